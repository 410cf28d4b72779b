//! Renderers on the host.

use host_tests::bench::*;
use scenes::{HEIGHT, Shot, WIDTH};

#[test]
fn callgrind_is_understood() {
    let said = "==1== Events    : Ir\n==1== Collected : 123456\n";
    assert_eq!(collected(said), Some(123_456.0));
    assert_eq!(collected("nothing"), None);
}

#[test]
fn another_picture_is_noticed() {
    let size = usize::from(WIDTH) * usize::from(HEIGHT);
    let mut ours = vec![0; size];
    ours[..1000].fill(0x8410);
    let entry = Entry {
        scene: Shot::Sphere,
        renderer: "x",
        package: PACKAGES[1],
        words: Vec::new(),
    };
    let pictures = Pictures::from([(Shot::Sphere.name(), ours.clone())]);
    let check = |picture: &[u16]| Compared::new(&entry, picture, &pictures);
    assert_eq!(check(&ours).map(|compared| compared.shown), Ok(1000));
    assert!(check(&ours[..size - 100]).is_err());
    assert!(check(&vec![0; size]).is_err());
    let mut moved = ours.clone();
    moved.rotate_right(30);
    assert!(check(&moved).is_err());
    let mut darker = ours.clone();
    darker[..1000].fill(0x4208);
    assert!(check(&darker).is_err());
}

#[test]
fn bytes_of_a_picture_come_low_first() {
    assert_eq!(pixels(&[0x34, 0x12, 0xff, 0]), [0x1234, 0xff]);
}

/// One reason for all that it keeps from being measured.
#[test]
fn reasons_are_told_once() {
    let row = |reasons: [&str; 2]| Row {
        scene: "sphere",
        renderer: OURS,
        instructions: None,
        pixels: 1,
        wall_ms: 1.0,
        ratio: 1.0,
        instructions_ratio: None,
        boards: reasons
            .map(|reason| OnBoard {
                board: host_tests::firmware::M4,
                counted: Err(reason.to_owned()),
            })
            .to_vec(),
    };
    let rows = [row(["no QEMU", "no QEMU"]), row(["no QEMU", "no core"])];
    assert_eq!(missing(&rows), ["no QEMU", "no core"]);
    let json = rows[0].to_json();
    assert_eq!(json["boards"]["m4"]["missing"], "no QEMU");
}

#[test]
fn shared_scenes_have_numbers() {
    for shot in scene::SHARED {
        let data = serde_json::to_value(scene::Data::new(shot).unwrap()).unwrap();
        let faces = data["faces"].as_array().unwrap().len();
        assert_eq!(faces, if shot == Shot::Sphere { 2048 } else { 32 });
    }
    assert!(scene::Data::new(Shot::Cube).is_none());
}
