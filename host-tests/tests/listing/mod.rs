//! What tests of lists share: clouds of vertices in every form.

use crate::common::Rng;
use host_tests::lists::writer::{FieldPacker, ListWriter};
use host_tests::model::{Model, ModelVertex};
use scanbeam::list::{
    Budget, Field, FieldForm, Header, Id, Instruction, Matrix, State, VertexFormat, read_block,
};
use scanbeam::{Affine, Faces, Mesh};
use std::sync::atomic::AtomicU32;

pub const PLENTY: Budget = Budget {
    instructions: 1 << 20,
    vertices: 1 << 24,
    jumps: 1 << 10,
};

/// The blocks of a list: where each begins, and what it says.
pub fn blocks(list: &[u32]) -> Vec<(usize, Instruction)> {
    let (mut at, mut format, mut all) = (0, VertexFormat::default(), Vec::new());
    while at < list.len() {
        let parsed = read_block(list, at as u32, &format).unwrap();
        if let Instruction::State(State::Format(new)) = parsed.instruction {
            format = new;
        }
        all.push((at, parsed.instruction));
        at += parsed.words as usize;
    }
    all
}

/// A mesh as a model of one colour.
pub fn model_of(mesh: Mesh<'_>, colour: [f64; 3]) -> Model {
    let Faces::Triangles(faces) = mesh.faces else {
        panic!("it has triangles");
    };
    let real = |v: [i16; 3]| v.map(|c| f64::from(c) / 16_384.0);
    let pairs = mesh.positions.iter().zip(mesh.normals);
    Model {
        vertices: pairs
            .map(|(p, n)| ModelVertex {
                position: real(*p),
                normal: real(*n),
                colour,
                uv: [0.0; 2],
            })
            .collect(),
        triangles: faces.iter().map(|f| f.map(u32::from)).collect(),
        triangle_materials: vec![None; faces.len()],
        ..Model::default()
    }
}

/// Memory of a ring of so many words.
pub fn ring_memory(words: u32) -> Vec<AtomicU32> {
    (0..words).map(|_| AtomicU32::new(0)).collect()
}

/// Vertices whose numbers every form of a format can hold.
pub struct Cloud {
    pub positions: Vec<[i16; 3]>,
    pub normals: Vec<[i16; 3]>,
    pub colours: Vec<[u8; 3]>,
}

impl Cloud {
    pub fn random(rng: &mut Rng, count: usize, place: FieldForm, normal: FieldForm) -> Self {
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
            let full = |v: i32, unit: f64| {
                let real = f64::from(v) * (1.0 + 1.0 / unit) / unit;
                (real * 16_384.0).floor() as i16
            };
            cloud.normals.push(match normal {
                FieldForm::S8x3 => n.map(|v| (v * 129) as i16),
                FieldForm::S10x3 => [full(n[0], 1024.0), full(n[1], 1024.0), full(n[2], 512.0)],
                _ => n.map(|v| v as i16),
            });
            cloud.colours.push([0; 3].map(|_: u8| rng.below(256) as u8));
        }
        cloud
    }

    /// The fields again.
    pub fn place_fields(&self, i: usize, form: FieldForm) -> [i32; 4] {
        let [x, y, z] = self.positions[i].map(i32::from);
        match form {
            FieldForm::S8x3 => [x >> 7, y >> 7, z >> 7, 0],
            FieldForm::S10x3 => [x >> 4, y >> 4, z >> 5, 0],
            FieldForm::S32x3 => [x << 16, y << 16, z << 16, 0],
            _ => [x, y, z, 0],
        }
    }

    pub fn normal_fields(&self, i: usize, form: FieldForm) -> [i32; 4] {
        let [x, y, z] = self.normals[i].map(i32::from);
        let back =
            |v: i32, most: i32| ((f64::from(v) + 0.5) / 16_384.0 * f64::from(most)).round() as i32;
        match form {
            FieldForm::S8x3 => [x / 129, y / 129, z / 129, 0],
            FieldForm::S10x3 => [back(x, 1023), back(y, 1023), back(z, 511), 0],
            _ => [x, y, z, 0],
        }
    }

    pub fn field(&self, field: Field, i: usize) -> [i32; 4] {
        match field.parameter {
            Field::PLACE => self.place_fields(i, field.form),
            Field::NORMAL => self.normal_fields(i, field.form),
            Field::DIFFUSE => {
                let [r, g, b] = self.colours[i].map(i32::from);
                [r, g, b, 255]
            }
            // What this reader does not know is passed over.
            _ => [i as i32, -1, 7, 1 << 20],
        }
    }

    /// The words of some vertices, one after the other.
    pub fn vertices(&self, format: &VertexFormat, header: Header, order: &[u16]) -> Vec<u32> {
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
    pub fn columns(&self, format: &VertexFormat, header: Header) -> Vec<u32> {
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

    /// As a mesh has them, without faces; without colours and normals where the header has none.
    pub fn plain(&self, shade: bool, format: &VertexFormat) -> Mesh<'_> {
        let has = |p| shade && format.fields().iter().any(|f| f.parameter == p);
        Mesh {
            positions: &self.positions,
            normals: if has(Field::NORMAL) {
                &self.normals[..]
            } else {
                &[]
            },
            colours: if has(Field::DIFFUSE) {
                &self.colours[..]
            } else {
                &[]
            },
            faces: Faces::Triangles(&[]),
        }
    }
}

/// Triangles of a strip or fan, by the definition: each from its corners' places in the strip.
pub fn unrolled(order: &[u16], fan: bool) -> Vec<[u16; 3]> {
    (2..order.len())
        .map(|k| match (fan, k % 2) {
            (true, _) => [order[0], order[k - 1], order[k]],
            (false, 0) => [order[k - 2], order[k - 1], order[k]],
            (false, _) => [order[k - 1], order[k - 2], order[k]],
        })
        .collect()
}

/// A strip or fan in blocks of random lengths, each going on with the one before, of none too: what
/// is given each, and whether it is the first.
pub fn in_blocks(rng: &mut Rng, order: &[u16], mut block: impl FnMut(&[u16], bool)) {
    let (mut rest, mut new) = (order, true);
    while new || !rest.is_empty() {
        let (part, left) = rest.split_at(rng.below(rest.len() as u32 + 1) as usize);
        block(part, new);
        (rest, new) = (left, false);
    }
}

pub fn some_format(rng: &mut Rng) -> (VertexFormat, FieldForm, FieldForm) {
    let place = rng.pick(&[FieldForm::S16x3, FieldForm::S10x3, FieldForm::S8x3]);
    let normal = rng.pick(&[FieldForm::S16x3, FieldForm::S10x3, FieldForm::S8x3]);
    let mut fields = vec![Field {
        parameter: Field::PLACE,
        form: place,
    }];
    if rng.below(3) > 0 {
        fields.push(Field {
            parameter: Field::NORMAL,
            form: normal,
        });
    }
    if rng.below(3) > 0 {
        fields.push(Field {
            parameter: Field::DIFFUSE,
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

/// A block that draws one triangle at a place of its own.
pub fn triangle(i: u32) -> Vec<u32> {
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
