//! M3: whatever comes in. Floats of any bits at every door of the crate, and numbers of any size
//! in model files and on the command line: refused in one line, or drawn without a panic, a wrap
//! or an overflow. The bounds are in the table of `stress_shapes.rs`.

use crate::common::Rng;
use crate::hot::cover::L;
use crate::hot::{LineRooms, SceneRooms, frame, line};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{BeginError, Draw, LARGEST};
use scanbeam::{Affine, Camera, CameraError, Cull, Light, Screen};
use scenes::{CUBE, TEAPOT};
use std::fs;
use std::process::Command;

/// A float of any kind: plain, of any bits, at the ends of the range, not a number.
fn float(rng: &mut Rng) -> f32 {
    let any = rng.below(u32::MAX);
    match rng.below(8) {
        0 => f32::from_bits(any),
        1 => f32::from_bits(any & 0x807F_FFFF),
        2 => rng.pick(&[
            f32::NAN,
            -f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            f32::MIN,
            f32::MIN_POSITIVE,
            -f32::MIN_POSITIVE,
            0.0,
            -0.0,
            f32::EPSILON,
        ]),
        3 => rng.signed() as f32 * (f64::from(rng.within(-126, 127))).exp2() as f32,
        _ => (8.0 * rng.signed()) as f32,
    }
}

fn vector(rng: &mut Rng) -> [f32; 3] {
    [(); 3].map(|()| float(rng))
}

/// What is not finite is refused, with the error that names it; what is made can be drawn with.
#[test]
fn floats_of_any_bits_are_refused_or_drawn() {
    let mut rng = Rng::new(81);
    let mut rooms = SceneRooms::new(64, 64, 16, 1);
    let (mut made, mut refused, mut pixels) = (0u32, [0u32; 5], 0u64);
    for round in 0..150_000 {
        let plain = round % 2 == 0;
        let (mut eye, mut at, mut up) = ([0.0, 0.5, 4.0], [0.0f32; 3], [0.0, 1.0, 0.0]);
        let (mut focal, mut near, mut far) = (12.0, 0.1f32, 100.0);
        if plain {
            // One of them odd, the others as usual.
            let odd = float(&mut rng);
            let i = rng.below(3) as usize;
            match rng.below(6) {
                0 => eye[i] = odd,
                1 => at[i] = odd,
                2 => up[i] = odd,
                3 => focal = odd,
                4 => near = odd,
                _ => far = odd,
            }
        } else {
            (eye, at, up) = (vector(&mut rng), vector(&mut rng), vector(&mut rng));
            (focal, near, far) = (float(&mut rng), float(&mut rng), float(&mut rng));
            if rng.below(4) == 0 {
                (at, focal, near, far) = (eye, 12.0, 0.1, 100.0);
            }
        }
        let all = [eye, at, up, [focal, near, far]];
        let finite = all.iter().flatten().all(|v| v.is_finite());
        let camera = match Camera::look_at(eye, at, up, focal, near, far) {
            Ok(camera) => camera,
            Err(error) => {
                let which = match error {
                    CameraError::NotFinite => 0,
                    CameraError::NoDirection => 1,
                    CameraError::NoUp => 2,
                    CameraError::Focal => 3,
                    _ => 4,
                };
                refused[which] += 1;
                continue;
            }
        };
        assert!(finite, "{all:?}");
        made += 1;
        let model = Affine::from_rows(
            [vector(&mut rng), vector(&mut rng), vector(&mut rng)],
            vector(&mut rng),
        )
        .filter(|_| rng.below(2) == 0)
        .unwrap_or(Affine::IDENTITY);
        let call = Draw {
            model: model.then(&Affine::rotation_x(float(&mut rng))),
            cull: rng.pick(&[Cull::Back, Cull::None]),
            light: Light::new(vector(&mut rng), float(&mut rng)),
            colour: [200, 100, 50],
            ..Draw::new(CUBE)
        };
        let screen = Screen::new(16, 16).unwrap();
        let mut scene = rooms.scene::<Gouraud<Rgb565Be>>(screen);
        scene.begin(&camera).unwrap();
        // 24 vertices and 12 triangles; clipping may need more than there is room for.
        let _ = scene.draw(&call);
        pixels += frame(&scene, 4, true, 0)
            .iter()
            .flatten()
            .filter(|p| **p != 0)
            .count() as u64;
    }
    println!("{made} cameras, refused {refused:?}, {pixels} pixels");
    assert!(
        made > 40_000 && refused.iter().all(|r| *r > 100),
        "{refused:?}"
    );
    assert!(pixels > 500_000, "{pixels}");
}

