//! `evidence.html`: the sections of a pack, each with what it rests on, or that it is empty.

use crate::EvidenceError;
use crate::change::Change;
use crate::claims::Claim;
use crate::limits::{Assumption, DEFECTS, Defect, LIMITS};
use crate::pack::PackInput;
use crate::planner_files::PlannerFiles;
use crate::sections::{Coverage, Document, Reading, Sections, SelfTest, SweepView};
use crate::thresholds::Threshold;
use campaign::Plan;
use campaign::plan::Source;
use record::Status;
use serde::Serialize;
use std::collections::BTreeMap;
use summary::{PairedRates, SecondJudge, StratumSummary};

/// The sections of a pack, in the order that an assessor ticks them off (statistics specification,
/// section 7).
const HEADINGS: [&str; 21] = [
    "Identification",
    "Claims, and what is not claimed",
    "System under test and operating envelope",
    "Hazard, requirement, metric, encounters",
    "Interpretation of the Regulations",
    "Encounter model",
    "Models of ships, sensing and environment",
    "Verification of the simulator",
    "Statistical plan",
    "Results",
    "Rare events",
    "Failures",
    "Coverage, and what was not covered",
    "Uncertainty",
    "Comparison",
    "Negative controls",
    "Limits and known defects",
    "Change since the last pack",
    "Deviations and runs without an outcome",
    "Argument, assumptions, monitors",
    "Reproduction",
];

pub(crate) fn page(
    input: &PackInput<'_>,
    sections: &Sections,
    argument_svg: &str,
    hashes: &BTreeMap<String, String>,
) -> Result<String, EvidenceError> {
    let plan = input.plan;
    let claims = input.gathered.claims.list();
    let whole = StratumSummary::new("all strata", &input.report.tallies.total());
    let view = View {
        css: report::css(),
        headings: &HEADINGS,
        shell_planner: shell_word(&plan.planner.name),
        title: &plan.title,
        campaign: &plan.campaign,
        planner: &plan.planner.name,
        seed: plan.seed.to_string(),
        rules: &plan.rules.name,
        rules_hash: &plan.rules.hash,
        plan_hash: plan.hash()?,
        root_digest: &input.gathered.root_digest,
        encounters: input.gathered.rows,
        not_claimed: report::not_claimed(&input.report),
        verdict: report::verdict_sentences(&input.report),
        build: build(input)?,
        built: &sections.built,
        resolved: &input.report.card.resolved,
        claims: claims.iter().map(claim_line).collect(),
        findings: input.report.findings.iter().map(finding_line).collect(),
        strata: input.report.summary.strata.iter().chain([&whole]).map(stratum_line).collect(),
        untested: untested(claims),
        readings: &sections.readings,
        thresholds: &sections.thresholds,
        several_rule_sets: plan.rules.by_own_length.len() > 1,
        documents: &sections.documents,
        source: source(plan),
        limits: &LIMITS,
        defects: &DEFECTS,
        assumptions: &sections.assumptions,
        excluded: excluded(&whole, input.report.summary.ended_by_wall_clock),
        asked_twice: plan.run.twice_run_share * 100.0,
        second_judge: &input.report.summary.second_judge,
        lines: claims.len(),
        pairs: pairs(&whole),
        weighted: whole.n_effective,
        self_test: sections.self_test.as_ref(),
        coverage: &sections.coverage,
        sweeps: &sections.sweeps,
        change: sections.change.as_ref(),
        outside: plan.planner.name.contains(':'),
        planner_files: sections.planner_files.as_ref(),
        argument: argument_svg,
        files: hashes.iter().map(|(path, hash)| (path.as_str(), hash.as_str())).collect(),
    };
    let mut environment = minijinja::Environment::new();
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    environment
        .add_template("evidence.html", include_str!("../templates/evidence.html"))
        .map_err(EvidenceError::Template)?;
    let view = minijinja::Value::from(minijinja::value::Serde(view));
    environment
        .get_template("evidence.html")
        .and_then(|page| page.render(view))
        .map_err(EvidenceError::Template)
}

#[derive(Serialize)]
struct View<'a> {
    css: String,
    headings: &'a [&'static str],
    shell_planner: String,
    title: &'a str,
    campaign: &'a str,
    planner: &'a str,
    seed: String,
    rules: &'a str,
    rules_hash: &'a str,
    plan_hash: String,
    root_digest: &'a str,
    encounters: u64,
    not_claimed: Vec<String>,
    verdict: Vec<String>,
    build: Vec<(String, String)>,
    built: &'a BTreeMap<String, String>,
    resolved: &'a [(String, String)],
    claims: Vec<ClaimLine>,
    findings: Vec<FindingLine>,
    strata: Vec<StratumLine>,
    untested: Vec<String>,
    readings: &'a [Reading],
    thresholds: &'a [Threshold],
    several_rule_sets: bool,
    documents: &'a [Document],
    /// Where encounters come from, in a sentence.
    source: String,
    limits: &'a [&'static str],
    defects: &'a [Defect],
    assumptions: &'a [Assumption],
    excluded: Vec<String>,
    asked_twice: f64,
    second_judge: &'a SecondJudge,
    /// Claims that are counted, for whoever wants to correct for their number.
    lines: usize,
    pairs: Vec<PairLine>,
    /// What weighted encounters are worth; absent while all weights are 1.
    weighted: Option<f64>,
    self_test: Option<&'a SelfTest>,
    coverage: &'a Coverage,
    sweeps: &'a [SweepView],
    change: Option<&'a Change>,
    outside: bool,
    planner_files: Option<&'a PlannerFiles>,
    argument: &'a str,
    files: Vec<(&'a str, &'a str)>,
}

