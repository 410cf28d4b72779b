//! Lights, highlights and overlays of lists: what the same calls give (K10, K14).

use crate::common::Rng;
use crate::listing::{
    self, Cloud, HEIGHT, PLENTY, Room, Smooth, WIDTH, begin, drawn, rooms, some_instance,
};
use host_tests::lists::writer::ListWriter;
use scanbeam::event::{Event, Notice};
use scanbeam::input::{ListRunner, ListSettings};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::list::{
    FieldForm, Flow, Halt, Header, Id, LightWords, Material, Overlay, OverlaySlot, Palette, State,
    TexelForm, TextureSlot,
};
use scanbeam::mesh::{I2F14, U1F15};
use scanbeam::overlay::{LineOverlay, ListOverlays};
use scanbeam::pipeline::blend::Finish;
use scanbeam::pipeline::{Composited, Instance};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::{Light, Screen};

type Picture = Vec<Vec<[u8; 3]>>;

/// What a list draws with eight lights, and its events but for the end.
fn lit(list: &[u32], instance: Instance) -> (Picture, Vec<Event>) {
    let mut events = Vec::new();
    let picture = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 256);
        let settings = ListSettings {
            instance,
            ..ListSettings::default()
        };
        let mut runner = room.lit(settings, (&[], &[]));
        runner.start(0);
        let mut note = |n: Notice| events.push(n.event);
        let halt = runner.run(list, scene, &mut PLENTY.clone(), &mut note);
        assert_eq!(halt, Ok(Halt::End));
    });
    events.retain(|e| !matches!(e, Event::ListEnd | Event::Clipped));
    (picture, events)
}

fn some_light(rng: &mut Rng) -> LightWords {
    let towards = [0; 3].map(|_: i32| rng.signed() as f32);
    let light = Light::new(towards, 0.4 * rng.signed().abs() as f32).unwrap();
    LightWords {
        colour: match rng.below(3) {
            0 => [255; 3],
            _ => [0; 3].map(|_: u8| rng.below(256) as u8),
        },
        ..LightWords::from(light)
    }
}

/// A share of 255 as one of 2^15, by real numbers.
fn share(c: u8, whole: f64) -> U1F15 {
    U1F15::from_bits((f64::from(c) * whole / 255.0).round() as u16)
}

#[test]
fn lights_of_lists_are_those_of_calls() {
    let (mut alone, mut highlights) = (0, 0);
    for seed in 0..200 {
        let mut rng = Rng::new(seed);
        let cloud = Cloud::random(&mut rng, 40, FieldForm::S16x3, FieldForm::S10x3);
        let start = some_instance(&mut rng);
        // The light of the settings is number 0 until the list says otherwise.
        let mut lights: [Option<LightWords>; 8] = [None; 8];
        lights[0] = start.light.map(LightWords::from);
        let mut memory = vec![0; 1024];
        let mut writer = ListWriter::new(&mut memory);
        for _ in 0..rng.below(6) {
            let number = rng.below(8) as u8;
            let light = (rng.below(4) > 0).then(|| some_light(&mut rng));
            lights[usize::from(number)] = light;
            writer
                .state(&match light {
                    Some(light) => State::Light { number, light },
                    None => State::LightOff { number },
                })
                .unwrap();
        }
        let material = Material {
            diffuse: [0; 3].map(|_: u8| rng.below(256) as u8),
            specular: match rng.below(2) {
                0 => [0; 3],
                _ => [0; 3].map(|_: u8| rng.below(256) as u8),
            },
            exponent: rng.below(256) as u8,
            two_sided: true,
            unlit: rng.below(8) == 0,
            ..Material::default()
        };
        writer.state(&State::Material(material)).unwrap();
        let order: Vec<u16> = (0..40).collect();
        let header = Header {
            shade: true,
            new: true,
            ..Header::of(Id::Short, 40)
        };
        let format = *writer.format();
        let words = cloud.vertices(&format, header, &order);
        writer.vertices(header, &words).unwrap();

        let on: Vec<LightWords> = lights.iter().flatten().copied().collect();
        let plain = on.len() == 1 && lights[0].is_some_and(|l| l.colour == [255; 3]);
        let plain = plain && material.specular == [0; 3];
        let instance = Instance {
            model: start.model,
            cull: scanbeam::Cull::None,
            light: None,
            colour: material.diffuse,
        };
        let faces = listing::unrolled(&order, false);
        let vertices = cloud.plain(true, &format);
        let want = drawn::<Smooth>(|scene| {
            if plain || on.is_empty() || material.unlit {
                let light = on.first().filter(|_| !material.unlit);
                let instance = Instance {
                    light: light.map(|l| Light::from(*l)),
                    ..instance
                };
                scene.draw_indexed(vertices, &faces, &instance).unwrap();
                alone += u32::from(light.is_some());
                return;
            }
            // What falls of each, and the sum of what is everywhere.
            let falls: Vec<DirectionalLight> = on
                .iter()
                .map(|l| DirectionalLight {
                    direction: l.direction.map(I2F14::from_bits),
                    colour: l
                        .colour
                        .map(|c| share(c, f64::from(32_768 - u32::from(l.ambient)))),
                })
                .collect();
            let ambient: u32 = on.iter().map(|l| u32::from(l.ambient)).sum();
            let ambient = [U1F15::from_bits(ambient.min(32_768) as u16); 3];
            let surface = scanbeam::mesh::Material {
                specular: material.specular.map(|c| share(c, 32_768.0)),
                shininess: u16::from(material.exponent),
                ..scanbeam::mesh::Material::default()
            };
            let lighting = Lighting::new(&falls, ambient, surface).unwrap();
            let mesh = scanbeam::Mesh {
                positions: vertices.positions,
                normals: vertices.normals,
                colours: vertices.colours,
                faces: scanbeam::Faces::Triangles(&faces),
            };
            scene.draw(&mesh, &instance.lit_by(Some(lighting))).unwrap();
            highlights += u32::from(material.specular != [0; 3]);
        });
        let (got, events) = lit(writer.words(), start);
        assert_eq!(events, [], "seed {seed}");
        assert!(got == want, "seed {seed}");
    }
    assert!(alone > 5 && highlights > 40, "{alone}, {highlights}");
}

