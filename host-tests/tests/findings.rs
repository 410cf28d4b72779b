//! Promises that were once broken at the ends of their ranges, each held by what a caller sees.

use crate::hot::{self, SceneRooms};
use host_tests::rooms::{self, Room};
use scanbeam::frame::{FastMemory, Memory as Lent, Renderer};
use scanbeam::look;
use scanbeam::mesh::{I2F14, U1F15};
use scanbeam::pixel::{Rgb565, Rgb888};
use scanbeam::scan_out::{LineBuf, Pump, ScanError, ScanoutDma, ShownRuns, Window};
use scanbeam::scene::{
    self, Draw, DrawState, Memory, Object, Scene, ShadowEdge, ShadowLight, ShadowMemory, Vertex,
};
use scanbeam::{Affine, Camera, CameraError, Faces, Light, Link, Mesh, MeshError, Screen};
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
            let mut rooms = SceneRooms::new(3, 1, 8, 1);
            let mut scene = rooms.scene::<look::Gouraud<Rgb888>>(Screen::new(8, 8).unwrap());
            scene.begin(&camera(9.0, 0.1, 9.0).unwrap()).unwrap();
            let normals = [normal; 3];
            let lit = Mesh {
                normals: &normals,
                ..mesh(&positions, &[[0, 1, 2]])
            };
            let draw = Draw {
                light: Some(light),
                colour: [200, 100, 50],
                ..Draw::new(lit)
            };
            scene.draw(&draw).unwrap();
            let middle = hot::frame(&scene, 1, true, [0; 3])[4][4];
            assert_eq!(middle, [200, 100, 50], "{ambient}, {normal:?}");
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

impl ScanoutDma for Shortening {
    type Error = Infallible;
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
    let over = Some(ScanError::OutOfTurn { line: lines });
    assert_eq!(frame.line_done().err(), over);
    assert_eq!(frame.line().err(), over);
    assert_eq!(frame.finish().err(), over);
    assert!(!pump.sink().open, "the rectangle is closed");
    let narrow = Window { width: 5, ..window };
    pump.begin(narrow, 1).unwrap();
}

/// Memory of a scene and of a renderer as statics, as firmware puts it into sections.
struct Arenas {
    vertices: [Vertex; 8],
    objects: [Object; 8],
    bins: [u16; 8],
    draws: [DrawState<'static>; 1],
    fast: FastMemory<look::Gouraud<Rgb565>, 4>,
    depth: [u32; 8],
    links: [Link; 8],
}

/// Records are made at compile time.
#[test]
fn arenas_can_be_statics() {
    static ARENAS: Mutex<Arenas> = Mutex::new(Arenas {
        vertices: [Vertex::EMPTY; 8],
        objects: [Object::EMPTY; 8],
        bins: [0; 8],
        draws: [DrawState::EMPTY; 1],
        fast: FastMemory::new(),
        depth: [0; 8],
        links: [Link::EMPTY; 8],
    });
    let positions = [
        [-8192, -8192, -16_384],
        [8192, -8192, -16_384],
        [0, 8192, -16_384],
    ];
    let arenas = &mut *ARENAS.lock().unwrap();
    let memory = Memory {
        vertices: &mut arenas.vertices,
        places: &mut [],
        objects: &mut arenas.objects,
        bins: &mut arenas.bins,
        draws: &mut arenas.draws,
    };
    let mut scene = Scene::<look::Gouraud<Rgb565>>::new(Screen::new(8, 8).unwrap(), memory);
    scene.begin(&camera(9.0, 0.1, 9.0).unwrap()).unwrap();
    let faces = [[0, 1, 2]];
    scene.draw(&Draw::new(mesh(&positions, &faces))).unwrap();
    let memory = Lent {
        cache: &mut arenas.fast,
        links: &mut arenas.links,
        depth: &mut arenas.depth,
    };
    let mut out = [0; 8];
    Renderer::new(memory)
        .draw_line(&scene, 4, &mut out, 0)
        .unwrap();
    assert!(out[4] != 0 && out[0] == 0, "{out:?}");
}
