//! `firmware SCENE.json`: what a scene costs on the boards, before there is any firmware of it.
//!
//! ```text
//! scene file -> draw calls in words -> drawn here ------------------> checksum, memory that it needs
//! list       -> the list in words              -> flash of the board -> checksum, instructions
//! ```
//! The words are drawn by the same calls here and there (`scene_flash`). What is drawn here of a scene file is held
//! against the picture of `render`, so that nothing of the file is left out.
//!
//! | file | there |
//! |---|---|
//! | `host.rs` | the words drawn here, and what memory they need |
//! | `list.rs` | a list as words |
//! | `blocks.rs` | what its blocks say, counted |
//! | `memory.rs` | bytes that it is lent |
//! | `shape.rs` | triangles by their sizes and textures |
//! | `tally.rs` | what a scene does on its lines, counted |
//! | `report.rs` | what was measured, as a table and as JSON |

pub mod blocks;
pub mod host;
pub mod list;
pub mod memory;
mod report;
pub mod shape;
pub mod tally;

use crate::args::{FirmwareArgs, PixelFormatArg, is_list};
use crate::draw::{self, CrewSettings, SceneParts};
use crate::firmware::profile::{Stepped, step_handed};
use crate::firmware::{
    self, Board, COMPARER, Handed, Measured, Output, Profile, Sections, Toolchain,
};
use crate::scene_file::{Format, Loaded};
use host::Shown;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scene_flash::{Counts, FLASH_AT, FLASH_BYTES, FlashError, Head, Kind};
use std::error::Error;
use std::path::Path;
use tempfile::TempDir;

/// A scene as the boards have it.
pub struct Flashed {
    /// Its words.
    pub words: Vec<u32>,
    /// What it shows here.
    pub shown: Shown,
    /// What is not as in the files.
    pub notes: Vec<String>,
}

/// Draws a scene on the boards that are asked for, and compares; `false` when a frame differs.
///
/// # Errors
/// When the scene cannot be read or drawn here, or is too large for the boards; when the firmware cannot be built or run.
pub fn run(file: &Path, args: &FirmwareArgs) -> Result<bool, Box<dyn Error>> {
    let flashed = Flashed::load(file)?;
    let toolchain = Toolchain::find()?;
    let boards = flashed.measure(&toolchain, &args.boards(), file)?;
    report::print(file, &flashed, &toolchain, &boards, args.json)?;
    crate::lists::heard::tell_all(file.display(), &flashed.shown.heard);
    for note in &flashed.notes {
        tell!("note: {note}");
    }
    Ok(boards.iter().all(|board| flashed.matches(board)))
}

impl Flashed {
    /// Reads a scene file or a list, and draws it here.
    ///
    /// # Errors
    /// When it cannot be read or drawn, or is too large for the boards.
    pub fn load(file: &Path) -> Result<Self, Box<dyn Error>> {
        match is_list(file) {
            true => Self::of_list(file),
            false => Self::of_scene(file, &Loaded::load(file)?),
        }
    }

