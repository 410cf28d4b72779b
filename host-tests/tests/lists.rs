//! Lists draw what the same calls draw, in any memory, from any source (H11-H14, H16, K2, K15).

mod common;

use common::{Rng, SceneRooms, frame};
use scanbeam::list::{
    Budget, Field, FieldForm, FieldPacker, Flow, Form, Halt, Header, Id, LightWords, ListCommand,
    ListControl, ListRing, ListWriter, Material, Matrix, SPLIT, State, VertexFormat, Window,
    parameter,
};
use scanbeam::{
    Affine, Camera, Cull, Event, EventFlags, EventSet, Faces, FlatDepth, GouraudDepth, Instance,
    Light, ListCoordinate, ListMemory, ListRunner, ListSettings, Mesh, Notice, OnViolation,
    Pipeline, QuadSplit, Rgb888, Scene, Screen, Vertices, WordOf,
};
use std::sync::atomic::AtomicU32;

type Smooth = GouraudDepth<Rgb888>;
type Faceted = FlatDepth<Rgb888>;

const WIDTH: u16 = 96;
const HEIGHT: u16 = 72;

fn rooms<P: Pipeline>() -> SceneRooms<P> {
    SceneRooms::new(60_000, 60_000, usize::from(HEIGHT))
}

fn begin<P: Pipeline>(scene: &mut Scene<'_, P>) {
    let camera = Camera::look_at([0.3, 0.5, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 90.0, 0.1, 99.0);
    scene.begin(&camera.unwrap()).unwrap();
}

/// What a call draws.
fn drawn<P: Pipeline>(draw: impl FnOnce(&mut Scene<'_, P>)) -> Vec<Vec<WordOf<P>>> {
    let mut rooms = rooms::<P>();
    let mut scene = rooms.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    begin(&mut scene);
    draw(&mut scene);
    frame(&scene, 16)
}

/// Memory of a runner: so many vertices and indices.
struct Room<C> {
    positions: Vec<[C; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    indices: Vec<u16>,
}

impl<C: ListCoordinate> Room<C> {
    fn new(vertices: usize, indices: usize) -> Self {
        Self {
            positions: vec![[C::default(); 3]; vertices],
            normals: vec![[0; 3]; vertices],
            colours: vec![[0; 3]; vertices],
            indices: vec![0; indices],
        }
    }

    fn runner<'m, 'c>(&'m mut self, settings: ListSettings<'c>) -> ListRunner<'m, 'c, C> {
        let memory = ListMemory {
            positions: &mut self.positions,
            normals: &mut self.normals,
            colours: &mut self.colours,
            indices: &mut self.indices,
        };
        ListRunner::new(memory, settings)
    }
}

const PLENTY: Budget = Budget {
    instructions: 1 << 20,
    vertices: 1 << 24,
    jumps: 1 << 10,
};

/// What a list draws, with so much memory; every event but the end's is a failure.
fn listed<P: Pipeline, C: ListCoordinate>(
    list: &[u32],
    instance: Instance,
    (vertices, indices): (usize, usize),
) -> Vec<Vec<WordOf<P>>> {
    drawn::<P>(|scene| {
        let mut room = Room::<C>::new(vertices, indices);
        let mut runner = room.runner(ListSettings {
            instance,
            ..ListSettings::default()
        });
        runner.start(0);
        let mut notices = Vec::new();
        let mut budget = PLENTY;
        let halt = runner.run(list, scene, &mut budget, &mut |n: Notice| notices.push(n));
        assert_eq!(halt, Ok(Halt::End));
        notices.retain(|n| !matches!(n.event, Event::ListEnd | Event::Clipped));
        assert_eq!(notices, []);
    })
}

/// Vertices whose numbers every form of a format can hold.
struct Cloud {
    positions: Vec<[i16; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
}

impl Cloud {
    fn random(rng: &mut Rng, count: usize, place: FieldForm, normal: FieldForm) -> Self {
        let field = |rng: &mut Rng, form| match form {
            FieldForm::S8x3 => [0; 3].map(|_: i32| rng.within(-128, 127)),
            FieldForm::S10x3 => [
                rng.within(-1024, 1023),
                rng.within(-1024, 1023),
                rng.within(-512, 511),
            ],
            _ => [0; 3].map(|_: i32| rng.within(-16_384, 16_384)),
        };
        let mut cloud = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
        };
        for _ in 0..count {
            // What the fields mean, said a second time and otherwise: as fractions of 1.
            let p = field(rng, place);
            let q14 = |v: i32, unit: f64| (f64::from(v) / unit * 16_384.0) as i16;
            cloud.positions.push(match place {
                FieldForm::S8x3 => p.map(|v| q14(v, 128.0)),
                FieldForm::S10x3 => [q14(p[0], 1024.0), q14(p[1], 1024.0), q14(p[2], 512.0)],
                _ => p.map(|v| v as i16),
            });
            let n = field(rng, normal);
            let full = |v: i32, most: f64| (f64::from(v) * (16_384.0 - 1.0 / most) / most).floor();
            cloud.normals.push(match normal {
                FieldForm::S8x3 => n.map(|v| (v * 129) as i16),
                FieldForm::S10x3 => [
                    full(n[0], 1023.0) as i16,
                    full(n[1], 1023.0) as i16,
                    full(n[2], 511.0) as i16,
                ],
                _ => n.map(|v| v as i16),
            });
            cloud.colours.push([0; 3].map(|_: u8| rng.below(256) as u8));
        }
        cloud
    }

    /// The fields again.
    fn place_fields(&self, i: usize, form: FieldForm) -> [i32; 4] {
        let [x, y, z] = self.positions[i].map(i32::from);
        match form {
            FieldForm::S8x3 => [x >> 7, y >> 7, z >> 7, 0],
            FieldForm::S10x3 => [x >> 4, y >> 4, z >> 5, 0],
            FieldForm::S32x3 => [x << 16, y << 16, z << 16, 0],
            _ => [x, y, z, 0],
        }
    }

    fn normal_fields(&self, i: usize, form: FieldForm) -> [i32; 4] {
        let [x, y, z] = self.normals[i].map(i32::from);
        let back =
            |v: i32, most: i32| ((f64::from(v) + 0.5) / 16_384.0 * f64::from(most)).round() as i32;
        match form {
            FieldForm::S8x3 => [x / 129, y / 129, z / 129, 0],
            FieldForm::S10x3 => [back(x, 1023), back(y, 1023), back(z, 511), 0],
            _ => [x, y, z, 0],
        }
    }

    fn field(&self, field: Field, i: usize) -> [i32; 4] {
        match field.parameter {
            parameter::PLACE => self.place_fields(i, field.form),
            parameter::NORMAL => self.normal_fields(i, field.form),
            parameter::DIFFUSE => {
                let [r, g, b] = self.colours[i].map(i32::from);
                [r, g, b, 255]
            }
            // What this reader does not know is passed over.
            _ => [i as i32, -1, 7, 1 << 20],
        }
    }

    /// The words of some vertices, one after the other.
    fn vertices(&self, format: &VertexFormat, header: Header, order: &[u16]) -> Vec<u32> {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for &i in order {
            for field in format.fields_of(header) {
                packer.field(field.form, self.field(field, usize::from(i)));
                packer.align();
            }
        }
        words
    }

    /// The words of all vertices, column by column.
    fn columns(&self, format: &VertexFormat, header: Header) -> Vec<u32> {
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for field in format.fields_of(header) {
            for i in 0..self.positions.len() {
                packer.field(field.form, self.field(field, i));
            }
            packer.align();
        }
        words
    }

    /// As the immediate calls take them; without colours and normals where the header has none.
    fn plain(&self, shade: bool, format: &VertexFormat) -> Vertices<'_> {
        let has = |p| shade && format.fields().iter().any(|f| f.parameter == p);
        Vertices {
            positions: &self.positions,
            normals: if has(parameter::NORMAL) {
                &self.normals
            } else {
                &[]
            },
            colours: if has(parameter::DIFFUSE) {
                &self.colours
            } else {
                &[]
            },
        }
    }
}

/// Triangles of a strip or fan, by the definition: each from its corners' places in the strip.
fn unrolled(order: &[u16], fan: bool) -> Vec<[u16; 3]> {
    (2..order.len())
        .map(|k| match (fan, k % 2) {
            (true, _) => [order[0], order[k - 1], order[k]],
            (false, 0) => [order[k - 2], order[k - 1], order[k]],
            (false, _) => [order[k - 1], order[k - 2], order[k]],
        })
        .collect()
}

fn some_instance(rng: &mut Rng) -> Instance {
    Instance {
        model: Affine::rotation_y(rng.signed() as f32 * 3.0),
        cull: rng.pick(&[Cull::Back, Cull::None]),
        light: rng
            .pick(&[true, false])
            .then(|| Light::new([0.3, 0.9, 0.5], 0.2).unwrap()),
        colour: [200, 90, 40],
    }
}

fn some_format(rng: &mut Rng) -> (VertexFormat, FieldForm, FieldForm) {
    let place = rng.pick(&[FieldForm::S16x3, FieldForm::S10x3, FieldForm::S8x3]);
    let normal = rng.pick(&[FieldForm::S16x3, FieldForm::S10x3, FieldForm::S8x3]);
    let mut fields = vec![Field {
        parameter: parameter::PLACE,
        form: place,
    }];
    if rng.below(3) > 0 {
        fields.push(Field {
            parameter: parameter::NORMAL,
            form: normal,
        });
    }
    if rng.below(3) > 0 {
        fields.push(Field {
            parameter: parameter::DIFFUSE,
            form: rng.pick(&[FieldForm::U8x3, FieldForm::U8x4]),
        });
    }
    if rng.below(3) == 0 {
        fields.push(Field {
            parameter: 9,
            form: rng.pick(&FieldForm::ALL),
        });
    }
    rng.shuffle(&mut fields);
    (VertexFormat::new(&fields).unwrap(), place, normal)
}

fn strips_and_fans<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 40, place, normal);
        let instance = some_instance(&mut rng);
        let shade = rng.below(4) > 0;
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let mut faces = Vec::new();
        for _ in 0..1 + rng.below(6) {
            let fan = rng.below(2) == 1;
            let order: Vec<u16> = (0..rng.below(20)).map(|_| rng.below(40) as u16).collect();
            faces.extend(unrolled(&order, fan));
            // In blocks of random lengths, each going on with the one before.
            let mut rest = &order[..];
            let mut new = true;
            while new || !rest.is_empty() {
                let (part, left) = rest.split_at(rng.below(rest.len() as u32 + 1) as usize);
                rest = left;
                let header = Header {
                    shade,
                    new,
                    rm: fan,
                    ..Header::of(Id::Short, part.len() as u16)
                };
                let words = cloud.vertices(&format, header, part);
                writer.vertices(header, &words).unwrap();
                new = false;
            }
        }
        if rng.below(2) == 0 {
            writer.flow(Flow::End).unwrap();
        }
        let list = writer.words();
        let want = drawn::<P>(|scene| {
            let vertices = cloud.plain(shade, &format);
            scene.draw_indexed(vertices, &faces, &instance).unwrap();
        });
        for room in [(4, 4), (5, 7), (9, 100), (1000, 1000)] {
            let got = listed::<P, i16>(list, instance, room);
            assert!(got == want, "seed {seed}, room {room:?}");
            let got = listed::<P, i32>(list, instance, room);
            assert!(got == want, "seed {seed}, room {room:?}, 32 bits");
        }
    }
}

