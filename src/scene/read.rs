//! What pass one has filed, as anyone may read it: a model of other hardware, a tool, a proof.

use super::record::{ORIGIN, Object, TexturePlace, Vertex};
use super::{DrawState, Scene};
use crate::geometry::Colour;
use core::ops::Range;

/// A corner of a triangle that pass one has filed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FiledCorner {
    /// Column in 13.3 from the picture's left rim: a pixel's middle is 4 beyond a multiple of 8. Up to 2,048 pixels from
    /// the picture's middle.
    pub x: i16,
    /// Line in 13.3 from the picture's top, likewise.
    pub y: i16,
    /// `n / w`, above 0 and below 1, in units of 2^-31: w is the distance along the view, and n the largest power of two
    /// that is not beyond the near plane.
    pub depth: u32,
    /// Its lit colour, 0 to 255 a channel, red first: the nearest of what is kept, which is 10 or 11 bits a channel. Where
    /// light falls on pixels, the colour that it falls on.
    pub colour: [u8; 3],
    /// Its place on the texture: across and down, in texels with 14 fraction bits, of which 11 are kept, modulo 2^18
    /// texels; 0 without a texture.
    pub texel: [i32; 2],
    /// How far beyond `x` and `y` that place is meant, in units of 1/64 pixel, -4 to 3; 0 without a texture.
    pub fine: [i8; 2],
}

/// A triangle that pass one has filed: what is left of a face when it is lit, cut, and on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FiledTriangle {
    /// Its corners, the topmost first (of two the left one), clockwise on the screen, with an area above 0.
    pub corners: [FiledCorner; 3],
    /// The number of its [state](Scene::draw_state): that of its draw call, counted from 0. Calls of which nothing is kept
    /// in memory do not count; a shadow volume counts as two, its outside and its inside, and again where the near plane
    /// cuts it.
    pub call: u16,
}

impl FiledTriangle {
    /// The lines on which it may have pixels, counted from the picture's first one: those whose middles lie below its
    /// topmost corner and not below its lowest. Empty where there is none between.
    #[must_use]
    pub fn lines(&self) -> Range<i32> {
        let y = self.corners.map(|corner| i32::from(corner.y));
        let first = |y: i32| (y + 4) >> 3;
        first(y[0].min(y[1]).min(y[2]))..first(y[0].max(y[1]).max(y[2]))
    }
}

impl DrawState<'_> {
    /// Whether pixels of the call hide what is farther, are hidden by what is nearer, and are otherwise the colours of its
    /// corners: whether there is no texture, blend, scissor, dither, shadow, priority, light at pixels or other
    /// comparison of depths.
    #[must_use]
    pub fn is_colours_alone(&self) -> bool {
        let is_plain = self.texture.is_none() && self.lamps.is_none() && self.priority == 0;
        is_plain && !self.has_values() && !self.waits()
    }
}

