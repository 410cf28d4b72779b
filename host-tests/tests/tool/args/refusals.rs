//! What is refused, and how that is said.

use super::*;

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
        "firmware m.obj",
        "firmware s.json t.json",
        "firmware s.json --bench",
        "firmware s.json --bench --bless",
        "firmware s.json --sizes",
        "firmware s.json --profile cube",
        "firmware s.json --board m7",
        "firmware s.json -o out",
        "firmware s.json --bless",
        "firmware s.json --markdown",
        "firmware s.json --symbols",
        "firmware s.json --function a",
        "firmware --symbols",
        "firmware --function a",
        "firmware --board m4 --sizes",
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
    for flags in ["--renderers 2", "--prefetch 8", "--depth z32"] {
        assert_eq!(
            refusal(&format!("--pace 9000 --format rgb565 {flags}")),
            "error: --pace has no --renderers, --prefetch or --depth"
        );
    }
    for flags in [
        "",
        "--format grey8",
        "--format rgb565 --dither on",
        "--format rgb565 --filter bilinear",
        "--format rgb565 --shadows on",
        "--format rgb565 --specular 1,2",
        "--format rgb565 --shade phong",
    ] {
        let line = refusal(&format!("--pace 9000 {flags}"));
        assert!(line.ends_with("no other costs are known"), "{line}");
    }
    for method in [
        "--interp plane",
        "--interp model",
        "--depth block-fix",
        "--depth word",
    ] {
        for (flags, what) in [
            (
                "--cache 3",
                "has no --cache, --renderers, --prefetch, --pace or --quality",
            ),
            (
                "--renderers 2",
                "has no --cache, --renderers, --prefetch, --pace or --quality",
            ),
            (
                "--prefetch 8",
                "has no --cache, --renderers, --prefetch, --pace or --quality",
            ),
            (
                "--pace 9000",
                "has no --cache, --renderers, --prefetch, --pace or --quality",
            ),
            (
                "--quality fast",
                "has no --cache, --renderers, --prefetch, --pace or --quality",
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
