//! What a file needs, told without firmware: the samples, what is beyond them, and what is printed.

use host_tests::args::{self, Command};
use host_tests::figures::gate;
use host_tests::firmware::BOARDS;
use host_tests::flashed::memory::cache_bytes;
use host_tests::image_out::{Frame, write_image};
use host_tests::plan::chips::CHIPS;
use host_tests::plan::model::{Costs, Equations, Parts, Works, reckon, works};
use host_tests::plan::program::code_of;
use host_tests::plan::record::{Record, SLOTS, load, tally};
use host_tests::plan::samples::{LONGEST_SIDE, samples, write};
use host_tests::plan::shapes::Shape;
use host_tests::plan::{BOUND, Plan, scope};
use host_tests::scene_file::Loaded;
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

/// A list has no instructions reckoned; slots are enough where one number less of those that were tried is not.
#[test]
fn a_list_has_bytes_and_slots() -> Tried {
    let record = Record::read(&Record::path())?;
    let plan = Plan::of(&root().join("examples/scenes/teapot.list"), SLOTS, &record)?;
    assert_eq!(plan.beyond, Some("lists"));
    assert!(
        plan.boards
            .iter()
            .all(|board| board.reckoned.is_none() && board.slow_bytes > 20_000)
    );
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
