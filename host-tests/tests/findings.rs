//! Promises that were once broken at the ends of their ranges, each held by what a caller sees.

use crate::common::{Rng, SceneRooms, frame};
use host_tests::rooms::{self, Room};
use scanbeam::look;
use scanbeam::mesh::{I2F14, U1F15};
use scanbeam::pipeline::{
    Composited, FlatDepth, FlatPainter, GouraudDepth, Instance, LineDepth, LineMemory,
    LineRenderer, ObjectOf, Pipeline, Scene, SceneMemory, SlotOf, VertexOf,
};
use scanbeam::pixel::{Grey8, Rgb565, Rgb888};
use scanbeam::scan_out::{ErrorType, LineBuf, Pump, ScanError, ScanoutDma, ShownRuns, Window};
use scanbeam::scene::{self, ShadowEdge, ShadowLight, ShadowMemory};
use scanbeam::{Affine, Camera, CameraError, Cull, Faces, Light, Link, Mesh, MeshError, Screen};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::sync::Mutex;
use std::task::Poll;

/// A camera at the origin that looks along -z.
fn camera(focal: f32, near: f32, far: f32) -> Result<Camera, CameraError> {
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at([0.0; 3], ahead, up, focal, near, far)
}

/// A mesh of triangles without colours.
fn mesh<'a>(positions: &'a [[i16; 3]], faces: &'a [[u16; 3]]) -> Mesh<'a> {
    Mesh {
        positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(faces),
    }
}

/// One pixel in the middle of surfaces that face the eye, at these distances and drawn in this
/// order: which of them is seen, from 1 on.
fn seen(camera: &Camera, distances: &[f64]) -> u8 {
    let mut rooms = SceneRooms::<FlatDepth<Rgb888>>::new(9, 9, 1);
    let mut scene = rooms.scene(Screen::new(1, 1).unwrap());
    scene.begin(camera).unwrap();
    for (number, distance) in (1..).zip(distances) {
        // In 2^-14 of the distance, so that it is not rounded by the mesh.
        let positions = [
            [-8192, -8192, -16_384],
            [8192, -8192, -16_384],
            [0, 8192, -16_384],
        ];
        let instance = Instance {
            model: Affine::placed(*distance as f32, [0.0; 3]).unwrap(),
            colour: [number; 3],
            ..Instance::default()
        };
        scene
            .draw(&mesh(&positions, &[[0, 1, 2]]), &instance)
            .unwrap();
    }
    frame(&scene, 2)[0][0][0]
}

/// Whatever near and far a camera accepts, of two surfaces a thousandth of their distance apart
/// the nearer one is seen, in either order; and what it does not accept it refuses by name.
#[test]
fn a_thousandth_apart_the_nearer_is_seen_at_any_distance() {
    let mut rng = Rng::new(301);
    for _ in 0..4_000 {
        let near = rng.between(-50.0, 60.0).exp2() as f32;
        let ratio = rng.between(0.1, 16.0).exp2() as f32;
        let camera = camera(20.0, near, near * ratio).unwrap();
        let (near, far) = (f64::from(near), f64::from(near * ratio) / 1.002);
        let away = near * (far / near).powf(rng.pick(&[0.0, 1.0, rng.clone().unit()])) * 1.0005;
        assert_eq!(
            seen(&camera, &[away, away * 1.001]),
            1,
            "{near} {ratio} {away}"
        );
        assert_eq!(
            seen(&camera, &[away * 1.001, away]),
            2,
            "{near} {ratio} {away}"
        );
    }
    for near in [1e-15f32, 0.001, 1.0, 3e5] {
        assert!(camera(20.0, near, 65_536.0 * near).is_ok());
        let beyond = (65_536.0 * near).next_up();
        assert_eq!(camera(20.0, near, beyond).err(), Some(CameraError::Ratio));
        assert_eq!(
            camera(20.0, near, 1e6 * near).err(),
            Some(CameraError::Ratio)
        );
    }
}

