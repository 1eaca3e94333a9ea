//! The sentences of the first screen: what was found, and what is not claimed.

use crate::group::Group;
use crate::input::ReportInput;
use crate::number::{count, per_cent};
use crate::page::bounds;
use crate::weighted;
use record::{Check, Status};
use serde::Serialize;
use summary::{AvoidableRates, BoundedRate, StratumSummary};

/// The line of a page that stands beside others; a page alone, as in a pack, is without it.
pub const BESIDE: &str = concat!(
    "<p class=\"sub\"><a href=\"../comparison.html\">",
    "All planners of this run side by side</a></p>\n"
);

/// What was found, in sentences.
#[derive(Serialize)]
pub(crate) struct Verdict {
    /// `bad`, `warn`, `good` or `none`.
    pub(crate) tone: &'static str,
    pub(crate) sentences: Vec<String>,
}

/// One encounter, several encounters.
pub(crate) fn encounters(n: u64) -> String {
    format!("{} encounter{}", count(n), if n == 1 { "" } else { "s" })
}

pub(crate) fn verdict(whole: &StratumSummary) -> Verdict {
    let (collisions, broken, n) = (whole.collision.k, whole.safety_radius.k, whole.n);
    if n == 0 {
        return Verdict { tone: "none", sentences: vec!["No encounter was run.".to_owned()] };
    }
    let mut sentences = Vec::new();
    let failed = failed_checks(whole);
    let tone = if collisions > 0 {
        sentences.push(format!("{} of {} ended in a collision.", count(collisions), encounters(n)));
        sentences.push(format!("The safety radius was broken in {}.", encounters(broken)));
        "bad"
    } else if broken > 0 {
        sentences.push(format!(
            "No collision in {}; the safety radius was broken in {}.",
            encounters(n),
            count(broken)
        ));
        "warn"
    } else if whole.unknown > 0 {
        sentences.push(format!("No collision was seen in {}.", encounters(n)));
        "warn"
    } else {
        sentences.push(format!("No collision and no broken safety radius in {}.", encounters(n)));
        if failed.is_empty() { "good" } else { "warn" }
    };
    if !failed.is_empty() {
        sentences.push(format!("Checks of the rules failed: {}.", failed.join("; ")));
    }
    if whole.unknown > 0 {
        sentences.push(format!(
            "The outcome of {} is unknown: the planner failed, or the run was cut short. They \
             count as failures in every upper bound.",
            encounters(whole.unknown)
        ));
    }
    Verdict { tone, sentences }
}

/// The checks that failed, each with how often and of how many to which it applied.
fn failed_checks(whole: &StratumSummary) -> Vec<String> {
    let of = |check: Check, status| {
        whole.checks.get(&check).and_then(|counts| counts.get(&status)).copied().unwrap_or(0)
    };
    let line = |check: Check| {
        let failed = of(check, Status::Fail);
        let applied: u64 = [Status::Pass, Status::Warn, Status::Fail, Status::Inconclusive]
            .map(|status| of(check, status))
            .iter()
            .sum();
        let title = check.title();
        (failed > 0).then(|| format!("{title} in {} of {}", count(failed), count(applied)))
    };
    Check::ALL.into_iter().filter_map(line).collect()
}

