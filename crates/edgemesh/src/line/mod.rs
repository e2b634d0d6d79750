//! Lines: their classes, the shapes drawn along them, and where these lie.

mod class;
mod kind;
mod placement;

pub use self::class::{ClassTable, LineClass, MAX_LINE_CLASSES, NO_LAYER};
pub use self::kind::{CAP_VERTICES, DISK_STEPS, DISK_VERTICES, LineKind};
pub use self::placement::{Parameterization, Placement};
