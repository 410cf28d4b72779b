//! What cargo, QEMU and the firmware do when all is well, and when not.

use host_tests::firmware::qemu::{Handed, run_in};
use host_tests::firmware::toolchain::is_of_outer_build;
use host_tests::firmware::*;
use host_tests::paced_report::{Costs, unhurried_lines};
use std::path::Path;
use std::time::Duration;

#[test]
fn outer_build_does_not_leak_into_the_inner_one() {
    for name in [
        "CARGO",
        "CARGO_MANIFEST_DIR",
        "CARGO_TARGET_DIR",
        "CARGO_ENCODED_RUSTFLAGS",
        "RUSTC",
        "RUSTC_BOOTSTRAP",
        "RUSTC_WORKSPACE_WRAPPER",
        "RUSTFLAGS",
        "RUSTDOCFLAGS",
        "LD_LIBRARY_PATH",
    ] {
        assert!(is_of_outer_build(name), "{name}");
    }
    for name in [
        "PATH",
        "HOME",
        "CARGO_HOME",
        "RUSTUP_TOOLCHAIN",
        "CARGO_HTTP_PROXY",
        "CARGO_REGISTRIES_CRATES_IO_PROTOCOL",
        "https_proxy",
    ] {
        assert!(!is_of_outer_build(name), "{name}");
    }
}

#[test]
fn missing_qemu_is_named() {
    let handed = Handed {
        words: &[],
        folder: Path::new("."),
        laid: None,
    };
    let error = run_in(
        "no-such-qemu",
        &M4,
        Path::new("none"),
        Duration::ZERO,
        &handed,
    )
    .expect_err("there is no such program");
    assert!(matches!(error, FirmwareError::NoQemu));
    assert!(
        error
            .to_string()
            .contains("apt-get install qemu-system-arm")
    );
}

#[test]
fn failure_of_qemu_is_passed_on() {
    let error = run(&M4, Path::new("no-such-elf"), DEFAULT_TIMEOUT).expect_err("no such ELF");
    assert!(matches!(&error, FirmwareError::Failed { status, .. } if status.code() == Some(1)));
    assert!(error.to_string().contains("no-such-elf"), "{error}");
}

/// The firmware for all boards, built at once, whichever test comes first.
fn built() -> Result<Toolchain, FirmwareError> {
    let toolchain = Toolchain::find()?;
    build_all(&toolchain, &BOARDS, Profile::Release, &[COMPARER], &[])?;
    Ok(toolchain)
}

/// On every board, and with overflow checks on one (each profile costs Debian's compiler a
/// build of `core`): frames have the host's bits, the counter counts right, every section is where
/// `memory.x` wants it, and what is printed is complete; a second run prints the same. One build
/// and one run of each variant, but for one board, which runs twice.
///
/// What is built is what `scanbeam firmware` runs, so after this test it builds nothing of it.
#[test]
fn firmware_runs_the_same_everywhere() -> Result<(), Box<dyn std::error::Error>> {
    let toolchain = built()?;
    let host = host_tests::frames::host_frames()?;
    let mut released = None;
    for (board, profile) in [
        (M4, Profile::Release),
        (M3, Profile::Release),
        (M0_PLUS, Profile::Release),
        (M4, Profile::Checked),
    ] {
        let measured = measure(&toolchain, &board, profile, &[])?;
        assert!(measured.output.counts.len() >= 2);
        assert!(measured.output.counts.iter().all(|count| count.ok));
        assert!(measured.output.figures["stack_bytes"] > 0);
        let sections = measured.sections;
        for (section, origin, length) in [
            (sections.text, 0, 4 << 20),
            (sections.bss, 0x2000_0000, 256 << 10),
            (sections.fast, 0x2004_0000, 64 << 10),
            (sections.dma, 0x2005_0000, 64 << 10),
            (sections.slow, 0x2100_0000, 16 << 20),
        ] {
            assert!(section.bytes > 0, "{sections:?}");
            assert!(section.address >= origin, "{sections:?}");
            assert!(
                section.address + section.bytes <= origin + length,
                "{sections:?}"
            );
        }
        if profile == Profile::Release {
            paced_lines_cost_no_more_than_they_may(&board, &measured.output);
            no_line_takes_more_than_was_paid(&toolchain, &board)?;
        }
        let frames = &measured.output.frames;
        assert_eq!(frames.len(), host.len(), "{}", board.name);
        for frame in frames {
            let here = host.get(frame.scene.as_str());
            assert_eq!(here, Some(&frame.crc), "{} on {}", frame.scene, board.name);
        }
        if profile == Profile::Checked {
            let asked = measure(&toolchain, &board, profile, &["bench"]).expect_err("it has none");
            assert!(asked.to_string().contains("frames alone"), "{asked}");
        }
        if (board, profile) == (M3, Profile::Release) {
            released = Some(measured);
        }
    }
    let released = released.expect("it was among them");
    stepped_frames_have_what_was_counted(&toolchain, &M3, &released.output)?;
    let again = measure(&toolchain, &M3, Profile::Release, &[])?;
    assert_eq!(again, released);
    Ok(())
}

