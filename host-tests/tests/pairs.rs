//! X12: every pair of what a draw call and a renderer may have draws the right picture, or is refused.
//!
//! Small scenes of all pairs, and larger ones of any combination, against f64 pixel by pixel (see `reference`), and
//! against each other: by any number of slots and of renderers, and in any order of lines, the same bits.

mod cover;
mod reference;
mod textures;

use crate::common::Rng;
use crate::hot::shine::{V3, q14, some_direction};
use crate::hot::values::{Cut, FUNCTIONS, depth_test};
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, WordOf, camera, draw_with, line};
use cover::Pairs;
use reference::{Call, Light64, Range, Rounding, Skin64, World, covering, pixel};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::look::{Gouraud, Textured};
use scanbeam::mesh::Material;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use scanbeam::scene::{Blend, BlendMode, Draw, DrawError, Factor, Scene, Shading, Skin};
use scanbeam::{Cull, Light, Screen};
use textures::{APPLICATIONS, BUDGETS, FORMS, WRAPS, textures};

const BACKGROUND: [u8; 3] = [40, 0, 120];

/// What is combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(usize)]
enum Axis {
    Look,
    Form,
    Wrap,
    Budget,
    Blend,
    Channels,
    ColourIf,
    DepthIf,
    Scissor,
    Priority,
    Shading,
    Light,
    Renderers,
    Slots,
    Depth,
    Key,
    Application,
    Dither,
    Filter,
    Mask,
    Alphas,
}

/// How many choices each has.
const CHOICES: [usize; 21] = [
    10, 10, 3, 3, 9, 2, 8, 8, 3, 2, 2, 3, 3, 4, 2, 2, 3, 2, 2, 3, 2,
];

/// The first look that has textures.
const TEXTURED: usize = 5;

/// A choice on each axis.
type Choices = [usize; 21];

/// A direction that 14 bits hold.
fn some_normal(rng: &mut Rng) -> V3 {
    some_direction(rng).map(|c| (c * 16_384.0).round() / 16_384.0)
}

/// A call of these choices.
fn call(rng: &mut Rng, screen: Screen, choices: &Choices) -> Call {
    let of = |axis: Axis| choices[axis as usize];
    let size = rng.pick(&[40, 200, 600, 3_000]);
    let middle = [screen.width(), screen.height()].map(|side| rng.within(0, 8 * i32::from(side)));
    let w = 1.0 + 7.0 * rng.unit();
    let slant = rng.pick(&[1.0, 1.0, 1.2, 3.0]);
    let corners = [(); 3].map(|()| Corner {
        at: (
            middle[0] + rng.within(-size, size),
            middle[1] + rng.within(-size, size),
        ),
        w: w * rng.between(1.0, slant),
        colour: [(); 3].map(|()| rng.below(256) as u8),
    });
    let light = match of(Axis::Light) {
        0 => Light64::None,
        1 => Light64::One(some_direction(rng), rng.unit()),
        _ => {
            let lights = (0..2 + rng.below(3)).map(|_| {
                let colour = [(); 3].map(|()| rng.unit());
                (some_direction(rng), colour)
            });
            let lights = lights.collect();
            Light64::Several(lights, rng.pick(&[0.0, 0.6]), rng.pick(&[1, 8]))
        }
    };
    let alpha = rng.below(256) as u8;
    let mode = match of(Axis::Blend) {
        0 => None,
        1 => Some(BlendMode::Replace),
        2 => Some(BlendMode::Filter(alpha)),
        3 => Some(BlendMode::Half),
        4 => Some(BlendMode::Add(alpha)),
        5 => Some(BlendMode::Subtract(alpha)),
        6 => Some(BlendMode::Factors {
            source: Factor::Destination,
            destination: Factor::Constant(alpha),
        }),
        7 => Some(BlendMode::Factors {
            source: Factor::InverseDestination,
            destination: Factor::ONE,
        }),
        _ => Some(BlendMode::Factors {
            source: rng.pick(&[Factor::SourceAlpha, Factor::TextureAlpha]),
            destination: rng.pick(&[Factor::InverseSourceAlpha, Factor::InverseTextureAlpha]),
        }),
    };
    let rgb = match of(Axis::Channels) {
        0 => [true; 3],
        _ => [(); 3].map(|()| rng.below(2) == 0),
    };
    let skin = of(Axis::Form).checked_sub(1).map(|form| Skin64 {
        form,
        wrap: WRAPS[of(Axis::Wrap)],
        places: [(); 3].map(|()| [(); 2].map(|()| rng.within(-20_000, 20_000))),
        budget: BUDGETS[of(Axis::Budget)],
        is_keyed: of(Axis::Key) == 1,
        is_filtered: of(Axis::Filter) == 1,
        mask: of(Axis::Mask),
        application: APPLICATIONS[of(Axis::Application)],
    });
    let cut = (of(Axis::Scissor) > 0).then(|| {
        let mut cut = Cut::new(rng, screen);
        cut.set_outside(of(Axis::Scissor) == 2);
        cut
    });
    Call {
        corners,
        colour: (rng.below(3) == 0).then(|| [(); 3].map(|()| rng.below(256) as u8)),
        normals: [(); 3].map(|()| some_normal(rng)),
        is_flat: of(Axis::Shading) == 1,
        light,
        skin,
        cut,
        test: [FUNCTIONS[of(Axis::ColourIf)], FUNCTIONS[of(Axis::DepthIf)]],
        blend: mode.map(|mode| (mode, rgb)),
        alphas: (of(Axis::Alphas) == 1).then(|| [(); 3].map(|()| rng.below(256) as u8)),
        dithers: of(Axis::Dither) == 1,
        priority: of(Axis::Priority) as u8 * (1 + rng.below(3) as u8),
    }
}

