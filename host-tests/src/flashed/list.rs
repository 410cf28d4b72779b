//! A list as words of a scene.

use crate::draw::camera_words;
use crate::reference::View;
use scanbeam::list::{Flow, Instruction, State, Texture, VertexFormat, read_block};
use scene_flash::{Head, Kind, List, ListRoom, Room};

/// Vertices and indices that a player has at least.
const LEAST: u32 = 64;
/// Blocks, vertices and jumps that a list may have, as `run-list` grants them when nothing is said.
const BUDGET: u32 = 1 << 24;

/// The words of a list, which is seen as `run-list` does when nothing is said.
pub fn words(list: &[u32]) -> Vec<u32> {
    let view = View::default();
    let (room, is_textured) = room(list);
    let written = List { room, words: list }.to_words();
    let head = Head {
        kind: match is_textured {
            true => Kind::ListTextured,
            false => Kind::ListSmooth,
        },
        size: [view.width as u16, view.height as u16],
        doubled: false,
        background: view.background,
        room: Room::default(),
        camera: camera_words(&view),
    };
    let length = Head::WORDS + written.len() + list.len();
    [&head.to_words(length as u32)[..], &written, list].concat()
}

/// What its player may need, by its blocks as they lie, and whether it has textures. It may jump past these: then it is
/// for the player to say what it lacks.
fn room(list: &[u32]) -> (ListRoom, bool) {
    let mut room = ListRoom {
        table: LEAST,
        indices: LEAST,
        budget: BUDGET,
        ..ListRoom::default()
    };
    let mut format = VertexFormat::default();
    // Indices of the table so far.
    let (mut at, mut of_table) = (0, 0);
    while let Ok(block) = read_block(list, at, &format) {
        match block.instruction {
            Instruction::State(State::Format(new)) => format = new,
            Instruction::Table(run) => {
                room.table = room.table.max(run.header.count.into());
                of_table = 0;
            }
            Instruction::Indexed(run) => {
                of_table += 3 * u32::from(run.header.count);
                room.indices = room.indices.max(of_table);
            }
            Instruction::State(State::Texture(texture)) => add(&mut room, &texture),
            Instruction::State(State::Palette(_)) | Instruction::Flow(Flow::LoadTexture { .. }) => {
                room.names += 1;
            }
            _ => {}
        }
        at += block.words;
        if at as usize >= list.len() {
            break;
        }
    }
    (room, room.textures > 0)
}

/// Room for a texture without a mask.
fn add(room: &mut ListRoom, texture: &Texture) {
    let sides = u32::from(texture.log_width) + u32::from(texture.log_height);
    room.names += 1;
    room.textures += 1;
    room.levels += u32::from(texture.levels.saturating_sub(1));
    room.texels += match texture.form.is_indexed() {
        true => 256,
        // Levels below the first have a third of its texels.
        false => (1 << sides.min(20)) * 3 / 2,
    };
}
