//! A planner of one's own in a bench of one's own: the whole command line, with this planner.
//!
//! `cargo run --release -- campaign quick --planner small-vo`
#![forbid(unsafe_code)]

mod planner;

use planner_api::{Options, PlannerEntry, Registry};
use std::process::ExitCode;

fn main() -> ExitCode {
    let registry = Registry::new().with(PlannerEntry {
        name: "small-vo".to_owned(),
        summary: "a small velocity-obstacle planner, the example for authors".to_owned(),
        caught_by: None,
        options: Options::new(),
        make: Box::new(|_| Ok(Box::new(planner::SmallVo::default()))),
    });
    seatrial::main_with(registry)
}