impl<'t, L> Scene<'_, 't, L> {
    /// What is kept of a draw call, by [its number](FiledTriangle::call).
    #[must_use]
    pub fn draw_state(&self, call: u16) -> Option<&DrawState<'t>> {
        self.draws.as_slice().get(usize::from(call))
    }

    /// The triangles that pass one has filed, in order of submission: pieces of those that were cut, none that is culled
    /// or found no room, those of shadow volumes too. All corners lie on the screen, or beside it.
    ///
    /// ```
    /// use scanbeam::look::Gouraud;
    /// use scanbeam::mesh::ScreenVertex;
    /// use scanbeam::pixel::Rgb565;
    /// use scanbeam::scene::{Draw, DrawState, Memory, Object, Scene, ScreenCorner, Vertex};
    /// use scanbeam::{Camera, Faces, Mesh, Screen};
    ///
    /// let (mut vertices, mut objects) = ([Vertex::EMPTY; 3], [Object::EMPTY; 1]);
    /// let (mut bins, mut draws) = ([0; 48], [DrawState::EMPTY; 1]);
    /// let memory = Memory {
    ///     vertices: &mut vertices, places: &mut [], objects: &mut objects, bins: &mut bins, draws: &mut draws,
    /// };
    /// let mut scene = Scene::<Gouraud<Rgb565>>::new(Screen::new(64, 48)?, memory);
    /// scene.begin(&Camera::look_at([0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0], 64.0, 0.1, 10.0)?)?;
    /// let corner = |x, y, colour| ScreenCorner {
    ///     vertex: ScreenVertex { x, y, depth: 1 << 30, colour },
    ///     ..ScreenCorner::default()
    /// };
    /// let (red, blue) = ([255, 0, 0], [0, 0, 255]);
    /// let empty = Mesh { positions: &[], normals: &[], colours: &[], faces: Faces::Triangles(&[]) };
    /// scene.draw_screen(&Draw::new(empty), &[[corner(80, 8, red), corner(0, 40, blue), corner(160, 90, blue)]])?;
    /// let triangle = scene.triangles().next().unwrap();
    /// let [top, right, left] = triangle.corners;
    /// // Clockwise from the topmost corner on.
    /// assert_eq!([(top.x, top.y), (right.x, right.y), (left.x, left.y)], [(80, 8), (160, 90), (0, 40)]);
    /// assert_eq!((top.colour, left.colour, triangle.call), (red, blue, 0));
    /// // From line 1, whose middle is 12 units down, to line 10 at 84.
    /// assert_eq!(triangle.lines(), 1..11);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn triangles(&self) -> impl DoubleEndedIterator<Item = FiledTriangle> + ExactSizeIterator {
        let (vertices, draws) = (self.vertices.as_slice(), self.draws.as_slice());
        let objects = self.objects.as_slice().iter().enumerate();
        objects.map(move |(number, Object { corner, .. })| {
            let after = draws.partition_point(|draw| usize::from(draw.first) <= number);
            let call = after.saturating_sub(1);
            let state = draws.get(call).unwrap_or(&DrawState::EMPTY);
            let corners = corner.map(|vertex| {
                let at = usize::from(vertex);
                let vertex = vertices.get(at).unwrap_or(&Vertex::EMPTY);
                let place = self.places.get(at).filter(|_| state.texture.is_some());
                self.filed_corner(vertex, place.copied().unwrap_or_default(), || {
                    state.lamps.is_some().then_some(state.colour)
                })
            });
            FiledTriangle {
                corners,
                call: call as u16,
            }
        })
    }

    /// A vertex of a triangle, of a colour of its own or of that of the call.
    fn filed_corner(
        &self,
        vertex: &Vertex,
        place: TexturePlace,
        of_call: impl Fn() -> Option<[u8; 3]>,
    ) -> FiledCorner {
        let from = |place: u32| (place as i32 - 8 * ORIGIN) as i16;
        let own = || Colour::from_word(vertex.colour).to_rgb8(&self.scale);
        FiledCorner {
            x: from(vertex.place & 0xFFFF),
            y: from(vertex.place >> 16),
            depth: vertex.depth,
            colour: of_call().unwrap_or_else(own),
            texel: place.texel(),
            fine: place.fine().map(|units| units as i8),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Camera, Faces, Mesh, Screen};
    use crate::look::{Gouraud, Phong, Textured};
    use crate::pixel::{Rgb565, Rgb888};
    use crate::scene::{Blend, Budget, Draw, Memory, NONE, Object, Skin, Texture};
    use std::vec::Vec;

    const NEAR: f32 = 0.3;
    /// The largest power of two that is not beyond it.
    const UNIT: f64 = 0.25;
    const FOCAL: f32 = 200.0;
    /// What is seen along -z from the origin, at 0.5 to 2.
    const POSITIONS: [[i16; 3]; 4] = [
        [-4000, -3001, -9000],
        [5123, -2000, -8192],
        [777, 6789, -32_768],
        [-9999, 2000, -20_000],
    ];
    const COLOURS: [[u8; 3]; 4] = [[255, 0, 17], [1, 2, 3], [99, 200, 254], [128, 127, 64]];
    const PLACES: [[i32; 2]; 4] = [[0, 1], [-300, 70_000], [1 << 19, -5], [256, 512]];
    const FACES: [[u16; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn mesh() -> Mesh<'static> {
        Mesh {
            positions: &POSITIONS,
            normals: &[],
            colours: &COLOURS,
            faces: Faces::Triangles(&FACES),
        }
    }

    fn read<'t, L: crate::look::Look>(
        draws: &[Draw<'_, 't>],
    ) -> (Vec<FiledTriangle>, Vec<DrawState<'t>>) {
        // Places of what was drawn before.
        let stale = TexturePlace::new([5 << 14; 2], [1; 2]);
        let (mut vertices, mut places) = ([Vertex::EMPTY; 32], [stale; 32]);
        let (mut objects, mut bins) = ([Object::EMPTY; 16], [NONE; 120]);
        let mut states = [DrawState::EMPTY; 4];
        let memory = Memory {
            vertices: &mut vertices,
            places: &mut places,
            objects: &mut objects,
            bins: &mut bins,
            draws: &mut states,
        };
        let mut scene = Scene::<L>::new(Screen::new(160, 120).unwrap(), memory);
        let (eye, at, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        scene
            .begin(&Camera::look_at(eye, at, up, FOCAL, NEAR, 50.0).unwrap())
            .unwrap();
        for draw in draws {
            scene.draw(draw).unwrap();
        }
        let triangles: Vec<_> = scene.triangles().collect();
        assert_eq!(triangles.len(), scene.objects());
        let states = (0..4).map_while(|i| scene.draw_state(i).copied()).collect();
        (triangles, states)
    }

    /// The vertex of the mesh that a corner is, by its colour or, where there is one, by its place on the texture.
    fn vertex_of(corner: &FiledCorner, textured: bool) -> usize {
        let is = |i: &usize| match textured {
            true => PLACES[*i].map(|t| t << 6) == corner.texel,
            false => COLOURS[*i] == corner.colour,
        };
        (0..4).find(is).unwrap()
    }

    /// Dies of another origin, texture places in other units, and of those of another call: all within what rounding leaves
    /// of f64.
    #[test]
    fn corners_are_where_f64_sees_them() {
        static TEXELS: [u16; 64] = [0; 64];
        let texture = Texture::words(&TEXELS, 8, 8).unwrap();
        let plain = Draw::new(mesh());
        let textured = Draw {
            texture: Some(Skin {
                texture: &texture,
                places: &PLACES,
                budget: Budget::BALANCED,
            }),
            ..plain
        };
        let of_colours = read::<Gouraud<Rgb888>>(&[plain]).0;
        let mut of_texels = read::<Textured<Rgb565>>(&[textured, plain]).0;
        for corner in of_texels.split_off(2).iter().flat_map(|t| t.corners) {
            assert_eq!((corner.texel, corner.fine), ([0; 2], [0; 2]));
        }
        for (triangles, has_texture) in [(of_colours, false), (of_texels, true)] {
            assert_eq!(triangles.len(), 2);
            for (triangle, face) in triangles.iter().zip(FACES) {
                let mut seen = triangle.corners.map(|c| vertex_of(&c, has_texture));
                for (corner, &i) in triangle.corners.iter().zip(&seen) {
                    let [x, y, z] = POSITIONS[i].map(|v| f64::from(v) / 16384.0);
                    let at = |v: f64, middle: f64| middle + f64::from(FOCAL) * v / -z;
                    let (x, y) = (at(x, 80.0), at(-y, 60.0));
                    assert!(
                        (f64::from(corner.x) / 8.0 - x).abs() < 0.08,
                        "{corner:?} {x}"
                    );
                    assert!(
                        (f64::from(corner.y) / 8.0 - y).abs() < 0.08,
                        "{corner:?} {y}"
                    );
                    if has_texture {
                        let fine = |v: i16, i: usize| f64::from(8 * v + i16::from(corner.fine[i]));
                        assert!((fine(corner.x, 0) / 64.0 - x).abs() < 0.02);
                        assert!((fine(corner.y, 1) / 64.0 - y).abs() < 0.02);
                    }
                    let depth = f64::from(corner.depth) / f64::from(1u32 << 31);
                    assert!(
                        (depth * -z / UNIT - 1.0).abs() < 1e-4,
                        "{corner:?} {}",
                        UNIT / -z
                    );
                }
                seen.sort_unstable();
                assert_eq!(seen, face.map(usize::from));
            }
        }
    }

    /// Dies where calls are numbered by their objects, and where a call that has more than colours is taken for one that
    /// has not.
    #[test]
    fn triangles_are_those_of_their_calls_and_lines() {
        let plain = Draw::new(mesh());
        let glass = Draw {
            blend: Some(Blend::filter(128)),
            ..plain
        };
        let ranked = Draw {
            priority: 1,
            ..plain
        };
        let (triangles, states) = read::<Gouraud<Rgb888>>(&[plain, glass, ranked]);
        let calls: Vec<_> = triangles.iter().map(|triangle| triangle.call).collect();
        assert_eq!(calls, [0, 0, 1, 1, 2, 2]);
        let alone: Vec<_> = states.iter().map(DrawState::is_colours_alone).collect();
        assert_eq!(alone, [true, false, false]);
        for triangle in &triangles {
            let y = triangle.corners.map(|corner| i32::from(corner.y));
            let (top, bottom) = (*y.iter().min().unwrap(), *y.iter().max().unwrap());
            assert_eq!(y[0], top);
            for line in -40..160 {
                let middle = 8 * line + 4;
                let is_between = top < middle && middle <= bottom;
                assert_eq!(triangle.lines().contains(&line), is_between, "{triangle:?}");
            }
        }
    }

    /// A corner on a line's middle is not above it at the top, and not below it at the bottom.
    #[test]
    fn a_line_belongs_to_what_ends_on_its_middle() {
        for (a, b) in (-20..40_i16).flat_map(|a| (a..40).map(move |b| (a, b))) {
            let corner = |y| FiledCorner {
                y,
                ..FiledCorner::default()
            };
            let triangle = FiledTriangle {
                corners: [corner(a), corner(b), corner(a)],
                call: 0,
            };
            for line in -5..6 {
                let middle = 8 * line + 4;
                let is_between = i32::from(a) < middle && middle <= i32::from(b);
                assert_eq!(
                    triangle.lines().contains(&line),
                    is_between,
                    "{a} {b} {line}"
                );
            }
        }
    }

    /// Dies where the word of a normal is read as a colour.
    #[test]
    fn where_pixels_are_lit_corners_have_the_colour_of_their_call() {
        const NORMALS: [[i16; 3]; 4] = [[0, 0, 16_384]; 4];
        let draw = Draw {
            colour: [3, 200, 77],
            ..Draw::new(Mesh {
                normals: &NORMALS,
                colours: &[],
                ..mesh()
            })
        };
        let (triangles, _) = read::<Phong<Rgb565>>(&[draw]);
        let corners = triangles.iter().flat_map(|triangle| triangle.corners);
        assert!(corners.clone().count() == 6);
        assert!(corners.map(|c| c.colour).all(|c| c == [3, 200, 77]));
    }
}
