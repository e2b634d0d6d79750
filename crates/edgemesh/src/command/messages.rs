//! Messages of the commands on standard error.

use clap::Args;

use super::failure::Failure;
use crate::report::Report;

/// Options for messages on standard error.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct MessageOptions {
    /// Print no warnings
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Print more messages; repeat for even more
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
}

impl MessageOptions {
    /// Starts logging at the level of `RUST_LOG`, or else of these options.
    pub fn start_logging(self) {
        let level = match (self.quiet, self.verbose) {
            (true, _) => "off",
            // Other libraries are left out: they also return what they log at this level.
            (false, 0) => "edgemesh=error,strokes=error,viewer=error",
            (false, 1) => "info",
            (false, _) => "debug",
        };
        let environment = env_logger::Env::default().default_filter_or(level);
        // Fails only if a logger is already set, which then serves as well.
        let _ = env_logger::Builder::from_env(environment).try_init();
    }
}

/// Prints the message of a failure, if it has one.
#[expect(clippy::print_stderr, reason = "messages go to standard error")]
pub(super) fn print_error(failure: &Failure) {
    if !failure.message.is_empty() {
        eprintln!("error: {}", failure.message);
    }
}

/// Prints each kind of warning once, with its first place and the number of further ones.
#[expect(clippy::print_stderr, reason = "messages go to standard error")]
pub fn print_warnings(model_name: &str, report: &Report) {
    for line in report.warning_lines(model_name, "warning: ") {
        eprintln!("{line}");
    }
}
