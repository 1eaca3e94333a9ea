//! `planners`: the registry, a line each.

use crate::exit::Ended;
use crate::say::say;
use campaign::Error;
use planner_api::Registry;

pub(super) fn run(registry: &Registry) -> Result<Ended, Error> {
    let width = registry.entries().iter().map(|entry| entry.name.len()).max().unwrap_or(0);
    for entry in registry.entries() {
        let caught = entry.caught_by.as_ref().map_or(String::new(), |by| format!(" [{by}]"));
        say!("{:width$}  {}{caught}", entry.name, entry.summary);
    }
    Ok(Ended::Done)
}