/// A scene: what its calls are, and how it is drawn.
struct Case {
    choices: Choices,
    calls: Vec<Call>,
    screen: Screen,
}

impl Case {
    /// A call of these choices among `others` of any.
    fn new(rng: &mut Rng, choices: Choices, others: u32) -> Self {
        let screen = Screen::new(rng.pick(&[33, 48]), 20).expect("a screen");
        let mut calls = vec![call(rng, screen, &choices)];
        for _ in 0..others {
            let mut any = some_choices(rng);
            // Most calls hide, so that there is something to compare with.
            if rng.below(2) == 0 {
                (any[Axis::ColourIf as usize], any[Axis::DepthIf as usize]) = (0, 0);
                any[Axis::Blend as usize] = 0;
            }
            any[Axis::Priority as usize] *= choices[Axis::Priority as usize];
            if choices[Axis::Look as usize] < TEXTURED {
                any[Axis::Form as usize] = 0;
            }
            let mut other = call(rng, screen, &any);
            if rng.below(4) == 0 {
                let same = &calls[rng.below(calls.len() as u32) as usize];
                for (corner, &old) in other.corners.iter_mut().zip(&same.corners) {
                    (corner.at, corner.w) = (old.at, old.w);
                }
            }
            calls.push(other);
        }
        rng.shuffle(&mut calls);
        Self {
            choices,
            calls,
            screen,
        }
    }

    fn of(&self, axis: Axis) -> usize {
        self.choices[axis as usize]
    }

    /// Whether the look of the scene has what a call asks for.
    fn is_meant(&self) -> bool {
        self.of(Axis::Look) >= TEXTURED || self.of(Axis::Form) == 0
    }

    fn is_ranked(&self) -> bool {
        self.calls.iter().any(|call| call.priority > 0)
    }

    fn hold(&self, rng: &mut Rng) -> Count {
        match self.of(Axis::Look) {
            0 => self.hold_as::<Gouraud<Rgb565>>(rng, OF_565),
            1 => self.hold_as::<Gouraud<Rgb565Be>>(rng, OF_565),
            2 => self.hold_as::<Gouraud<Rgb565Le>>(rng, OF_565),
            3 => self.hold_as::<Gouraud<Rgb888>>(rng, OF_888),
            4 => self.hold_as::<Gouraud<Xrgb8888>>(rng, OF_888),
            5 => self.hold_as::<Textured<Rgb565>>(rng, OF_TEXELS),
            6 => self.hold_as::<Textured<Rgb565Be>>(rng, OF_TEXELS),
            7 => self.hold_as::<Textured<Rgb565Le>>(rng, OF_TEXELS),
            8 => self.hold_as::<Textured<Rgb888>>(rng, OF_WIDE_TEXELS),
            _ => self.hold_as::<Textured<Xrgb8888>>(rng, OF_WIDE_TEXELS),
        }
    }

