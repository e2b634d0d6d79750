//! The picture of the window: a renderer that follows the session, and its texture in the
//! window.
//!
//! A picture is drawn only if the recipe or the size has changed. If it cannot be drawn, the
//! error is reported and the last good picture stays.

use std::sync::Arc;
use std::time::Instant;

use edgemesh_shaders::ShaderError;
use strokes::Gpu;

use super::error_text::error_text;
use super::inspection::Inspection;
use super::loading::BuildKey;
use super::picture_paint::{PaintedPicture, PicturePainter};
use super::recipe::Appearance;
use super::session::Session;
use super::viewpoint::Viewpoint;
use super::watching::Change;
use crate::error::Error;
use crate::picture::renderer::{
    FrameStatistics, PendingStatistics, PictureInput, PictureOptions, PictureRenderer,
};
use crate::scene::models::Scene;

/// The pictures of the window: one, or two that are compared.
pub(super) struct Canvas {
    gpu: Gpu,
    painter: PicturePainter,
    /// The scene of the sheets' renderers.
    scene: Option<Arc<Scene>>,
    sheet: Sheet,
    compared: Option<Sheet>,
    /// When the last picture was drawn.
    drawn_at: Option<Instant>,
}

/// A picture with its renderer.
#[derive(Debug, Default)]
struct Sheet {
    renderer: Option<PictureRenderer>,
    /// What the renderer was built for; `None` if files have changed since.
    built: Option<BuildKey>,
    /// The input of the last picture.
    drawn: Option<DrawKey>,
    /// The input that could not be drawn.
    failed: Option<DrawKey>,
    /// Whether the files may be half saved, so that errors are not reported yet.
    is_doubted: bool,
    painted: Option<PaintedPicture>,
    pending: Option<PendingStatistics>,
}

/// The input of a picture; the same key gives the same picture.
#[derive(Debug, Clone, PartialEq)]
struct DrawKey {
    appearance: Appearance,
    viewpoint: Viewpoint,
    size: [u32; 2],
}

impl std::fmt::Debug for Canvas {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Canvas").field("sheet", &self.sheet).finish_non_exhaustive()
    }
}

impl Canvas {
    /// # Errors
    /// If the shader of the window cannot be resolved.
    pub(super) fn new(window: &egui_wgpu::RenderState) -> Result<Self, ShaderError> {
        let gpu = Gpu {
            info: window.adapter.get_info(),
            device: window.device.clone(),
            queue: window.queue.clone(),
        };
        Ok(Self {
            gpu,
            painter: PicturePainter::new(window)?,
            scene: None,
            sheet: Sheet::default(),
            compared: None,
            drawn_at: None,
        })
    }

    #[must_use]
    pub(super) const fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The last picture.
    #[must_use]
    pub(super) const fn picture(&self) -> Option<&PaintedPicture> {
        self.sheet.painted.as_ref()
    }

    /// The second picture, if two are compared.
    #[must_use]
    pub(super) fn compared_picture(&self) -> Option<&PaintedPicture> {
        self.compared.as_ref()?.painted.as_ref()
    }

    /// Takes a loaded scene, and its renderer if one could be built.
    pub(super) fn take_scene(
        &mut self,
        scene: Arc<Scene>,
        renderer: Option<(PictureRenderer, BuildKey)>,
    ) {
        self.scene = Some(scene);
        for sheet in self.compared.iter_mut().chain([&mut self.sheet]) {
            (sheet.renderer, sheet.pending) = (None, None);
            (sheet.built, sheet.drawn, sheet.failed) = (None, None, None);
        }
        (self.sheet.renderer, self.sheet.built) = renderer.unzip();
    }

    /// Takes the session's scene if it has changed because edges were marked.
    pub(super) fn follow(&mut self, session: &Session) {
        let Some(scene) = &session.scene else { return };
        if self.scene.as_ref().is_some_and(|known| !Arc::ptr_eq(known, scene)) {
            self.take_scene(scene.clone(), None);
        }
    }

    /// Draws everything again after a file has changed. Errors are reported only once the
    /// files are settled.
    pub(super) fn forget(&mut self, change: Change) {
        for sheet in self.compared.iter_mut().chain([&mut self.sheet]) {
            (sheet.built, sheet.drawn, sheet.failed) = (None, None, None);
            sheet.is_doubted = change == Change::Now;
        }
    }

