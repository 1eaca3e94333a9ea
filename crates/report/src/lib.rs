//! Figures, tables and the HTML report; the only crate that names plotters
#![forbid(unsafe_code)]
