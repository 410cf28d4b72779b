//! What a file needs, told without firmware: the samples, what is beyond them, and what is printed.

use host_tests::args::{self, Command};
use host_tests::figures::gate;
use host_tests::firmware::BOARDS;
use host_tests::flashed::memory::cache_bytes;
use host_tests::image_out::{Frame, write_image};
use host_tests::lists::read_list;
use host_tests::lists::writer::{ListWriter, WriteError};
use host_tests::plan::chips::CHIPS;
use host_tests::plan::lists::camera;
use host_tests::plan::model::{Costs, Equations, Parts, Works, reckon, works};
use host_tests::plan::program::code_of;
use host_tests::plan::record::{Record, SLOTS, load, tally};
use host_tests::plan::samples::{LONGEST_SIDE, samples, write};
use host_tests::plan::shapes::Shape;
use host_tests::plan::{BOUND, Plan, scope};
use host_tests::scene_file::Loaded;
use scanbeam::list::{CameraWords, Flow, Material, State, Window};
use scenes::SmoothLook;
use serde_json::json;
use std::error::Error;
use std::path::{Path, PathBuf};

type Tried = Result<(), Box<dyn Error>>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Writes a scene of an object that is seen from so far.
fn scene_of(
    object: &serde_json::Value,
    distance: u32,
    folder: &Path,
) -> Result<PathBuf, Box<dyn Error>> {
    let scene = json!({
        "size": [320, 240],
        "format": "rgb565",
        "camera": { "eye": [0, 0, distance], "at": [0, 0, 0], "fov": 45 },
        "objects": [object],
    });
    let file = folder.join("s.json");
    std::fs::write(&file, scene.to_string())?;
    Ok(file)
}

/// Kills: a sample on record that is off by more than the bound, and is said to be within it.
#[test]
fn samples_are_reckoned_from_all_others() -> Tried {
    let record = Record::read(&Record::path())?;
    let (_, boards) = record.latest().ok_or("no record")?;
    assert!(BOARDS.iter().all(|board| boards.contains_key(board.name)));
    for (name, board) in boards {
        let bounded: Vec<_> = (board.samples.iter())
            .filter(|(_, known)| known.is_bounded())
            .collect();
        assert!(bounded.len() > 60, "{name}: {}", bounded.len());
        for (sample, known) in bounded {
            let off = (known.reckoned_without / known.measured - 1.0).abs();
            assert!(off <= BOUND, "{name}: {sample}: {off:.3}");
        }
    }
    Ok(())
}

/// Kills: costs on record that are a third higher than what samples take.
#[test]
fn costs_on_record_are_those_of_what_is_counted() -> Tried {
    let record = Record::read(&Record::path())?;
    let (_, boards) = record.latest().ok_or("no record")?;
    let folder = tempfile::tempdir()?;
    let all = samples(folder.path());
    write(folder.path(), &all)?;
    // One of each ten: they take their time.
    for sample in all.iter().step_by(10) {
        let flashed = load(folder.path(), sample)?;
        let counted = works(&tally(&flashed, &[SLOTS])?[0]);
        for (name, board) in boards {
            let known = board.samples.get(&sample.name).ok_or(sample.name.clone())?;
            assert!(counted.keys().all(|work| board.costs.contains_key(work)));
            let parts = Parts::of(&board.costs, &counted);
            let off = (reckon(&board.costs, &counted) / known.measured - 1.0).abs();
            let is_good = !parts.are_small() || off <= BOUND;
            assert!(is_good, "{name}: {}: {off:.3}", sample.name);
        }
    }
    Ok(())
}

/// Two works in three equations have what one of each takes, and none takes less than nothing.
#[test]
fn costs_are_what_equations_say_and_never_negative() {
    let works = |a: f64, b: f64| Works::from([("a".to_owned(), a), ("b".to_owned(), b)]);
    let solved = |all: &[(Works, f64)]| {
        let mut equations = Equations::default();
        for (works, cost) in all {
            equations.add(works, *cost, 1.0);
        }
        equations.solve()
    };
    let near = |costs: &Costs, name: &str, wanted: f64| (costs[name] - wanted).abs() < 0.01;
    let costs = solved(&[
        (works(1.0, 2.0), 70.0),
        (works(3.0, 1.0), 60.0),
        (works(4.0, 3.0), 130.0),
    ]);
    assert!(
        near(&costs, "a", 10.0) && near(&costs, "b", 30.0),
        "{costs:?}"
    );
    assert!((reckon(&costs, &works(2.0, 1.0)) - 50.0).abs() < 0.1);
    let costs = solved(&[(works(1.0, 0.0), 50.0), (works(1.0, 1.0), 40.0)]);
    assert_eq!(costs["b"], 0.0);
}

