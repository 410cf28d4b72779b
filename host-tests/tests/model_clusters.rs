//! Triangles of scenes by blocks and clusters: the pixels of the fast path, each once, and what edge functions cost beside
//! spans (B1, B2, B4, B6).

use crate::hot::exact::within;
use crate::hot::{NO_MESH, SceneRooms, frame};
use scanbeam::Cull;
use scanbeam::look::Gouraud;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::Rgb888;
use scanbeam::scan_out::BlockFrame;
use scanbeam::scene::{Blocked, Draw, FiledTriangle, Scene, ScreenCorner, Shading};
use scanbeam_model::{Cluster, Grid, Traversal};
use scenes::{DRAWS, HEIGHT, OBJECTS, SHOTS, Shot, VERTICES, WIDTH};

type L = Gouraud<Rgb888>;

/// Pixels of a block: a page of 1 KB in 16 bits.
const BLOCK: [u32; 2] = [32, 16];
/// Columns and lines before the picture in the model's space, in units of 1/8 pixel: whole blocks.
const ORIGIN: i32 = 8 * 3072;

fn rooms() -> SceneRooms {
    SceneRooms::new(VERTICES.max(3 * OBJECTS), OBJECTS, HEIGHT.into(), DRAWS)
}

/// The colour of a triangle, by its number.
fn colour(number: usize) -> [u8; 3] {
    let id = number as u32 + 1;
    [id as u8, (id >> 8) as u8, 99]
}

fn id([low, high, _]: [u8; 3]) -> u16 {
    u16::from(low) | u16::from(high) << 8
}

/// Triangles of a shot again, in their order, each of a colour of its own.
fn numbered<'m>(shot: Shot, rooms: &'m mut SceneRooms) -> Scene<'m, 'static, L> {
    let mut own = self::rooms();
    let mut scene = own.scene::<L>(Shot::screen());
    shot.build(&mut scene).unwrap();
    let faces: Vec<_> = scene
        .triangles()
        .enumerate()
        .map(|(number, triangle)| {
            triangle.corners.map(|corner| ScreenCorner {
                vertex: ScreenVertex {
                    x: corner.x,
                    y: corner.y,
                    depth: 1 << 30,
                    colour: colour(number),
                },
                ..ScreenCorner::default()
            })
        })
        .collect();
    let mut scene = rooms.scene::<L>(Shot::screen());
    scene.begin(&crate::hot::camera()).unwrap();
    let call = Draw {
        cull: Cull::None,
        shading: Shading::Flat,
        ..Draw::new(NO_MESH)
    };
    scene.draw_screen(&call, &faces).unwrap();
    assert_eq!(scene.objects(), faces.len());
    scene
}

/// The corners of a triangle in the model's space.
fn corners(triangle: &FiledTriangle) -> [(u16, u16); 3] {
    let at = |v: i16| (i32::from(v) + ORIGIN) as u16;
    triangle.corners.map(|c| (at(c.x), at(c.y)))
}

/// The pixels of a cluster that lie in the picture.
fn shown(cluster: Cluster) -> impl Iterator<Item = (u16, u16)> {
    let origin = ORIGIN / 8;
    let pixels = cluster.pixels().map(move |(x, y)| (x - origin, y - origin));
    let is_shown =
        |(x, y): &(i32, i32)| (0..WIDTH.into()).contains(x) && (0..HEIGHT.into()).contains(y);
    pixels.filter(is_shown).map(|(x, y)| (x as u16, y as u16))
}

