//! A textured scene through the whole pipeline, at each quality: set-up, clipping, hidden surfaces,
//! the choice of steps along each span, light on texels.
//!
//! It lends its memory from the stack, some 14 KB.

use crate::texels::{TEXEL_SIDE, TEXELS_565, size};
use crate::{CUBE, HEIGHT, Shot, ShotError, WIDTH};
use scanbeam::mesh::QuadSplit;
use scanbeam::pipeline::texture::{Quality, Skin, Texture, Textures, Words, Wrap};
use scanbeam::pipeline::{
    Counted, Instance, LineMemory, LineRenderer, ObjectOf, Scene, SceneMemory, TexturedDepth,
    VertexOf,
};
use scanbeam::pixel::Rgb565;
use scanbeam::stats::SpanCounts;
use scanbeam::{Affine, Camera, Cull, Faces, Light, Link, Mesh};

type Store<'t> = Texture<Words<'t, u16>, Wrap>;
/// Counted, so that it shows what was textured.
type Look<'t> = Counted<TexturedDepth<'t, Rgb565, Store<'t>>>;

/// Squares of the ground across and away.
const SQUARES: [usize; 2] = [4, 8];
const CORNERS: usize = (SQUARES[0] + 1) * (SQUARES[1] + 1);
/// Corners of ground and cube, and what the near plane adds.
const VERTICES: usize = CORNERS + 24 + 32;
/// Triangles of both, and what the near plane adds.
const OBJECTS: usize = 2 * SQUARES[0] * SQUARES[1] + 12 + 32;
const SLOTS: usize = 16;
/// Where nothing is.
const SKY: u16 = 0x18DF;

/// A ground of 2 by 2 in model space, and where its corners are on the texture: 2 repeats across, 4
/// away.
struct Ground {
    positions: [[i16; 3]; CORNERS],
    places: [[i32; 2]; CORNERS],
    faces: [[u16; 4]; SQUARES[0] * SQUARES[1]],
}

impl Ground {
    fn new() -> Self {
        let [across, away] = SQUARES;
        let of = |i: usize| (i % (across + 1), i / (across + 1));
        let texel = TEXEL_SIDE as i32 * 256;
        Self {
            positions: core::array::from_fn(|i| {
                let (x, z) = of(i);
                let even =
                    |at: usize, count: usize| (at as i32 * 32_767 / count as i32 - 16_383) as i16;
                [even(x, across), 0, even(z, away)]
            }),
            places: core::array::from_fn(|i| {
                let (x, z) = of(i);
                [x as i32 * texel / 2, z as i32 * texel / 2]
            }),
            faces: core::array::from_fn(|i| {
                let at = (i / across * (across + 1) + i % across) as u16;
                [at, at + across as u16 + 1, at + across as u16 + 2, at + 1]
            }),
        }
    }
}

/// Each side of the cube has the texture once and a half.
const SIDES: [[i32; 2]; 24] = {
    const FAR: i32 = TEXEL_SIDE as i32 * 384;
    let mut places = [[0; 2]; 24];
    let mut i = 0;
    while i < 24 {
        places[i] = [[0, FAR], [FAR, FAR], [FAR, 0], [0, 0]][i % 4];
        i += 1;
    }
    places
};

/// Draws the scene, hands each line to `emit`, and tells what was counted.
///
/// `None` when memory is short, which would be a mistake of this module.
pub fn textured(quality: Quality, emit: &mut dyn FnMut(&[u16])) -> Option<SpanCounts> {
    let store = Words(&TEXELS_565[..]);
    let texture = Texture::<_, Wrap>::new(store, size(TEXEL_SIDE, TEXEL_SIDE)).ok()?;
    let textures = [texture];
    let mut vertices = [VertexOf::<Look<'_>>::empty(); VERTICES];
    let mut objects = [ObjectOf::<Look<'_>>::default(); OBJECTS];
    let mut buckets = [Link::NONE; HEIGHT as usize];
    let memory = SceneMemory {
        vertices: &mut vertices,
        objects: &mut objects,
        buckets: &mut buckets,
    };
    let mut scene = Scene::<Look<'_>>::new(Shot::screen(), memory);
    scene.set_textures(Textures(&textures));
    build(&mut scene, quality).ok()?;
    let mut slots = [LineRenderer::<Look<'_>>::empty_slot(); SLOTS];
    let mut links = [Link::NONE; OBJECTS];
    let mut depth = [0; WIDTH as usize];
    let mut renderer = LineRenderer::<Look<'_>>::new(LineMemory {
        slots: &mut slots,
        links: &mut links,
        depth: &mut depth,
    });
    let mut pixels = [0; WIDTH as usize];
    for line in 0..HEIGHT {
        pixels.fill(SKY);
        renderer.draw_line(&scene, line, &mut pixels).ok()?;
        emit(&pixels);
    }
    Some(renderer.take_span_counts())
}

/// The ground goes from behind the eye to the horizon; the cube stands on it and is lit.
fn build(scene: &mut Scene<'_, Look<'_>>, quality: Quality) -> Result<(), ShotError> {
    let (eye, at, up) = ([0.3, 0.5, 1.0], [0.0, 0.3, -1.0], [0.1, 1.0, 0.0]);
    scene.begin(&Camera::look_at(eye, at, up, 200.0, 0.1, 40.0)?)?;
    let skin = |places| Skin {
        places,
        texture: 0,
        quality,
    };
    let placed = |scale, offset| Affine::placed(scale, offset).unwrap_or(Affine::IDENTITY);
    let ground = Ground::new();
    let mesh = Mesh {
        positions: &ground.positions,
        normals: &[],
        colours: &[],
        faces: Faces::Quads(&ground.faces, QuadSplit::default()),
    };
    let instance = Instance {
        cull: Cull::None,
        model: placed(12.0, [0.0, 0.0, -9.0]),
        ..Instance::default()
    };
    scene.draw_skinned(&mesh, skin(&ground.places[..]), &instance)?;
    let instance = Instance {
        model: Affine::rotation_y(0.6).then(&placed(0.45, [0.2, 0.5, -0.9])),
        light: Light::new([0.3, 0.8, 0.6], 0.3),
        ..Instance::default()
    };
    scene.draw_skinned(&CUBE, skin(&SIDES[..]), &instance)?;
    Ok(())
}
