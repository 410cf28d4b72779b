//! What is read, and what is refused.

use super::*;
use crate::draw::CrewSettings;
use crate::reference::{Cull, Shade, View};
use scanbeam::scene::Budget;

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
    use clap::CommandFactory;
    Cli::command().debug_assert();
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
    };
    assert_eq!(words("demo -o d --frames 3"), Ok(Command::Demo(demo)));
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
fn bad_lines_are_refused_in_one_line() {
    for flags in [
        "--size 0x10",
        "--size 10x0",
        "--size 8193x1",
        "--size 1x8193",
        "--size 10",
        "--size -1x5",
        "--size ax5",
        "--size 99999999999x1",
        "--size 1x2x3",
        "--eye 1,2",
        "--eye 1,2,3,4",
        "--eye nan,0,0",
        "--eye inf,0,0",
        "--eye 1e999,0,0",
        "--eye 1e300,0,0",
        "--eye",
        "--eye --at 0,0,0",
        "--eye 0,0,0",
        "--at 0,0,3",
        "--up 0,0,0",
        "--up 0,0,-2",
        "--up nan,0,0",
        "--fov 0",
        "--fov 180",
        "--fov -10",
        "--fov nan",
        "--near 0",
        "--near -1",
        "--near 100",
        "--far 0.1",
        "--far inf",
        "--far 0.05",
        "--light 0,0,0",
        "--light 1,1",
        "--ambient -0.1",
        "--ambient 1.1",
        "--ambient x",
        "--shade toon",
        "--shade",
        "--cull front",
        "--format rgb666",
        "--interp fast",
        "--interp lirp",
        "--interp",
        "--quality best",
        "--quality 1",
        "--background 256,0,0",
        "--background -1,0,0",
        "--background 1,2",
        "--background 1.5,0,0",
        "--cache -1",
        "--cache 4096",
        "--renderers 0",
        "--renderers 17",
        "--prefetch -1",
        "--unknown",
        "--unknown 3",
        "--texture",
        "--texture o.png",
        "--texture a.png --interp model",
        "--filter best",
        "--size 1x1 --size 2x2",
        "extra",
        "-o p.png",
        "--stats o.png",
        "--stats m.obj",
    ] {
        match words(&format!("render m.obj -o o.png {flags}")) {
            Err(Stop::Refused(line)) => {
                assert!(line.starts_with("error: "), "{flags}: {line}");
                assert!(!line.contains('\n') && line.len() > 15, "{flags}: {line}");
            }
            other => panic!("{flags}: {other:?}"),
        }
    }
    for line in [
        "render",
        "render m.obj",
        "render -o o.png",
        "render m.obj -o",
        "render m.obj -o o.bmp",
        "render m.obj -o o",
        "render m.png -o m.png",
        "paint",
        "--unknown",
        "demo --frames 0",
        "demo --frames 1001",
        "demo --frames -1",
        "demo x",
        "trace m.obj",
        "trace --line 3",
        "trace m.obj --line 240",
        "trace m.obj --line -1",
        "trace m.obj --line 65536",
        "trace m.obj --line 3 --size 4x3",
        "trace m.obj --line 3 --fov 0",
        "trace m.obj --line 3 -o x.png",
        "firmware --jsn",
        "bake m.obj",
        "bake m.stl -o m.list",
        "bake m.obj -o m.obj",
        "bake m.obj -o m.list --error 0",
        "bake m.obj -o m.list --error nan",
        "bake m.obj -o m.list --normals maybe",
        "compress t.png",
        "compress t.png -o t.png",
        "compress -o t.bc1",
        "run-list m.list",
        "run-list m.list -o m.list",
        "run-list m.list -o m.png --print",
        "run-list m.list -o m.png --budget -1",
        "run-list m.list -o m.png --size 0x1",
        "disassemble",
        "disassemble m.list x",
        "firmware x",
        "firmware --symbols",
        "firmware --function a",
        "firmware --board m4",
        "firmware --profile",
        "firmware --profile cube --board m7",
        "firmware --profile cube --sizes",
        "budgets x",
        "--frames 3",
    ] {
        match words(line) {
            Err(Stop::Refused(text)) => assert!(!text.contains('\n'), "{line}: {text}"),
            other => panic!("{line}: {other:?}"),
        }
    }
    let broken = parse(["scanbeam", "render", "a\nb.obj", "-o", "c\n\nd.bmp"]);
    assert!(matches!(broken, Err(Stop::Refused(text)) if !text.contains('\n')));
}

