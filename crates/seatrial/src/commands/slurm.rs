//! `slurm`: the scripts of a sharded campaign for a cluster.
//!
//! An array of one task for each shard, and a job that merges when the array has ended. Slurm
//! starts a task again when its node fails; a task whose process was killed it does not, so the
//! script does, a bounded number of times. Wrong input and a harness fault are not tried again.

use crate::cli::SlurmArgs;
use crate::exit::Ended;
use crate::files;
use crate::say::say;
use campaign::{Error, Folder};
use std::fs;
use std::path::Path;

/// Largest index of a job array under Slurm's default `MaxArraySize` of 1001.
const SHARDS_MAX: u64 = 1000;

pub(super) fn run(args: &SlurmArgs) -> Result<Ended, Error> {
    if args.shards == 0 || args.shards > SHARDS_MAX {
        return Err(Error::input(format!(
            "--shards {} must lie from 1 to {SHARDS_MAX}: Slurm's default limit of array indices \
             is 1001, and each task can run any number of parts",
            args.shards
        )));
    }
    // a wrong name is told now, not by a thousand tasks
    let text = crate::embedded::campaign_text(&args.campaign)?;
    let file = campaign::CampaignFile::parse(&text, &args.campaign)?;
    let planner = match (&args.planner, &file.planners[..]) {
        (Some(planner), _) => planner,
        (None, [one]) => one,
        (None, several) => {
            return Err(Error::input(format!(
                "the campaign names {}; choose one with --planner",
                several.join(", ")
            )));
        }
    };
    let path = |path: &Path| std::path::absolute(path).map_err(Error::io("find", path));
    let out = path(&args.out)?;
    // the job that merges would refuse it, at the end
    Folder::check_for_shards(&out)?;
    let campaign = match args.campaign.ends_with(".toml") || args.campaign.contains('/') {
        true => path(Path::new(&args.campaign))?.to_string_lossy().into_owned(),
        false => args.campaign.clone(),
    };
    let program = std::env::current_exe().map_err(Error::io("find", Path::new("seatrial")))?;
    let mut command = format!(
        "{} campaign {} --planner {}",
        quoted(&program.to_string_lossy()),
        quoted(&campaign),
        quoted(planner)
    );
    for (option, value) in [("--encounters", args.encounters), ("--seed", args.seed)] {
        if let Some(value) = value {
            command += &format!(" {option} {value}");
        }
    }
    let job = Job { args, name: &file.name, out: &out.to_string_lossy(), command: &command };
    fs::create_dir_all(out.join("shard-logs")).map_err(Error::io("make", &out))?;
    let mut merge = format!("{} merge {}", quoted(&program.to_string_lossy()), quoted(job.out));
    if args.table_in_parts {
        merge += " --table-in-parts";
    }
    for (name, text) in [
        ("shard-array.sbatch", job.array()),
        ("shard-merge.sbatch", job.merge(&merge)),
        ("shard-submit.sh", job.submit()),
    ] {
        files::write(&out.join(name), text.as_bytes())?;
    }
    say!("submit with: sh {}", quoted(&out.join("shard-submit.sh").to_string_lossy()));
    Ok(Ended::Done)
}

struct Job<'a> {
    args: &'a SlurmArgs,
    name: &'a str,
    out: &'a str,
    command: &'a str,
}

impl Job<'_> {
    fn array(&self) -> String {
        let Self { args, name, out, command } = self;
        let SlurmArgs { shards, threads, time, attempts, .. } = args;
        let folder = quoted(out);
        format!(
            r#"#!/bin/bash
# One task for each of {shards} shards of the campaign {name}.
#SBATCH --job-name=seatrial-{name}
#SBATCH --array=1-{shards}
#SBATCH --cpus-per-task={threads}
#SBATCH --time={time}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={out}/shard-logs/%a.log
set -u
# Slurm itself requeues a task whose node failed; the bound keeps a bad shard from going round.
if [ "${{SLURM_RESTART_COUNT:-0}}" -gt {attempts} ]; then
    echo "shard $SLURM_ARRAY_TASK_ID was requeued more than {attempts} times" >&2
    exit 1
fi
shard=$(printf '%s/shard-%04d' {folder} "$SLURM_ARRAY_TASK_ID")
# It does not start again what was killed on a healthy node; parts that are whole are not run again.
for attempt in $(seq {attempts}); do
    {command} --shard "$SLURM_ARRAY_TASK_ID/{shards}" \
        --threads {threads} --out "$shard" --resume --quiet
    code=$?
    case $code in
        0) exit 0 ;;
        2 | 4) exit $code ;; # wrong input or a harness fault: the next attempt would end alike
    esac
    echo "attempt $attempt of {attempts} ended with $code" >&2
done
exit $code
"#
        )
    }

    fn merge(&self, merge: &str) -> String {
        let Self { args, name, out, .. } = self;
        let time = &args.time;
        format!(
            r#"#!/bin/bash
# Puts the shards of the campaign {name} together; refuses gaps, and names them.
#SBATCH --job-name=seatrial-{name}-merge
#SBATCH --time={time}
#SBATCH --open-mode=append
#SBATCH --output={out}/shard-logs/merge.log
exec {merge}
"#
        )
    }

    fn submit(&self) -> String {
        let array = quoted(&format!("{}/shard-array.sbatch", self.out));
        let merge = quoted(&format!("{}/shard-merge.sbatch", self.out));
        format!(
            r#"#!/bin/sh
# Submits the array and, to run when it has ended, the merge; prints both job ids.
set -eu
array=$(sbatch --parsable {array})
merge=$(sbatch --parsable --dependency=afterany:"${{array%%;*}}" {merge})
echo "$array $merge"
"#
        )
    }
}

/// A word of a shell command.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_reach_the_shell_whole() {
        assert_eq!(quoted("quick"), "quick");
        assert_eq!(quoted("exec:./a b"), "'exec:./a b'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