#[test]
fn opacity_is_a_finish_where_there_are_finishes() {
    type Mixed = Composited<Smooth>;
    let mut through = 0;
    for seed in 0..40 {
        let mut rng = Rng::new(seed);
        let cloud = Cloud::random(&mut rng, 20, FieldForm::S16x3, FieldForm::S10x3);
        let mut memory = vec![0; 1024];
        let mut writer = ListWriter::new(&mut memory);
        let mut sheets = Vec::new();
        for _ in 0..3 {
            let material = Material {
                diffuse: [0; 3].map(|_: u8| rng.below(256) as u8),
                opacity: rng.pick(&[255, 255, rng.clone().below(256) as u8]),
                two_sided: true,
                ..Material::default()
            };
            let order: Vec<u16> = (0..5).map(|_| rng.below(20) as u16).collect();
            let header = Header {
                new: true,
                ..Header::of(Id::Short, 5)
            };
            writer.state(&State::Material(material)).unwrap();
            let format = *writer.format();
            let words = cloud.vertices(&format, header, &order);
            writer.vertices(header, &words).unwrap();
            sheets.push((material, listing::unrolled(&order, false)));
        }
        let format = *writer.format();
        let draw = |composited: bool| {
            drawn::<Mixed>(|scene| {
                for (material, faces) in &sheets {
                    let vertices = cloud.plain(false, &format);
                    let mesh = scanbeam::Mesh {
                        positions: vertices.positions,
                        normals: &[],
                        colours: &[],
                        faces: scanbeam::Faces::Triangles(faces),
                    };
                    let instance = Instance {
                        cull: scanbeam::Cull::None,
                        colour: material.diffuse,
                        ..Instance::default()
                    };
                    let finish = match material.opacity {
                        a if a < 255 && composited => Finish::filtered(a),
                        _ => Finish::OPAQUE,
                    };
                    scene.draw_skinned(&mesh, finish.into(), &instance).unwrap();
                }
            })
        };
        let got = listing::listed::<Mixed, i16>(writer.words(), Instance::default(), (64, 256));
        assert!(got == draw(true), "seed {seed}");
        through += u32::from(got != draw(false));
    }
    assert!(through > 10, "{through}");
}

