//! The judge: a trace and a rule set become verdicts.
//!
//! `record::Trace` in, `record::Judgement` out; one file for each rule, opening with the rule, our
//! reading and its source. The judge sees neither simulator nor planner. [`Judge::judge`] is the
//! whole of it and the first function to read; thresholds come from a [`RuleSet`].
#![forbid(unsafe_code)]

mod action;
mod before_risk;
mod case;
mod crossing_ahead;
mod facts;
mod flaws;
mod judge;
mod last_minute;
mod life;
mod other_class;
mod pair;
mod risk;
mod rule_05_07_lookout;
mod rule_06_safe_speed;
mod rule_08_dribble;
mod rule_08_magnitude;
mod rule_08_third_ship;
mod rule_08_time;
mod rule_13_overtaking;
mod rule_14_head_on;
mod rule_15_crossing;
mod rule_16_give_way;
mod rule_17_hold;
mod rule_17_may_act;
mod rule_17_port;
mod rule_17_shall_act;
mod rule_19_restricted;
mod rule_19_safe_speed;
mod ruleset;
mod ruleset_file;
mod ruling;
mod runs;
mod safe;
mod scope;
mod score;
mod signal;
mod turn;

#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

pub use judge::Judge;
pub use ruleset::{
    Classification, Distances, Manoeuvre, PortInExtremis, Release, RestrictedVisibility, Risk,
    RuleSet, StageMode, Stages, StandOn, Timing,
};
pub use ruleset_file::RuleSetError;
