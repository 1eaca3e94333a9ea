//! `campaign`: the main job.

use super::finish;
use crate::cli::CampaignArgs;
use crate::exit::Ended;
use crate::progress::Progress;
use crate::say::say;
use crate::timing::Stopwatch;
use crate::{build, embedded};
use campaign::folder::Opened;
use campaign::supervisor::{self, GO_ON, Supervisor};
use campaign::{CampaignFile, Error, Folder, Overrides, Plan, run_parts};
use planner_api::Registry;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) fn run(args: &CampaignArgs, registry: Registry) -> Result<Ended, Error> {
    let (plans, registry) = plans(args, registry)?;
    let out = args.out.clone().unwrap_or_else(|| default_folder(&plans));
    let several = plans.len() > 1;
    let threads = threads(args.threads)?;
    let folders = folders(&plans, &out, args)?;
    let interrupted = on_interrupt()?;
    let mut results = Vec::new();
    for (plan, folder) in plans.iter().zip(&folders) {
        let registry = &registry;
        let job = Job { plan, registry, threads, interrupted: &interrupted, args, several };
        if let Some(result) = job.run(folder)? {
            results.push(result);
        }
    }
    if several && args.shard.is_none() {
        let sound = plans.iter().zip(&results).filter(|(_, result)| !result.takes_its_process());
        let sound: Vec<&Plan> = sound.map(|(plan, _)| plan).collect();
        let costs =
            super::avoiding_cost::measure(&sound, registry, &out, args.quiet, &interrupted)?;
        finish::comparison(&out, &results, &costs, args.quiet)?;
    }
    Ok(Ended::Done)
}

/// One plan for each planner that was asked for.
fn plans(args: &CampaignArgs, registry: Registry) -> Result<(Vec<Plan>, Registry), Error> {
    // --situations alone means the built-in campaign that takes situations over
    let default = if args.situations.is_some() { "situations" } else { "quick" };
    let name = args.campaign.as_deref().unwrap_or(default);
    let file = CampaignFile::parse(&embedded::campaign_text(name)?, name)?;
    let named = if args.planners.is_empty() { &file.planners } else { &args.planners };
    let registry = super::with_outside(registry, named)?;
    let overrides = Overrides {
        planners: args.planners.clone(),
        rules: args.rules.clone(),
        encounters: args.encounters,
        seed: args.seed,
    };
    let mut plans = file.resolve(
        &overrides,
        args.situations.as_deref(),
        &registry,
        &embedded::rules_text,
        &build::build(),
    )?;
    for plan in &mut plans {
        plan.planner.files_sha256 = crate::files::hashes(planner_host::files(&plan.planner.name))?;
    }
    Ok((plans, registry))
}

fn default_folder(plans: &[Plan]) -> PathBuf {
    let name = match plans {
        [one] => format!("{}-{}", one.campaign, folder_name(&one.planner.name)),
        several => format!("{}-compare", several.first().map_or("", |plan| &plan.campaign)),
    };
    Path::new("reports").join(name)
}

/// The folder of each plan. All are looked at before the first is run, and none is touched when one
/// of them is refused.
fn folders(plans: &[Plan], out: &Path, args: &CampaignArgs) -> Result<Vec<PathBuf>, Error> {
    let folders: Vec<PathBuf> = match plans {
        [_] => vec![out.to_owned()],
        several => {
            let name = |plan: &Plan| folder_name(&plan.planner.name);
            let folders: Vec<PathBuf> = several.iter().map(|plan| out.join(name(plan))).collect();
            Folder::check_around(out, &folders)?;
            folders
        }
    };
    for (i, (plan, folder)) in plans.iter().zip(&folders).enumerate() {
        if let Some(other) = folders[..i].iter().position(|other| other == folder) {
            return Err(Error::input(format!(
                "planners `{}` and `{}` would share the folder {}; run them one by one",
                plans[other].planner.name,
                plan.planner.name,
                folder.display()
            )));
        }
        Folder::check(folder, plan, args.resume, args.force)?;
    }
    Ok(folders)
}

/// A planner's name as the name of a folder: `exec:./my_planner --flag` has more than letters.
fn folder_name(planner: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    planner.chars().map(safe).collect()
}

pub(super) fn threads(asked: Option<usize>) -> Result<usize, Error> {
    match asked {
        Some(0) => Err(Error::input("--threads 0 runs nothing; ask for at least 1")),
        Some(n) => Ok(n),
        None => Ok(std::thread::available_parallelism().map_or(1, usize::from)),
    }
}

pub(super) fn on_interrupt() -> Result<Arc<AtomicBool>, Error> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))
        .map_err(|e| Error::Fault(format!("failed to handle Ctrl-C: {e}")))?;
    Ok(interrupted)
}

/// One planner's part of the work.
struct Job<'a> {
    plan: &'a Plan,
    registry: &'a Registry,
    threads: usize,
    interrupted: &'a AtomicBool,
    args: &'a CampaignArgs,
    /// Other planners meet the same encounters.
    several: bool,
}

impl Job<'_> {
    /// Runs, finishes, and prints; nothing to show after one shard of several.
    fn run(&self, folder: &Path) -> Result<Option<finish::PlannerResult>, Error> {
        let plan = self.plan;
        let quiet = self.args.quiet;
        if !quiet {
            say!(
                "campaign {}, planner {}, seed {}, {} encounters",
                plan.campaign,
                plan.planner.name,
                plan.seed,
                plan.encounters()
            );
            plan.warnings().iter().for_each(|warning| say!("note: {warning}"));
        }
        let folder = match Folder::open(folder, plan, self.args.resume, self.args.force)? {
            Opened::Ready(folder) => folder,
            Opened::Finished(folder) => {
                if !quiet {
                    say!("finished already: {}", folder.path().join("report.html").display());
                }
                return finish::read_back(plan, &folder).map(Some);
            }
        };
        let mut stopwatch = Stopwatch::start();
        let shard = self.args.shard.unwrap_or((1, 1));
        let go_on = |e: Error| e.kept_in(folder.path(), GO_ON);
        self.run_parts(&folder, shard).map_err(go_on)?;
        stopwatch.lap("run");
        if self.args.shard.is_some() {
            if !quiet {
                say!("part {}/{} is done in {}", shard.0, shard.1, folder.parts().display());
            }
            return Ok(None);
        }
        let how = finish::How {
            threads: self.threads,
            in_parts: false,
            quiet,
            beside: self.several,
            interrupted: self.interrupted,
            go_on: GO_ON,
        };
        finish::finish(plan, self.registry, &folder, &mut stopwatch, how).map(Some).map_err(go_on)
    }

    fn run_parts(&self, folder: &Folder, shard: (u64, u64)) -> Result<(), Error> {
        let keys = campaign::pipeline::shard_keys(self.plan, shard);
        let (total, done) = supervisor::encounters(self.plan, folder, &keys);
        let progress = Progress::new(&self.plan.planner.name, total, self.args.quiet);
        progress.begin_with(done);
        let supervisor = Supervisor {
            program: std::env::current_exe().map_err(Error::io("find", Path::new("seatrial")))?,
            threads: self.threads,
            interrupted: self.interrupted,
            progress: &|encounters| progress.add(encounters),
        };
        let ended = run_parts(self.plan, folder, shard, &supervisor);
        progress.end();
        ended
    }
}
