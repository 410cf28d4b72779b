//! What reading a list costs: pass one of the baked teapot, from the list and from its own tables
//! unpacked beforehand and drawn by immediate calls.

use crate::frames::Smooth;
use crate::rooms::{Rooms, RoomsOf};
use scanbeam::list::{Instruction, Layout, State, Strip, VertexFormat, normal, read_block};
use scanbeam::mesh::Vertices;
use scanbeam::{Affine, Camera, Instance, Light, Scene, SceneMemory};
use scenes::{Shot, build_listed, teapot_list};

/// Tables that the list may have.
const TABLES: usize = 16;

/// A table, unpacked: its places where they lie, its normals and faces by number.
#[derive(Clone, Copy, Default)]
struct Part {
    positions: &'static [[i16; 3]],
    normals: usize,
    faces: (usize, usize),
}

/// The list's tables as meshes.
pub(crate) struct Unpacked {
    parts: [Part; TABLES],
    instance: Instance,
    normals: &'static mut [[i16; 3]],
    faces: &'static mut [[u16; 3]],
}

fn scene(smooth: &mut RoomsOf<Smooth>) -> Scene<'_, Smooth> {
    Scene::new(
        Shot::screen(),
        SceneMemory {
            vertices: smooth.vertices,
            objects: smooth.objects,
            buckets: smooth.buckets,
        },
    )
}

/// From the list; the vertices that were transformed and the objects that were filed.
pub(crate) fn from_list(rooms: &mut Rooms) -> (u32, u32) {
    let mut scene = scene(&mut rooms.smooth);
    let counts = build_listed(&mut scene, rooms.list.memory());
    let counts = counts.expect("the rooms are large enough");
    (counts.vertices, scene.pass_one().objects)
}

impl Unpacked {
    /// Unpacks the list.
    pub(crate) fn new(normals: &'static mut [[i16; 3]], faces: &'static mut [[u16; 3]]) -> Self {
        let list = teapot_list().expect("it is aligned");
        let mut all = Self {
            parts: [Part::default(); TABLES],
            instance: Instance {
                light: Light::new([0.3, 0.8, 0.6], 0.2),
                ..Instance::default()
            },
            normals,
            faces,
        };
        let (mut at, mut tables, mut used, mut filed) = (0, 0, 0, 0);
        let mut format = VertexFormat::default();
        while (at as usize) < list.len() {
            let block = read_block(list, at, &format).expect("it is well-formed");
            at += block.words;
            match block.instruction {
                Instruction::State(State::Format(new)) => format = new,
                Instruction::State(State::Material(m)) => all.instance.colour = m.diffuse,
                Instruction::State(State::Matrix(m)) => {
                    all.instance.model = Affine::from(&m).then(&Affine::rotation_y(0.6));
                }
                Instruction::Table(run) => {
                    let layout = Layout::new(&format, run.header);
                    let count = run.header.count;
                    let slot = layout.normal.expect("it has normals");
                    let positions = layout.place.in_place(list, run.at, count);
                    all.parts[tables] = Part {
                        positions: positions.expect("its places are 3x16S"),
                        normals: used,
                        faces: (filed, filed),
                    };
                    let out = &mut all.normals[used..used + usize::from(count)];
                    slot.column(list, run.at, out, |f| normal(slot.form, f));
                    used += usize::from(count);
                    tables += 1;
                }
                Instruction::Indexed(run) => {
                    let mut strip = Strip::default();
                    for n in 0..u32::from(run.header.count) {
                        let index = list[(run.at + n / 4) as usize] >> (8 * (n % 4)) & 0xFF;
                        if index == 0xFF {
                            strip.restart();
                        } else if let Some(face) = strip.push(index as u16, run.header.rm) {
                            all.faces[filed] = face;
                            filed += 1;
                            if run.header.low & scanbeam::list::SEPARATE != 0 {
                                strip.restart();
                            }
                        }
                    }
                    all.parts[tables - 1].faces.1 = filed;
                }
                _ => {}
            }
        }
        all
    }

    /// By immediate calls; what [`from_list`] gives.
    pub(crate) fn draw(&self, rooms: &mut Rooms) -> (u32, u32) {
        let mut scene = scene(&mut rooms.smooth);
        let (eye, up) = ([0.0, 1.2, 2.6], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(eye, [0.0; 3], up, 300.0, 0.1, 100.0);
        scene
            .begin(&camera.expect("it sees"))
            .expect("a bucket for each line");
        let mut vertices = 0;
        for part in &self.parts {
            let count = part.positions.len();
            let mesh = Vertices {
                positions: part.positions,
                normals: &self.normals[part.normals..part.normals + count],
                colours: &[],
            };
            if count > 0 {
                vertices += count as u32;
                scene
                    .draw_indexed(
                        mesh,
                        &self.faces[part.faces.0..part.faces.1],
                        &self.instance,
                    )
                    .expect("the rooms are large enough");
            }
        }
        (vertices, scene.pass_one().objects)
    }
}
