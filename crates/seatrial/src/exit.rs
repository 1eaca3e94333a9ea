//! Exit codes, a contract with scripts.

use campaign::Error;
use std::process::ExitCode;

/// Done; collisions found are a result, not an error.
pub(crate) const DONE: u8 = 0;
/// A check or a comparison that was asked for has failed.
pub(crate) const FAILED: u8 = 1;
/// Usage, campaign or input error.
pub(crate) const USAGE: u8 = 2;
/// Inconclusive or incomplete, also after Ctrl-C.
pub(crate) const INCOMPLETE: u8 = 3;
/// The bench itself is at fault.
pub(crate) const HARNESS: u8 = 4;

/// What a command ends with when nothing went wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ended {
    /// Done.
    Done,
    /// A check that was asked for has failed.
    Failed,
    /// Neither shown nor refuted.
    Inconclusive,
}

/// The exit code of a command; an error is printed.
pub(crate) fn code(ended: Result<Ended, Error>) -> ExitCode {
    ExitCode::from(match ended {
        Ok(Ended::Done) => DONE,
        Ok(Ended::Failed) => FAILED,
        Ok(Ended::Inconclusive) => INCOMPLETE,
        Err(error) => {
            eprintln!("seatrial: {error}");
            match error {
                Error::Input(_) => USAGE,
                Error::Incomplete(_) => INCOMPLETE,
                Error::Io { .. } | Error::Fault(_) => HARNESS,
            }
        }
    })
}