/// Values of scene files of which no costs are on record, each by itself.
#[test]
fn what_is_not_reckoned_is_told() -> Tried {
    let folder = tempfile::tempdir()?;
    let model = root().join("examples/scene-files/cube.obj");
    let tiles = root().join("examples/scene-files/tiles.png");
    let beyond = |object: serde_json::Value,
                  scene: serde_json::Value|
     -> Result<_, Box<dyn Error>> {
        let mut one = json!({ "model": model });
        let mut all = json!({ "size": [32, 32], "format": "rgb565", "camera": { "eye": [0, 0, 6], "at": [0, 0, 0], "fov": 45 } });
        for (to, from) in [(&mut one, object), (&mut all, scene)] {
            for (key, value) in from.as_object().into_iter().flatten() {
                to[key] = value.clone();
            }
        }
        all["objects"] = json!([{ "model": model }, one]);
        let file = folder.path().join("s.json");
        std::fs::write(&file, all.to_string())?;
        Ok(scope::beyond(&Loaded::load(&file)?.scene))
    };
    let none = json!({});
    let light = json!([{ "towards": [1, 2, 2] }]);
    let shadows = json!([{ "towards": [1, 2, 2], "shadows": true }]);
    assert_eq!(beyond(none.clone(), json!({ "lights": light }))?, None);
    assert_eq!(
        beyond(
            json!({ "texture": tiles, "cull": "back", "shade": "none" }),
            json!({ "lights": light })
        )?,
        None
    );
    for (object, scene, wanted) in [
        (none.clone(), json!({ "dither": true }), "dither"),
        (none.clone(), json!({ "doubled": true }), "doubled pictures"),
        (
            none.clone(),
            json!({ "phong": true, "lights": light }),
            "light at pixels",
        ),
        (none.clone(), json!({ "lights": shadows }), "shadows"),
        (
            json!({ "shade": "flat" }),
            json!({ "lights": light }),
            "flat faces",
        ),
        (json!({ "blend": "add" }), none.clone(), "blends"),
        (
            json!({ "depth": "farther" }),
            none.clone(),
            "tests of depth",
        ),
        (
            json!({ "priority": 1 }),
            none.clone(),
            "an order of draw calls",
        ),
        (
            json!({ "texture": tiles, "filter": "bilinear" }),
            none.clone(),
            "filters of textures",
        ),
        (
            json!({ "texture": tiles, "texel_form": "compressed" }),
            none.clone(),
            "textures in other forms",
        ),
        (
            json!({ "texture": tiles, "quality": "exact" }),
            none.clone(),
            "qualities of textures",
        ),
        (
            json!({ "texture": tiles, "levels": false }),
            none.clone(),
            "textures without levels",
        ),
    ] {
        assert_eq!(beyond(object, scene)?, Some(wanted));
    }
    Ok(())
}

/// A row by its whole name, a cell for each core.
#[test]
fn the_code_of_a_program_is_that_of_its_row() {
    let table = "| name | M4 |\n| One, more | 9 | 9 | 9 | 9 |\n| One | 1,234 | 2,000,567 | 30 | 4 / 4 | 5 |\n| Two | x | 1 | 1 |\n";
    assert_eq!(code_of(table, "One"), Some([1234, 2_000_567, 30]));
    assert_eq!(code_of(table, "Two"), None);
    assert_eq!(code_of(table, "Three"), None);
}