    /// Draws all calls, and hands the scene to `see`; whether a call was refused instead.
    fn draw<L: Smooth>(&self, see: impl FnOnce(&Scene<'_, '_, L>)) -> bool {
        // A flat face has vertices of its own, beside those of its mesh; both may have alphas.
        let count = self.calls.len();
        let mut rooms = SceneRooms::new(8 * count, count, self.screen.height().into(), count);
        let mut scene = rooms.scene::<L>(self.screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        // Of looks with textures, the one whose bytes are in the order that this machine's are not in.
        let is_swapped =
            self.of(Axis::Look) == TEXTURED + 1 + usize::from(cfg!(target_endian = "big"));
        for call in &self.calls {
            let before = (scene.objects(), scene.vertices());
            let drawn = draw_with(&mut scene, &[call.corners], |draw| {
                dress(call, draw, is_swapped);
            });
            if L::TEXTURED || call.skin.is_none() {
                drawn.expect("there is room");
                continue;
            }
            assert_eq!(drawn, Err(DrawError::Untextured));
            assert_eq!((scene.objects(), scene.vertices()), before);
            return true;
        }
        see(&scene);
        false
    }

    /// Holds pictures against the reference, and those by other slots and renderers against the first.
    fn hold_as<L: Smooth>(&self, rng: &mut Rng, rounding: Rounding) -> Count
    where
        WordOf<L>: PartialEq + std::fmt::Debug,
    {
        let mut count = Count::default();
        let has_depth = self.of(Axis::Depth) == 0;
        let mut order: Vec<_> = self.calls.iter().collect();
        order.sort_by_key(|call| call.priority);
        let world = World {
            screen: self.screen,
            texels: &textures().texels,
            background: BACKGROUND,
            rounding,
            by_depth: has_depth && !self.is_ranked(),
        };
        let is_refused = self.draw::<L>(|scene| {
            let first = picture(scene, &[128], has_depth, &mut None);
            let slots = [0, 2, 5, 64][self.of(Axis::Slots)];
            let renderers = vec![slots; 1 + self.of(Axis::Renderers)];
            let other = picture(scene, &renderers, has_depth, &mut Some(rng));
            assert_eq!(first, other, "{renderers:?} slots: {:?}", self.choices);
            for (y, words) in (0..).zip(&first) {
                for (x, &word) in (0..).zip(words) {
                    let Some(want) = pixel(&order, [x, y], &world) else {
                        count.open += 1;
                        continue;
                    };
                    count.held += 1;
                    let got = L::Format::to_rgb8(word);
                    assert!(
                        is_within(got, want),
                        "{got:?} for {want:?} at {x}, {y}: {:?} {:#?}",
                        self.choices,
                        covering(&order, [x, y], &world)
                    );
                }
            }
        });
        assert_eq!(is_refused, !self.is_meant());
        count.refused = usize::from(is_refused);
        count
    }
}

fn is_within(got: [u8; 3], want: [Range; 3]) -> bool {
    let mut levels = got.into_iter().zip(want);
    levels.all(|(got, [low, high])| (low..=high).contains(&f64::from(got)))
}

/// What was compared, what was left open, and how many scenes were refused.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    held: usize,
    open: usize,
    refused: usize,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.held += other.held;
        self.open += other.open;
        self.refused += other.refused;
    }
}

/// Half a step of 5 bits, and half of one of blue where one word of colour steps; alpha of 5 bits.
const OF_565: Rounding = Rounding {
    written: 4.7,
    sloped: 8.8,
    blended: 8.8,
    dithered: 4.2,
    by_twos: false,
};
/// Half a level, what light rounds, and half a level of two words of colour.
const OF_888: Rounding = Rounding {
    written: 0.9,
    sloped: 1.4,
    blended: 1.01,
    dithered: 0.0,
    by_twos: false,
};
/// The texel times the shade is rounded to steps of 5 bits; where the shade changes it is off by one more.
const OF_TEXELS: Rounding = Rounding {
    written: 5.4,
    sloped: 13.3,
    blended: 8.8,
    dithered: 4.2,
    by_twos: true,
};

/// The texel as levels, times the shade of the pixel's own place: half a level each, and half a unit of blue, which has 512.
const OF_WIDE_TEXELS: Rounding = Rounding {
    written: 1.3,
    sloped: 1.5,
    blended: 1.01,
    dithered: 0.0,
    by_twos: false,
};

fn some_choices(rng: &mut Rng) -> Choices {
    CHOICES.map(|choices| rng.below(choices as u32) as usize)
}

