//! Scenes as boards have them: nothing of a file is left out, they take as little memory as they can, and boards draw the
//! same bits.

mod lists;
mod planned_lists;
mod plans;

use host_tests::firmware::{BOARDS, Board, M4, Measured, Output, Section, Sections, Toolchain};
use host_tests::flashed::host::{frame, grow, settle};
use host_tests::flashed::list;
use host_tests::flashed::*;
use host_tests::image_out::{Frame, write_image};
use scanbeam::list::Lent;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scene_flash::{FLASH_AT, Kind};
use serde_json::{Value, json};
use std::error::Error;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

type Tried = Result<(), Box<dyn Error>>;

/// A file of the examples.
fn example(name: &str) -> PathBuf {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    examples.join(name)
}

/// The words of a scene.
fn loaded(folder: &TempDir, scene: &Value) -> Result<Flashed, Box<dyn Error>> {
    let file = folder.path().join("s.json");
    std::fs::write(&file, scene.to_string())?;
    Flashed::load(&file)
}

/// A textured pane behind a cube behind a pane that is blended, each over some of the one before it.
fn scene() -> Value {
    let file = |name: &str| json!(example("scene-files").join(name));
    json!({
        "size": [64, 48],
        "format": "rgb565",
        "background": [24, 32, 48],
        "camera": { "eye": [0, 0, 6], "at": [0, 0, 0], "fov": 45 },
        "ambient": 0.3,
        "lights": [{ "towards": [1, 2, 2], "colour": [0.8, 0.75, 0.7] }],
        "objects": [
            { "model": file("pane.obj"), "texture": file("tiles.png"), "scale": 2, "place": [0, 0, -1] },
            { "model": file("cube.obj"), "turn": [20, 30, 0] },
            { "model": file("pane.obj"), "place": [0.5, 0, 2], "blend": "filter", "alpha": 100 }
        ]
    })
}

/// Kills: another frame than the one that is counted, the making of the scene with it, a frame of the firmware's own.
#[test]
fn scenes_are_stepped_through() -> Tried {
    let folder = tempfile::tempdir()?;
    let (flashed, file) = (loaded(&folder, &scene())?, folder.path().join("s.json"));
    let toolchain = Toolchain::find()?;
    let measured = flashed.measure(&toolchain, &[M4], &file)?;
    let counted = measured[0].output.frames[0].instructions;
    let stepped = flashed.step(&toolchain, &M4, &file)?.instructions();
    // Some ten for each of 48 lines that are handed on.
    assert!(counted.abs_diff(stepped) < 1_000, "{counted} {stepped}");
    Ok(())
}

/// Kills: a value that the words leave out or mistake (a blend for another, the window's other side, a function's bits,
/// the functions of colour and depth for each other, an ambient light of its own, a texture of another object, the second
/// light): `load` fails where the picture is another than that of `render`.
#[test]
fn all_that_a_file_says_is_in_the_words() -> Tried {
    let folder = tempfile::tempdir()?;
    let plain = loaded(&folder, &scene())?.shown.pixels;
    let window = |outside: bool| json!({ "left": 30, "top": 9, "width": 9, "height": 30, "outside": outside });
    // Another one than that of the first object.
    let frame = Frame::new(4, 4, vec![250; 48]).ok_or("sides")?;
    write_image(&folder.path().join("white.png"), &frame)?;
    let second = json!([{ "towards": [1, 2, 2] }, { "towards": [-1, 0, 1], "colour": [0, 0, 1] }]);
    // Of an object, by its number, or of the scene.
    let changes = [
        (Some(2), "blend", json!("add")),
        (Some(2), "blend", json!("subtract")),
        (Some(2), "alpha", json!(200)),
        (Some(1), "blend", json!("half")),
        (
            Some(1),
            "blend",
            json!({ "factors": { "source": "one", "destination": "destination" } }),
        ),
        (
            Some(1),
            "blend",
            json!({ "factors": { "source": { "constant": 90 }, "destination": "inverse_destination" } }),
        ),
        (Some(1), "channels", json!([true, false, true])),
        (Some(0), "reflection", json!(true)),
        (Some(0), "filter", json!("bilinear")),
        (Some(0), "application", json!("replace")),
        (Some(1), "shade", json!("none")),
        (Some(1), "depth", json!("never")),
        (Some(2), "depth", json!("farther")),
        (Some(1), "depth", json!("farther_or_equal")),
        (Some(0), "depth", json!("farther")),
        (Some(1), "writes_depth", json!(false)),
        (Some(0), "priority", json!(3)),
        (Some(1), "window", window(false)),
        (Some(1), "window", window(true)),
        (Some(2), "texture", json!("white.png")),
        (Some(0), "turn", json!([0, 40, 15])),
        (None, "dither", json!(true)),
        (None, "ambient", json!(0.9)),
        (None, "lights", second),
        (None, "background", json!([200, 0, 0])),
        (None, "size", json!([63, 47])),
    ];
    for (object, key, value) in changes {
        let mut other = scene();
        match object {
            Some(number) => other["objects"][number][key] = value.clone(),
            None => other[key] = value.clone(),
        }
        let said = format!("{key} {value}");
        let shown = loaded(&folder, &other).map_err(|error| format!("{said}: {error}"))?;
        assert!(shown.shown.pixels != plain, "{said}");
    }
    // A cube is as flat as it can be.
    let mut round = scene();
    round["objects"][1]["model"] = json!(example("scene-files/ball.obj"));
    let smooth = loaded(&folder, &round)?.shown.pixels;
    round["objects"][1]["shade"] = json!("flat");
    assert!(loaded(&folder, &round)?.shown.pixels != smooth);
    // What shows its back is dropped.
    let mut turned = scene();
    turned["objects"][2]["turn"] = json!([0, 180, 0]);
    let seen = loaded(&folder, &turned)?.shown.pixels;
    turned["objects"][2]["cull"] = json!("back");
    assert!(loaded(&folder, &turned)?.shown.pixels != seen);
    Ok(())
}

