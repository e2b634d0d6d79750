//! What the commands print on standard error, and how much of it.

use clap::Args;

use crate::report::Report;

/// How much the commands say on standard error.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct MessageOptions {
    /// No warnings
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// More messages; twice for still more
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
}

impl MessageOptions {
    /// Sets up log messages: `RUST_LOG` decides, else these options.
    pub fn start_logging(self) {
        let level = match (self.quiet, self.verbose) {
            (true, _) => "off",
            // What libraries log at this level, they report as errors too.
            (false, 0) => "edgemesh=error,strokes=error,viewer=error",
            (false, 1) => "info",
            (false, _) => "debug",
        };
        let environment = env_logger::Env::default().default_filter_or(level);
        // Fails only where a logger is set already, which then serves as well.
        let _ = env_logger::Builder::from_env(environment).try_init();
    }
}

/// Prints each kind of warning once, with its first place and how many more there are.
#[expect(clippy::print_stderr, reason = "messages go to standard error")]
pub fn print_warnings(model_name: &str, report: &Report) {
    for line in report.warning_lines(model_name, "warning: ") {
        eprintln!("{line}");
    }
}
