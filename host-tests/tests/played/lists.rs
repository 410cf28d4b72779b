//! Lists of the player's tests: what stands between a triangle and the end.

use crate::listing::triangle;
use host_tests::lists::writer::{FieldPacker, ListWriter};
use scanbeam::list::{FieldForm, Flow, Header, Id, Material, State, TexelForm, Texture};

/// A triangle, then what `write` writes, then the end; the byte offset of what comes last before it.
pub fn after_a_triangle(write: impl FnOnce(&mut ListWriter<'_>) -> u32) -> (Vec<u32>, u32) {
    let mut memory = vec![0; 4096];
    let first = triangle(1);
    memory[..first.len()].copy_from_slice(&first);
    let mut writer = ListWriter::new(&mut memory[first.len()..]);
    let at = write(&mut writer);
    writer.flow(Flow::End).unwrap();
    let len = first.len() + writer.words().len();
    memory.truncate(len);
    (memory, 4 * (first.len() as u32 + at))
}

/// Texture 1, of 4 x 4 texels.
pub fn texture(form: TexelForm, levels: u8) -> Texture {
    Texture {
        number: 1,
        log_width: 2,
        log_height: 2,
        form,
        levels,
        palette: 2,
        clamped: false,
        at: 0,
    }
}

/// A material with texture 1, and a triangle that has texture places, in the default format.
pub fn draw_textured(writer: &mut ListWriter<'_>) -> u32 {
    let material = Material {
        texture: Some(1),
        two_sided: true,
        ..Material::default()
    };
    writer.state(&State::Material(material)).unwrap();
    let at = writer.position();
    let header = Header {
        text: true,
        new: true,
        ..Header::of(Id::Short, 3)
    };
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for [x, y] in [[-9000, -9000], [9000, -9000], [0, 9000]] {
        packer.field(FieldForm::S16x3, [x, y, 0, 0]);
        packer.align();
        packer.field(FieldForm::U16x2, [x + 9000, y + 9000, 0, 0]);
        packer.align();
    }
    writer.vertices(header, &words).unwrap();
    at
}
