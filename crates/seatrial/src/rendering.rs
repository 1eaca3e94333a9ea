//! What a report is made from, beyond the counts: the findings in words and the encounters that
//! are shown with their tracks, run again because traces are not kept.

use crate::obstacles;
use campaign::cases::Cases;
use campaign::plan::Source;
use campaign::worker::{self, Run};
use campaign::{Error, Plan};
use planner_api::Registry;
use record::{EncounterId, Outcome, Status};
use report::{Card, Case, Found, ReportInput};
use std::collections::BTreeMap;
use summary::{Event, Finding, Findings, StratumSummary, Summary, SummaryHead, Tallies};

/// Encounters that a report shows with their tracks, and plays.
const CASES_SHOWN: usize = 20;

/// Everything that is behind a report.
#[derive(Debug)]
pub(crate) struct Rendering {
    pub(crate) card: Card,
    pub(crate) summary: Summary,
    pub(crate) tallies: Tallies,
    pub(crate) findings: Vec<Found>,
    pub(crate) cases: Vec<Case>,
    pub(crate) scenes: Vec<Case>,
}

impl Rendering {
    /// From what the rows add up to. The same rows and plan give the same bytes.
    pub(crate) fn new(
        plan: &Plan,
        registry: &Registry,
        tallies: Tallies,
        root_digest: String,
        (cases, findings, disagreements): (&Cases, &Findings, &[String]),
    ) -> Result<Self, Error> {
        campaign::engine::quiet_planner_panics();
        let mut shown = Shown { plan, registry, runs: BTreeMap::new() };
        let findings: Vec<&Finding> = findings.list();
        let worst = findings.iter().filter(|f| !takes_process(f.worst_outcome)).map(|f| &f.worst);
        let mut ids: Vec<EncounterId> = Vec::new();
        for id in worst.chain(&cases.ids(CASES_SHOWN)) {
            if ids.len() < CASES_SHOWN && !ids.contains(id) {
                ids.push(id.clone());
            }
        }
        let findings = findings.into_iter().map(|f| shown.found(f)).collect::<Result<_, _>>()?;
        let cases = ids.iter().map(|id| shown.case(id)).collect::<Result<_, _>>()?;
        let summary = summary(plan, &tallies, root_digest, disagreements)?;
        let scenes = scenes(plan, &summary);
        let scenes = scenes.iter().map(|id| shown.case(id)).collect::<Result<_, _>>()?;
        Ok(Self { card: card(plan)?, summary, tallies, findings, cases, scenes })
    }

    /// The first failure of the planner that is shown: which run, and in words.
    pub(crate) fn first_failure(&self) -> Option<(&EncounterId, &str)> {
        let rows = self.cases.iter().map(|case| &case.row);
        let mut failed = rows.filter(|row| row.outcome.is_planner_failure());
        failed.find_map(|row| Some((&row.id, row.planner_detail.as_deref()?)))
    }

    /// As the report wants it.
    pub(crate) fn input(&self) -> ReportInput<'_> {
        ReportInput {
            card: &self.card,
            summary: &self.summary,
            tallies: &self.tallies,
            findings: &self.findings,
            cases: &self.cases,
            scenes: &self.scenes,
        }
    }
}

/// `summary.json` of what the rows add up to.
pub(crate) fn summary(
    plan: &Plan,
    tallies: &Tallies,
    root_digest: String,
    disagreements: &[String],
) -> Result<Summary, Error> {
    let head = SummaryHead {
        campaign: plan.campaign.clone(),
        planner: plan.planner.name.clone(),
        seed: plan.seed,
        root_digest,
    };
    let weight_max = plan.weight_max()?;
    Ok(Summary::new(head, tallies, plan.strata.iter().map(String::as_str))
        .with_weights(tallies, |stratum| weight_max.get(stratum).copied())
        .with_disagreements(disagreements.to_vec()))
}

/// Whether a run with this outcome takes its process with it, and so is not run again here.
pub(crate) const fn takes_process(outcome: Outcome) -> bool {
    matches!(outcome, Outcome::PlannerHung | Outcome::PlannerCrashed)
}

/// More named scenes than this are a data set, and the report's worst cases have to do.
const SCENES_MAX: usize = 24;

/// The named scenes of a campaign; each of its strata is one.
fn scenes(plan: &Plan, summary: &Summary) -> Vec<EncounterId> {
    let named = matches!(plan.source, Source::Fixed(_)) && plan.strata.len() <= SCENES_MAX;
    let can_be_shown = |stratum: &&StratumSummary| {
        !stratum.outcomes.iter().any(|(o, &k)| k > 0 && takes_process(*o))
    };
    let strata = summary.strata.iter().filter(|_| named).filter(can_be_shown);
    strata.map(|stratum| EncounterId::new(stratum.name.as_str(), 0)).collect()
}

/// A run as the report wants it.
pub(crate) fn case(plan: &Plan, run: Run) -> Case {
    Case {
        obstacle_radius_m: obstacles::radii_m(plan, &run.encounter),
        encounter: run.encounter,
        trace: run.trace,
        judgement: run.judgement,
        row: run.row,
    }
}

