//! Models on a thread of their own, while the window goes on with what it has.
//!
//! ```text
//!   files --read, build--> Scene --upload--> PictureRenderer --> the window takes both
//! ```
//!
//! What is cancelled, or overtaken by another request, is given up at its next stage and
//! never shown.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use edgemesh::command::{ExitStatus, Failure, Listener};
use strokes::gpu::Gpu;

use crate::command::picture_arguments::{PictureArguments, objects_of};
use crate::render::{PictureOptions, PictureRenderer, Scene};
use crate::scene_file::SceneObject;
use crate::technique::Technique;

/// What is loaded, and what it is to be drawn with at first.
#[derive(Debug, Clone)]
pub struct Request {
    /// Models and scene files.
    pub models: Vec<PathBuf>,
    /// How they are read.
    pub arguments: PictureArguments,
    /// The device to upload to; none where nothing is drawn.
    pub gpu: Option<Gpu>,
    /// The technique.
    pub technique: Technique,
    /// How it is drawn.
    pub options: PictureOptions,
}

/// Models that are there.
#[derive(Debug)]
pub struct LoadedScene {
    /// The request's models.
    pub models: Vec<PathBuf>,
    /// What they are.
    pub scene: Arc<Scene>,
    /// The objects of scene files.
    pub objects: Vec<SceneObject>,
    /// Ready to draw, where there is a device.
    pub renderer: Option<PictureRenderer>,
    /// How they were read.
    pub arguments: PictureArguments,
}

/// Models on their way.
#[derive(Debug)]
pub struct Loading {
    result: Receiver<Result<LoadedScene, Failure>>,
    stage: Arc<Mutex<String>>,
    is_cancelled: Arc<AtomicBool>,
    /// Since when.
    pub started: Instant,
}

impl Loading {
    /// Begins; `wake` is called whenever there is something new to show.
    #[must_use]
    pub fn start(request: Request, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (sender, result) = channel();
        let stage = Arc::new(Mutex::new(String::new()));
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let (told, cancelled) = (stage.clone(), is_cancelled.clone());
        std::thread::spawn(move || {
            let tell = |what: &str| {
                what.clone_into(&mut told.lock().unwrap_or_else(PoisonError::into_inner));
                wake();
                !cancelled.load(Ordering::Relaxed)
            };
            // A fault of ours in a reader must not take the window with it.
            let load = std::panic::AssertUnwindSafe(|| load(request, &tell));
            let loaded = std::panic::catch_unwind(load).unwrap_or_else(|_| {
                let message = "internal error while the model was read, please report it with \
                               the file";
                Err(Failure { message: message.into(), status: ExitStatus::Internal })
            });
            // Nobody waits for what was cancelled.
            let _ = sender.send(loaded);
            wake();
        });
        Self { result, stage, is_cancelled, started: Instant::now() }
    }

    /// What is being done.
    #[must_use]
    pub fn stage(&self) -> String {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The models, once they are there.
    #[must_use]
    pub fn take(&self) -> Option<Result<LoadedScene, Failure>> {
        self.result.try_recv().ok()
    }
}

impl Drop for Loading {
    fn drop(&mut self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }
}

fn load(request: Request, tell: &(dyn Fn(&str) -> bool + Sync)) -> Result<LoadedScene, Failure> {
    let listener = Listener::Other(tell);
    let objects = objects_of(&request.models)?;
    let scene = Scene::load(&objects, &request.arguments.input, listener)?;
    let renderer = match &request.gpu {
        None => None,
        Some(gpu) => {
            listener.begin("uploading")?;
            let Request { technique, options, .. } = &request;
            // What is wrong with a technique is no fault of the models: the window tells it.
            let made = PictureRenderer::new(gpu, &scene, technique, &[], options);
            match made {
                Err(failure) if failure.status != ExitStatus::Shader => return Err(failure),
                made => made.ok(),
            }
        }
    };
    let Request { models, arguments, .. } = request;
    Ok(LoadedScene { models, scene: Arc::new(scene), objects, renderer, arguments })
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::Duration;

    use super::*;
    use crate::technique::library::Library;
    use crate::window::recipe::Recipe;

    fn request(model: &Path) -> Request {
        let library = Library::shipped();
        let recipe = Recipe::of_words(&[model.display().to_string()], &library).unwrap();
        Request {
            models: recipe.models,
            arguments: recipe.arguments,
            gpu: None,
            technique: recipe.appearance.technique,
            options: PictureOptions::default(),
        }
    }

    fn wait(loading: &Loading) -> Result<LoadedScene, Failure> {
        loading.result.recv_timeout(Duration::from_secs(60)).unwrap()
    }

    #[test]
    fn models_come_with_what_was_done() {
        let loading = Loading::start(request(Path::new("demo:")), || {});
        let loaded = wait(&loading).unwrap();
        assert_eq!(loaded.scene.models.len(), 1);
        assert!(loading.stage().starts_with("building"), "{}", loading.stage());
        let missing = Loading::start(request(Path::new("no such.obj")), || {});
        let failure = wait(&missing).unwrap_err();
        assert!(failure.message.contains("no such.obj"), "{}", failure.message);
    }

    #[test]
    fn what_is_cancelled_ends_at_its_next_stage() {
        let (sender, receiver) = channel();
        let (answer, go_on) = channel::<()>();
        let go_on = Mutex::new(go_on);
        let loading = Loading::start(request(Path::new("demo:")), move || {
            sender.send(()).ok();
            go_on.lock().unwrap().recv().ok();
        });
        receiver.recv().unwrap();
        loading.is_cancelled.store(true, Ordering::Relaxed);
        drop(answer);
        assert_eq!(wait(&loading).unwrap_err().message, "it was cancelled");
    }
}
