//! Several lights of lists that are played, coloured, with highlights: what the same calls draw (K10, H11).

use crate::common::Rng;
use crate::listing::{Cloud, PLENTY, unrolled};
use crate::played::lists::after_a_triangle;
use crate::played::{Kept, drawn, lit_at_pixels, played};
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::list::{
    Budget, FieldForm, Flow, Halt, Header, Id, LightWords, ListCommand, ListError, Material,
    Missing, Reason, State, VertexFormat,
};
use scanbeam::look::{Gouraud, Look, Phong};
use scanbeam::mesh::{I2F14, U1F15};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Draw, Shading};
use scanbeam::{Affine, Cull, Faces, Light, Mesh};

type Smooth = Gouraud<Rgb565Be>;

const VERTICES: u16 = 40;

fn some_light(rng: &mut Rng) -> LightWords {
    let towards = [0; 3].map(|_: i32| rng.signed() as f32);
    // Together they are often above 1, and sometimes above 2.
    let most = rng.pick(&[0.4, 0.4, 1.0]);
    let light = Light::new(towards, most * rng.signed().abs() as f32).unwrap();
    LightWords {
        colour: match rng.below(2) {
            0 => [255; 3],
            _ => [0; 3].map(|_: u8| rng.below(256) as u8),
        },
        ..LightWords::from(light)
    }
}

fn some_material(rng: &mut Rng) -> Material {
    Material {
        diffuse: [0; 3].map(|_: u8| rng.below(256) as u8),
        specular: match rng.below(3) {
            0 | 1 => [0; 3],
            _ => [0; 3].map(|_: u8| rng.below(256) as u8),
        },
        exponent: rng.below(256) as u8,
        two_sided: true,
        unlit: rng.below(8) == 0,
        ..Material::default()
    }
}

/// A share of 255 as one of 2^15, by real numbers.
fn share(c: u8, whole: f64) -> U1F15 {
    U1F15::from_bits((f64::from(c) * whole / 255.0).round() as u16)
}

/// A strip, with what falls on it.
#[derive(Clone)]
struct Sheet {
    lights: [Option<LightWords>; 8],
    material: Material,
    faces: Vec<[u16; 3]>,
}

impl Sheet {
    /// Hands over the call of it.
    fn draw(
        &self,
        cloud: &Cloud,
        begin: &Draw<'_, 'static>,
        then: impl FnOnce(&Draw<'_, 'static>),
    ) {
        let vertices = cloud.plain(true, &VertexFormat::default());
        let call = Draw {
            mesh: Mesh {
                positions: vertices.positions,
                normals: vertices.normals,
                colours: vertices.colours,
                faces: Faces::Triangles(&self.faces),
            },
            light: None,
            colour: self.material.diffuse,
            cull: Cull::None,
            ..*begin
        };
        let on: Vec<LightWords> = self.lights.iter().flatten().copied().collect();
        if on.is_empty() || self.material.unlit {
            return then(&call);
        }
        if self.is_plain() {
            let light = Some(Light::from(on[0]));
            return then(&Draw { light, ..call });
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
            specular: self.material.specular.map(|c| share(c, 32_768.0)),
            shininess: u16::from(self.material.exponent),
            ..scanbeam::mesh::Material::default()
        };
        let lighting = Lighting::new(&falls, ambient, surface).unwrap();
        let lights = Some(&lighting as _);
        then(&Draw { lights, ..call });
    }

    /// Light 0 alone, white, on what is matt: as one light has it.
    fn is_plain(&self) -> bool {
        let white = self.lights[0].is_some_and(|l| l.colour == [255; 3]);
        let others = self.lights[1..].iter().any(Option::is_some);
        white && !others && self.material.specular == [0; 3]
    }
}

/// A list that begins with at most one light: its lights are set, changed and put out between strips, and it pauses.
fn some_list(rng: &mut Rng, cloud: &Cloud, first: Option<Light>) -> (Vec<u32>, Vec<Sheet>) {
    let mut memory = vec![0; 4096];
    let mut writer = ListWriter::new(&mut memory);
    let mut sheets = Vec::new();
    let mut sheet = Sheet {
        lights: [None; 8],
        material: some_material(rng),
        faces: Vec::new(),
    };
    sheet.lights[0] = first.map(LightWords::from);
    writer.state(&State::Material(sheet.material)).unwrap();
    for _ in 0..1 + rng.below(4) {
        for _ in 0..rng.below(4) {
            let number = rng.pick(&[0, 0, 0, 1, 1, 7]);
            let light = (rng.below(3) > 0).then(|| some_light(rng));
            sheet.lights[usize::from(number)] = light;
            let state = match light {
                Some(light) => State::Light { number, light },
                None => State::LightOff { number },
            };
            writer.state(&state).unwrap();
            match rng.below(6) {
                0 => writer.flow(Flow::Pause).unwrap(),
                1 => writer.flow(Flow::Sync).unwrap(),
                _ => {}
            }
        }
        if rng.below(3) == 0 {
            sheet.material = some_material(rng);
            writer.state(&State::Material(sheet.material)).unwrap();
        }
        let order: Vec<u16> = (0..9).map(|_| rng.below(VERTICES.into()) as u16).collect();
        let header = Header {
            shade: true,
            new: true,
            ..Header::of(Id::Short, order.len() as u16)
        };
        let format = *writer.format();
        writer
            .vertices(header, &cloud.vertices(&format, header, &order))
            .unwrap();
        sheet.faces = unrolled(&order, false);
        sheets.push(sheet.clone());
    }
    writer.flow(Flow::End).unwrap();
    (writer.words().to_vec(), sheets)
}

