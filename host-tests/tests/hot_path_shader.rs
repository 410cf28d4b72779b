//! K15: parameters of one's own in vertices reach pixels: by a look that this file defines, and that no room knows.
//!
//! A pixel of 32 bits holds two parameters of 16 bits as they come, so that each is held against f64: vertices keep whole
//! levels, planes have 20 bits more, and a parameter is cut to 1/256 of a level.

use crate::common::Rng;
use crate::hot::exact::{weights, within};
use crate::hot::{Corner, LineRooms, SceneRooms, camera, draw_with};
use scanbeam::look::{Shaded, Shader};
use scanbeam::pixel::Xrgb8888;
use scanbeam::scene::{Blend, Scissor};
use scanbeam::{Cull, Screen};

/// The first two parameters.
struct Pair;

impl Shader for Pair {
    type Pixel = Xrgb8888;

    fn pixel([first, second, _]: [u16; 3], _: [u16; 2]) -> u32 {
        u32::from(first) << 16 | u32::from(second)
    }
}

/// The third one, and where the pixel is.
struct Third;

impl Shader for Third {
    type Pixel = Xrgb8888;

    fn pixel([_, _, third]: [u16; 3], [column, line]: [u16; 2]) -> u32 {
        u32::from(third) << 16 | u32::from(column) << 8 | u32::from(line)
    }
}

/// What no shader makes: no parameter is above 255.0.
const NOTHING: u32 = 0xFFFF_FFFF;

/// The picture of a triangle and what a call has beside it, with so many slots.
fn picture<S: Shader<Pixel = Xrgb8888>>(
    screen: Screen,
    corners: [Corner; 3],
    slots: u16,
    scissor: Option<Scissor>,
) -> Vec<Vec<u32>> {
    let mut rooms = SceneRooms::of_triangles(1, screen);
    let mut scene = rooms.scene::<Shaded<S>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    let drawn = draw_with(&mut scene, &[corners], |draw| {
        (draw.cull, draw.scissor) = (Cull::None, scissor);
    });
    drawn.expect("there is room");
    let mut lines = LineRooms::fitting(&scene, slots, true);
    let mut renderer = lines.renderer();
    let width = usize::from(screen.width());
    let line = |y| {
        let mut pixels = vec![NOTHING; width];
        let drawn = renderer.draw_line(&scene, y, &mut pixels, NOTHING);
        drawn.expect("the memory suffices");
        pixels
    };
    scene.lines().map(line).collect()
}

fn some_corners(rng: &mut Rng, screen: Screen) -> [Corner; 3] {
    let size = rng.pick(&[10, 60, 300, 2_000]);
    let middle = [screen.width(), screen.height()].map(|side| rng.within(0, 8 * i32::from(side)));
    // Thin ones too.
    let thin = rng.pick(&[1, 1, 40]);
    [(); 3].map(|()| Corner {
        at: (
            middle[0] + rng.within(-size, size) / thin,
            middle[1] + rng.within(-size, size),
        ),
        w: 1.0,
        colour: [(); 3].map(|()| {
            let any = rng.below(256) as u8;
            rng.pick(&[0, 255, any])
        }),
    })
}

/// Kills: planes in another order, half a level that stays, a step that is left out, a place of another pixel.
#[test]
fn every_pixel_has_the_parameters_of_its_place() {
    let (mut rng, mut pixels, mut worst) = (Rng::new(1_911), 0, 0.0f64);
    for round in 0..600 {
        let screen = Screen::new(rng.pick(&[40, 160]), 24).expect("a screen");
        let corners = some_corners(&mut rng, screen);
        let slots = round % 3;
        let pair = picture::<Pair>(screen, corners, slots, None);
        let third = picture::<Third>(screen, corners, slots, None);
        for y in 0..screen.height() {
            let columns = within(corners.map(|c| c.at), y.into(), screen.width());
            for x in 0..usize::from(screen.width()) {
                let (pair, third) = (pair[usize::from(y)][x], third[usize::from(y)][x]);
                if !columns.contains(&x) {
                    assert_eq!([pair, third], [NOTHING; 2], "{x}, {y} of {corners:?}");
                    continue;
                }
                assert_eq!(third & 0xFFFF, (x as u32) << 8 | u32::from(y));
                let (part, _) = weights(corners.map(|c| c.at), x as i32, y.into());
                for (i, got) in [pair >> 16, pair & 0xFFFF, third >> 16]
                    .into_iter()
                    .enumerate()
                {
                    let exact: f64 = (0..3)
                        .map(|k| part[k] * f64::from(corners[k].colour[i]))
                        .sum();
                    let off = (f64::from(got) - 256.0 * exact).abs();
                    worst = worst.max(off);
                    assert!(
                        off <= 1.1,
                        "{i}: {got} for {exact} levels, {x}, {y}, {slots} slots: {corners:?}"
                    );
                }
                pixels += 1;
            }
        }
    }
    println!("{pixels} pixels, at most {worst:.2} of 1/256 level off");
    assert!(pixels > 60_000, "{pixels}");
}

/// What a call has beside its look is that of any look: a scissor cuts it, and what is blended is drawn over the rest.
#[test]
fn values_of_a_call_need_nothing_of_a_shader() {
    let (mut rng, mut kept) = (Rng::new(1_912), 0);
    let screen = Screen::new(64, 24).expect("a screen");
    for _ in 0..60 {
        let corners = some_corners(&mut rng, screen);
        let all = picture::<Pair>(screen, corners, 4, None);
        let cut = picture::<Pair>(screen, corners, 4, Some(Scissor::inside(10..40, 5..20)));
        for (y, (all, cut)) in all.iter().zip(&cut).enumerate() {
            for (x, (&all, &cut)) in all.iter().zip(cut).enumerate() {
                let is_inside = (10..40).contains(&x) && (5..20).contains(&y);
                assert_eq!(cut, if is_inside { all } else { NOTHING }, "{x}, {y}");
                kept += usize::from(cut != NOTHING);
            }
        }
        let mut rooms = SceneRooms::new(6, 2, 24, 2);
        let mut scene = rooms.scene::<Shaded<Pair>>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        for blend in [None, Some(Blend::filter(255))] {
            let drawn = draw_with(&mut scene, &[corners], |draw| {
                (draw.cull, draw.blend) = (Cull::None, blend);
                if blend.is_none() {
                    (draw.mesh.colours, draw.colour) = (&[], [0; 3]);
                }
            });
            drawn.expect("there is room");
        }
        let mut lines = LineRooms::fitting(&scene, 4, true);
        let mut renderer = lines.renderer();
        let mut pixels = [0; 64];
        for (y, all) in all.iter().enumerate() {
            let drawn = renderer.draw_line(&scene, y as u16, &mut pixels, NOTHING);
            drawn.expect("the memory suffices");
            for (x, (&got, &all)) in pixels.iter().zip(all).enumerate() {
                // Blended colours have no bits above their 24.
                let (got, all) = (got & 0xFF_FFFF, all & 0xFF_FFFF);
                assert_eq!(got, all, "{x}, {y}");
            }
        }
    }
    assert!(kept > 800, "{kept}");
}
