//! `conformance`: the kit of `planner-api` against one planner, also one from outside.

use crate::exit::Ended;
use crate::say::say;
use campaign::{CampaignFile, Error, Overrides, worker};
use planner_api::{Registry, conformance};

pub(super) fn run(planner: &str, registry: Registry) -> Result<Ended, Error> {
    let registry = super::with_outside(registry, &[planner.to_owned()])?;
    let wrong = |e: planner_api::OptionsError| Error::input(e.to_string());
    let entry = registry.get(planner).map_err(wrong)?;
    (entry.make)(&entry.options).map_err(wrong)?;
    campaign::engine::quiet_planner_panics();
    let findings = conformance::check(&|| {
        (entry.make)(&entry.options).expect("what could be made once can be made again")
    });
    for finding in &findings {
        say!("{finding}");
    }
    if findings.iter().any(|finding| finding.check == conformance::Check::Answers)
        && let Some(said) = in_words(planner, &registry)?
    {
        say!("  in an encounter of `{WORLD}`: {said}");
    }
    match findings.len() {
        0 => say!("{planner} conforms"),
        n => say!("{planner} fails {n} of {} checks", conformance::Check::ALL.len()),
    }
    Ok(if findings.is_empty() { Ended::Done } else { Ended::Failed })
}

/// Where a planner that does not answer is asked why.
const WORLD: &str = "laboratory";

/// How the first encounter of a campaign ends with this planner, where it ends by a failure that
/// has words: the kit only sees that there is no answer.
fn in_words(planner: &str, registry: &Registry) -> Result<Option<String>, Error> {
    let file = CampaignFile::parse(&crate::embedded::campaign_text(WORLD)?, WORLD)?;
    let overrides = Overrides { planners: vec![planner.to_owned()], ..Overrides::default() };
    let build = crate::build::build();
    let rules = &crate::embedded::rules_text;
    let plan = file.resolve(&overrides, None, registry, rules, &build)?.remove(0);
    let row = worker::run_alone(&plan, registry, &plan.id(0, 0))?.row;
    Ok(row.planner_detail.map(|detail| format!("{}: {detail}", row.outcome.name())))
}
