//! `verify`: encounters in which the planner takes its process with it, run again in processes of
//! their own.

use super::verify_again::{Chosen, Differing};
use crate::say::say;
use campaign::folder::Opened;
use campaign::supervisor::Supervisor;
use campaign::{Error, Folder, Plan};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A planner that hangs takes its whole limit each time: so many encounters at most, ...
const LOST_MAX: usize = 100;
/// ... and no further one after so long.
const LOST_TIME: Duration = Duration::from_secs(60);

/// What was found.
pub(super) struct Lost {
    pub(super) differing: Vec<Differing>,
    /// How many of the sample were not run again.
    pub(super) unknown: u64,
}

/// Runs each alone and compares how it ends; it has no track and no verdicts. The words of a
/// planner that dies are those of its machine, and are not compared.
#[expect(clippy::disallowed_methods, reason = "how long a check may take changes no number of it")]
pub(super) fn run_again(plan: &Plan, lost: &[Chosen]) -> Result<Lost, Error> {
    let sampled = |rows: &[Chosen]| rows.iter().filter(|(_, sampled)| *sampled).count() as u64;
    let mut found = Lost { differing: Vec::new(), unknown: sampled(lost) };
    if lost.is_empty() {
        return Ok(found);
    }
    let name = &plan.planner.name;
    if name.starts_with("exec:") || name.starts_with("lib:") {
        say!("  not run again: {} whose planner from outside hangs or dies", lost.len());
        return Ok(found);
    }
    let scratch = tempfile::tempdir().map_err(Error::io("make", &std::env::temp_dir()))?;
    let Opened::Ready(folder) = Folder::open(&scratch.path().join("again"), plan, false, false)?
    else {
        return Err(Error::Fault("a fresh folder holds a finished result".to_owned()));
    };
    let supervisor = Supervisor {
        program: std::env::current_exe().map_err(Error::io("find", Path::new("seatrial")))?,
        threads: 1,
        // the process of an encounter ends with this one
        interrupted: &AtomicBool::new(false),
        progress: &|_| {},
    };
    let started = Instant::now();
    let mut done = 0;
    for (row, sampled) in lost.iter().take(LOST_MAX) {
        if started.elapsed() > LOST_TIME {
            break;
        }
        let stratum = plan
            .stratum_of(&row.id)
            .ok_or_else(|| Error::input(format!("{} is no encounter of the plan", row.id)))?;
        let limit_s = plan.run.planner_hang_limit_s;
        let ended = supervisor.trial(&folder, (stratum, row.id.j), limit_s)?;
        let again = ended.map_or("the process lives on", |(outcome, _)| outcome.name());
        if again != row.outcome.name() {
            let what = format!("{} run again: {again}, not {}", row.id, row.outcome.name());
            found.differing.push(Differing { sampled: *sampled, what });
        }
        done += 1;
    }
    found.unknown = sampled(&lost[done..]);
    say!(
        "  in processes of their own: {done} of {} in which the planner hangs or dies; {} end \
         otherwise",
        lost.len(),
        found.differing.len()
    );
    if done < lost.len() {
        say!(
            "  not run again: {} more of these (at most {LOST_MAX}, and none after {} s)",
            lost.len() - done,
            LOST_TIME.as_secs()
        );
    }
    Ok(found)
}
