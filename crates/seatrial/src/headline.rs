//! The table of headline figures, for a terminal of any width.

use record::{Outcome, Status};
use std::fmt::Write;
use summary::{BoundedRate, StratumSummary, Summary};

/// From this width on the table has columns; below it each stratum gets lines of its own.
const COLUMNS_MIN: usize = 96;

/// The width of the terminal, or a page's where there is none.
pub(crate) fn terminal_columns() -> usize {
    terminal_size::terminal_size().map_or(100, |(width, _)| usize::from(width.0))
}

/// The headline figures of a result.
pub(crate) fn table(summary: &Summary, columns: usize) -> String {
    let mut text = if columns >= COLUMNS_MIN { wide(summary) } else { narrow(summary) };
    if summary.strata.iter().any(|stratum| stratum.weighted.is_some()) {
        text.push_str(WEIGHTED);
    }
    text
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

/// What must be said beside rates of a planner that did not answer: such a run is no collision.
pub(crate) fn planner_failures(summary: &Summary) -> Option<String> {
    let of = |outcome: Outcome| -> u64 {
        summary.strata.iter().filter_map(|s| s.outcomes.get(&outcome)).sum()
    };
    let kinds = Outcome::ALL.into_iter().filter(|outcome| outcome.is_planner_failure());
    let kinds: Vec<(Outcome, u64)> =
        kinds.map(|outcome| (outcome, of(outcome))).filter(|(_, k)| *k > 0).collect();
    let failed: u64 = kinds.iter().map(|(_, k)| k).sum();
    let words: Vec<String> = kinds.iter().map(|(o, k)| format!("{k} {}", o.name())).collect();
    (failed > 0).then(|| {
        format!(
            "the planner failed in {failed} of {} runs ({}); they count as failures in the upper \
             bounds alone",
            summary.encounters,
            words.join(", ")
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
            rates(s)[0],
            rates(s)[1],
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
            rates(s)[0],
            rates(s)[1],
            seconds(s.reaction_time_s.median),
            metres(s.min_cpa_m.p01),
        )
        .expect("writing to a string");
    }
    text
}

/// Under the table of a weighted campaign.
const WEIGHTED: &str = "rates are weighted, bounds are betting bounds, which hold for weights; -: \
                        too few events for a rate\nturn failures, reactions and distances are of \
                        the draws\n";

/// Collision, and safety radius broken: of the population where encounters carry weights.
fn rates(stratum: &StratumSummary) -> [String; 2] {
    let plain = |rate: &BoundedRate| rate_text(rate.rate, rate.lower_95, rate.upper_95);
    match &stratum.weighted {
        None => [plain(&stratum.collision), plain(&stratum.safety_radius)],
        Some(weighted) => [&weighted.collision, &weighted.safety_radius]
            .map(|rate| rate_text(rate.rate, rate.lower_95, rate.upper_95)),
    }
}

fn rate_text(rate: Option<f64>, lower_95: f64, upper_95: f64) -> String {
    let short = |value: f64| {
        if value <= 0.0 {
            "0".to_owned()
        } else if value >= 0.001 {
            format!("{value:.4}")
        } else {
            format!("{value:.1e}")
        }
    };
    let shown = rate.map_or("-".to_owned(), short);
    format!("{shown} [{}, {}]", short(lower_95), short(upper_95))
}

fn seconds(value: Option<f64>) -> String {
    value.map_or("never".to_owned(), |s| format!("{s:.1} s"))
}

fn metres(value: Option<f64>) -> String {
    value.map_or("unknown".to_owned(), |m| format!("{m:.1} m"))
}
