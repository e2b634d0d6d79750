//! The `viewer` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    viewer::command::main()
}