/// What follows from the numbers, then what the campaign says of itself.
pub(crate) fn not_claimed(input: &ReportInput, whole: &Group) -> Vec<String> {
    let summary = &whole.summary;
    let of = if summary.weighted.is_some() {
        "Rates are those of the traffic that this campaign declares, which is no traffic at sea \
         until its distributions are one's."
    } else {
        "Rates are those of encounters drawn as this campaign says, strata in the numbers that it \
         asks for; they are not rates of any traffic at sea."
    };
    let mut sentences = vec![of.to_owned()];
    if summary.n > 0 && summary.collision.k == 0 {
        sentences.push(format!(
            "No collision was seen. That does not show that there is none: at 95 % confidence up \
             to {} of such encounters could end in one.",
            per_cent(summary.collision.upper_95)
        ));
    }
    sentences.push(format!(
        "Bounds hold for one line at a time, not for all at once. No comparison with another \
         planner and no pass or fail follows from this page. Verdicts on the rules rest on the \
         thresholds of {}, where the treaty has no number.",
        input.card.rules
    ));
    let silent: Vec<&str> = Check::ALL
        .into_iter()
        .filter(|&check| {
            summary.n > 0 && whole.tally.check(check, Status::NotEvaluated) == summary.n
        })
        .map(Check::title)
        .collect();
    if !silent.is_empty() {
        sentences.push(format!("Nothing is said about: {}.", silent.join(", ")));
    }
    if let Some(n_effective) = summary.n_effective {
        sentences.push(format!(
            "The encounters carry importance weights (they are worth {} unweighted ones). Rates \
             and bounds of strata, checks and avoiding are weighted: of the encounters that the \
             declared traffic makes, near passes no oftener than it has them. Every count, and \
             what is shown without bounds (findings, maps, classes, times, distances), is of the \
             draws.",
            crate::number::significant(n_effective, 4)
        ));
    }
    if whole.tally.second_judge_asked > 0 {
        sentences.push(format!(
            "A second judge was asked about {} and disagreed in {}{}.",
            encounters(whole.tally.second_judge_asked),
            count(whole.tally.judges_disagree),
            disagreements(&input.summary.second_judge)
        ));
    }
    sentences.extend(by_planner_class(&input.summary.planner_class, summary));
    sentences.extend(input.card.not_claimed.iter().cloned());
    sentences
}

/// The rates under the planner's own class, beside the judge's, where a check's differ.
fn by_planner_class(class: &summary::PlannerClass, whole: &StratumSummary) -> Option<String> {
    if class.disagree == 0 {
        return None;
    }
    let n = whole.n;
    let rates =
        if whole.weighted.is_some() { "shares of the draws that fail" } else { "rates of failure" };
    let rate = |k: u64| crate::number::significant(k as f64 / n as f64, 3);
    let mut lines = Vec::new();
    for (name, [judge, planner]) in &class.fails {
        let Some(title) = Check::from_name(name).map(Check::title) else { continue };
        lines.push(format!("{title} {} instead of {}", rate(*planner), rate(*judge)));
    }
    let what = if lines.is_empty() { "no rate".to_owned() } else { lines.join("; ") };
    Some(format!(
        "The planner's own class of an encounter is not the judge's in {} of {} (column \
         fails_by_planner_class); the judge's decides. Under the planner's, the {rates} would be: \
         {what}.",
        count(class.disagree),
        encounters(class.stated),
    ))
}

/// What is known of encounters that no manoeuvre of own ship clears, where they were looked for.
pub(crate) fn unavoidable(whole: &Group) -> Option<String> {
    let asked = whole.tally.avoidable + whole.tally.unavoidable;
    AvoidableRates::new(&whole.tally).map(|mut without| {
        let weighted = whole.summary.weighted.as_ref().and_then(|w| w.without_unavoidable);
        if let Some(weighted) = weighted {
            weighted::take(&mut without.collision, &weighted.collision);
            weighted::take(&mut without.safety_radius, &weighted.safety_radius);
        }
        let line = |rate: &BoundedRate| format!("{} of {} ({})", rate.k, rate.n, bounds(rate));
        format!(
            "{} of {} runs ended in a contact that own ship could not have avoided: hard over by \
             90 or 180 degrees to either side, full astern, both, or nothing, begun at any beat \
             from her first track of the ship that she hit on, the others being as they were, \
             clears not all. They stay in every rate. Without them: collisions {}, safety radius \
             broken {}; only runs that failed can be left out so, and these numbers are no rates \
             of a population.",
            count(whole.tally.unavoidable),
            count(asked),
            line(&without.collision),
            line(&without.safety_radius),
        )
    })
}

/// Which encounters the judges disagree on, the first few of them.
fn disagreements(judge: &summary::SecondJudge) -> String {
    const SHOWN: usize = 20;
    let more = if judge.disagree > SHOWN as u64 { ", ..." } else { "" };
    let ids: Vec<&str> = judge.ids.iter().take(SHOWN).map(String::as_str).collect();
    if ids.is_empty() { String::new() } else { format!(": {}{more}", ids.join(", ")) }
}
