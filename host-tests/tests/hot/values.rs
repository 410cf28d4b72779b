//! Values of draw calls, and what they mean to a reference: rectangles, functions of depth, modes of blending.

use super::{Corner, camera, draw_with};
use crate::common::Rng;
use scanbeam::Screen;
use scanbeam::look::Look;
use scanbeam::scene::{
    BlendMode, DepthFunction, DepthTest, Draw, Factor, Scene, Scissor, Texture, Wrap,
};
use std::cmp::Ordering;
use std::ops::Range;

/// A rectangle, and whether what is outside of it is kept.
#[derive(Clone, Debug)]
pub struct Cut {
    columns: Range<u16>,
    lines: Range<u16>,
    outside: bool,
}

impl Cut {
    pub fn new(rng: &mut Rng, screen: Screen) -> Self {
        let mut range = |end: u16| {
            let [a, b] = [(); 2].map(|()| rng.below(u32::from(end) + 20) as u16);
            a.min(b)..a.max(b)
        };
        Self {
            columns: range(screen.width()),
            lines: range(screen.height()),
            outside: rng.below(2) == 0,
        }
    }

    /// Keeps what is outside of the rectangle, or what is inside.
    pub fn set_outside(&mut self, outside: bool) {
        self.outside = outside;
    }

    pub fn keeps(&self, x: u16, y: u16) -> bool {
        (self.columns.contains(&x) && self.lines.contains(&y)) != self.outside
    }

    pub fn scissor(&self) -> Scissor {
        let (columns, lines) = (self.columns.clone(), self.lines.clone());
        if self.outside {
            Scissor::outside(columns, lines)
        } else {
            Scissor::inside(columns, lines)
        }
    }
}

/// A function, and whether it lets nearer, equal and farther depths pass.
pub type Function = (DepthFunction, [bool; 3]);

pub const NEARER_OR_EQUAL: Function = (DepthFunction::NEARER_OR_EQUAL, [true, true, false]);

pub const FUNCTIONS: [Function; 8] = [
    NEARER_OR_EQUAL,
    (DepthFunction::NEVER, [false; 3]),
    (DepthFunction::ALWAYS, [true; 3]),
    (DepthFunction::NEARER, [true, false, false]),
    (DepthFunction::EQUAL, [false, true, false]),
    (DepthFunction::FARTHER_OR_EQUAL, [false, true, true]),
    (DepthFunction::FARTHER, [false, false, true]),
    (DepthFunction::DIFFERENT, [true, false, true]),
];

/// Where colours are seen, and where depth is kept.
pub fn depth_test(test: [Function; 2]) -> DepthTest {
    let [colour_if, depth_if] = test.map(|(function, _)| function);
    DepthTest {
        colour_if,
        depth_if,
    }
}

/// Where the corners of a triangle lie on a texture.
pub const PLACES: [[i32; 2]; 3] = [[0, 0], [60 << 8, 0], [0, 40 << 8]];

/// Whether a depth that compares so passes.
pub fn passes((_, passing): Function, order: Ordering) -> bool {
    match order {
        Ordering::Greater => passing[0],
        Ordering::Equal => passing[1],
        Ordering::Less => passing[2],
    }
}

/// Alphas of a pixel beside that of its mode, 0 to 1, and whether it is added.
#[derive(Clone, Copy)]
pub struct Alphas {
    pub surface: f64,
    pub texel: f64,
    pub is_added: bool,
}

/// What a mode makes of a level that is there, and what becomes of its error.
pub fn blended(mode: BlendMode, old: f64, new: f64) -> [f64; 2] {
    let opaque = Alphas {
        surface: 1.0,
        texel: 1.0,
        is_added: false,
    };
    blended_by(mode, opaque, old, new)
}

