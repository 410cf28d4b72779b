//! The picture as it should be: a renderer in `f64` that shares no arithmetic with `scanbeam`.
//!
//! Conventions, the same as the command line tool's:
//! - The world is right-handed and y is up; the view is a look-at with a vertical field of view. Pixel (0, 0) is at the
//!   top left, its centre at (0.5, 0.5).
//! - Triangles are lit at their own corners, then clipped as polygons in homogeneous space, first at `near`, then at
//!   `far` (both as distances along the view direction), by Sutherland-Hodgman: the output starts with the first corner
//!   that is inside, or with the crossing before it. A corner made by clipping gets its colour by linear interpolation
//!   along the edge in clip space. The polygon is drawn as a fan from the first corner of that output, and within each
//!   triangle of the fan colour and 1/w are linear in *screen* space.
//! - `flat`: the colour of the face's first corner times the light at the geometric normal, which is not turned to the
//!   eye. `gouraud`: each corner's colour times the light at its normal. Light is `A + (1 - A) max(0, N.L)`.
//! - Back-face culling drops what is clockwise on the screen.
//! - The depth test compares 1/w; nearer or equal wins, in submission order.
//! - A texture is perspective-correct: u/w, v/w and 1/w are linear on the screen, and the texel at their quotient
//!   multiplies the colour. Places are linear along an edge that is clipped.
//! - A pixel is covered when `min < x <= max` and `top < y <= bottom` at its centre (K4), evaluated so that a shared edge gives each pixel to one side exactly.
//!
//! An object of the output is a triangle of the model; its id is the index in [`Model::triangles`].
//!
//! | file | there |
//! |---|---|
//! | `raster.rs` | pixels of a triangle, depth, the mask of pixels that rounding may change |
//! | `texel.rs` | textures: what is found at a place |
//! | `compare.rs` | a drawn frame against the reference |

mod compare;
mod raster;
mod texel;

pub use compare::{Comparison, SizeMismatch, TOLERANCE_LEVELS, compare};
pub use texel::{Filter, Sides, TextureMap, Textures};

use crate::model::Model;
use raster::{Raster, ScreenVertex};
use std::fmt;

/// Marks pixels where no object is seen.
pub const NO_OBJECT: u32 = u32::MAX;

/// How light is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Shade {
    /// Vertex colours as they are
    None,
    /// One light level for a face
    Flat,
    /// Light at the corners, linear between
    Gouraud,
}

/// Which triangles are dropped by the side that they show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Cull {
    /// Those that are clockwise on the screen
    Back,
    /// None
    None,
}

/// Camera, light and choices of one picture. [`View::check`] says which values hold together.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Pixels per row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Place of the eye.
    pub eye: [f64; 3],
    /// Place that is seen in the middle of the picture.
    pub at: [f64; 3],
    /// Direction that is up in the picture, of any length.
    pub up: [f64; 3],
    /// Vertical field of view in degrees, above 0 and below 180.
    pub fov: f64,
    /// Nearest distance along the view direction that is drawn, above 0, inclusive.
    pub near: f64,
    /// Farthest distance along the view direction that is drawn, above `near`, inclusive.
    pub far: f64,
    /// Direction to the light, of any length but zero.
    pub light: [f64; 3],
    /// Part of the light that comes from everywhere, `0.0..=1.0`.
    pub ambient: f64,
    /// How light is applied.
    pub shade: Shade,
    /// Which side of triangles is dropped.
    pub cull: Cull,
    /// Red, green, blue where nothing is drawn.
    pub background: [u8; 3],
}

impl Default for View {
    /// What the command line tool uses when nothing is asked.
    fn default() -> Self {
        Self {
            width: 320,
            height: 240,
            eye: [0.0, 0.0, 3.0],
            at: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov: 60.0,
            near: 0.1,
            far: 100.0,
            light: [0.0, 0.0, 1.0],
            ambient: 0.2,
            shade: Shade::None,
            cull: Cull::None,
            background: [0; 3],
        }
    }
}

/// Why a view describes no picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ViewError(&'static str);

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

impl std::error::Error for ViewError {}

/// Below this sine of the angle between up and the view direction, they count as parallel.
const PARALLEL_SINE: f64 = 1e-9;

