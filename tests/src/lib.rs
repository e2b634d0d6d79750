//! What the tests across the crates share.
//!
//! - [`locate`]: the tests' own data, the programs under test, the shared files.
//! - [`compare`]: golden images, held to two numbers.
//! - [`wgsl_fn`]: a shader function over data, to hold it to its Rust twin.
//!
//! The tests themselves are one binary, `tests/all/`.

pub mod compare;
pub mod locate;
pub mod wgsl_fn;
