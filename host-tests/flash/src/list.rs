//! A list behind the head: [`ListRoom`], 7 words; how many words the list has; the list.

use crate::reader::{FlashError, Reader};
use scanbeam::event::Notice;
use scanbeam::input::{Player, PlayerSettings, RunCounts};
use scanbeam::list::{Budget, Halt, ListCommand, ListError};
use scanbeam::look::Look;
use scanbeam::scene::{BeginError, Draw, Scene};
use scanbeam::{Camera, Cull};

/// What a player is lent for a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ListRoom {
    /// Vertices of a table.
    pub table: u32,
    /// Indices that are drawn together.
    pub indices: u32,
    /// Numbers of textures and palettes.
    pub names: u32,
    /// Textures.
    pub textures: u32,
    /// Words of their texels and palettes.
    pub texels: u32,
    /// Levels of detail below the first.
    pub levels: u32,
    /// Blocks, vertices and jumps that it may have.
    pub budget: u32,
}

/// A list, and how it begins.
#[derive(Clone, Copy, Debug)]
pub struct List<'t> {
    /// What its player is lent.
    pub room: ListRoom,
    /// Its words.
    pub words: &'t [u32],
}

/// Why a list was not played whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlayError {
    /// The scene was not begun.
    Begin(BeginError),
    /// The list was refused.
    List(ListError),
    /// It halted before its end: at this word.
    Halted(Halt, u32),
    /// So many triangles found no room.
    Full(u32),
}

impl<'t> List<'t> {
    /// Of what is behind the head.
    ///
    /// # Errors
    /// When it ends too early.
    pub fn read(reader: &mut Reader<'t>) -> Result<Self, FlashError> {
        let [table, indices, names, textures, texels, levels, budget] = reader.array()?;
        let count = reader.word()? as usize;
        Ok(Self {
            room: ListRoom {
                table,
                indices,
                names,
                textures,
                texels,
                levels,
                budget,
            },
            words: reader.table(count)?,
        })
    }

    /// The words in front of those of the list, and how many they are.
    #[must_use]
    pub fn to_words(&self) -> [u32; 8] {
        let r = &self.room;
        [
            r.table,
            r.indices,
            r.names,
            r.textures,
            r.texels,
            r.levels,
            r.budget,
            self.words.len() as u32,
        ]
    }

    /// How it begins: as `run-list` does when nothing is said, not lit.
    #[must_use]
    pub fn settings<'m>(&self) -> PlayerSettings<'m, 't> {
        let settings = PlayerSettings::default();
        PlayerSettings {
            draw: Draw {
                cull: Cull::None,
                ..settings.draw
            },
            camera: true,
            ..settings
        }
    }

    /// Begins `scene` and plays the list into it; pauses are passed over, for a picture has no later frame to wait for.
    ///
    /// # Errors
    /// When it is refused, does not come to its end, or the scene is too small.
    pub fn play<L: Look>(
        &self,
        player: &mut Player<'_, 't, L>,
        begin: ListCommand,
        camera: &Camera,
        scene: &mut Scene<'_, 't, L>,
    ) -> Result<RunCounts, PlayError> {
        self.play_heard(player, begin, camera, scene, |_| {})
    }

    /// The same; `hear` takes what the player tells.
    ///
    /// # Errors
    /// As [`play`](Self::play).
    pub fn play_heard<L: Look>(
        &self,
        player: &mut Player<'_, 't, L>,
        begin: ListCommand,
        camera: &Camera,
        scene: &mut Scene<'_, 't, L>,
        mut hear: impl FnMut(Notice),
    ) -> Result<RunCounts, PlayError> {
        scene.begin(camera).map_err(PlayError::Begin)?;
        player.command(begin);
        let mut budget = Budget::of(self.room.budget);
        loop {
            let ran = player.run(self.words, scene, &mut budget, &mut hear);
            match ran.map_err(PlayError::List)? {
                Halt::Sync => {}
                Halt::Paused => player.command(ListCommand::Resume),
                Halt::End => break,
                halt => return Err(PlayError::Halted(halt, player.position())),
            }
        }
        match player.counts() {
            counts if counts.dropped > 0 => Err(PlayError::Full(counts.dropped)),
            counts => Ok(counts),
        }
    }
}