/// A light is a direction and a level, or refused.
#[test]
fn lights_of_any_bits_are_within_their_range() {
    let mut rng = Rng::new(82);
    let mut made = 0;
    for _ in 0..500_000 {
        let (direction, ambient) = (vector(&mut rng), float(&mut rng));
        let usable = direction.iter().all(|v| v.is_finite()) && direction != [0.0; 3];
        let light = Light::new(direction, ambient);
        assert_eq!(light.is_some(), usable, "{direction:?}");
        let Some(light) = light else { continue };
        made += 1;
        let length: f64 = light
            .direction
            .iter()
            .map(|c| c.to_num::<f64>().powi(2))
            .sum();
        // Each within 2^-14.
        let bound = 3f64.sqrt() * 2f64.powi(-14) + 1e-6;
        assert!(
            (length.sqrt() - 1.0).abs() < bound,
            "{direction:?}: {light:?}"
        );
        let normal = [(); 3].map(|()| rng.below(65_536) as u16 as i16);
        let level = light.level(normal).to_num::<f64>();
        assert!((light.ambient.to_num::<f64>()..=1.0).contains(&level));
    }
    assert!(made > 100_000, "{made}");
}

/// Every size from 1x1 to 8192x8192 is a screen, no other is; the extremes of what a scene can be are drawn, and what is
/// larger is refused whole and drawn in parts.
#[test]
fn screens_of_any_size_are_refused_or_drawn() {
    for side in 0..=u16::MAX {
        let good = (1..=8192).contains(&side);
        assert_eq!(Screen::new(side, 1).is_ok(), good);
        assert_eq!(Screen::new(8192, side).is_ok(), good);
    }
    for (width, height) in [(1, 1), (8192, 1), (1, 8192), (8192, 8192), (8191, 3)] {
        let whole = Screen::new(width, height).unwrap();
        let mut rooms = SceneRooms::new(64, 64, LARGEST.into(), 1);
        let (eye, up) = ([0.2, 0.1, 3.0], [0.0, 1.0, 0.0]);
        let focal = 2.0 * f32::from(width.max(height));
        let camera = Camera::look_at(eye, [0.0; 3], up, focal, 0.1, 10.0).unwrap();
        let begun = rooms.scene::<L>(whole).begin(&camera);
        let fits = width.max(height) <= LARGEST;
        let refused = Err(BeginError::Size { width, height });
        assert_eq!(begun, if fits { Ok(()) } else { refused });
        let [right, down] = [width, height].map(|side| side - side.min(LARGEST));
        let part = Screen::new(width - right, height - down).unwrap();
        // The parts at the corners of the whole.
        for [left, top] in [[0, 0], [right, 0], [0, down], [right, down]] {
            let shift = [[left, right], [top, down]]
                .map(|[from, last]| f32::from(from) - f32::from(last) / 2.0);
            let mut scene = rooms.scene::<L>(part);
            scene.begin(&camera.shifted(shift).unwrap()).unwrap();
            scene.draw(&Draw::new(CUBE)).unwrap();
            let mut lines = LineRooms::fitting(&scene, 4, true);
            let mut renderer = lines.renderer();
            for y in (0..part.height()).step_by(usize::from(part.height() / 8).max(1)) {
                // The cube is larger than the picture.
                let drawn = line(&mut renderer, &scene, y, [0; 3]);
                assert!(drawn.iter().all(|p| *p != [0; 3]), "{width}x{height}, {y}");
            }
        }
    }
}

/// A world scaled by a power of two, the eye and the planes with it, is the same picture, bit
/// for bit, from 2^-50 to 2^80: numbers are mantissas that never see the exponent.
#[test]
fn a_world_of_any_size_is_the_same_picture() {
    let mut rooms = SceneRooms::new(8192, 4096, 48, 2);
    let mut picture = |power: i32| {
        let scale = f64::from(power).exp2() as f32;
        let mut scene = rooms.scene::<L>(Screen::new(64, 48).unwrap());
        let eye = [0.3f32, 1.1, 2.2].map(|v| v * scale);
        let up = [0.0, 1.0, 0.0];
        let (near, far) = (0.7 * scale, 40.0 * scale);
        let camera = Camera::look_at(eye, [0.0; 3], up, 50.0, near, far).unwrap();
        scene.begin(&camera).unwrap();
        let place =
            |size: f32, at: [f32; 3]| Affine::placed(size * scale, at.map(|v| v * scale)).unwrap();
        let call = |mesh, model| Draw {
            model,
            cull: Cull::None,
            light: Light::new([1.0, 2.0, 3.0], 0.1),
            ..Draw::new(mesh)
        };
        // The floor goes through the near plane.
        let floor = Affine::rotation_y(0.4).then(&place(5.0, [0.0, -6.0, 0.0]));
        scene.draw(&call(CUBE, floor)).unwrap();
        let pot = Affine::rotation_y(2.0).then(&place(0.9, [0.1, 0.2, -0.3]));
        scene.draw(&call(TEAPOT, pot)).unwrap();
        assert!(scene.assembled().clipped > 0);
        frame(&scene, 16, true, [0; 3])
    };
    let want = picture(0);
    assert!(want.iter().flatten().filter(|p| **p != [0; 3]).count() > 1500);
    for power in (-50..=80).filter(|p| *p != 0) {
        assert_eq!(picture(power), want, "2^{power}");
    }
}