struct Shown<'a> {
    plan: &'a Plan,
    registry: &'a Registry,
    runs: BTreeMap<EncounterId, Case>,
}

impl Shown<'_> {
    fn case(&mut self, id: &EncounterId) -> Result<Case, Error> {
        if !self.runs.contains_key(id) {
            let run = worker::run_alone(self.plan, self.registry, id)?;
            self.runs.insert(id.clone(), case(self.plan, run));
        }
        Ok(self.runs[id].clone())
    }

    fn found(&mut self, finding: &Finding) -> Result<Found, Error> {
        let finding = finding.clone();
        if takes_process(finding.worst_outcome) {
            let sentence = format!(
                "The planner took its process with it ({}), so there is no track to show.",
                finding.worst_outcome.name().replace('_', " ")
            );
            return Ok(Found { finding, sentence, t_s: None });
        }
        let case = self.case(&finding.worst)?;
        let (sentence, t_s) = sentence(finding.event, &case);
        Ok(Found { finding, sentence, t_s })
    }
}

/// What a mariner would say of the worst encounter, and the moment that decided it.
fn sentence(event: Event, case: &Case) -> (String, Option<f64>) {
    let trace = &case.trace;
    let failed = |check| {
        case.judgement.worst(check).filter(|verdict| verdict.status == Status::Fail).map(
            |verdict| {
                let plain = || format!("{} {}", verdict.check.title(), verdict.detail);
                (verdict.sentence.clone().unwrap_or_else(plain), verdict.t_s)
            },
        )
    };
    let nearest = || {
        let minima = trace.pairs.iter().map(|pair| pair.minimum.of(trace.distance));
        minima.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    match event {
        Event::Failed(check) => failed(check).unwrap_or_default(),
        Event::Contact(_) => match &trace.contact {
            Some(contact) => {
                let touched = format!(
                    "Contact {:.0} s after the start, at {:.1} m/s across the hulls.",
                    contact.t_s, contact.impact_mps
                );
                // what the judge says of the passing adds how it came to that
                let why = failed(record::Check::Turn).map_or(String::new(), |(why, _)| why);
                (format!("{touched} {why}").trim_end().to_owned(), Some(contact.t_s))
            }
            None => ("Contact.".to_owned(), Some(trace.end_s)),
        },
        Event::SafetyRadius => nearest().map_or((String::new(), None), |(distance_m, at_s)| {
            let said = format!(
                "Passed at {distance_m:.1} m, {at_s:.0} s after the start; {:.0} m had to be kept.",
                trace.safety_radius_m
            );
            (said, Some(at_s))
        }),
        Event::Planner(event) => {
            let beats = event.beats(&trace.events);
            let on = if beats == 1 { "one beat".to_owned() } else { format!("{beats} beats") };
            (format!("The planner counted of itself, on {on}: {}.", event.title()), None)
        }
        Event::Unknown(outcome) => (
            format!("{} {:.0} s after the start.", outcome.name().replace('_', " "), trace.end_s),
            Some(trace.end_s),
        ),
    }
}

/// What a report says of the plan.
pub(crate) fn card(plan: &Plan) -> Result<Card, Error> {
    let mut resolved = Vec::new();
    let json = plan.json()?;
    for key in ["seed", "encounters_per_stratum", "planner", "run", "source", "build"] {
        flatten(key, &json[key], &mut resolved);
    }
    Ok(Card {
        title: plan.title.clone(),
        campaign: plan.campaign.clone(),
        planner: plan.planner.name.clone(),
        rules: format!("{} ({})", plan.rules.name, &plan.rules.hash[..12]),
        tool: format!("seatrial {}", plan.build.tool_version),
        distance: plan.run.distance,
        safety_radius_m: plan.run.safety_radius_m,
        // a report must not depend on where it was written: the folder is the one it stands in
        replay_command: "seatrial replay . {id}".to_owned(),
        resolved,
        // a page has no code marks
        not_claimed: plan.warnings().iter().map(|w| format!("{}.", w.replace('`', ""))).collect(),
        beside: false,
    })
}

/// Longest list of a plan that a report shows item by item.
const ITEMS_SHOWN: usize = 12;

/// `key.path = value` lines of a plan.
fn flatten(key: &str, value: &serde_json::Value, lines: &mut Vec<(String, String)>) {
    use serde_json::Value;
    match value {
        // an option that was not taken says nothing
        Value::Null => {}
        Value::Object(map) => {
            map.iter().for_each(|(name, value)| flatten(&format!("{key}.{name}"), value, lines));
        }
        Value::Array(items) if items.len() > ITEMS_SHOWN => {
            lines.push((key.to_owned(), format!("{} entries", items.len())));
        }
        Value::Array(items) if items.iter().any(|item| item.is_object() || item.is_array()) => {
            for (i, item) in items.iter().enumerate() {
                flatten(&format!("{key}[{i}]"), item, lines);
            }
        }
        Value::String(text) => lines.push((key.to_owned(), text.clone())),
        other => lines.push((key.to_owned(), other.to_string())),
    }
}
