//! Settings that the window keeps from one run to the next.

use std::path::{Path, PathBuf};

use super::navigation::TurnMode;
use super::viewpoint::UpAxis;

/// The most entries of recent files.
const MOST_RECENT: usize = 10;

/// Settings that the window keeps from one run to the next. eframe keeps the size and place
/// of the window.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// Recent files, the newest first. Files opened together are one entry.
    pub(crate) recent: Vec<Vec<PathBuf>>,
    /// Whether the panels are shown.
    pub shows_panels: bool,
    /// The open panel.
    pub tab: Tab,
    /// How a drag turns the eye.
    pub(crate) turn_mode: TurnMode,
    /// The up axis of the models.
    pub(crate) up: UpAxis,
    /// Theme of the window.
    pub(crate) theme: Theme,
    /// Width and height of saved pictures in pixels; `None` for the size in the window.
    pub(crate) picture_size: Option<[u32; 2]>,
    /// Number of pictures of a turntable.
    pub(crate) turntable_steps: u32,
}

/// A panel at the side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Tab {
    /// Technique, passes and variables.
    #[default]
    Look,
    /// Line classes.
    Lines,
    /// Light and cuts.
    Light,
    /// Camera.
    View,
    /// Debug views, textures, counts and times.
    Inspect,
    /// Pictures and commands.
    Output,
}

impl Tab {
    /// All tabs with their labels.
    pub(crate) const ALL: [(Self, &'static str); 6] = [
        (Self::Look, "Look"),
        (Self::Lines, "Lines"),
        (Self::Light, "Light"),
        (Self::View, "View"),
        (Self::Inspect, "Inspect"),
        (Self::Output, "Output"),
    ];
}

/// Theme of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub(crate) enum Theme {
    /// As the desktop.
    #[default]
    System,
    /// Light.
    Light,
    /// Dark.
    Dark,
}

impl From<Theme> for egui::ThemePreference {
    fn from(theme: Theme) -> Self {
        match theme {
            Theme::System => Self::System,
            Theme::Light => Self::Light,
            Theme::Dark => Self::Dark,
        }
    }
}

impl Default for Remembered {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            shows_panels: true,
            tab: Tab::default(),
            turn_mode: TurnMode::default(),
            up: UpAxis::default(),
            theme: Theme::default(),
            picture_size: None,
            turntable_steps: 72,
        }
    }
}

impl Remembered {
    /// Puts files first in the recent files; standard input and the demo are left out.
    pub(crate) fn opened(&mut self, models: &[PathBuf]) {
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let is_file = |path: &PathBuf| path.is_file();
        if models.is_empty() || !models.iter().all(is_file) {
            return;
        }
        let models: Vec<PathBuf> = models.iter().map(absolute).collect();
        self.recent.retain(|known| *known != models);
        self.recent.insert(0, models);
        self.recent.truncate(MOST_RECENT);
    }
}

/// The title of files opened together.
#[must_use]
pub(crate) fn name_of(models: &[PathBuf]) -> String {
    let name = |path: &Path| {
        path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    };
    match models {
        [] => String::new(),
        [one] => name(one),
        [first, rest @ ..] => format!("{} and {} more", name(first), rest.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_files_come_first_and_each_once() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, "").unwrap();
            path
        };
        let mut remembered = Remembered::default();
        let (a, b) = (file("a.obj"), file("b.obj"));
        for models in [vec![a.clone()], vec![b.clone()], vec![a.clone(), b.clone()], vec![a]] {
            remembered.opened(&models);
        }
        remembered.opened(&[PathBuf::from("demo:")]);
        let names: Vec<String> = remembered.recent.iter().map(|files| name_of(files)).collect();
        assert_eq!(names, ["a.obj", "a.obj and 1 more", "b.obj"]);
        for index in 0..20 {
            remembered.opened(&[file(&format!("{index}.obj"))]);
        }
        assert_eq!(remembered.recent.len(), MOST_RECENT);
    }
}
