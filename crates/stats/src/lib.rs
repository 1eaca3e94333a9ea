//! Estimators, intervals, sequential tests and the gate rule: slices in, numbers out.
//!
//! Where it stands in the flow: verdicts and rows come in as counts and slices, and what the
//! report, the summary and the gate print comes out. The crate names no other crate of ours, has
//! no clock, no entropy and no threads, and takes every transcendental function from libm, so a
//! number has the same bits on every machine.
//!
//! Claim or picture: every [`Estimate`] carries its [`Method`], and only a claim-bearing one can
//! become a [`Claim`], the form in which the gate accepts an interval from outside.
#![forbid(unsafe_code)]

mod binomial;
mod bootstrap;
mod difference;
mod eprocess;
mod error;
mod estimate;
mod gate;
mod histogram;
mod intervals;
mod math;
mod multiple;
mod paired;
mod rare;
mod ratio;
mod sample_size;
mod sequence;
mod special;
mod weighted;

pub use binomial::{
    binomial_lower_tail, binomial_upper_tail, clopper_pearson, clopper_pearson_lower,
    clopper_pearson_upper, jeffreys, ln_binomial_pmf, wilson,
};
pub use bootstrap::bca_mean;
pub use difference::{DifferenceSequence, WeightedNonInferiority};
pub use eprocess::{Forecast, Harm, NonInferiority, RateTest};
pub use error::StatsError;
pub use estimate::{Claim, Estimate, Method};
pub use gate::{
    AbsolutePlan, AbsoluteResult, AbsoluteTest, BrokenCase, CorpusResult, Feasibility, Gate,
    GateError, GatePlan, GateResult, GateVerdict, Harmed, LayerVerdict, Margin, MetricPlan,
    MetricResult, Observation, PairRow, PlanError, PlannedNeed, RatchetPlan, RatchetResult,
    combine, judge_absolute,
};
pub use histogram::{Bins, Histogram, QuantileValue, quantile_rank_bounds};
pub use intervals::{IntervalsError, IntervalsReport, check_intervals};
pub use multiple::{benjamini_hochberg, benjamini_yekutieli, holm};
pub use paired::{
    PairedCounts, exact_difference, exact_difference_upper, mcnemar_exact, mcnemar_randomised,
    pairs_needed, tango, unpaired_needed,
};
pub use rare::{ImportanceFitness, last_particle, last_particle_cv_squared, replications};
pub use ratio::{
    RiskCounts, RiskEvent, RiskPart, RiskSums, betting_ratio, betting_ratio_lower,
    betting_ratio_upper, exact_ratio, exact_ratio_upper,
};
pub use sample_size::{
    encounters_fixed_test, encounters_for_bound, encounters_for_width, events_allowance,
};
pub use sequence::{BetaBinomial, Sprt, SprtDecision, betting_interval};
pub use special::{
    beta_quantile, chi_squared_quantile, normal_cdf, normal_quantile, regularized_beta,
    regularized_gamma_lower, regularized_gamma_upper, student_t_quantile,
};
pub use weighted::{MeanBets, WeightedCount, fay_feuer};
