//! The functions of a firmware, by the symbols of its ELF.

use super::{FirmwareError, io_error};
use object::{Object, ObjectSymbol, SymbolKind};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its first instruction.
    pub address: u64,
    /// Bytes of its code, with the constants that stand behind it.
    pub bytes: u64,
    /// Its name as the source has it, without the compiler's hash.
    pub name: String,
}

/// All functions, by address.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Symbols(Vec<Symbol>);

impl Symbols {
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
        let functions = elf
            .symbols()
            .filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0)
            .filter_map(|symbol| {
                // Bit 0 of an address says that the code is Thumb.
                let address = symbol.address() & !1;
                Some((address, symbol.size(), symbol.name().ok()?))
            });
        Ok(Self::of(functions))
    }

    /// Of addresses, sizes and names as the linker has them. Of several names for one place the
    /// first is kept.
    pub fn of<'n>(functions: impl Iterator<Item = (u64, u64, &'n str)>) -> Self {
        let mut by_address = BTreeMap::new();
        for (address, bytes, name) in functions {
            by_address.entry(address).or_insert_with(|| Symbol {
                address,
                bytes,
                name: format!("{:#}", rustc_demangle::demangle(name)),
            });
        }
        Self(by_address.into_values().collect())
    }

    /// The function that an address lies in.
    #[must_use]
    pub fn at(&self, address: u64) -> Option<&Symbol> {
        let behind = self.0.partition_point(|symbol| symbol.address <= address);
        let symbol = self.0.get(behind.checked_sub(1)?)?;
        (address < symbol.address + symbol.bytes).then_some(symbol)
    }

    /// All functions, by address.
    pub fn iter(&self) -> impl Iterator<Item = &Symbol> {
        self.0.iter()
    }

    /// All functions, the largest first.
    #[must_use]
    pub fn by_size(&self) -> Vec<&Symbol> {
        let mut symbols: Vec<&Symbol> = self.0.iter().collect();
        symbols.sort_by(|a, b| b.bytes.cmp(&a.bytes).then(a.name.cmp(&b.name)));
        symbols
    }
}
