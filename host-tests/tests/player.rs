//! Lists that are played into the rooms: what the same calls draw, and what is refused (H7, H11-H13, X7).

use crate::common::Rng;
use crate::listing::{Cloud, PLENTY, in_blocks, some_format, unrolled};
use crate::played::{Kept, WIDTH, begun, drawn, played};
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{
    FieldForm, Flow, Header, Id, Instruction, Layout, LightWords, Material, Matrix, Palette, State,
    Strip, TexelForm, Texture as TextureBlock, VertexFormat, Window, read_block,
};
use scanbeam::look::{Gouraud, Textured};
use scanbeam::mesh::QuadSplit;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{
    Blend, Budget, DepthFunction, DepthTest, Draw, Scene, Scissor, Shading, Skin, Texture,
};
use scanbeam::{Affine, Cull, Faces, Light, Mesh};
use scenes::Played;
use std::collections::BTreeMap;

type Smooth = Gouraud<Rgb565Be>;
type Skinned = Textured<Rgb565Be>;

/// A table of a list as arrays, and the triangles of it.
#[derive(Default)]
struct Unrolled {
    positions: Vec<[i16; 3]>,
    normals: Vec<[i16; 3]>,
    places: Vec<[i32; 2]>,
    faces: Vec<[u16; 3]>,
    prsp: bool,
    material: Material,
    matrix: Option<Matrix>,
}

/// What a baked list holds, read block by block as they lie.
struct Contents {
    tables: Vec<Unrolled>,
    textures: BTreeMap<u8, TextureBlock>,
    palettes: BTreeMap<u8, Palette>,
}

fn contents(list: &[u32]) -> Contents {
    let mut contents = Contents {
        tables: Vec::new(),
        textures: BTreeMap::new(),
        palettes: BTreeMap::new(),
    };
    let (mut format, mut material, mut matrix) =
        (VertexFormat::default(), Material::default(), None);
    let mut at = 0;
    while (at as usize) < list.len() {
        let block = read_block(list, at, &format).unwrap();
        at += block.words;
        match block.instruction {
            Instruction::State(State::Format(new)) => format = new,
            Instruction::State(State::Material(new)) => material = new,
            Instruction::State(State::Matrix(new)) => matrix = Some(new),
            Instruction::State(State::Texture(t)) => drop(contents.textures.insert(t.number, t)),
            Instruction::State(State::Palette(p)) => drop(contents.palettes.insert(p.number, p)),
            Instruction::Table(run) => {
                let layout = Layout::new(&format, run.header);
                let count = usize::from(run.header.count);
                let mut table = Unrolled {
                    positions: vec![[0; 3]; count],
                    normals: vec![[0; 3]; count],
                    places: vec![[0; 2]; count],
                    prsp: run.header.prsp,
                    material,
                    matrix,
                    ..Unrolled::default()
                };
                let words = list;
                let up = match layout.place.form {
                    FieldForm::S8x3 => 7,
                    FieldForm::S16x3 => 0,
                    form => panic!("{form:?}"),
                };
                let place = |_, f: [i32; 3]| f.map(|c| (c << up) as i16);
                (layout.place).column(words, run.at, &mut table.positions, place);
                let slot = layout.normal.unwrap();
                slot.column(words, run.at, &mut table.normals, FieldForm::normal);
                if let Some(slot) = layout.texture {
                    slot.column(words, run.at, &mut table.places, |_, [u, v, _]| [u, v]);
                }
                contents.tables.push(table);
            }
            Instruction::Indexed(run) => {
                let table = contents.tables.last_mut().unwrap();
                table.material = material;
                let mut strip = Strip::default();
                for n in 0..u32::from(run.header.count) {
                    let index = list[(run.at + n / 4) as usize] >> (8 * (n % 4)) & 0xFF;
                    if index == 0xFF {
                        strip.restart();
                    } else if let Some(face) = strip.push(index as u16, run.header.rm) {
                        table.faces.push(face);
                        if run.header.low & Header::SEPARATE != 0 {
                            strip.restart();
                        }
                    }
                }
            }
            _ => {}
        }
    }
    contents
}

