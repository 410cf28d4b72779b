//! Pictures of triangles whose corners lie on chosen 1/8 pixels, against the words of the fill rule: which of them is
//! seen at a pixel, and how often each pixel is hit.

use super::exact::{doubled_area, within};
use super::{Corner, Place, SceneRooms, camera, draw, frame, position};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{Blend, Draw, Scene};
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};
use std::collections::HashMap;

pub type L = Gouraud<Rgb888>;
/// Something for each pixel.
pub type Picture<T> = Vec<Vec<T>>;
/// As far from the picture's middle as a corner can be without being cut off, in units of 1/8 pixel.
pub const GUARD: i32 = (1 << 14) - 3;

/// A triangle's colour, by number from 1; far enough apart to be read back from any pixel.
fn colour(id: usize) -> [u8; 3] {
    [0, 4, 8].map(|shift| ((id >> shift & 15) * 17) as u8)
}

/// The number of the triangle that has a colour; 0 for none.
pub fn id(pixel: [u8; 3]) -> usize {
    (0..3).fold(0, |id, i| {
        id | ((usize::from(pixel[i]) + 8) / 17) << (4 * i)
    })
}

/// Triangles with a colour each.
pub fn corners(triangles: &[[Place; 3]]) -> Vec<[Corner; 3]> {
    let of = |(id, places): (usize, &[Place; 3])| {
        places.map(|at| Corner {
            at,
            w: 1.0,
            colour: colour(id),
        })
    };
    (1..).zip(triangles).map(of).collect()
}

/// By the fill rule alone: the number of the last triangle at each pixel, and how many there are.
pub struct Wanted {
    pub last: Picture<usize>,
    pub hits: Picture<u8>,
}

impl Wanted {
    pub fn new(screen: Screen, triangles: &[[Place; 3]], cull: Cull) -> Self {
        let mut last = vec![vec![0; screen.width().into()]; screen.height().into()];
        let mut hits = vec![vec![0u8; screen.width().into()]; screen.height().into()];
        for (id, &triangle) in (1..).zip(triangles) {
            if cull == Cull::Back && doubled_area(triangle) > 0 {
                continue;
            }
            let lines = triangle.map(|(_, y)| y);
            let [low, high] = [lines.iter().min(), lines.iter().max()]
                .map(|y| y.map_or(0, |y| y.div_euclid(8).clamp(0, screen.height().into())));
            for y in low..(high + 1).min(screen.height().into()) {
                let columns = within(triangle, y, screen.width());
                last[y as usize][columns.clone()].fill(id);
                for hit in &mut hits[y as usize][columns] {
                    *hit = hit.saturating_add(1);
                }
            }
        }
        Self { last, hits }
    }
}

/// Draws a mesh that adds 1 to each pixel that it hits.
pub fn add_one(scene: &mut Scene<'_, 'static, L>, mesh: Mesh<'_, i32>, cull: Cull) {
    let call = Draw {
        cull,
        colour: [1; 3],
        blend: Some(Blend::add(255)),
        ..Draw::new(mesh)
    };
    scene.draw(&call).expect("there is room");
}

/// How often each pixel of a scene of [`add_one`] is hit: a painter adds them up, whatever lies before what.
pub fn hits(scene: &Scene<'_, '_, L>, slots: u16) -> Picture<u8> {
    let lines = frame(scene, slots, false, [0; 3]).into_iter();
    lines
        .map(|line| line.into_iter().map(|pixel| pixel[0]).collect())
        .collect()
}

/// How much more often a pixel is hit from the front than from behind, by what [`Cull::Back`] leaves of its hits. A mesh
/// that covers each pixel once has -1, 0 or 1, even where a thin triangle folds over as its corners are rounded: that
/// hits once more from one side, and once from the other.
pub fn balance(front: u8, all: u8) -> i32 {
    2 * i32::from(front) - i32::from(all)
}

/// Keeps its memory from scene to scene.
pub struct Bench {
    pub rooms: SceneRooms,
    pub triangles: usize,
}

impl Bench {
    pub fn new() -> Self {
        Self {
            rooms: SceneRooms::new(16_384, 8_192, 1_016, 8),
            triangles: 0,
        }
    }

