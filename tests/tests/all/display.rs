//! A virtual display (Xvfb) with input (xdotool) and screenshots (`import` of `ImageMagick`).

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use image::RgbaImage;
use testkit::locate::{left_out, program};
use viewer::picture::png::read_png;

/// A display without a screen, and a window on it.
pub(crate) struct Display {
    server: Child,
    /// The value of `DISPLAY`.
    pub(crate) number: String,
    /// The home folder of its user.
    pub(crate) home: tempfile::TempDir,
    window: Option<Child>,
}

impl Display {
    /// `None` if a tool is missing.
    pub(crate) fn start() -> Option<Self> {
        let has = |name: &str| {
            let mut command = Command::new(name);
            command.arg("-version").stdout(Stdio::null()).stderr(Stdio::null());
            command.status().is_ok()
        };
        if !["Xvfb", "xdotool", "import"].iter().all(|name| has(name)) {
            left_out("a real window (no Xvfb, xdotool or ImageMagick)", 1);
            return None;
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "900x600x24"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let stdout = server.stdout.take().unwrap();
        std::io::BufRead::read_line(&mut std::io::BufReader::new(stdout), &mut line).unwrap();
        let number = format!(":{}", line.trim());
        Some(Self { server, number, home: tempfile::tempdir().unwrap(), window: None })
    }

    pub(crate) fn command(&self, name: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(name);
        command.env("DISPLAY", &self.number).env("HOME", self.home.path());
        command.env_remove("WAYLAND_DISPLAY").env_remove("XDG_CONFIG_HOME");
        command.env_remove("XDG_DATA_HOME").env("XDG_RUNTIME_DIR", self.home.path());
        command.env_remove("DBUS_SESSION_BUS_ADDRESS");
        // A script answers the dialogs.
        let path = std::env::var_os("PATH").unwrap_or_default();
        let own = std::iter::once(self.home.path().to_owned());
        let folders = own.chain(std::env::split_paths(&path));
        command.env("PATH", std::env::join_paths(folders).unwrap());
        command
    }

    /// Makes the next dialogs answer with a file.
    pub(crate) fn answer_dialogs(&self, file: &Path) {
        use std::os::unix::fs::PermissionsExt as _;
        let path = self.home.path().join("zenity");
        std::fs::write(&path, format!("#!/bin/sh\necho '{}'\n", file.display())).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// The id of the window.
    pub(crate) fn window_id(&self) -> Option<u32> {
        let search = self.command("xdotool").args(["search", "--name", "Edgemesh"]).output();
        let id = String::from_utf8(search.unwrap().stdout).unwrap();
        id.lines().last()?.trim().parse().ok()
    }

    /// The window's title.
    pub(crate) fn title(&self) -> String {
        let id = self.window_id().unwrap_or_default().to_string();
        let name = self.command("xdotool").args(["getwindowname", &id]).output().unwrap();
        String::from_utf8(name.stdout).unwrap().trim().to_owned()
    }

    /// Runs xdotool commands one after another, each as slow as a hand: several frames.
    pub(crate) fn hands(&self, parts: &[&str]) {
        for part in parts {
            assert!(self.hand(&part.split(' ').collect::<Vec<_>>()), "{part}");
            std::thread::sleep(Duration::from_millis(300));
        }
    }

    /// Whether the window closes by itself, with success.
    pub(crate) fn closes(&mut self) -> bool {
        let mut window = self.window.take().unwrap();
        let status = self.until(|_| window.try_wait().unwrap());
        self.window = Some(window);
        status.is_some_and(|status| status.success())
    }

    pub(crate) fn open(&mut self, arguments: &[&str]) {
        let mut command = self.command(program("viewer"));
        self.window = Some(command.args(arguments).spawn().unwrap());
        self.focus();
    }

    /// Waits for the window and gives it the keyboard focus.
    pub(crate) fn focus(&self) {
        let found = self.until(|display| {
            let id = display.window_id()?.to_string();
            // Without a window manager nobody else gives it the focus.
            display.hand(&["windowfocus", &id]).then_some(())
        });
        assert!(found.is_some(), "no window opened");
    }

    pub(crate) fn hand(&self, arguments: &[&str]) -> bool {
        let moved = self.command("xdotool").args(arguments).stderr(Stdio::null()).status();
        moved.unwrap().success()
    }

    pub(crate) fn look(&self) -> RgbaImage {
        let path = self.home.path().join("look.png");
        let took = self.command("import").args(["-window", "root"]).arg(&path).status();
        assert!(took.unwrap().success(), "the screenshot failed");
        read_png(&path).unwrap()
    }

    /// The picture of the display once it satisfies `wanted`.
    pub(crate) fn see(&self, wanted: impl Fn(&RgbaImage) -> bool) -> Option<RgbaImage> {
        self.until(|display| Some(display.look()).filter(&wanted))
    }

    pub(crate) fn until<T>(&self, mut wanted: impl FnMut(&Self) -> Option<T>) -> Option<T> {
        let started = Instant::now();
        while started.elapsed() < Duration::from_secs(60) {
            if let Some(found) = wanted(self) {
                return Some(found);
            }
            std::thread::sleep(Duration::from_millis(100));
        }
        None
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        for child in self.window.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
