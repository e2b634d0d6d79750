//! Lines: their classes, what is drawn along them, and where it lies.
//!
//! - [`class`]: contours, creases and the others, and which of them a drawing has.
//! - [`kind`]: thin lines, quads with their ends, fins.
//! - [`placement`]: inside, outside or centred, and how a brush lies along a stroke.

pub mod class;
pub mod kind;
pub mod placement;
