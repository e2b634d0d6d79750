//! The picture of the window: a renderer that follows the session, and its texture in
//! the window.
//!
//! It draws only when something of the recipe or the size has changed. What cannot be
//! drawn is told, and the last good picture stays.

use std::sync::Arc;

use edgemesh::command::{ExitStatus, Failure};
use strokes::gpu::Gpu;

use super::recipe::Appearance;
use super::session::Session;
use super::viewpoint::Viewpoint;
use super::watching::Change;
use crate::render::{FrameStatistics, PendingStatistics, PictureRenderer, Scene};

/// The picture of the window.
pub(super) struct Canvas {
    gpu: Gpu,
    window: egui_wgpu::RenderState,
    renderer: Option<PictureRenderer>,
    /// The scene that the renderer has.
    scene: Option<Arc<Scene>>,
    /// What was drawn last.
    drawn: Option<Drawn>,
    /// What could not be drawn.
    failed: Option<Drawn>,
    /// Whether files may be half saved.
    is_doubted: bool,
    texture: Option<egui::TextureId>,
    pending: Option<PendingStatistics>,
}

/// What makes a picture.
#[derive(Debug, Clone, PartialEq)]
struct Drawn {
    appearance: Appearance,
    viewpoint: Viewpoint,
    size: [u32; 2],
}

impl std::fmt::Debug for Canvas {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Canvas").field("drawn", &self.drawn).finish_non_exhaustive()
    }
}

impl Canvas {
    /// A canvas in a window.
    #[must_use]
    pub(super) fn new(window: egui_wgpu::RenderState) -> Self {
        let gpu = Gpu {
            info: window.adapter.get_info(),
            device: window.device.clone(),
            queue: window.queue.clone(),
        };
        Self {
            gpu,
            window,
            renderer: None,
            scene: None,
            drawn: None,
            failed: None,
            is_doubted: false,
            texture: None,
            pending: None,
        }
    }

    /// The device.
    #[must_use]
    pub(super) const fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The picture as the window knows it.
    #[must_use]
    pub(super) const fn texture(&self) -> Option<egui::TextureId> {
        self.texture
    }

    /// The longest side that it can have, in pixels.
    #[must_use]
    pub(super) fn max_side(&self) -> u32 {
        self.gpu.device.limits().max_texture_dimension_2d
    }

    /// Takes a scene that was loaded, with a renderer where one could be made.
    pub(super) fn take_scene(&mut self, scene: Arc<Scene>, renderer: Option<PictureRenderer>) {
        self.scene = Some(scene);
        self.renderer = renderer;
        self.pending = None;
        (self.drawn, self.failed) = (None, None);
    }

    /// Draws everything again after a file has changed. What is wrong with it is told once
    /// it is settled.
    pub(super) fn forget(&mut self, change: Change) {
        (self.drawn, self.failed) = (None, None);
        self.is_doubted = change == Change::Now;
    }

    /// Draws what the session has, where anything of it has changed.
    pub(super) fn draw(&mut self, session: &mut Session, size: [u32; 2]) {
        let (Some(scene), Some(viewpoint)) = (self.scene.clone(), session.recipe.viewpoint) else {
            return;
        };
        let size = size.map(|side| side.clamp(1, self.max_side()));
        let wanted = Drawn { appearance: session.recipe.appearance.clone(), viewpoint, size };
        if self.drawn.as_ref() == Some(&wanted) || self.is_hopeless(&wanted) {
            return;
        }
        match self.draw_now(session, &scene, &wanted) {
            Ok(()) => {
                session.messages.technique = None;
                (self.failed, self.is_doubted) = (None, false);
                self.drawn = Some(wanted);
            }
            // It may just be half saved.
            Err(_) if self.is_doubted => self.failed = Some(wanted),
            Err(failure) => {
                if failure.status == ExitStatus::Shader {
                    session.messages.technique = Some(failure.message);
                } else {
                    session.messages.error(failure.message);
                }
                self.failed = Some(wanted);
            }
        }
    }

    /// Whether it was tried, wherever it was seen from.
    fn is_hopeless(&self, wanted: &Drawn) -> bool {
        self.failed.as_ref().is_some_and(|failed| {
            failed.appearance == wanted.appearance && failed.size == wanted.size
        })
    }

    fn draw_now(
        &mut self,
        session: &Session,
        scene: &Arc<Scene>,
        wanted: &Drawn,
    ) -> Result<(), Failure> {
        let options = session.recipe.picture_options(wanted.size)?;
        let technique = &wanted.appearance.technique;
        let is_same = self.drawn.as_ref().is_some_and(|drawn| {
            let (old, new) = (&drawn.appearance, &wanted.appearance);
            drawn.size == wanted.size
                && old.technique == new.technique
                && old.is_transparent == new.is_transparent
        });
        let is_lit = |renderer: &mut PictureRenderer| renderer.set_lighting(&options.lighting);
        let is_ready = is_same && self.renderer.as_mut().is_some_and(is_lit);
        if !is_ready {
            self.pending = None;
            let looks = session.object_looks()?;
            match &mut self.renderer {
                Some(renderer) => renderer.reload(scene, technique, &looks, &options)?,
                None => {
                    let gpu = &self.gpu;
                    self.renderer =
                        Some(PictureRenderer::new(gpu, scene, technique, &looks, &options)?);
                }
            }
        }
        let Some(renderer) = &mut self.renderer else { return Ok(()) };
        renderer.draw(&wanted.viewpoint.camera(&scene.frame))?;
        if self.pending.is_none() {
            self.pending = renderer.begin_statistics().ok();
        }
        self.show();
        Ok(())
    }

    /// Hands the picture to the window.
    fn show(&mut self) {
        let Some(picture) = self.renderer.as_ref().and_then(PictureRenderer::picture) else {
            return;
        };
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut window = self.window.renderer.write();
        let (device, filter) = (&self.gpu.device, wgpu::FilterMode::Nearest);
        match self.texture {
            Some(texture) => {
                window.update_egui_texture_from_wgpu_texture(device, &view, filter, texture);
            }
            None => {
                self.texture = Some(window.register_native_texture(device, &view, filter));
            }
        }
    }

    /// What the last picture drew and cost, once it is known; whether there will be more.
    pub(super) fn statistics(&mut self) -> (Option<FrameStatistics>, bool) {
        let (Some(renderer), Some(pending)) = (&self.renderer, &self.pending) else {
            return (None, false);
        };
        match renderer.statistics(pending) {
            Ok(None) => (None, true),
            known => {
                self.pending = None;
                (known.ok().flatten(), false)
            }
        }
    }
}
