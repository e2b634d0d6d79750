//! Builds a model from the nodes of a scene.
//!
//! ```text
//! file_walk --Document--> walk_v1 or walk_v2 --nodes--> shapes_v1 or shapes_v2
//!     ^                        |                            | solids, elevation_grid,
//!     '-------- inlined -------'                            | extrusion
//!                                                           v
//!            SceneBuilder with the Model <--face_writer-- FaceSet
//! ```

mod appearance;
mod elevation_grid;
mod extrusion;
mod face_set;
mod face_writer;
mod file_walk;
mod indices;
mod inline_request;
mod lines;
mod materials;
mod number_list;
mod placement;
mod scene_builder;
mod shapes_v1;
mod shapes_v2;
mod solids;
mod state_v1;
mod textures;
mod transforms;
mod traversal;
mod vertex_lists;
mod walk_v1;
mod walk_v2;

pub(super) use file_walk::build_model;
