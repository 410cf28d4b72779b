//! K2, K3, K4, M3: shared edges leave no gap and hit no pixel twice, exactly, for all inputs.
//!
//! Meshes whose corners are put on chosen 1/8-pixel places are drawn twice: each triangle in a colour of its own, so
//! that the last is seen, and each adding 1 to the pixels that it hits. Both must be what the fill rule's words alone say
//! of triangles, line by line in whole numbers. Where the mesh is a plain patch, each pixel inside it must be hit once.

use crate::common::Rng;
use crate::hot::cover::{
    Bench, L, Picture, Wanted, add_one, camera_of_part, corners, hits, id, shared,
};
use crate::hot::exact::doubled_area;
use crate::hot::{Place, SceneRooms, camera, draw_of, frame, position};
use scanbeam::mesh::QuadSplit;
use scanbeam::scene::{Draw, LARGEST};
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

const SLOTS: [[u16; 2]; 4] = [[128, 4], [0, 64], [3, 0], [31, 128]];

/// A patch of `columns` x `rows` quads whose corners are `grid`, row by row.
fn patch(grid: &[Place], columns: usize, rows: usize, rng: &mut Rng) -> Vec<[Place; 3]> {
    let mut triangles = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            let at = |dx: usize, dy: usize| grid[(y + dy) * (columns + 1) + x + dx];
            let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
            if rng.below(2) == 0 {
                triangles.extend([[a, c, b], [b, c, d]]);
            } else {
                triangles.extend([[a, c, d], [a, d, b]]);
            }
        }
    }
    triangles
}

/// What corners of a patch lie on: multiples of so many units, and so much more.
#[derive(Clone, Copy)]
struct Snap {
    grid: i32,
    offset: i32,
}

const fn snap(grid: i32, offset: i32) -> Snap {
    Snap { grid, offset }
}

/// Corners anywhere, on pixel centres alone, on pixel borders alone, on both.
const SNAPS: [Snap; 4] = [snap(1, 0), snap(8, 4), snap(8, 0), snap(4, 0)];

/// Cells of a patch, from the left and the top on.
#[derive(Clone, Copy)]
struct Cells {
    start: Place,
    /// Units of a side.
    side: i32,
    /// How far a corner may be from its place.
    jitter: i32,
    columns: usize,
    rows: usize,
}

impl Cells {
    /// So many that they reach over all sides of a picture, and so even that no quad folds over.
    fn over(screen: Screen, side: i32, snap: Snap) -> Self {
        let need = |pixels: u16| (8 * i32::from(pixels) / side + 5) as usize;
        Self {
            start: (-2 * side, -2 * side),
            side,
            jitter: (side - 2 * snap.grid) / 4,
            columns: need(screen.width()),
            rows: need(screen.height()),
        }
    }

    fn corners(&self, rng: &mut Rng, snap: Snap) -> Vec<Place> {
        let mut places = Vec::new();
        for y in 0..=self.rows as i32 {
            for x in 0..=self.columns as i32 {
                let mut put = |from: i32, i: i32| {
                    let exact = from + self.side * i + rng.within(-self.jitter, self.jitter);
                    exact.div_euclid(snap.grid) * snap.grid + snap.offset
                };
                places.push((put(self.start.0, x), put(self.start.1, y)));
            }
        }
        places
    }

    fn patch(&self, rng: &mut Rng, snap: Snap) -> Vec<[Place; 3]> {
        let grid = self.corners(rng, snap);
        patch(&grid, self.columns, self.rows, rng)
    }
}

fn is_plain(triangles: &[[Place; 3]]) -> bool {
    triangles.iter().all(|&t| doubled_area(t) < 0)
}

/// Grids that reach over all sides of the picture: each pixel is hit once.
#[test]
fn a_patch_hits_every_pixel_once() {
    let mut rng = Rng::new(1);
    let mut bench = Bench::new();
    for round in 0..1_800 {
        let (size, sides): (_, &[i32]) = match round % 6 {
            0 => (
                rng.pick(&[(320, 240), (1016, 3), (3, 1016)]),
                &[200, 500, 900],
            ),
            _ => (
                (rng.pick(&[1, 3, 16, 31, 40]), rng.pick(&[1, 5, 16, 29])),
                &[24, 31, 40, 60],
            ),
        };
        let screen = Screen::new(size.0, size.1).unwrap();
        let snap = SNAPS[round / 6 % 4];
        let cells = Cells::over(screen, rng.pick(sides), snap);
        let triangles = cells.patch(&mut rng, snap);
        assert!(is_plain(&triangles), "not plain");
        let slots = SLOTS[round % 4];
        let want = bench.check_both_ways(screen, &triangles, Cull::Back, &slots);
        assert!(want.hits.concat().iter().all(|&h| h == 1), "round {round}");
    }
    bench.done(150_000);
}

