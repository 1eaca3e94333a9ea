//! One file for each command.

mod avoiding_cost;
mod campaign;
mod compare;
mod engine;
mod finish;
mod intervals;
mod planners;
mod replay;
mod speed;

mod vectors;

use crate::cli::Command;
use crate::exit::Ended;
use ::campaign::Error;
use planner_api::Registry;

pub(crate) fn run(command: Command, registry: Registry) -> Result<Ended, Error> {
    match command {
        Command::Campaign(args) => campaign::run(&args, registry),
        Command::Replay { dir, encounter_id } => replay::run(&dir, &encounter_id, registry),
        Command::Planners => planners::run(&registry),
        Command::Speed { encounters } => speed::run(encounters, &registry),
        Command::Vectors { file } => vectors::run(&file),
        Command::Intervals { file } => intervals::run(&file),
        Command::Compare { planners, common } => compare::run(planners, common, registry),
        Command::Engine { dir, threads, suspect } => {
            engine::run(&dir, threads, suspect.as_deref(), registry)
        }
    }
}

/// The registry with the planners from outside that are named `exec:...` or `lib:...`.
fn with_outside(mut registry: Registry, names: &[String]) -> Result<Registry, Error> {
    for name in names {
        if let Some(entry) = planner_host::outside(name) {
            registry = registry.with(entry.map_err(|e| Error::input(e.to_string()))?);
        }
    }
    Ok(registry)
}
