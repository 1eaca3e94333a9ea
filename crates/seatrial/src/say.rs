//! What goes to standard output.
//!
//! A reader may close the pipe early (`seatrial planners | head -1`). The standard macros panic
//! then; a campaign should go on to its end, since its result is the files. So what nobody reads
//! is dropped; any other failure, such as a full disk behind a redirection, is told once, and the
//! command ends as incomplete.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

static CUT: AtomicBool = AtomicBool::new(false);

/// Whether something that was printed did not arrive, for another reason than a reader who left.
pub(crate) fn was_cut() -> bool {
    CUT.load(Ordering::Relaxed)
}

/// Prints a line; use [`say!`].
pub(crate) fn line(text: Arguments<'_>) {
    to(&mut io::stdout().lock(), text, "\n");
}

/// Prints text that ends its own lines; use [`say_text!`].
pub(crate) fn text(text: Arguments<'_>) {
    to(&mut io::stdout().lock(), text, "");
}

fn to(out: &mut dyn Write, text: Arguments<'_>, end: &str) {
    match out.write_fmt(text).and_then(|()| out.write_all(end.as_bytes())) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            if CUT.swap(true, Ordering::Relaxed) {
                return;
            }
            // the terminal may be gone too, and there is nobody left to tell
            drop(writeln!(io::stderr(), "seatrial: standard output was cut: {error}"));
        }
        _ => {}
    }
}

/// `println!` for a reader who may leave early.
macro_rules! say {
    () => { $crate::say::line(format_args!("")) };
    ($($arg:tt)*) => { $crate::say::line(format_args!($($arg)*)) };
}

/// `print!` for a reader who may leave early.
macro_rules! say_text {
    ($($arg:tt)*) => { $crate::say::text(format_args!($($arg)*)) };
}

pub(crate) use {say, say_text};
