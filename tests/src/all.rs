//! One test binary, many modules: what no single crate can show.
#![forbid(unsafe_code)]

mod end_to_end;
mod golden;
mod killed;
mod lost_runs;
mod refusals;
mod same_bits;
mod support;
