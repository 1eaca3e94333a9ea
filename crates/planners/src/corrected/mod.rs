//! `zhuang-corrected`: the seed planner with the repairs that COLREGS ask for.
//!
//! | fault of the paper | repair | file |
//! |---|---|---|
//! | no memory (F1, F15) | class and duty latched until past and clear, Rule 13(d) | [`encounter`], [`observe`] |
//! | acts as stand-on (F2, F3) | holds; acts when Rule 17(a)(ii) lets it | [`encounter`] |
//! | first-order step (F10, F17, F18) | exact edge of the cone at constant speed | [`search`] |
//! | not apparent, no margin (F4, F5) | 35 degrees or half the speed, R with a margin | [`options`] |
//! | turn to port (F3, F6, F16) | no port candidate for a ship to port, ahead or crossing | [`search`] |
//! | one reference obstacle (F11, F12) | every candidate is checked against every target | [`search`] |
//! | point without inertia (F19) | predicted turn with own ship's limits | [`path`] |
//! | targets known perfectly | steady lines, margins that grow with the doubt | [`steady`], [`own_motion`] |
//! | no land | every path keeps clear of the chart's polygons | [`land`] |
//! | returns too early (F14) | only when the wish is clear of every target | [`planner`] |

pub mod encounter;
pub mod gap;
pub mod land;
pub mod observe;
pub mod options;
pub mod own_motion;
pub mod path;
pub mod planner;
pub mod search;
pub mod steady;

pub use options::CorrectedOptions;
pub use planner::ZhuangCorrected;
