//! What functions read, by their returns.

use host_tests::boards::functions::*;
use host_tests::boards::wire::Use;
use host_tests::firmware::Symbols;

fn used(address: u64, misses: u64, returns: u64) -> Use {
    Use {
        address,
        misses,
        returns,
    }
}

#[test]
fn functions_stand_by_their_returns_a_byte_and_data_in_ram_is_left_out() {
    let symbols = Symbols::of(
        [
            (0x1000_0100, 0x40, "long"),
            (0x1000_0140, 8, "short"),
            (RAM, 0x20, "fast"),
        ]
        .into_iter(),
    );
    let uses = [
        used(0x1000_0000, 6, 2),
        used(0x1000_0100, 4, 10),
        used(0x1000_013E, 2, 10),
        used(0x1000_0144, 0, 4),
        used(RAM + 2, 0, 40),
        used(RAM + 0x20, 0, 400),
    ];
    let functions = of(&uses, &symbols, 2);
    let row = |name: &str, bytes, is_in_ram, misses, returns| Function {
        name: name.into(),
        bytes,
        is_in_ram,
        misses,
        returns,
    };
    let wanted = [
        row("fast", 0x20, true, 0, 20),
        row("short", 8, false, 0, 2),
        row("long", 0x40, false, 3, 10),
        row("constants", 0, false, 3, 1),
    ];
    assert_eq!(functions, wanted);
    let text = table(&functions).to_string();
    // 104 bytes down to the third; 10 returns in 64 bytes are 160 a KB.
    assert!(text.contains(" 104 ") && text.contains(" 160 "), "{text}");
}
