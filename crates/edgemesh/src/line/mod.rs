//! Lines: their classes, what is drawn along them, and where it lies.
//!
//! - [`class`]: contours, creases and the others, and which of them a drawing has.
//! - [`kind`]: thin lines, quads with their ends, fins.
//! - [`placement`]: inside, outside or centred, and how a brush lies along a stroke.

mod class;
mod kind;
mod placement;

pub use self::class::{ClassTable, LineClass, MAX_LINE_CLASSES, NO_LAYER};
pub use self::kind::{CAP_VERTICES, DISK_STEPS, DISK_VERTICES, LineKind};
pub use self::placement::{Parameterization, Placement};