#[test]
fn strips_and_fans_are_the_triangles_that_they_stand_for() {
    strips_and_fans::<Smooth>(0..60);
    strips_and_fans::<Faceted>(100..130);
}

fn quads<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 40, place, normal);
        let instance = some_instance(&mut rng);
        let strip = rng.below(2) == 1;
        let split = rng.pick(&[QuadSplit::Corner0To2, QuadSplit::Corner1To3]);
        let group = if strip { 2 } else { 4 };
        let order: Vec<u16> = (0..group * (2 + rng.below(8)))
            .map(|_| rng.below(40) as u16)
            .collect();
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let (mut rest, mut new) = (&order[..], true);
        while !rest.is_empty() {
            let most = rest.len() as u32 / group;
            let (part, left) = rest.split_at((group * (1 + rng.below(most))) as usize);
            rest = left;
            let header = Header {
                shade: true,
                new: new || !strip,
                rm: strip,
                low: if split == QuadSplit::Corner1To3 {
                    SPLIT
                } else {
                    0
                },
                ..Header::of(Id::Quads, part.len() as u16)
            };
            let words = cloud.vertices(&format, header, part);
            writer.vertices(header, &words).unwrap();
            new = false;
        }
        let list = writer.words();
        let mut fours = Vec::new();
        fours.extend(order.chunks_exact(4).map(|q| [q[0], q[1], q[2], q[3]]));
        let vertices = cloud.plain(true, &format);
        let want = drawn::<P>(|scene| {
            let mesh = Mesh {
                positions: vertices.positions,
                normals: vertices.normals,
                colours: vertices.colours,
                faces: if strip {
                    Faces::QuadStrip(&order, split)
                } else {
                    Faces::Quads(&fours, split)
                },
            };
            scene.draw(&mesh, &instance).unwrap();
        });
        for room in [(4, 4), (5, 6), (9, 100), (1000, 1000)] {
            assert!(
                listed::<P, i16>(list, instance, room) == want,
                "seed {seed}, room {room:?}, strip {strip}"
            );
        }
    }
}

