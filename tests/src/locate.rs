//! Where things are: the tests' own data, the programs under test, and the
//! models and corpus that are shared between projects and not kept here.

use std::env;
use std::path::{Path, PathBuf};

/// The folder of this package, which holds the goldens: `TESTKIT_ROOT`, else
/// where the package was built.
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

/// The program `name`, `edgemesh` or `viewer`: in `TESTKIT_BIN`, else in the
/// workspace's `target/debug`.
///
/// # Panics
/// Where it has not been built; the message says how to.
#[must_use]
pub fn program(name: &str) -> PathBuf {
    built(Path::new(""), name)
}

/// The example `name` of any crate, in the folder `examples` beside the programs.
///
/// # Panics
/// Where it has not been built; the message says how to.
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

/// The folder of shared models and files: `EDGEMESH_SHARED`, else `../shared`
/// beside the workspace; `None` where there is no such folder.
#[must_use]
pub fn shared() -> Option<PathBuf> {
    let folder = env::var_os("EDGEMESH_SHARED")
        .map_or_else(|| workspace_root().join("..").join("shared"), PathBuf::from);
    folder.is_dir().then_some(folder)
}

/// Says on standard error that `count` cases of `what` were left out, because
/// there is no [`shared`] folder.
pub fn left_out(what: &str, count: usize) {
    eprintln!("left out {count} cases of {what}: set EDGEMESH_SHARED to the shared files");
}
