//! Host side of scanbeam.

pub mod args;
pub mod demo;
pub mod draw;
pub mod firmware;
pub mod firmware_report;
pub mod image_out;
pub mod mock;
pub mod model;
pub mod reference;
pub mod trace;
