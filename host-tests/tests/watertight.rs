//! K3, K4, M3: shared edges leave no gap and hit no pixel twice, exactly, for all inputs.
//!
//! Meshes whose corners are put on chosen 1/8-pixel places are drawn through the public API by
//! a pipeline without depth, each triangle in a colour of its own. On each line the number of
//! pixels that were shaded, and at each pixel the triangle that is seen, must be those of a
//! count that is made here with integers, pixel by pixel, from the fill rule's words alone.
//! Where the mesh is a plain patch, that count must also be 1 at every pixel inside it.

pub mod count;

use crate::common::{self, LineRooms, Rng, SceneRooms};
use count::{Count, Place, doubled_area};
use scanbeam::mesh::QuadSplit;
use scanbeam::pipeline::{Counted, FlatPainter, Instance};
use scanbeam::pixel::Rgb888;
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

type P = Counted<FlatPainter<Rgb888>>;

/// A place as a vertex: all lie at distance 1, where a focal length of 4096 pixels makes 2^-15
/// of a coordinate one unit of the screen.
fn vertex(screen: Screen, at: Place) -> [i32; 3] {
    // The principal point is the picture's middle.
    let x = at.0 - 4 * i32::from(screen.width());
    let y = at.1 - 4 * i32::from(screen.height());
    [x << 15, -(y << 15), -1 << 30]
}

fn camera() -> Camera {
    Camera::look_at(
        [0.0; 3],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        4096.0,
        0.5,
        2.0,
    )
    .unwrap()
}

/// Draws and checks; keeps its memory from mesh to mesh.
struct Bench {
    scene: SceneRooms<P>,
    lines: LineRooms<P>,
    triangles: usize,
    pixels: u64,
}

impl Bench {
    fn new() -> Self {
        Self {
            scene: SceneRooms::new(8192, 4096, 8192),
            lines: LineRooms::new(16, 4096, 8192),
            triangles: 0,
            pixels: 0,
        }
    }

    /// Draws triangles, each in its own colour, in the order given and in reverse, and holds
    /// every pixel against [`Count`], which it hands back.
    fn check(&mut self, screen: Screen, triangles: &[[Place; 3]], cull: Cull) -> Count {
        let reversed: Vec<_> = triangles.iter().rev().copied().collect();
        self.check_once(screen, &reversed, cull);
        self.check_once(screen, triangles, cull)
    }

    fn check_once(&mut self, screen: Screen, triangles: &[[Place; 3]], cull: Cull) -> Count {
        // Corners 1 and 2 are shared wherever they lie at the same place; corner 0 carries the
        // triangle's colour. All three corners take their turn as corner 0.
        let mut positions = Vec::new();
        let mut colours = Vec::new();
        let mut shared = std::collections::HashMap::new();
        let mut faces = Vec::new();
        for (id, &corners) in (1u32..).zip(triangles) {
            let turn = id as usize % 3;
            let own = positions.len() as u16;
            positions.push(vertex(screen, corners[turn]));
            let [_, r, g, b] = id.to_be_bytes();
            colours.push([r, g, b]);
            let mut other = |place: Place| {
                *shared.entry(place).or_insert_with(|| {
                    positions.push(vertex(screen, place));
                    colours.push([0; 3]);
                    positions.len() as u16 - 1
                })
            };
            let second = other(corners[(turn + 1) % 3]);
            faces.push([own, second, other(corners[(turn + 2) % 3])]);
        }
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &colours,
            faces: Faces::Triangles(&faces),
        };
        let count = Count::new(screen, triangles, cull);
        self.draw(screen, &mesh, cull, |line, pixels, shaded| {
            let range = count.line(line);
            let hits: u32 = count.hits[range.clone()].iter().sum();
            let context = || format!("{screen:?} {cull:?} line {line} of {triangles:?}");
            assert_eq!(shaded, hits, "pixels shaded, {}", context());
            for (x, (pixel, want)) in pixels.iter().zip(&count.last[range]).enumerate() {
                let id = u32::from_be_bytes([0, pixel[0], pixel[1], pixel[2]]);
                assert_eq!(id, *want, "column {x}, {}", context());
            }
        });
        self.triangles += triangles.len();
        count
    }

    /// Draws a mesh and hands out each line with the number of its pixels that were shaded.
    fn draw(
        &mut self,
        screen: Screen,
        mesh: &Mesh<'_, i32>,
        cull: Cull,
        mut check: impl FnMut(u16, &[[u8; 3]], u32),
    ) {
        let mut scene = self.scene.scene(screen);
        scene.begin(&camera()).unwrap();
        let instance = Instance {
            cull,
            ..Instance::default()
        };
        scene.draw(mesh, &instance).unwrap();
        let mut renderer = self.lines.renderer();
        let mut pixels = vec![[0; 3]; usize::from(screen.width())];
        for line in 0..screen.height() {
            pixels.fill([0; 3]);
            renderer.draw_line(&scene, line, &mut pixels).unwrap();
            let shaded = renderer.take_span_counts().pixels_shaded;
            self.pixels += u64::from(shaded);
            check(line, &pixels, shaded);
        }
    }

    /// The summary, which also holds the test to its size.
    fn done(&self, at_least: usize) {
        assert!(self.triangles >= at_least, "{}", self.triangles);
        println!("{} triangles, {} pixels", self.triangles, self.pixels);
    }
}

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

