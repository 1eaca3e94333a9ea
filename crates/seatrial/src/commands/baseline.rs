//! `baseline`: stores a planner that later changes are measured against.

use super::gate_arms::{self, Arms};
use super::gate_git::git;
use crate::cli_gate::BaselineArgs;
use crate::exit::Ended;
use crate::say::say;
use crate::{build, embedded};
use campaign::Error;
use gate::serve::Identity;
use gate::{GateSpec, Record, Role};
use planner_api::Registry;
use std::path::PathBuf;

/// Changed files that a refusal names.
const SHOWN: usize = 5;

pub(super) fn run(args: &BaselineArgs, registry: Registry) -> Result<Ended, Error> {
    refuse_changed_sources()?;
    let folder: PathBuf = args.out.clone().unwrap_or_else(|| super::gate::BASELINES.into());
    let role = Role::from_name(&args.role)
        .ok_or_else(|| Error::input(format!("there is no role `{}`", args.role)))?;
    let before = Record::read(&folder, role)?;
    let kept = before.as_ref().map(|record| record.planner.clone());
    let planner = args.planner.clone().or(kept).ok_or_else(|| {
        Error::input(format!("no {} is stored yet; name one with --planner", role.name()))
    })?;
    if registry.get(&planner).is_err() {
        return Err(Error::input(format!(
            "`{planner}` is no planner of the registry: a stored planner must be runnable from \
             its commit alone; `cargo xtask planners` lists them"
        )));
    }
    let spec = GateSpec::parse(&embedded::campaign_text(&args.campaign)?, &args.campaign)?;
    let arms = Arms::new(&spec, registry, 1)?;
    let plan = arms.plan(&planner, gate_arms::options(&args.options)?, 0)?;
    let signed = args.signed.as_ref().map(|text| text.trim().to_owned());
    let record = Record {
        schema: 1,
        role,
        planner,
        options: plan.planner.options.clone(),
        campaign: spec.file.name.clone(),
        identity: Identity::of(&plan, &build::build())?,
        signed: signed.filter(|text| !text.is_empty()),
        replaced: None,
    };
    let (stored, path) = record.store(&folder)?;
    say!("{}: {}", role.name(), stored.named());
    match (&stored.replaced, before.is_some_and(|before| before == stored)) {
        (_, true) => say!("  it was that already"),
        (Some(who), _) => say!("  replaces {} of commit {}", who.planner, who.git_commit),
        (None, _) => say!("  the first one"),
    }
    say!("  {}", path.display());
    Ok(Ended::Done)
}

/// A record names a commit, so what runs must be what that commit holds.
fn refuse_changed_sources() -> Result<(), Error> {
    let build = build::build();
    let changed = git(&["status", "--porcelain", "--untracked-files=no"])?;
    if !changed.is_empty() {
        let files: Vec<&str> = changed.lines().take(SHOWN).map(str::trim).collect();
        return Err(Error::input(format!(
            "the working folder has changes that no commit holds ({}{}); commit them first",
            files.join(", "),
            if changed.lines().count() > SHOWN { ", ..." } else { "" }
        )));
    }
    let head = git(&["rev-parse", "HEAD"])?;
    if !build.git_clean || build.git_commit != head {
        return Err(Error::input(format!(
            "this binary was built from {}{}, and the working folder is at {head}; \
             run it through `cargo xtask baseline`, which builds it anew",
            build.git_commit,
            if build.git_clean { "" } else { " with changes" }
        )));
    }
    Ok(())
}
