//! Texels on a ground plane that goes through a near plane of 0.02, against f64: its edges are
//! cut far outside of the picture, and what is shown is read back from the picture (X13, H4, X2).
//!
//! Wanted at [`Budget::EXACT`] are 0.3 % of another texel at most. Pixels whose texel was another one when this was
//! written, of 22,000 each:
//!
//! | roll | exact | balanced | fast |
//! |---|---|---|---|
//! | 0 | 0.00 % | 0.16 % | 0.16 % |
//! | 7 | 0.25 % | 1.45 % | 1.45 % |
//! | -31 | 0.20 % | 1.67 % | 1.65 % |
//!
//! Two roundings are small enough for that: planes count in a unit that is fine enough for what the picture shows, since
//! the guard band puts the nearest corner 2,000 pixels below the middle, where 1/w is 16 and more times as large; and
//! places of corners that are cut keep 11 fraction bits.

use host_tests::rooms::{Room, picture as drawn};
use scanbeam::look::Textured;
use scanbeam::pixel::Rgb565;
use scanbeam::scene::{Budget, Draw, Skin, Texture};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

const WIDTH: usize = 320;
/// Texels a side: each is named by its word.
const SIDE: u32 = 128;
const BACKGROUND: u16 = 0xFFFF;

/// Half the ground's extent across and along, and where its middle lies: from 2 behind the eye to 88 before it.
const HALF: [f64; 2] = [40.0, 45.0];
const MIDDLE: [f64; 2] = [0.0, -43.0];
/// Texels from one end to the other, across and along.
const TEXELS: [i32; 2] = [640, 720];

static POSITIONS: [[i16; 3]; 4] = [
    [-16384, 0, 16384],
    [16384, 0, 16384],
    [16384, 0, -16384],
    [-16384, 0, -16384],
];
static FACES: [[u16; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const PLACES: [[i32; 2]; 4] = [
    [0, 0],
    [TEXELS[0] << 8, 0],
    [TEXELS[0] << 8, TEXELS[1] << 8],
    [0, TEXELS[1] << 8],
];

/// How the camera is held: one above the ground, turned about its axis by so many degrees.
fn up(roll: f64) -> [f64; 3] {
    let (sin, cos) = roll.to_radians().sin_cos();
    [sin, cos, 0.0]
}

fn picture(budget: Budget, roll: f64) -> Vec<u16> {
    let words: Vec<u16> = (0..SIDE * SIDE).map(|i| i as u16).collect();
    let texture = Texture::words(&words, SIDE, SIDE).unwrap();
    let eye = [0.0; 3];
    let camera = Camera::look_at(
        eye,
        [0.0, 0.0, -1.0],
        up(roll).map(|c| c as f32),
        320.0,
        0.02,
        200.0,
    );
    let rows = [
        [HALF[0] as f32, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, HALF[1] as f32],
    ];
    let offset = [MIDDLE[0] as f32, -1.0, MIDDLE[1] as f32];
    let draw = Draw {
        model: Affine::from_rows(rows, offset).unwrap(),
        cull: Cull::None,
        texture: Some(Skin {
            texture: &texture,
            places: &PLACES,
            budget,
        }),
        ..Draw::new(Mesh {
            positions: &POSITIONS,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&FACES),
        })
    };
    let room = Room {
        vertices: 64,
        places: 64,
        objects: 64,
        draws: 1,
    };
    let screen = Screen::new(320, 240).unwrap();
    let drawn = drawn::<_, Textured<Rgb565>>(screen, room, BACKGROUND, |scene| {
        scene.begin(&camera.unwrap())?;
        scene.draw(&draw)?;
        Ok(())
    });
    drawn.unwrap()
}

/// The place that a ray through a pixel's centre meets, and how many texels lie between it and the one below: `None`
/// where that is the sky, the ground's end, or less than two pixels from either.
fn place(roll: f64, x: usize, y: usize) -> Option<([f64; 2], f64)> {
    let [right_y, up_y] = {
        let [sin, cos, _] = up(roll);
        [-sin, cos]
    };
    let right_x = up_y;
    let up_x = -right_y;
    let at = |x: f64, y: f64| {
        let (across, above) = ((x - 160.0) / 320.0, (120.0 - y) / 320.0);
        let down = -(across * right_y + above * up_y);
        let ahead = down.recip();
        let world = [(across * right_x + above * up_x) * ahead, -ahead];
        let is_on = down > 0.0 && (0..2).all(|i| (world[i] - MIDDLE[i]).abs() < HALF[i]);
        is_on.then(|| {
            let part = |i: usize| (world[i] - MIDDLE[i]) / HALF[i];
            let of = [part(0), -part(1)];
            [0, 1].map(|i| (of[i] + 1.0) / 2.0 * f64::from(TEXELS[i]))
        })
    };
    let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
    for (dx, dy) in [(-2.0, 0.0), (2.0, 0.0), (0.0, -2.0), (0.0, 2.0)] {
        at(x + dx, y + dy)?;
    }
    let (here, below) = (at(x, y)?, at(x, y + 1.0)?);
    let way = (here[0] - below[0]).abs().max((here[1] - below[1]).abs());
    Some((here, way))
}

/// Whether a word names the texel of a place, or one of those whose common edge it lies on.
fn names(word: u16, place: [f64; 2]) -> bool {
    const ON_THE_EDGE: f64 = 1e-9;
    let is_at = |axis: usize, texel: u32| {
        let at = |off: f64| (place[axis] + off).floor().rem_euclid(f64::from(SIDE));
        [-ON_THE_EDGE, ON_THE_EDGE]
            .map(at)
            .contains(&f64::from(texel))
    };
    let word = u32::from(word);
    is_at(0, word % SIDE) && is_at(1, word / SIDE)
}

/// The part of pixels that show another texel, of those whose texels are no smaller than pixels: with smaller ones
/// the snapping of the screen shows.
fn wrong_part(budget: Budget, roll: f64) -> f64 {
    let (mut inner, mut wrong) = (0, 0);
    for (i, got) in picture(budget, roll).into_iter().enumerate() {
        let Some((place, way)) = place(roll, i % WIDTH, i / WIDTH) else {
            continue;
        };
        if way > 1.0 {
            continue;
        }
        inner += 1;
        wrong += u32::from(!names(got, place));
    }
    assert!(inner > 10_000, "{inner}");
    let part = f64::from(wrong) / f64::from(inner);
    println!(
        "{roll}, {budget:?}: {wrong} of {inner} pixels, {:.3} %",
        100.0 * part
    );
    part
}

/// Kills: planes whose rounded steps are followed from a corner to the picture, corners that are cut at 1/8 pixel, a
/// stride of one budget for another.
#[test]
fn a_ground_that_the_near_plane_cuts_shows_the_texels_of_f64() {
    for (roll, exact, coarse) in [
        (0.0, 0.0005, 0.0025),
        (7.0, 0.003, 0.0155),
        (-31.0, 0.003, 0.0177),
    ] {
        let budgets = [
            (Budget::EXACT, exact),
            (Budget::BALANCED, coarse),
            (Budget::FAST, coarse),
        ];
        for (budget, most) in budgets {
            let part = wrong_part(budget, roll);
            assert!(part <= most, "{roll}, {budget:?}: {part}");
        }
    }
}
