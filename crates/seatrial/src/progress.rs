//! Progress: a bar with rate and time left on a terminal, plain lines elsewhere.

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// Below this many columns the numbers take the room of the bar and of the planner's name.
const BAR_COLUMNS_MIN: usize = 64;
/// How often the time left is drawn again while nothing is reported.
const TICK_EVERY: Duration = Duration::from_millis(500);

/// Told of encounters that are done.
pub(crate) struct Progress {
    total: u64,
    how: How,
}

enum How {
    Silent,
    Bar(ProgressBar),
    Lines(Mutex<Lines>),
}

struct Lines {
    done: u64,
    tenths_told: u64,
}

impl Progress {
    /// For `total` encounters of one planner.
    pub(crate) fn new(label: &str, total: u64, quiet: bool) -> Self {
        let how = if quiet {
            How::Silent
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(total);
            if let Ok(style) = ProgressStyle::with_template(template(terminal_columns())) {
                let rate = |state: &ProgressState, text: &mut dyn Write| {
                    // a number that cannot be written is one that nobody sees
                    let _ = write!(text, "{:.0}/s", state.per_sec());
                };
                bar.set_style(style.with_key("rate", rate));
            }
            bar.set_message(label.to_owned());
            bar.enable_steady_tick(TICK_EVERY);
            How::Bar(bar)
        } else {
            How::Lines(Mutex::new(Lines { done: 0, tenths_told: 0 }))
        };
        Self { total, how }
    }

    /// That many more are done.
    pub(crate) fn add(&self, encounters: u64) {
        match &self.how {
            How::Silent => {}
            How::Bar(bar) => bar.inc(encounters),
            How::Lines(lines) => {
                let Ok(mut lines) = lines.lock() else { return };
                lines.done += encounters;
                let tenths = (10 * lines.done).checked_div(self.total).unwrap_or(10);
                if tenths > lines.tenths_told {
                    lines.tenths_told = tenths;
                    eprintln!("{} of {} encounters", lines.done, self.total);
                }
            }
        }
    }

    /// That many were done before; they say nothing of the rate.
    pub(crate) fn begin_with(&self, encounters: u64) {
        self.add(encounters);
        if let How::Bar(bar) = &self.how {
            bar.reset_eta();
        }
    }

    /// Takes the bar off the terminal.
    pub(crate) fn end(&self) {
        if let How::Bar(bar) = &self.how {
            bar.finish_and_clear();
        }
    }
}

/// The width of the terminal that the bar is drawn on.
fn terminal_columns() -> usize {
    terminal_size::terminal_size_of(std::io::stderr())
        .map_or(BAR_COLUMNS_MIN, |(width, _)| usize::from(width.0))
}

fn template(columns: usize) -> &'static str {
    if columns < BAR_COLUMNS_MIN {
        "{pos}/{len} {rate} {eta} left"
    } else {
        "{msg} {wide_bar} {pos}/{len} {rate} {eta} left"
    }
}
