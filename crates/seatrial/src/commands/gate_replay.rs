//! `gate --replay`: one encounter of a gate again, under both planners, with a picture of each.

use crate::exit::Ended;
use crate::say::say;
use campaign::{Error, worker};
use gate::GateReport;
use planner_api::Registry;
use record::{EncounterId, Status};
use std::fs;
use std::path::Path;

/// The result of a gate.
pub(super) fn read(folder: &Path) -> Result<GateReport, Error> {
    let path = folder.join("gate.json");
    let text = fs::read_to_string(&path)
        .map_err(|e| Error::input(format!("cannot read {}: {e}", path.display())))?;
    serde_json::from_str(&text)
        .map_err(|e| Error::input(format!("{} is no result of a gate: {e}", path.display())))
}

pub(super) fn run(folder: &Path, id: &str, registry: Registry) -> Result<Ended, Error> {
    let report = read(folder)?;
    let id: EncounterId = id.parse().map_err(|e| Error::input(format!("{e}")))?;
    let mut names = vec![report.baseline.plan.planner.name.clone()];
    if report.candidate.plan.planner.name != names[0] {
        names.push(report.candidate.plan.planner.name.clone());
    }
    let registry = super::with_outside(registry, &names)?;
    for (arm, side) in [("baseline", &report.baseline), ("candidate", &report.candidate)] {
        let build = crate::build::build();
        let theirs = (&side.identity.engine, &side.identity.planners);
        if theirs != (&build.engine, &build.planners) {
            say!("{arm} {}: lives in another build and is not run here", side.asked);
            continue;
        }
        let run = worker::run_alone(&side.plan, &registry, &id)?;
        say!("{arm} {}: {}, digest {}", side.asked, run.row.outcome.name(), run.row.digest);
        if let Some(cpa_m) = run.row.cpa_hull_m {
            say!("  closest {cpa_m:.1} m from hull to hull");
        }
        for verdict in &run.judgement.verdicts {
            if verdict.status == Status::Fail {
                let sentence = verdict.sentence.as_deref().unwrap_or(&verdict.detail);
                say!("  fail {}: {sentence}", verdict.check.title());
            }
        }
        let pictures = folder.join("replay");
        fs::create_dir_all(&pictures).map_err(Error::io("make", &pictures))?;
        let picture = pictures.join(format!("{}-{arm}.svg", id.file_stem()));
        let case = crate::rendering::case(&side.plan, run);
        report::draw_case(&picture, &case).map_err(Error::stage)?;
        say!("  picture: {}", picture.display());
    }
    Ok(Ended::Done)
}
