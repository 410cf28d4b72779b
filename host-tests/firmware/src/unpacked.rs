//! The baked teapot's own tables, unpacked beforehand, as meshes for immediate calls.

use scanbeam::list::{
    FieldForm, Header, Instruction, Layout, State, Strip, VertexFormat, read_block,
};
use scanbeam::{Affine, Draw, Faces, Light, Mesh};
use scenes::teapot_list;

/// Tables that the list may have.
const TABLES: usize = 16;

/// A table, unpacked: its places where they lie, its normals and faces by number.
#[derive(Clone, Copy, Default)]
struct Part {
    positions: &'static [[i16; 3]],
    normals: usize,
    faces: (usize, usize),
}

const NOTHING: Mesh<'static> = Mesh {
    positions: &[],
    normals: &[],
    colours: &[],
    faces: Faces::Triangles(&[]),
};

/// The list's tables as meshes.
pub(crate) struct Unpacked {
    parts: [Part; TABLES],
    /// What is said of all of them; its mesh is empty.
    pub(crate) call: Draw<'static, 'static>,
    normals: &'static mut [[i16; 3]],
    faces: &'static mut [[u16; 3]],
}

impl Unpacked {
    /// Unpacks the list.
    pub(crate) fn new(normals: &'static mut [[i16; 3]], faces: &'static mut [[u16; 3]]) -> Self {
        let list = teapot_list().expect("it is aligned");
        let mut all = Self {
            parts: [Part::default(); TABLES],
            call: Draw {
                light: Light::new([0.3, 0.8, 0.6], 0.2),
                ..Draw::new(NOTHING)
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
                Instruction::State(State::Material(m)) => all.call.colour = m.diffuse,
                Instruction::State(State::Matrix(m)) => {
                    all.call.model = Affine::from(&m).then(&Affine::rotation_y(0.6));
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
                    slot.column(list, run.at, out, FieldForm::normal);
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
                            if run.header.low & Header::SEPARATE != 0 {
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

    /// Its tables as meshes.
    pub(crate) fn meshes(&self) -> impl Iterator<Item = Mesh<'_>> {
        let tables = self.parts.iter().filter(|part| !part.positions.is_empty());
        tables.map(|part| Mesh {
            positions: part.positions,
            normals: &self.normals[part.normals..part.normals + part.positions.len()],
            colours: &[],
            faces: Faces::Triangles(&self.faces[part.faces.0..part.faces.1]),
        })
    }
}
