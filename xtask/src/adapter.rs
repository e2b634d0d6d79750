//! Finds a Vulkan adapter to draw with.
//!
//! The viewer lists the adapters, not the system, since only the viewer knows what it can
//! use. If it lists none, Mesa's software driver is installed, unless that needs a password.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::failure::{Failure, NO_ADAPTER};
use crate::programs;

const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];
/// Names the folder in which Mesa keeps compiled shaders.
const SHADER_CACHE: &str = "MESA_SHADER_CACHE_DIR";
const BY_HAND: &str = "sudo apt-get install mesa-vulkan-drivers libvulkan1";

/// Finds an adapter, or installs one and looks again.
pub(crate) fn ensure(viewer: &Path) -> Result<(), Failure> {
    if is_present(viewer)? {
        return Ok(());
    }
    install()?;
    if is_present(viewer)? {
        return Ok(());
    }
    Err(missing("the driver is installed, but the viewer still finds no Vulkan adapter"))
}

/// Makes a program draw with Vulkan.
///
/// Mesa's driver complains if `XDG_RUNTIME_DIR` is not set, so it gets a folder here.
/// Without a cache of compiled shaders, five of six seconds of the GPU tests go into
/// compiling. The cache lies in the target folder, so that programs with an empty home
/// folder, those of tests and of CI, find it too.
pub(crate) fn use_vulkan(command: &mut Command) -> Result<(), Failure> {
    command.env("WGPU_BACKEND", "vulkan");
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        command.env("XDG_RUNTIME_DIR", runtime_folder()?);
    }
    if std::env::var_os(SHADER_CACHE).is_none() {
        command.env(SHADER_CACHE, programs::target_folder()?.join("shader-cache"));
    }
    Ok(())
}

fn is_present(viewer: &Path) -> Result<bool, Failure> {
    let mut command = Command::new(viewer);
    command.args(["adapters", "--quiet"]).stdin(Stdio::null());
    use_vulkan(&mut command)?;
    let output = command.output().map_err(|error| programs::cannot_start(&command, &error))?;
    match output.status.code() {
        Some(0) => Ok(true),
        Some(code) if code == i32::from(NO_ADAPTER) => Ok(false),
        _ => Err(Failure::new(format!(
            "cannot list the adapters ({}): {}\n{}",
            output.status,
            programs::command_line(&command),
            String::from_utf8_lossy(&output.stderr).trim_end()
        ))),
    }
}

/// Makes the runtime folder, which only its user may read.
fn runtime_folder() -> Result<PathBuf, Failure> {
    let folder = programs::target_folder()?.join("runtime");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::file("make", &folder, error))?;
    #[cfg(unix)]
    {
        use std::fs::Permissions;
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(&folder, Permissions::from_mode(0o700))
            .map_err(|error| Failure::file("close to others", &folder, error))?;
    }
    Ok(folder)
}

fn install() -> Result<(), Failure> {
    if !cfg!(target_os = "linux") || !programs::succeeds(Command::new("apt-get").arg("--version")) {
        return Err(missing("there is no Vulkan adapter; install a Vulkan driver"));
    }
    let prefix: &[&str] = if is_root() {
        &[]
    } else if programs::succeeds(Command::new("sudo").args(["-n", "true"])) {
        &["sudo", "-n"]
    } else {
        return Err(missing(&format!("there is no Vulkan adapter; install one with\n  {BY_HAND}")));
    };
    eprintln!("xtask: no Vulkan adapter; installing {}", PACKAGES.join(" and "));
    // An outdated list may still be good enough to install from.
    if let Err(failure) = programs::run(&mut apt_get(prefix, &["update"])) {
        eprintln!("xtask: {}; going on", failure.message);
    }
    let words: Vec<&str> =
        ["install", "-y", "--no-install-recommends"].into_iter().chain(PACKAGES).collect();
    programs::run(&mut apt_get(prefix, &words)).map_err(|failure| missing(&failure.message))
}

/// `sudo` clears the environment, so `env` sets the variable after it.
fn apt_get(prefix: &[&str], words: &[&str]) -> Command {
    let line = [prefix, &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"], words].concat();
    let mut command = Command::new(line[0]);
    command.args(&line[1..]).stdin(Stdio::null());
    command
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output();
    id.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

fn missing(message: &str) -> Failure {
    Failure { message: message.to_owned(), status: NO_ADAPTER }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_exit_status_of_the_viewer_says_whether_there_is_an_adapter() {
        // Programs of every system with the exit statuses 0 and 1.
        assert!(is_present(Path::new("true")).unwrap(), "0 means present");
        let failure = is_present(Path::new("false")).unwrap_err();
        assert_eq!(failure.status, 1, "{}", failure.message);
        assert!(failure.message.contains("false adapters --quiet"), "{}", failure.message);
    }

    #[test]
    fn apt_get_asks_nothing() {
        let command = apt_get(&["sudo", "-n"], &["update"]);
        let expected = "sudo -n env DEBIAN_FRONTEND=noninteractive apt-get update";
        assert_eq!(programs::command_line(&command), expected);
    }
}
