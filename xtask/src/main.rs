//! `cargo xtask`: runs the product and the checks of this repository.
//!
//! Thin on purpose: the product is run through cargo, as a process, so that this program builds in
//! a second and never links the engine (docs/ARCHITECTURE.md).
#![forbid(unsafe_code)]

mod commands;
mod run;
mod tidy;

use std::ffi::OsString;
use std::process::ExitCode;

/// What a command line that cannot be understood, or a missing tool, ends with.
const EXIT_USAGE: u8 = 2;

fn main() -> ExitCode {
    let mut args = std::env::args_os().skip(1);
    let Some(command) = args.next() else {
        eprint!("{}", commands::help());
        return ExitCode::from(EXIT_USAGE);
    };
    let rest: Vec<OsString> = args.collect();
    match commands::dispatch(&command.to_string_lossy(), rest) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::from(EXIT_USAGE)
        }
    }
}
