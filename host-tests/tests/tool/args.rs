//! What is read, and what is refused.

mod refusals;

use host_tests::args::*;
use host_tests::draw::CrewSettings;
use host_tests::reference::{Cull, Shade, View};
use scanbeam::scene::Budget;
use std::path::PathBuf;

fn words(line: &str) -> Result<Command, Stop> {
    parse(std::iter::once("scanbeam").chain(line.split_whitespace()))
}

fn render(flags: &str) -> RenderArgs {
    match words(&format!("render m.obj -o o.png {flags}")) {
        Ok(Command::Render(render)) => render,
        other => panic!("{flags}: {other:?}"),
    }
}

#[test]
fn the_definitions_hold_together() {
    definitions().debug_assert();
}

#[test]
fn defaults_are_those_of_the_design() {
    let args = render("");
    assert_eq!(args.view(), View::default());
    assert_eq!(args.picture.format, PixelFormatArg::Rgb888);
    assert_eq!((args.interp, args.quality), (InterpArg::Auto, None));
    assert_eq!(args.method(), Method::DrawCalls);
    assert_eq!(args.budget(), Budget::BALANCED);
    assert_eq!(args.crew(), CrewSettings::default());
    assert_eq!(args.stats, None);
    assert_eq!(words(""), Ok(Command::Demo(DemoArgs::default())));
    assert_eq!(words("demo"), words(""));
    assert_eq!((args.cache, args.renderers, args.prefetch), (64, 1, 0));
    let plain = CacheArgs {
        json: false,
        output: None,
    };
    assert_eq!(words("cache"), Ok(Command::Cache(plain)));
    assert_eq!(
        words("firmware"),
        Ok(Command::Firmware(FirmwareArgs {
            json: false,
            ..FirmwareArgs::default()
        }))
    );
    assert_eq!(
        words("firmware --json"),
        Ok(Command::Firmware(FirmwareArgs {
            json: true,
            ..FirmwareArgs::default()
        }))
    );
}

/// Kills: a scene that is not taken, and one without the flags that go with it.
#[test]
fn firmware_takes_a_scene() {
    for (line, json, board) in [
        ("firmware s.json", false, None),
        ("firmware S.JSON --json", true, None),
        ("firmware l.list --board m3 --json", true, Some("m3")),
    ] {
        let Ok(Command::Firmware(args)) = words(line) else {
            panic!("{line}");
        };
        let file = args.scene.as_ref().and_then(|file| file.to_str());
        assert_eq!(file, line.split(' ').nth(1), "{line}");
        assert_eq!((args.json, args.board.as_deref()), (json, board), "{line}");
        assert_eq!(args.boards().len(), if board.is_some() { 1 } else { 3 });
    }
}

#[test]
fn boards_are_run_as_asked() {
    let plain = BoardsArgs {
        json: false,
        functions: false,
        board: None,
        frames: 2,
        miss_cycles: 56,
        built: None,
        packages: None,
    };
    assert_eq!(words("boards"), Ok(Command::Boards(plain)));
    let all = BoardsArgs {
        json: true,
        functions: false,
        board: Some("rp2350".into()),
        frames: 126,
        miss_cycles: 0,
        built: Some("a".into()),
        packages: Some("b".into()),
    };
    let line = "boards rp2350 --json --frames 126 --miss-cycles 0 --built a --packages b";
    assert_eq!(words(line), Ok(Command::Boards(all)));
    let Ok(Command::Boards(asked)) = words("boards --functions") else {
        panic!("--functions is refused");
    };
    assert!(asked.functions);
    for line in [
        "boards --functions --json",
        "boards a b",
        "boards --frames 1",
        "boards --frames 127",
        "boards --miss-cycles 1001",
        "boards --miss-cycles x",
    ] {
        assert!(matches!(words(line), Err(Stop::Refused(_))), "{line}");
    }
}