/// Clocks are those that the examples set up, and a cache is as large as the firmware has it.
#[test]
fn chips_and_caches_are_those_of_the_examples() -> Tried {
    let read = |path: &str| std::fs::read_to_string(root().join("examples").join(path));
    let stm = read("stm32f4/src/main.rs")?;
    assert!(stm.contains("sysclk(100.MHz())") && stm.contains("mode, 50.MHz()"));
    assert!(read("rp2040-two-cores/src/main.rs")?.contains("The bus runs at 62.5 MHz"));
    assert!(read("README.md")?.contains("At 125 MHz"));
    let known = CHIPS.map(|chip| (chip.clock, chip.bus));
    assert_eq!(
        known,
        [(100_000_000, 50_000_000), (125_000_000, 62_500_000)]
    );
    assert_eq!(CHIPS[1].by_clock(5e6), 25.0);
    assert!((CHIPS[1].by_bus([320, 240]) - 50.86).abs() < 0.01);
    // Depth and two lines beside it.
    let fast = gate::Record::read(&gate::Record::path())?.latest("m4", "fast small");
    let lines = 320 * 4 + 2 * 320 * 2;
    assert_eq!(
        fast,
        Some((cache_bytes::<SmoothLook>(SLOTS) + lines) as f64)
    );
    Ok(())
}

/// A list has bytes and instructions; slots are enough where one number less of those that were tried is not.
#[test]
fn a_list_has_bytes_and_slots() -> Tried {
    let record = Record::read(&Record::path())?;
    let plan = Plan::of(&root().join("examples/scenes/teapot.list"), SLOTS, &record)?;
    assert_eq!(plan.beyond, None);
    for board in &plan.boards {
        let reckoned = board.reckoned.ok_or(board.name)?;
        // Half of its 2,256 triangles are turned away, and a triangle that is drawn takes more than 600.
        assert!(reckoned.is_within && reckoned.instructions > 1128.0 * 600.0);
        assert!(board.slow_bytes > 20_000);
    }
    let enough = plan.enough().ok_or("there are slots enough")?;
    let at = plan
        .rows
        .iter()
        .position(|row| row == enough)
        .ok_or("it is a row")?;
    assert!(50 * enough.without <= enough.spans);
    assert!(at > 0 && 50 * plan.rows[at - 1].without > enough.spans);
    Ok(())
}

/// Lists that have what there are no costs of, each by itself.
#[test]
fn what_is_not_reckoned_of_lists_is_told() -> Tried {
    let folder = tempfile::tempdir()?;
    let record = Record::read(&Record::path())?;
    let teapot = read_list(&root().join("examples/scenes/teapot.list"))?;
    let beyond = |front: &[u32], rest: &[u32]| -> Result<_, Box<dyn Error>> {
        let words = front.iter().chain(rest);
        let bytes: Vec<u8> = words.flat_map(|word| word.to_ne_bytes()).collect();
        let file = folder.path().join("one.list");
        std::fs::write(&file, bytes)?;
        Ok(Plan::of(&file, SLOTS, &record)?.beyond)
    };
    let words_of = |write: &dyn Fn(&mut ListWriter<'_>) -> Result<(), WriteError>| {
        let mut memory = [0; 64];
        let mut writer = ListWriter::new(&mut memory);
        write(&mut writer).map(|()| writer.words().to_vec())
    };
    let of_material = |material| words_of(&|writer| writer.state(&State::Material(material)));
    let shiny = of_material(Material {
        specular: [9; 3],
        ..Material::default()
    })?;
    let clear = of_material(Material {
        opacity: 254,
        ..Material::default()
    })?;
    // Over a word that is no block.
    let mut jump = words_of(&|writer| writer.flow(Flow::JumpRelative(1)))?;
    jump.push(u32::MAX);
    let window = Window {
        left: 0,
        top: 0,
        right: 300,
        bottom: 200,
    };
    let cut = words_of(&|writer| writer.state(&State::Window(window)))?;
    for (front, wanted) in [
        (shiny, Some("highlights")),
        (clear, Some("blends")),
        (jump, Some("jumps of lists")),
        (cut, Some("windows")),
        (Vec::new(), None),
    ] {
        assert_eq!(beyond(&front, &teapot)?, wanted);
    }
    let crates = read_list(&root().join("examples/scenes/crate.list"))?;
    assert_eq!(beyond(&[], &crates)?, Some("textures of lists"));
    let parts = read_list(&root().join("examples/scenes/teapot_meshlets.list"))?;
    assert_eq!(beyond(&[], &parts)?, None);
    // It looks away, so that the teapot is out of sight.
    let away = words_of(&|writer| {
        writer.state(&State::Camera(CameraWords {
            at: [0.0, 0.0, 6.0],
            ..camera([0.0, 0.0, 3.0])
        }))
    })?;
    let several = Some("tables that are drawn several times, or not at all");
    assert_eq!(beyond(&away, &teapot)?, several);
    Ok(())
}