#[test]
fn quads_and_quad_strips_are_those_of_meshes() {
    quads::<Smooth>(0..60);
    quads::<Faceted>(100..140);
}

fn indexed<P: Pipeline>(seeds: std::ops::Range<u64>)
where
    WordOf<P>: PartialEq + std::fmt::Debug,
{
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let count = 30 + rng.below(3) as usize;
        let cloud = Cloud::random(&mut rng, count, place, normal);
        let instance = some_instance(&mut rng);
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let header = Header {
            shade: true,
            ..Header::of(Id::Table, count as u16)
        };
        writer
            .vertices(header, &cloud.columns(&format, header))
            .unwrap();
        let mut faces = Vec::new();
        for _ in 0..1 + rng.below(4) {
            let form = rng.pick(&[None, Some(Form::Strip), Some(Form::Fan)]);
            let mut indices = Vec::new();
            for _ in 0..1 + rng.below(4) {
                let mut len = rng.below(12);
                len -= if form.is_none() { len % 3 } else { 0 };
                let order: Vec<u16> = (0..len).map(|_| rng.below(count as u32) as u16).collect();
                match form {
                    None => faces.extend(order.chunks_exact(3).map(|f| [f[0], f[1], f[2]])),
                    Some(form) => faces.extend(unrolled(&order, form == Form::Fan)),
                }
                if form.is_some() && !indices.is_empty() {
                    indices.push(None);
                }
                indices.extend(order.into_iter().map(Some));
            }
            let wide = rng.below(2) == 1;
            writer.indexed(form, wide, indices.into_iter()).unwrap();
        }
        let list = writer.words();
        let want = drawn::<P>(|scene| {
            let vertices = cloud.plain(true, &format);
            scene.draw_indexed(vertices, &faces, &instance).unwrap();
        });
        for room in [(40, 4), (33, 31), (1000, 1000)] {
            assert!(
                listed::<P, i16>(list, instance, room) == want,
                "seed {seed}, room {room:?}"
            );
            assert!(listed::<P, i32>(list, instance, room) == want);
        }
        // What can be used where it lies needs no room.
        if format.fields().iter().all(|f| {
            matches!(
                (f.parameter, f.form),
                (0 | 4, FieldForm::S16x3) | (2, FieldForm::U8x3) | (9, _)
            )
        }) {
            assert!(listed::<P, i16>(list, instance, (4, 9)) == want);
        }
    }
}

