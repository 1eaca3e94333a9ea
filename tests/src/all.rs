//! One test binary, many modules: what no single crate can show.
#![forbid(unsafe_code)]
#![expect(clippy::unwrap_used, reason = "everything here is a test; a panic is its failure")]

mod another_repository;
mod end_to_end;
mod evidence;
mod fit_ais;
mod gate_command;
mod golden;
mod hostile_planners;
mod judge_again;
mod killed;
mod lost_runs;
mod negative_controls;
mod newcomers_walk;
mod no_room;
mod refusals;
mod same_bits;
mod shards;
mod starred_findings;
mod support;
mod weighted;
