//! One test binary, many modules: what no single crate can show.
#![forbid(unsafe_code)]

mod end_to_end;
mod golden;
mod judge_again;
mod killed;
mod lost_runs;
mod refusals;
mod same_bits;
mod shards;
mod support;
