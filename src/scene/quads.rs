//! Pairs of triangles that are one parallelogram, and are drawn as one (K1, H3).
//!
//! Two triangles that follow on each other in a mesh, share a side, and are a parallelogram both there and on the texture
//! have the same planes of 1/w, u/w and v/w. Where their corners have one colour, one object with four corners draws
//! both, and half as many spans have to be sorted, told apart and begun.
//!
//! The upper one's record stays under its line, and the other's becomes its
//! [second](Object::second). Pairs are joined that are not small and affine, for which places in one word are as cheap;
//! that are thick enough for planes; and whose depths differ by two times at most, so that planes through three corners
//! are as exact at the fourth. A mesh is looked at as far as it has such pairs.

use super::assemble::bin_of;
use super::pass::Pass;
use super::{Budget, DrawState, Object, Scene, Stretch, Vertex, is_affine, range};
use crate::geometry::{Coordinate, Mesh};
use core::hint::black_box as unknown;

/// Units of 1/8 pixel of height and width together, below which what is affine has places in one word.
const SMALL: i32 = 8 * 50;

/// The least thickness, likewise.
const THICK: i32 = 8 * 2;

/// Two triangles with a side in common: the corners of it, as the first one has them, and beside it.
struct Pair {
    side: [u16; 2],
    /// The first one's third corner, and the second one's.
    tips: [u16; 2],
}

impl Pair {
    #[inline(never)]
    fn of(one: &Object, other: &Object) -> Option<Self> {
        let tip = |of: &Object, beside: &Object| {
            let mut corners = unknown(&of.corner[..]).iter();
            corners.position(|corner| !beside.corner.contains(corner))
        };
        let from = |of: &Object, i: usize| {
            let [a, b, c] = of.corner;
            match i {
                0 => [a, b, c],
                1 => [b, c, a],
                _ => [c, a, b],
            }
        };
        let [r, p, q] = from(one, tip(one, other)?);
        let [s, from, to] = from(other, tip(other, one)?);
        ([from, to] == [q, p]).then_some(Self {
            side: [p, q],
            tips: [r, s],
        })
    }

    /// Clockwise, from one end of the side on.
    fn around(&self) -> [u16; 4] {
        let ([p, q], [r, s]) = (self.side, self.tips);
        [p, s, q, r]
    }

    /// Whether it is a parallelogram in a mesh whose vertices begin at `base`, and on its texture.
    fn is_even<C: Coordinate>(&self, mesh: &Mesh<'_, C>, texels: &[[i32; 2]], base: usize) -> bool {
        let at = |i: u16| usize::from(i).wrapping_sub(base);
        let place = |i: u16| mesh.positions.get(at(i));
        let texel = |i: u16| texels.get(at(i));
        let ([p, q], [r, s]) = (self.side, self.tips);
        let (Some(a), Some(b), Some(c), Some(d)) = (place(p), place(q), place(r), place(s)) else {
            return false;
        };
        let sum = |a: C, b: C| i64::from(a.to_q30()) + i64::from(b.to_q30());
        if (0..3).any(|i| sum(a[i], b[i]) != sum(c[i], d[i])) {
            return false;
        }
        let (Some(a), Some(b), Some(c), Some(d)) = (texel(p), texel(q), texel(r), texel(s)) else {
            return false;
        };
        (0..2).all(|i| a[i].wrapping_add(b[i]) == c[i].wrapping_add(d[i]))
    }
}

/// The doubled area of three places that go clockwise, in units of 1/64 pixel.
fn area([a, b, c]: [[i32; 2]; 3]) -> i32 {
    let ways = [b, c].map(|to| [to[0] - a[0], to[1] - a[1]]);
    ways[0][0] * ways[1][1] - ways[1][0] * ways[0][1]
}

