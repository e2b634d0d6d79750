//! All tests across the crates, in one binary so that they link once.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod borders;
mod broken_techniques;
mod child;
mod commands;
mod compare_strokes;
mod corpus;
#[cfg(feature = "gpu")]
mod display;
#[cfg(feature = "gpu")]
mod drop_file;
#[cfg(feature = "gpu")]
mod easel;
mod examples;
mod expectations;
mod field_cases;
#[cfg(feature = "gpu")]
mod gpu_detectors;
#[cfg(feature = "gpu")]
mod gpu_device;
#[cfg(feature = "gpu")]
mod gpu_edges;
#[cfg(feature = "gpu")]
mod gpu_glass;
#[cfg(feature = "gpu")]
mod gpu_graph;
#[cfg(feature = "gpu")]
mod gpu_instances;
#[cfg(feature = "gpu")]
mod gpu_joins;
#[cfg(feature = "gpu")]
mod gpu_layouts;
#[cfg(feature = "gpu")]
mod gpu_lines;
#[cfg(feature = "gpu")]
mod gpu_real_window;
#[cfg(feature = "gpu")]
mod gpu_render;
#[cfg(feature = "gpu")]
mod gpu_scenes;
#[cfg(feature = "gpu")]
mod gpu_techniques;
#[cfg(feature = "gpu")]
mod gpu_tiles;
#[cfg(feature = "gpu")]
mod gpu_twin;
#[cfg(feature = "gpu")]
mod gpu_visibility;
#[cfg(feature = "gpu")]
mod gpu_window;
mod hostile;
mod instances;
mod layer_chains;
mod layouts;
mod models;
mod noop;
mod own_models;
mod packages;
mod preprocess_commands;
#[cfg(feature = "gpu")]
mod random;
mod render_command;
mod round_trips;
mod shaders;
mod technique_commands;
mod window_panels;
mod writing;
