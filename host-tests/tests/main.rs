//! All proofs of the host tools as one program: what they draw with is compiled once and linked
//! once, and all threads are busy until the last proof. As fifty programs they took nearly twice as
//! long to build.
//!
//! A proof is a file here and its line below; `rows.rs` refuses a file that has none. One of them
//! alone: `cargo test -p host-tests --test proofs cache::`. None needs a process of its own: none
//! sets what a process has once (its environment, folder, allocator or hook of panics), and those
//! that try the command line tool start it.

// What proofs share.
mod common;
mod glass;
mod hot;
mod listing;
mod played;
mod shadow_world;

mod against_reference;
mod arenas;
mod by_calls;
mod by_calls_parts;
mod cache;
mod command_line;
mod defmt_log;
mod demo;
mod depth_methods;
mod effects;
mod findings;
mod findings_textures;
mod flashed;
mod formats;
mod frame_events;
mod frames;
mod fuzz;
mod gltf_files;
mod golden;
mod hot_path_alpha;
mod hot_path_colours;
mod hot_path_compressed;
mod hot_path_computed;
mod hot_path_counts;
mod hot_path_cover;
mod hot_path_depth;
mod hot_path_dither;
mod hot_path_errors;
mod hot_path_fetching;
mod hot_path_frames;
mod hot_path_ground;
mod hot_path_master;
mod hot_path_paced;
mod hot_path_palette;
mod hot_path_phong;
mod hot_path_reflection;
mod hot_path_sampling;
mod hot_path_shader;
mod hot_path_shading;
mod hot_path_shadows;
mod hot_path_shared;
mod hot_path_texels;
mod hot_path_values;
mod hot_path_volumes;
mod hot_path_wide;
mod input;
mod lines_alone;
mod list_bake;
mod list_bake_textures;
mod list_fuzz;
mod list_values;
mod list_words;
mod meshlets;
mod model_clusters;
mod model_pipe;
mod model_scenes;
mod model_tokens;
mod model_trace;
mod one_way;
mod output;
mod pairs;
mod places;
mod player;
mod player_alpha;
mod player_cones;
mod player_flow;
mod player_fuzz;
mod player_lights;
mod player_overlays;
mod player_paced;
mod player_palette;
mod player_places;
mod player_refused;
mod player_screen;
mod player_shadows;
mod player_strips;
mod player_tables;
mod player_textures;
mod player_told;
mod priority;
mod rows;
mod scan_out;
mod scan_out_continuous;
mod scan_out_doubled;
mod scan_out_faults;
mod scan_out_runs;
mod scan_out_spi;
mod scene_b;
mod scene_files;
mod scene_files_forms;
mod scene_files_light;
mod scene_files_texels;
mod skipped;
mod stress_input;
mod stress_near;
mod stress_shapes;
mod support;
mod survivors;
mod texture_cli;
mod texture_levels;
mod texture_truth;
mod told;
mod tool;
mod view;
#[cfg(target_os = "linux")]
mod view_terminal;
mod watertight;
mod written;