impl Contents {
    /// The textures of a list's bytes, by number: 8 bits, whose palettes are words of the panel.
    fn textures<'t>(
        &self,
        bytes: &'t [u8],
        palettes: &'t BTreeMap<u8, Vec<u16>>,
    ) -> BTreeMap<u8, Texture<'t>> {
        let made = self.textures.iter().map(|(&number, t)| {
            let palette = &palettes[&t.palette];
            let (width, height) = (1 << t.log_width, 1 << t.log_height);
            let texels = &bytes[4 * t.at as usize..];
            let made = match t.form {
                TexelForm::Index4 => Texture::index4(texels, palette, width, height),
                TexelForm::Index8 => Texture::index8(texels, palette, width, height),
                form => panic!("{form:?}"),
            };
            (number, made.unwrap())
        });
        made.collect()
    }

    fn palettes(&self, list: &[u32]) -> BTreeMap<u8, Vec<u16>> {
        let palette = |p: &Palette| {
            let mut words = vec![0; 256];
            for (slot, colour) in words
                .iter_mut()
                .zip(&list[p.at as usize..][..p.count.into()])
            {
                let [r, g, b, _] = colour.to_le_bytes();
                *slot = Rgb565Be::from_rgb8([r, g, b]);
            }
            words
        };
        self.palettes
            .iter()
            .map(|(&n, p)| (n, palette(p)))
            .collect()
    }
}

#[test]
fn baked_lists_are_what_the_same_calls_draw() {
    for list in [Played::Teapot, Played::Crate, Played::CrateOwn] {
        let words = list.list().unwrap();
        let contents = contents(words);
        let palettes = contents.palettes(words);
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
        let textures = contents.textures(&bytes, &palettes);
        let PlayerSettings {
            draw: begin,
            textures: own,
            ..
        } = list.settings();
        let want = begun::<Skinned>(&list.camera().unwrap(), |scene| {
            for table in &contents.tables {
                let matrix = table.matrix.as_ref().map_or(Affine::IDENTITY, Affine::from);
                let texture = table.material.texture.map(|number| {
                    let own = own.get(usize::from(number)).copied().flatten();
                    own.unwrap_or(&textures[&number])
                });
                let places: Vec<[i32; 2]> = (table.places.iter())
                    .map(|[u, v]| {
                        let (w, h) = texture.map_or((1, 1), |t| (t.width(), t.height()));
                        [(*u * w as i32) >> 4, (*v * h as i32) >> 4]
                    })
                    .collect();
                let call = Draw {
                    model: matrix.then(&begin.model),
                    light: begin.light,
                    colour: table.material.diffuse,
                    cull: match table.material.two_sided {
                        true => Cull::None,
                        false => Cull::Back,
                    },
                    texture: texture.map(|texture| Skin {
                        texture,
                        places: &places,
                        budget: match table.prsp {
                            true => Budget::EXACT,
                            false => Budget::FAST,
                        },
                    }),
                    ..Draw::new(Mesh {
                        positions: &table.positions,
                        normals: &table.normals,
                        colours: &[],
                        faces: Faces::Triangles(&table.faces),
                    })
                };
                scene.draw(&call).unwrap();
            }
        });
        for (vertices, indices) in [(255, 1536), (255, 300)] {
            let mut kept = Kept::new(vertices, indices);
            let mut player = kept.player::<Skinned>(PlayerSettings {
                budget: Budget::EXACT,
                ..list.settings()
            });
            let got = begun::<Skinned>(&list.camera().unwrap(), |scene| {
                player.start(0);
                played(&mut player, words, scene, PLENTY).unwrap();
            });
            assert!(got == want, "{list:?} with {indices} indices");
        }
        assert!(want.iter().filter(|word| **word != want[0]).count() > 2_000);
    }
}

/// What has been said of the state so far: the call, the light, and whether it falls on the material.
#[derive(Clone, Copy)]
struct Told {
    call: Draw<'static, 'static>,
    light: Option<Light>,
    unlit: bool,
}

