//! The planners in scenes: the paper's four simulations, the findings, the negative controls, the
//! conformance kit.

mod boundary;
mod conformance;
mod controls;
mod figures;
mod findings;
mod isolated;
mod land;
mod memory;
mod random;
mod rivals;
mod scene;