/// Kills: memory that is lent in full, memory for vertices of which nothing is kept in the end, and a draw call without a
/// state.
#[test]
fn a_scene_takes_as_little_memory_as_it_can() -> Tried {
    let folder = tempfile::tempdir()?;
    let mut scene = scene();
    // Some of it is behind the eye.
    scene["objects"][0]["scale"] = json!(40);
    scene["objects"][0]["turn"] = json!([-90, 0, 0]);
    let seen = loaded(&folder, &scene)?.shown.head.room;
    // The last one shows its back.
    scene["objects"][2]["turn"] = json!([0, 180, 0]);
    scene["objects"][2]["cull"] = json!("back");
    let flashed = loaded(&folder, &scene)?;
    let room = flashed.shown.head.room;
    assert_eq!((room.draws, room.objects), (3, seen.objects - 2));
    assert!(room.vertices <= seen.vertices + 2, "{room:?} {seen:?}");
    let drawn = |room| frame(&flashed.words, &[0, 1, 2], room);
    assert!(drawn(room)?.pixels == flashed.shown.pixels);
    for (vertices, objects, draws) in [(4, 0, 0), (0, 1, 0), (0, 0, 1)] {
        let less = scene_flash::Room {
            vertices: room.vertices - vertices,
            objects: room.objects - objects,
            draws: room.draws - draws,
        };
        let error = drawn(less)
            .map(|_| ())
            .expect_err("there is too little room");
        let error = error.to_string();
        assert!(error.contains("object "), "{error}");
    }
    Ok(())
}

/// Kills: pictures in another form than the file says, levels, keys, masks and palettes that are mistaken for each other,
/// light at corners instead of pixels, a surface's highlights on another one, shadows that are left out or fall from
/// another light, what is drawn again where it is not in the shadow, and a picture that is not doubled: `load` fails where
/// the picture is another than that of `render`.
#[test]
fn textures_of_all_forms_highlights_shadows_and_doubled_pictures_are_in_the_words() -> Tried {
    let folder = tempfile::tempdir()?;
    let squares =
        json!({ "squares": { "size": [8, 8], "side": 2, "colours": [[0, 0, 0], [9, 9, 9]] } });
    let gradient = json!({ "gradient": { "size": [8, 8], "from": [0, 9, 0], "to": [200, 9, 9], "length": 8 } });
    let star = json!(example("scene-files").join("star.png"));
    let glow = json!(example("scene-files").join("glow.png"));
    // Of the scene, or of an object: what is another picture each time.
    let changes = [
        json!({}),
        json!({ "phong": true }),
        json!({ "doubled": true }),
        json!({ "shadows": true }),
        json!({ "shadows": true, "phong": true }),
        json!({ "shadows": true, "doubled": true }),
        json!({ "object": 0, "computed": squares }),
        json!({ "object": 0, "computed": gradient }),
        json!({ "object": 0, "texture": star, "texels": "cutout" }),
        json!({ "object": 0, "texture": star, "texels": "cutout", "texel_form": "compressed", "reflection": true }),
        json!({ "object": 0, "texture": glow, "texels": "alpha", "blend": "add" }),
        json!({ "object": 1, "specular": 0.5 }),
        json!({ "object": 1, "specular": 0.5, "shininess": 3 }),
        json!({ "object": 1, "specular": [0.5, 0, 0], "shininess": 3 }),
    ];
    let with = |change: &Value| -> Result<Vec<u16>, Box<dyn Error>> {
        let mut scene = scene();
        scene["objects"][1]["model"] = json!(example("scene-files/ball.obj"));
        let all = change.as_object().into_iter().flatten();
        for (key, value) in all.filter(|(key, _)| *key != "object") {
            match (change["object"].as_u64(), &key[..]) {
                (Some(number), _) => scene["objects"][number as usize][key] = value.clone(),
                (None, "shadows") => scene["lights"][0]["shadows"] = value.clone(),
                (None, _) => scene[key] = value.clone(),
            }
            if key == "computed" {
                scene["objects"][0]
                    .as_object_mut()
                    .map(|item| item.remove("texture"));
            }
        }
        let shown = loaded(&folder, &scene);
        let shown = shown.map_err(|error| format!("{change}: {error}"))?.shown;
        assert_eq!(shown.head.sent(), [64, 48], "{change}");
        Ok(shown.pixels)
    };
    let mut pictures = Vec::new();
    for change in &changes {
        let picture = with(change)?;
        assert_eq!(picture.len(), 64 * 48, "{change}");
        assert!(!pictures.contains(&picture), "{change}");
        pictures.push(picture);
    }
    // The same texels in another form, with and without a cache.
    let tiles = |more: &str| {
        let mut change = json!({ "object": 0, "texel_form": "compressed" });
        change[more] = json!(true);
        with(&change)
    };
    assert!(tiles("cached")? == tiles("levels")?);
    let palette = with(
        &json!({ "object": 0, "texture": star, "texels": "cutout", "texel_form": "palette" }),
    )?;
    assert!(palette == pictures[8]);
    with(
        &json!({ "object": 0, "texture": star, "texels": "alpha", "texel_form": "palette", "blend": "filter" }),
    )?;
    Ok(())
}

