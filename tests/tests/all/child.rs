//! Runs programs with a time limit.

use std::ffi::OsStr;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use testkit::locate::program;

/// No file of the corpus may take longer than this, even in a debug build.
pub(crate) const TIME_LIMIT: Duration = Duration::from_secs(20);

/// Runs `command` and returns its exit status and output.
///
/// A program that takes longer than [`TIME_LIMIT`] is ended, and the test fails.
pub(crate) fn run(command: &mut Command) -> Output {
    let shown = format!("{command:?}");
    let mut child = command
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("{shown}: {error}"));
    // Read while waiting: a full pipe would block the program.
    let stdout = child.stdout.take().map(|pipe| thread::spawn(|| read_all(pipe)));
    let stderr = child.stderr.take().map(|pipe| thread::spawn(|| read_all(pipe)));
    let status = wait(&mut child, &shown);
    let bytes = |reader: Option<thread::JoinHandle<Vec<u8>>>| {
        reader.map_or_else(Vec::new, |reader| reader.join().unwrap())
    };
    Output { status, stdout: bytes(stdout), stderr: bytes(stderr) }
}

fn read_all(mut pipe: impl Read) -> Vec<u8> {
    let mut bytes = Vec::new();
    pipe.read_to_end(&mut bytes).unwrap();
    bytes
}

fn wait(child: &mut Child, shown: &str) -> ExitStatus {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status;
        }
        if start.elapsed() > TIME_LIMIT {
            child.kill().unwrap();
            panic!("{shown}: took longer than {TIME_LIMIT:?}");
        }
        thread::sleep(Duration::from_millis(2));
    }
}

/// Runs `edgemesh` with `arguments`.
pub(crate) fn edgemesh<A: AsRef<OsStr>>(arguments: &[A]) -> Output {
    run(Command::new(program("edgemesh")).args(arguments).stdout(Stdio::piped()))
}

/// Runs `edgemesh info --json` on `model`.
pub(crate) fn info(model: &Path) -> Output {
    edgemesh(&[OsStr::new("info"), OsStr::new("--json"), model.as_os_str()])
}

/// The standard output of a program as JSON.
pub(crate) fn json(output: &Output) -> Value {
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text).unwrap_or_else(|error| {
        panic!("no JSON on standard output: {error}\n{text}{}", stderr(output))
    })
}

/// The standard error of a program.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Fails unless there is exactly one message, it is an error, and it contains all `parts`.
pub(crate) fn one_error(output: &Output, parts: &[&str]) -> Result<(), String> {
    let text = stderr(output);
    if text.lines().count() != 1 || !text.starts_with("error: ") {
        return Err(format!("not one error message: {text:?}"));
    }
    match parts.iter().find(|part| !text.contains(*part)) {
        Some(part) => Err(format!("{part:?} is not in {text:?}")),
        None => Ok(()),
    }
}
