//! What a scene file says of light: highlights, faces and pixels against `render` with the flags that say the same of a
//! model, bit by bit; shadows against rays to the light.

use crate::command_line::Desk;
use crate::scene_files::{RED, at, desk, drawn, near, scene, square};
use host_tests::image_out::Frame;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs;

/// A folder with a coarse ball of radius 1 about the origin, of one colour.
fn with_ball() -> Desk {
    let desk = desk();
    let (mut text, steps) = (String::new(), 12);
    for (row, column) in (0..=steps).flat_map(|row| (0..2 * steps).map(move |column| (row, column)))
    {
        let angle = |n: u32| std::f64::consts::PI * f64::from(n) / f64::from(steps);
        let (s, c) = angle(row).sin_cos();
        let [x, y, z] = [s * angle(column).cos(), c, s * angle(column).sin()];
        writeln!(text, "v {x} {y} {z} 0.8 0.5 0.3\nvn {x} {y} {z}").unwrap();
    }
    for (row, column) in (0..steps).flat_map(|row| (0..2 * steps).map(move |column| (row, column)))
    {
        let corner = |row: u32, column: u32| 2 * steps * row + column % (2 * steps) + 1;
        let all = [
            corner(row, column),
            corner(row, column + 1),
            corner(row + 1, column + 1),
            corner(row + 1, column),
        ];
        let [a, b, c, d] = all;
        writeln!(text, "f {a}//{a} {b}//{b} {c}//{c} {d}//{d}").unwrap();
    }
    fs::write(desk.path("ball.obj"), text).unwrap();
    desk
}

/// A lit ball with more fields.
fn ball(ambient: f64, colour: f64, fields: &Value) -> Value {
    let mut ball = json!({ "model": "ball.obj" });
    for (name, value) in fields.as_object().unwrap() {
        ball[name] = value.clone();
    }
    let mut scene = scene(json!([ball]));
    scene["size"] = json!([48, 40]);
    scene["camera"] = json!({ "eye": [0.3, 0.5, 3], "at": [0, 0, 0], "fov": 50 });
    scene["lights"] = json!([{ "towards": [1, 2, 2], "colour": [colour, colour, colour] }]);
    scene["ambient"] = json!(ambient);
    scene
}

/// A field and a flag that say the same draw the same picture, which is another than without them. Kills: a field that
/// is read and forgotten, a power of another default, light at corners for that at pixels, smooth for flat.
#[test]
fn light_falls_as_with_flags() {
    let desk = with_ball();
    let view = "--size 48x40 --eye 0.3,0.5,3 --fov 50 --light 1,2,2";
    let of_flags = |flags: &str| desk.drawn(&format!("render ball.obj -o o.png {view} {flags}"));
    let matt = drawn(&desk, &ball(0.0, 1.0, &json!({})));
    let shiny = json!({ "specular": 0.5, "shininess": 8 });
    let flat = json!({ "specular": 0.5, "shininess": 8, "shade": "flat" });
    for (fields, phong, flags) in [
        (json!({}), false, "--shade gouraud --specular 0,1"),
        (json!({}), true, "--shade phong"),
        (shiny.clone(), false, "--shade gouraud --specular 0.5,8"),
        (
            json!({ "specular": 0.5 }),
            false,
            "--shade gouraud --specular 0.5,32",
        ),
        (shiny.clone(), true, "--shade phong --specular 0.5,8"),
        (flat, false, "--shade flat --specular 0.5,8"),
        (
            json!({ "shade": "flat" }),
            false,
            "--shade flat --specular 0,1",
        ),
        (
            json!({ "shade": "gouraud" }),
            false,
            "--shade gouraud --specular 0,1",
        ),
        (json!({ "shade": "none" }), false, "--shade none"),
        (json!({ "shade": "none" }), true, "--shade none"),
    ] {
        let mut scene = ball(0.0, 1.0, &fields);
        scene["phong"] = json!(phong);
        let said = drawn(&desk, &scene);
        assert!(
            said == of_flags(&format!("{flags} --ambient 0")),
            "{fields}, {phong}"
        );
        let is_matt = !phong && flags == "--shade gouraud --specular 0,1";
        assert!((said == matt) == is_matt, "{fields}, {phong}");
    }
    // Where there is light from everywhere too, and the light is weaker.
    for phong in [false, true] {
        let mut scene = ball(0.25, 0.75, &json!({}));
        scene["phong"] = json!(phong);
        let shade = if phong {
            "phong"
        } else {
            "gouraud --specular 0,1"
        };
        let flags = format!("--shade {shade} --ambient 0.25");
        assert!(drawn(&desk, &scene) == of_flags(&flags), "{phong}");
    }
}