/// The same of a pixel with these alphas.
pub fn blended_by(mode: BlendMode, by: Alphas, old: f64, new: f64) -> [f64; 2] {
    let part = |alpha: u8| f64::from(alpha) / 255.0;
    let all = |alpha: u8| part(alpha) * by.surface * by.texel;
    let [level, of_old] = match mode {
        BlendMode::Replace => [new, 0.0],
        BlendMode::Filter(alpha) | BlendMode::Add(alpha) | BlendMode::Subtract(alpha)
            if by.is_added =>
        {
            [old + new * all(alpha), 1.0]
        }
        _ if by.is_added => [old + new * all(255), 1.0],
        BlendMode::Filter(alpha) => [old + (new - old) * all(alpha), 1.0 - all(alpha)],
        BlendMode::Half => [(old + new) / 2.0, 0.5],
        BlendMode::Add(alpha) => [old + new * all(alpha), 1.0],
        BlendMode::Subtract(alpha) => [old - new * all(alpha), 1.0],
        BlendMode::Factors {
            source,
            destination,
        } => {
            let factor = |factor: Factor| match factor {
                Factor::Constant(value) => [part(value), 0.0],
                Factor::Destination => [old / 255.0, 1.0 / 255.0],
                Factor::InverseDestination => [1.0 - old / 255.0, -1.0 / 255.0],
                Factor::SourceAlpha => [by.surface, 0.0],
                Factor::InverseSourceAlpha => [1.0 - by.surface, 0.0],
                Factor::TextureAlpha => [by.texel, 0.0],
                Factor::InverseTextureAlpha => [1.0 - by.texel, 0.0],
            };
            let [[s, ds], [d, dd]] = [factor(source), factor(destination)];
            [new * s + old * d, (new * ds + old * dd + d).abs()]
        }
    };
    [level.clamp(0.0, 255.0), of_old]
}

/// Modes of which no error grows.
pub fn some_mode(rng: &mut Rng) -> BlendMode {
    let alpha = rng.below(256) as u8;
    match rng.below(9) {
        0 => BlendMode::Half,
        1 => BlendMode::Add(alpha),
        2 => BlendMode::Subtract(alpha),
        3 => BlendMode::Factors {
            source: Factor::Destination,
            destination: Factor::ZERO,
        },
        4 => BlendMode::Factors {
            source: Factor::InverseDestination,
            destination: Factor::ONE,
        },
        5 => BlendMode::Factors {
            source: Factor::Constant(alpha),
            destination: Factor::Constant(rng.below(256) as u8),
        },
        6 => BlendMode::Replace,
        _ => BlendMode::Filter(alpha),
    }
}

/// A texture that leaves colours as they are.
pub static WHITE: Texture<'static> = {
    static WORDS: [u16; 64] = [0xFFFF; 64];
    match Texture::words(&WORDS, 8, 8) {
        Ok(texture) => texture.wrapping(Wrap::Repeat),
        Err(_) => panic!("8 x 8 texels"),
    }
};

/// The same with holes in half of its columns.
pub static HOLED: Texture<'static> = {
    const KEY: u16 = 0x1234;
    static WORDS: [u16; 64] = {
        let mut words = [0xFFFF; 64];
        let mut i = 0;
        while i < 64 {
            if i % 8 < 4 {
                words[i] = KEY;
            }
            i += 1;
        }
        words
    };
    match Texture::words(&WORDS, 8, 8) {
        Ok(texture) => texture.wrapping(Wrap::Repeat).keyed(KEY),
        Err(_) => panic!("8 x 8 texels"),
    }
};

/// Begins a scene, and draws the triangle of each call as it is dressed.
pub fn draw_each<L: Look, C>(
    scene: &mut Scene<'_, '_, L>,
    calls: &[C],
    corners: impl Fn(&C) -> [Corner; 3],
    dress: impl Fn(&C, &mut Draw<'_, '_, i32>),
) {
    scene.begin(&camera()).expect("the rooms are large enough");
    for call in calls {
        let drawn = draw_with(scene, &[corners(call)], |draw| dress(call, draw));
        drawn.expect("there is room");
    }
}

/// The corners of any triangle of one colour, about the screen.
pub fn some_corners(rng: &mut Rng, screen: Screen) -> [Corner; 3] {
    let size = rng.pick(&[40, 200, 600, 3_000]);
    let middle = [screen.width(), screen.height()].map(|side| rng.within(0, 8 * i32::from(side)));
    let w = 1.0 + 7.0 * rng.unit();
    let slant = rng.pick(&[1.0, 1.0, 1.0, 3.0]);
    let colour = [(); 3].map(|()| rng.below(256) as u8);
    [(); 3].map(|()| Corner {
        at: (
            middle[0] + rng.within(-size, size),
            middle[1] + rng.within(-size, size),
        ),
        w: w * rng.between(1.0, slant),
        colour,
    })
}
