//! What the judge says: a status, a margin, and the numbers that decided it.

use crate::Check;
use geom::EncounterClass;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The six words of a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Status {
    /// The rule applied and was kept.
    Pass = 0,
    /// Kept, but not as good seamanship would.
    Warn = 1,
    /// Broken.
    Fail = 2,
    /// Applied, but the run ended before it could be decided.
    Inconclusive = 3,
    /// Never applied.
    NotApplicable = 4,
    /// An input that the check needs was not there.
    NotEvaluated = 5,
}

impl Status {
    /// Every status, in the order of reports.
    pub const ALL: [Self; 6] = [
        Self::Pass,
        Self::Warn,
        Self::Fail,
        Self::Inconclusive,
        Self::NotApplicable,
        Self::NotEvaluated,
    ];

    /// The word used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Warn => "warn",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::NotApplicable => "not_applicable",
            Self::NotEvaluated => "not_evaluated",
        }
    }

    /// The status with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|status| status.name() == name)
    }

    /// How bad, for the worst of several pairs: a failure outweighs what is not decided, that
    /// outweighs a warning, and a rule that applied outweighs one that did not.
    pub const fn severity(self) -> u8 {
        match self {
            Self::Fail => 5,
            Self::Inconclusive => 4,
            Self::Warn => 3,
            Self::Pass => 2,
            Self::NotEvaluated => 1,
            Self::NotApplicable => 0,
        }
    }

    /// The worse of two.
    pub const fn worse(self, other: Self) -> Self {
        if other.severity() > self.severity() { other } else { self }
    }
}

/// The unit of a margin or of a piece of evidence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Metres.
    Metres,
    /// Seconds.
    Seconds,
    /// Radians (reports show degrees).
    Radians,
    /// Metres a second.
    MetresPerSecond,
    /// A share, a score or a count.
    One,
}

/// A number that decided a verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// What it is, such as `x_stbd` or `limit_3`.
    pub name: Cow<'static, str>,
    /// Its value, in `unit`.
    pub value: f64,
    /// Its unit.
    pub unit: Unit,
}

/// How the limits of the stages of an encounter are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StageClock {
    /// Fixed ranges, as papers have them.
    Range,
    /// Ranges that grow with the closing speed.
    Time,
}

/// One check of one pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Which check.
    pub check: Check,
    /// Index of the target; absent when the whole run is judged.
    pub target: Option<u8>,
    /// One of six words.
    pub status: Status,
    /// A code such as `FAIL-14-PORT`, `AMBIGUOUS`, `RESOLVED_EARLY`; may be empty.
    pub detail: Cow<'static, str>,
    /// By how much, in `margin_unit`; positive on the good side.
    pub margin: Option<f64>,
    /// Unit of the margin.
    pub margin_unit: Unit,
    /// The margin scaled and clipped to [-1, 1].
    pub robustness: Option<f64>,
    /// Score in [0, 1] after Hagen 2023, where there is one.
    pub score: Option<f64>,
    /// By what the limits of the stages were found; absent for a pair that had none.
    pub stages_by: Option<StageClock>,
    /// The moment that decided it, seconds.
    pub t_s: Option<f64>,
    /// The numbers that decided it.
    pub evidence: Vec<Evidence>,
    /// A plain sentence for a failure or a warning; absent otherwise.
    pub sentence: Option<String>,
}

/// What own ship owes the target while the role is locked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Keeps out of the way.
    GiveWay,
    /// Keeps course and speed, until she may or shall act.
    StandOn,
    /// Both alter (head-on).
    Both,
    /// No role in Rules 13 to 17 (a static target, or restricted visibility).
    None,
}

/// When own ship first did something that could be seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reaction {
    /// Risk never opened: nothing to react to.
    NoRisk,
    /// Before risk opened; counts as 0 s.
    Early,
    /// Seconds after onset (or after the track was confirmed, if later).
    After(f64),
    /// Never, in a run that was long enough: counts as infinite.
    Never,
    /// Not yet, when the run was cut short.
    Unknown,
}

/// The life of one pair's encounter, as the judge found it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairFacts {
    /// Index of the target.
    pub target: u8,
    /// Onset of risk, seconds; absent if it never opened.
    pub risk_s: Option<f64>,
    /// Class at onset that decides, by the judge: where another is within the doubt, the one that
    /// Rules 13(c) and 14(c) prefer.
    pub class: Option<EncounterClass>,
    /// Class at onset by the bearings alone, whatever the doubt.
    pub class_by_bearings: Option<EncounterClass>,
    /// Class at onset by the head-on sector that the planner states; absent where it states none.
    pub class_by_planner: Option<EncounterClass>,
    /// Role at onset.
    pub role: Role,
    /// Another class is reachable within 2 degrees.
    pub ambiguous: bool,
    /// `beta` at onset, radians.
    pub beta_rad: Option<f64>,
    /// `alpha` at onset, radians.
    pub alpha_rad: Option<f64>,
    /// Range at onset, metres.
    pub range_m: Option<f64>,
    /// Closest point of the actual run, seconds, if the run went past it.
    pub cpa_s: Option<f64>,
    /// Entries of stages 2, 3 and 4, seconds.
    pub stages_s: [Option<f64>; 3],
    /// Finally past and clear, seconds.
    pub released_s: Option<f64>,
    /// First detectable alteration.
    pub reaction: Reaction,
    /// First readily apparent alteration.
    pub apparent: Reaction,
    /// Signed size of the first alteration, radians (starboard positive), where there was one.
    pub first_turn_rad: Option<f64>,
}

/// Everything the judge says of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// One entry for each target.
    pub pairs: Vec<PairFacts>,
    /// One entry for each check and pair.
    pub verdicts: Vec<Verdict>,
    /// The same under the classes of the planner's own head-on sector, where one of them differs
    /// from the judge's; absent where none does, or the planner states none. They decide nothing.
    pub by_planner_class: Option<Vec<Verdict>>,
}

impl Judgement {
    /// The status of a check over all pairs, the worst of them; `not_evaluated` where the judge
    /// did not run it.
    pub fn status(&self, check: Check) -> Status {
        self.worst(check).map_or(Status::NotEvaluated, |verdict| verdict.status)
    }

    /// The verdict that decides a check over all pairs: the worst, then the smallest margin.
    pub fn worst(&self, check: Check) -> Option<&Verdict> {
        worst(&self.verdicts, check)
    }

    /// The checks that fail under the planner's own classes, where one of these differs.
    pub fn fails_by_planner_class(&self) -> Option<Vec<Check>> {
        let verdicts = self.by_planner_class.as_ref()?;
        let fails = |check: &Check| {
            worst(verdicts, *check).is_some_and(|verdict| verdict.status == Status::Fail)
        };
        Some(Check::ALL.into_iter().filter(fails).collect())
    }
}

fn worst(verdicts: &[Verdict], check: Check) -> Option<&Verdict> {
    verdicts.iter().filter(|verdict| verdict.check == check).max_by(|a, b| {
        let margin = |v: &Verdict| v.margin.unwrap_or(f64::INFINITY);
        (a.status.severity().cmp(&b.status.severity()))
            .then_with(|| margin(b).total_cmp(&margin(a)))
    })
}