/// A block of state, and what it stands for.
fn some_state(rng: &mut Rng, writer: &mut ListWriter<'_>, begin: &Told, told: &mut Told) {
    match rng.below(6) {
        0 => {
            let turn = Affine::rotation_y(rng.signed() as f32 * 3.0);
            let place = Affine::placed(0.7, [0.3 * rng.signed() as f32, 0.0, 0.0]);
            let matrix = turn.then(&place.unwrap());
            let words = Matrix::try_from(&matrix).unwrap();
            writer.state(&State::Matrix(words)).unwrap();
            told.call.model = matrix.then(&begin.call.model);
        }
        1 => {
            let light = Light::new([0; 3].map(|_: i32| rng.signed() as f32), 0.2).unwrap();
            let words = LightWords::from(light);
            let state = State::Light {
                number: 0,
                light: words,
            };
            writer.state(&state).unwrap();
            told.light = Some(light);
        }
        2 => {
            writer.state(&State::LightOff { number: 0 }).unwrap();
            told.light = None;
        }
        3 => {
            let window = Window {
                left: rng.below(40) as u16,
                top: rng.below(30) as u16,
                right: 41 + rng.below(50) as u16,
                bottom: 31 + rng.below(40) as u16,
            };
            writer.state(&State::Window(window)).unwrap();
            let (columns, lines) = (window.left..window.right, window.top..window.bottom);
            told.call.scissor = Some(Scissor::inside(columns, lines));
        }
        _ => {
            let material = Material {
                diffuse: [0; 3].map(|_: u8| rng.below(256) as u8),
                opacity: rng.pick(&[255, 255, 100]),
                two_sided: rng.below(2) == 0,
                unlit: rng.below(3) == 0,
                ..Material::default()
            };
            writer.state(&State::Material(material)).unwrap();
            told.call.colour = material.diffuse;
            told.call.cull = match material.two_sided {
                true => Cull::None,
                false => Cull::Back,
            };
            told.call.blend = match material.opacity {
                255 => begin.call.blend,
                opacity => Some(Blend::filter(opacity)),
            };
            told.unlit = material.unlit;
        }
    }
    told.call.light = told.light.filter(|_| !told.unlit);
}

/// PlayerSettings of all kinds that a list cannot say.
fn some_settings(rng: &mut Rng) -> PlayerSettings<'static, 'static> {
    let settings = PlayerSettings::default();
    PlayerSettings {
        draw: Draw {
            model: Affine::rotation_x(rng.signed() as f32),
            cull: rng.pick(&[Cull::Back, Cull::None]),
            light: (rng.below(2) == 0).then(|| Light::new([0.3, 0.9, 0.5], 0.2).unwrap()),
            colour: [200, 90, 40],
            shading: rng.pick(&[Shading::Smooth, Shading::Flat]),
            depth: rng.pick(&[
                DepthTest::HIDES,
                DepthTest::new(DepthFunction::ALWAYS),
                DepthTest::HIDES.without_write(),
            ]),
            dither: rng.below(2) == 0,
            priority: rng.pick(&[0, 0, 3]),
            ..settings.draw
        },
        ..settings
    }
}

#[test]
fn strips_fans_and_quads_are_what_the_same_calls_draw() {
    let mut lit = 0;
    for seed in 0..120 {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 40, place, normal);
        let settings = some_settings(&mut rng);
        let mut memory = vec![0; 8192];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let begin = Told {
            call: settings.draw,
            light: settings.draw.light,
            unlit: false,
        };
        let mut told = begin;
        let mut calls = Vec::new();
        for _ in 0..1 + rng.below(5) {
            for _ in 0..rng.below(4) {
                some_state(&mut rng, &mut writer, &begin, &mut told);
            }
            let shade = rng.below(4) > 0;
            let kind = rng.below(3);
            let order: Vec<u16> = (0..4 * rng.below(6))
                .map(|_| rng.below(40) as u16)
                .collect();
            let faces = match kind {
                0 | 1 => {
                    let fan = kind == 1;
                    in_blocks(&mut rng, &order, |part, new| {
                        let header = Header {
                            shade,
                            new,
                            rm: fan,
                            ..Header::of(Id::Short, part.len() as u16)
                        };
                        let words = cloud.vertices(&format, header, part);
                        writer.vertices(header, &words).unwrap();
                    });
                    Ok(unrolled(&order, fan))
                }
                _ => {
                    let header = Header {
                        shade,
                        new: true,
                        low: Header::SPLIT,
                        ..Header::of(Id::Quads, order.len() as u16)
                    };
                    let words = cloud.vertices(&format, header, &order);
                    writer.vertices(header, &words).unwrap();
                    let (quads, _) = order.as_chunks::<4>();
                    Err(quads.to_vec())
                }
            };
            calls.push((told.call, shade, faces));
        }
        writer.flow(Flow::End).unwrap();
        let list = writer.words();
        let want = drawn::<Smooth>(|scene| {
            for (call, shade, faces) in &calls {
                let vertices = cloud.plain(*shade, &format);
                let faces = match faces {
                    Ok(faces) => Faces::Triangles(faces),
                    Err(quads) => Faces::Quads(quads, QuadSplit::Corner1To3),
                };
                let mesh = Mesh {
                    positions: vertices.positions,
                    normals: vertices.normals,
                    colours: vertices.colours,
                    faces,
                };
                lit += u32::from(call.light.is_some() && !vertices.normals.is_empty());
                scene.draw(&Draw { mesh, ..*call }).unwrap();
            }
        });
        for (vertices, indices) in [(4, 4), (9, 100), (1000, 1000)] {
            // A player's memory is full at other places than a call's, and what is translucent is drawn by call.
            let blends = calls.iter().any(|(call, ..)| call.blend.is_some());
            if blends && indices < 1000 {
                continue;
            }
            let mut kept = Kept::new(vertices, indices);
            let mut player = kept.player::<Smooth>(settings);
            let got = drawn::<Smooth>(|scene| {
                player.start(0);
                played(&mut player, list, scene, PLENTY).unwrap();
            });
            assert!(got == want, "seed {seed}, {vertices} vertices");
        }
    }
    assert!(lit > 30, "{lit}");
}