/// Triangles at the rim of the largest pictures, against one test a pixel.
#[test]
fn the_rim_of_the_largest_pictures_is_drawn() {
    let mut rng = Rng::new(302);
    let mut covered = 0;
    for round in 0..400 {
        let across = rng.pick(&[8192u16, 8191, 8176, 8161, 8160]);
        let upright = round % 2 == 1;
        let (width, height) = if upright { (40, across) } else { (across, 40) };
        let far_side = rng.below(2) == 1;
        // In 1/4 pixels from the principal point, which are exact: 4096 focal, 2^-14 a unit.
        let half = 2 * i32::from(across);
        let mut corner = || {
            let out = (half - rng.within(0, 64)).min(16_383);
            let out = if far_side { out } else { -out };
            let along = rng.within(-80, 80);
            if upright { (along, out) } else { (out, along) }
        };
        let corners = [corner(), corner(), corner()];
        let positions = corners.map(|(x, y)| [x as i16, -y as i16, -16_384]);
        let mut rooms = SceneRooms::<FlatPainter<Grey8>>::new(64, 64, usize::from(height));
        let screen = Screen::new(width, height).unwrap();
        let mut scene = rooms.scene(screen);
        scene.begin(&camera(4096.0, 0.1, 9.0).unwrap()).unwrap();
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        scene
            .draw(&mesh(&positions, &[[0, 1, 2]]), &instance)
            .unwrap();
        let picture = frame(&scene, 2);
        // Centres of pixels in the same quarters, doubled.
        let middle = |side: u16| 4 * i32::from(side / 2) + 2 * i32::from(side & 1);
        let at = corners.map(|(x, y)| (2 * x, 2 * y));
        let side = |a: (i32, i32), b: (i32, i32), p: (i32, i32)| {
            i64::from(b.0 - a.0) * i64::from(p.1 - a.1)
                - i64::from(b.1 - a.1) * i64::from(p.0 - a.0)
        };
        for (y, line) in picture.iter().enumerate() {
            for (x, pixel) in line.iter().enumerate() {
                let p = (
                    2 * (4 * x as i32 + 2 - middle(width)),
                    2 * (4 * y as i32 + 2 - middle(height)),
                );
                let sides = [0, 1, 2].map(|i| side(at[i], at[(i + 1) % 3], p));
                let (low, high) = (sides.iter().min().unwrap(), sides.iter().max().unwrap());
                // On an edge one of the neighbours has the pixel; and a cut at the rim is rounded.
                let near = sides.iter().any(|s| s.abs() < 2 * 400);
                if near {
                    continue;
                }
                let inside = *low > 0 || *high < 0;
                covered += u32::from(inside);
                assert_eq!(
                    *pixel != 0,
                    inside,
                    "{width} x {height}, {x}, {y}: {corners:?}"
                );
            }
        }
    }
    println!("{covered} pixels at the rim");
    assert!(covered > 10_000, "{covered}");
}

/// P4: whatever the public fields of a light hold, no colour wraps: in a light that is brighter
/// than 1 everywhere a mesh has its own colour.
#[test]
fn light_above_1_is_full_light() {
    let positions = [
        [-8192, -8192, -16_384],
        [8192, -8192, -16_384],
        [0, 8192, -16_384],
    ];
    for normal in [[0, 0, -16_384], [0, 0, 8192], [0, 0, -8192], [i16::MIN; 3]] {
        for ambient in [32_768, 32_769, 40_960, 65_535].map(U1F15::from_bits) {
            let light = Light {
                direction: [I2F14::ZERO, I2F14::ZERO, I2F14::ONE],
                ambient,
            };
            let mut rooms = SceneRooms::<GouraudDepth<Rgb888>>::new(3, 1, 8);
            let mut scene = rooms.scene(Screen::new(8, 8).unwrap());
            scene.begin(&camera(9.0, 0.1, 9.0).unwrap()).unwrap();
            let lit = Mesh {
                normals: &[normal; 3],
                ..mesh(&positions, &[[0, 1, 2]])
            };
            let instance = Instance {
                light: Some(light),
                colour: [200, 100, 50],
                ..Instance::default()
            };
            scene.draw(&lit, &instance).unwrap();
            assert_eq!(
                frame(&scene, 1)[4][4],
                [200, 100, 50],
                "{ambient}, {normal:?}"
            );
        }
    }
}