/// The dearest line of each frame that is paced, of those whose costs are those of the board's code (X9).
///
/// Kills: what it costs to choose how runs are coloured is not paid for.
fn paced_lines_cost_no_more_than_they_may(board: &Board, output: &Output) {
    for paced in scenes::PACED {
        let worst = output.figures[&format!("worst_line_{}", paced.name)];
        let most = u64::from(paced.pace.most);
        println!("{}: {worst} of {most} on {}", paced.name, board.name);
        let is_of_board = *board != M0_PLUS || paced.is_in_m0_code();
        assert!(worst > most / 4, "{} on {}", paced.name, board.name);
        assert!(
            !is_of_board || worst <= most,
            "{} on {}",
            paced.name,
            board.name
        );
    }
}

/// Each line of the frames that can be paced, with time enough (X9).
///
/// Kills: in smooth M0+ code large triangles at 2,300 in place of 2,700, spans at 170 in place of 200, and pixels at 6 in
/// place of 8.
fn no_line_takes_more_than_was_paid(
    toolchain: &Toolchain,
    board: &Board,
) -> Result<(), Box<dyn std::error::Error>> {
    let measured = unhurried_lines(toolchain, board)?;
    for is_textured in [false, true] {
        let costs = Costs::new(board, is_textured, &measured)?;
        assert!(costs.lines.len() >= 9 * 240, "{}", costs.lines.len());
        let over = costs.lines.iter().find(|line| !line.is_paid());
        assert!(over.is_none(), "{}: {over:?}", board.name);
    }
    Ok(())
}

/// A frame that is stepped through has the instructions that the firmware counts: but for two
/// ticks, and for what stands between counter or marks and the frame.
fn stepped_frames_have_what_was_counted(
    toolchain: &Toolchain,
    board: &Board,
    output: &Output,
) -> Result<(), FirmwareError> {
    let stepped = profile::step(toolchain, board, "cube")?;
    let counted = output.frames.iter().find(|frame| frame.scene == "cube");
    let counted = counted.map_or(0, |frame| frame.instructions);
    let apart = stepped.instructions().abs_diff(counted);
    assert!(
        apart <= 400,
        "{counted} counted, {} stepped",
        stepped.instructions()
    );
    let by_function: u64 = stepped.functions.iter().map(|f| f.instructions).sum();
    let nowhere = stepped.instructions() - by_function;
    assert!(nowhere * 100 < counted, "{nowhere} in no function");
    let calls = |words: &str| {
        let named = stepped
            .functions
            .iter()
            .filter(|f| f.symbol.name.contains(words));
        named.map(|f| f.calls).max().unwrap_or_default()
    };
    assert_eq!(calls("frames::draw"), 1);
    let missing = stepped.listing("no such function").unwrap_err();
    assert!(
        matches!(missing, FirmwareError::NoFunction { .. }),
        "{missing}"
    );
    let unknown = profile::step(toolchain, board, "nothing").unwrap_err();
    assert!(
        unknown.to_string().contains("there is no frame `nothing`"),
        "{unknown}"
    );
    Ok(())
}

#[test]
fn firmware_that_does_not_end_is_stopped() -> Result<(), FirmwareError> {
    let elf = build(&built()?, &M4, Profile::Release, COMPARER, &[])?;
    let error = run(&M4, &elf, Duration::ZERO).expect_err("no time was given");
    assert!(matches!(error, FirmwareError::Timeout { .. }), "{error}");
    Ok(())
}
