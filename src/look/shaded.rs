//! Pixels by a function of one's own, from parameters of vertices (K15).
//!
//! A vertex has three parameters where other looks have its colour. What transforms, lights, clips, sorts and walks knows
//! nothing of them but their number: each has a plane with 20 fraction bits, and a pixel its exact value.

use super::gouraud::{Planes, thin_shades, wide_at, wide_shades};
use super::ramp::go_on;
use super::{Fill, Look, Place, Primitive, States, ThinSpan, WordOf};
use crate::geometry::Scale;
use crate::pixel::PixelFormat;
use crate::scene::Draws;
use core::marker::PhantomData;

/// What makes a pixel of three parameters that are linear between vertices.
///
/// They stand in the mesh's [`colours`](crate::Mesh::colours), or are the call's colour where it has none; light on
/// vertices multiplies them. Scissors, depth, blends and priorities are those of any look; a dither is the shader's own.
///
/// ```
/// use scanbeam::frame::{self, FastMemory, Renderer};
/// use scanbeam::look::{Shaded, Shader};
/// use scanbeam::pixel::{PixelFormat, Rgb565};
/// use scanbeam::scene::{Draw, DrawState, Memory, Object, Scene, Vertex};
/// use scanbeam::{Camera, Faces, Link, Mesh, Screen};
///
/// /// Bands of a temperature, 16 levels each, with a dark line between two of them.
/// struct Contours;
///
/// impl Shader for Contours {
///     type Pixel = Rgb565;
///
///     fn pixel([temperature, ..]: [u16; 3], _: [u16; 2]) -> u16 {
///         let (band, rest) = (temperature >> 12, temperature & 0xFFF);
///         match rest {
///             0..0x200 => Rgb565::from_rgb8([20; 3]),
///             _ => Rgb565::from_rgb8([16 * band as u8, 64, 255 - 16 * band as u8]),
///         }
///     }
/// }
///
/// // Cold on the left, hot on the right.
/// let plate = Mesh {
///     positions: &[[-8192_i16, -8192, 0], [8192, -8192, 0], [8192, 8192, 0], [-8192, 8192, 0]],
///     normals: &[],
///     colours: &[[0, 0, 0], [255, 0, 0], [255, 0, 0], [0, 0, 0]],
///     faces: Faces::Triangles(&[[0, 1, 2], [0, 2, 3]]),
/// };
/// let (mut vertices, mut objects) = ([Vertex::EMPTY; 4], [Object::EMPTY; 2]);
/// let (mut bins, mut draws) = ([0; 48], [DrawState::EMPTY; 1]);
/// let memory = Memory {
///     vertices: &mut vertices, places: &mut [], objects: &mut objects, bins: &mut bins, draws: &mut draws,
/// };
/// let mut scene = Scene::<Shaded<Contours>>::new(Screen::new(64, 48)?, memory);
/// scene.begin(&Camera::look_at([0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0], 64.0, 0.1, 10.0)?)?;
/// scene.draw(&Draw::new(plate))?;
/// let (mut cache, mut links) = (FastMemory::<_, 1>::new(), [Link::EMPTY; 2]);
/// let mut renderer = Renderer::new(frame::Memory { cache: &mut cache, links: &mut links, depth: &mut [] });
/// let mut line = [0; 64];
/// renderer.draw_line(&scene, 24, &mut line, 0)?;
/// // 4 levels a pixel: a band is 4 pixels wide, and its first pixel is dark.
/// let dark = Rgb565::from_rgb8([20; 3]);
/// assert!((0..64).all(|x| (line[x] == dark) == (x % 4 == 0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Shader {
    /// The pixels of the line.
    type Pixel: PixelFormat;

    /// The pixel at a column and a line of the picture, by its parameters: 8-bit levels with 8 fraction bits, 0 to 255.0.
    fn pixel(parameters: [u16; 3], at: [u16; 2]) -> <Self::Pixel as PixelFormat>::Word;
}

/// The look of a [`Shader`].
#[derive(Clone, Copy, Debug)]
pub struct Shaded<S>(PhantomData<S>);

/// Half a level, which vertices have for rounding.
const HALF: u16 = 1 << 7;

impl<S: Shader> Look for Shaded<S> {
    type Pixel = S::Pixel;
    type Planes = Planes;
    const EMPTY: Planes = [0; 8];
    const TEXTURED: bool = false;
    /// Fields have 3 and 2 bits below a level, whatever the pixels are.
    const SCALE: Scale = Scale::new([255; 3]);

    fn set_up(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
        wide_shades(of.triangle, planes)
    }

    fn set_up_thin(span: &ThinSpan<'_>, _: u16, _: &Draws<'_>, planes: &mut Planes) {
        thin_shades(span, planes);
    }

    #[inline(never)]
    fn fill(_: Fill, planes: &Planes, place: Place, _: States<'_>, run: &mut [WordOf<Self>]) {
        let [mut value, steps] = wide_at(planes, place);
        for (pixel, column) in run.iter_mut().zip(place.column as u16..) {
            // Planes have 31 bits.
            let parameters = value.map(|value| ((value >> 15) as u16).saturating_sub(HALF));
            *pixel = S::pixel(parameters, [column, place.line as u16]);
            go_on(&mut value, steps, 1);
        }
    }
}
