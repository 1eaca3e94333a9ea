//! `replay`: one encounter of a result again, alone, and whether it gives the same bits.

use crate::exit::Ended;
use crate::say::say;
use campaign::{Error, Folder, worker};
use planner_api::Registry;
use record::{EncounterId, Status};
use std::fs;
use std::path::{Path, PathBuf};

pub(super) fn run(dir: &Path, encounter_id: &str, registry: Registry) -> Result<Ended, Error> {
    let id: EncounterId =
        encounter_id.parse().map_err(|e: record::id::ParseIdError| Error::input(e.to_string()))?;
    let (folder, plan) = Folder::finished(dir)?;
    let registry = super::with_outside(registry, std::slice::from_ref(&plan.planner.name))?;
    campaign::engine::quiet_planner_panics();
    let stored = crate::stored::find(folder.path(), &plan, &id)?;
    if matches!(stored.outcome, record::Outcome::PlannerHung | record::Outcome::PlannerCrashed) {
        say!(
            "{id}: {}; the planner takes its process with it, so it is not run here again",
            stored.outcome.name()
        );
        return Ok(Ended::Done);
    }
    let run = worker::run_alone(&plan, &registry, &id)?;
    say!("{id}: {}, digest {}", run.row.outcome.name(), run.row.digest);
    for verdict in &run.judgement.verdicts {
        if matches!(verdict.status, Status::Fail | Status::Warn) {
            let sentence = verdict.sentence.as_deref().unwrap_or(&verdict.detail);
            say!("  {} {}: {sentence}", verdict.status.name(), verdict.check.title());
        }
    }
    for d in run.disagreements.iter().flatten() {
        say!(
            "  the judges disagree on {}, target {}: {} {}, and the second finds {:?}",
            d.check.title(),
            d.target,
            d.first.name(),
            d.detail,
            d.second
        );
    }
    let pictures = pictures(folder.path());
    fs::create_dir_all(&pictures).map_err(Error::io("make", &pictures))?;
    let picture = pictures.join(format!("{}.svg", id.file_stem()));
    let case = crate::rendering::case(&plan, run);
    report::draw_case(&picture, &case).map_err(Error::stage)?;
    say!("  picture: {}", picture.display());
    if case.row.digest == stored.digest {
        say!("  the same bits as stored");
        return Ok(Ended::Done);
    }
    say!("  NOT the same bits: stored {}", stored.digest);
    Ok(Ended::Failed)
}

/// Beside the pack where the result is in one, which must not change; else in the result.
fn pictures(result: &Path) -> PathBuf {
    match crate::files::pack_around(result) {
        Some(pack) => {
            let name = pack.file_name().unwrap_or_default().to_string_lossy().into_owned();
            pack.with_file_name(name + "-replay")
        }
        None => result.join("replay"),
    }
}