/// Painted in order of submission, pixel by pixel into blocks, by one renderer and by several.
#[test]
fn clusters_paint_the_pictures_of_the_fast_path() {
    let [across, down] = BLOCK.map(u32::ilog2);
    let block = Blocked::new(across, down).unwrap();
    for shot in SHOTS {
        let mut rooms = rooms();
        let scene = numbered(shot, &mut rooms);
        let fast = frame(&scene, 64, false, [0; 3]);
        for factor in [(1, 1), (2, 1), (3, 2)] {
            let mut words = vec![0_u16; BlockFrame::<u16>::needed(WIDTH, HEIGHT, block)];
            let mut picture = BlockFrame::new(&mut words, WIDTH, HEIGHT, block).unwrap();
            // Each of several renderers has its own clusters, and all triangles.
            for renderer in 0..factor.0 * factor.1 {
                let own = (renderer % factor.0, renderer / factor.0);
                let grid = Grid::new((4, 2), BLOCK[0] as u16).unwrap();
                let grid = grid.interleaved(factor, own).unwrap();
                for (number, triangle) in (1..).zip(scene.triangles()) {
                    let clusters = Traversal::new(corners(&triangle), grid);
                    for (x, y) in clusters.flat_map(shown) {
                        assert!(picture.set_word(x, y, number));
                    }
                }
            }
            for (y, line) in (0..).zip(&fast) {
                for (x, &pixel) in (0..).zip(line) {
                    let number = match pixel {
                        [0, 0, 0] => 0,
                        pixel => id(pixel),
                    };
                    let painted = picture.word(x, y);
                    assert_eq!(painted, Some(number), "{} {x}, {y}", shot.name());
                }
            }
        }
    }
}

/// What a scene takes either way.
#[derive(Default)]
struct Cost {
    pixels: u64,
    /// Lines of triangles, each with two sides.
    spans: u64,
    /// Clusters whose edge functions were taken, and those that have a pixel.
    looked_at: u64,
    found: u64,
    /// Blocks that were opened, by clusters and by spans.
    by_clusters: u32,
    by_spans: u32,
}

fn cost(scene: &Scene<'_, '_, L>) -> Cost {
    let [across, down] = BLOCK.map(u32::ilog2);
    let block = Blocked::new(across, down).unwrap();
    let grid = Grid::new((4, 2), BLOCK[0] as u16).unwrap();
    let needed = BlockFrame::<u16>::needed(WIDTH, HEIGHT, block);
    let mut memories = [vec![0_u16; needed], vec![0; needed]];
    let mut frames = memories
        .each_mut()
        .map(|words| BlockFrame::new(words, WIDTH, HEIGHT, block).unwrap());
    let mut cost = Cost::default();
    for triangle in scene.triangles() {
        let mut clusters = Traversal::new(corners(&triangle), grid);
        let mut pixels = 0;
        for cluster in clusters.by_ref() {
            cost.found += 1;
            for (x, y) in shown(cluster) {
                pixels += 1;
                frames[0].set_word(x, y, 1);
            }
        }
        cost.looked_at += u64::from(clusters.looked_at());
        let places = triangle.corners.map(|c| (c.x.into(), c.y.into()));
        let mut of_spans = 0;
        for y in triangle.lines().start.max(0)..triangle.lines().end.min(HEIGHT.into()) {
            cost.spans += 1;
            for x in within(places, y, WIDTH) {
                of_spans += 1;
                frames[1].set_word(x as u16, y as u16, 1);
            }
        }
        assert_eq!(pixels, of_spans, "{triangle:?}");
        cost.pixels += pixels;
    }
    [cost.by_clusters, cost.by_spans] = frames.map(|frame| frame.page_changes());
    cost
}

/// The figures of the guide. A side of a span is one product and a sum; a cluster that is looked at takes three functions
/// at its corner, and one that has a pixel three at each of its eight pixels.
#[test]
fn edge_functions_take_more_than_sides_of_spans() {
    for shot in [Shot::Teapot, Shot::Cube, Shot::Sphere, Shot::Quads] {
        let mut rooms = rooms();
        let cost = cost(&numbered(shot, &mut rooms));
        let sides = 2 * cost.spans;
        let functions = 3 * cost.looked_at + 24 * cost.found;
        println!(
            "{:8}: {} pixels; {sides} sides of spans, {functions} edge functions; {} clusters looked at, {} found; blocks opened: {} by clusters, {} by spans",
            shot.name(),
            cost.pixels,
            cost.looked_at,
            cost.found,
            cost.by_clusters,
            cost.by_spans,
        );
        assert!(functions > 4 * sides, "{}", shot.name());
        assert!(cost.by_clusters <= cost.by_spans, "{}", shot.name());
    }
}
