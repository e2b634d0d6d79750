//! Helpers of the tests across the crates.
//!
//! - [`locate`]: the tests' own data, the programs under test, the shared files.
//! - [`compare`]: golden images.
//! - [`wgsl_fn`]: runs a shader function over data, for comparison with its Rust twin.
//!
//! The tests are one binary, `tests/all/`.

pub mod compare;
pub mod locate;
pub mod wgsl_fn;
