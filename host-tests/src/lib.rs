//! Host side of scanbeam.

// First: its macros are everybody's.
#[macro_use]
pub mod stdio;

pub mod accuracy;
pub mod args;
pub mod bench;
pub mod boards;
pub mod budgets;
pub mod cache_report;
pub mod crew;
pub mod demo;
pub mod draw;
pub mod effect_frames;
pub mod figures;
pub mod firmware;
pub mod firmware_report;
pub mod golden;
pub mod image_out;
mod lean_frames;
pub mod lent;
pub mod lists;
pub mod memory_model;
pub mod method_frames;
pub mod mock;
pub mod model;
pub mod places;
pub mod plot;
pub mod preset_sizes;
pub mod profile_report;
pub mod reference;
pub mod report;
pub mod scene_file;
pub mod texture_file;
pub mod texture_report;
pub mod trace;
pub mod view;
