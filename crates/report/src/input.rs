//! What a report is made from. Nothing in it is a literal of the report's own.

use record::{DistanceKind, Encounter, Judgement, RunRow, Trace};
use summary::{Finding, Summary, Tallies};

/// What a reader must know of a campaign, as text; every value from the resolved campaign.
#[derive(Clone, Debug)]
pub struct Card {
    /// Title of the campaign.
    pub title: String,
    /// Its short name.
    pub campaign: String,
    /// The planner, options included.
    pub planner: String,
    /// Name and version of the rule set.
    pub rules: String,
    /// Tool and version.
    pub tool: String,
    /// The one kind of distance of the campaign.
    pub distance: DistanceKind,
    /// Distance that own ship shall keep, metres.
    pub safety_radius_m: f64,
    /// The command that runs one encounter again; `{id}` stands for its id.
    pub replay_command: String,
    /// Every resolved value that is worth showing: key and value.
    pub resolved: Vec<(String, String)>,
    /// What this campaign in particular does not show; sentences. The report adds those that
    /// follow from the numbers.
    pub not_claimed: Vec<String>,
    /// Several planners were run together: `comparison.html` is in the folder above.
    pub beside: bool,
}

/// An encounter that is shown with its tracks.
#[derive(Clone, Debug)]
pub struct Case {
    /// Before it was run.
    pub encounter: Encounter,
    /// What happened.
    pub trace: Trace,
    /// What the judge says of it.
    pub judgement: Judgement,
    /// Its row.
    pub row: RunRow,
    /// Radius of the disc around each target that the planner keeps its relative velocity out of,
    /// metres between reference points; absent where the planner has no velocity obstacle.
    pub obstacle_radius_m: Option<Vec<f64>>,
}

/// A finding and what a mariner would say of its worst encounter.
#[derive(Clone, Debug)]
pub struct Found {
    /// What, how often, and the worst.
    pub finding: Finding,
    /// One sentence.
    pub sentence: String,
    /// The moment that decided it, seconds, where there is one.
    pub t_s: Option<f64>,
}

/// A report of one planner.
#[derive(Clone, Copy, Debug)]
pub struct ReportInput<'a> {
    /// What was run.
    pub card: &'a Card,
    /// `summary.json`.
    pub summary: &'a Summary,
    /// The counts that it was made from.
    pub tallies: &'a Tallies,
    /// What went wrong, clustered, the gravest first.
    pub findings: &'a [Found],
    /// The worst encounters, worst first.
    pub cases: &'a [Case],
    /// The scenes of a campaign of named scenes, in order; each is drawn under its own name.
    pub scenes: &'a [Case],
}

/// One column of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Compared<'a> {
    /// What was run.
    pub card: &'a Card,
    /// Its `summary.json`.
    pub summary: &'a Summary,
    /// Its counts.
    pub tallies: &'a Tallies,
    /// Its report, relative to the comparison: `zhuang/report.html`.
    pub link: &'a str,
    /// What avoiding cost; absent where it was not measured.
    pub cost: Option<&'a Cost>,
}

/// What avoiding cost, over the first encounters of each stratum.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Mean wall clock of one call of the planner, microseconds: a fact of one machine at one time,
    /// and the only one in a comparison.
    pub planning_us_per_call: f64,
    /// All strata together.
    pub whole: Extra,
    /// Each stratum by its name.
    pub strata: Vec<(String, Extra)>,
}

/// What avoiding cost on the way: means over some encounters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extra {
    /// Encounters that were looked at.
    pub encounters: u64,
    /// Way sailed to the passage of the goal and way still to go, less the planned way, metres.
    pub distance_m: f64,
    /// The same for time, what is still to go at planned speed, seconds.
    pub time_s: f64,
}