/// Corners of a patch: cells of `cell` units, each corner moved by up to `jitter`, then put on
/// a multiple of `grid` units plus `offset`.
fn jittered(
    rng: &mut Rng,
    (columns, rows): (usize, usize),
    start: Place,
    cell: i32,
    jitter: i32,
    (grid, offset): (i32, i32),
) -> Vec<Place> {
    let mut places = Vec::new();
    for y in 0..=rows as i32 {
        for x in 0..=columns as i32 {
            let mut put = |from: i32, i: i32| {
                let exact = from + cell * i + rng.within(-jitter, jitter);
                (exact.div_euclid(grid)) * grid + offset
            };
            let column = put(start.0, x);
            places.push((column, put(start.1, y)));
        }
    }
    places
}

/// Grids that reach over all sides of the picture: each pixel is hit once.
#[test]
fn a_patch_hits_every_pixel_once() {
    let mut rng = Rng::new(1);
    let mut bench = Bench::new();
    for round in 0..1500 {
        let screen = Screen::new(rng.pick(&[1, 3, 16, 31, 40]), rng.pick(&[1, 5, 16, 29])).unwrap();
        // Corners anywhere, on pixel centres alone, on pixel borders alone.
        let snap = [(1, 0), (8, 4), (8, 0), (4, 0)][round % 4];
        let cell = rng.within(24, 40);
        // Below this no quad folds over, so the patch is plain.
        let jitter = (cell - 2 * snap.0) / 4;
        let need = |pixels: u16| (8 * i32::from(pixels) / cell + 5) as usize;
        let size = (need(screen.width()), need(screen.height()));
        let grid = jittered(&mut rng, size, (-2 * cell, -2 * cell), cell, jitter, snap);
        let triangles = patch(&grid, size.0, size.1, &mut rng);
        assert!(triangles.iter().all(|&t| doubled_area(t) < 0), "not plain");
        let count = bench.check(screen, &triangles, Cull::Back);
        assert!(count.hits.iter().all(|&h| h == 1), "round {round}");
    }
    bench.done(60_000);
}

/// Grids that fold over, seen from either side or both; many triangles are points or lines.
#[test]
fn folded_patches_hit_as_often_as_they_cover() {
    let mut rng = Rng::new(2);
    let mut bench = Bench::new();
    for round in 0..1000 {
        let screen = Screen::new(24, 20).unwrap();
        let snap = [(1, 0), (8, 4), (4, 0), (16, 4)][round % 4];
        let cell = rng.within(3, 24);
        let jitter = rng.within(cell, 4 * cell);
        let grid = jittered(&mut rng, (10, 10), (-20, -20), cell, jitter, snap);
        let triangles = patch(&grid, 10, 10, &mut rng);
        let cull = rng.pick(&[Cull::Back, Cull::None]);
        bench.check(screen, &triangles, cull);
    }
    bench.done(60_000);
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
        let count = bench.check(screen, &triangles, Cull::None);
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
                    let at = (line * 48 + column) as usize;
                    assert_eq!(count.hits[at] as usize, inside, "{column},{line}: {ring:?}");
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
        bench.check(screen, &triangles, Cull::None);
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
        bench.check(screen, &triangles, Cull::None);
    }
    bench.done(30_000);
}

