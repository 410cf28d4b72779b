//! What a scene's text may say, and what contradicts itself.

use clap::Parser;
use host_tests::args::ViewArgs;
use host_tests::scene_file::{Loaded, SceneFile};
use host_tests::view::{Scenery, State};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// A scene of one object that says as little as it can.
fn least() -> Value {
    json!({
        "size": [16, 12],
        "camera": { "eye": [0, 0, 4], "at": [0, 0, 0] },
        "objects": [{ "model": "m.obj" }],
    })
}

/// The same with one value more, at a path of names and numbers.
fn with(mut scene: Value, path: &str, value: Value) -> Value {
    let (parent, name) = path.rsplit_once('/').unwrap();
    let parent = scene.pointer_mut(parent).unwrap();
    parent[name] = value;
    scene
}

fn refusal(scene: &Value) -> String {
    match SceneFile::parse(&scene.to_string()) {
        Err(line) => line,
        Ok(scene) => panic!("{scene:?}"),
    }
}

#[test]
fn the_least_that_a_scene_says() {
    let scene = SceneFile::parse(&least().to_string()).unwrap();
    let view = scene.view();
    assert_eq!((view.width, view.height, view.fov), (16, 12, 60.0));
    assert_eq!(
        (view.up, view.near, view.far),
        ([0.0, 1.0, 0.0], 0.1, 100.0)
    );
    assert!(!scene.has_palettes() && !scene.has_priorities());
    assert!(scene.lights.is_empty() && !scene.dither);
}

#[test]
fn what_cannot_be_had_together_is_named() {
    let palettes = json!([{ "from_line": 0, "colours": [[1, 2, 3]] }]);
    let indexed = with(least(), "/palettes", palettes);
    let light = json!([{ "towards": [0, 0, 1] }]);
    for (name, value) in [
        ("lights", light.clone()),
        ("dither", json!(true)),
        ("background", json!([1, 2, 3])),
        ("doubled", json!(true)),
    ] {
        let line = refusal(&with(indexed.clone(), &format!("/{name}"), value));
        let both = format!("`palettes` and `{name}` cannot be had together");
        assert!(line.starts_with(&both), "{line}");
    }
    for (name, value) in [
        ("texture", json!("t.png")),
        ("blend", json!("add")),
        ("depth", json!("nearer")),
        ("writes_depth", json!(false)),
        ("priority", json!(3)),
        ("filter", json!("bilinear")),
        ("levels", json!(false)),
        ("quality", json!("exact")),
        ("application", json!("replace")),
        ("shade", json!("flat")),
        (
            "computed",
            json!({ "squares": { "size": [8, 8], "colours": [[0, 0, 0], [9, 9, 9]], "side": 2 } }),
        ),
        ("texels", json!("cutout")),
        ("texel_form", json!("palette")),
        ("reflection", json!(true)),
    ] {
        let path = format!("/objects/0/{name}");
        assert!(SceneFile::parse(&with(least(), &path, value.clone()).to_string()).is_ok());
        let line = refusal(&with(indexed.clone(), &path, value));
        let both = format!("object 0: `{name}` and `palettes` cannot be had together");
        assert!(line.starts_with(&both), "{line}");
    }
    let mut ranked = least();
    let second = json!({ "model": "m.obj", "priority": 1 });
    ranked["objects"].as_array_mut().unwrap().push(second);
    for (name, value) in [("depth", json!("always")), ("writes_depth", json!(true))] {
        let line = refusal(&with(ranked.clone(), &format!("/objects/0/{name}"), value));
        let both = format!("object 0: `{name}` and `priority` cannot be had together");
        assert!(line.starts_with(&both), "{line}");
    }
    (ranked["dither"], ranked["format"]) = (json!(true), json!("rgb565"));
    assert!(SceneFile::parse(&ranked.to_string()).is_ok());
    for (path, value, what) in [
        ("/objects/0/index", json!(1), "`index` needs `palettes`"),
        (
            "/objects/0/shade",
            json!("none"),
            "`shade` none needs `lights`",
        ),
        (
            "/objects/0/specular",
            json!(0.5),
            "`specular` needs `lights`",
        ),
        (
            "/objects/0/shininess",
            json!(9),
            "`shininess` needs `specular`",
        ),
        ("/objects/0/shadow", json!(true), "`shadow` needs `shadows`"),
        ("/phong", json!(true), "`phong` needs `lights`"),
        ("/objects/0/alpha", json!(1), "`alpha` needs `blend`"),
        ("/ambient", json!(0.5), "`ambient` needs `lights`"),
        ("/dither", json!(true), "`dither` needs `format` rgb565"),
    ] {
        let line = refusal(&with(least(), path, value));
        assert!(line.ends_with(what), "{line}");
    }
}

