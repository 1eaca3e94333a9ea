//! Layer 1: the corpus, named encounters that somebody once got wrong.
//!
//! A case says what no planner may do in it, and what the planner that was found wrong does, so
//! that a judge that no longer sees the fault is noticed too. There are no statistics here: a case
//! that the baseline passes and the candidate breaks is a FAIL.

use crate::{ArmRow, Event};
use campaign::plan::RulesChoice;
use campaign::{Error, row};
use planner_api::{Options, Planner, Registry};
use record::{Digest, Encounter};
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
    /// Exactly what of `must_not` it does.
    pub events: Vec<Event>,
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
        toml::from_str(&text).map_err(|e| Error::input(format!("case {}: {e}", path.display())))
    };
    paths.iter().map(case).collect()
}

/// What a planner does in one encounter, of these events.
pub fn events(
    encounter: &Encounter,
    planner: &mut dyn Planner,
    rules: &RulesChoice,
    of: &[Event],
    beat: &AtomicU64,
) -> Result<Vec<Event>, Error> {
    let mut trace = sim::run(encounter, planner, &mut sim::Scratch::default(), beat);
    trace.nominal = sim::nominal(encounter);
    let judgement = rules::Judge::new(rules.rule_set()?).judge(&trace);
    let whole = row::of_run(encounter, &trace, Digest::of_trace(&trace), &judgement);
    let row = ArmRow::of(0, &whole, encounter.distance);
    let had = |event: &Event| event.of(&row, 0.0) == Observation::Event;
    Ok(of.iter().copied().filter(had).collect())
}

/// Makes a planner of the registry with changed options.
pub fn make(registry: &Registry, name: &str, options: &Options) -> Result<Box<dyn Planner>, Error> {
    let input = |e: planner_api::OptionsError| Error::input(e.to_string());
    let entry = registry.get(name).map_err(input)?;
    (entry.make)(&entry.resolve(options).map_err(input)?).map_err(input)
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
}

/// Asks a planner: which of these events does it have? None when it took its process with it.
pub type Ask<'a> = &'a mut dyn FnMut(&Question) -> Result<Option<Vec<Event>>, Error>;

/// Cases that the baseline passes and the candidate breaks. A planner that is lost in a case has
/// every event of it.
pub fn replay(
    cases: &[Case],
    find_rules: campaign::spec::FindRules<'_>,
    baseline: Ask<'_>,
    candidate: Ask<'_>,
) -> Result<CorpusResult, Error> {
    let mut result = CorpusResult { cases: cases.len() as u64, broken: Vec::new() };
    for case in cases {
        let question = Question {
            encounter: case.encounter.clone(),
            rules: RulesChoice::new(&case.rules, find_rules(&case.rules)?)?,
            events: case.must_not.clone(),
        };
        let was = baseline(&question)?.unwrap_or_else(|| case.must_not.clone());
        let now = candidate(&question)?.unwrap_or_else(|| case.must_not.clone());
        if now.iter().any(|event| !was.contains(event)) {
            result.broken.push(BrokenCase { name: case.name.clone(), waived: case.waived.clone() });
        }
    }
    Ok(result)
}
