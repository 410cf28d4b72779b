//! H13: what a supervisor switches off for a scene is left out of every call, whatever the call asks for.
//!
//! The reference is a scene without the switch, whose calls do not ask.

use crate::common::Rng;
use crate::hot::shine::even_light;
use crate::hot::values::{FUNCTIONS, some_mode};
use crate::hot::{Corner, SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::look::{Phong, Textured};
use scanbeam::mesh::Material;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{
    Application, Blend, Budget, DepthTest, Draw, DrawError, Master, Scissor, Shading, Skin, Texture,
};
use scanbeam::{Cull, Light, Screen};

/// Squares, some of them holes.
static HOLED: Texture<'static> = {
    static WORDS: [u16; 64] = {
        let mut words = [0xF800; 64];
        let mut i = 0;
        while i < 64 {
            words[i] = [0x1F_u16, 0x7E0, 0xF81F, 0xFFFF][(i + i / 8) % 4].to_be();
            i += 1;
        }
        words
    };
    match Texture::words(&WORDS, 8, 8) {
        Ok(texture) => texture.keyed(0xF81F_u16.to_be()),
        Err(_) => panic!("8 x 8 texels"),
    }
};

/// A call: a triangle and all that is asked for.
struct Call {
    corners: [Corner; 3],
    normals: Vec<[i16; 3]>,
    lamps: &'static PixelLamps,
    depth: DepthTest,
    blend: Option<Blend>,
    application: Application,
    priority: u8,
    dither: bool,
    flat: bool,
}

impl Call {
    fn new(rng: &mut Rng, screen: Screen, lamps: &'static PixelLamps, is_ranked: bool) -> Self {
        let size = rng.pick(&[60, 300, 900]);
        let middle =
            [screen.width(), screen.height()].map(|side| rng.within(0, 8 * i32::from(side)));
        let [colour_if, depth_if] = [(); 2].map(|()| rng.pick(&FUNCTIONS).0);
        let test = DepthTest {
            colour_if,
            depth_if,
        };
        let blend = Blend::new(some_mode(rng));
        let (priority, w) = (1 + rng.below(3) as u8, 1.0 + 3.0 * rng.unit());
        let corner = |rng: &mut Rng| Corner {
            at: (
                middle[0] + rng.within(-size, size),
                middle[1] + rng.within(-size, size),
            ),
            w,
            colour: [(); 3].map(|()| rng.below(256) as u8),
        };
        Self {
            corners: [(); 3].map(|()| corner(rng)),
            normals: vec![[3_000, 9_000, 13_000]; 3],
            lamps,
            depth: rng.pick(&[DepthTest::HIDES, test]),
            blend: rng.pick(&[None, Some(blend)]),
            application: rng.pick(&[
                Application::Product,
                Application::Replace,
                Application::Decal,
            ]),
            priority: if is_ranked { priority } else { 0 },
            dither: rng.pick(&[true, false]),
            flat: rng.pick(&[true, false]),
        }
    }

    /// What a textured look is asked for.
    fn textured(draw: &mut Draw<'_, '_, i32>, call: &Self) {
        draw.light = Light::new([0.3, 0.8, 0.6], 0.3);
        draw.colour = [250, 130, 60];
        if call.priority < 2 && !call.flat {
            draw.mesh.colours = &[];
        }
        if call.priority < 3 {
            draw.texture = Some(Skin {
                texture: &HOLED,
                places: &[[0, 0], [20 << 8, 0], [0, 20 << 8]],
                budget: Budget::BALANCED,
            });
        }
    }

    /// What a look of light at pixels is asked for.
    fn phong(draw: &mut Draw<'_, '_, i32>, call: &Self) {
        (draw.mesh.colours, draw.colour) = (&[], [250, 130, 60]);
        draw.lamps = Some(call.lamps);
    }
}

/// What a call asks for of a look.
type Dress = fn(&mut Draw<'_, '_, i32>, &Call);

/// Whether each of shading, depth, texture, blend and dither is off.
type Off = [bool; 5];

fn master([shading, depth, texture, blend, dither]: Off) -> Master {
    let mut master = Master::ALL;
    for (is_off, what) in [
        (shading, Master::SHADING),
        (depth, Master::DEPTH),
        (texture, Master::TEXTURE),
        (blend, Master::BLEND),
        (dither, Master::DITHER),
    ] {
        if is_off {
            master = master.without(what);
        }
    }
    master
}

