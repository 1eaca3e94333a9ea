//! The command line: a contract, scripts are written against it.

use crate::cli_gate::{BaselineArgs, CorpusArgs, GateArgs, ShrinkArgs};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0  done; collisions found are a result, not an error
  1  a check or comparison that was asked for has failed
  2  usage, campaign or input error
  3  inconclusive or incomplete; after Ctrl-C, go on with --resume
  4  harness fault: nothing that was written may be trusted";

const CAMPAIGN_EXAMPLES: &str = "\
Examples:
  seatrial campaign quick --encounters 200
  seatrial campaign mine.toml --planner zhuang --planner 'exec:python3 mine.py' --out both
  seatrial campaign quick --resume             after Ctrl-C, a full disk or a kill
  seatrial campaign quick --shard 3/1000 --out all/shard-3

Exit codes:
  0  done; collisions found are a result, not an error
  2  usage, campaign or input error
  3  incomplete; after Ctrl-C, go on with --resume
  4  harness fault: nothing that was written may be trusted";

/// A million sea trials for a collision-avoidance planner, before its first one.
///
/// Runs randomized encounters against a planner, judges every one against the collision
/// regulations, and reports rates with exact bounds. The same seed gives the same encounters and
/// the same bits on any number of threads.
#[derive(Debug, Parser)]
#[command(name = "seatrial", version, after_help = EXIT_CODES, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a campaign and write its report
    ///
    /// FILE is a campaign file, or the name of one that is built in; `quick` is the default.
    ///
    /// DIR gets report.html, which opens offline, runs.parquet with a row for every encounter,
    /// summary.json, figures/, manifest.json with everything that decided a number, and
    /// timing.json. Of several planners each has a folder of its own in DIR, beside one comparison.
    #[command(after_help = CAMPAIGN_EXAMPLES)]
    Campaign(CampaignArgs),
    /// Run one encounter of a result again, alone, compare its digest and draw it
    #[command(after_help = EXIT_CODES)]
    Replay {
        /// Folder of a result
        dir: PathBuf,
        /// The encounter, such as head_on/001234
        encounter_id: String,
    },
    /// List the planners, a line each
    Planners,
    /// Run the conformance kit against a planner
    ///
    /// Repeatable, reset completely, in range, its own random stream only, and indifferent to where
    /// the scene lies. A planner of the registry that ends its process ends this command too.
    #[command(after_help = EXIT_CODES)]
    Conformance {
        /// A planner of the registry, `exec:COMMAND` or `lib:FILE`
        #[arg(long, value_name = "NAME")]
        planner: String,
    },
    /// Measure encounters per second, the floor, and the share of each stage
    Speed {
        /// Encounters to run for each figure
        #[arg(long, value_name = "N", default_value_t = 200)]
        encounters: u64,
    },
    /// Turning circle, zigzags and crash stop of every vessel
    Manoeuvres {
        /// Folder for the table and the picture; without it the table is printed and no more
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Fit an encounter model to a file of AIS reports
    #[command(after_help = EXIT_CODES)]
    FitAis {
        /// A CSV file; columns are found by name
        file: PathBuf,
        /// Folder for the report, the picture, the model and the situations; absent:
        /// reports/ais-NAME
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Seed of the bootstraps of intervals and p-values
        #[arg(long, value_name = "N", default_value_t = 1)]
        seed: u64,
    },
    /// Check a file of planner vectors, and print the largest error of each column
    #[command(after_help = EXIT_CODES)]
    Vectors {
        /// A CSV file in the format of the seed planner's test vectors
        file: PathBuf,
    },
    /// Check a file of exact binomial bounds, and print the largest relative error
    #[command(after_help = EXIT_CODES)]
    Intervals {
        /// A CSV file with the columns k, n, one_sided_alpha, lower, upper
        file: PathBuf,
    },
    /// Several planners on the same encounters, side by side
    #[command(after_help = EXIT_CODES)]
    Compare {
        /// Planners of the registry, `exec:COMMAND` or `lib:FILE`
        #[arg(required = true, num_args = 2..)]
        planners: Vec<String>,
        #[command(flatten)]
        common: CompareArgs,
    },
    /// Write an evidence pack of a finished result
    #[command(after_help = EXIT_CODES)]
    Evidence {
        /// Folder of a result
        dir: PathBuf,
        /// Folder of the pack; it must not be there
        #[arg(long, value_name = "PACK")]
        out: PathBuf,
        /// Secret key of `minisign`, which must be installed
        #[arg(long, value_name = "FILE")]
        key: Option<PathBuf>,
        /// The gate's self-test, as `gate --self-test` writes it [default: the tool's own]
        #[arg(long, value_name = "FILE")]
        self_test: Option<PathBuf>,
        /// The pack before this one, to show what changed
        #[arg(long, value_name = "PACK")]
        previous: Option<PathBuf>,
        /// Print no PDF, even if there is a browser
        #[arg(long)]
        no_pdf: bool,
    },
    /// Check an evidence pack: every byte, what follows from its rows, and encounters run again
    #[command(after_help = EXIT_CODES)]
    Verify {
        /// Folder of a pack
        pack: PathBuf,
        /// The line of a minisign public key
        #[arg(long, value_name = "KEY")]
        key: Option<String>,
        /// Encounters to run again besides the failures
        #[arg(long, value_name = "N", default_value_t = 1000)]
        sample: u64,
        /// Seed of the sample [default: fresh, and printed]
        #[arg(long, value_name = "N")]
        sample_seed: Option<u64>,
        /// Do not start a planner from outside that is in the pack
        #[arg(long)]
        no_planner: bool,
    },
    /// Judge a finished campaign again, under another rule set
    ///
    /// Runs every encounter again from its seed, compares its digest with the stored one, and
    /// writes a second verdict table and summary into DIR/judged-<rules>/.
    #[command(after_help = EXIT_CODES)]
    Judge(JudgeArgs),
    /// List the parts of a sharded campaign that are not there
    #[command(after_help = EXIT_CODES)]
    Missing {
        /// Folder that holds the shards, as `shard-*`
        dir: PathBuf,
        /// Further folders, one shard each
        shards: Vec<PathBuf>,
        /// List the shards to be run again instead, of this many
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
        of: Option<u64>,
    },
    /// Put the parts of a sharded campaign together, as one machine would have
    #[command(after_help = EXIT_CODES)]
    Merge {
        /// Folder that holds the shards, as `shard-*`; the result goes there
        dir: PathBuf,
        /// Further folders, one shard each
        shards: Vec<PathBuf>,
        /// Leave the rows in the parts of the shards, and list these with their hashes, instead of
        /// making one table; a later `merge` without it makes the table
        #[arg(long)]
        table_in_parts: bool,
        /// No table
        #[arg(long)]
        quiet: bool,
    },
    /// Write the job array of a sharded campaign
    ///
    /// One task for each shard, with bounded retries, and a job that merges when all have ended.
    #[command(after_help = EXIT_CODES)]
    Slurm(SlurmArgs),
    /// May this planner replace that one: pass (0), fail (1) or inconclusive (3)
    ///
    /// Runs both on the same fresh encounters, one after the other in id order, and stops as soon
    /// as the answer is shown. The levels, margins and the cap stand in the campaign file.
    #[command(after_help = EXIT_CODES)]
    Gate(GateArgs),
    /// Store a planner that later changes are measured against
    ///
    /// Writes DIR/current.json, release.json or anchor.json: a planner of this commit, with the
    /// hashes of what its numbers mean, and whom it replaced. The working folder must be clean.
    #[command(after_help = EXIT_CODES)]
    Baseline(BaselineArgs),
    /// Make a failing encounter small while it fails the same way, and keep it in the corpus
    #[command(after_help = EXIT_CODES)]
    Shrink(ShrinkArgs),
    /// Run the corpus: every case must get the verdict that its file holds
    #[command(after_help = EXIT_CODES)]
    Corpus(CorpusArgs),
    /// The process that runs one planner for a gate; the gate starts it
    #[command(hide = true)]
    GateArm {
        /// Worker threads
        #[arg(long, default_value_t = 1)]
        threads: usize,
    },
    /// The engine process of a campaign; the supervisor starts it
    #[command(hide = true)]
    Engine {
        /// Folder of the result
        dir: PathBuf,
        /// Worker threads
        #[arg(long, default_value_t = 1)]
        threads: usize,
        /// Run this encounter alone and store nothing: index of the stratum, slash, number
        #[arg(long)]
        suspect: Option<String>,
    },
}

