//! `judge`: other rule sets over a finished campaign.
//!
//! Encounters are run again from their seed, once for all rule sets, and must give the digests that
//! are stored. One rule set gives a second table and summary, the same bytes as a campaign under
//! that rule set would have written; a sweep gives the rates at every value of one threshold.

use crate::cli::JudgeArgs;
use crate::exit::Ended;
use crate::files;
use crate::say::{say, say_text};
use crate::sweep::{Sweep, Values};
use campaign::folder::TABLE;
use campaign::plan::RulesChoice;
use campaign::rejudge::{Rejudge, Stored};
use campaign::{Error, Folder, Plan};
use planner_api::Registry;
use record::{RootDigest, RunRow};
use rules::RuleSet;
use std::fs;
use std::path::{Path, PathBuf};
use summary::{Summary, Tallies};

pub(super) fn run(args: &JudgeArgs, registry: Registry) -> Result<Ended, Error> {
    let (folder, plan) = Folder::finished(&args.dir)?;
    if let Some(pack) = files::pack_around(&args.dir) {
        return Err(Error::input(format!(
            "{} is part of the pack {}, which must not change; copy it elsewhere first",
            args.dir.display(),
            pack.display()
        )));
    }
    let registry = super::with_outside(registry, std::slice::from_ref(&plan.planner.name))?;
    campaign::engine::quiet_planner_panics();
    let job = Job {
        folder: &folder,
        plan: &plan,
        registry: &registry,
        threads: super::campaign::threads(args.threads)?,
        quiet: args.quiet,
    };
    let rules = match &args.rules {
        Some(name) => RulesChoice::new(name, crate::embedded::rules_text(name)?)?,
        None => plan.rules.clone(),
    };
    match &args.sweep {
        Some(values) => job.sweep(&rules, values),
        None => job.again(&rules),
    }
}

struct Job<'a> {
    folder: &'a Folder,
    plan: &'a Plan,
    registry: &'a Registry,
    threads: usize,
    quiet: bool,
}

impl Job<'_> {
    /// Another rule set: a second table and summary.
    fn again(&self, rules: &RulesChoice) -> Result<Ended, Error> {
        let out = self.out(&rules.rule_set()?)?;
        let failed = |e: table::TableError| Error::stage(e);
        let mut table = table::ParquetSink::create(out.join(TABLE)).map_err(failed)?;
        let summary = self.run(rules, vec![rules.rule_set()?], &mut |rows| {
            rows.iter().try_for_each(|row| table.push(row)).map_err(failed)
        })?;
        let summary = &summary[0].summary;
        table.finish().map_err(failed)?;
        files::write(&out.join("summary.json"), summary.to_json().as_bytes())?;
        files::write(&out.join("rules.toml"), rules.text.as_bytes())?;
        if !self.quiet {
            say!("rules {} ({}) over {}", rules.name, &rules.hash[..12], self.shown());
            say_text!("{}", crate::headline::table(summary, crate::headline::terminal_columns()));
            say!("every run gave its stored digest; root digest {}", summary.root_digest);
            say!("table: {}", out.join(TABLE).display());
        }
        Ok(Ended::Done)
    }

    /// The rule set with one threshold at several values.
    fn sweep(&self, rules: &RulesChoice, values: &Values) -> Result<Ended, Error> {
        self.plan.refuse_weights("a sweep")?;
        let base = rules.rule_set()?;
        let mut sets = vec![base.clone()];
        for value in &values.values {
            let set = base.with(&values.key, *value);
            sets.push(set.map_err(|e| Error::input(format!("failed to {e}")))?);
        }
        let out = self.out(&base)?;
        let mut class_changed = vec![0; sets.len()];
        let judged = self.run(rules, sets, &mut |rows| {
            for (changed, row) in class_changed.iter_mut().zip(&rows) {
                *changed += u64::from(row.class != rows[0].class);
            }
            Ok(())
        })?;
        let sweep = Sweep::new(self.plan, rules, values, &judged, &class_changed);
        let path = out.join(format!("sweep-{}.json", values.key));
        files::write(&path, sweep.to_json().as_bytes())?;
        if !self.quiet {
            say_text!("{}", sweep.table());
            say!("with bounds, and for each stratum: {}", path.display());
        }
        Ok(Ended::Done)
    }

    fn run(
        &self,
        first: &RulesChoice,
        sets: Vec<RuleSet>,
        sink: &mut dyn FnMut(Vec<RunRow>) -> Result<(), Error>,
    ) -> Result<Vec<JudgedAgain>, Error> {
        let rows = crate::stored::rows(self.folder.path(), self.plan)?;
        let mut stored = rows.map(|row| row.map(Stored::from));
        let texts: Vec<RuleSet> = sets.clone();
        let mut tallies = vec![Tallies::new(); sets.len()];
        let mut disagreeing = vec![Vec::new(); sets.len()];
        let mut root = RootDigest::new();
        let progress = crate::progress::Progress::new("judge", self.plan.encounters(), self.quiet);
        let plan = Plan { rules: first.clone(), ..self.plan.clone() };
        let job =
            Rejudge { plan: &plan, registry: self.registry, rules: sets, threads: self.threads };
        let ended = job.run(&mut stored, &mut |again| {
            root.push(again.rows[0].digest);
            for ((row, tallies), ids) in again.rows.iter().zip(&mut tallies).zip(&mut disagreeing) {
                let tally = tallies.stratum_mut(&row.id.stratum);
                tally.add(row);
                tally.add_draws(1 + again.rejected, again.rejected);
                summary::list_disagreement(ids, row);
            }
            progress.add(1);
            sink(again.rows)
        });
        progress.end();
        ended?;
        let root_digest = root.hex();
        let summary = |tallies: &Tallies, ids: Vec<String>| {
            crate::rendering::summary(self.plan, tallies, root_digest.clone(), &ids)
        };
        texts
            .into_iter()
            .zip(tallies)
            .zip(disagreeing)
            .map(|((rules, tallies), ids)| {
                Ok(JudgedAgain { summary: summary(&tallies, ids)?, tallies, rules })
            })
            .collect()
    }

    /// The folder of what is found, made.
    fn out(&self, rules: &RuleSet) -> Result<PathBuf, Error> {
        let safe = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
        let name: String = rules.name.chars().map(safe).collect();
        let out = self.folder.path().join(format!("{}{name}", campaign::folder::JUDGED));
        fs::create_dir_all(&out).map_err(Error::io("make", &out))?;
        Ok(out)
    }

    fn shown(&self) -> String {
        let path: &Path = self.folder.path();
        path.display().to_string()
    }
}

/// What one rule set says of the whole campaign.
#[derive(Debug)]
pub(crate) struct JudgedAgain {
    /// The rule set.
    pub(crate) rules: RuleSet,
    /// Its tallies.
    pub(crate) tallies: Tallies,
    /// Their summary.
    pub(crate) summary: Summary,
}