#[test]
fn tables_are_indexed_meshes() {
    indexed::<Smooth>(0..80);
    indexed::<Faceted>(100..140);
}

#[test]
fn immediate_calls_are_meshes() {
    let mut rng = Rng::new(3);
    let cloud = Cloud::random(&mut rng, 840, FieldForm::S16x3, FieldForm::S16x3);
    let vertices = cloud.plain(true, &VertexFormat::default());
    let instance = some_instance(&mut rng);
    let threes: Vec<[u16; 3]> = (0..280).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let fours: Vec<[u16; 4]> = (0..210).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k)).collect();
    let triangles = drawn::<Smooth>(|scene| {
        let done = scene.draw_triangles(vertices, &instance).unwrap();
        assert_eq!(done.triangles, 280);
    });
    let indexed = drawn::<Smooth>(|scene| {
        scene.draw_indexed(vertices, &threes, &instance).unwrap();
    });
    assert!(triangles == indexed);
    for split in [QuadSplit::Corner0To2, QuadSplit::Corner1To3] {
        let quads = drawn::<Faceted>(|scene| {
            let done = scene.draw_quads(vertices, split, &instance).unwrap();
            assert_eq!(done.triangles, 420);
        });
        let mesh = Mesh {
            positions: vertices.positions,
            normals: vertices.normals,
            colours: vertices.colours,
            faces: Faces::Quads(&fours, split),
        };
        let want = drawn::<Faceted>(|scene| {
            scene.draw(&mesh, &instance).unwrap();
        });
        assert!(quads == want);
    }
    let bad = Vertices {
        normals: &cloud.normals[1..],
        ..vertices
    };
    drawn::<Smooth>(|scene| assert!(scene.draw_triangles(bad, &instance).is_err()));
}

