//! The scenes that costs are measured on: shapes near and far, few and many, plain and textured, over each other and apart.

use crate::image_out::{Frame, write_image};
use crate::plan::lists::{self, ListSample};
use crate::plan::shapes::Shape;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::error::Error;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// A scene that is measured.
#[derive(Debug, Clone)]
pub struct Sample {
    /// What it is called in the record.
    pub name: String,
    /// What is drawn.
    pub source: Source,
    shapes: Vec<Shape>,
}

/// What a sample is.
#[derive(Debug, Clone)]
pub enum Source {
    /// The words of a scene file.
    Scene(Value),
    /// A list that is baked.
    List(ListSample),
}

/// Their textures: squares of two colours, and waves of many.
const SQUARES: &str = "squares.png";
const WAVES: &str = "waves.png";

/// The longest side of a texture of theirs.
pub const LONGEST_SIDE: u32 = 128;
/// The shortest one that is drawn alike.
pub const SHORTEST_SIDE: u32 = 32;

/// How surfaces look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Style {
    /// Lit colours.
    Smooth,
    /// Colours without a light.
    Unlit,
    /// A texture, lit.
    Lit,
    /// A texture in full light.
    Texels,
}

impl Style {
    const ALL: [Self; 4] = [Self::Smooth, Self::Unlit, Self::Lit, Self::Texels];

    const fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Unlit => "unlit",
            Self::Lit => "lit texels",
            Self::Texels => "texels",
        }
    }

    const fn texture(self) -> Option<&'static str> {
        match self {
            Self::Smooth | Self::Unlit => None,
            Self::Lit => Some(SQUARES),
            Self::Texels => Some(WAVES),
        }
    }
}

/// One shape, seen from a distance and a height.
pub(super) const SINGLES: [(Shape, f64, f64); 14] = [
    (Shape::Ball(6, 8), 2.4, 0.3),
    (Shape::Ball(8, 12), 3.4, 0.5),
    (Shape::Ball(14, 20), 2.2, 0.2),
    (Shape::Ball(16, 24), 4.0, 1.0),
    (Shape::Ball(24, 36), 2.6, 0.8),
    (Shape::Ball(30, 44), 8.0, 0.4),
    (Shape::Ball(44, 60), 3.0, 0.6),
    (Shape::Ring(16, 10), 3.6, 2.0),
    (Shape::Ring(48, 20), 3.4, 1.2),
    (Shape::Land(14), 1.6, 0.7),
    (Shape::Land(36), 2.4, 1.1),
    (Shape::Cube(1), 3.6, 1.5),
    (Shape::Cube(3), 5.0, 2.2),
    (Shape::Pane(6), 3.0, 1.4),
];
/// Walls of so many pieces along a side, turned by so much, and seen from so far.
const WALLS: [(u32, f64, f64); 7] = [
    (1, 0.0, 4.0),
    (1, 0.0, 8.0),
    (1, 20.0, 5.0),
    (2, 0.0, 6.0),
    (2, 35.0, 5.0),
    (4, 10.0, 4.0),
    (8, 5.0, 6.0),
];
/// Pictures of the first shapes that are not 320 x 240.
const SIZES: [[u32; 2]; 3] = [[160, 128], [240, 240], [480, 320]];

/// All of them; models and textures have paths in `folder`.
pub fn samples(folder: &Path) -> Vec<Sample> {
    let mut all = Vec::new();
    for style in Style::ALL {
        for (at, (shape, distance, height)) in SINGLES.into_iter().enumerate() {
            let one =
                Maker::new(folder, style).object(shape, 1.0, [0.0; 3], 20.0 + 3.0 * at as f64);
            let scene = one.seen([0.4, height, distance]);
            all.push(scene.named(&format!("{} from {distance}", shape.name())));
        }
        for shape in [
            Shape::Ball(10, 14),
            Shape::Ring(14, 10),
            Shape::Cube(1),
            Shape::Cube(4),
        ] {
            for (count, reach) in [(9, 1.0), (24, 1.8)] {
                let many = Maker::new(folder, style).scattered(shape, count, reach);
                let scene = many.seen([0.3, 0.9, 5.0]);
                all.push(scene.named(&format!("{count} of {}", shape.name())));
            }
        }
        for (walls, shape) in [
            (1, Shape::Ball(12, 18)),
            (1, Shape::Ring(14, 10)),
            (2, Shape::Ball(12, 18)),
            (4, Shape::Ring(18, 12)),
            (7, Shape::Cube(1)),
        ] {
            let room = Maker::new(folder, style)
                .object(Shape::Room(walls), 4.0, [0.0; 3], 0.0)
                .object(shape, 0.8, [0.4, -0.2, -0.6], 30.0)
                .object(Shape::Ball(8, 12), 0.5, [-1.4, 0.1, 0.3], 0.0);
            all.push(
                room.seen([0.6, 0.5, 3.0])
                    .named(&format!("room of {walls} with {}", shape.name())),
            );
        }
        for pieces in [1, 5, 12] {
            let floor = Maker::new(folder, style)
                .object(Shape::Floor(pieces), 4.0, [0.0, -0.8, 0.0], 15.0)
                .object(Shape::Ball(16, 20), 0.6, [0.8, -0.1, 0.0], 0.0)
                .object(Shape::Cube(1), 0.5, [-0.9, -0.3, 0.5], 30.0);
            all.push(
                floor
                    .seen([0.2, 1.1, 4.4])
                    .named(&format!("floor of {pieces}")),
            );
        }
        for (pieces, turn, distance) in WALLS {
            let wall = Maker::new(folder, style).object(Shape::Pane(pieces), 2.0, [0.0; 3], turn);
            let name = format!("wall of {pieces} by {turn} from {distance}");
            all.push(wall.seen([0.0, 0.0, distance]).named(&name));
        }
        for size in SIZES {
            let mut one = Maker::new(folder, style)
                .object(Shape::Ball(12, 18), 0.9, [0.0; 3], 10.0)
                .object(Shape::Ring(16, 8), 0.5, [0.9, 0.4, 0.3], 50.0);
            one.size = size;
            let [width, height] = size;
            all.push(
                one.seen([0.0, 0.8, 3.2])
                    .named(&format!("{width} x {height}")),
            );
        }
    }
    all.extend(lists::samples().into_iter().map(|(name, list)| Sample {
        name: format!("{name} of a list"),
        shapes: vec![list.shape],
        source: Source::List(list),
    }));
    all
}

