//! Properties of every mesh, tested on random ones.
//!
//! - `edges`: each edge once, counted again by plain maps; Euler's formula;
//!   order and winding do not matter.
//! - `linked`: chains, fans, welding, frames, threads.
//! - `files`: written files are read back.
//! - `views`: contours and creases under flips, scales and the paper's Equation 1.
//! - `instances`: meshes in several places, copied, stored and exported.
//! - `exports`: exported files give back their edge mesh.
//! - `readers`: the same polygons and materials as two other OBJ parsers.
//! - `readers_ply_stl`: the same polygons as other PLY and STL parsers; sound, broken and cut
//!   files.
//! - `readers_field`: files that people reported in other projects.
//! - `readers_gltf`: sound and broken glTF files of other projects.
//!
//! `PROPTEST_CASES` (256 for the usual count) makes runs longer,
//! `PROPTEST_RNG_SEED` gives other cases.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod edges;
mod exports;
mod files;
mod gltf_edges;
mod instances;
mod linked;
mod meshes;
mod readers;
mod readers_field;
mod readers_gltf;
mod readers_ply_stl;
mod rigs;
mod views;

use proptest::test_runner::{Config, RngSeed};

/// `cases` cases, and the same ones in every run unless the environment asks
/// for others.
fn config(cases: u32) -> Config {
    let asked = Config::default();
    let rng_seed = match asked.rng_seed {
        RngSeed::Random => RngSeed::Fixed(2004),
        fixed @ RngSeed::Fixed(_) => fixed,
    };
    Config { cases: cases * asked.cases / 256, rng_seed, failure_persistence: None, ..asked }
}