/// Sets the values of a call.
fn dress(call: &Call, draw: &mut Draw<'_, '_, i32>, is_swapped: bool) {
    // A call may outlive its scene, as the compiler sees it.
    let normals: &'static [_] = call.normals.map(q14).to_vec().leak();
    draw.mesh.normals = normals;
    if let Some(colour) = call.colour {
        (draw.mesh.colours, draw.colour) = (&[], colour);
    }
    let f32s = |v: V3| v.map(|c| c as f32);
    match &call.light {
        Light64::None => {}
        Light64::One(towards, ambient) => {
            draw.light = Light::new(f32s(*towards), *ambient as f32);
        }
        Light64::Several(lights, specular, power) => {
            let light = |&(towards, colour): &(V3, V3)| {
                DirectionalLight::new(f32s(towards), f32s(colour)).expect("a direction")
            };
            let lights: &'static [_] = lights.iter().map(light).collect::<Vec<_>>().leak();
            let material = Material::shiny(*specular as f32, *power);
            let lighting = Lighting::new(lights, [Default::default(); 3], material);
            let lighting: &'static Lighting<'_> = Box::leak(Box::new(lighting.expect("lights")));
            draw.lights = Some(lighting);
        }
    }
    draw.texture = call.skin.as_ref().map(|skin| {
        let all = textures();
        let forms = &all.of[usize::from(is_swapped)][usize::from(skin.is_keyed)];
        let wrap = WRAPS.iter().position(|wrap| *wrap == skin.wrap);
        let texture = &forms[skin.form][wrap.expect("one of them")];
        let places: &'static [_] = skin.places.to_vec().leak();
        Skin {
            texture: &texture[usize::from(skin.is_filtered)][skin.mask],
            places,
            budget: skin.budget.0,
        }
    });
    draw.application = call
        .skin
        .as_ref()
        .map_or_else(Default::default, |skin| skin.application);
    draw.cull = Cull::None;
    draw.shading = if call.is_flat {
        Shading::Flat
    } else {
        Shading::Smooth
    };
    draw.scissor = call.cut.as_ref().map(Cut::scissor);
    draw.depth = depth_test(call.test);
    draw.blend = call.blend.map(|(mode, rgb)| Blend::new(mode).writing(rgb));
    draw.dither = call.dithers;
    draw.alphas = call.alphas.map_or(&[], |alphas| alphas.to_vec().leak());
    draw.priority = call.priority;
}

/// All lines, by renderers in turns, each with so many slots; in order, or in any.
fn picture<L: Smooth>(
    scene: &Scene<'_, '_, L>,
    slots: &[u16],
    has_depth: bool,
    shuffled: &mut Option<&mut Rng>,
) -> Vec<Vec<WordOf<L>>> {
    let mut rooms: Vec<_> = slots
        .iter()
        .map(|&slots| LineRooms::fitting(scene, slots, has_depth))
        .collect();
    let mut renderers: Vec<_> = rooms.iter_mut().map(LineRooms::renderer).collect();
    let height = scene.screen().height();
    let mut order: Vec<_> = (0..height).collect();
    if let Some(rng) = shuffled {
        if rng.below(3) == 0 {
            rng.shuffle(&mut order);
        }
    }
    let background = L::Format::from_rgb8(BACKGROUND);
    let mut lines = vec![Vec::new(); height.into()];
    for y in order {
        let number = usize::from(y) % renderers.len();
        lines[usize::from(y)] = line(&mut renderers[number], scene, y, background);
    }
    lines
}

/// Every pair, as a call alone and among others.
#[test]
fn every_pair_is_drawn_right_or_refused() {
    let mut rng = Rng::new(1_701);
    let (mut count, mut scenes) = (Count::default(), 0);
    for round in 0..3 {
        let mut pairs = Pairs::all();
        while let Some(choices) = pairs.next(&mut rng) {
            let others = round * (1 + rng.below(2));
            let case = Case::new(&mut rng, choices, others);
            count.add(case.hold(&mut rng));
            scenes += 1;
        }
    }
    println!("{scenes} scenes, {count:?}");
    assert!(scenes > 300 && count.refused >= 3 * TEXTURED * FORMS.len());
    assert!(count.held > 100_000 && count.open < count.held / 50);
}

/// Larger scenes of any combination.
#[test]
fn any_combination_is_drawn_right() {
    let mut rng = Rng::new(1_702);
    let mut count = Count::default();
    for _ in 0..2_000 {
        let mut choices = some_choices(&mut rng);
        if choices[Axis::Look as usize] < TEXTURED {
            choices[Axis::Form as usize] = 0;
        }
        let others = rng.pick(&[2, 5, 12]);
        let case = Case::new(&mut rng, choices, others);
        count.add(case.hold(&mut rng));
    }
    println!("{count:?}");
    assert!(count.refused == 0);
    assert!(count.held > 1_000_000 && count.open < count.held / 20);
}
