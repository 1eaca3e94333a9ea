//! `evidence.html`: the sections of a pack, each with what it rests on, or that it is empty.

use crate::EvidenceError;
use crate::claims::Claim;
use crate::pack::PackInput;
use record::Status;
use serde::Serialize;
use std::collections::BTreeMap;
use summary::StratumSummary;

/// Known defects and limits of the bench itself; a change of one is a change of this list.
const KNOWN_LIMITS: [&str; 6] = [
    "Ships are rigid hulls in the plane: no waves, no heel, no interaction between hulls in close \
     passing.",
    "While two hulls are far apart the stored distance between them is a lower bound; the smallest \
     distance of a run is exact.",
    "Targets keep to their intent; only those that run a planner answer to own ship.",
    "The treaty has few numbers. Where the judge needs one, the rule set names it; another rule \
     set may judge the same track otherwise.",
    "Rates are those of the declared encounters. They become rates at sea only with an encounter \
     model that was fitted to traffic, and no better than its fit.",
    "Not in this tool: validation of the ship models against sea trials, which the owner of the \
     models has to add.",
];

pub(crate) fn page(
    input: &PackInput<'_>,
    claims: &[Claim],
    argument_svg: &str,
    hashes: &BTreeMap<String, String>,
) -> Result<String, EvidenceError> {
    let plan = input.plan;
    let whole = StratumSummary::new("all strata", &input.report.tallies.total());
    let view = View {
        css: report::css(),
        title: &plan.title,
        campaign: &plan.campaign,
        planner: &plan.planner.name,
        seed: plan.seed.to_string(),
        rules: &plan.rules.name,
        rules_hash: &plan.rules.hash,
        rules_text: &plan.rules.text,
        plan_hash: plan.hash()?,
        root_digest: &input.gathered.root_digest,
        encounters: input.gathered.rows,
        not_claimed: &input.report.card.not_claimed,
        build: build(input)?,
        resolved: &input.report.card.resolved,
        claims: claims.iter().map(claim_line).collect(),
        findings: input.report.findings.iter().map(finding_line).collect(),
        strata: input.report.summary.strata.iter().chain([&whole]).map(stratum_line).collect(),
        untested: untested(claims),
        limits: KNOWN_LIMITS.to_vec(),
        excluded: excluded(&whole),
        asked_twice: plan.run.twice_run_share * 100.0,
        outside: plan.planner.name.contains(':'),
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
    title: &'a str,
    campaign: &'a str,
    planner: &'a str,
    seed: String,
    rules: &'a str,
    rules_hash: &'a str,
    rules_text: &'a str,
    plan_hash: String,
    root_digest: &'a str,
    encounters: u64,
    not_claimed: &'a [String],
    build: Vec<(String, String)>,
    resolved: &'a [(String, String)],
    claims: Vec<ClaimLine>,
    findings: Vec<FindingLine>,
    strata: Vec<StratumLine>,
    untested: Vec<String>,
    limits: Vec<&'static str>,
    excluded: Vec<String>,
    asked_twice: f64,
    outside: bool,
    argument: &'a str,
    files: Vec<(&'a str, &'a str)>,
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
fn excluded(whole: &StratumSummary) -> Vec<String> {
    let mut lines: Vec<String> = (whole.outcomes.iter())
        .filter(|(outcome, n)| **n > 0 && outcome.is_planner_failure())
        .map(|(outcome, n)| format!("{n} ended with {}", outcome.name().replace('_', " ")))
        .collect();
    let inconclusive: u64 = (whole.checks.values())
        .map(|statuses| statuses.get(&Status::Inconclusive).copied().unwrap_or(0))
        .sum();
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