#[test]
fn every_flag_arrives() {
    let view = render(
        "--size 17x8192 --eye -1,0,3 --at=-2,-3.5,1e-2 --up 0,0,-1 --fov 179.9 --near 1 --far 2.5 --light -1,-1,-1 \
         --ambient 1 --shade gouraud --cull back --background 255,0,7 --format rgb565 --quality fast --stats s.json \
         --cache 0 --renderers 16 --prefetch 99 --depth z32",
    );
    let crew = CrewSettings {
        renderers: 16,
        slots: 0,
        prefetch: 99,
        counts: true,
        depth: DepthArg::Z32,
        pace: None,
    };
    assert_eq!((view.crew(), view.method()), (crew, Method::DrawCalls));
    assert_eq!(view.stats, Some(PathBuf::from("s.json")));
    assert_eq!(view.picture.format, PixelFormatArg::Rgb565);
    assert_eq!(view.quality, Some(QualityArg::Fast));
    let expected = View {
        width: 17,
        height: 8192,
        eye: [-1.0, 0.0, 3.0],
        at: [-2.0, -3.5, 0.01],
        up: [0.0, 0.0, -1.0],
        fov: 179.9,
        near: 1.0,
        far: 2.5,
        light: [-1.0; 3],
        ambient: 1.0,
        shade: Shade::Gouraud,
        cull: Cull::Back,
        background: [255, 0, 7],
    };
    assert_eq!(view.view(), expected);
    match words("trace m.obj --line 8191 --size 17x8192 --shade flat") {
        Ok(Command::Trace(trace)) => {
            assert_eq!((trace.line, trace.model), (8191, PathBuf::from("m.obj")));
            assert_eq!(trace.picture.shade, ShadeArg::Flat);
        }
        other => panic!("{other:?}"),
    }
    let demo = DemoArgs {
        output: "d".into(),
        frames: 3,
        changed: ChangedArg::Runs,
    };
    let said = words("demo -o d --frames 3 --changed runs");
    assert_eq!(said, Ok(Command::Demo(demo)));
    for (name, method) in [
        ("plane", InterpArg::Plane),
        ("packed8", InterpArg::Packed8),
        ("packed16", InterpArg::Packed16),
        ("half", InterpArg::Half),
        ("quarter", InterpArg::Quarter),
        ("lirp10", InterpArg::Lirp10),
        ("lirp12", InterpArg::Lirp12),
        ("lirp16", InterpArg::Lirp16),
        ("lirp-packed", InterpArg::LirpPacked),
        ("model", InterpArg::Model),
    ] {
        let args = render(&format!("--interp {name}"));
        assert_eq!(args.method(), Method::Interp(method));
    }
    for (name, budget) in [
        ("fast", Budget::FAST),
        ("balanced", Budget::BALANCED),
        ("exact", Budget::EXACT),
    ] {
        let args = render(&format!("--quality {name} --interp auto"));
        assert_eq!((args.method(), args.budget()), (Method::DrawCalls, budget));
    }
    for (name, method) in [
        ("block-fix", Method::Depth(DepthArg::BlockFix)),
        ("word", Method::Depth(DepthArg::Word)),
        ("id", Method::DrawCalls),
        ("priority", Method::DrawCalls),
    ] {
        let args = render(&format!("--depth {name}"));
        assert_eq!(args.method(), method);
    }
}

/// Draw calls have any flag beside any other.
#[test]
fn flags_of_draw_calls_go_together() {
    let crews = [
        "",
        "--cache 4095 --renderers 3 --prefetch 8 --quality exact",
    ];
    let depths = ["auto", "z32", "id", "priority"];
    let effects = [
        "",
        "--specular 0.5,8 --shade flat",
        "--shade phong",
        "--shadows on",
        "--shadows on --shade phong --specular 0.5,8",
        "--texture t.png",
        "--texture t.png --filter bilinear --levels off --shade phong",
    ];
    let formats = [
        "rgb888",
        "rgb565",
        "rgb565 --dither on",
        "xrgb8888",
        "grey8",
        "mono",
    ];
    let mut refused = Vec::new();
    for crew in crews {
        for depth in depths {
            for effect in effects {
                for format in formats {
                    let flags = format!("--depth {depth} --format {format} {crew} {effect}");
                    let no_shadow = depth == "priority" && effect.contains("shadows");
                    let no_texture =
                        effect.contains("texture") && ["grey8", "mono"].contains(&format);
                    let line = words(&format!("render m.obj -o o.png {flags}"));
                    assert_eq!(line.is_err(), no_shadow || no_texture, "{flags}: {line:?}");
                    refused.extend(line.err());
                }
            }
        }
    }
    assert_eq!(refused.len(), 2 * (2 * 6 + 4 * 2 * 2));
}

#[test]
fn help_is_text_not_a_refusal() {
    for line in ["--help", "render --help", "--version", "help"] {
        assert!(matches!(words(line), Err(Stop::Text(_))), "{line}");
    }
}
