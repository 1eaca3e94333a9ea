//! `conformance`: the kit of `planner-api` against one planner, also one from outside.

use crate::exit::Ended;
use crate::say::say;
use campaign::Error;
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
    match findings.len() {
        0 => say!("{planner} conforms"),
        n => say!("{planner} fails {n} of {} checks", conformance::Check::ALL.len()),
    }
    Ok(if findings.is_empty() { Ended::Done } else { Ended::Failed })
}
