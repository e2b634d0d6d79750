//! Blend modes as blend states, for colors with premultiplied alpha.

use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState};

use crate::technique::core_view::Blend;

/// The blend state of a mode; none for one that replaces.
#[must_use]
pub(crate) const fn blend_state(blend: Blend) -> Option<BlendState> {
    let add = BlendOperation::Add;
    // An opaque target stays opaque.
    let over = component(BlendFactor::One, add, BlendFactor::OneMinusSrcAlpha);
    let color = match blend {
        Blend::Replace => return None,
        Blend::Over => over,
        // Card and Mitchell: source times destination. A transparent source keeps the
        // destination.
        Blend::Multiply => component(BlendFactor::Dst, add, BlendFactor::OneMinusSrcAlpha),
        Blend::Add => component(BlendFactor::One, add, BlendFactor::One),
        Blend::Screen => component(BlendFactor::One, add, BlendFactor::OneMinusSrc),
        Blend::Darken => component(BlendFactor::One, BlendOperation::Min, BlendFactor::One),
        Blend::Lighten => component(BlendFactor::One, BlendOperation::Max, BlendFactor::One),
    };
    let alpha = match blend {
        Blend::Darken => component(BlendFactor::One, BlendOperation::Max, BlendFactor::One),
        _ => over,
    };
    Some(BlendState { color, alpha })
}

const fn component(
    src_factor: BlendFactor,
    operation: BlendOperation,
    dst_factor: BlendFactor,
) -> BlendComponent {
    BlendComponent { src_factor, dst_factor, operation }
}
