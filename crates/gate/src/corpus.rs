//! Layer 1: the corpus, named encounters that somebody once got wrong.
//!
//! A case says what no planner may do in it, and what the planner that was found wrong does, so
//! that a judge that no longer sees the fault is noticed too. There are no statistics here: a case
//! that the baseline passes and the candidate breaks is a FAIL.

use crate::{ArmRow, Event};
use campaign::plan::RulesChoice;
use campaign::{Error, row};
use planner_api::{Options, Registry};
use record::{Check, Digest, Encounter};
use serde::{Deserialize, Serialize};
use stats::{BrokenCase, CorpusResult, Observation};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicU64;

/// One case, as its file holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// 1.
    pub schema: u32,
    /// As the file is called.
    pub name: String,
    /// What went wrong, in a sentence.
    pub why: String,
    /// Name of the rule set.
    pub rules: String,
    /// What no planner may do here.
    pub must_not: Vec<Event>,
    /// Whose signature waives the case, and why; absent: it counts.
    pub waived: Option<String>,
    /// What the planner that was found wrong does.
    pub found: Found,
    /// The encounter.
    pub encounter: Encounter,
}

/// A verdict that the case must get.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Found {
    /// The planner.
    pub planner: String,
    /// Every option that is not its own.
    #[serde(default)]
    pub options: Options,
    /// Everything that it does wrong, of [`every_event`]; more than the case forbids.
    pub events: Vec<Event>,
}

/// What a case can ask for. `near` is left out: it needs the factor of a gate.
pub fn every_event() -> Vec<Event> {
    let named = [Event::Collision, Event::PlannerFailure, Event::SafetyRadius];
    named.into_iter().chain(Check::ALL.map(Event::Check)).collect()
}

impl Case {
    /// Reads a case; `stem` is the name of its file without the ending.
    pub fn parse(text: &str, stem: &str) -> Result<Self, Error> {
        let wrong = |what: String| Error::input(format!("case {stem}: {what}"));
        let case: Self = toml::from_str(text).map_err(|e| wrong(e.to_string()))?;
        let known = every_event();
        if case.schema != 1 {
            return Err(wrong(format!("schema = {} is not known; it must be 1", case.schema)));
        }
        if case.name != stem {
            return Err(wrong(format!("name = \"{}\" must be the name of its file", case.name)));
        }
        if case.must_not.is_empty() {
            return Err(wrong("must_not is empty: the case forbids nothing".to_owned()));
        }
        if let Some(event) = case.must_not.iter().find(|event| !known.contains(event)) {
            return Err(wrong(format!("must_not has `{}`, which needs a gate", event.name())));
        }
        if let Some(event) = case.must_not.iter().find(|e| !case.found.events.contains(e)) {
            return Err(wrong(format!(
                "must_not has `{}`, which {} was not found to do",
                event.name(),
                case.found.planner
            )));
        }
        sim::check(&case.encounter).map_err(|e| wrong(e.to_string()))?;
        Ok(case)
    }

    /// The file.
    pub fn text(&self) -> Result<String, Error> {
        toml::to_string_pretty(self).map_err(|e| Error::Fault(format!("failed to encode: {e}")))
    }

    /// What an arm is asked.
    pub fn question(
        &self,
        find_rules: campaign::spec::FindRules<'_>,
        events: Vec<Event>,
        or_undetermined: bool,
    ) -> Result<Question, Error> {
        Ok(Question {
            encounter: self.encounter.clone(),
            rules: RulesChoice::new(&self.rules, find_rules(&self.rules)?)?,
            events,
            or_undetermined,
        })
    }
}

/// Every case of a folder, by name; a folder that is not there has none.
pub fn read(folder: &Path) -> Result<Vec<Case>, Error> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let entries = fs::read_dir(folder).map_err(Error::io("read", folder))?;
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    paths.sort();
    let case = |path: &std::path::PathBuf| {
        let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
        Case::parse(&text, &path.file_stem().unwrap_or_default().to_string_lossy())
    };
    paths.iter().map(case).collect()
}

/// One case as an arm is asked for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Question {
    /// The encounter.
    pub encounter: Encounter,
    /// The rule set that judges.
    pub rules: RulesChoice,
    /// The events that are asked for.
    pub events: Vec<Event>,
    /// Whether what cannot be said counts as an event.
    #[serde(default)]
    pub or_undetermined: bool,
}

/// What a planner of the registry does in one encounter, of the events that are asked for. Targets
/// under a planner have one of the registry with its own options.
pub fn events(
    question: &Question,
    registry: &Registry,
    (planner, options): (&str, &Options),
    beat: &AtomicU64,
) -> Result<Vec<Event>, Error> {
    let Question { encounter, rules, events, or_undetermined } = question;
    let make = |name: &str, options: &Options| {
        let entry = registry.get(name).map_err(|e| e.to_string())?;
        let options = entry.resolve(options).map_err(|e| e.to_string())?;
        (entry.make)(&options).map_err(|e| e.to_string())
    };
    let mut own = make(planner, options).map_err(Error::Input)?;
    let peers = &mut |name: &str| make(name, &Options::new()).ok();
    let scratch = &mut sim::Scratch::default();
    let voyage = sim::voyage(encounter, own.as_mut(), peers, scratch, beat);
    let trace = voyage.into_trace(encounter);
    let judgement = rules::Judge::new(rules.rule_set()?).judge(&trace);
    let whole = row::of_run(encounter, &trace, Digest::of_trace(&trace), &judgement);
    let row = ArmRow::of(0, &whole, encounter.distance);
    let had = |event: &Event| match event.of(&row, 0.0) {
        Observation::Event => true,
        Observation::Undetermined => *or_undetermined,
        Observation::NoEvent => false,
    };
    Ok(events.iter().copied().filter(had).collect())
}

/// Asks a planner: which of these events does it have? None when it took its process with it.
pub type Ask<'a> = &'a mut dyn FnMut(&Question) -> Result<Option<Vec<Event>>, Error>;

/// What a planner is found to do in a case; one that is lost fails as a planner.
pub fn found(question: &Question, ask: Ask<'_>) -> Result<Vec<Event>, Error> {
    Ok(ask(question)?.unwrap_or_else(|| vec![Event::PlannerFailure]))
}

/// Cases that the baseline passes and the candidate breaks. What cannot be said counts as broken,
/// and a planner that is lost in a case has every event of it.
pub fn replay(
    cases: &[Case],
    find_rules: campaign::spec::FindRules<'_>,
    baseline: Ask<'_>,
    candidate: Ask<'_>,
) -> Result<CorpusResult, Error> {
    let mut result = CorpusResult { cases: cases.len() as u64, broken: Vec::new() };
    for case in cases {
        let question = case.question(find_rules, case.must_not.clone(), true)?;
        let was = baseline(&question)?.unwrap_or_else(|| case.must_not.clone());
        let now = candidate(&question)?.unwrap_or_else(|| case.must_not.clone());
        if now.iter().any(|event| !was.contains(event)) {
            result.broken.push(BrokenCase { name: case.name.clone(), waived: case.waived.clone() });
        }
    }
    Ok(result)
}

/// What changed in a list of events, a line each: `- ` no longer, `+ ` new.
pub fn changes(was: &[Event], now: &[Event]) -> Vec<String> {
    let gone = was.iter().filter(|event| !now.contains(event)).map(|e| format!("- {}", e.name()));
    let new = now.iter().filter(|event| !was.contains(event)).map(|e| format!("+ {}", e.name()));
    gone.chain(new).collect()
}
