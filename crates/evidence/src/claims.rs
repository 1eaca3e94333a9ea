//! Requirement -> hazard -> metric -> encounters.
//!
//! The hazards are those of collision avoidance at sea as the Regulations name their remedies; a
//! project's own hazard log maps to them by id. Each requirement has one metric, counted over
//! every row, and the ids of the encounters that broke it.

use record::{Check, EncounterId, Outcome, RunRow, Status};
use summary::BoundedRate;

/// Ids listed for one requirement; the table has the others.
pub(crate) const IDS_MAX: usize = 10_000;

/// A hazard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Hazard {
    pub(crate) id: &'static str,
    pub(crate) text: &'static str,
}

pub(crate) const HAZARDS: [Hazard; 6] = [
    Hazard { id: "H1", text: "Own ship touches another ship or a hazard" },
    Hazard { id: "H2", text: "Own ship comes into close quarters" },
    Hazard { id: "H3", text: "Own ship turns to the side that others do not expect" },
    Hazard { id: "H4", text: "Own ship acts too late, too little, or in small steps" },
    Hazard { id: "H5", text: "Own ship fails in the duties of a stand-on vessel" },
    Hazard { id: "H6", text: "The planner stops working, or does not see or reckon" },
];

#[derive(Clone, Copy, Debug)]
enum Metric {
    Contact,
    SafetyRadius,
    PlannerWorks,
    Check(Check),
}

/// A requirement and what the rows say of it.
#[derive(Clone, Debug)]
pub(crate) struct Claim {
    pub(crate) id: String,
    pub(crate) hazard: Hazard,
    pub(crate) requirement: String,
    pub(crate) metric: String,
    pub(crate) broken: u64,
    pub(crate) unknown: u64,
    pub(crate) n: u64,
    /// The first encounters that broke it.
    pub(crate) ids: Vec<EncounterId>,
    counts: Metric,
}

impl Claim {
    /// With exact two-sided 95 % bounds.
    pub(crate) fn rate(&self) -> BoundedRate {
        BoundedRate::new(self.broken, self.unknown, self.n)
    }

    /// The file with the ids, inside the pack.
    pub(crate) fn file(&self) -> String {
        format!("trace/{}.txt", self.id)
    }

    fn add(&mut self, row: &RunRow) {
        let (applies, broken, unknown) = match self.counts {
            Metric::Contact => {
                let touched = matches!(row.outcome, Outcome::Collision | Outcome::Grounding);
                (true, touched, row.unknown && !touched)
            }
            Metric::SafetyRadius => {
                let broken = row.safety_radius_broken;
                (true, broken, row.unknown && !broken)
            }
            Metric::PlannerWorks => {
                let invalid = row.outcome == Outcome::Invalid;
                (true, row.outcome.is_planner_failure(), invalid)
            }
            Metric::Check(check) => match row.check(check).status {
                Status::Fail => (true, true, false),
                Status::Inconclusive => (true, false, true),
                Status::Pass | Status::Warn => (true, false, false),
                Status::NotApplicable | Status::NotEvaluated => (false, false, false),
            },
        };
        self.n += u64::from(applies);
        self.broken += u64::from(broken);
        self.unknown += u64::from(unknown);
        if broken && self.ids.len() < IDS_MAX {
            self.ids.push(row.id.clone());
        }
    }
}

/// All claims, counted row by row.
#[derive(Clone, Debug)]
pub(crate) struct Claims(Vec<Claim>);

impl Default for Claims {
    fn default() -> Self {
        let claim = |id: &str, hazard: usize, requirement: &str, metric: &str, counts| Claim {
            id: id.to_owned(),
            hazard: HAZARDS[hazard],
            requirement: requirement.to_owned(),
            metric: metric.to_owned(),
            broken: 0,
            unknown: 0,
            n: 0,
            ids: Vec::new(),
            counts,
        };
        let mut claims = vec![
            claim("contact", 0, "No contact", "share of encounters with contact", Metric::Contact),
            claim(
                "safety-radius",
                1,
                "The safety radius is kept",
                "share of encounters nearer than the safety radius",
                Metric::SafetyRadius,
            ),
            claim(
                "planner-works",
                5,
                "The planner answers every beat with an order in range",
                "share of encounters in which it does not",
                Metric::PlannerWorks,
            ),
        ];
        for check in Check::ALL {
            let metric = "share of the encounters to which the check applied that failed it";
            let counts = Metric::Check(check);
            claims.push(claim(check.name(), hazard(check), check.title(), metric, counts));
        }
        Self(claims)
    }
}

impl Claims {
    pub(crate) fn offer(&mut self, row: &RunRow) {
        self.0.iter_mut().for_each(|claim| claim.add(row));
    }

    pub(crate) fn list(&self) -> &[Claim] {
        &self.0
    }

    /// `trace-table.csv`.
    pub(crate) fn csv(&self) -> String {
        let head = "hazard,hazard_text,requirement,requirement_text,metric,broken,unknown,n,\
                    lower_95,upper_95,first_encounter,encounters_file\r\n";
        let line = |claim: &Claim| {
            let rate = claim.rate();
            let first = claim.ids.first().map_or_else(String::new, ToString::to_string);
            format!(
                "{},\"{}\",{},\"{}\",\"{}\",{},{},{},{},{},\"{}\",{}\r\n",
                claim.hazard.id,
                claim.hazard.text,
                claim.id,
                claim.requirement,
                claim.metric,
                claim.broken,
                claim.unknown,
                claim.n,
                rate.lower_95,
                rate.upper_95,
                first.replace('"', "\"\""),
                claim.file(),
            )
        };
        std::iter::once(head.to_owned()).chain(self.0.iter().map(line)).collect()
    }
}

/// Which hazard a check guards against; an index into [`HAZARDS`].
const fn hazard(check: Check) -> usize {
    match check {
        Check::Safe | Check::R8Third => 1,
        Check::Turn | Check::R13 | Check::R14 | Check::R15 => 2,
        Check::R8Magnitude | Check::R8Dribble | Check::R8Time | Check::R16 | Check::LastMinute => 3,
        Check::R17Hold | Check::R17May | Check::R17Shall | Check::R17Port => 4,
        Check::R5R7 | Check::R6 | Check::R19 | Check::R19Speed => 5,
    }
}