/// Kills: queues that are drained in another order than that of their sources, one that loses what finds no room, and a
/// call that is named by another one's number.
#[test]
fn calls_come_in_the_order_of_their_sources() -> Tried {
    let folder = tempfile::tempdir()?;
    let pane = |x: f64, alpha: u8, source: Value| {
        json!({ "model": example("scene-files").join("pane.obj"),
        "place": [x, 0, 0], "blend": "filter", "alpha": alpha, "source": source })
    };
    let of = |objects: Vec<Value>| {
        let mut all = scene();
        all["objects"] = json!(objects);
        loaded(&folder, &all)
    };
    // Of a source that says more than a queue has room for, and of two before it.
    let with = |sources: [Value; 6], order: [usize; 6]| {
        let panes = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5].map(|x| (x, 60 + (200.0 * x) as u8));
        of(order
            .map(|i| pane(panes[i].0, panes[i].1, sources[i].clone()))
            .to_vec())
    };
    let numbers = [3, 0, 3, 3, 1, 3].map(Value::from);
    let said = with(numbers, [0, 1, 2, 3, 4, 5])?;
    let none = [(); 6].map(|()| Value::Null);
    let direct = with(none.clone(), [1, 4, 0, 2, 3, 5])?;
    assert!(said.shown.pixels == direct.shown.pixels);
    assert_eq!(said.shown.head, direct.shown.head);
    let as_it_stands = with(none, [0, 1, 2, 3, 4, 5])?;
    assert!(said.shown.pixels != as_it_stands.shown.pixels);
    // The third of them all finds no room.
    let room = scene_flash::Room {
        objects: 5,
        ..said.shown.head.room
    };
    let error = frame(&said.words, &[10, 11, 12, 13, 14, 15], room);
    let error = error.map(|_| ()).expect_err("too little").to_string();
    assert!(error.starts_with("object 12: "), "{error}");
    Ok(())
}

/// Kills: a picture that is drawn in part where one scene does not hold it.
#[test]
fn what_is_larger_than_a_board_draws_is_refused() -> Tried {
    let folder = tempfile::tempdir()?;
    let mut large = scene();
    large["size"] = json!([1020, 48]);
    let said = loaded(&folder, &large).map(|_| ()).expect_err("its size");
    let end = "s.json: `size` is 1020 x 48: boards draw at most 1016 columns and lines at once";
    assert!(said.to_string().ends_with(end), "{said}");
    Ok(())
}

