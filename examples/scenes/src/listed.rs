//! Baked lists, run from flash: the teapot, and a crate with its textures (H7, H11).

use scanbeam::include_list;
use scanbeam::list::{ListError, words_of};

/// Vertices of the list's largest table, which its HEAD says.
pub const LIST_TABLE: usize = 255;
/// Indices that are drawn together: those of a table's triangles.
pub const LIST_INDICES: usize = 1536;

/// Vertices of the crate's largest table.
pub const CRATE_TABLE: usize = 16;
/// Indices of the crate that are drawn together.
pub const CRATE_INDICES: usize = 48;
/// The list, as it lies in flash.
///
/// # Errors
/// None: it is aligned.
pub fn teapot_list() -> Result<&'static [u32], ListError> {
    words_of(include_list!(concat!(env!("OUT_DIR"), "/teapot.list")))
}

/// The teapot in parts, as it lies in flash.
///
/// # Errors
/// None: it is aligned.
pub fn teapot_meshlets_list() -> Result<&'static [u32], ListError> {
    words_of(include_list!(concat!(
        env!("OUT_DIR"),
        "/teapot_meshlets.list"
    )))
}

/// The crate, as it lies in flash.
///
/// # Errors
/// None: it is aligned.
pub fn crate_list() -> Result<&'static [u32], ListError> {
    words_of(include_list!(concat!(env!("OUT_DIR"), "/crate.list")))
}
