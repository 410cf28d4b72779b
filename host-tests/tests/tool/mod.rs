//! The parts of the command line tool, each by itself. They are here and not beside what they test, since a library with
//! unit tests is compiled twice.

mod accuracy;
mod args;
mod bench;
mod bench_boards;
mod bench_table;
mod boards;
mod boards_functions;
mod budgets;
mod budgets_source;
mod cache_report;
mod demo;
mod figures;
mod figures_gate;
mod figures_goals;
mod figures_growth;
mod figures_suite;
mod firmware;
mod firmware_output;
mod firmware_profile;
mod firmware_symbols;
mod flashed;
mod golden;
mod lists_strips;
mod lists_texels;
mod memory_model;
mod plan;
mod plot;
mod report;
mod scene_file;
mod sizes;
mod texture_report;
mod view_screen;