/// Grids that fold over, seen from either side or both; many triangles are points or lines.
#[test]
fn folded_patches_hit_as_often_as_they_cover() {
    let mut rng = Rng::new(2);
    let mut bench = Bench::new();
    for round in 0..1_000 {
        let screen = Screen::new(24, 20).unwrap();
        let snap = [snap(1, 0), snap(8, 4), snap(4, 0), snap(16, 4)][round % 4];
        let side = rng.within(3, 24);
        let cells = Cells {
            start: (-20, -20),
            side,
            jitter: rng.within(side, 4 * side),
            columns: 10,
            rows: 10,
        };
        let triangles = cells.patch(&mut rng, snap);
        let cull = rng.pick(&[Cull::Back, Cull::None]);
        bench.check_both_ways(screen, &triangles, cull, &SLOTS[round / 4 % 4]);
    }
    bench.done(300_000);
}

/// Triangles around a hub: every pixel is hit once inside the ring, none outside.
#[test]
fn fans_close_around_their_hub() {
    let mut rng = Rng::new(3);
    let mut bench = Bench::new();
    for round in 0..3000 {
        let screen = Screen::new(48, 33).unwrap();
        // On a centre, on a corner of pixels, anywhere, beside the picture.
        let hub = match round % 4 {
            0 => (8 * rng.within(10, 30) + 4, 8 * rng.within(10, 20) + 4),
            1 => (8 * rng.within(10, 30), 8 * rng.within(10, 20)),
            2 => (rng.within(0, 383), rng.within(0, 263)),
            _ => (rng.within(-90, 470), rng.within(-90, 350)),
        };
        let blades = rng.pick(&[3, 5, 17, 64, 200]);
        let reach = rng.pick(&[20, 130, 900]);
        let ring: Vec<Place> = (0..blades)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / f64::from(blades);
                let radius = f64::from(reach) * (0.75 + 0.25 * rng.signed());
                let x = hub.0 + (radius * angle.cos()).round() as i32;
                (x, hub.1 - (radius * angle.sin()).round() as i32)
            })
            .collect();
        let next = |i: usize| ring[(i + 1) % ring.len()];
        let triangles: Vec<_> = (0..ring.len()).map(|i| [hub, ring[i], next(i)]).collect();
        let want = bench.check_both_ways(screen, &triangles, Cull::None, &[128, 4]);
        // Blades of no more than a unit may fold over when their ends are rounded.
        if triangles.iter().all(|&t| doubled_area(t) <= 0) {
            // The ring as one polygon, by the same words of the rule.
            for line in 0..33 {
                for column in 0..48 {
                    let inside = triangles
                        .iter()
                        .enumerate()
                        .filter(|(i, _)| crosses(ring[*i], next(*i), column, line))
                        .count()
                        % 2;
                    let hits = want.hits[line as usize][column as usize];
                    assert_eq!(usize::from(hits), inside, "{column},{line}: {ring:?}");
                }
            }
        }
    }
    bench.done(50_000);
}

/// Whether an edge is left of the pixel's centre, on its line.
fn crosses(a: Place, b: Place, column: i32, line: i32) -> bool {
    let (a, b) = if a.1 <= b.1 { (a, b) } else { (b, a) };
    let (x, y) = (8 * column + 4, 8 * line + 4);
    a.1 < y
        && y <= b.1
        && i64::from(x - a.0) * i64::from(b.1 - a.1) > i64::from(y - a.1) * i64::from(b.0 - a.0)
}

