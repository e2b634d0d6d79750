//! Silhouettes by the stencil (paper, section 3.4).
//!
//! The fill of each object writes a distinct value where it is visible. Contours drawn once more
//! where the stencil has another value are those against anything else. A stencil has 255 values
//! besides that of no object, so it is cleared once in 255 objects, not for each.
//!
//! The paper fills and lines one model after the other. Lines leave no depth, so a later model
//! behind the lines of an earlier one covers them. Here all objects are filled first; those past
//! the first 254 write their values later, where the depth is theirs.
//!
//! A silhouette inside its edge, or centered on it, lies over its own object; its fragments
//! compare the values beside the edge (`stroke_over_surface.wgsl`).

/// The stencil value of no object, to which the stencil is cleared. WGSL twin: the constant of
/// this name.
pub const NO_OBJECT: u32 = 255;

/// Hands out stencil values.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StencilValues {
    last: u32,
}

impl StencilValues {
    /// The value of the next object, and whether the stencil must be cleared before it: steps 1
    /// and 2 of the paper's list.
    pub(crate) const fn next(&mut self) -> (u32, bool) {
        self.last = (self.last + 1) % NO_OBJECT;
        (self.last, self.last == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_two_clears_no_value_comes_twice() {
        let mut values = StencilValues::default();
        let mut seen = Vec::new();
        let mut clears = 0;
        for _ in 0..1000 {
            let (value, must_clear) = values.next();
            if must_clear {
                clears += 1;
                seen.clear();
            }
            assert!(value != NO_OBJECT && !seen.contains(&value), "{value}");
            seen.push(value);
        }
        assert_eq!(clears, 3);
    }
}