/// A word for a shell: quoted where it is not plain.
fn shell_word(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=".contains(c);
    if word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// An event with and without avoiding.
#[derive(Serialize)]
struct PairLine {
    event: &'static str,
    rates: PairedRates,
    ratio: String,
}

fn pairs(whole: &StratumSummary) -> Vec<PairLine> {
    let line = |event, rates: PairedRates| {
        let ratio = match (rates.risk_ratio, rates.lower_95, rates.upper_95) {
            (Some(ratio), Some(lower), Some(upper)) => {
                format!("{ratio:.3} ({lower:.3} to {upper:.3})")
            }
            _ => "–".to_owned(),
        };
        PairLine { event, rates, ratio }
    };
    vec![
        line("collision", whole.collision_pairs),
        line("safety radius broken", whole.safety_radius_pairs),
    ]
}

/// Where the encounters come from.
fn source(plan: &Plan) -> String {
    match &plan.source {
        Source::Model(_) => format!(
            "Drawn at random from the model of the plan (section 3, source.model), {} of each of \
             {} strata; every draw is a function of seed, stratum and number.",
            plan.encounters_per_stratum,
            plan.strata.len()
        ),
        Source::Fixed(encounters) => format!(
            "A fixed list of {} named encounters, each with {} runs; nothing is drawn but noise. \
             Whether they stand for traffic is not shown here.",
            encounters.len(),
            plan.encounters_per_stratum
        ),
    }
}

#[derive(Serialize)]
struct ClaimLine {
    hazard: String,
    requirement: String,
    metric: String,
    broken: u64,
    unknown: u64,
    n: u64,
    bounds: String,
    file: String,
}

#[derive(Serialize)]
struct FindingLine {
    what: String,
    class: String,
    count: u64,
    worst: String,
    sentence: String,
}

#[derive(Serialize)]
struct StratumLine {
    name: String,
    n: u64,
    drawn: u64,
    rejected: u64,
    collisions: String,
    breaches: String,
    unknown: u64,
}

fn bounds(rate: &summary::BoundedRate) -> String {
    if rate.n == 0 {
        return "–".to_owned();
    }
    format!("{:.4} % to {:.4} %", 100.0 * rate.lower_95, 100.0 * rate.upper_95)
}

fn claim_line(claim: &Claim) -> ClaimLine {
    ClaimLine {
        hazard: format!("{}: {}", claim.hazard.id, claim.hazard.text),
        requirement: claim.requirement.clone(),
        metric: claim.metric.clone(),
        broken: claim.broken,
        unknown: claim.unknown,
        n: claim.n,
        bounds: bounds(&claim.rate()),
        file: claim.file(),
    }
}

fn finding_line(found: &report::Found) -> FindingLine {
    let finding = &found.finding;
    FindingLine {
        what: finding.event.title(),
        class: finding.class.map_or("risk never opened", |c| c.name()).replace('_', " "),
        count: finding.count,
        worst: finding.worst.to_string(),
        sentence: found.sentence.clone(),
    }
}

fn stratum_line(stratum: &StratumSummary) -> StratumLine {
    let cell = |rate: &summary::BoundedRate| format!("{} ({})", rate.k, bounds(rate));
    StratumLine {
        name: stratum.name.clone(),
        n: stratum.n,
        drawn: stratum.generated,
        rejected: stratum.rejected,
        collisions: cell(&stratum.collision),
        breaches: cell(&stratum.safety_radius),
        unknown: stratum.unknown,
    }
}

fn untested(claims: &[Claim]) -> Vec<String> {
    claims.iter().filter(|claim| claim.n == 0).map(|claim| claim.requirement.clone()).collect()
}

/// Runs that are in every denominator and have no outcome, by reason.
fn excluded(whole: &StratumSummary, clocked: u64) -> Vec<String> {
    let mut lines: Vec<String> = (whole.outcomes.iter())
        .filter(|(outcome, n)| **n > 0 && outcome.is_planner_failure())
        .map(|(outcome, n)| format!("{n} ended with {}", outcome.name().replace('_', " ")))
        .collect();
    let inconclusive: u64 = (whole.checks.values())
        .map(|statuses| statuses.get(&Status::Inconclusive).copied().unwrap_or(0))
        .sum();
    if clocked > 0 {
        lines.push(format!(
            "{clocked} ended by a limit on the wall clock: a faster machine might not have ended \
             them, and the root digest would then be another"
        ));
    }
    lines.push(format!("{} of unknown outcome in all", whole.unknown));
    lines.push(format!("{inconclusive} verdicts inconclusive"));
    lines
}

fn build(input: &PackInput<'_>) -> Result<Vec<(String, String)>, EvidenceError> {
    let json = input.plan.json()?;
    let pairs = json["build"].as_object().into_iter().flatten();
    Ok(pairs
        .map(|(key, value)| {
            let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            (key.clone(), text)
        })
        .collect())
}