/// A mesh that names a vertex it does not have is refused whole, by shadows as by `draw`.
#[test]
fn shadows_of_meshes_that_contradict_themselves_are_refused() {
    let positions = [
        [-8192, -8192, -16_384],
        [8192, -8192, -16_384],
        [0, 8192, -16_384],
    ];
    let faces = [[0, 1, 2], [0, 1, 3]];
    let room = Room {
        vertices: 99,
        places: 0,
        objects: 99,
        draws: 9,
    };
    let mut rooms = rooms::SceneRooms::new(room, 8);
    let mut scene = rooms.scene::<look::Gouraud<Rgb888>>(Screen::new(8, 8).unwrap());
    scene.begin(&camera(9.0, 0.1, 9.0).unwrap()).unwrap();
    let light = ShadowLight {
        light: 0,
        direction: [I2F14::ZERO, I2F14::ZERO, I2F14::ONE],
        reach: 3,
    };
    let mut shadow = |mesh: &Mesh<'_>| {
        let memory = ShadowMemory {
            edges: &mut [ShadowEdge::default(); 9],
            positions: &mut [[0; 3]; 12],
            faces: &mut [[0; 3]; 12],
        };
        let done = scene.draw_shadow(mesh, &Affine::IDENTITY, &light, memory);
        (done, scene.objects())
    };
    let bad = |error| Err(scene::DrawError::Mesh(error));
    let index = bad(MeshError::Index { face: 1 });
    assert_eq!(shadow(&mesh(&positions, &faces)), (index, 0));
    let uneven = Mesh {
        normals: &[[0; 3]; 2],
        ..mesh(&positions, &faces[..1])
    };
    assert_eq!(shadow(&uneven), (bad(MeshError::AttributeLength), 0));
    assert!(matches!(
        shadow(&mesh(&positions, &faces[..1])),
        (Ok(_), 1..)
    ));
}

/// A line buffer that a sink can cut.
struct Cut(Vec<u16>);

impl LineBuf for Cut {
    type Word = u16;

    fn pixels(&mut self) -> &mut [u16] {
        &mut self.0
    }
}

/// Gives back buffers that are shorter, from one of its transfers on.
struct Shortening {
    buffers: VecDeque<Cut>,
    /// Transfers until then.
    good: u32,
    starts: u32,
    open: bool,
}

impl ErrorType for Shortening {
    type Error = Infallible;
}