impl View {
    /// Whether the values describe a picture.
    ///
    /// # Errors
    /// A side of zero, a number that is not finite or does not fit an `f32`, a range that is left, eye and at the same
    /// place, up or light zero, up parallel to the view direction.
    pub fn check(&self) -> Result<(), ViewError> {
        let fits = |v: &[f64; 3]| v.iter().all(|x| x.abs() <= f64::from(f32::MAX));
        let (forward, up) = (unit(sub(self.at, self.eye)), unit(self.up));
        let wrong = if self.width == 0 || self.height == 0 {
            "the picture has no pixels"
        } else if ![self.eye, self.at, self.up, self.light].iter().all(fits) {
            "eye, at, up and light must fit 32-bit floating point"
        } else if !(self.fov > 0.0 && self.fov < 180.0) {
            "fov must be above 0 and below 180 degrees"
        } else if !(self.near > 0.0 && self.near.is_finite()) {
            "near must be above 0"
        } else if !self.far.is_finite() {
            "far must be finite"
        } else if self.near >= self.far {
            "near must be below far"
        } else if !(0.0..=1.0).contains(&self.ambient) {
            "ambient must be from 0 to 1"
        } else if self.light == [0.0; 3] {
            "light must not be zero"
        } else if forward == [0.0; 3] {
            "eye and at are the same place"
        } else if up == [0.0; 3] {
            "up must not be zero"
        } else if length(cross(forward, up)) < PARALLEL_SINE {
            "up is parallel to the view direction"
        } else {
            return Ok(());
        };
        Err(ViewError(wrong))
    }
}

/// Choices of the reference that the command line tool does not have.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// Rounds screen places to this many steps per pixel before anything is drawn, ties towards positive infinity:
    /// 8.0 for 13.3. `None` keeps them exact. It tells errors of arithmetic from those of the number format.
    pub steps_per_pixel: Option<f64>,
}

/// A picture with what is known about each pixel. All lists are row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue in levels `0.0..=255.0`, not rounded.
    pub colour: Vec<[f64; 3]>,
    /// Index of the triangle that is seen, or [`NO_OBJECT`].
    pub object: Vec<u32>,
    /// 1/w of what is seen, larger is nearer; 0 where nothing is.
    pub inverse_w: Vec<f64>,
    /// Where what is seen lies on its texture, in texels from its upper left corner, to the right and down; 0 where
    /// there is none.
    pub place: Vec<[f64; 2]>,
    /// Pixels that a rounded vertex may change: within 1 pixel of a pixel of another object, nearer than 0.75 pixels
    /// to an edge that can be seen, or where two objects are too close in depth to tell which is in front after
    /// their corners moved by 1/8 of a pixel.
    pub near_edge: Vec<bool>,
}

/// Draws a model with exact vertices.
///
/// # Errors
/// See [`View::check`].
pub fn render(model: &Model, view: &View) -> Result<Reference, ViewError> {
    render_with(model, view, Options::default())
}

/// Draws a model without textures. Takes about 80 bytes per pixel and 200 per triangle.
///
/// # Errors
/// See [`View::check`].
pub fn render_with(model: &Model, view: &View, options: Options) -> Result<Reference, ViewError> {
    render_textured(model, Textures::default(), view, options)
}

/// Draws a model with textures.
///
/// # Errors
/// See [`View::check`].
pub fn render_textured(
    model: &Model,
    textures: Textures<'_>,
    view: &View,
    options: Options,
) -> Result<Reference, ViewError> {
    view.check()?;
    let camera = Camera::new(view);
    let light = unit(view.light);
    let lit =
        |normal: [f64; 3]| view.ambient + (1.0 - view.ambient) * dot(unit(normal), light).max(0.0);
    let mut raster = Raster::new(view);
    for (object, corners) in (0..).zip(&model.triangles) {
        let texture = textures.of(object as usize);
        let corners = corners.map(|index| model.vertices[index as usize]);
        let colours = match view.shade {
            Shade::None => corners.map(|v| v.colour),
            Shade::Gouraud => corners.map(|v| scale(v.colour, lit(v.normal))),
            Shade::Flat => {
                let [a, b, c] = corners.map(|v| v.position);
                let normal = cross(sub(b, a), sub(c, a));
                [scale(corners[0].colour, lit(normal)); 3]
            }
        };
        let polygon: Vec<ClipVertex> = corners
            .iter()
            .zip(colours)
            .map(|(vertex, colour)| ClipVertex {
                place: texture.map_or([0.0; 2], |texture| texture.place(vertex.uv)),
                ..camera.clip_vertex(vertex.position, scale(colour, 255.0))
            })
            .collect();
        let polygon = clip(&polygon, |v| v.w - view.near);
        let polygon = clip(&polygon, |v| view.far - v.w);
        let polygon: Vec<ScreenVertex> = polygon
            .iter()
            .map(|vertex| camera.screen_vertex(vertex, options))
            .collect();
        let finite = |v: &ScreenVertex| v.x.is_finite() && v.y.is_finite() && v.q.is_finite();
        if polygon.len() < 3 || !polygon.iter().all(finite) {
            continue;
        }
        // y goes down, so counter-clockwise to the eye has a negative area.
        let clockwise = raster::doubled_area(&polygon) > 0.0;
        if !(clockwise && view.cull == Cull::Back) {
            raster.draw(object, &polygon, texture);
        }
    }
    Ok(raster.finish())
}

