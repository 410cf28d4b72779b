//! What the blocks of a list say, counted as they lie, up to its end.

use super::tally::Meshes;
use scanbeam::list::{
    Field, Flow, Header, Instruction, LightWords, Material, State, VertexFormat, read_block,
};

/// What a list has in its blocks, each once.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Blocks {
    /// Vertices of its tables.
    pub meshes: Meshes,
    /// Those of the lit ones that one white light falls on.
    pub white: u32,
    /// What it has that has no costs on record.
    pub beyond: Option<&'static str>,
}

/// What is in force between blocks.
struct Walk {
    all: Blocks,
    format: VertexFormat,
    lights: [Option<LightWords>; 8],
    material: Material,
}

impl Blocks {
    /// Of a list, up to its end.
    #[must_use]
    pub fn of(list: &[u32]) -> Self {
        let mut walk = Walk {
            all: Self::default(),
            format: VertexFormat::default(),
            lights: [None; 8],
            material: Material::default(),
        };
        let mut at = 0;
        while (at as usize) < list.len() {
            let Ok(block) = read_block(list, at, &walk.format) else {
                // It is not played, or the list would be refused.
                walk.all.beyond = walk.all.beyond.or(Some("words between blocks"));
                break;
            };
            if block.instruction == Instruction::Flow(Flow::End) {
                break;
            }
            let found = walk.block(&block.instruction);
            walk.all.beyond = walk.all.beyond.or(found);
            at += block.words;
        }
        walk.all
    }
}

impl Walk {
    /// Counts a block; what of it is beyond.
    fn block(&mut self, block: &Instruction) -> Option<&'static str> {
        match block {
            Instruction::Table(run) => {
                self.table(run.header);
                None
            }
            Instruction::Indexed(_) | Instruction::Later => None,
            Instruction::Flow(Flow::Pause | Flow::Sync) => None,
            Instruction::Flow(Flow::Interrupt(_)) => Some("interrupts of lists"),
            Instruction::Flow(_) => Some("jumps of lists"),
            Instruction::State(state) => self.state(state),
            Instruction::Short(_) | Instruction::Quads(_) => Some("vertices without a table"),
            Instruction::Long(_) | Instruction::Points(_) => Some("vertices on the screen"),
            Instruction::Master(_) => Some("the master state"),
        }
    }

    fn table(&mut self, header: Header) {
        let count = u32::from(header.count);
        let has = |parameter| {
            let mut fields = self.format.fields_of(header);
            fields.any(|field| field.parameter == parameter)
        };
        let on = self.lights.iter().flatten().count() as u32;
        let is_lit = on > 0 && !self.material.unlit && has(Field::NORMAL);
        let meshes = &mut self.all.meshes;
        meshes.vertices += count;
        meshes.lit += if is_lit { count } else { 0 };
        meshes.lights = meshes.lights.max(on);
        let is_white = self.lights[0].is_some_and(|light| light.colour == [255; 3]) && on == 1;
        self.all.white += if is_lit && is_white { count } else { 0 };
    }

    fn state(&mut self, state: &State) -> Option<&'static str> {
        match state {
            State::Format(format) => self.format = *format,
            State::Light { number, light } => {
                *self.lights.get_mut(usize::from(*number))? = Some(*light)
            }
            State::LightOff { number } => *self.lights.get_mut(usize::from(*number))? = None,
            State::Material(material) => {
                self.material = *material;
                if material.specular != [0; 3] {
                    return Some("highlights");
                }
                if material.opacity < 255 {
                    return Some("blends");
                }
            }
            State::Texture(_) => return Some("textures of lists"),
            State::Window(_) => return Some("windows"),
            State::Overlay(_) => return Some("overlays"),
            State::Head(_)
            | State::PointSize(_)
            | State::Matrix(_)
            | State::Camera(_)
            | State::Palette(_)
            | State::Bounds(_)
            | State::Cone(_) => {}
        }
        None
    }
}
