//! `trace` prints what is on the wires, and `render --interp model` draws it (K13).

use host_tests::args::PixelFormatArg;
use host_tests::draw::{CrewSettings, draw, draw_model};
use host_tests::model::Model;
use host_tests::reference::{Shade, View};
use host_tests::trace::{describe, trace};
use scanbeam_model::{Output, ParameterSetup, Pipe, PipeMemory, Target, Token, TokenBits};
use std::process::Command;

const SQUARE: &str = "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 0 0 0 1\nv -1 1 0 1 1 1\nf 1 2 3 4\n";

fn square() -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("square.obj");
    std::fs::write(&file, SQUARE).unwrap();
    (folder, file)
}

fn view() -> View {
    View {
        width: 48,
        height: 40,
        background: [10, 20, 30],
        ..View::default()
    }
}

/// The tokens that are printed make the line of the picture, in a pipeline of their own.
#[test]
fn what_is_traced_draws_the_line() {
    let (_folder, file) = square();
    let model = Model::load(&file).unwrap();
    for shade in [Shade::None, Shade::Flat, Shade::Gouraud] {
        let view = View { shade, ..view() };
        let picture = draw_model(&model, &view, PixelFormatArg::Rgb888).unwrap();
        let fast = draw(
            &model,
            &view,
            PixelFormatArg::Rgb888,
            CrewSettings::default(),
        )
        .unwrap();
        let mut drawn = 0;
        for line in 0..view.height {
            let traced = trace(&model, &view, line as u16).unwrap();
            let mut memory = [(); 4].map(|()| [0x77; 48]);
            let [z0, z1, c0, c1] = &mut memory;
            let mut pipe = Pipe::new(PipeMemory {
                z: [z0, z1],
                rgb: [c0, c1],
            });
            let mut pixels = Vec::new();
            for bits in &traced.tokens {
                pipe.bits(*bits, &mut |output| match output {
                    Output::Pixel { x, argb } => pixels.push((x, argb)),
                    Output::Data(data) => panic!("{data:x}"),
                })
                .unwrap();
            }
            assert_eq!(pixels.len(), 48);
            for (x, (at, [_, rgb @ ..])) in (0..).zip(&pixels) {
                assert_eq!(
                    (x, picture.frame.pixel(x, line)),
                    (u32::from(*at), Some(*rgb))
                );
                let other = fast.frame.pixel(x, line).unwrap();
                assert!((0..3).all(|i| other[i].abs_diff(rgb[i]) <= 3));
                drawn += u32::from(*rgb != view.background);
            }
            assert_eq!(traced.counts, pipe.counts());
        }
        assert!(drawn > 400, "{drawn}");
    }
}

/// What is wider than a scene can be is traced in parts, from left to right.
#[test]
fn a_wide_line_is_traced_in_parts() {
    let (_folder, file) = square();
    let model = Model::load(&file).unwrap();
    let view = View {
        width: 2500,
        ..view()
    };
    let picture = draw_model(&model, &view, PixelFormatArg::Rgb888).unwrap();
    let mut memory = [(); 4].map(|()| [0; 1016]);
    let [z0, z1, c0, c1] = &mut memory;
    let mut pipe = Pipe::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    });
    let mut pixels = Vec::new();
    for bits in trace(&model, &view, 20).unwrap().tokens {
        let mut keep = |output| match output {
            Output::Pixel { argb, .. } => pixels.push(argb),
            Output::Data(data) => panic!("{data:x}"),
        };
        pipe.bits(bits, &mut keep).unwrap();
    }
    assert_eq!(pixels.len(), 2500);
    let drawn = pixels
        .iter()
        .filter(|[_, rgb @ ..]| *rgb != view.background);
    assert!(drawn.count() > 10);
    for (x, [_, rgb @ ..]) in (0..).zip(pixels) {
        assert_eq!(picture.frame.pixel(x, 20), Some(rgb), "{x}");
    }
}

#[test]
fn tokens_are_told_with_their_fields() {
    let swap = Token::Swap(Target::BOTH).encode();
    assert_eq!(
        describe(swap),
        "0f04c000000000000000  J swap buffers  RGB  Z"
    );
    let normal = ParameterSetup {
        left: 0xFFF_001_800,
        right: 0,
    };
    let normal = describe(Token::NormalSetup(normal).encode());
    assert!(
        normal.ends_with("F normal set-up  Nx0=-1  Ny0=1  Nz0=-2048"),
        "{normal}"
    );
    assert!(describe(TokenBits::default()).ends_with("- null"));
    let own = Token::ParameterSetup(9, ParameterSetup::default());
    assert!(describe(own.encode()).ends_with("- set-up of parameter 9"));
    let unknown = TokenBits::truncated(5 << 72);
    assert!(describe(unknown).ends_with("- unknown, id 5"));
}

#[test]
fn the_command_prints_a_line_and_refuses_others() {
    let (_folder, file) = square();
    let run = |line: &str| {
        Command::new(env!("CARGO_BIN_EXE_scanbeam"))
            .arg("trace")
            .arg(&file)
            .args(["--size", "48x40", "--line", line])
            .output()
            .unwrap()
    };
    let done = run("20");
    assert!(done.status.success());
    let text = String::from_utf8(done.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("line 20, 48 pixels, "), "{text}");
    let kinds = |letter: &str| {
        let letter = format!("  {letter} ");
        lines.iter().filter(|line| line.contains(&letter)).count()
    };
    // A mode, two triangles side by side, two swaps.
    let pixels = kinds("A");
    assert_eq!(
        [kinds("K"), kinds("C"), kinds("D"), kinds("J")],
        [1, 2, 2, 2]
    );
    assert!(
        pixels > 10
            && lines
                .last()
                .unwrap()
                .starts_with(&format!("{pixels} pixels"))
    );
    let refused = run("40");
    assert_eq!(refused.status.code(), Some(2));
    assert!(refused.stdout.is_empty());
    let text = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(
        text,
        "error: --line must be below the height, which is 40\n"
    );
}