/// A corner before the division by w.
#[derive(Clone, Copy)]
struct ClipVertex {
    x: f64,
    y: f64,
    /// Distance along the view direction.
    w: f64,
    /// In levels.
    colour: [f64; 3],
    /// In texels.
    place: [f64; 2],
}

struct Camera {
    eye: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    forward: [f64; 3],
    /// Factors from view space to clip space.
    zoom: [f64; 2],
    /// Half the size of the picture, in pixels.
    half: [f64; 2],
}

impl Camera {
    fn new(view: &View) -> Self {
        let forward = unit(sub(view.at, view.eye));
        let right = unit(cross(forward, unit(view.up)));
        let (width, height) = (f64::from(view.width), f64::from(view.height));
        let zoom = 1.0 / (view.fov.to_radians() / 2.0).tan();
        Self {
            eye: view.eye,
            right,
            up: cross(right, forward),
            forward,
            zoom: [zoom * height / width, zoom],
            half: [width / 2.0, height / 2.0],
        }
    }

    fn clip_vertex(&self, position: [f64; 3], colour: [f64; 3]) -> ClipVertex {
        let from_eye = sub(position, self.eye);
        ClipVertex {
            x: dot(from_eye, self.right) * self.zoom[0],
            y: dot(from_eye, self.up) * self.zoom[1],
            w: dot(from_eye, self.forward),
            colour,
            place: [0.0; 2],
        }
    }

    fn screen_vertex(&self, vertex: &ClipVertex, options: Options) -> ScreenVertex {
        let snap = |x: f64| match options.steps_per_pixel {
            Some(steps) => (x * steps + 0.5).floor() / steps,
            None => x,
        };
        ScreenVertex {
            x: snap((1.0 + vertex.x / vertex.w) * self.half[0]),
            y: snap((1.0 - vertex.y / vertex.w) * self.half[1]),
            q: 1.0 / vertex.w,
            colour: vertex.colour,
            place: vertex.place,
        }
    }
}

/// Keeps the part of a polygon where `inside` is not negative. `inside` must be linear in clip space.
fn clip(polygon: &[ClipVertex], inside: impl Fn(&ClipVertex) -> f64) -> Vec<ClipVertex> {
    let mut output = Vec::with_capacity(polygon.len() + 1);
    for (index, current) in polygon.iter().enumerate() {
        let next = &polygon[(index + 1) % polygon.len()];
        let (d0, d1) = (inside(current), inside(next));
        if d0 >= 0.0 {
            output.push(*current);
        }
        if (d0 >= 0.0) != (d1 >= 0.0) {
            let t = d0 / (d0 - d1);
            let mix = |a: f64, b: f64| a + (b - a) * t;
            output.push(ClipVertex {
                x: mix(current.x, next.x),
                y: mix(current.y, next.y),
                w: mix(current.w, next.w),
                colour: std::array::from_fn(|i| mix(current.colour[i], next.colour[i])),
                place: std::array::from_fn(|i| mix(current.place[i], next.place[i])),
            });
        }
    }
    output
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn scale(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|x| x * factor)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The vector at unit length, or zero where it has none. Scales first, so that neither huge nor tiny ones overflow.
fn unit(a: [f64; 3]) -> [f64; 3] {
    let largest = a.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 {
        return [0.0; 3];
    }
    let scaled = a.map(|x| x / largest);
    scale(scaled, 1.0 / length(scaled))
}