/// Kills: one level for all channels, the channels of another order.
#[test]
fn highlights_have_a_colour() {
    let desk = with_ball();
    let with = |specular: Value| {
        let fields = json!({ "specular": specular, "shininess": 8 });
        drawn(&desk, &ball(0.1, 0.9, &fields))
    };
    let channel = |frame: &Frame, i: usize| -> Vec<u8> {
        frame.rgb().iter().skip(i).step_by(3).copied().collect()
    };
    let (all, matt) = (with(json!(0.5)), drawn(&desk, &ball(0.1, 0.9, &json!({}))));
    assert!(with(json!([0.5, 0.5, 0.5])) == all);
    let some = with(json!([0.5, 0, 0.5]));
    for i in 0..3 {
        let want = if i == 1 { &matt } else { &all };
        assert!(channel(&some, i) == channel(want, i), "channel {i}");
        assert!(channel(&all, i) != channel(&matt, i));
    }
}

/// Each object is lit in its own way. Kills: the way of the first, or of the last, for all.
#[test]
fn objects_are_lit_each_in_its_way() {
    let desk = desk();
    for phong in [false, true] {
        let left = json!({ "model": "red.obj", "place": [-1, 0, 0], "shade": "none" });
        let right = json!({ "model": "red.obj", "place": [1, 0, 0] });
        let mut scene = scene(json!([left, right]));
        scene["lights"] = json!([{ "towards": [0, 0, 1], "colour": [0.5, 0, 0] }]);
        (scene["ambient"], scene["phong"]) = (json!(0), json!(phong));
        let picture = drawn(&desk, &scene);
        assert_eq!(at(&picture, 4, 8), RED);
        assert!(near(at(&picture, 12, 8), [128, 0, 0]), "phong {phong}");
    }
}

/// Light at pixels falls on one colour a triangle. Kills: the colour of a triangle's first corner for all of it, one
/// colour for all triangles.
#[test]
fn light_at_pixels_has_a_colour_for_each_triangle() {
    let desk = desk();
    let lit = |model: &str| {
        let mut scene =
            scene(json!([{ "model": "red.obj", "place": [0, 0, -9] }, { "model": model }]));
        (scene["lights"], scene["phong"]) = (json!([{ "towards": [0, 0, 1] }]), json!(true));
        scene["ambient"] = json!(0);
        scene
    };
    let corner = |x: i32, y: i32, colour: &str| format!("v {x} {y} 0 {colour}\nvn 0 0 1\n");
    let halves: String = [(-1, "0 1 0"), (0, "0 0 1")]
        .map(|(x, colour)| {
            let corners = [(x, -1), (x + 1, -1), (x + 1, 1), (x, 1)];
            corners.map(|(x, y)| corner(x, y, colour)).concat()
        })
        .concat();
    let faces = "f 1//1 2//2 3//3 4//4\nf 5//5 6//6 7//7 8//8\n";
    fs::write(desk.path("halves.obj"), halves + faces).unwrap();
    let picture = drawn(&desk, &lit("halves.obj"));
    assert_eq!(at(&picture, 4, 8), [0, 255, 0]);
    assert_eq!(at(&picture, 12, 8), [0, 0, 255]);
    let mixed = square("1 1 0").replacen("1 1 0", "0 1 1", 1);
    fs::write(desk.path("mixed.obj"), mixed).unwrap();
    fs::write(desk.path("s.json"), lit("mixed.obj").to_string()).unwrap();
    let line = desk.refused("render s.json -o p.png");
    assert!(
        line.contains("s.json: object 1: `phong` lights one colour"),
        "{line}"
    );
}