#[test]
fn lights_that_are_not_there_are_events() {
    let white = LightWords::from(Light::new([0.0, 1.0, 1.0], 0.3).unwrap());
    let red = LightWords {
        colour: [255, 0, 0],
        ..white
    };
    let shiny = Material {
        specular: [9; 3],
        ..Material::default()
    };
    let asked = [
        State::Light {
            number: 0,
            light: white,
        },
        State::LightOff { number: 200 },
        State::Light {
            number: 0,
            light: red,
        },
        State::Light {
            number: 7,
            light: white,
        },
        State::Material(shiny),
        State::Light {
            number: 8,
            light: white,
        },
    ];
    for (n, state) in asked.into_iter().enumerate() {
        let mut memory = vec![0; 16];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&state).unwrap();
        let list = writer.words().to_vec();
        let (_, events) = lit(&list, Instance::default());
        assert_eq!(events.len(), usize::from(n == 5), "{state:?}");
        drawn::<Smooth>(|scene| {
            let mut room = Room::<i16>::new(4, 4);
            let mut runner: ListRunner<'_, '_> = room.runner(ListSettings::default());
            runner.start(0);
            let _ = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_: Notice| {});
            let count = u32::from(n >= 2);
            assert_eq!(runner.counts().unimplemented, count, "{state:?}");
        });
    }
}

/// The field of some bits from a place in a run of words, bit by bit.
fn bits(words: &[u32], from: usize, count: usize) -> u32 {
    (0..count).fold(0, |v, k| {
        let at = from + k;
        v | (words[at / 32] >> (at % 32) & 1) << k
    })
}

/// An overlay, its words, and the colours that its palette's number has then.
struct Sheet {
    block: Overlay,
    words: Vec<u32>,
    colours: Vec<u32>,
}

impl Sheet {
    fn rgba(&self, x: usize, y: usize) -> [u8; 4] {
        let each = self.block.form.bits() as usize;
        let v = bits(
            &self.words,
            (y * usize::from(self.block.width) + x) * each,
            each,
        );
        let grown = |v: u32, bits: u32| (v << (8 - bits) | v >> (2 * bits - 8)) as u8;
        match self.block.form {
            TexelForm::Rgb565 => [
                grown(v >> 11, 5),
                grown(v >> 5 & 63, 6),
                grown(v & 31, 5),
                255,
            ],
            TexelForm::Rgb888 => [v as u8, (v >> 8) as u8, (v >> 16) as u8, 255],
            TexelForm::Rgba => {
                // 7 bits of alpha: nothing only where all are 0.
                let alpha = if v >> 24 & 0x7F == 0 { 0 } else { 1 };
                [v as u8, (v >> 8) as u8, (v >> 16) as u8, alpha]
            }
            TexelForm::Index6 => self.colour(v & 63),
            _ => self.colour(v),
        }
    }

    fn colour(&self, n: u32) -> [u8; 4] {
        let colour = self.colours.get(n as usize);
        colour.map_or([0; 4], |c| c.to_le_bytes())
    }
}

fn overlaid<F: PixelFormat>(seed: u64) -> u32
where
    F::Word: PartialEq + std::fmt::Debug,
{
    let mut rng = Rng::new(seed);
    let any = |rng: &mut Rng| rng.below(1 << 16) << 16 | rng.below(1 << 16);
    let mut memory = vec![0; 1 << 15];
    let mut writer = ListWriter::new(&mut memory);
    let mut palettes: [Vec<u32>; 2] = [vec![], vec![]];
    let mut sheets: Vec<Sheet> = Vec::new();
    for _ in 0..1 + rng.below(6) {
        for (number, colours) in palettes.iter_mut().enumerate() {
            if colours.is_empty() || rng.below(2) == 0 {
                *colours = (0..1 + rng.below(256)).map(|_| any(&mut rng)).collect();
                // Some let the picture through.
                colours.iter_mut().step_by(3).for_each(|c| *c &= 0xFF_FFFF);
                let palette = Palette {
                    number: number as u8,
                    count: colours.len() as u16,
                    at: 0,
                };
                writer.bulk(&State::Palette(palette), colours).unwrap();
            }
        }
        let palette = rng.below(2) as u8;
        let block = Overlay {
            left: rng.below(u32::from(WIDTH) + 9) as u16,
            top: rng.below(u32::from(HEIGHT) + 9) as u16,
            width: 1 + rng.below(40) as u16,
            height: 1 + rng.below(40) as u16,
            form: rng.pick(&TexelForm::ALL),
            additive: rng.below(2) == 0,
            palette,
            at: 0,
        };
        let words: Vec<u32> = (0..block.words()).map(|_| any(&mut rng)).collect();
        writer.bulk(&State::Overlay(block), &words).unwrap();
        sheets.push(Sheet {
            block,
            words,
            colours: palettes[usize::from(palette)].clone(),
        });
    }
    let list = writer.words().to_vec();
    let textures: Vec<TextureSlot> = (0..2).map(|_| TextureSlot::new()).collect();
    let slots: Vec<OverlaySlot> = (0..6).map(|_| OverlaySlot::new()).collect();
    drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(4, 4);
        let mut runner = room.lit(ListSettings::default(), (&textures, &slots));
        runner.start(0);
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_: Notice| {});
        assert_eq!((halt, runner.counts().unimplemented), (Ok(Halt::End), 0));
    });
    let mut over = ListOverlays {
        words: &list,
        slots: &slots,
    };
    let mut painted = 0;
    for line in 0..HEIGHT {
        let mut got: Vec<F::Word> = (0..WIDTH)
            .map(|_| F::from_rgb8([0; 3].map(|_: u8| rng.below(256) as u8)))
            .collect();
        let mut want = got.clone();
        LineOverlay::<F>::paint(&mut over, line, &mut got);
        for sheet in &sheets {
            for (x, pixel) in (0..).zip(&mut want) {
                let (left, top) = (sheet.block.left, sheet.block.top);
                let within = (left..left + sheet.block.width).contains(&x)
                    && (top..top + sheet.block.height).contains(&line);
                if !within {
                    continue;
                }
                let [r, g, b, a] = sheet.rgba(usize::from(x - left), usize::from(line - top));
                let word = F::from_rgb8([r, g, b]);
                if a > 0 {
                    *pixel = if sheet.block.additive {
                        F::add(*pixel, word)
                    } else {
                        word
                    };
                    painted += 1;
                }
            }
        }
        assert_eq!(got, want, "seed {seed}, line {line}");
    }
    painted
}