/// The picture of all calls, with these off for the scene, or asked for by none.
fn picture<L: Smooth>(
    calls: &[Call],
    screen: Screen,
    (off, by_master): (Off, bool),
    dress: Dress,
) -> Vec<Vec<WordOf<L>>> {
    let mut rooms = SceneRooms::of_triangles(2 * calls.len(), screen);
    let mut scene = rooms.scene::<L>(screen);
    if by_master {
        scene.set_master(master(off));
    }
    scene.begin(&camera()).expect("the rooms are large enough");
    let [shading, depth, texture, blend, dither] = off.map(|is_off| is_off && !by_master);
    for call in calls {
        let normals: &'static [_] = call.normals.clone().leak();
        let drawn = draw_with(&mut scene, &[call.corners], |draw| {
            draw.mesh.normals = normals;
            (draw.cull, draw.priority) = (Cull::None, call.priority);
            (draw.depth, draw.blend) = (call.depth, call.blend);
            (draw.dither, draw.application) = (call.dither, call.application);
            draw.scissor = Some(Scissor::outside(10..20, 5..12)).filter(|_| call.dither);
            if call.flat {
                draw.shading = Shading::Flat;
            }
            dress(draw, call);
            if shading {
                (draw.light, draw.lamps) = (None, None);
                (draw.mesh.normals, draw.mesh.colours) = (&[], &[]);
                draw.shading = Shading::Smooth;
                if draw.texture.is_some() && draw.application == Application::Product {
                    draw.application = Application::Replace;
                }
            }
            if texture {
                draw.texture = None;
            }
            if blend {
                draw.blend = None;
            }
            draw.dither &= !dither;
        });
        drawn.expect("there is room");
    }
    let is_deep = by_master || !depth;
    frame(&scene, 8, is_deep, L::Format::from_rgb8([40, 0, 120]))
}

/// Scenes with everything, for all ways to switch off: kills a switch that does nothing, or more than it says.
fn switched<L: Smooth>(seed: u64, dress: Dress) -> [usize; 5] {
    let mut rng = Rng::new(seed);
    let screen = Screen::new(48, 20).expect("a screen");
    let light = DirectionalLight::new([0.6, 0.8, 1.0], [1.0, 0.9, 0.8]).expect("a direction");
    let lights: &'static _ = Box::leak(Box::new([light]));
    let lighting = Lighting::new(lights, [Default::default(); 3], Material::shiny(0.5, 20));
    let lamps = PixelLamps::new(&lighting.expect("one light"), &camera(), screen);
    let lamps: &'static _ = Box::leak(Box::new(lamps));
    let mut differ = [0; 5];
    for round in 0..60 {
        let calls: Vec<_> = (0..8)
            .map(|_| Call::new(&mut rng, screen, lamps, round % 3 == 0))
            .collect();
        let all = picture::<L>(&calls, screen, ([false; 5], true), dress);
        for bits in 0..32 {
            let off: Off = std::array::from_fn(|i| bits >> i & 1 != 0);
            let by_master = picture::<L>(&calls, screen, (off, true), dress);
            let unasked = picture::<L>(&calls, screen, (off, false), dress);
            assert!(by_master == unasked, "{off:?} off in round {round}");
            if let Some(i) = (0..5).find(|&i| bits == 1 << i) {
                differ[i] += usize::from(by_master != all);
            }
        }
    }
    differ
}

#[test]
fn what_is_switched_off_is_as_if_nobody_had_asked() {
    let differ = switched::<Textured<Rgb565Be>>(1_921, Call::textured);
    assert!(differ.iter().all(|&n| n > 20), "{differ:?}");
    let [shading, depth, texture, blend, dither] = switched::<Phong<Rgb565Be>>(1_922, Call::phong);
    assert!(shading.min(depth).min(blend).min(dither) > 20 && texture == 0);
}

/// A switch lasts until it is set again, and refuses nothing, nor lets anything pass that is wrong.
#[test]
fn a_switch_lasts_and_leaves_refusals_as_they_are() {
    let mut rng = Rng::new(1_923);
    let light = even_light();
    let screen = Screen::new(48, 20).expect("a screen");
    let corners = [(0, 0), (300, 0), (0, 150)].map(|at| Corner {
        at,
        w: 1.0,
        colour: [rng.below(256) as u8; 3],
    });
    let mut rooms = SceneRooms::of_triangles(4, screen);
    let mut scene = rooms.scene::<Phong<Rgb565Be>>(screen);
    scene.set_master(master([true; 5]));
    for _ in 0..2 {
        scene.begin(&camera()).expect("the rooms are large enough");
        let lit = draw_with(&mut scene, &[corners], |draw| {
            (draw.light, draw.lamps) = (Light::new([0.0, 0.0, 1.0], 0.5), light);
        });
        assert_eq!(lit, Err(DrawError::Light));
        let textured = draw_with(&mut scene, &[corners], |draw| {
            draw.mesh.colours = &[];
            draw.texture = Some(Skin {
                texture: &HOLED,
                places: &[[0; 2]; 3],
                budget: Budget::FAST,
            });
        });
        assert_eq!(textured, Err(DrawError::Untextured));
    }
    let words = |master: Master| {
        let mut rooms = SceneRooms::of_triangles(4, screen);
        let mut scene = rooms.scene::<Textured<Rgb565Be>>(screen);
        scene.set_master(master);
        // Another frame with it still on.
        for _ in 0..2 {
            scene.begin(&camera()).expect("the rooms are large enough");
            draw_with(&mut scene, &[corners], |draw| draw.cull = Cull::None).expect("room");
        }
        frame(&scene, 8, true, 0)
    };
    assert!(words(master([true, false, false, false, false])) != words(Master::ALL));
}