/// Where a box stands, how large it is, and where the floor is.
#[derive(Clone, Copy, Debug)]
struct Setup {
    place: [f64; 3],
    size: f64,
    floor: f64,
    /// The middle of the floor, from under the box: to the right and down.
    aside: [f64; 2],
    /// The sides of the floor are so far from the middle of the picture.
    half: f64,
}

/// The way to the light.
const LIGHT: [f64; 3] = [1.0, 2.0, 0.5];
/// Pixels a side.
const SIDE: u32 = 64;

impl Setup {
    /// The camera looks down on the floor, all of which it sees.
    fn scene(&self) -> Value {
        let [x, z] = [0, 1].map(|i| self.place[2 * i] + self.aside[i]);
        let above = self.floor + self.height();
        let mut scene = scene(json!([
            { "model": "red.obj", "scale": self.half, "turn": [-90, 0, 0], "place": [x, self.floor, z] },
            { "model": "box.obj", "scale": self.size, "place": self.place },
        ]));
        scene["size"] = json!([SIDE, SIDE]);
        scene["camera"] = json!({
            "eye": [x, above, z], "at": [x, self.floor, z], "up": [0, 0, -1], "fov": 90,
            "near": self.height() / 100.0, "far": 2.0 * self.height(),
        });
        scene["lights"] = json!([
            { "towards": LIGHT, "colour": [0.5, 0.5, 0.5], "shadows": true },
            { "towards": [0, 1, 0], "colour": [0.25, 0.25, 0.25] },
        ]);
        scene["ambient"] = json!(0.125);
        scene
    }

    /// From the floor to the eye.
    fn height(&self) -> f64 {
        self.half
    }

    /// Where a pixel's place on the floor is, from its middle: to the right and down.
    fn on_floor(&self, x: f64, y: f64) -> [f64; 2] {
        let middle = f64::from(SIDE) / 2.0;
        [x, y].map(|at| (at - middle) / middle * self.height())
    }

    /// Whether a ray goes through the box: from a point of the floor, this way.
    fn is_hit(&self, at: [f64; 2], way: [f64; 3]) -> bool {
        let [x, z] = [0, 1].map(|i| at[i] + self.aside[i]);
        let from = [x, self.floor - self.place[1], z];
        let mut times = [0.0f64, f64::INFINITY];
        for i in 0..3 {
            let ends = [-self.size, self.size].map(|side| {
                let (off, way) = (side - from[i], way[i]);
                match way == 0.0 {
                    true => off.signum() * f64::INFINITY,
                    false => off / way,
                }
            });
            times[0] = times[0].max(ends[0].min(ends[1]));
            times[1] = times[1].min(ends[0].max(ends[1]));
        }
        times[0] < times[1]
    }

    /// What a pixel shows of the floor: whether that is in the shadow. `None` where that is the box, or near a border.
    fn want(&self, x: u32, y: u32) -> Option<bool> {
        let corners = [(-0.3, -0.3), (1.3, -0.3), (-0.3, 1.3), (1.3, 1.3)];
        let mut seen = corners.map(|(dx, dy)| {
            let at = self.on_floor(f64::from(x) + dx, f64::from(y) + dy);
            let eye = [-at[0], self.height(), -at[1]];
            (self.is_hit(at, eye), self.is_hit(at, LIGHT))
        });
        seen.sort_unstable();
        let (is_box, is_dark) = seen[0];
        (seen[0] == seen[3] && !is_box).then_some(is_dark)
    }
}

/// A folder with a box of side 2 about the origin, faces outwards, and the squares.
fn with_box() -> Desk {
    let desk = desk();
    let mut text = String::new();
    for corner in 0..8 {
        let [x, y, z] = [1, 2, 4].map(|bit| if corner & bit == 0 { -1 } else { 1 });
        writeln!(text, "v {x} {y} {z} 0 1 0").unwrap();
    }
    text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    fs::write(desk.path("box.obj"), text).unwrap();
    desk
}

