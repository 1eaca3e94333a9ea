//! The public plug: what a planner sees, what it answers, and the conformance kit
#![forbid(unsafe_code)]
