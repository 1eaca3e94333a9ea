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
mod error;
mod estimate;
mod histogram;
mod intervals;
mod math;
mod special;

pub use binomial::{
    binomial_lower_tail, binomial_upper_tail, clopper_pearson, clopper_pearson_lower,
    clopper_pearson_upper, jeffreys, ln_binomial_pmf, wilson,
};
pub use error::StatsError;
pub use estimate::{Claim, Estimate, Method};
pub use histogram::{Bins, Histogram, QuantileValue, quantile_rank_bounds};
pub use intervals::{IntervalsError, IntervalsReport, check_intervals};
pub use special::{
    beta_quantile, chi_squared_quantile, normal_cdf, normal_quantile, regularized_beta,
    regularized_gamma_lower, regularized_gamma_upper, student_t_quantile,
};
