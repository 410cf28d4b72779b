//! What memory a firmware takes, by the sections of its ELF.

use super::{FirmwareError, io_error};
use object::{Object, ObjectSection};
use std::fs;
use std::path::Path;

/// Where a section of the ELF lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Section {
    /// First address at run time.
    pub address: u64,
    /// Length in bytes.
    pub bytes: u64,
}

/// The sections of a firmware that take memory; one that is absent is empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    /// `.text`: code of the whole firmware, with its console and panic messages' formatting.
    pub text: Section,
    /// `.rodata`: constants, models and tables.
    pub rodata: Section,
    /// `.data`: variables with an initial value, in RAM and in flash.
    pub data: Section,
    /// `.bss`: variables that start as zero.
    pub bss: Section,
    /// `.fast`: tightly coupled RAM.
    pub fast: Section,
    /// `.dma`: RAM that a DMA can reach.
    pub dma: Section,
    /// `.slow`: external RAM.
    pub slow: Section,
}

impl Sections {
    /// Reads them from an ELF.
    ///
    /// # Errors
    ///
    /// [`FirmwareError::Io`] or [`FirmwareError::Elf`].
    pub fn read(path: &Path) -> Result<Self, FirmwareError> {
        let bytes = fs::read(path).map_err(io_error(path.display().to_string()))?;
        let elf = object::File::parse(&*bytes).map_err(|source| FirmwareError::Elf {
            path: path.to_owned(),
            source,
        })?;
        let find = |name| {
            elf.section_by_name(name)
                .map_or(Section::default(), |section| Section {
                    address: section.address(),
                    bytes: section.size(),
                })
        };
        Ok(Self {
            text: find(".text"),
            rodata: find(".rodata"),
            data: find(".data"),
            bss: find(".bss"),
            fast: find(".fast"),
            dma: find(".dma"),
            slow: find(".slow"),
        })
    }

    /// Bytes of code.
    pub fn text_bytes(&self) -> u64 {
        self.text.bytes
    }

    /// Bytes of on-chip RAM that the firmware holds all the time: all but [`slow`](Self::slow) and
    /// the stack, whose peak the firmware prints as the figure `stack_bytes`.
    pub fn ram_bytes(&self) -> u64 {
        self.data.bytes + self.bss.bytes + self.fast.bytes + self.dma.bytes
    }

    /// Bytes of external RAM.
    pub fn slow_bytes(&self) -> u64 {
        self.slow.bytes
    }
}