/// Slivers: strips a few units wide and many long, at any slope.
#[test]
fn slivers_add_up_to_their_strip() {
    let mut rng = Rng::new(4);
    let mut bench = Bench::new();
    for _ in 0..6000 {
        let screen = Screen::new(64, 48).unwrap();
        let width = rng.within(1, 9);
        let (from, to) = (
            (rng.within(-100, 612), rng.within(-100, 484)),
            (rng.within(-100, 612), rng.within(-100, 484)),
        );
        let steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
        let steps = rng.within(1, 24);
        let mut sides = Vec::new();
        for i in 0..=steps {
            let on = |a: i32, b: i32| a + (b - a) * i / steps;
            let p = (on(from.0, to.0), on(from.1, to.1));
            let (w, bend) = (rng.within(0, width), rng.within(-1, 1));
            let side = |w: i32| {
                if steep {
                    (p.0 + w, p.1 + bend)
                } else {
                    (p.0 + bend, p.1 + w)
                }
            };
            sides.push((side(0), side(w)));
        }
        let triangles: Vec<_> = sides
            .windows(2)
            .flat_map(|s| [[s[0].0, s[1].0, s[0].1], [s[0].1, s[1].0, s[1].1]])
            .collect();
        bench.check_both_ways(screen, &triangles, Cull::None, &[128, 4]);
    }
    bench.done(30_000);
}

/// Corners from a handful of places, so that most triangles share corners, edges or all.
#[test]
fn coincident_and_degenerate_triangles() {
    let mut rng = Rng::new(5);
    let mut bench = Bench::new();
    for round in 0..3000 {
        let screen = Screen::new(12, 12).unwrap();
        let step = [1, 4, 8, 3][round % 4];
        let start = rng.within(-8, 60);
        let triangles: Vec<_> = (0..64)
            .map(|_| {
                [(); 3].map(|()| {
                    let mut at = || start + step * rng.within(0, 4);
                    (at(), at())
                })
            })
            .collect();
        bench.check_both_ways(screen, &triangles, Cull::None, &[128, 4]);
    }
    bench.done(30_000);
}

fn mesh<'a>(positions: &'a [[i32; 3]], faces: Faces<'a>) -> Mesh<'a, i32> {
    Mesh {
        positions,
        normals: &[],
        colours: &[],
        faces,
    }
}

/// Draws each part of a picture of any size, and puts what `see` says of them together.
fn in_parts<T: Clone + Default>(
    whole: Screen,
    mut see: impl FnMut(Screen, [u16; 2]) -> Picture<T>,
) -> Picture<T> {
    let (width, height) = (whole.width(), whole.height());
    let mut picture = vec![vec![T::default(); width.into()]; height.into()];
    for top in (0..height).step_by(LARGEST.into()) {
        for left in (0..width).step_by(LARGEST.into()) {
            let size = [width - left, height - top].map(|side| side.min(LARGEST));
            let part = Screen::new(size[0], size[1]).unwrap();
            for (line, seen) in picture[top.into()..].iter_mut().zip(see(part, [left, top])) {
                line[left.into()..][..seen.len()].clone_from_slice(&seen);
            }
        }
    }
    picture
}

/// Pictures as large as they can be, of as many parts as that takes: on this grid a part is what the whole picture has
/// there, so that what is watertight is so across parts.
#[test]
fn the_largest_pictures_are_watertight() {
    let mut rng = Rng::new(6);
    let mut rooms = SceneRooms::new(16_384, 8_192, LARGEST.into(), 2);
    let (mut count, mut parts) = (0, 0);
    for (width, height) in [
        (8192, 3),
        (3, 8192),
        (8191, 2),
        (1, 8191),
        (2033, 1017),
        (1023, 9),
    ] {
        let screen = Screen::new(width, height).unwrap();
        for round in 0..4 {
            let snap = SNAPS[round];
            let cells = Cells::over(screen, rng.pick(&[600, 900]), snap);
            let triangles = cells.patch(&mut rng, snap);
            assert!(is_plain(&triangles), "not plain");
            let want = Wanted::new(screen, &triangles, Cull::Back);
            let slots = SLOTS[round];
            // Numbers that are read back from colours have 12 bits.
            assert!(triangles.len() < 4_096);
            let seen = in_parts(screen, |part, from| {
                parts += 1;
                let mut scene = rooms.scene::<L>(part);
                scene.begin(&camera_of_part(screen, part, from)).unwrap();
                let drawn = draw_of(&mut scene, screen, &corners(&triangles), |_| ());
                drawn.expect("there is room");
                let lines = frame(&scene, slots[0], parts % 2 == 0, [0; 3]);
                let ids = lines
                    .into_iter()
                    .map(|line| line.into_iter().map(id).collect());
                ids.collect()
            });
            assert!(seen == want.last, "{screen:?}, round {round}");
            let hit = in_parts(screen, |part, from| {
                let mut scene = rooms.scene::<L>(part);
                scene.begin(&camera_of_part(screen, part, from)).unwrap();
                let (positions, faces) = shared(screen, &triangles);
                let mesh = mesh(&positions, Faces::Triangles(&faces));
                add_one(&mut scene, mesh, Cull::Back);
                hits(&scene, slots[1])
            });
            assert!(
                hit.concat().iter().all(|&h| h == 1),
                "{screen:?}, round {round}"
            );
            count += triangles.len();
        }
    }
    println!("{count} triangles, {parts} parts");
    assert!(count > 5_000 && parts > 100, "{count}, {parts}");
}

