//! The paths of the tests' own data, of the programs under test, and of the models and
//! files that are not part of the repository.

use std::env;
use std::path::{Path, PathBuf};

/// The folder of this package, with the goldens: `TESTKIT_ROOT`, or else the folder
/// that the package was built in.
#[must_use]
pub fn tests_root() -> PathBuf {
    env::var_os("TESTKIT_ROOT").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from)
}

/// The folder of the workspace.
#[must_use]
pub fn workspace_root() -> PathBuf {
    let root = tests_root();
    root.parent().map_or_else(|| root.join(".."), PathBuf::from)
}

/// The program `name`, `edgemesh` or `viewer`: in `TESTKIT_BIN`, or else in the
/// workspace's `target/debug`.
///
/// # Panics
/// If it has not been built; the message says how to build it.
#[must_use]
pub fn program(name: &str) -> PathBuf {
    built(Path::new(""), name)
}

/// The example `name` of any crate, in the folder `examples` beside the programs.
///
/// # Panics
/// If it has not been built; the message says how to build it.
#[must_use]
pub fn example(name: &str) -> PathBuf {
    built(Path::new("examples"), name)
}

fn built(below: &Path, name: &str) -> PathBuf {
    let folder = env::var_os("TESTKIT_BIN")
        .map_or_else(|| workspace_root().join("target").join("debug"), PathBuf::from);
    let path = folder.join(below).join(format!("{name}{}", env::consts::EXE_SUFFIX));
    assert!(
        path.is_file(),
        "{}: no such program; build it with `cargo build --workspace --bins --examples`, or run \
         all tests with `cargo xtask test`, or set TESTKIT_BIN to its folder",
        path.display()
    );
    path
}

/// The folder of shared models and files: `EDGEMESH_SHARED`, or else `../shared`
/// beside the workspace; `None` if there is no such folder.
#[must_use]
pub fn shared() -> Option<PathBuf> {
    let folder = env::var_os("EDGEMESH_SHARED")
        .map_or_else(|| workspace_root().join("..").join("shared"), PathBuf::from);
    folder.is_dir().then_some(folder)
}

/// Reports on standard error that `count` cases of `what` were skipped because there is
/// no [`shared`] folder.
pub fn left_out(what: &str, count: usize) {
    eprintln!("skipped {count} cases of {what}: set EDGEMESH_SHARED to the folder of shared files");
}