    /// Draws the session's picture if its input has changed.
    pub(super) fn draw(&mut self, session: &mut Session, size: [u32; 2]) {
        let (Some(scene), Some(viewpoint)) = (self.scene.clone(), session.recipe.viewpoint) else {
            return;
        };
        let max_side = self.gpu.device.limits().max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, max_side));
        let gpu = &self.gpu;
        let mut appearance = session.recipe.appearance.clone();
        let is_there = |inspection: &&Inspection| session.generated.contains(&inspection.texture);
        if let Some(inspection) = session.inspection.as_ref().filter(is_there)
            && let Some(shown) = inspection.shown(&appearance.technique, &session.library)
        {
            appearance.technique = shown;
        }
        let wanted = DrawKey { appearance, viewpoint, size };
        let started = Instant::now();
        if self.sheet.draw(gpu, session, &scene, wanted) {
            self.sheet.show(gpu, &self.painter);
            let ms = |since: Instant| since.elapsed().as_secs_f64() * 1e3;
            if let Some(before) = self.drawn_at.replace(Instant::now()) {
                log::debug!(
                    "a picture, {:.1} ms after the last, made in {:.1} ms",
                    ms(before),
                    ms(started)
                );
            }
            let renderer = self.sheet.renderer.as_ref();
            session.generated = renderer.map_or_else(Vec::new, PictureRenderer::generated_textures);
        }
        match &session.comparison {
            Some(comparison) => {
                let sheet = self.compared.get_or_insert_default();
                let appearance = Appearance {
                    lighting: session.recipe.appearance.lighting.clone(),
                    ..comparison.appearance.clone()
                };
                let wanted = DrawKey { appearance, viewpoint, size };
                if sheet.draw(gpu, session, &scene, wanted) {
                    sheet.show(gpu, &self.painter);
                }
            }
            None => self.compared = None,
        }
    }

    /// The statistics of the last picture once they are known, and whether to ask again.
    pub(super) fn statistics(&mut self) -> (Option<FrameStatistics>, bool) {
        let sheet = &mut self.sheet;
        let (Some(renderer), Some(pending)) = (&sheet.renderer, &sheet.pending) else {
            return (None, false);
        };
        match renderer.statistics(pending) {
            Ok(None) => (None, true),
            known => {
                sheet.pending = None;
                (known.ok().flatten(), false)
            }
        }
    }
}

impl Sheet {
    /// Draws `wanted` if it differs from the last picture; returns whether it did. Errors are
    /// reported to the session.
    fn draw(
        &mut self,
        gpu: &Gpu,
        session: &mut Session,
        scene: &Arc<Scene>,
        wanted: DrawKey,
    ) -> bool {
        if self.drawn.as_ref() == Some(&wanted) || self.is_hopeless(&wanted) {
            return false;
        }
        match self.draw_now(gpu, session, scene, &wanted) {
            Ok(()) => {
                session.messages.technique = None;
                (self.failed, self.is_doubted) = (None, false);
                self.drawn = Some(wanted);
                return true;
            }
            // The files may be half saved.
            Err(_) if self.is_doubted => {}
            Err(Error::Technique(error)) => session.messages.technique = Some(error.to_string()),
            Err(error) => session.messages.error(error_text(&error)),
        }
        self.failed = Some(wanted);
        false
    }

    /// Whether the same appearance and size have failed before, from any viewpoint.
    fn is_hopeless(&self, wanted: &DrawKey) -> bool {
        self.failed.as_ref().is_some_and(|failed| {
            failed.appearance == wanted.appearance && failed.size == wanted.size
        })
    }

    fn draw_now(
        &mut self,
        gpu: &Gpu,
        session: &Session,
        scene: &Arc<Scene>,
        wanted: &DrawKey,
    ) -> Result<(), Error> {
        let options = PictureOptions {
            lighting: wanted.appearance.lighting.clone(),
            is_transparent: wanted.appearance.is_transparent,
            ..session.recipe.picture_options(wanted.size)
        };
        let technique = &wanted.appearance.technique;
        let is_same = |built: &BuildKey| {
            (&built.technique, built.is_transparent) == (technique, options.is_transparent)
        };
        // `None` until it is built as wanted.
        let before = self.built.take().filter(is_same);
        let is_lit = |renderer: &mut PictureRenderer| renderer.set_lighting(&options.lighting);
        let before = before.filter(|_| self.renderer.as_mut().is_some_and(is_lit));
        if let (Some(renderer), Some(_)) = (&mut self.renderer, &before) {
            if renderer.options().size != wanted.size {
                self.pending = None;
                renderer.resize(wanted.size)?;
            }
        } else {
            self.pending = None;
            let overrides = &session.object_overrides()?;
            let input = PictureInput { scene, technique, overrides };
            match &mut self.renderer {
                Some(renderer) => renderer.reload(input, &options)?,
                None => self.renderer = Some(PictureRenderer::new(gpu, input, &options)?),
            }
        }
        let is_transparent = options.is_transparent;
        let new = || BuildKey { technique: technique.clone(), is_transparent };
        self.built = Some(before.unwrap_or_else(new));
        let Some(renderer) = &mut self.renderer else { return Ok(()) };
        renderer.draw(&wanted.viewpoint.camera(&scene.frame))?;
        if self.pending.is_none() {
            self.pending = renderer.begin_statistics().ok();
        }
        Ok(())
    }

    /// Hands the picture to the window.
    fn show(&mut self, gpu: &Gpu, painter: &PicturePainter) {
        if let Some(picture) = self.renderer.as_ref().map(PictureRenderer::picture) {
            self.painted = Some(painter.picture(&gpu.device, picture));
        }
    }
}
