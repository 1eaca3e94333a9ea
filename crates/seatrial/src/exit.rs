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
        Ok(Ended::Done) if crate::say::was_cut() => INCOMPLETE,
        Ok(Ended::Done) => DONE,
        Ok(Ended::Failed) => FAILED,
        Ok(Ended::Inconclusive) => INCOMPLETE,
        Err(error) => {
            eprintln!("seatrial: {error}");
            of_error(&error)
        }
    })
}

/// A full disk leaves a result that can be taken up again; a place that cannot be written to is the
/// user's to change.
fn of_error(error: &Error) -> u8 {
    match error {
        Error::Input(_) => USAGE,
        Error::Incomplete(_) => INCOMPLETE,
        Error::Io { .. } | Error::Stage { .. } if error.is_no_room() => INCOMPLETE,
        Error::Io { .. } | Error::Stage { .. } if error.is_wrong_place() => USAGE,
        Error::Io { .. } | Error::Stage { .. } | Error::Fault(_) => HARNESS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;
    use std::path::Path;

    #[test]
    fn the_code_of_a_failed_write_says_whose_fault_it_is() {
        for (errno, expected) in [
            (28, INCOMPLETE),  // ENOSPC
            (122, INCOMPLETE), // EDQUOT
            (27, INCOMPLETE),  // EFBIG
            (30, USAGE),       // EROFS
            (13, USAGE),       // EACCES
            (20, USAGE),       // ENOTDIR
            (5, HARNESS),      // EIO
        ] {
            let of_file = Error::io("write", Path::new("a"))(io::Error::from_raw_os_error(errno));
            assert_eq!(of_error(&of_file), expected, "{of_file}");
            let of_stage = Error::stage(io::Error::from_raw_os_error(errno));
            assert_eq!(of_error(&of_stage), expected, "{of_stage}");
            assert_eq!(of_error(&of_stage.kept_in(Path::new("b"), "go on")), expected);
        }
    }
}
