//! Pictures of several parts, and faces that are more than triangles.

use super::{Cells, SLOTS, SNAPS, is_plain, mesh};
use crate::common::Rng;
use crate::hot::cover::{L, Picture, Wanted, add_one, camera_of_part, corners, hits, id, shared};
use crate::hot::{SceneRooms, camera, draw_of, frame, position};
use scanbeam::mesh::QuadSplit;
use scanbeam::scene::{Draw, LARGEST};
use scanbeam::{Cull, Faces, Mesh, Screen};

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