/// A block that draws one triangle at a place of its own.
fn triangle(i: u32) -> Vec<u32> {
    let mut memory = [0; 32];
    let mut writer = ListWriter::new(&mut memory);
    let matrix = Affine::placed(
        0.2,
        [i as f32 % 9.0 / 3.0 - 1.4, i as f32 / 40.0 - 1.0, 0.0],
    );
    let matrix = Matrix::try_from(&matrix.unwrap()).unwrap();
    writer.state(&State::Matrix(matrix)).unwrap();
    let header = Header {
        new: true,
        ..Header::of(Id::Short, 3)
    };
    let one = 1 << 14;
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for [x, y] in [[-one, -one], [one, -one], [0, one]] {
        packer.field(FieldForm::S16x3, [x, y, 0, 0]);
        packer.align();
    }
    writer.vertices(header, &words).unwrap();
    writer.words().to_vec()
}

#[test]
fn a_list_that_grows_while_it_is_drawn_is_drawn_once() {
    const ALL: u32 = 80;
    let whole: Vec<u32> = (0..ALL).flat_map(triangle).collect();
    let want = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(0);
        let halt = runner.run(&whole[..], scene, &mut PLENTY.clone(), &mut |_| {});
        assert_eq!(halt, Ok(Halt::End));
        assert_eq!(runner.counts().triangles, ALL);
    });
    // Another thread writes into a ring that holds three blocks and a half, and waits for room.
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let mut memory = [const { AtomicU32::new(0) }; 64];
        let mut ring = ListRing::new(&mut memory);
        let (mut writer, mut reader) = ring.split();
        let mut pauses: Vec<u32> = (0..ALL).map(|_| rng.below(40)).collect();
        let got = drawn::<Smooth>(|scene| {
            std::thread::scope(|threads| {
                threads.spawn(move || {
                    for i in 0..ALL {
                        let block = triangle(i);
                        while writer.append(&block).is_err() {
                            std::thread::yield_now();
                        }
                        for _ in 0..pauses.pop().unwrap() {
                            std::hint::spin_loop();
                        }
                    }
                    let mut memory = [0; 1];
                    let mut end = ListWriter::new(&mut memory);
                    end.flow(Flow::End).unwrap();
                    while writer.append(end.words()).is_err() {}
                });
                let mut room = Room::<i16>::new(64, 64);
                let mut runner = room.runner(ListSettings::default());
                runner.start(0);
                let flags = EventFlags::new(EventSet::ALL);
                loop {
                    // Small budgets, so that it halts between any two blocks.
                    let mut budget = Budget {
                        instructions: 1 + rng.below(4),
                        ..PLENTY
                    };
                    let halt = runner.run(reader.words(), scene, &mut budget, &mut &flags);
                    reader.free_to(runner.position());
                    match halt.unwrap() {
                        Halt::End => break,
                        Halt::Waiting | Halt::Budget => {}
                        other => panic!("{other:?}"),
                    }
                }
                assert!(flags.take().has(Event::ListEnd));
                assert_eq!(runner.counts().triangles, ALL);
            });
        });
        assert!(got == want, "seed {seed}");
    }
}

