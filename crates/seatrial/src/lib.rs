//! The command line, as a library of one function: [`main_with`].
//!
//! Somebody outside this repository adds planners of their own with a `main` of a few lines:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     seatrial::main_with(planners::registry())
//! }
//! ```
#![forbid(unsafe_code)]
// `say!` survives a reader that leaves early
#![deny(clippy::print_stdout)]

mod build;
mod cli;
mod cli_gate;
mod commands;
mod embedded;
mod exit;
mod files;
mod headline;
mod manifest;
mod obstacles;
mod progress;
mod rendering;
mod say;
mod stored;
mod sweep;
mod timing;

use clap::Parser;
use planner_api::Registry;
use std::io::ErrorKind;
use std::process::ExitCode;

/// Runs the command line with these planners.
#[must_use]
pub fn main_with(registry: Registry) -> ExitCode {
    let cli = match cli::Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // help and version are no errors; a reader that closed the pipe is none either
            let cut = matches!(error.print(), Err(e) if e.kind() != ErrorKind::BrokenPipe);
            return ExitCode::from(match error.use_stderr() {
                true => exit::USAGE,
                false if cut => exit::INCOMPLETE,
                false => exit::DONE,
            });
        }
    };
    exit::code(commands::run(cli.command, registry))
}