const SETUPS: [Setup; 6] = [
    Setup {
        place: [0.0, 0.5, 0.0],
        size: 0.5,
        floor: 0.0,
        aside: [0.0; 2],
        half: 4.0,
    },
    // High above, so that the shadow is many times as long as the box.
    Setup {
        place: [0.0, 2.0, 0.0],
        size: 0.25,
        floor: 0.0,
        aside: [0.0; 2],
        half: 4.0,
    },
    // Small on a large floor.
    Setup {
        place: [0.0, 300.0, 0.0],
        size: 40.0,
        floor: 0.0,
        aside: [0.0; 2],
        half: 600.0,
    },
    // Far from the origin.
    Setup {
        place: [1000.0, 53.0, -700.0],
        size: 1.0,
        floor: 50.0,
        aside: [0.0; 2],
        half: 16.0,
    },
    Setup {
        place: [0.0, 0.0, 0.0],
        size: 0.015625,
        floor: -0.03125,
        aside: [0.0; 2],
        half: 0.125,
    },
    // Small both, and far from each other: the box is behind the eye.
    Setup {
        place: [50.0, 100.0, 25.0],
        size: 1.0,
        floor: 0.0,
        aside: [-50.0, -25.0],
        half: 4.0,
    },
];

/// Kills: shadows too short, by the box alone or by the distance alone; a fixed length; the direction turned round; the
/// other light in the shadow, or light from everywhere left out; darkness on what is lit.
#[test]
fn shadows_fall_where_rays_to_the_light_are_stopped() {
    let desk = with_box();
    for (setup, phong) in SETUPS
        .into_iter()
        .flat_map(|setup| [(setup, false), (setup, true)])
    {
        let mut scene = setup.scene();
        scene["phong"] = json!(phong);
        let picture = drawn(&desk, &scene);
        for_floor(setup, |x, y, is_dark| {
            let want = [floor_levels()[usize::from(is_dark)], 0, 0];
            (picture.pixel(x, y).unwrap(), want)
        });
    }
}

/// What the floor shows of its colour in the light and in the shadow: 1/8 from everywhere, 1/4 from above, and of the
/// other light its part.
fn floor_levels() -> [u8; 2] {
    let part = LIGHT[1] / LIGHT.iter().map(|c| c * c).sum::<f64>().sqrt();
    [0.375 + 0.5 * part, 0.375].map(|level| (level * 255.0).round() as u8)
}

/// Holds what pixels of the floor show against what they should, by their places and whether they are in the shadow.
fn for_floor(setup: Setup, shown: impl Fn(u32, u32, bool) -> ([u8; 3], [u8; 3])) {
    let mut count = [0; 2];
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        let Some(is_dark) = setup.want(x, y) else {
            continue;
        };
        let (got, want) = shown(x, y, is_dark);
        assert!(
            near(got, want),
            "{setup:?} ({x}, {y}): {got:?}, not {want:?}"
        );
        count[usize::from(is_dark)] += 1;
    }
    assert!(count[0] > 1000 && count[1] > 3, "{setup:?}: {count:?}");
}

/// Kills: all that casts, whatever it says; what is blended throwing shadows or getting any.
#[test]
fn what_says_so_or_is_blended_throws_no_shadow() {
    let desk = with_box();
    let setup = SETUPS[0];
    let with = |fields: Value| {
        let mut scene = setup.scene();
        for (name, value) in fields.as_object().unwrap() {
            scene["objects"][1][name] = value.clone();
        }
        scene
    };
    let dark = |picture: &Frame| {
        let all = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        let pixels = all.map(|(x, y)| picture.pixel(x, y).unwrap());
        pixels.filter(|&pixel| near(pixel, [96, 0, 0])).count()
    };
    assert!(dark(&drawn(&desk, &with(json!({})))) > 20);
    let shown = drawn(&desk, &with(json!({ "shadow": true })));
    assert!(shown == drawn(&desk, &with(json!({}))));
    for fields in [
        json!({ "shadow": false }),
        json!({ "blend": "filter", "alpha": 200 }),
        json!({ "blend": "add", "alpha": 200 }),
    ] {
        assert_eq!(dark(&drawn(&desk, &with(fields))), 0);
    }
    // A pane over the floor, in the way of the light: half of it as in the light, half of what is behind it.
    let mut scene = with(json!({}));
    let pane = json!({
        "model": "white.obj", "scale": 4, "turn": [-90, 0, 0], "place": [0, 0.01, 0],
        "blend": "filter", "alpha": 128,
    });
    scene["objects"].as_array_mut().unwrap().push(pane);
    let mixed = drawn(&desk, &scene);
    let under = drawn(&desk, &with(json!({})));
    let lit = floor_levels()[0];
    for_floor(setup, |x, y, _| {
        let behind = under.pixel(x, y).unwrap();
        let want = behind.map(|level| (u32::from(level) + u32::from(lit)).div_ceil(2) as u8);
        (mixed.pixel(x, y).unwrap(), want)
    });
}

