//! Builds the workspace's two commands and runs programs.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::failure::Failure;

/// Where the two commands are.
#[derive(Debug)]
pub(crate) struct Programs {
    /// Their folder.
    pub(crate) folder: PathBuf,
    pub(crate) viewer: PathBuf,
}

/// Builds the two commands.
///
/// Builds all packages at once with the features of the tests, so that cargo chooses the
/// same features as for the tests and compiles each dependency once.
pub(crate) fn build() -> Result<Programs, Failure> {
    let mut command = cargo();
    command.args(["build", "--workspace", "--bins", "--features", "testkit/gpu"]);
    run(&mut command)?;
    let folder = target_folder()?.join("debug");
    Ok(Programs { viewer: built(&folder, "viewer")?, folder })
}

fn built(folder: &Path, name: &str) -> Result<PathBuf, Failure> {
    let path = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    if path.is_file() {
        Ok(path)
    } else {
        Err(Failure::new(format!("`cargo build` did not make {}", path.display())))
    }
}

/// The folder that holds the workspace's `Cargo.toml`.
pub(crate) fn workspace_root() -> &'static Path {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask)
}

/// The target folder of cargo. A relative `CARGO_TARGET_DIR` is relative to the folder in
/// which this program was started.
pub(crate) fn target_folder() -> Result<PathBuf, Failure> {
    match std::env::var_os("CARGO_TARGET_DIR") {
        Some(folder) => std::path::absolute(&folder)
            .map_err(|error| Failure::file("find", Path::new(&folder), error)),
        None => Ok(workspace_root().join("target")),
    }
}

/// A call of the cargo that runs this program, in the workspace's root.
pub(crate) fn cargo() -> Command {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(program);
    command.current_dir(workspace_root());
    if let Ok(folder) = target_folder() {
        command.env("CARGO_TARGET_DIR", folder);
    }
    command
}

/// Runs a program and waits for it. A failure names the command line and has the
/// program's exit status.
pub(crate) fn run(command: &mut Command) -> Result<(), Failure> {
    let status = command.status().map_err(|error| cannot_start(command, &error))?;
    if status.success() {
        return Ok(());
    }
    Err(Failure {
        message: format!("failed ({status}): {}", command_line(command)),
        status: status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1),
    })
}

/// Whether a program starts and succeeds; its output is dropped.
pub(crate) fn succeeds(command: &mut Command) -> bool {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

pub(crate) fn cannot_start(command: &Command, error: &std::io::Error) -> Failure {
    Failure::new(format!("cannot start {}: {error}", command_line(command)))
}

/// The command as typed in a shell.
pub(crate) fn command_line(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| quoted(&word.to_string_lossy())).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:=,+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_holds_the_workspace() {
        let manifest = std::fs::read_to_string(workspace_root().join("Cargo.toml")).unwrap();
        assert!(manifest.contains("[workspace]"), "{manifest}");
    }

    #[test]
    fn a_command_line_can_be_typed_again() {
        let mut command = Command::new("viewer");
        command.args(["render", "my model.obj", "it's", "-o", "a/b-c.png", ""]);
        let expected = r"viewer render 'my model.obj' 'it'\''s' -o a/b-c.png ''";
        assert_eq!(command_line(&command), expected);
    }

    #[cfg(unix)]
    #[test]
    fn a_failing_program_hands_on_its_status() {
        let failure = run(Command::new("sh").args(["-c", "exit 101"])).unwrap_err();
        assert_eq!(failure.status, 101, "{}", failure.message);
        assert!(failure.message.ends_with("sh -c 'exit 101'"), "{}", failure.message);
    }
}