/// As wide and as high as a picture can be, with corners up to the ends of guard space.
#[test]
fn the_largest_pictures_are_watertight() {
    let mut rng = Rng::new(6);
    let mut bench = Bench::new();
    for (width, height) in [
        (8192, 3),
        (3, 8192),
        (8191, 2),
        (1000, 20),
        (1023, 9),
        (1, 8191),
    ] {
        let screen = Screen::new(width, height).unwrap();
        for round in 0..40 {
            // Guard space in the picture's units; at its outmost 128th corners are clipped.
            let end = 32_600;
            let middle = (4 * i32::from(width), 4 * i32::from(height));
            let place = |rng: &mut Rng, along: i32, across: i32| {
                let (w, h) = (8 * i32::from(width), 8 * i32::from(height));
                let scatter = |rng: &mut Rng, size: i32| match along {
                    0 => rng.within(-40, size + 40),
                    _ => rng.within(-2 * size, 3 * size),
                };
                let (x, y) = (scatter(rng, w), scatter(rng, h) * across);
                (
                    x.clamp(middle.0 - end, middle.0 + end),
                    y.clamp(middle.1 - end, middle.1 + end),
                )
            };
            let hub = place(&mut rng, 0, 1);
            let mut ring: Vec<_> = (0..9).map(|_| place(&mut rng, round % 2, 1)).collect();
            ring.sort_by(|a, b| {
                let angle = |p: &Place| f64::from(p.1 - hub.1).atan2(f64::from(p.0 - hub.0));
                angle(a).total_cmp(&angle(b))
            });
            let triangles: Vec<_> = (0..9).map(|i| [hub, ring[i], ring[(i + 1) % 9]]).collect();
            bench.check(screen, &triangles, Cull::None);
        }
    }
    bench.done(800);
}

/// Quads and quad strips are the triangles that their splits say (K2).
#[test]
fn quads_and_strips_are_watertight() {
    let mut rng = Rng::new(7);
    let mut bench = Bench::new();
    let screen = Screen::new(40, 32).unwrap();
    for round in 0..100 {
        let (columns, rows) = (9usize, 7usize);
        let start = (-8, -8);
        let grid = jittered(&mut rng, (columns, rows), start, 40, 9, (1, 0));
        let positions: Vec<_> = grid.iter().map(|&p| vertex(screen, p)).collect();
        let split = [QuadSplit::Corner0To2, QuadSplit::Corner1To3][round % 2];
        let at = |x: usize, y: usize| (y * (columns + 1) + x) as u16;
        let quads: Vec<_> = (0..columns * rows)
            .map(|i| (i % columns, i / columns))
            .map(|(x, y)| [at(x, y), at(x, y + 1), at(x + 1, y + 1), at(x + 1, y)])
            .collect();
        let strips: Vec<Vec<u16>> = (0..rows)
            .map(|y| {
                (0..=columns)
                    .flat_map(|x| [at(x, y), at(x, y + 1)])
                    .collect()
            })
            .collect();
        let mut hits = vec![0u32; 40 * 32];
        let mut sum = 0;
        let mut count = |_: u16, pixels: &[[u8; 3]], shaded: u32| {
            sum += shaded;
            sum -= pixels.iter().filter(|p| **p != [0; 3]).count() as u32;
        };
        let mesh = |faces| Mesh {
            positions: &positions,
            normals: &[],
            colours: &[],
            faces,
        };
        bench.draw(
            screen,
            &mesh(Faces::Quads(&quads, split)),
            Cull::None,
            &mut count,
        );
        assert_eq!(sum, 0, "a quad hit a pixel twice");
        // Each strip alone, so that it is seen where one strip ends and the next begins.
        for strip in &strips {
            bench.draw(
                screen,
                &mesh(Faces::QuadStrip(strip, split)),
                Cull::None,
                |y, p, n| {
                    assert_eq!(n as usize, p.iter().filter(|p| **p != [0; 3]).count());
                    for (x, _) in p.iter().enumerate().filter(|(_, p)| **p != [0; 3]) {
                        hits[usize::from(y) * 40 + x] += 1;
                    }
                },
            );
        }
        assert!(hits.iter().all(|&h| h == 1), "strips, round {round}");
        bench.triangles += 4 * columns * rows;
    }
    bench.done(25_000);
}

/// Triangles cut at the near plane and at the guard band: neighbours get the same new corners.
#[test]
fn cut_edges_stay_shut() {
    const N: i32 = 6;
    let mut rng = Rng::new(8);
    let mut rooms = SceneRooms::<P>::new(8192, 4096, 64);
    let mut lines = LineRooms::<P>::new(16, 4096, 96);
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
        let mut scene = rooms.scene(screen);
        scene.begin(&camera).unwrap();
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&faces),
        };
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        clipped += scene.draw(&mesh, &instance).unwrap().clipped;
        let mut renderer = lines.renderer();
        for y in 0..64 {
            let pixels = common::line(&mut renderer, &scene, y);
            let counts = renderer.take_span_counts();
            let covered: Vec<_> = (0..96).filter(|&x| pixels[x] != [0; 3]).collect();
            assert_eq!(
                counts.pixels_shaded as usize,
                covered.len(),
                "round {round}, line {y}: hit twice"
            );
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
