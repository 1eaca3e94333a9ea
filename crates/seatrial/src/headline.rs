//! The table of headline figures, for a terminal of any width.

use record::Status;
use std::fmt::Write;
use summary::{BoundedRate, Summary};

/// From this width on the table has columns; below it each stratum gets lines of its own.
const COLUMNS_MIN: usize = 96;

/// The width of the terminal, or a page's where there is none.
pub(crate) fn terminal_columns() -> usize {
    terminal_size::terminal_size().map_or(100, |(width, _)| usize::from(width.0))
}

/// The headline figures of a result.
pub(crate) fn table(summary: &Summary, columns: usize) -> String {
    if columns >= COLUMNS_MIN { wide(summary) } else { narrow(summary) }
}

/// What must be said beside a root digest that holds runs which the wall clock ended.
pub(crate) fn wall_clock(ended: u64) -> Option<String> {
    let many = (ended > 0).then_some(if ended == 1 { "run was" } else { "runs were" });
    many.map(|many| {
        format!(
            "{ended} {many} ended by a limit on the wall clock: a faster machine might not end \
             them, and its digest would then be another"
        )
    })
}

fn wide(summary: &Summary) -> String {
    let name = summary.strata.iter().map(|s| s.name.len()).max().unwrap_or(0).max(7);
    let mut text = format!(
        "{:name$} {:>8}  {:26} {:26} {:>9} {:>10} {:>9}\n",
        "stratum",
        "n",
        "collision [95 %]",
        "radius broken [95 %]",
        "turn fail",
        "react p50",
        "CPA p01",
    );
    for s in &summary.strata {
        let fails = s.turn_direction.get(&Status::Fail).copied().unwrap_or(0);
        writeln!(
            text,
            "{:name$} {:>8}  {:26} {:26} {fails:>9} {:>10} {:>9}",
            s.name,
            s.n,
            rate(&s.collision),
            rate(&s.safety_radius),
            seconds(s.reaction_time_s.median),
            metres(s.min_cpa_m.p01),
        )
        .expect("writing to a string");
    }
    text
}

fn narrow(summary: &Summary) -> String {
    let mut text = String::new();
    for s in &summary.strata {
        let fails = s.turn_direction.get(&Status::Fail).copied().unwrap_or(0);
        write!(
            text,
            "{} (n = {})\n  collision {}\n  radius    {}\n  turn fail {fails}\n  \
             reaction  {}\n  CPA p01   {}\n",
            s.name,
            s.n,
            rate(&s.collision),
            rate(&s.safety_radius),
            seconds(s.reaction_time_s.median),
            metres(s.min_cpa_m.p01),
        )
        .expect("writing to a string");
    }
    text
}

fn rate(rate: &BoundedRate) -> String {
    let short = |value: f64| {
        if value <= 0.0 {
            "0".to_owned()
        } else if value >= 0.001 {
            format!("{value:.4}")
        } else {
            format!("{value:.1e}")
        }
    };
    let shown = rate.rate.map_or("-".to_owned(), short);
    format!("{shown} [{}, {}]", short(rate.lower_95), short(rate.upper_95))
}

fn seconds(value: Option<f64>) -> String {
    value.map_or("never".to_owned(), |s| format!("{s:.1} s"))
}

fn metres(value: Option<f64>) -> String {
    value.map_or("unknown".to_owned(), |m| format!("{m:.1} m"))
}
