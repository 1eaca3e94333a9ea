//! Rows become counts that add up, and those become `summary.json`.
//!
//! `RunRow -> Tally -> Summary`. A tally holds integers only, so the tallies of any partition of
//! the rows, merged in any order, are equal to the tally of all of them, byte for byte: threads,
//! shards and resumed runs cannot change a number. Every rate in `summary.json` is made from a
//! tally by `stats`, and from nothing else.
#![forbid(unsafe_code)]

mod bearing_map;
mod build;
mod by_weight;
mod findings;
mod fixed_point;
mod planner_event;
mod risk;
mod summary;
mod tallies;
mod tally;
mod times;
mod weighted;

pub use bearing_map::{BEARING_SECTORS, BearingMap, Cell, CellKey, RATIO_BANDS};
pub use build::check_rate;
pub use by_weight::{ByWeight, EventCounts, WeightBin, WeightCounts};
pub use findings::{Event, Finding, Findings};
pub use fixed_point::FixedSum;
pub use planner_event::PlannerEvent;
pub use risk::PairedCounts;
pub use summary::{
    AvoidableRates, BoundedRate, CpaSummary, PairedRates, PlannerClass, SecondJudge,
    StratumSummary, Summary, SummaryHead, TimeSummary, list_disagreement,
};
pub use tallies::Tallies;
pub use tally::Tally;
pub use times::Times;
pub use weighted::{WeightedAvoidable, WeightedRate, WeightedRatio, WeightedSummary};
