//! `cargo xtask test`: runs every test, including those that need an adapter and the two
//! commands, and each bench once, so that none breaks unnoticed.

use std::process::Command;

use crate::adapter;
use crate::failure::Failure;
use crate::programs::{self, Programs};

/// Turns on backtraces of libraries; where it is not set, `RUST_BACKTRACE` does.
const LIBRARY_BACKTRACES: &str = "RUST_LIB_BACKTRACE";

/// Runs the tests. With `args`, which go to the test programs, runs only `cargo test` and
/// no bench.
pub(crate) fn run(args: &[&str]) -> Result<(), Failure> {
    let programs = programs::build()?;
    adapter::ensure(&programs.viewer)?;
    if !args.is_empty() {
        programs::run(call(&programs, &["test"])?.arg("--").args(args))?;
        eprintln!("xtask: skipped the benches, as there are arguments");
        return Ok(());
    }
    let has_nextest = programs::succeeds(programs::cargo().args(["nextest", "--version"]));
    for task in tasks(has_nextest) {
        programs::run(&mut call(&programs, task)?)?;
    }
    Ok(())
}

/// The calls of cargo that run everything. cargo-nextest runs the tests of all programs at
/// once, and no doctests.
fn tasks(has_nextest: bool) -> &'static [&'static [&'static str]] {
    if has_nextest {
        &[&["nextest", "run"], &["test", "--doc"], &["test", "--benches"]]
    } else {
        &[&["test"], &["test", "--benches"]]
    }
}

/// A call of cargo for the whole workspace, all with the same features, so that nothing is
/// built twice.
fn call(programs: &Programs, task: &[&str]) -> Result<Command, Failure> {
    let mut command = programs::cargo();
    command.args(task).args(["--workspace", "--features", "testkit/gpu"]);
    command.env("TESTKIT_BIN", &programs.folder);
    command.env("TESTKIT_ROOT", programs::workspace_root().join("tests"));
    // With RUST_BACKTRACE alone, wgpu records a backtrace at each of its locks: an eighth of
    // the time of the GPU tests. Panics still print theirs.
    if std::env::var_os(LIBRARY_BACKTRACES).is_none() {
        command.env(LIBRARY_BACKTRACES, "0");
    }
    adapter::use_vulkan(&mut command)?;
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doctests_and_benches_run_with_and_without_nextest() {
        assert!(tasks(true).contains(&&["nextest", "run"][..]));
        assert!(tasks(true).contains(&&["test", "--doc"][..]), "nextest runs none");
        assert!(tasks(false).contains(&&["test"][..]), "which runs doctests too");
        for has_nextest in [true, false] {
            assert!(tasks(has_nextest).contains(&&["test", "--benches"][..]));
        }
    }
}
