//! The verdict for a terminal and for the summary page of a CI job.

use crate::GateReport;
use stats::{Forecast, GateVerdict, Harmed, LayerVerdict, MetricResult};
use std::fmt::Write;

/// New failures that are shown.
pub const SHOWN: usize = 3;

/// One word for a verdict.
pub const fn word(verdict: GateVerdict) -> &'static str {
    match verdict {
        GateVerdict::Pass => "PASS",
        GateVerdict::Fail => "FAIL",
        GateVerdict::Inconclusive => "INCONCLUSIVE",
    }
}

/// One word for a layer.
pub const fn layer_word(verdict: LayerVerdict) -> &'static str {
    match verdict {
        LayerVerdict::Pass => "pass",
        LayerVerdict::Fail => "FAIL",
        LayerVerdict::Inconclusive => "inconclusive",
        LayerVerdict::NotAsked => "not asked",
    }
}

/// What a metric says, in one or two words.
pub fn metric_word(metric: &MetricResult) -> String {
    match (metric.harmed, metric.passed_at) {
        (Some(Harmed::Alone), _) => "WORSE".to_owned(),
        (Some(Harmed::Joint), _) => "worse (joint)".to_owned(),
        (None, Some(_)) if metric.worse_within_margin => "worse within the margin".to_owned(),
        (None, Some(at)) => format!("ok at {at}"),
        (None, None) => match metric.forecast {
            Forecast::Reached => "ok".to_owned(),
            Forecast::Encounters(more) => format!("open, about {more} more pairs"),
            Forecast::CannotPass => "cannot pass at these rates".to_owned(),
        },
    }
}

/// Pairs of which both outcomes are known. The tests count the undetermined ones besides: as breaks
/// for a PASS, as fixes for a FAIL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Certain {
    /// Both had the event; one of which only the other outcome is certain may be among them.
    pub both: u64,
    /// Only the candidate had it.
    pub breaks: u64,
    /// Only the baseline had it.
    pub fixes: u64,
}

impl Certain {
    /// Of a metric.
    pub fn of(metric: &MetricResult) -> Self {
        let (pass, fail) = (&metric.counts_pass, &metric.counts_fail);
        let both = fail.n11.min(pass.n11);
        Self { both, breaks: fail.n10, fixes: pass.n01 }
    }
}

/// The command that shows a new failure; `folder` is where `gate.json` lies.
pub fn replay_command(folder: &str, encounter: &record::EncounterId) -> String {
    format!("cargo xtask gate --replay {encounter} --out {folder}")
}

/// One line for a case of the corpus.
pub fn case_line(case: &crate::corpus::Case) -> String {
    let does: Vec<&str> = case.found.events.iter().map(|event| event.name()).collect();
    format!("{}: {} does {}", case.name, case.found.planner, does.join(", "))
}

/// The confidence of a sequence at the level of this attempt: attempt 2 has half of the first's.
fn confidence(alpha: f64) -> String {
    let percent = format!("{:.3}", 100.0 * (1.0 - alpha));
    format!("{} %", percent.trim_end_matches('0').trim_end_matches('.'))
}

/// The verdict on one screen.
pub fn terminal(report: &GateReport, folder: &str) -> String {
    let result = &report.result;
    let mut text = String::new();
    let mut line = |words: String| {
        text.push_str(words.trim_end());
        text.push('\n');
    };
    line(format!(
        "gate: {}   {} against {}",
        word(report.verdict),
        report.candidate.asked,
        report.baseline.asked
    ));
    line(format!(
        "  {} pairs of at most {}, {} looks; {} runs differ; attempt {} of `{}`, passes at {}",
        result.pairs,
        result.cap,
        result.looks,
        report.different,
        result.attempt,
        report.series,
        result.alpha_pass
    ));
    line(format!(
        "  corpus {} ({} cases), comparison {}, absolute {}, ratchet {}",
        layer_word(result.corpus),
        report.corpus.cases,
        layer_word(result.comparison),
        layer_word(result.absolute),
        layer_word(result.ratchet)
    ));
    for broken in &report.corpus.broken {
        let waived =
            broken.waived.as_ref().map_or(String::new(), |why| format!(" (waived: {why})"));
        line(format!("  corpus: {} is newly broken{waived}", broken.name));
    }
    line(format!(
        "  {:16} {:>7} {:>7} {:>7} {:>7}  {:25} {}",
        "metric",
        "both",
        "breaks",
        "fixes",
        "unknown",
        format!("difference [{} conf. seq.]", confidence(result.alpha_pass)),
        "verdict"
    ));
    for metric in &result.metrics {
        let Certain { both, breaks, fixes } = Certain::of(metric);
        line(format!(
            "  {:16} {both:>7} {breaks:>7} {fixes:>7} {:>7}  {:+.1e} [{:+.1e}, {:+.1e}]   {}",
            metric.name,
            metric.undetermined,
            metric.difference.value,
            metric.difference.lower,
            metric.difference.upper,
            metric_word(metric)
        ));
    }
    for absolute in result.absolutes.iter().filter(|a| a.verdict != LayerVerdict::Pass) {
        line(format!(
            "  absolute {}: {} of {} encounters, {}",
            absolute.name,
            absolute.events_demonstrated,
            absolute.n,
            match absolute.verdict {
                LayerVerdict::Fail => "VIOLATED",
                _ => "not demonstrated",
            }
        ));
    }
    for arm in result.ratchets.iter().filter(|arm| arm.passed_at.is_none()) {
        line(format!("  ratchet {} / {}: not shown", arm.arm, arm.metric));
    }
    if let Some(sentence) = report.ended_by_wall_clock.sentence() {
        line(format!("  {sentence}"));
    }
    if !report.new_failures.is_empty() {
        line("  worst new failures, each with the command that replays it:".to_owned());
    }
    for failure in report.new_failures.iter().take(SHOWN) {
        line(format!("    {}", failure.sentence()));
        line(format!("      {}", replay_command(folder, &failure.encounter)));
    }
    line(format!("  result: {folder}/gate.json, {folder}/junit.xml, {folder}/summary.md"));
    text
}

