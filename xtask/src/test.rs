//! `cargo xtask test`: every test, also those that need an adapter and the two
//! commands, and one turn of every bench so that none of them rots.

use std::process::Command;

use crate::failure::Failure;
use crate::programs::Programs;
use crate::{adapter, programs};

/// Runs the tests; `args` go to the test programs. Who gives some wants to see
/// certain tests only, so the benches are left out then.
pub(crate) fn run(args: &[&str]) -> Result<(), Failure> {
    let programs = programs::build()?;
    adapter::ensure(&programs.viewer)?;
    let mut tests = cargo_test(&programs, &[])?;
    if args.is_empty() {
        programs::run(&mut tests)?;
        return programs::run(&mut cargo_test(&programs, &["--benches"])?);
    }
    programs::run(tests.arg("--").args(args))?;
    eprintln!("xtask: the benches were left out, as arguments were given");
    Ok(())
}

fn cargo_test(programs: &Programs, targets: &[&str]) -> Result<Command, Failure> {
    let mut command = programs::cargo();
    command.args(["test", "--workspace"]).args(targets).args(["--features", "testkit/gpu"]);
    command.env("TESTKIT_BIN", &programs.folder);
    command.env("TESTKIT_ROOT", programs::workspace_root().join("tests"));
    adapter::use_vulkan(&mut command)?;
    Ok(command)
}
