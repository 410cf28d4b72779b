//! Renderers on boards.

use host_tests::bench::boards::*;
use host_tests::bench::{Entry, OURS, PACKAGES};
use host_tests::firmware::{BOARDS, FirmwareError};
use scenes::Shot;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;

fn entry(scene: Shot, renderer: &'static str) -> Entry {
    Entry {
        scene,
        renderer,
        package: PACKAGES[usize::from(renderer != OURS)],
        words: Vec::new(),
    }
}

fn on(instructions: Option<f64>) -> OnBoard {
    OnBoard {
        board: BOARDS[0],
        counted: match instructions {
            Some(instructions) => Ok(Counted {
                instructions,
                pixels: 100,
                ratio: None,
            }),
            None => Err("it does not build".to_owned()),
        },
    }
}

/// Each scene by its own figure of ours; what is not there is said with the reason.
#[test]
fn ratios_are_of_the_same_scene() {
    let entries = [
        entry(Shot::Sphere, OURS),
        entry(Shot::Sphere, "x"),
        entry(Shot::Sphere, "y"),
        entry(Shot::FarToNear, OURS),
        entry(Shot::FarToNear, "x"),
        entry(Shot::NearToFar, OURS),
        entry(Shot::NearToFar, "x"),
    ];
    let figures = [
        Some(2e6),
        Some(5e6),
        None,
        Some(1e6),
        Some(9e6),
        None,
        Some(3e6),
    ];
    let mut column = figures.map(on);
    compare(&entries, &mut column);
    let ratios: Vec<Option<f64>> = column
        .iter()
        .map(|on| on.counted.as_ref().ok().and_then(|counted| counted.ratio))
        .collect();
    let expected = [Some(1.0), Some(2.5), None, Some(1.0), Some(9.0), None, None];
    assert_eq!(ratios, expected);
    assert_eq!(column[1].cells(), ["5.00", "2.5"]);
    assert_eq!(column[2].cells(), ["-", "-"]);
    assert_eq!(
        column[1].to_json()["instructions_per_shaded_pixel"],
        50_000.0
    );
    assert_eq!(column[2].to_json()["missing"], "it does not build");
}

#[test]
fn what_does_not_build_is_said_in_a_line() {
    let error = FirmwareError::Build {
        targets: "thumbv6m-none-eabi".to_owned(),
        status: ExitStatus::from_raw(256),
        stderr: "   Compiling x\nerror[E0463]: can't find crate for `std`\n".to_owned(),
    };
    let said = reason("peers", &error);
    assert_eq!(
        said,
        "peers does not build for thumbv6m-none-eabi: error[E0463]: can't find crate for `std`"
    );
    let said = reason("peers", &FirmwareError::NoQemu);
    assert!(said.contains("apt-get install qemu-system-arm"), "{said}");
}