#[test]
fn what_a_list_must_not_do_is_an_event() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    writer.master(0x77).unwrap();
    let all = Window {
        left: 0,
        top: 0,
        right: WIDTH,
        bottom: HEIGHT,
    };
    let wide = Window {
        right: WIDTH + 1,
        ..all
    };
    writer.state(&State::Window(wide)).unwrap();
    writer.state(&State::Window(all)).unwrap();
    writer.flow(Flow::Jump(0xFFFF_FF00)).unwrap();
    let camera = scanbeam::list::CameraWords {
        eye: [0.0; 3],
        at: [1.0; 3],
        up: [0.0, 1.0, 0.0],
        focal: 100.0,
        near: 0.1,
        far: 9.0,
    };
    writer.state(&State::Camera(camera)).unwrap();
    writer.flow(Flow::LoadTexture { number: 0, at: 0 }).unwrap();
    let violations = 5;
    let from = writer.position();
    let drawn_part = triangle(7);
    let list: Vec<u32> = writer.words().iter().chain(&drawn_part).copied().collect();
    let want = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(from);
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_| {});
        assert_eq!((halt, runner.counts().violations), (Ok(Halt::End), 0));
    });
    let got = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(0);
        let mut seen = Vec::new();
        let mut events = |n: Notice| seen.push((n.event, n.offset));
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut events);
        assert_eq!(
            (halt, runner.counts().violations),
            (Ok(Halt::End), violations)
        );
        let offsets: Vec<u32> = seen
            .iter()
            .filter(|(event, _)| *event == Event::AccessViolation)
            .map(|(_, offset)| *offset)
            .collect();
        assert_eq!(offsets, [0, 8, 32, 40, 92]);
    });
    assert!(got == want);
    let stopped = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings {
            on_violation: OnViolation::Stop,
            ..ListSettings::default()
        });
        runner.start(0);
        for _ in 0..violations {
            let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_| {});
            assert_eq!(halt, Ok(Halt::Violation));
            runner.command(ListCommand::Resume);
        }
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_| {});
        assert_eq!(halt, Ok(Halt::End));
    });
    assert!(stopped == want);
}

#[test]
fn what_the_pipeline_lacks_is_an_event_and_the_rest_is_drawn() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    let glass = Material {
        diffuse: [10, 200, 30],
        opacity: 128,
        ..Material::default()
    };
    writer.state(&State::Material(glass)).unwrap();
    let light = Light::new([0.0, 1.0, 1.0], 0.3).unwrap();
    let light = LightWords::from(light);
    writer.state(&State::Light { number: 0, light }).unwrap();
    writer.state(&State::Light { number: 3, light }).unwrap();
    let list: Vec<u32> = writer
        .words()
        .iter()
        .chain(&triangle(40))
        .copied()
        .collect();
    let got = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(0);
        let flags = EventFlags::new(EventSet::ALL);
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut &flags);
        assert_eq!(halt, Ok(Halt::End));
        assert_eq!(runner.counts().unimplemented, 2);
        assert!(flags.take().has(Event::Unimplemented));
    });
    let want = [10u8, 200, 30];
    let pixels = got.iter().flatten().filter(|p| **p == want);
    assert!(pixels.count() > 20);
}

#[test]
fn pauses_syncs_interrupts_and_commands_halt_where_they_stand() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    writer.flow(Flow::Interrupt(42)).unwrap();
    writer.flow(Flow::Pause).unwrap();
    writer.flow(Flow::Sync).unwrap();
    let mut list = writer.words().to_vec();
    list.extend(triangle(4));
    let control = ListControl::new();
    drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings {
            control: Some(&control),
            ..ListSettings::default()
        });
        let mut seen = Vec::new();
        let mut budget = PLENTY;
        let mut call = |runner: &mut ListRunner<'_, '_>| {
            runner.run(&list[..], scene, &mut budget, &mut |n: Notice| {
                seen.push((n.event, n.value));
            })
        };
        assert_eq!(call(&mut runner), Ok(Halt::Stopped));
        control.send(ListCommand::Start(0));
        assert_eq!(call(&mut runner), Ok(Halt::Paused));
        assert_eq!(call(&mut runner), Ok(Halt::Stopped));
        control.send(ListCommand::Resume);
        assert_eq!(call(&mut runner), Ok(Halt::Sync));
        control.send(ListCommand::Step);
        assert_eq!(call(&mut runner), Ok(Halt::Stepped));
        assert_eq!(runner.counts().triangles, 0, "the matrix alone");
        control.send(ListCommand::Step);
        assert_eq!(call(&mut runner), Ok(Halt::Stepped));
        assert_eq!(runner.counts().triangles, 1);
        control.send(ListCommand::Resume);
        assert_eq!(call(&mut runner), Ok(Halt::End));
        control.send(ListCommand::Restart);
        assert_eq!(call(&mut runner), Ok(Halt::Paused));
        assert_eq!(
            seen,
            [
                (Event::Interrupt, 42),
                (Event::Paused, 0),
                (Event::Sync, 0),
                (Event::ListEnd, 0),
                (Event::Interrupt, 42),
                (Event::Paused, 0),
            ]
        );
    });
}