/// The triangles of a quad that is split so.
fn halves([a, b, c, d]: [u16; 4], split: QuadSplit) -> [[u16; 3]; 2] {
    match split {
        QuadSplit::Corner0To2 => [[a, b, c], [a, c, d]],
        QuadSplit::Corner1To3 => [[a, b, d], [b, c, d]],
    }
}

/// Quads and quad strips are the triangles that their splits say, and have no pixel twice (K2).
#[test]
fn quads_and_strips_are_watertight() {
    let mut rng = Rng::new(7);
    let mut rooms = SceneRooms::new(8_192, 4_096, 32, 2);
    let screen = Screen::new(40, 32).unwrap();
    for round in 0..100 {
        let cells = Cells {
            start: (-8, -8),
            side: 40,
            jitter: 9,
            columns: 9,
            rows: 7,
        };
        let grid = cells.corners(&mut rng, SNAPS[0]);
        let places = grid.iter().map(|&p| position(screen, p, 1.0, 1.0));
        let positions: Vec<_> = places.collect();
        let colours: Vec<_> = grid
            .iter()
            .map(|_| [(); 3].map(|()| rng.below(256) as u8))
            .collect();
        let split = [QuadSplit::Corner0To2, QuadSplit::Corner1To3][round % 2];
        let at = |x: usize, y: usize| (y * 10 + x) as u16;
        let quad = |x: usize, y: usize| [at(x, y), at(x, y + 1), at(x + 1, y + 1), at(x + 1, y)];
        let quads: Vec<_> = (0..63).map(|i| quad(i % 9, i / 9)).collect();
        let slots = SLOTS[round % 4];
        // How often pixels are hit, and what is seen in the colours of corners, which differ by the split.
        let mut drawn = |faces: Faces<'_>| {
            let mut scene = rooms.scene::<L>(screen);
            scene.begin(&camera()).unwrap();
            add_one(&mut scene, mesh(&positions, faces), Cull::None);
            let hit = hits(&scene, slots[0]).concat();
            scene.begin(&camera()).unwrap();
            let call = Draw {
                cull: Cull::None,
                ..Draw::new(Mesh {
                    colours: &colours,
                    ..mesh(&positions, faces)
                })
            };
            scene.draw(&call).expect("there is room");
            (hit, frame(&scene, slots[1], false, [0; 3]))
        };
        let (hit, seen) = drawn(Faces::Quads(&quads, split));
        assert!(hit.iter().all(|&h| h == 1), "quads, round {round}");
        let triangles: Vec<_> = quads.iter().flat_map(|&quad| halves(quad, split)).collect();
        let same = drawn(Faces::Triangles(&triangles)).1;
        assert!(same == seen, "halves of quads, round {round}");
        // Each strip alone, so that it is seen where one strip ends and the next begins.
        let mut sum = vec![0; hit.len()];
        for y in 0..7 {
            let strip: Vec<_> = (0..10).flat_map(|x| [at(x, y), at(x, y + 1)]).collect();
            let (hit, seen) = drawn(Faces::QuadStrip(&strip, split));
            sum.iter_mut().zip(hit).for_each(|(sum, hits)| *sum += hits);
            let splits = [split, split.other()].into_iter().cycle();
            let triangles: Vec<_> = (0..9)
                .zip(splits)
                .flat_map(|(x, split)| halves(quad(x, y), split))
                .collect();
            let same = drawn(Faces::Triangles(&triangles)).1;
            assert!(same == seen, "halves of a strip, round {round}");
        }
        assert!(sum.iter().all(|&h| h == 1), "strips, round {round}");
    }
}

