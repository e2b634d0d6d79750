//! The usual ways of laying one colour over another, with premultiplied alpha.

use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// The blending of a word of the variable `blend`; `None` replaces.
#[must_use]
pub(crate) fn blend_state(word: &str) -> Option<BlendState> {
    let component =
        |src_factor, operation, dst_factor| BlendComponent { src_factor, dst_factor, operation };
    let add = BlendOperation::Add;
    // What is opaque stays so, whatever is done to its colour.
    let over = component(BlendFactor::One, add, BlendFactor::OneMinusSrcAlpha);
    let color = match word {
        "over" => over,
        // Card and Mitchell: source times destination. Where the source is clear
        // the destination stays.
        "multiply" => component(BlendFactor::Dst, add, BlendFactor::OneMinusSrcAlpha),
        "add" => component(BlendFactor::One, add, BlendFactor::One),
        "screen" => component(BlendFactor::One, add, BlendFactor::OneMinusSrc),
        "darken" => component(BlendFactor::One, BlendOperation::Min, BlendFactor::One),
        "lighten" => component(BlendFactor::One, BlendOperation::Max, BlendFactor::One),
        _ => return None,
    };
    let alpha = match word {
        "darken" => component(BlendFactor::One, BlendOperation::Max, BlendFactor::One),
        _ => over,
    };
    Some(BlendState { color, alpha })
}