impl<L> Scene<'_, '_, L> {
    /// Joins pairs of the triangles of a mesh, from an object on.
    #[inline(never)]
    pub(super) fn join_quads<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        pass: &Pass<'_>,
        first: usize,
    ) {
        let Some(budget) = self.joins(pass) else {
            return;
        };
        let texels = pass.texels.unwrap_or_default();
        let mut at = first;
        while let Some([one, other]) = self.objects.as_slice().get(at..at + 2) {
            let pair = Pair::of(one, other);
            let Some(pair) = pair.filter(|pair| pair.is_even(mesh, texels, pass.base)) else {
                return;
            };
            if self.is_fit(&pair, budget) {
                self.join(at, &pair);
            }
            at += 2;
        }
    }

    /// How exact the draw call's texture is drawn, if its triangles may be joined.
    fn joins(&self, pass: &Pass<'_>) -> Option<Budget> {
        let state = self.draws.as_slice().last()?;
        let (_, budget) = state.texture()?;
        let is_even =
            pass.generated.is_none() && pass.shared > 0 && !DrawState::takes_alphas(state);
        (is_even && state.lamps.is_none() && budget.is_coarse()).then_some(budget)
    }

    /// Whether the corners of a pair have one colour, and whether planes of three serve the fourth.
    #[inline(never)]
    fn is_fit(&self, pair: &Pair, budget: Budget) -> bool {
        let around = pair.around().map(usize::from);
        let mut corners = [Vertex::EMPTY; 4];
        let mut texels = [[0; 2]; 4];
        for (i, at) in around.into_iter().enumerate() {
            let (Some(&vertex), Some(place)) =
                (self.vertices.as_slice().get(at), self.places.get(at))
            else {
                return false;
            };
            (corners[i], texels[i]) = (vertex, place.texel());
        }
        let [a, b, c, d] = corners.map(|v| v.depth);
        let [least, most] = range([a, b, c]);
        let [least, most] = [least.min(d), most.max(d)];
        let is_one = corners.iter().all(|v| v.colour == corners[0].colour);
        if !is_one || least == 0 || most / 2 > least {
            return false;
        }
        let places = corners.map(|v| [v.place & 0xFFFF, v.place >> 16].map(|at| at as i32));
        let extent = |axis: usize| {
            let [a, b, c, d] = places.map(|place| place[axis]);
            let [low, high] = range([a, b, c]);
            high.max(d) - low.min(d)
        };
        let size = extent(0) + extent(1);
        // Each corner with both of its neighbours: what is convex has an area there.
        let [a, b, c, d] = places;
        let areas = [[d, a, b], [a, b, c], [b, c, d], [c, d, a]].map(area);
        if areas.iter().any(|&area| area < THICK * size) {
            return false;
        }
        let [p, s, q, r] = texels;
        let stretch = Stretch::of(&[p, q, r]).and_then(|stretch| stretch.and(p, s));
        let affine = |width: u32| is_affine(width, [least, most], budget);
        stretch.is_some_and(|stretch| size >= SMALL || !affine(stretch.width))
    }

    /// Makes one object of a pair whose first one has this number.
    #[inline(never)]
    fn join(&mut self, at: usize, pair: &Pair) {
        let first = at as u16;
        let objects = self.objects.as_slice().get(at..at + 2);
        let Some(&[one, other]) = objects.and_then(|two| two.first_chunk()) else {
            return;
        };
        let top = |object: &Object| {
            let vertex = self.vertices.as_slice().get(usize::from(object.corner[0]));
            vertex.map_or(u32::MAX, |vertex| vertex.place)
        };
        let ([p, q], [r, s]) = (pair.side, pair.tips);
        let (owner, number, second) = match top(&other) < top(&one) {
            true => (first + 1, first, Object::second(first, r, first + 1, q)),
            false => (first, first + 1, Object::second(first + 1, s, first, p)),
        };
        let lower = if owner == first { &other } else { &one };
        if !self.take_out(lower, number) {
            return;
        }
        if let Some(object) = self.objects.as_mut_slice().get_mut(usize::from(number)) {
            *object = second;
            let start = if self.quads.is_empty() {
                first
            } else {
                self.quads.start
            };
            self.quads = start..first + 2;
        }
    }

    /// The corners of a triangle by its number, the topmost first, whether it was joined to another or not.
    pub(super) fn corners_of(&self, number: usize, object: &Object) -> [u16; 3] {
        let objects = self.objects.as_slice();
        let owner = object.owner(number as u16);
        let Some(owner) = owner.and_then(|owner| objects.get(usize::from(owner))) else {
            return object.corner;
        };
        let [fourth, behind] = object.fourth();
        let [a, b, c] = owner.corner;
        let before = match behind {
            at if at == a => b,
            at if at == b => c,
            _ => a,
        };
        let mut corners = [fourth, before, behind];
        let place = |i: u16| {
            self.vertices
                .as_slice()
                .get(usize::from(i))
                .map(|v| v.place)
        };
        let top = (0..3).min_by_key(|&i| place(corners[i]));
        corners.rotate_left(top.unwrap_or(0));
        corners
    }

    /// Takes an object out of those under its line; whether it was there.
    fn take_out(&mut self, object: &Object, number: u16) -> bool {
        let vertices = self.vertices.as_slice();
        let place = |i: u16| vertices.get(usize::from(i)).map(|v| v.place);
        let (picture, next) = (self.picture(), object.next);
        let [Some(a), Some(b), Some(c)] = object.corner.map(place) else {
            return false;
        };
        let bin = bin_of([a, b, c], &picture);
        let Some(mut at) = bin.and_then(|bin| self.bins.get_mut(bin)) else {
            return false;
        };
        let mut objects = self.objects.as_mut_slice();
        // From the last filed on, each leads to one before it.
        while *at != number {
            let Some((before, rest)) = objects.split_at_mut_checked(usize::from(*at)) else {
                return false;
            };
            let Some(object) = rest.first_mut() else {
                return false;
            };
            (objects, at) = (before, &mut object.next);
        }
        *at = next;
        true
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Affine, Camera, Faces, Mesh, Screen};
    use crate::look::Textured;
    use crate::pixel::Rgb565;
    use crate::scene::{
        Budget, Draw, DrawState, FiledTriangle, Memory, NONE, Object, Scene, Skin, Texture,
        TexturePlace, Vertex,
    };
    use std::vec::Vec;

    /// A square, each of whose corners may be elsewhere in the model and on the texture.
    const SQUARE: [[i16; 3]; 4] = [
        [-8000, -8000, 0],
        [8000, -8000, 0],
        [8000, 8000, 0],
        [-8000, 8000, 0],
    ];
    const PLACES: [[i32; 2]; 4] = [[0, 64 << 8], [64 << 8, 64 << 8], [64 << 8, 0], [0, 0]];
    const FACES: [[u16; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    /// The triangles of such a mesh, turned about y, how many are filed under lines, and the first of these.
    fn drawn(
        (positions, places): (&[[i16; 3]; 4], &[[i32; 2]; 4]),
        colours: &[[u8; 3]],
        faces: &[[u16; 3]],
        (turn, away, budget): (f32, f32, Budget),
    ) -> (Vec<FiledTriangle>, usize, Option<usize>) {
        let (mut vertices, mut records) = ([Vertex::EMPTY; 8], [TexturePlace::EMPTY; 8]);
        let (mut objects, mut bins) = ([Object::EMPTY; 4], [NONE; 240]);
        let mut states = [DrawState::EMPTY; 1];
        let memory = Memory {
            vertices: &mut vertices,
            places: &mut records,
            objects: &mut objects,
            bins: &mut bins,
            draws: &mut states,
        };
        let texels = [0; 4096];
        let texture = Texture::words(&texels, 64, 64).unwrap();
        let mut scene = Scene::<Textured<Rgb565>>::new(Screen::new(320, 240).unwrap(), memory);
        let (eye, up) = ([0.0, 0.3, away], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(eye, [0.0; 3], up, 320.0, 0.1, 100.0).unwrap();
        scene.begin(&camera).unwrap();
        let draw = Draw {
            model: Affine::rotation_y(turn),
            texture: Some(Skin {
                texture: &texture,
                places,
                budget,
            }),
            ..Draw::new(Mesh {
                positions,
                normals: &[],
                colours,
                faces: Faces::Triangles(faces),
            })
        };
        scene.draw(&draw).unwrap();
        let mut filed = 0;
        for &head in &*scene.bins {
            let mut at = head;
            while let Some(object) = scene.objects.as_slice().get(usize::from(at)) {
                (filed, at) = (filed + 1, object.next);
            }
        }
        let first = scene.bins.iter().position(|&head| head != NONE);
        (scene.triangles().collect(), filed, first)
    }

    /// What is joined is read as both triangles.
    ///
    /// Kills: the lower triangle that stays under its line, the upper one that leaves it, corners of a second record that
    /// are read as they lie there, and the questions for texture, colours, depths, thickness and size.
    #[test]
    fn parallelograms_in_perspective_are_joined_and_nothing_else_is() {
        let of = |mesh, colours: &[_], faces: &[_], view| {
            let (triangles, filed, first) = drawn(mesh, colours, faces, view);
            let (turn, away, _) = view;
            let exact = drawn(mesh, colours, faces, (turn, away, Budget::EXACT));
            assert_eq!((&triangles, first), (&exact.0, exact.2));
            assert_eq!(exact.1, exact.0.len());
            triangles.len() - filed
        };
        let square = (&SQUARE, &PLACES);
        let view = (0.6, 2.0, Budget::BALANCED);
        // Whichever half comes first, and whichever is higher.
        let orders = [FACES, [FACES[1], FACES[0]], [[1, 2, 3], [1, 3, 0]]];
        for faces in orders {
            for turn in [-0.6, 0.6] {
                let view = (turn, 2.0, Budget::BALANCED);
                assert_eq!(of(square, &[], &faces, view), 1, "{faces:?} {turn}");
            }
        }
        let mut bent = SQUARE;
        bent[2][2] = 900;
        assert_eq!(of((&bent, &PLACES), &[], &FACES, view), 0);
        let mut skewed = PLACES;
        skewed[1][0] += 256;
        assert_eq!(of((&SQUARE, &skewed), &[], &FACES, view), 0);
        let colours = [[255; 3], [255; 3], [255; 3], [0; 3]];
        assert_eq!(of(square, &colours, &FACES, view), 0);
        assert_eq!(of(square, &[[200; 3]; 4], &FACES, view), 1);
        // Nothing in common; small and affine; seen from the side; twice as near on one side as on the other.
        assert_eq!(of(square, &[], &[[0, 1, 2], [0, 1, 3]], view), 0);
        let far = |turn, away| of(square, &[], &FACES, (turn, away, Budget::BALANCED));
        assert_eq!((far(0.1, 30.0), far(1.56, 2.0)), (0, 0));
        assert_eq!((far(0.6, 0.9), far(0.6, 1.2)), (0, 1));
        assert_eq!(far(0.0, 2.0), 1);
    }
}
