//! `strokes`: feature edges by the stroke renderer.
//!
//! Passes that follow each other are one drawing style and are drawn from one detection: what
//! is hidden, then what is visible, then silhouettes. What lies under them is the framebuffer
//! as it is; if no pass has drawn the scene there, its depth is filled first, so that surfaces
//! that are not drawn still hide lines.

use std::sync::Arc;

use strokes::gpu::device::Gpu;
use strokes::gpu::target_formats::TargetFormats;
use strokes::gpu::timer::TimedPasses;
use strokes::render::drawing::Drawing;
use strokes::render::frame_request::{Fill, FrameRequest};
use strokes::render::pipelines::{DetectionStage, RendererOptions};
use strokes::render::prepared_style::PreparedStyle;
use strokes::render::renderer::Renderer;

use super::stroke_style::style_of_passes;
use super::{Encoding, GraphOptions};
use crate::error::Error;
use crate::scene::models::Scene;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::pass::Pass;

/// The stroke renderer that all groups of strokes share.
#[derive(Debug)]
pub(crate) struct StrokePasses {
    renderer: Renderer,
    /// What views made of the groups of the technique before, in order.
    drawings: std::vec::IntoIter<Drawing>,
    folders: Vec<std::path::PathBuf>,
}

/// What stays while techniques come and go: renderers with the pipelines that they have
/// built, one per kind of target, and what views made of the last technique's groups.
#[derive(Debug, Default)]
pub(crate) struct StrokeStore {
    renderers: Vec<Renderer>,
    /// Of the last renderer in `renderers`.
    drawings: Vec<Drawing>,
}

impl StrokeStore {
    /// Drops what views made of the last technique.
    pub(crate) fn forget_drawings(&mut self) {
        self.drawings.clear();
    }
}

/// Targets with a stencil and without.
const MOST_RENDERERS: usize = 2;

/// Passes that are drawn together.
#[derive(Debug)]
pub(crate) struct StrokeGroup {
    /// The style of each object.
    styles: Vec<Arc<PreparedStyle>>,
    pub(crate) drawing: Drawing,
}

/// Whether a pass of strokes is done and asks what is beside its lines.
pub(crate) fn needs_stencil(technique: &Technique, overrides: &[Technique]) -> bool {
    let is_silhouette = |pass: &Pass| {
        pass.is_rendered()
            && pass.component.core == CoreComponent::Strokes
            && pass.string("visibility") == "silhouette"
    };
    let mut all = std::iter::once(technique).chain(overrides).flat_map(|own| &own.passes);
    all.any(is_silhouette)
}

impl StrokePasses {
    /// For strokes in targets of `formats`; takes what still fits out of `store`.
    pub(crate) fn new(
        gpu: &Gpu,
        options: &GraphOptions,
        formats: TargetFormats,
        folders: &[std::path::PathBuf],
        store: &mut StrokeStore,
    ) -> Result<Self, Error> {
        let GraphOptions { layout, stage, .. } = *options;
        let options = RendererOptions { layout, stage, formats }.supported();
        let known = store.renderers.iter().position(|known| *known.options() == options);
        // Drawings belong to the renderer that was used last.
        let is_last = known.is_some_and(|at| at + 1 == store.renderers.len());
        let drawings = std::mem::take(&mut store.drawings);
        let renderer = match known {
            Some(at) => store.renderers.remove(at),
            None => Renderer::new(gpu, options)?,
        };
        let drawings = if is_last { drawings } else { Vec::new() };
        Ok(Self { renderer, drawings: drawings.into_iter(), folders: folders.to_vec() })
    }

    /// Leaves the renderer, and the drawings of its groups, for the next technique.
    pub(crate) fn put_back(self, drawings: Vec<Drawing>, store: &mut StrokeStore) {
        store.drawings = drawings;
        store.renderers.push(self.renderer);
        if store.renderers.len() > MOST_RENDERERS {
            store.renderers.remove(0);
        }
    }

    /// Whether vertex shaders detect, which count nothing.
    pub(crate) fn counts_nothing(&self) -> bool {
        self.renderer.options().stage == DetectionStage::Vertex
    }

    /// Prepares the styles of `passes` for the objects of `scene`; objects with overrides take
    /// all passes of strokes from there.
    pub(crate) fn group(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        passes: &[&Pass],
        overrides: &[Technique],
    ) -> Result<StrokeGroup, Error> {
        let style = |passes: &[&Pass], folders: &[std::path::PathBuf]| {
            style_of_passes(passes, folders, &scene.frame, scene.thresholds)
        };
        let mut all = vec![style(passes, &self.folders)?];
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
                None => self.renderer.prepare(gpu, style)?,
            });
        }
        let of_object = |look: usize| prepared.get(look + 1).unwrap_or(&prepared[0]).clone();
        Ok(StrokeGroup {
            styles: scene.objects.iter().map(|object| of_object(object.look)).collect(),
            drawing: self.drawings.next().unwrap_or_default(),
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
            overview: encoding.overview,
            resolves: false,
            timer,
        };
        self.renderer.encode(encoding.gpu, encoder, &mut group.drawing, &request)?;
        (encoding.is_fresh, encoding.has_depth) = (false, true);
        Ok(())
    }
}

impl StrokeGroup {
    /// Whether any strokes are linked.
    pub(crate) fn is_linked(&self) -> bool {
        self.styles.iter().any(|style| style.is_linked())
    }
}