/// Kills: pictures of any side pass for those of the samples.
#[test]
fn textures_larger_than_those_of_samples_have_no_bound() -> Tried {
    let folder = tempfile::tempdir()?;
    let record = Record::read(&Record::path())?;
    let ball = Shape::Ball(16, 24);
    std::fs::write(folder.path().join(ball.file()), ball.to_obj())?;
    for side in [LONGEST_SIDE, 2 * LONGEST_SIDE] {
        let picture = folder.path().join(format!("{side}.png"));
        let texels = vec![99; 3 * (side * side) as usize];
        write_image(
            &picture,
            &Frame::new(side, side, texels).ok_or("a picture")?,
        )?;
        let object = json!({ "model": ball.file(), "texture": picture, "cull": "back" });
        // So far away that its triangles are small with either.
        let file = scene_of(&object, 8, folder.path())?;
        let plan = Plan::of(&file, SLOTS, &record)?;
        for board in &plan.boards {
            let is_within = board.reckoned.ok_or("it is reckoned")?.is_within;
            assert_eq!(is_within, side == LONGEST_SIDE, "{side}: {}", board.name);
        }
    }
    Ok(())
}

/// A plan is of a scene file or a list, of no more slots than there are, or writes the record.
#[test]
fn a_plan_has_a_file() {
    let parsed = |line: &str| args::parse(std::iter::once("scanbeam").chain(line.split(' ')));
    let planned = parsed("plan s.json --slots 32 --json");
    assert!(matches!(planned, Ok(Command::Plan(args)) if args.slots == Some(32) && args.json));
    assert!(matches!(parsed("plan --bless"), Ok(Command::Plan(args)) if args.bless));
    for line in [
        "plan",
        "plan m.obj",
        "plan s.json --slots 225",
        "plan s.json --bless",
    ] {
        assert!(parsed(line).is_err(), "{line}");
    }
}

/// What is printed, as a table and as JSON: of a scene that is reckoned and of one that is not.
#[test]
fn plans_are_printed() -> Tried {
    let folder = tempfile::tempdir()?;
    let ball = root().join("examples/scene-files/ball.obj");
    let file = scene_of(&json!({ "model": ball, "cull": "back" }), 6, folder.path())?;
    let said = |file: &Path, flag: &str| -> Result<String, Box<dyn Error>> {
        let mut tool = std::process::Command::new(env!("CARGO_BIN_EXE_scanbeam"));
        let output = tool
            .arg("plan")
            .arg(file)
            .args(flag.split_whitespace())
            .output()?;
        assert_eq!(
            (output.status.code(), output.stderr.len()),
            (Some(0), 0),
            "{output:?}"
        );
        Ok(String::from_utf8(output.stdout)?)
    };
    let table = said(&file, "")?;
    for words in [
        "320 x 240, 1 draw calls of 224 triangles",
        "Gouraud, plain",
        "within 10 %",
        "slots are enough",
        "RP2040, one core",
    ] {
        assert!(table.contains(words), "{words}: {table}");
    }
    let report: serde_json::Value = serde_json::from_str(&said(&file, "--json --slots 16")?)?;
    // The cache of 32 slots, and the depth of a line.
    assert_eq!(
        report["fast_bytes"],
        json!(cache_bytes::<SmoothLook>(32) + 320 * 4)
    );
    assert_eq!(report["boards"][2]["board"], "m0plus");
    assert_eq!(report["boards"][2]["within_bound"], false);
    let took = report["boards"][2]["instructions"]
        .as_f64()
        .ok_or("instructions")?;
    assert_eq!(
        report["chips"][1]["most_by_clock"]
            .as_f64()
            .map(|rate| (rate * took / 1e6).round()),
        Some(125.0)
    );
    let room = root().join("examples/scene-files/room.json");
    assert!(said(&room, "")?.contains("not reckoned: dither"));
    let report: serde_json::Value = serde_json::from_str(&said(&room, "--json")?)?;
    assert_eq!(report["not_reckoned"], "dither");
    assert!(
        report["boards"][0]["instructions"].is_null()
            && report["chips"][0]["most_by_clock"].is_null()
    );
    assert_eq!(report["program"], "Textured");
    Ok(())
}
