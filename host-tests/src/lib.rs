//! Host side of scanbeam.

// For its macros, which are everybody's.
#[macro_use]
extern crate host_support;

pub use host_draw::{self as draw, choice, crew, places};
pub use host_frames as frames;
pub use host_support::{image_out, mock, model, reference, rooms, say, stdio, tell, texture_file};

pub mod accuracy;
pub mod args;
pub mod bench;
pub mod boards;
pub mod budgets;
pub mod cache_report;
pub mod compress;
pub mod demo;
pub mod figures;
pub mod firmware;
pub mod firmware_report;
pub mod flashed;
pub mod golden;
pub mod lists;
pub mod memory_model;
pub mod paced_report;
pub mod plan;
pub mod plot;
pub mod profile_report;
pub mod report;
pub mod scene_file;
pub mod sizes;
pub mod texture_report;
pub mod trace;
pub mod view;