/// Writes the models and textures of all samples into a folder.
///
/// # Errors
/// When one cannot be written.
pub fn write(folder: &Path, all: &[Sample]) -> Result<(), Box<dyn Error>> {
    let texture = |name: &str, side: u32, of: &dyn Fn(u32, u32) -> [u8; 3]| {
        let texels = (0..side * side).flat_map(|at| of(at % side, at / side));
        let frame = Frame::new(side, side, texels.collect()).ok_or("the sides of a texture")?;
        Ok::<(), Box<dyn Error>>(write_image(&folder.join(name), &frame)?)
    };
    texture(SQUARES, 64, &|x, y| match (x ^ y) & 8 {
        0 => [220, 200, 90],
        _ => [60, 90, 160],
    })?;
    texture(WAVES, LONGEST_SIDE, &|x, y| {
        let wave = |at: u32, by: f64| {
            128.0 + 120.0 * (f64::from(at) * TAU / f64::from(LONGEST_SIDE) * by).sin()
        };
        [wave(x, 3.0), wave(y, 2.0), wave(x + y, 5.0)].map(|level| level as u8)
    })?;
    let shapes: HashSet<Shape> = all
        .iter()
        .flat_map(|sample| sample.shapes.clone())
        .collect();
    for shape in shapes {
        std::fs::write(folder.join(shape.file()), shape.to_obj())?;
    }
    Ok(())
}

/// Makes a scene.
struct Maker {
    folder: PathBuf,
    style: Style,
    size: [u32; 2],
    objects: Vec<Value>,
    shapes: Vec<Shape>,
    eye: [f64; 3],
}

impl Maker {
    fn new(folder: &Path, style: Style) -> Self {
        Self {
            folder: folder.into(),
            style,
            size: [320, 240],
            objects: Vec::new(),
            shapes: Vec::new(),
            eye: [0.0; 3],
        }
    }

    /// With another shape, turned about its axis and leaning by half as much.
    fn object(mut self, shape: Shape, scale: f64, place: [f64; 3], turn: f64) -> Self {
        let leaning = if shape.is_lying() { 0.0 } else { turn / 2.0 };
        let mut object = json!({
            "model": self.folder.join(shape.file()),
            "scale": scale,
            "place": place,
            "turn": [leaning, turn, 0],
            "cull": "back",
        });
        if let Some(texture) = self.style.texture() {
            object["texture"] = json!(self.folder.join(texture));
        }
        self.objects.push(object);
        self.shapes.push(shape);
        self
    }

    /// With so many of a shape, within a distance of the middle.
    fn scattered(mut self, shape: Shape, count: u32, reach: f64) -> Self {
        let mut seed = count;
        let mut next = |reach: f64| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (f64::from(seed >> 16) / 32_768.0 - 1.0) * reach
        };
        for _ in 0..count {
            let place = [next(1.3 * reach), next(reach), next(reach)];
            let (scale, turn) = (0.35 + next(0.15), next(180.0));
            self = self.object(shape, scale, place, turn);
        }
        self
    }

    fn seen(mut self, eye: [f64; 3]) -> Self {
        self.eye = eye;
        self
    }

    fn named(self, name: &str) -> Sample {
        let mut scene = json!({
            "size": self.size,
            "format": "rgb565",
            "background": [24, 32, 48],
            "camera": { "eye": self.eye, "at": [0, 0, 0], "fov": 45 },
            "objects": self.objects,
        });
        if matches!(self.style, Style::Smooth | Style::Lit) {
            let lights = [
                json!({ "towards": [1, 2, 2], "colour": [0.8, 0.75, 0.7] }),
                json!({ "towards": [-2, 1, 0.5], "colour": [0.1, 0.15, 0.3] }),
            ];
            // One light, or two where there are several objects.
            let count = self.objects.len().min(2);
            scene["ambient"] = json!(0.2);
            scene["lights"] = json!(lights[..count]);
        }
        Sample {
            name: format!("{}, {name}", self.style.name()),
            source: Source::Scene(scene),
            shapes: self.shapes,
        }
    }
}
