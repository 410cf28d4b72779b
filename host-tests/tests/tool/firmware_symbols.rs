//! Functions by their addresses.

use host_tests::firmware::symbols::*;

#[test]
fn an_address_is_in_the_function_whose_bytes_hold_it() {
    let symbols = Symbols::of(
        [
            (0x100, 0x20, "_ZN8scanbeam4span4draw17h836dc6be1353f5a2E"),
            (0x140, 8, "memset"),
            (0x140, 8, "__aeabi_memset"),
            (0x120, 6, "_ZN11_$LT$u8$GT$3new17h836dc6be1353f5a2E"),
        ]
        .into_iter(),
    );
    let name = |address| symbols.at(address).map(|symbol| symbol.name.as_str());
    assert_eq!(name(0xFF), None);
    assert_eq!(name(0x100), Some("scanbeam::span::draw"));
    assert_eq!(name(0x11F), Some("scanbeam::span::draw"));
    assert_eq!(name(0x120), Some("<u8>::new"));
    assert_eq!(name(0x126), None);
    assert_eq!(name(0x147), Some("memset"));
    assert_eq!(name(0x148), None);
    let sizes: Vec<u64> = symbols
        .by_size()
        .iter()
        .map(|symbol| symbol.bytes)
        .collect();
    assert_eq!(sizes, [0x20, 8, 6]);
}