#[test]
fn overlays_of_lists_are_painted_as_they_say() {
    let painted: u32 = (0..60)
        .map(|seed| overlaid::<Rgb888>(seed) + overlaid::<Rgb565>(1000 + seed))
        .sum();
    assert!(painted > 30_000, "{painted}");
}

#[test]
fn overlays_end_with_their_frame_and_what_finds_no_slot_is_said() {
    let overlay = Overlay {
        left: 0,
        top: 0,
        width: 1,
        height: 1,
        form: TexelForm::Rgb888,
        additive: false,
        palette: 0,
        at: 0,
    };
    let mut memory = vec![0; 64];
    let mut writer = ListWriter::new(&mut memory);
    let indexed = Overlay {
        form: TexelForm::Index1,
        ..overlay
    };
    // A palette that is not there, and one overlay more than slots.
    writer.bulk(&State::Overlay(indexed), &[1]).unwrap();
    for colour in [1, 2] {
        writer.bulk(&State::Overlay(overlay), &[colour]).unwrap();
    }
    writer.flow(Flow::Sync).unwrap();
    writer.bulk(&State::Overlay(overlay), &[3]).unwrap();
    let list = writer.words();
    let slots = [const { OverlaySlot::new() }; 1];
    let pixel = || {
        let mut line = [[7; 3]; 2];
        let mut over = ListOverlays {
            words: list,
            slots: &slots,
        };
        LineOverlay::<Rgb888>::paint(&mut over, 0, &mut line);
        assert_eq!(line[1], [7; 3]);
        line[0][0]
    };
    let mut rooms = rooms::<Smooth>();
    let mut scene = rooms.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    begin(&mut scene);
    let mut room = Room::<i16>::new(4, 4);
    let mut runner = room.lit(ListSettings::default(), (&[], &slots));
    runner.start(0);
    let mut events = Vec::new();
    let mut budget = PLENTY;
    let halt = runner.run(list, &mut scene, &mut budget, &mut |n: Notice| {
        events.push(n.event)
    });
    assert_eq!((halt, pixel()), (Ok(Halt::Sync), 1));
    assert_eq!(events, [Event::Unimplemented, Event::Full, Event::Sync]);
    let halt = runner.run(list, &mut scene, &mut budget, &mut |_: Notice| {});
    assert_eq!((halt, pixel()), (Ok(Halt::End), 3));
    // Nobody paints them: it is said.
    let mut room = Room::<i16>::new(4, 4);
    let mut runner = room.lit(ListSettings::default(), (&[], &[]));
    runner.start(0);
    let _ = runner.run(list, &mut scene, &mut budget, &mut |_: Notice| {});
    assert_eq!(runner.counts().unimplemented, 3);
}
