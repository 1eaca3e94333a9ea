//! Progress: a bar with rate and time left on a terminal, plain lines elsewhere.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;

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
            let template = "{msg} {wide_bar} {pos}/{len} {per_sec} {eta} left";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar.set_message(label.to_owned());
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

    /// Takes the bar off the terminal.
    pub(crate) fn end(&self) {
        if let How::Bar(bar) = &self.how {
            bar.finish_and_clear();
        }
    }
}
