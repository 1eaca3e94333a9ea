//! `engine`: the process that runs encounters; the supervisor starts it.

use crate::exit::Ended;
use campaign::part::PartKey;
use campaign::{Error, Folder, engine};
use planner_api::Registry;
use std::fs;
use std::path::Path;

pub(super) fn run(
    dir: &Path,
    threads: usize,
    suspect: Option<&str>,
    registry: Registry,
) -> Result<Ended, Error> {
    let ended = run_engine(dir, threads, suspect, registry);
    engine::say_farewell();
    ended
}

fn run_engine(
    dir: &Path,
    threads: usize,
    suspect: Option<&str>,
    registry: Registry,
) -> Result<Ended, Error> {
    engine::die_with_supervisor();
    engine::quiet_planner_panics();
    // Ctrl-C reaches the whole group; the supervisor decides when this process ends
    ctrlc::set_handler(|| {}).map_err(|e| Error::Fault(format!("failed to handle Ctrl-C: {e}")))?;
    let (folder, plan) = Folder::existing(dir)?;
    let registry = super::with_outside(registry, std::slice::from_ref(&plan.planner.name))?;
    if let Some(suspect) = suspect {
        let (stratum, j) = suspect
            .split_once('/')
            .and_then(|(stratum, j)| Some((stratum.parse().ok()?, j.parse().ok()?)))
            .ok_or_else(|| Error::input(format!("`{suspect}` is no suspect")))?;
        let scratch = folder.inflight().with_extension("trial");
        engine::run_suspect(&plan, &registry, &scratch, (stratum, j))?;
        return Ok(Ended::Done);
    }
    let list = dir.join("state").join("keys.json");
    let text = fs::read(&list).map_err(Error::io("read", &list))?;
    let keys: Vec<PartKey> = serde_json::from_slice(&text)
        .map_err(|e| Error::Fault(format!("{} is damaged: {e}", list.display())))?;
    engine::run(&plan, &folder, &registry, &keys, threads)?;
    Ok(Ended::Done)
}
