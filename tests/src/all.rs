//! One test binary, many modules: what no single crate can show.
#![forbid(unsafe_code)]

mod end_to_end;
mod killed;
mod lost_runs;
mod negative_controls;
mod refusals;
mod same_bits;
mod support;