/// A scene with a light that throws shadows, and fields of its object.
fn lit(fields: Value) -> Value {
    let light = json!([{ "towards": [0, 0, 1], "shadows": true }]);
    let mut scene = with(least(), "/lights", light);
    for (name, value) in fields.as_object().unwrap() {
        scene["objects"][0][name] = value.clone();
    }
    scene
}

/// Each of two fields is accepted alone. Kills: a line of the table left out, or of another field.
#[test]
fn two_fields_of_an_object_that_contradict_each_other_are_named() {
    let squares =
        json!({ "squares": { "size": [8, 8], "colours": [[0, 0, 0], [9, 9, 9]], "side": 2 } });
    let computed = json!({ "computed": squares });
    for (one, other, names) in [
        (
            computed.clone(),
            json!({ "texture": "t.png" }),
            "`computed` and `texture`",
        ),
        (
            computed.clone(),
            json!({ "levels": true }),
            "`computed` and `levels`",
        ),
        (
            computed.clone(),
            json!({ "texels": "cutout" }),
            "`computed` and `texels`",
        ),
        (
            computed,
            json!({ "texel_form": "words" }),
            "`computed` and `texel_form`",
        ),
        (
            json!({ "texels": "alpha", "blend": "add" }),
            json!({ "texel_form": "compressed" }),
            "`texels` alpha and `texel_form` compressed",
        ),
        (
            json!({ "shade": "none" }),
            json!({ "specular": 0.5 }),
            "`shade` none and `specular`",
        ),
        (
            json!({ "application": "replace" }),
            json!({ "specular": 0.5 }),
            "`application` replace and `specular`",
        ),
        (
            json!({ "shadow": false }),
            json!({ "blend": "add" }),
            "`shadow` and `blend`",
        ),
    ] {
        let mut both = one.clone();
        both.as_object_mut()
            .unwrap()
            .extend(other.as_object().unwrap().clone());
        for alone in [one, other] {
            let scene = lit(alone);
            assert!(SceneFile::parse(&scene.to_string()).is_ok(), "{scene}");
        }
        let line = refusal(&lit(both));
        let both = format!("object 0: {names} cannot be had together");
        assert!(line.starts_with(&both), "{line}");
    }
    let line = refusal(&lit(json!({ "writes_depth": false })));
    assert!(
        line.contains("`writes_depth` false and `shadows`"),
        "{line}"
    );
    let line = refusal(&lit(json!({ "priority": 1 })));
    assert!(line.starts_with("`shadows` and `priority`"), "{line}");
    let doubled = with(least(), "/doubled", json!(true));
    let window = json!({ "left": 0, "top": 0, "width": 3, "height": 3 });
    let line = refusal(&with(doubled.clone(), "/objects/0/window", window));
    assert!(
        line.contains("object 0: `window` and `doubled` cannot"),
        "{line}"
    );
    let line = refusal(&with(doubled, "/size", json!([16, 13])));
    assert!(line.contains("`doubled` needs an even `size`"), "{line}");
    for accepted in [
        json!({ "writes_depth": true }),
        json!({ "writes_depth": false, "blend": "add" }),
        json!({ "depth": "always" }),
    ] {
        let scene = lit(accepted);
        assert!(SceneFile::parse(&scene.to_string()).is_ok(), "{scene}");
    }
    let mut two = lit(json!({}));
    let second = json!({ "towards": [1, 0, 0], "shadows": true });
    two["lights"].as_array_mut().unwrap().push(second);
    assert!(refusal(&two).contains("at most one of the `lights` throws `shadows`"));
    two["lights"][0]["shadows"] = json!(false);
    assert!(SceneFile::parse(&two.to_string()).is_ok());
}

