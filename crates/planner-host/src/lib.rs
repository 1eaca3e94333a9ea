//! Planners from outside, and the supervised engine process
#![forbid(unsafe_code)]
