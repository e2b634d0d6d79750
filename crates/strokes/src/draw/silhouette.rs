//! Silhouettes by the stencil (paper, section 3.4).
//!
//! The fill of each object writes a value of its own where it is seen; contours
//! drawn again where the stencil has another value are those against something
//! else. A stencil has 255 values besides that of no object, so it has to be
//! cleared once in 255 objects, not for each.
//!
//! The paper fills and lines one model after the other. A later one behind the
//! lines of an earlier one then covers them, as lines leave no depth. Here all
//! objects are filled first; those past the first 254 are marked again when
//! their turn comes, where their depth is the one that is there.
//!
//! A silhouette that lies inside of its edge, or centred, is over its own object;
//! its fragments compare the values beside the edge (`stroke_over_surface.wgsl`).

/// The stencil's value where no object is: what it is cleared to.
pub const NO_OBJECT: u32 = 255;

/// The value for each object, and when to clear.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StencilValues {
    last: u32,
}

impl StencilValues {
    /// The value of the next object, and whether the stencil must be cleared
    /// before it: steps 1 and 2 of the paper's list.
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