#[test]
fn lights_of_lists_are_those_of_calls() {
    let (mut alone, mut several, mut highlights, mut halts) = (0, 0, 0, 0);
    for seed in 0..200 {
        let mut rng = Rng::new(seed);
        let cloud = Cloud::random(
            &mut rng,
            VERTICES.into(),
            FieldForm::S16x3,
            FieldForm::S10x3,
        );
        let settings = PlayerSettings::default();
        let settings = PlayerSettings {
            draw: Draw {
                model: Affine::rotation_x(rng.signed() as f32),
                light: (rng.below(2) == 0).then(|| Light::new([0.3, 0.9, 0.5], 0.2).unwrap()),
                shading: rng.pick(&[Shading::Smooth, Shading::Smooth, Shading::Flat]),
                ..settings.draw
            },
            ..settings
        };
        let (list, sheets) = some_list(&mut rng, &cloud, settings.draw.light);
        let want = drawn::<Smooth>(|scene| {
            for sheet in &sheets {
                sheet.draw(&cloud, &settings.draw, |call| {
                    scene.draw(call).unwrap();
                    let is_lit = call.lights.is_some();
                    alone += u32::from(call.light.is_some());
                    several += u32::from(is_lit);
                    highlights += u32::from(is_lit && sheet.material.specular != [0; 3]);
                });
            }
        });
        for (vertices, indices) in [(5, 9), (64, 256)] {
            let mut kept = Kept::new(vertices, indices).with_lights();
            let mut player = kept.player::<Smooth>(settings);
            // The first begins it, the second begins it anew, with the lights of its beginning.
            for command in [ListCommand::Start(0), ListCommand::Restart] {
                let got = drawn::<Smooth>(|scene| {
                    player.command(command);
                    let few = Budget {
                        instructions: 2,
                        ..PLENTY
                    };
                    loop {
                        match played(&mut player, &list[..], scene, few).unwrap() {
                            Halt::End => break,
                            Halt::Paused => player.command(ListCommand::Resume),
                            _ => {}
                        }
                        halts += 1;
                    }
                });
                assert!(got == want, "seed {seed}, {vertices} vertices, {command:?}");
            }
        }
    }
    let counts = [alone, several, highlights, halts];
    assert!(counts.iter().all(|n| *n > 40), "{counts:?}");
}

/// A strip over the picture, and its block.
fn strip(rng: &mut Rng) -> (Cloud, Header, Vec<u16>) {
    let cloud = Cloud::random(rng, 8, FieldForm::S16x3, FieldForm::S10x3);
    let header = Header {
        shade: true,
        new: true,
        ..Header::of(Id::Short, 8)
    };
    (cloud, header, (0..8).collect())
}

