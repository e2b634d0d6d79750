//! Checks files against the rules of their formats.
//!
//! A reader accepts a file that it can draw. The checks here warn of rules that the
//! file breaks nevertheless, because other programs may refuse it.

pub(crate) mod gltf;