#[test]
fn a_list_that_is_cut_by_its_budget_goes_on_where_it_stood() {
    let list = Played::Teapot.list().unwrap();
    let camera = Played::Teapot.camera().unwrap();
    let mut kept = Kept::new(255, 1536);
    let mut player = kept.player::<Smooth>(Played::Teapot.settings());
    let whole = begun::<Smooth>(&camera, |scene| {
        player.start(0);
        played(&mut player, list, scene, PLENTY).unwrap();
    });
    let mut halts = 0;
    let parts = begun::<Smooth>(&camera, |scene| {
        player.start(0);
        let few = scanbeam::list::Budget {
            instructions: 3,
            vertices: 900,
            jumps: 0,
        };
        while played(&mut player, list, scene, few).unwrap() != scanbeam::list::Halt::End {
            halts += 1;
        }
    });
    assert!(parts == whole && halts > 4, "{halts}");
    // Played again, with what it has kept.
    let again = begun::<Smooth>(&camera, |scene| {
        player.command(scanbeam::list::ListCommand::Restart);
        played(&mut player, list, scene, PLENTY).unwrap();
    });
    assert!(again == whole);
}

#[test]
fn what_is_out_of_sight_is_passed_over() {
    let list = Played::Teapot.list().unwrap();
    let (at, up) = ([0.0, 1.2, 9.0], [0.0, 1.0, 0.0]);
    for (eye, skipped) in [([0.0, 1.2, 2.6], 1), ([0.0, 1.2, 12.0], 0)] {
        let camera = scanbeam::Camera::look_at(eye, at, up, 300.0, 0.1, 100.0).unwrap();
        let mut kept = Kept::new(255, 1536);
        let mut player = kept.player::<Smooth>(Played::Teapot.settings());
        begun::<Smooth>(&camera, |scene| {
            player.start(0);
            played(&mut player, list, scene, PLENTY).unwrap();
            assert_eq!(scene.objects() == 0, skipped == 1);
        });
        let counts = player.counts();
        assert_eq!((counts.skipped, counts.draws == 0), (skipped, skipped == 1));
    }
}

#[test]
fn settings_grant_a_window() {
    let list = Played::Teapot.list().unwrap();
    let camera = Played::Teapot.camera().unwrap();
    let window = Window {
        left: 10,
        top: 20,
        right: 60,
        bottom: 50,
    };
    let mut kept = Kept::new(255, 1536);
    let mut draw = |settings| {
        let mut player = kept.player::<Smooth>(settings);
        begun::<Smooth>(&camera, |scene: &mut Scene<'_, '_, Smooth>| {
            player.start(0);
            played(&mut player, list, scene, PLENTY).unwrap();
        })
    };
    let settings = Played::Teapot.settings();
    let all = draw(settings);
    let cut = draw(PlayerSettings {
        window: Some(window),
        ..settings
    });
    assert!(all != cut);
    for (i, (cut, all)) in cut.iter().zip(&all).enumerate() {
        let (x, y) = (i as u16 % WIDTH, i as u16 / WIDTH);
        let inside = (10..60).contains(&x) && (20..50).contains(&y);
        assert_eq!(*cut, if inside { *all } else { 0 }, "{x}, {y}");
    }
}