impl ScanoutDma for Shortening {
    type Buf = Cut;

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        self.open = true;
        Ok(())
    }

    fn start(&mut self, mut buf: Cut, len: usize) -> Result<(), (Infallible, Cut)> {
        assert!(len <= buf.0.len(), "a transfer of what is not there");
        self.starts += 1;
        if self.starts > self.good {
            buf.0.truncate(5);
        }
        self.buffers.push_back(buf);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Cut>, Infallible>> {
        Poll::Ready(Ok(self.buffers.pop_front()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
        self.open = false;
        Ok(())
    }
}

fn shortening(good: u32) -> Pump<Shortening> {
    let sink = Shortening {
        buffers: VecDeque::new(),
        good,
        starts: 0,
        open: false,
    };
    Pump::new(sink, [Cut(vec![0; 16]), Cut(vec![0; 16])])
}

/// Every error ends the frame, and takes the line back.
#[test]
fn a_buffer_that_comes_back_short_ends_the_frame() {
    let window = Window {
        x: 0,
        y: 0,
        width: 8,
        height: 12,
    };
    let short = ScanError::BufferTooShort { needed: 8, have: 5 };
    for good in 0..3 {
        let mut pump = shortening(good);
        pump.begin(window, 1).unwrap();
        let mut lines = 0;
        let error = loop {
            match pump.line() {
                Ok(line) => line.fill(lines),
                Err(error) => break error,
            }
            pump.line_done().unwrap();
            lines += 1;
            assert!(lines < 12, "no error");
        };
        assert_eq!(error, short);
        assert!(!pump.sink().open, "the rectangle is closed");
        let starts = pump.sink().starts;
        assert_eq!(pump.line_done(), Err(ScanError::OutOfTurn { line: 0 }));
        assert_eq!(pump.line().err(), Some(ScanError::OutOfTurn { line: 0 }));
        assert_eq!(pump.finish(), Err(ScanError::OutOfTurn { line: 0 }));
        assert_eq!(pump.sink().starts, starts, "nothing more is sent");
        // The buffers are home, too short for another frame of this size.
        assert_eq!(pump.begin(window, 1), Err(short));
        let narrow = Window { width: 5, ..window };
        pump.begin(narrow, 1).unwrap();
        assert_eq!(pump.line().map(|line| line.len()), Ok(5));
    }
}

/// The same for frames of which cells are left out.
#[test]
fn a_buffer_that_comes_back_short_ends_a_frame_of_runs() {
    let window = Window {
        x: 0,
        y: 0,
        width: 8,
        height: 12,
    };
    let mut words = vec![0; ShownRuns::words(8, 12, 4, 1)];
    let mut shown = ShownRuns::new(&mut words, 8, 4, 1);
    let mut pump = shortening(1);
    let mut frame = pump.begin_in_runs(window, 1, &mut shown).unwrap();
    let mut lines = 0;
    let error = loop {
        match frame.line() {
            Ok(line) => line.fill(lines),
            Err(error) => break error,
        }
        if let Err(error) = frame.line_done() {
            break error;
        }
        lines += 1;
        assert!(lines < 12, "no error");
    };
    assert!(
        matches!(error, ScanError::BufferTooShort { have: 5, .. }),
        "{error:?}"
    );
    assert_eq!(frame.line_done(), Err(ScanError::OutOfTurn { line: 12 }));
    assert_eq!(frame.line().err(), Some(ScanError::OutOfTurn { line: 12 }));
    assert!(!pump.sink().open, "the rectangle is closed");
    let narrow = Window { width: 5, ..window };
    pump.begin(narrow, 1).unwrap();
}

/// Arenas, cache and line memory of a pipeline as statics, as firmware puts them into sections.
struct Arenas<P: Pipeline> {
    vertices: [VertexOf<P>; 8],
    objects: [ObjectOf<P>; 8],
    slots: [SlotOf<P>; 2],
    depth: [<P::Depth as LineDepth>::Cell; 8],
    buckets: [Link; 8],
    links: [Link; 8],
}

impl<P: Pipeline> Arenas<P> {
    const fn new() -> Self {
        Self {
            vertices: [VertexOf::<P>::empty(); 8],
            objects: [ObjectOf::<P>::empty(); 8],
            slots: [LineRenderer::<P>::empty_slot(); 2],
            depth: [<P::Depth as LineDepth>::FARTHEST; 8],
            buckets: [Link::NONE; 8],
            links: [Link::NONE; 8],
        }
    }

    /// Whether the middle of a triangle is drawn in this memory.
    fn draws(&mut self) -> bool {
        let positions = [
            [-8192, -8192, -16_384],
            [8192, -8192, -16_384],
            [0, 8192, -16_384],
        ];
        let memory = SceneMemory {
            vertices: &mut self.vertices,
            objects: &mut self.objects,
            buckets: &mut self.buckets,
        };
        let mut scene = Scene::<P>::new(Screen::new(8, 8).unwrap(), memory);
        scene.begin(&camera(9.0, 0.1, 9.0).unwrap()).unwrap();
        scene
            .draw(&mesh(&positions, &[[0, 1, 2]]), &Instance::default())
            .unwrap();
        let memory = LineMemory {
            slots: &mut self.slots,
            links: &mut self.links,
            depth: &mut self.depth,
        };
        let mut out = [Default::default(); 8];
        LineRenderer::<P>::new(memory)
            .draw_line(&scene, 4, &mut out)
            .unwrap();
        let (middle, corner) = (out[4], out[0]);
        middle != corner
    }
}

/// Records are made at compile time, whatever the pipeline is.
#[test]
fn arenas_can_be_statics() {
    type Plain = GouraudDepth<Rgb565>;
    type Clear = Composited<Plain>;
    static GOURAUD: Mutex<Arenas<Plain>> = Mutex::new(Arenas::new());
    static FLAT: Mutex<Arenas<FlatDepth<Rgb565>>> = Mutex::new(Arenas::new());
    static CLEAR: Mutex<Arenas<Clear>> = Mutex::new(Arenas::new());
    assert!(GOURAUD.lock().unwrap().draws());
    assert!(FLAT.lock().unwrap().draws());
    assert!(CLEAR.lock().unwrap().draws());
}