#[derive(Debug, Args)]
pub(crate) struct JudgeArgs {
    /// Folder of a finished result
    pub(crate) dir: PathBuf,
    /// Rule set, a name or a file [with --sweep default: the campaign's]
    #[arg(long, value_name = "NAME", required_unless_present = "sweep")]
    pub(crate) rules: Option<String>,
    /// Show how every rate moves with one threshold, such as head_on_half_angle_deg=5,10,13,15,22.5
    #[arg(long, value_name = "KEY=VALUES")]
    pub(crate) sweep: Option<crate::sweep::Values>,
    /// Worker threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// No progress and no table
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SlurmArgs {
    /// A campaign file, or the name of one that is built in
    #[arg(value_name = "FILE|NAME")]
    pub(crate) campaign: String,
    /// Number of shards, one task each; at most 1000
    #[arg(long, value_name = "N")]
    pub(crate) shards: u64,
    /// Folder on a file system that all nodes share: scripts, shards, and the merged result
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// A planner of the registry [default: the campaign's, where it names one]
    #[arg(long, value_name = "NAME")]
    pub(crate) planner: Option<String>,
    /// Encounters of each stratum, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) encounters: Option<u64>,
    /// Seed, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Processors and worker threads of a task
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) threads: u64,
    /// Longest time of a task, in Slurm's form
    #[arg(long, value_name = "TIME", default_value = "04:00:00")]
    pub(crate) time: String,
    /// Merge with --table-in-parts
    #[arg(long)]
    pub(crate) table_in_parts: bool,
    /// How often a task is tried, and how often it may be requeued
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub(crate) attempts: u64,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// A campaign file, or the name of one that is built in
    #[arg(long, value_name = "FILE|NAME", default_value = "quick")]
    pub(crate) campaign: String,
    /// Encounters of each stratum, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) encounters: Option<u64>,
    /// Seed, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Worker threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// Output folder [default: reports/<campaign>-compare]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Go on with a partial result
    #[arg(long)]
    pub(crate) resume: bool,
    /// Replace a result that is there
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Clone, Debug, Default, Args)]
pub(crate) struct CampaignArgs {
    /// A campaign file, or the name of one that is built in [default: quick, and with --situations
    /// situations]
    #[arg(value_name = "FILE|NAME")]
    pub(crate) campaign: Option<String>,
    /// A planner of the registry, `exec:COMMAND` or `lib:FILE`, instead of the campaign's; may be
    /// given several times
    #[arg(long = "planner", value_name = "NAME")]
    pub(crate) planners: Vec<String>,
    /// Rule set, a name or a file that ends in .toml, instead of the campaign's
    #[arg(long, value_name = "NAME")]
    pub(crate) rules: Option<String>,
    /// DNV traffic situations (JSON): a file or a folder
    #[arg(long, value_name = "PATH")]
    pub(crate) situations: Option<PathBuf>,
    /// Encounters of each stratum, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) encounters: Option<u64>,
    /// Seed, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Worker threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// Run only this part of the campaign; parts count from 1
    #[arg(long, value_name = "I/N", value_parser = parse_shard)]
    pub(crate) shard: Option<(u64, u64)>,
    /// Output folder [default: reports/<campaign>-<planner>]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Go on with a partial result
    #[arg(long)]
    pub(crate) resume: bool,
    /// Replace a result that is there
    #[arg(long)]
    pub(crate) force: bool,
    /// No progress and no table
    #[arg(long)]
    pub(crate) quiet: bool,
}

fn parse_shard(text: &str) -> Result<(u64, u64), String> {
    let wrong = || format!("`{text}` is no shard; one looks like 3/1000 and counts from 1");
    let (index, of) = text.split_once('/').ok_or_else(wrong)?;
    let index: u64 = index.parse().map_err(|_| wrong())?;
    let of: u64 = of.parse().map_err(|_| wrong())?;
    if index == 0 || index > of { Err(wrong()) } else { Ok((index, of)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }

    #[test]
    fn shards_count_from_one() {
        assert_eq!(parse_shard("3/1000"), Ok((3, 1000)));
        for text in ["0/3", "4/3", "3", "a/b", "1/0"] {
            assert!(parse_shard(text).is_err(), "{text}");
        }
    }
}