#[test]
fn lights_of_the_settings_fall_until_a_list_has_its_own() {
    let mut rng = Rng::new(7);
    let (cloud, header, order) = strip(&mut rng);
    let lamp = |towards, colour| DirectionalLight::new(towards, colour).unwrap();
    let lamps = [
        lamp([0.0, 1.0, 1.0], [0.9, 0.2, 0.1]),
        lamp([1.0, 0.0, 1.0], [0.0, 0.8, 0.9]),
    ];
    let ambient = [U1F15::from_bits(3000); 3];
    let of_settings = Lighting::new(&lamps, ambient, scanbeam::mesh::Material::default()).unwrap();
    let settings = PlayerSettings::default();
    let settings = PlayerSettings {
        draw: Draw {
            cull: Cull::None,
            lights: Some(&of_settings),
            ..settings.draw
        },
        ..settings
    };
    let light = some_light(&mut rng);
    let mut lights = [None; 8];
    lights[3] = Some(light);
    let own = Sheet {
        lights,
        material: Material {
            two_sided: true,
            ..Material::default()
        },
        faces: unrolled(&order, false),
    };
    let dark = Sheet {
        lights: [None; 8],
        ..own.clone()
    };
    let white = LightWords {
        colour: [255; 3],
        ..light
    };
    let mut alone = dark.clone();
    alone.lights[0] = Some(white);
    let none = Draw {
        lights: None,
        ..settings.draw
    };
    // What the list says, then what its strip looks like.
    let on = State::Light { number: 3, light };
    let off = |number| State::LightOff { number };
    type Said<'a> = (&'a [State], &'a Sheet, &'a Draw<'a, 'static>);
    let first = State::Light {
        number: 0,
        light: white,
    };
    let said: [Said<'_>; 6] = [
        (&[], &dark, &settings.draw),
        (&[off(3)], &dark, &settings.draw),
        (&[on], &own, &none),
        (&[on, off(3)], &dark, &none),
        (&[off(0)], &dark, &none),
        // One that is put out leaves the others as they were.
        (&[first, on, off(3)], &alone, &none),
    ];
    let mut pictures = Vec::new();
    for (n, (states, sheet, begin)) in said.into_iter().enumerate() {
        let mut memory = vec![0; 256];
        let mut writer = ListWriter::new(&mut memory);
        for state in states {
            writer.state(state).unwrap();
        }
        let words = cloud.vertices(writer.format(), header, &order);
        writer.vertices(header, &words).unwrap();
        let mut kept = Kept::new(64, 96).with_lights();
        let mut player = kept.player::<Smooth>(settings);
        let got = drawn::<Smooth>(|scene| {
            player.start(0);
            played(&mut player, writer.words(), scene, PLENTY).unwrap();
        });
        let want = drawn::<Smooth>(|scene| {
            sheet.draw(&cloud, begin, |call| scene.draw(call).unwrap());
        });
        assert!(got == want, "{n}");
        pictures.push(got);
    }
    assert!(pictures[0] != pictures[2] && pictures[2] != pictures[3]);
    assert!(pictures[0] != pictures[3]);
    // What their lights fall on is for the settings to say.
    let shiny = State::Material(SHINY);
    assert_eq!(
        refused::<Smooth>(&[shiny], settings),
        Some((0, Reason::Missing(Missing::Highlights)))
    );
    assert_eq!(refused::<Smooth>(&[on, shiny], settings), None);
}

const SHINY: Material = Material {
    diffuse: [255; 3],
    opacity: 255,
    specular: [9; 3],
    exponent: 3,
    two_sided: false,
    unlit: false,
    texture: None,
};

/// Which state is refused of a list that has a triangle before it and room for lights, and why; if it is one, nothing
/// was drawn.
fn refused<'t, L: Look<Pixel = Rgb565Be>>(
    states: &[State],
    settings: PlayerSettings<'t, 't>,
) -> Option<(usize, Reason)> {
    let mut offsets = Vec::new();
    let (list, at) = after_a_triangle(|writer| {
        for state in states {
            offsets.push(writer.position());
            writer.state(state).unwrap();
        }
        0
    });
    let list: &'t [u32] = Vec::leak(list);
    let kept = Box::leak(Box::new(Kept::new(64, 96).with_lights()));
    let mut player = kept.player::<L>(settings);
    let mut result = Ok(Halt::End);
    drawn::<L>(|scene| {
        player.start(0);
        result = played(&mut player, list, scene, PLENTY);
        assert_eq!(scene.objects() > 0, result.is_ok(), "{result:?}");
    });
    let ListError { offset, reason, .. } = result.err()?;
    let state = offsets.iter().position(|from| at + 4 * from == offset);
    Some((state.unwrap(), reason))
}

#[test]
fn lights_that_there_is_no_room_for_are_refused_where_they_stand() {
    let red = LightWords {
        colour: [255, 0, 0],
        ..LightWords::from(Light::new([0.0, 1.0, 1.0], 0.3).unwrap())
    };
    let on = |number| State::Light { number, light: red };
    let off = |number| State::LightOff { number };
    let settings = PlayerSettings::default();
    let shiny = State::Material(SHINY);
    let all = [on(0), on(7), off(7), off(8), off(255), shiny];
    assert_eq!(refused::<Smooth>(&all, settings), None);
    let missing = |at, missing| Some((at, Reason::Missing(missing)));
    for number in [8, 255] {
        let got = refused::<Smooth>(&[on(7), on(number)], settings);
        assert_eq!(got, missing(1, Missing::Lights));
    }
    // Where light falls on pixels, it is that of the settings.
    type Pixels = Phong<Rgb565Be>;
    let at_pixels = lit_at_pixels();
    let got = refused::<Pixels>(&[on(1)], at_pixels);
    assert_eq!(got, missing(0, Missing::LightAtVertices));
    let got = refused::<Pixels>(&[shiny], at_pixels);
    assert_eq!(got, missing(0, Missing::Highlights));
}
