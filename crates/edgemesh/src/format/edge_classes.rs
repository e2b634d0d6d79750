//! How an export says that it lists the classes of its edges.

/// A comment or member of exports in which each hard edge has its classes, and no other edge has
/// any. The number changes with the lists.
pub(super) const STATES_CLASSES: &str = "Edgemesh edge classes 1";

/// What the name of the generator of a glTF file begins with.
pub(super) const GENERATOR: &str = "Edgemesh ";
