//! `missing` and `merge`: the parts of a campaign that ran on several machines.

use super::finish;
use crate::exit::Ended;
use crate::say::say;
use crate::stored;
use crate::timing::Stopwatch;
use campaign::part::PartKey;
use campaign::parts_list;
use campaign::shards::Shards;
use campaign::{Error, Folder, Plan};
use planner_api::Registry;
use std::fs;
use std::path::{Path, PathBuf};

/// Lists the parts that are not there; with `of`, the shards that have to be run again.
pub(super) fn missing(dir: &Path, further: &[PathBuf], of: Option<u64>) -> Result<Ended, Error> {
    let shards = Shards::find(dir, further)?;
    let mut count = 0;
    for key in shards.missing() {
        count += 1;
        if of.is_none() {
            say!("{}", shown(&shards.plan, key));
        }
    }
    if let Some(of) = of.filter(|_| count > 0) {
        say!("{}", ranges(&shards.missing_shards(of)));
    }
    let there = shards.parts.len();
    if count == 0 {
        say!("all {there} parts are there");
        return Ok(Ended::Done);
    }
    Err(Error::Incomplete(format!("{count} of {} parts are missing", count + there)))
}

/// What is to be merged, and how.
#[derive(Clone, Copy, Debug)]
pub(super) struct Merge<'a> {
    pub(super) dir: &'a Path,
    /// Further folders of shards.
    pub(super) further: &'a [PathBuf],
    /// Leave the rows in the parts.
    pub(super) table_in_parts: bool,
    pub(super) quiet: bool,
}

/// Puts the parts of all shards together, as one machine would have.
pub(super) fn merge(wanted: &Merge<'_>, registry: Registry) -> Result<Ended, Error> {
    let Merge { dir, further, table_in_parts, quiet } = *wanted;
    let manifest = dir.join("manifest.json");
    let makes_table = stored::in_parts(dir) && !table_in_parts;
    if manifest.exists() && !makes_table {
        return Err(Error::input(format!("{} is finished already", dir.display())));
    }
    let shards = Shards::find(dir, further)?;
    let gaps: Vec<PartKey> = shards.missing().collect();
    if let Some(&first) = gaps.first() {
        return Err(Error::Incomplete(format!(
            "{} of {} parts are missing, {} the first; `seatrial missing {}` lists them",
            gaps.len(),
            gaps.len() + shards.parts.len(),
            shown(&shards.plan, first),
            dir.display()
        )));
    }
    if table_in_parts {
        parts_list::refuse_elsewhere(dir, &shards.parts)?;
    }
    let Shards { plan, parts } = shards;
    let registry = super::with_outside(registry, std::slice::from_ref(&plan.planner.name))?;
    campaign::engine::quiet_planner_panics();
    let mut stopwatch = Stopwatch::start();
    let folder = Folder::merged(dir, &plan, parts)?;
    if manifest.exists() {
        // the result of before is no longer whole once its list of parts is gone
        fs::remove_file(&manifest).map_err(Error::io("remove", &manifest))?;
    }
    let interrupted = super::campaign::on_interrupt()?;
    let how = finish::How {
        threads: 1,
        in_parts: table_in_parts,
        quiet,
        beside: false,
        interrupted: &interrupted,
        go_on: "merge again",
    };
    finish::finish(&plan, &registry, &folder, &mut stopwatch, how)
        .map_err(|e| e.kept_in(dir, "merge again"))?;
    Ok(Ended::Done)
}

/// `head_on/000500 to head_on/000999`.
fn shown(plan: &Plan, key: PartKey) -> String {
    let range = key.range(plan.encounters_per_stratum);
    let (first, last) = (plan.id(key.stratum, range.start), plan.id(key.stratum, range.end - 1));
    format!("{first} to {last} ({})", key.file_name())
}

/// `1-3,7`, the form that Slurm's `--array` takes.
fn ranges(numbers: &[u64]) -> String {
    let mut text: Vec<String> = Vec::new();
    let mut rest = numbers;
    while let Some(&first) = rest.first() {
        let run = rest.iter().zip(first..).take_while(|(a, b)| **a == *b).count();
        let last = rest[run - 1];
        text.push(if run == 1 { first.to_string() } else { format!("{first}-{last}") });
        rest = &rest[run..];
    }
    text.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_to_run_again_are_given_as_slurm_wants_them() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1-3,7,9-10");
        assert_eq!(ranges(&[]), "");
    }
}
