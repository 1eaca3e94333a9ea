//! Estimators, intervals, sequential tests and the gate rule: slices in, numbers out
#![forbid(unsafe_code)]
