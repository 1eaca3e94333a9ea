//! Figures, tables and the HTML report; the only crate that names plotters.
//!
//! `Summary + Tallies + cases -> report.html, figures/*.svg`. Every number comes from the input,
//! every figure has a caption with its n and the numbers behind it, and a figure without data says
//! so. Nothing here knows a clock or the host, so the same input gives the same bytes.
#![forbid(unsafe_code)]

mod axis;
mod canvas;
mod case_figure;
mod case_marks;
mod clip;
mod compare;
mod error;
mod figure;
mod figure_cpa;
mod figure_map;
mod figure_polar;
mod figure_rates;
mod figure_scene;
mod figure_times;
mod findings;
mod font;
mod group;
mod input;
mod manoeuvres;
mod number;
mod page;
mod page_tables;
mod plan_view;
mod player;
mod simplify;
mod time_charts;
mod traffic;
mod weighted;
mod wording;
mod write;

pub use error::ReportError;
pub use figure::{DataTable, Figure};
pub use input::{Card, Case, Compared, Cost, Extra, Found, ReportInput};
pub use manoeuvres::{Trials, manoeuvres_picture};
pub use page::{css, not_claimed, verdict_sentences};
pub use traffic::{Sample, Traffic, traffic_picture};
pub use wording::BESIDE;
pub use write::{Rendered, case_picture, draw_case, render, write, write_comparison};
