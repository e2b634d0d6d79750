//! `strokes`: feature edges by the stroke renderer.
//!
//! Consecutive passes are one drawing style and share one detection. Hidden strokes are drawn
//! first, then visible ones, then silhouettes, over the framebuffer. If no pass has drawn the
//! scene there, its depth is filled first, so that surfaces that are not drawn still hide
//! lines.

use std::sync::Arc;

use strokes::{
    DetectionStage, Drawing, Fill, FrameRequest, Gpu, PreparedStyle, Renderer, RendererOptions,
    TargetFormats, TimedPasses,
};

use super::glass::GlassTargets;
use super::material::has_glass;
use super::stroke_style::style_of_passes;
use super::{Encoding, GraphInput, GraphOptions};
use crate::error::Error;
use crate::scene::models::PlacedObject;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::core_view::{LineSelection, Visibility};
use crate::technique::pass::Pass;

/// The stroke renderers, one per kind of target: with a stencil and without. They keep their
/// pipelines when the technique changes.
#[derive(Debug, Default)]
pub(crate) struct StrokeRenderers {
    /// The renderer used last is the last.
    known: Vec<Renderer>,
}

/// Targets with a stencil and without.
const MOST_RENDERERS: usize = 2;

/// Passes that are drawn together.
#[derive(Debug)]
pub(crate) struct StrokeGroup {
    /// The options of its renderer.
    options: RendererOptions,
    /// The style of each object.
    styles: Vec<Arc<PreparedStyle>>,
    pub(crate) drawing: Drawing,
}

/// Whether a rendered pass draws silhouettes, which need a stencil.
pub(crate) fn needs_stencil(technique: &Technique, overrides: &[Technique]) -> bool {
    let is_silhouette = |pass: &Pass| {
        pass.is_rendered()
            && LineSelection::of(pass)
                .is_some_and(|lines| lines.visibility == Visibility::Silhouette)
    };
    let mut all = std::iter::once(technique).chain(overrides).flat_map(|own| &own.passes);
    all.any(is_silhouette)
}

impl StrokeRenderers {
    /// The renderer with these options, built if it is not known.
    fn renderer(&mut self, gpu: &Gpu, options: RendererOptions) -> Result<&mut Renderer, Error> {
        let known = self.known.iter().position(|known| *known.options() == options);
        let renderer = match known {
            Some(at) => self.known.remove(at),
            None => Renderer::new(gpu, options)?,
        };
        self.known.push(renderer);
        let last = self.known.len() - 1;
        Ok(&mut self.known[last])
    }

    /// Drops all but the renderers that were used last.
    pub(crate) fn trim(&mut self) {
        let surplus = self.known.len().saturating_sub(MOST_RENDERERS);
        self.known.drain(..surplus);
    }

    /// Prepares the styles of `passes` for the objects of the scene, in targets of `formats`;
    /// objects with overrides take all passes of strokes from there.
    pub(crate) fn group(
        &mut self,
        gpu: &Gpu,
        input: &GraphInput,
        passes: &[&Pass],
        formats: TargetFormats,
    ) -> Result<StrokeGroup, Error> {
        let GraphInput { scene, technique, overrides, options, .. } = *input;
        let GraphOptions { layout, stage, .. } = *options;
        let has_glass = has_glass(scene);
        let options = RendererOptions { layout, stage, formats, has_glass }.supported();
        let renderer = self.renderer(gpu, options)?;
        let style = |passes: &[&Pass], folders: &[std::path::PathBuf]| {
            style_of_passes(passes, folders, &scene.frame, scene.thresholds)
        };
        let mut all = vec![style(passes, &technique.folders)?];
        for own in overrides {
            let is_drawn =
                |pass: &&Pass| pass.is_rendered() && pass.component.core == CoreComponent::Strokes;
            let passes: Vec<&Pass> = own.passes.iter().filter(is_drawn).collect();
            all.push(style(&passes, &own.folders)?);
        }
        // Equal styles share pipelines and textures.
        let mut prepared: Vec<Arc<PreparedStyle>> = Vec::with_capacity(all.len());
        for (at, style) in all.iter().enumerate() {
            let same = all[..at].iter().position(|known| known == style);
            prepared.push(match same {
                Some(same) => prepared[same].clone(),
                None => renderer.prepare(gpu, style)?,
            });
        }
        let of_object = |object: &PlacedObject| {
            prepared.get(object.override_index + 1).unwrap_or(&prepared[0]).clone()
        };
        Ok(StrokeGroup {
            options,
            styles: scene.objects.iter().map(of_object).collect(),
            drawing: Drawing::new(),
        })
    }

    pub(crate) fn encode(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        group: &mut StrokeGroup,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        let fill = match (encoding.has_depth, encoding.is_fresh) {
            (true, _) => Fill::Done,
            (false, true) => Fill::Clear([0.0; 4]),
            (false, false) => Fill::Depth,
        };
        let request = FrameRequest {
            targets: encoding.framebuffer,
            instances: encoding.instances,
            styles: &group.styles,
            view: encoding.view,
            fill,
            glass_depth: encoding
                .glass
                .filter(|_| encoding.has_glass_depth)
                .map(GlassTargets::nearest),
            overview: encoding.overview,
            resolves: false,
            timer,
        };
        self.renderer(encoding.gpu, group.options)?.encode(
            encoding.gpu,
            encoder,
            &mut group.drawing,
            &request,
        )?;
        (encoding.is_fresh, encoding.has_depth) = (false, true);
        Ok(())
    }
}

impl StrokeGroup {
    /// Takes over the buffers of the views of an earlier group with the same renderer.
    pub(crate) fn continue_from(&mut self, before: Self) {
        if self.options == before.options {
            self.drawing = before.drawing;
        }
    }

    /// Whether the detection stage is the vertex shader, which counts nothing.
    pub(crate) fn counts_nothing(&self) -> bool {
        self.options.stage == DetectionStage::Vertex
    }

    /// Whether any strokes are linked.
    pub(crate) fn is_linked(&self) -> bool {
        self.styles.iter().any(|style| style.is_linked())
    }
}
