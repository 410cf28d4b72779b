//! What the tool and the tests stand on: models and pictures from files and to files, the mocked frame buffer, the
//! memory that is lent, pictures of scenes, the reference in f64, and what is said on standard output.

// First: its macros are everybody's.
#[macro_use]
pub mod stdio;

pub mod apart;
pub mod compress;
pub mod image_out;
pub mod mock;
pub mod model;
pub mod reference;
pub mod rooms;
pub mod staged;
pub mod texture_file;
