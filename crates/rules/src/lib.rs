//! The judge: a trace and a rule set become verdicts
#![forbid(unsafe_code)]
