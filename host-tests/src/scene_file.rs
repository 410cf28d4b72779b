//! A scene as a file, as the flags of the tool are held against it.

pub use host_draw::scene_file::*;
