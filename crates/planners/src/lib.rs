//! The seed planner, its repairs, its rivals and the negative controls
#![forbid(unsafe_code)]
