//! The second judge: temporal-logic robustness over the same trace
#![forbid(unsafe_code)]
