//! World stepping, vessel dynamics, hull contact and sensing: an encounter becomes a trace
#![forbid(unsafe_code)]