    /// Draws a scene that was read from a file.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn of_scene(file: &Path, loaded: &Loaded) -> Result<Self, Box<dyn Error>> {
        let mut notes = loaded.notes();
        if loaded.scene.format == Format::Rgb888 {
            notes.push("boards are sent 16 bits a pixel: `format` is rgb565 there".into());
        }
        let flashed = Self::of_loaded(loaded, notes);
        flashed.map_err(|error| format!("{}: {error}", file.display()).into())
    }

    fn of_loaded(loaded: &Loaded, notes: Vec<String>) -> Result<Self, Box<dyn Error>> {
        let parts = SceneParts::new(loaded)?;
        let (mut words, objects) = draw::flash_words(&parts)?;
        fits_flash(&words)?;
        let shown = host::settle(&mut words, &objects)?;
        let format = loaded.scene.in_format(PixelFormatArg::Rgb565);
        let view = loaded.scene.view();
        let drawn = draw::draw_scene_file(&parts, &view, format, CrewSettings::default())?;
        is_as_rendered(&shown.pixels, drawn.frame.rgb())?;
        Ok(Self {
            words,
            shown,
            notes,
        })
    }

    fn of_list(file: &Path) -> Result<Self, Box<dyn Error>> {
        let mut words = list::words(&crate::lists::read_list(file)?);
        let shown = fits_flash(&words).and_then(|()| host::settle(&mut words, &[]));
        let shown = shown.map_err(|error| format!("{}: {error}", file.display()))?;
        Ok(Self {
            words,
            shown,
            notes: Vec::new(),
        })
    }

    /// Bytes of flash that its models and textures take.
    #[must_use]
    pub fn flash_bytes(&self) -> usize {
        size_of_val(&self.words[..])
    }

    /// Whether it is a list.
    #[must_use]
    pub fn is_list(&self) -> bool {
        matches!(self.shown.head.kind, Kind::ListSmooth | Kind::ListTextured)
    }

    /// Bytes of slow memory that it takes where the state of a draw call has so many; of a list at most so many.
    #[must_use]
    pub fn slow_bytes(&self, draw_bytes: usize) -> usize {
        let head = &self.shown.head;
        let beside = self.shown.slow_bytes - memory::slow_bytes(head, memory::DRAW_BYTES);
        memory::slow_bytes(head, draw_bytes) + beside
    }

    /// Bytes of fast memory that it takes beside the object cache.
    ///
    /// # Errors
    /// When its words are none of a scene.
    pub fn rest_of_fast_bytes(&self) -> Result<usize, FlashError> {
        let (head, mut reader) = Head::read(&self.words)?;
        let counts = match self.is_list() {
            true => None,
            false => Some(Counts::read(&mut reader)?),
        };
        Ok(memory::fast_bytes(&head, counts.as_ref()))
    }

    /// Whether a board drew what was drawn here.
    pub fn matches(&self, board: &Measured) -> bool {
        let frames = &board.output.frames;
        frames.iter().all(|frame| frame.crc == self.shown.crc()) && frames.len() == 1
    }

    /// Builds the firmware for boards and runs it with the scene in its flash.
    pub fn measure(
        &self,
        toolchain: &Toolchain,
        boards: &[Board],
        file: &Path,
    ) -> Result<Vec<Measured>, Box<dyn Error>> {
        let folder = self.laid()?;
        let built = firmware::build_all(toolchain, boards, Profile::Release, &[COMPARER], &[])?;
        let mut measured = Vec::new();
        for board in boards {
            let elf = built.join(board.target).join("release").join(COMPARER);
            let sections = Sections::read(&elf)?;
            self.fits(&sections, file)?;
            let handed = handed(&[COMPARER, "scene"], folder.path());
            let said = firmware::run_handed(board, &elf, &handed)?;
            measured.push(Measured {
                board: *board,
                sections,
                output: Output::parse(&said)?,
            });
        }
        Ok(measured)
    }

    /// Builds the firmware for a board and steps through a frame of the scene.
    pub fn step(
        &self,
        toolchain: &Toolchain,
        board: &Board,
        file: &Path,
    ) -> Result<Stepped, Box<dyn Error>> {
        let folder = self.laid()?;
        let elf = firmware::build(toolchain, board, Profile::Release, COMPARER, &[])?;
        self.fits(&Sections::read(&elf)?, file)?;
        let handed = handed(&[COMPARER, "scene", "profile"], folder.path());
        Ok(step_handed(board, elf, &handed)?)
    }

    /// A folder with its words in a file.
    fn laid(&self) -> std::io::Result<TempDir> {
        let folder = tempfile::tempdir()?;
        let bytes: Vec<u8> = self.words.iter().flat_map(|w| w.to_le_bytes()).collect();
        std::fs::write(folder.path().join(LAID), bytes)?;
        Ok(folder)
    }

    /// Whether there is slow memory for it, behind that of the firmware's own scenes, and its code ends before it.
    pub fn fits(&self, sections: &Sections, file: &Path) -> Result<(), String> {
        let code_end = sections.rodata.address + sections.rodata.bytes + sections.data.bytes;
        if code_end > u64::from(FLASH_AT) {
            return Err(format!("the firmware's code ends at {code_end:#x}"));
        }
        let slow = sections.slow;
        let left = host::SLOW_END.saturating_sub(slow.address + slow.bytes);
        let needed = self.shown.slow_bytes as u64;
        match needed > left {
            true => Err(too_large(needed, left)).map_err(|e| format!("{}: {e}", file.display())),
            false => Ok(()),
        }
    }
}

/// The file with a scene's words.
const LAID: &str = "scene.flash";

/// Words for the firmware, and a scene of a folder in its flash.
fn handed<'a>(words: &'a [&'a str], folder: &'a Path) -> Handed<'a> {
    Handed {
        words,
        folder,
        laid: Some((LAID, FLASH_AT)),
    }
}

/// Whether there is flash for so many words.
fn fits_flash(words: &[u32]) -> Result<(), Box<dyn Error>> {
    let bytes = size_of_val(words);
    match bytes > FLASH_BYTES {
        true => Err(format!(
            "needs {bytes} bytes of flash, the emulated boards have {FLASH_BYTES}"
        )
        .into()),
        false => Ok(()),
    }
}

/// Whether words of a panel show what `render` draws of the same file.
pub fn is_as_rendered(pixels: &[u16], rgb: &[u8]) -> Result<(), String> {
    let own = pixels.iter().copied().flat_map(Rgb565Be::to_rgb8);
    match own.zip(rgb).filter(|(a, b)| a != *b).count() {
        0 if 3 * pixels.len() == rgb.len() => Ok(()),
        differ => Err(format!(
            "boards would not draw what `render` draws: {differ} levels of pixels differ"
        )),
    }
}

/// What is refused.
fn too_large(needed: u64, have: u64) -> String {
    format!("needs {needed} bytes of slow memory, the emulated boards have {have}")
}