/// Triangles cut at the near plane and at the guard band: neighbours get the same new corners.
#[test]
fn cut_edges_stay_shut() {
    const N: i32 = 6;
    let mut rng = Rng::new(8);
    let mut rooms = SceneRooms::new(8_192, 4_096, 64, 1);
    let screen = Screen::new(96, 64).unwrap();
    let (mut clipped, mut held) = (0, 0);
    for round in 0..2000 {
        // A floor of jittered cells with a straight rim, around the eye and partly behind it,
        // and low enough that the cut at the near plane itself is often seen.
        let size = rng.pick(&[0.4, 1.0, 1.9]);
        let near: f64 = rng.pick(&[5e-5, 1e-4, 0.003, 0.05]);
        let height = rng.pick(&[0.02, 0.3 * near, 0.02 * near]);
        let mut places = Vec::new();
        for z in 0..=N {
            for x in 0..=N {
                let put = |i: i32, r: f64| {
                    let jitter = if i % N == 0 { 0.0 } else { 0.4 * r };
                    (f64::from(2 * i - N) + jitter) / f64::from(N) * size
                };
                places.push([put(x, rng.signed()), -height, put(z, rng.signed())]);
            }
        }
        let positions: Vec<_> = places
            .iter()
            .map(|p| p.map(|c| (c * f64::from(1 << 30)) as i32))
            .collect();
        let at = |x: i32, z: i32| (z * (N + 1) + x) as u16;
        let mut faces = Vec::new();
        for z in 0..N {
            for x in 0..N {
                let (a, b, c, d) = (at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z));
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        let ahead = [rng.signed(), -height, rng.signed()];
        let focal = rng.pick(&[40.0, 400.0, 9000.0]);
        let camera = Camera::look_at(
            [0.0; 3],
            ahead.map(|c| c as f32),
            [0.0, 1.0, 0.0],
            focal as f32,
            near as f32,
            // Beyond the floor.
            3.2,
        )
        .unwrap();
        // Lines of the picture at which corners of the rim are seen: rounded to 1/8 pixel, a
        // straight rim is straight no more, and a line along it may have holes.
        let level = ahead[0].hypot(ahead[2]);
        let mut rim = Vec::new();
        for (i, p) in (0..).zip(&places) {
            let along = (p[0] * ahead[0] + p[2] * ahead[2]) / level;
            let z = along * level + p[1] * ahead[1];
            let up = p[1] * level - along * ahead[1];
            if (i % (N + 1) % N == 0 || i / (N + 1) % N == 0) && z > 0.0 {
                rim.push(32.0 - focal * up / z);
            }
        }
        let mut scene = rooms.scene::<L>(screen);
        scene.begin(&camera).unwrap();
        add_one(
            &mut scene,
            mesh(&positions, Faces::Triangles(&faces)),
            Cull::None,
        );
        clipped += scene.assembled().clipped;
        for (y, hits) in (0..64u16).zip(hits(&scene, SLOTS[round % 4][0])) {
            assert!(
                hits.iter().all(|&h| h <= 1),
                "round {round}, line {y}: hit twice"
            );
            let covered: Vec<_> = (0..96).filter(|&x| hits[x] > 0).collect();
            let centre = f64::from(y) + 0.5;
            if rim.iter().any(|at| (at - centre).abs() < 1.5) {
                continue;
            }
            // The floor is convex, so that what a line sees of it is in one piece.
            if let (Some(&first), Some(&last)) = (covered.first(), covered.last()) {
                held += 1;
                assert_eq!(
                    last - first + 1,
                    covered.len(),
                    "round {round}, line {y}: a gap in {first}..={last}"
                );
            }
        }
    }
    println!("{clipped} triangles cut, {held} lines without a gap");
    assert!(clipped > 20_000 && held > 10_000, "{clipped}, {held}");
}