    /// Holds a picture against the rule, with depth and without, with so many slots; all triangles are equally far, so
    /// the last is seen in either case. Hands back what the rule says.
    pub fn check(
        &mut self,
        screen: Screen,
        triangles: &[[Place; 3]],
        cull: Cull,
        slots: &[u16],
    ) -> Wanted {
        let want = Wanted::new(screen, triangles, cull);
        self.check_seen(screen, triangles, cull, slots, &want);
        self.check_hits(screen, triangles, cull, slots[0], &want);
        self.triangles += triangles.len();
        want
    }

    /// The same of triangles in the order given and in reverse, so that what is hidden by others is seen once.
    pub fn check_both_ways(
        &mut self,
        screen: Screen,
        triangles: &[[Place; 3]],
        cull: Cull,
        slots: &[u16],
    ) -> Wanted {
        let reversed: Vec<_> = triangles.iter().rev().copied().collect();
        self.check(screen, &reversed, cull, slots);
        self.check(screen, triangles, cull, slots)
    }

    fn check_seen(
        &mut self,
        screen: Screen,
        triangles: &[[Place; 3]],
        cull: Cull,
        slots: &[u16],
        want: &Wanted,
    ) {
        let mut scene = self.rooms.scene::<L>(screen);
        scene.begin(&camera()).unwrap();
        draw(&mut scene, &corners(triangles), cull).unwrap();
        let use_of = scene.assembled();
        assert_eq!(use_of.clipped, 0, "places lie within the guard band");
        assert_eq!(use_of.triangles as usize, triangles.len());
        assert_eq!(
            use_of.culled as usize + scene.objects(),
            triangles.len(),
            "each is culled or kept"
        );
        for (&slots, depth) in slots.iter().zip([false, true].into_iter().cycle()) {
            let got = frame(&scene, slots, depth, [0; 3]);
            for (y, (got, want)) in got.iter().zip(&want.last).enumerate() {
                for (x, (&pixel, &want)) in got.iter().zip(want).enumerate() {
                    assert_eq!(
                        id(pixel),
                        want,
                        "{x}, {y} of {screen:?} {cull:?}, {slots} slots, depth {depth}: {triangles:?}"
                    );
                }
            }
        }
    }

    fn check_hits(
        &mut self,
        screen: Screen,
        triangles: &[[Place; 3]],
        cull: Cull,
        slots: u16,
        want: &Wanted,
    ) {
        let mut scene = self.rooms.scene::<L>(screen);
        scene.begin(&camera()).unwrap();
        let (positions, faces) = shared(screen, triangles);
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&faces),
        };
        add_one(&mut scene, mesh, cull);
        for (y, (got, want)) in hits(&scene, slots).iter().zip(&want.hits).enumerate() {
            assert_eq!(
                got, want,
                "line {y} of {screen:?} {cull:?}, {slots} slots: {triangles:?}"
            );
        }
    }

    /// The summary, which also holds the test to its size.
    pub fn done(&self, at_least: usize) {
        println!("{} triangles", self.triangles);
        assert!(self.triangles >= at_least, "{}", self.triangles);
    }
}

/// Triangles that share vertices wherever corners lie at the same place, each beginning with another of its corners.
pub fn shared(screen: Screen, triangles: &[[Place; 3]]) -> (Vec<[i32; 3]>, Vec<[u16; 3]>) {
    let (mut positions, mut known) = (Vec::new(), HashMap::new());
    let mut of = |place: Place| {
        *known.entry(place).or_insert_with(|| {
            positions.push(position(screen, place, 1.0, 1.0));
            positions.len() as u16 - 1
        })
    };
    let faces = (0..)
        .zip(triangles)
        .map(|(number, corners)| [0, 1, 2].map(|k| of(corners[(number + k) % 3])));
    let faces = faces.collect();
    (positions, faces)
}

/// [`camera`], for the part of a picture of this size that begins at a column and a line.
pub fn camera_of_part(whole: Screen, part: Screen, from: [u16; 2]) -> Camera {
    let middle = |from: u16, part: u16, whole: u16| {
        f32::from(from) + (f32::from(part) - f32::from(whole)) / 2.0
    };
    let right = middle(from[0], part.width(), whole.width());
    let down = middle(from[1], part.height(), whole.height());
    camera()
        .shifted([right, down])
        .expect("within 8,192 pixels")
}
