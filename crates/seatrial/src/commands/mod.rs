//! One file for each command.

mod avoiding_cost;
mod baseline;
mod campaign;
mod compare;
mod conformance;
mod corpus;
mod engine;
mod evidence;
mod evidence_given;
mod finish;
mod fit_ais;
mod gate;
mod gate_arms;
mod gate_git;
mod gate_replay;
mod gate_self_test;
mod gate_write;
mod intervals;
mod judge;
mod manoeuvres;
mod planners;
mod replay;
mod shards;
mod shrink;
mod slurm;
mod speed;
mod vectors;
mod verify;
mod verify_again;
mod verify_lost;
mod verify_planner;

pub(crate) use judge::JudgedAgain;

use crate::cli::Command;
use crate::exit::Ended;
use ::campaign::Error;
use planner_api::Registry;

pub(crate) fn run(command: Command, registry: Registry) -> Result<Ended, Error> {
    match command {
        Command::Campaign(args) => campaign::run(&args, registry),
        Command::Replay { dir, encounter_id } => replay::run(&dir, &encounter_id, registry),
        Command::Planners => planners::run(&registry),
        Command::Conformance { planner } => conformance::run(&planner, registry),
        Command::Speed { encounters } => speed::run(encounters, &registry),
        Command::Manoeuvres { out } => manoeuvres::run(out.as_deref()),
        Command::FitAis { file, out, seed } => fit_ais::run(&file, out.as_deref(), seed),
        Command::Vectors { file } => vectors::run(&file),
        Command::Intervals { file } => intervals::run(&file),
        Command::Compare { planners, common } => compare::run(planners, common, registry),
        Command::Evidence { dir, out, key, self_test, previous, no_pdf } => {
            let wanted = evidence::Wanted {
                dir: &dir,
                out: &out,
                key: key.as_deref(),
                self_test: self_test.as_deref(),
                previous: previous.as_deref(),
                pdf: !no_pdf,
            };
            evidence::run(&wanted, registry)
        }
        Command::Verify { pack, key, sample, sample_seed, no_planner } => {
            let key = key.as_deref();
            let planner = !no_planner;
            let wanted = verify::Wanted { pack: &pack, key, sample, seed: sample_seed, planner };
            verify::run(&wanted, registry)
        }
        Command::Judge(args) => judge::run(&args, registry),
        Command::Missing { dir, shards, of } => shards::missing(&dir, &shards, of),
        Command::Merge { dir, shards, table_in_parts, quiet } => {
            let wanted = shards::Merge { dir: &dir, further: &shards, table_in_parts, quiet };
            shards::merge(&wanted, registry)
        }
        Command::Slurm(args) => slurm::run(&args),
        Command::Gate(args) => gate::run(&args, registry),
        Command::Baseline(args) => baseline::run(&args, registry),
        Command::Shrink(args) => shrink::run(&args, registry),
        Command::Corpus(args) => corpus::run(&args, registry),
        Command::GateArm { threads } => gate_arms::serve(threads, registry),
        Command::Engine { dir, threads, suspect } => {
            engine::run(&dir, threads, suspect.as_deref(), registry)
        }
    }
}

/// The registry with the planners that are named `exec:...`, `lib:...` or `mutant:...`.
fn with_outside(mut registry: Registry, names: &[String]) -> Result<Registry, Error> {
    for name in names {
        if let Some(entry) = planner_host::outside(name) {
            registry = registry.with(entry.map_err(|e| Error::input(e.to_string()))?);
        }
        registry = ::gate::mutants::with_mutant(registry, name).map_err(Error::input)?;
    }
    Ok(registry)
}
