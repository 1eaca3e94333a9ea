//! `shrink`: a failing encounter of a result becomes a small case of the corpus.

use super::gate_arms;
use crate::cli_gate::ShrinkArgs;
use crate::embedded;
use crate::exit::Ended;
use crate::say::say;
use campaign::plan::RulesChoice;
use campaign::worker::Shop;
use campaign::{Error, Folder, Plan};
use gate::corpus::{self, Case, Found, Question};
use gate::{Child, Event, shrink};
use planner_api::{Options, Registry};
use record::{Encounter, EncounterId};
use std::path::PathBuf;

pub(super) fn run(args: &ShrinkArgs, registry: Registry) -> Result<Ended, Error> {
    let id: EncounterId = args
        .encounter_id
        .parse()
        .map_err(|e: record::id::ParseIdError| Error::input(e.to_string()))?;
    let (_, plan) = Folder::existing(&args.dir)?;
    let registry = super::with_outside(registry, std::slice::from_ref(&plan.planner.name))?;
    let stratum = plan
        .stratum_of(&id)
        .ok_or_else(|| Error::input(format!("{} has no encounter {id}", args.dir.display())))?;
    let (encounter, _) = Shop::new(&plan, &registry)?.draw(stratum, id.j)?;
    let rules = rules(&plan, &encounter)?;
    let mut arm = Child::start(gate_arms::launch(1)?, plan.clone())?;
    let mut does = |trial: &Encounter, events: Vec<Event>| {
        let (encounter, rules) = (trial.clone(), rules.clone());
        let question = Question { encounter, rules, events, or_undetermined: false };
        corpus::found(&question, &mut |question| arm.case(question))
    };
    let had = does(&encounter, corpus::every_event())?;
    let must_not = must_not(args, &plan, &id, &had)?;
    let name = args.name.clone().unwrap_or_else(|| default_name(&plan, &id, &must_not));
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from(super::gate::CORPUS));
    let path = folder.join(format!("{name}.toml"));
    if path.exists() && !args.force {
        return Err(Error::input(format!(
            "{} is there; give the case another --name, or --force",
            path.display()
        )));
    }
    let small = shrink::shrink(&encounter, &name, &mut |trial| {
        does(trial, must_not.clone()).map(|events| events == must_not)
    })?;
    let found = does(&small.encounter, corpus::every_event())?;
    let titles: Vec<&str> = must_not.iter().map(|event| event.title()).collect();
    let default_why =
        || format!("{} in {} {id}: {}", plan.planner.name, plan.campaign, titles.join(", "));
    let case = Case {
        schema: 1,
        name,
        why: args.why.clone().unwrap_or_else(default_why),
        rules: rules.name.clone(),
        must_not,
        waived: None,
        found: Found {
            options: changed_options(&plan, &registry)?,
            planner: plan.planner.name.clone(),
            events: found,
        },
        encounter: small.encounter,
    };
    std::fs::create_dir_all(&folder).map_err(Error::io("make", &folder))?;
    crate::files::write(&path, case.text()?.as_bytes())?;
    say!("{id}: {} of {} changes kept", small.kept, small.tried);
    say!(
        "  {} ships and {} hazards left of {} and {}",
        1 + case.encounter.targets.len(),
        case.encounter.hazards.len(),
        1 + encounter.targets.len(),
        encounter.hazards.len()
    );
    say!("  {}", gate::text::case_line(&case));
    say!("  case: {}", path.display());
    Ok(Ended::Done)
}

/// The rule set that judged this encounter, as a name that the corpus can look up.
fn rules(plan: &Plan, encounter: &Encounter) -> Result<RulesChoice, Error> {
    let profile = plan.rules.key(encounter.own.hull.length_m);
    let name = if profile.is_empty() { &plan.rules.name } else { profile };
    let rules = RulesChoice::new(name, embedded::rules_text(name)?)?;
    let text = plan.rules.by_own_length.get(profile).unwrap_or(&plan.rules.text);
    if rules.hash != RulesChoice::hash_of(text) {
        return Err(Error::input(format!(
            "the result was judged by another text of the rule set {name} than today's; \
             run the campaign anew"
        )));
    }
    Ok(rules)
}

/// What the small encounter must go on doing: what was asked for, or the worst that it does.
fn must_not(
    args: &ShrinkArgs,
    plan: &Plan,
    id: &EncounterId,
    had: &[Event],
) -> Result<Vec<Event>, Error> {
    let planner = &plan.planner.name;
    let Some(worst) = had.iter().min() else {
        return Err(Error::input(format!(
            "{planner} does nothing wrong in {id}; there is nothing to shrink"
        )));
    };
    if args.events.is_empty() {
        return Ok(vec![*worst]);
    }
    let mut wanted = Vec::new();
    for name in &args.events {
        let event = Event::from_name(name).ok_or_else(|| {
            Error::input(format!("there is no event `{name}`; there are {}", Event::names()))
        })?;
        if !had.contains(&event) {
            let does: Vec<&str> = had.iter().map(|event| event.name()).collect();
            return Err(Error::input(format!(
                "{planner} does not do `{name}` in {id}; it does {}",
                does.join(", ")
            )));
        }
        wanted.push(event);
    }
    // in the order in which an arm answers
    Ok(corpus::every_event().into_iter().filter(|event| wanted.contains(event)).collect())
}

fn default_name(plan: &Plan, id: &EncounterId, must_not: &[Event]) -> String {
    let events: Vec<&str> = must_not.iter().map(|event| event.name()).collect();
    let name = format!("{}-{}-{}", plan.planner.name, id.file_stem(), events.join("-"));
    let safe = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    name.chars().map(safe).collect()
}

/// Options that are not the planner's own.
fn changed_options(plan: &Plan, registry: &Registry) -> Result<Options, Error> {
    let entry = registry.get(&plan.planner.name).map_err(|e| Error::input(e.to_string()))?;
    let options = plan.planner.options.clone().into_iter();
    Ok(options.filter(|(key, value)| entry.options.get(key) != Some(value)).collect())
}
