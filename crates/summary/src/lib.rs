//! Rows become counts and histograms that add up, and those become summary.json
#![forbid(unsafe_code)]