#[test]
fn refusals_say_what_is_wrong() {
    let refusal = |flags: &str| match words(&format!("render m.obj -o o.png {flags}")) {
        Err(Stop::Refused(line)) => line,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        refusal("--size 0x4"),
        "error: invalid value '0x4' for '--size <WxH>': WIDTHxHEIGHT is needed, each 1 to 8192"
    );
    assert_eq!(
        refusal("--eye 0,0,0"),
        "error: eye and at are the same place"
    );
    assert_eq!(
        refusal("--up 0,0,5"),
        "error: up is parallel to the view direction"
    );
    assert_eq!(refusal("--near 5 --far 5"), "error: near must be below far");
    assert_eq!(
        refusal("--dither on --format grey8"),
        "error: --dither on needs --format rgb565"
    );
    assert_eq!(
        refusal("--shadows on --depth priority"),
        "error: --depth priority has no --shadows on, which are found by depth"
    );
    for method in [
        "--interp plane",
        "--interp model",
        "--depth block-fix",
        "--depth word",
    ] {
        for (flags, what) in [
            (
                "--cache 3",
                "has no --cache, --renderers, --prefetch or --quality",
            ),
            (
                "--renderers 2",
                "has no --cache, --renderers, --prefetch or --quality",
            ),
            (
                "--prefetch 8",
                "has no --cache, --renderers, --prefetch or --quality",
            ),
            (
                "--quality fast",
                "has no --cache, --renderers, --prefetch or --quality",
            ),
            (
                "--shadows on",
                "has no --texture, --specular, --shadows on or --shade phong",
            ),
            (
                "--texture x.png",
                "has no --texture, --specular, --shadows on or --shade phong",
            ),
            (
                "--shade phong",
                "has no --texture, --specular, --shadows on or --shade phong",
            ),
            (
                "--format grey8",
                "needs --format rgb888 or rgb565, and --dither off",
            ),
            (
                "--format rgb565 --dither on",
                "needs --format rgb888 or rgb565, and --dither off",
            ),
        ] {
            let line = refusal(&format!("{method} {flags}"));
            assert_eq!(line, format!("error: {method} {what}"));
        }
    }
    for depth in ["z32", "id", "priority", "block-fix", "word"] {
        assert_eq!(
            refusal(&format!("--interp plane --depth {depth}")),
            "error: --interp plane has no --depth: its own is what it is"
        );
    }
    assert_eq!(
        refusal("--format mono --texture x.png"),
        "error: --texture needs --format rgb888, rgb565 or xrgb8888"
    );
    assert_eq!(
        refusal("--specular 0.5,8"),
        "error: --specular needs --shade flat, gouraud or phong"
    );
    for wrong in ["0.5", "1.5,8", "0.5,-1", "0.5,8.5", "a,b"] {
        let line = refusal(&format!("--shade flat --specular {wrong}"));
        assert!(line.contains("S,N"), "{line}");
    }
    assert_eq!(
        refusal("--textures x.png"),
        "error: unexpected argument '--textures' found"
    );
    assert_eq!(
        words("render"),
        Err(Stop::Refused(
            "error: the following required arguments were not provided: --output <OUT> <MODEL.obj>"
                .into()
        ))
    );
}

#[test]
fn flags_that_would_do_nothing_are_refused() {
    let refusal = |line: &str| match words(line) {
        Err(Stop::Refused(line)) => line,
        other => panic!("{line}: {other:?}"),
    };
    for format in ["rgb565", "xrgb8888", "grey8", "mono"] {
        assert_eq!(
            refusal(&format!("run-list m.list -o o.png --format {format}")),
            "error: run-list has no --format but rgb888"
        );
        assert_eq!(
            refusal(&format!("trace m.obj --line 3 --format {format}")),
            "error: trace has no --format but rgb888: tokens come before pixels"
        );
    }
    assert_eq!(
        refusal("run-list m.list -o o.png --shade phong"),
        "error: run-list has no --shade phong: lists are lit at corners"
    );
    // What prints a list draws nothing.
    for flag in [
        "--budget 3",
        "--size 3x3",
        "--eye 1,2,3",
        "--at 1,2,3",
        "--up 0,0,1",
        "--fov 50",
        "--near 1",
        "--far 9",
        "--light 1,2,3",
        "--ambient 0.1",
        "--shade flat",
        "--cull back",
        "--format rgb888",
        "--background 1,2,3",
    ] {
        let line = refusal(&format!("run-list m.list --print {flag}"));
        let name = flag.split(' ').next().unwrap();
        assert!(line.contains("--print") && line.contains(name), "{line}");
    }
    for line in [
        "run-list m.list --print",
        "run-list m.list -o o.png --format rgb888 --shade gouraud",
        "trace m.obj --line 3 --format rgb888",
    ] {
        assert!(words(line).is_ok(), "{line}");
    }
}

#[test]
fn help_is_text_not_a_refusal() {
    for line in ["--help", "render --help", "--version", "help"] {
        assert!(matches!(words(line), Err(Stop::Text(_))), "{line}");
    }
}
