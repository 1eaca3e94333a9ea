//! The command line of the gate and of what belongs to it.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct BaselineArgs {
    /// A planner of the registry [default: the one that the role has]
    #[arg(long, value_name = "NAME")]
    pub(crate) planner: Option<String>,
    /// An option of it, such as radius_factor=0.9; may be given several times
    #[arg(long = "option", value_name = "KEY=VALUE")]
    pub(crate) options: Vec<String>,
    /// What it is for
    #[arg(long, default_value = "current", value_parser = ["current", "release", "anchor"])]
    pub(crate) role: String,
    /// Who decides on it, and why; an anchor is not moved without
    #[arg(long, value_name = "NAME: REASON")]
    pub(crate) signed: Option<String>,
    /// The campaign of the gate
    #[arg(long, value_name = "FILE|NAME", default_value = "gate")]
    pub(crate) campaign: String,
    /// Folder of the records [default: reports/baseline]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ShrinkArgs {
    /// Folder of a result
    pub(crate) dir: PathBuf,
    /// The encounter, such as head_on/001234
    pub(crate) encounter_id: String,
    /// What it must go on doing wrong; may be given several times [default: the worst that it does]
    #[arg(long = "event", value_name = "NAME")]
    pub(crate) events: Vec<String>,
    /// Name of the case and of its file [default: from planner, encounter and event]
    #[arg(long, value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// What went wrong, in a sentence [default: planner, encounter and event]
    #[arg(long, value_name = "SENTENCE")]
    pub(crate) why: Option<String>,
    /// Folder of the case [default: tests/corpus]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace a case that is there
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CorpusArgs {
    /// Folder of the cases
    #[arg(value_name = "DIR", default_value = "tests/corpus")]
    pub(crate) dir: PathBuf,
    /// Show which cases this planner breaks as well; may be given several times
    #[arg(long = "planner", value_name = "NAME")]
    pub(crate) planners: Vec<String>,
    /// Write the verdicts of today into the files, and show what changed
    #[arg(long)]
    pub(crate) refresh: bool,
}

#[derive(Debug, Args)]
pub(crate) struct GateArgs {
    /// The planner of today: a name, git:REV, git:REV:NAME, exec:COMMAND or lib:FILE [default: the
    /// stored baseline]
    #[arg(long, value_name = "PLANNER")]
    pub(crate) baseline: Option<String>,
    /// The planner that is to replace it: a name, exec:COMMAND or lib:FILE
    #[arg(long, value_name = "PLANNER")]
    pub(crate) candidate: Option<String>,
    /// An option of the baseline, such as radius_factor=0.9; may be given several times
    #[arg(long = "baseline-option", value_name = "KEY=VALUE")]
    pub(crate) baseline_options: Vec<String>,
    /// An option of the candidate; may be given several times
    #[arg(long = "candidate-option", value_name = "KEY=VALUE")]
    pub(crate) candidate_options: Vec<String>,
    /// A campaign file with a table [gate], or the name of one that is built in
    #[arg(long, value_name = "FILE|NAME", default_value = "gate")]
    pub(crate) campaign: String,
    /// The largest number of pairs, instead of the campaign's
    #[arg(long, value_name = "N")]
    pub(crate) cap: Option<u64>,
    /// Name of the change series, whose attempts are counted [default: the git branch]
    #[arg(long, value_name = "NAME")]
    pub(crate) series: Option<String>,
    /// The folder of named encounters that must not be newly broken [default: tests/corpus]
    #[arg(long, value_name = "DIR")]
    pub(crate) corpus: Option<PathBuf>,
    /// Folder of the stored baseline, release and anchor [default: reports/baseline]
    #[arg(long, value_name = "DIR")]
    pub(crate) baselines: Option<PathBuf>,
    /// The ledger of attempts [default: reports/gate-ledger.jsonl]
    #[arg(long, value_name = "FILE")]
    pub(crate) ledger: Option<PathBuf>,
    /// Worker threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// Output folder [default: reports/gate]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Run one encounter of the gate in --out again under both planners, and draw both
    #[arg(long, value_name = "ENCOUNTER_ID", conflicts_with_all = ["baseline", "candidate"])]
    pub(crate) replay: Option<String>,
    /// Test the gate itself: a planner against itself, and planners that must fail
    #[arg(long, conflicts_with_all = ["candidate", "replay"])]
    pub(crate) self_test: bool,
    /// A self-test of a minute: wider margins, a small cap, a few planners that must fail
    #[arg(long, requires = "self_test")]
    pub(crate) small: bool,
    /// No progress
    #[arg(long)]
    pub(crate) quiet: bool,
}
