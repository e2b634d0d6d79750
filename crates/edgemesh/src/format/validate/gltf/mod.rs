//! Rules of glTF that a file may break and still be drawn.
//!
//! Based on: glTF 2.0, sections 3 and 5 (properties). A test of the reader compares with
//! the Khronos validator.
//!
//! Most rules are rows of a table ([`rules`]): a pattern of places in the JSON
//! ([`pattern`]), and what must hold there. Some compare several values
//! ([`relations`]); those for extensions look at the whole file ([`extensions`]).

mod check;
mod extensions;
mod pattern;
mod relations;
mod rules;

pub(crate) use check::check;