/// Draws a file on boards, which have to draw what this machine does; what pass one takes on each.
///
/// Kills: another scene than the one that lies in flash, a board that draws nothing, calls that are left out, palettes in
/// another order, figures that are not of the scene, and code that reaches to where the scene lies.
fn drawn_on(file: &str, kind: Kind, asked: &[Board]) -> Result<Vec<u64>, Box<dyn Error>> {
    let toolchain = Toolchain::find()?;
    let file = example(file);
    let flashed = Flashed::load(&file)?;
    assert_eq!(flashed.shown.head.kind, kind);
    let boards = flashed.measure(&toolchain, asked, &file)?;
    assert_eq!(boards.len(), asked.len());
    for board in &boards {
        let name = format!("{} on {}", file.display(), board.board.name);
        assert!(flashed.matches(board), "{name}");
        let (frame, lines) = (&board.output.frames[0], &board.output.lines[0]);
        assert_eq!(lines.costs.len(), 240, "{name}");
        assert!(lines.pass_one > 4000, "{name}: {}", lines.pass_one);
        // Each line may be a tick off.
        let sum = lines.pass_one + lines.costs.iter().sum::<u64>();
        let apart = sum.abs_diff(frame.instructions);
        assert!(
            apart <= frame.instructions / 10,
            "{name}: {sum} of {}",
            frame.instructions
        );
        plans::bytes_are_as_planned(&flashed, board)?;
    }
    let passes = boards.iter().map(|board| board.output.lines[0].pass_one);
    Ok(passes.collect())
}

#[test]
fn boards_draw_what_this_machine_draws() -> Tried {
    drawn_on("scene-files/room.json", Kind::Textured, &BOARDS)?;
    drawn_on("scene-files/dusk.json", Kind::Indexed, &BOARDS[1..])?;
    drawn_on("scene-files/court.json", Kind::TexturedPhong, &[M4])?;
    drawn_on("scene-files/yard.json", Kind::Textured, &BOARDS[2..])?;
    drawn_on("scene-files/cards.json", Kind::Textured, &[M4])?;
    Ok(())
}

/// Kills: a board whose frame has other bits, or that has drawn none, and is said to match.
#[test]
fn another_checksum_is_told() -> Tried {
    let mut flashed = Flashed::load(&example("scene-files/dusk.json"))?;
    let frame = |crc| format!("frame scene=scene crc={crc:08x} instructions=1");
    let board = |lines: &[String]| -> Result<Measured, Box<dyn Error>> {
        Ok(Measured {
            board: M4,
            sections: Sections::default(),
            output: Output::parse(lines)?,
        })
    };
    let drawn = board(&[frame(flashed.shown.crc()), "done frames=1".into()])?;
    assert!(flashed.matches(&drawn));
    assert!(!flashed.matches(&board(&["done frames=0".into()])?));
    flashed.shown.pixels[0] ^= 1;
    assert!(!flashed.matches(&drawn));
    Ok(())
}

/// Kills: a picture that is not held against that of `render`, or of which the end is not.
#[test]
fn a_picture_that_is_not_that_of_render_is_told() {
    let words = [Rgb565Be::from_rgb8([8, 4, 0]); 2];
    let rgb: Vec<u8> = words
        .iter()
        .flat_map(|word| Rgb565Be::to_rgb8(*word))
        .collect();
    assert_eq!(is_as_rendered(&words, &rgb), Ok(()));
    let mut other = rgb.clone();
    other[5] ^= 1;
    let said = is_as_rendered(&words, &other).unwrap_err();
    assert!(said.contains("1 levels of pixels differ"), "{said}");
    assert!(is_as_rendered(&words[..1], &rgb).is_err());
    assert!(is_as_rendered(&words, &rgb[..3]).is_err());
}

/// Kills: memory that is asked for and not there, of the boards and of a player whose memory grows, and code that reaches
/// to where the scene lies.
#[test]
fn what_boards_have_no_memory_for_is_refused_with_how_much_it_is() -> Tried {
    let file = Path::new("s.json");
    let flashed = Flashed::load(&example("scene-files/dusk.json"))?;
    let needed = flashed.shown.slow_bytes as u64;
    let with_slow = |left: u64| Sections {
        slow: Section {
            address: 0x2100_0000,
            bytes: (16 << 20) - left,
        },
        ..Sections::default()
    };
    assert_eq!(flashed.fits(&with_slow(needed), file), Ok(()));
    let left = needed - 1;
    let want =
        format!("s.json: needs {needed} bytes of slow memory, the emulated boards have {left}");
    assert_eq!(flashed.fits(&with_slow(left), file), Err(want));
    let code = Sections {
        rodata: Section {
            address: u64::from(FLASH_AT) - 8,
            bytes: 9,
        },
        ..with_slow(needed)
    };
    assert!(flashed.fits(&code, file).is_err());
    let list = host_tests::lists::read_list(&example("scenes/crate.list"))?;
    let mut words = list::words(&list);
    let grown = (0..32).find_map(|_| grow(&mut words, Lent::Texels, String::new()).err());
    let said = grown.map(|error| error.to_string()).unwrap_or_default();
    assert!(
        said.contains("bytes of slow memory, the emulated boards have 16777216"),
        "{said}"
    );
    Ok(())
}