/// Kills: darkness on what is not lit, none on what is lit by faces.
#[test]
fn what_is_not_lit_is_as_it_is_in_the_shadow() {
    let desk = with_box();
    let setup = SETUPS[0];
    let with = |shade: &str| {
        let mut scene = setup.scene();
        scene["objects"][0]["shade"] = json!(shade);
        drawn(&desk, &scene)
    };
    let (bare, flat) = (with("none"), with("flat"));
    for_floor(setup, |x, y, _| (bare.pixel(x, y).unwrap(), RED));
    for_floor(setup, |x, y, is_dark| {
        let want = [floor_levels()[usize::from(is_dark)], 0, 0];
        (flat.pixel(x, y).unwrap(), want)
    });
}

/// Kills: a box that is too small, drawn with shadows that end on their way.
#[test]
fn what_is_too_small_to_throw_its_shadow_is_named() {
    let desk = with_box();
    let mut scene = SETUPS[0].scene();
    scene["objects"][1]["scale"] = json!(0.001);
    fs::write(desk.path("s.json"), scene.to_string()).unwrap();
    let line = desk.refused("render s.json -o p.png");
    assert!(
        line.contains("object 1: it is too small to throw"),
        "{line}"
    );
    scene["objects"][1]["shadow"] = json!(false);
    drawn(&desk, &scene);
}

/// One model with its shadow on itself is the picture of `render --shadows on`. Kills: a part in the dark drawn where it
/// is seen in the light, a volume too long or too short by a power of two.
#[test]
fn shadows_of_one_model_are_those_of_the_flag() {
    let desk = with_box();
    let tower = "v -1 -1 1 0.8 0.5 0.3\nv 1 -1 1 0.8 0.5 0.3\nv 1 -1 -1 0.8 0.5 0.3\nv -1 -1 -1 0.8 0.5 0.3\n";
    let mut text = format!("{tower}f 1 2 3 4\n");
    for corner in 0..8 {
        let [x, y, z] = [1, 2, 4].map(|bit| if corner & bit == 0 { -0.25 } else { 0.25 });
        let y = if y < 0.0 { -0.9 } else { 1.0 };
        writeln!(text, "v {x} {y} {z} 0.8 0.5 0.3").unwrap();
    }
    for face in [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ] {
        let corners = face
            .split(' ')
            .map(|i| (i.parse::<u32>().unwrap() + 4).to_string());
        writeln!(text, "f {}", corners.collect::<Vec<_>>().join(" ")).unwrap();
    }
    fs::write(desk.path("tower.obj"), text).unwrap();
    for (phong, shade) in [(false, "gouraud"), (true, "phong")] {
        let mut scene = ball(0.25, 0.75, &json!({ "model": "tower.obj" }));
        scene["lights"][0]["shadows"] = json!(true);
        scene["lights"][0]["towards"] = json!([3, 2, 1]);
        scene["phong"] = json!(phong);
        let flags = format!("--shade {shade} --shadows on --ambient 0.25 --light 3,2,1");
        let view = "--size 48x40 --eye 0.3,0.5,3 --fov 50";
        let of_flags = desk.drawn(&format!("render tower.obj -o o.png {view} {flags}"));
        assert!(drawn(&desk, &scene) == of_flags, "{shade}");
        scene["lights"][0]["shadows"] = json!(false);
        assert!(drawn(&desk, &scene) != of_flags, "{shade}");
    }
}