/// Numbers that are none, or too large: each with whether a file may have it.
const NUMBERS: [(&str, bool); 22] = [
    ("nan", false),
    ("-NaN", false),
    ("inf", false),
    ("-inf", false),
    ("Infinity", false),
    ("1e39", false),
    ("-3.5e38", false),
    ("1e309", false),
    ("-1e99999", false),
    ("1e", false),
    ("0x10", false),
    ("1,5", false),
    ("--1", false),
    ("1e-40", true),
    ("-1e-45", true),
    ("1e-400", true),
    ("3.4e38", true),
    ("-3.4e38", true),
    ("1e30", true),
    ("-0", true),
    ("00000000000000000000000000000000000001", true),
    ("0.1234567890123456789012345678901234567890", true),
];

struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.path().join(name), text).unwrap();
    }

    /// Exit code and what was said; `o.png` is there afterwards if and only if it was drawn.
    fn render(&self, flags: &str) -> (i32, String) {
        let picture = self.0.path().join("o.png");
        let _ = fs::remove_file(&picture);
        let output = Command::new(env!("CARGO_BIN_EXE_scanbeam"))
            .args(["render", "m.obj", "-o", "o.png", "--size", "16x12"])
            .args(flags.split_whitespace())
            .current_dir(self.0.path())
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        let code = output.status.code().unwrap_or(-1);
        assert!(code == 0 || code == 2, "{flags}: {code}: {said}");
        assert_eq!(picture.exists(), code == 0, "{flags}: {said}");
        if code == 2 {
            assert_eq!(said.lines().count(), 1, "{flags}: {said}");
        }
        (code, said)
    }
}

#[test]
fn files_with_any_number_are_drawn_or_refused_with_their_line() {
    let desk = Desk::new();
    for (number, good) in NUMBERS {
        // Where it stands: the line, and the file with `@` in its place.
        for (line, file, text) in [
            (2, "m.obj", "v 0 0 0\nv @ 0 0\nv 0 1 0\nf 1 2 3\n"),
            (3, "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 @\nf 1 2 3\n"),
            (1, "m.obj", "v 0 0 0 @ 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            (
                4,
                "m.obj",
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 @\nf 1/1 2/1 3/1\n",
            ),
            (
                5,
                "m.obj",
                "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nvn 0 @ 1\nf 1//1 2//1 3//1\n",
            ),
            (2, "m.mtl", "newmtl a\nKd @ 0 0\n"),
            (3, "m.mtl", "newmtl a\n\nNs @\n"),
        ] {
            let text = text.replace('@', number);
            if file == "m.mtl" {
                desk.write("m.mtl", &text);
                let model = "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
                desk.write("m.obj", model);
            } else {
                desk.write("m.obj", &text);
            }
            let (code, said) = desk.render("--shade gouraud");
            // Places that 32-bit floats hold, but for which no camera can be set: either is right.
            let beyond = number.contains("e3") && text.starts_with("v 0 0 0\nv ");
            if !(good && beyond) {
                assert_eq!(code == 0, good, "{text:?}: {said}");
            }
            if !good {
                let place = format!("{file}:{line}: ");
                assert!(said.contains(&place), "{text:?}: {said}");
            }
        }
    }
}

#[test]
fn flags_with_any_number_are_drawn_or_refused() {
    let desk = Desk::new();
    desk.write("m.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    let (mut drawn, mut refused) = (0, 0);
    for (number, good) in NUMBERS {
        for flag in [
            "--eye 0,@,3",
            "--eye @,0,0",
            "--at @,0,0",
            "--up 0,@,1",
            "--light 0,0,@",
            "--fov @",
            "--near @",
            "--far @",
            "--ambient @",
        ] {
            let flags = flag.replace('@', number);
            let (code, said) = desk.render(&flags);
            // A good number may still be out of its flag's range; a bad one never passes.
            assert!(good || code == 2, "{flags}: {said}");
            if code == 0 {
                drawn += 1;
            } else {
                refused += 1;
            }
        }
    }
    assert!(drawn > 30 && refused > 120, "{drawn}, {refused}");
}