/// The verdict for the page of a CI job.
pub fn markdown(report: &GateReport, folder: &str) -> String {
    let result = &report.result;
    let mut text = String::new();
    let out = &mut text;
    let mut put = |line: String| writeln!(out, "{line}").expect("writing to a string");
    put(format!("## Planner gate: {}\n", word(report.verdict)));
    put(format!(
        "`{}` against `{}` on {} fresh pairs (cap {}, attempt {} of `{}`, passes at {}, blocks a \
         change that is no worse in at most {:.1} %).\n",
        report.candidate.asked,
        report.baseline.asked,
        result.pairs,
        result.cap,
        result.attempt,
        report.series,
        result.alpha_pass,
        100.0 * report.false_alarm_budget
    ));
    put("| layer | answer |\n|---|---|".to_owned());
    for (name, layer) in [
        ("corpus", result.corpus),
        ("comparison with the baseline", result.comparison),
        ("absolute requirements", result.absolute),
        ("release and anchor", result.ratchet),
    ] {
        put(format!("| {name} | {} |", layer_word(layer)));
    }
    put(format!(
        "\n| metric | both | breaks | fixes | undetermined | difference ({} confidence sequence) | \
         answer |\n|---|---|---|---|---|---|---|",
        confidence(result.alpha_pass)
    ));
    for metric in &result.metrics {
        let Certain { both, breaks, fixes } = Certain::of(metric);
        put(format!(
            "| {} | {both} | {breaks} | {fixes} | {} | {:+.1e} [{:+.1e}, {:+.1e}] | {} |",
            metric.name,
            metric.undetermined,
            metric.difference.value,
            metric.difference.lower,
            metric.difference.upper,
            metric_word(metric)
        ));
    }
    if let Some(sentence) = report.ended_by_wall_clock.sentence() {
        put(format!("\n**{sentence}.**"));
    }
    if !report.new_failures.is_empty() {
        put("\nWorst new failures:\n".to_owned());
    }
    for failure in report.new_failures.iter().take(SHOWN) {
        let command = replay_command(folder, &failure.encounter);
        put(format!("* {}: `{command}`", failure.sentence()));
    }
    put(format!("\nSeed {} of key `{}`.", report.key.seed(), report.key));
    text
}

/// What the plan needs, said before the run.
pub fn expectation(feasibility: &stats::Feasibility) -> String {
    let hardest = feasibility.needs.iter().max_by_key(|need| need.pairs_min);
    let longest =
        feasibility.needs.iter().max_by_key(|need| need.pairs_expected.unwrap_or(u64::MAX));
    let mut text = String::new();
    if let Some(need) = hardest {
        write!(text, "needs at least {} pairs ({})", need.pairs_min, need.name)
            .expect("writing to a string");
    }
    match longest.map(|need| (need.pairs_expected, &need.name)) {
        Some((Some(pairs), name)) if pairs <= feasibility.cap => {
            write!(text, "; a neutral change is expected to pass after about {pairs} ({name})")
        }
        Some((Some(pairs), name)) => write!(
            text,
            "; a neutral change is expected to need {pairs} ({name}), over the cap of {}: expect \
             INCONCLUSIVE unless the planners differ less than planned",
            feasibility.cap
        ),
        Some((None, name)) => {
            write!(text, "; at the planned rates a neutral change does not pass ({name})")
        }
        None => Ok(()),
    }
    .expect("writing to a string");
    text
}

#[cfg(test)]
mod tests {
    use super::confidence;

    #[test]
    fn the_confidence_is_that_of_the_attempt() {
        assert_eq!(confidence(0.05), "95 %");
        assert_eq!(confidence(0.025), "97.5 %");
        assert_eq!(confidence(0.003_125), "99.688 %");
    }
}
