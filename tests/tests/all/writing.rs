//! What stands at the path of an output: files, links and pipes; and what signals leave behind.
#![cfg(unix)]

use std::fs;
use std::io::Read as _;
use std::os::unix::fs::{FileTypeExt as _, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use testkit::locate::program;

use crate::child::{edgemesh, stderr};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder with the model `in.obj` of `faces` triangles; it lasts as long as the first value.
fn folder_with_model(faces: usize) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("in.obj");
    let triangles = (0..faces).map(|face| TRIANGLE.replace("0\nv 1", &format!("{face}\nv 1")));
    let relative = triangles.map(|text| text.replace("1 2 3", "-1 -2 -3"));
    fs::write(&model, relative.collect::<String>()).unwrap();
    (folder, model)
}

fn export(model: &Path, output: &Path) {
    let result = edgemesh(&[
        "export".as_ref(),
        model.as_os_str(),
        "-o".as_ref(),
        output.as_os_str(),
        "--to".as_ref(),
        "obj".as_ref(),
    ]);
    assert_eq!(result.status.code(), Some(0), "{}", stderr(&result));
    assert!(result.stdout.is_empty() && result.stderr.is_empty(), "{result:?}");
}

/// A pipe is written to and stays, also behind a link.
#[test]
fn a_pipe_is_written_to() {
    let (folder, model) = folder_with_model(1);
    let path = |name: &str| folder.path().join(name);
    export(&model, &path("plain.obj"));
    let expected = fs::read(path("plain.obj")).unwrap();
    let made = Command::new("mkfifo").arg(path("pipe")).status().unwrap();
    assert!(made.success(), "mkfifo");
    symlink("pipe", path("link")).unwrap();
    for name in ["pipe", "link"] {
        let read_end = path("pipe");
        let reader = std::thread::spawn(move || {
            let mut bytes = Vec::new();
            fs::File::open(read_end).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        });
        export(&model, &path(name));
        assert_eq!(reader.join().unwrap(), expected, "{name}");
        assert!(fs::symlink_metadata(path("pipe")).unwrap().file_type().is_fifo(), "{name}");
    }
}

/// Two commands that share standard output, one by its name, write one after the other.
#[test]
fn standard_output_has_a_name() {
    let (folder, model) = folder_with_model(1);
    let name = folder.path().join("out");
    symlink("/proc/self/fd/1", &name).unwrap();
    let script = r#""$0" export "$1" -o "$2" --to obj && "$0" export "$1" -o - --to obj"#;
    let both = folder.path().join("both");
    let mut command = Command::new("sh");
    command.args(["-c", script]).arg(program("edgemesh")).arg(&model).arg(&name);
    let status = command.stdout(fs::File::create(&both).unwrap()).status().unwrap();
    assert!(status.success(), "{status}");
    let text = fs::read_to_string(&both).unwrap();
    let (first, second) = text.split_at(text.len() / 2);
    assert!(first == second && first.contains("\nf "), "{text}");
}

/// The hidden files in a folder.
fn hidden(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    entries.filter(|name| name.as_encoded_bytes().starts_with(b".")).count()
}

/// Sends `signal` to an export as soon as its temporary file is there. `None` if the export ended
/// before it arrived.
fn interrupted(model: &Path, output: &Path, signal: &str) -> Option<ExitStatus> {
    let mut command = Command::new(program("edgemesh"));
    command.arg("export").arg(model).arg("-o").arg(output).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    let folder = output.parent().unwrap();
    let start = Instant::now();
    while hidden(folder) == 0 {
        if child.try_wait().unwrap().is_some() {
            return None;
        }
        assert!(start.elapsed() < Duration::from_secs(20), "no temporary file");
        std::thread::sleep(Duration::from_micros(100));
    }
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    let status = child.wait().unwrap();
    Some(status).filter(|status| sent.success() && status.code() != Some(0))
}

/// The model is so large that its file takes some milliseconds to write; a signal that comes too
/// late is sent again to another run.
#[test]
fn signals_leave_no_temporary_file() {
    use std::os::unix::process::ExitStatusExt as _;
    let (folder, model) = folder_with_model(100_000);
    let output = folder.path().join("out.json");
    for (signal, code) in [("-INT", Some(130)), ("-TERM", Some(143)), ("-KILL", None)] {
        let mut tries = (0..20).filter_map(|_| interrupted(&model, &output, signal));
        let status = tries.next().unwrap_or_else(|| panic!("{signal}: always too late"));
        assert_eq!(status.code(), code, "{signal}");
        assert_eq!(status.signal(), code.is_none().then_some(9), "{signal}");
        assert_eq!(hidden(folder.path()), usize::from(code.is_none()), "{signal}");
    }
    export(&folder_with_model(1).1, &output);
    assert_eq!(hidden(folder.path()), 0, "the next run removes what a kill left");
}