#[test]
fn what_is_out_of_range_or_unknown_is_one_line() {
    let lit = lit(json!({}));
    let lights = |count| Value::from(vec![json!({ "towards": [0, 0, 1] }); count]);
    let palette = |line: u32, count| json!({ "from_line": line, "colours": vec![[0; 3]; count] });
    let gradient = |size: [u32; 2], length: u32| json!({ "gradient": { "size": size, "from": [0, 0, 0], "to": [9, 9, 9], "length": length } });
    assert!(SceneFile::parse(&with(least(), "/lights", lights(8)).to_string()).is_ok());
    let ramp = with(least(), "/objects/0/computed", gradient([1024, 1], 2048));
    assert!(SceneFile::parse(&ramp.to_string()).is_ok());
    for (scene, path, value) in [
        (least(), "/size", json!([0, 4])),
        (least(), "/size", json!([4, 8193])),
        (least(), "/size", json!([4])),
        (least(), "/colour", json!(1)),
        (least(), "/format", json!("grey8")),
        (least(), "/background", json!([1, 2, 256])),
        (least(), "/camera/eye", json!([0, 0, 0])),
        (least(), "/camera/fov", json!(180)),
        (least(), "/camera/far", json!(0.05)),
        (least(), "/camera/tilt", json!(1)),
        (least(), "/lights", lights(9)),
        (lit.clone(), "/ambient", json!(1.5)),
        (lit.clone(), "/objects/0/specular", json!(1.5)),
        (lit.clone(), "/objects/0/specular", json!([0, 0, -1])),
        (lit.clone(), "/objects/0/specular", json!([0, 0])),
        (lit.clone(), "/objects/0/shininess", json!(65536)),
        (lit.clone(), "/objects/0/shade", json!("phong")),
        (lit.clone(), "/lights/0/towards", json!([0, 0, 0])),
        (lit.clone(), "/lights/0/towards", json!([1e39, 0, 0])),
        (lit, "/lights/0/colour", json!([0, 0, 1.1])),
        (least(), "/palettes", json!([palette(1, 2)])),
        (least(), "/palettes", json!([palette(0, 0)])),
        (least(), "/palettes", json!([palette(0, 257)])),
        (least(), "/palettes", json!([palette(0, 2), palette(12, 2)])),
        (least(), "/palettes", json!([palette(0, 2), palette(0, 2)])),
        (least(), "/objects/0/model", json!("a\nb.obj")),
        (least(), "/objects/0/scale", json!(0)),
        (least(), "/objects/0/place", json!([1e39, 0, 0])),
        (least(), "/objects/0/turn", json!([0, -1e39, 0])),
        (least(), "/objects/0/blend", json!("multiply")),
        (least(), "/objects/0/depth", json!("near")),
        (least(), "/objects/0/priority", json!(256)),
        (least(), "/objects/0/cull", json!("front")),
        (least(), "/objects/0/filter", json!("cubic")),
        (least(), "/objects/0/texels", json!("holes")),
        (least(), "/objects/0/texel_form", json!("bytes")),
        (least(), "/objects/0/computed", json!({})),
        (
            least(),
            "/objects/0/computed",
            json!({ "squares": { "size": [8, 8], "side": 2 } }),
        ),
        (least(), "/objects/0/computed", gradient([8, 9], 4)),
        (least(), "/objects/0/computed", gradient([2048, 8], 4)),
        (least(), "/objects/0/computed", gradient([8, 8], 3)),
        (least(), "/objects/0/computed", gradient([8, 8], 4096)),
        (least(), "/objects/0/quality", json!("good")),
        (least(), "/objects/0/application", json!("modulate")),
        (
            least(),
            "/objects/0/window",
            json!({ "left": 0, "top": 0, "width": 0, "height": 3 }),
        ),
    ] {
        let line = refusal(&with(scene, path, value.clone()));
        assert!(
            !line.contains('\n') && line.len() > 15,
            "{path} {value}: {line}"
        );
    }
    let text = least().to_string();
    for end in 0..text.len() {
        let line = SceneFile::parse(&text[..end]).unwrap_err();
        assert!(!line.contains('\n'), "{line}");
    }
    let many = Value::from(vec![json!({ "model": "m.obj" }); 1025]);
    assert!(refusal(&with(least(), "/objects", many)).contains("1024 `objects`"));
}

/// `view` begins where the file's camera is, and goes around what it looks at.
#[test]
fn eyes_go_around_what_the_camera_looks_at() {
    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        view: ViewArgs,
    }
    let camera = json!({ "eye": [1, 3, 4], "at": [1, 0, 0], "up": [0, 2, 0], "far": 50 });
    let scene = SceneFile::parse(&with(least(), "/camera", camera).to_string()).unwrap();
    let loaded = Loaded {
        scene,
        parts: Vec::new(),
        files: Vec::new(),
    };
    let scenery = Scenery::of_scene(&loaded).unwrap();
    let args = Line::parse_from(["view", "s.json"]).view;
    let mut state = State::of_scene(&args, &loaded.scene);
    let mut eye_is = |change: &dyn Fn(&mut State), want: [f64; 3]| {
        change(&mut state);
        let view = state.view(&scenery, 30, 20);
        let off = (0..3).map(|i| (view.eye[i] - want[i]).abs());
        assert!(
            off.fold(0.0, f64::max) < 1e-9,
            "{:?}, not {want:?}",
            view.eye
        );
        assert_eq!((view.at, view.far, view.width), ([1.0, 0.0, 0.0], 50.0, 30));
    };
    eye_is(&|_| {}, [1.0, 3.0, 4.0]);
    eye_is(&|state| state.yaw = TAU / 2.0, [1.0, 3.0, -4.0]);
    eye_is(&|state| state.distance = 2.0, [1.0, 6.0, -8.0]);
    // From the horizon, and from nearly above but never from the pole.
    let rise = (0.6f64).asin();
    eye_is(&|state| state.pitch = -rise, [1.0, 0.0, -10.0]);
    let steepest = TAU / 4.0 - 0.05;
    let top = [1.0, 10.0 * steepest.sin(), -10.0 * steepest.cos()];
    eye_is(&|state| state.pitch = TAU, top);
}
