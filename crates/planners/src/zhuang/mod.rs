//! The seed planner: J. Zhuang, R. Bucknall, J. Luo, H. Sun, Y. Liu, C. Huang, *Collision
//! Avoidance for Unmanned Surface Vehicles based on COLREGS*, in every reading of its text.
//!
//! Inside this module the paper's symbols and its counter-clockwise angles hold (x east, y north,
//! port positive); [`planner`] converts once on the way in and once on the way out.
//!
//! Where the paper misprints, and what was done:
//!
//! | place | printed | here |
//! |---|---|---|
//! | (2) | no value for D <= R | `as-printed` keeps the NaN (so "safe"); `consistent` pi/2 |
//! | (3) | "gamma equal to mu ... safe" beside flag 1 | the formula: `<=` is a collision |
//! | (3), (17), (19)-(23) | gamma without its sign | the modulus; (4)-(16) need the sign |
//! | (4) | atan folds gamma and gamma + pi | `as-printed` keeps it; `consistent` atan2, V_s > 0 |
//! | (7), (8) | "Eq. (6)", trailing "= dV_A", stray "(2)" | (7) is meant; the rest is dropped |
//! | (11) | varphi "between dV and V_A" | signed, from dV to V_A: varphi = alpha - phi |
//! | (16) | variation of *relative* velocity | variation of own speed |
//! | (19)-(23) | comparisons of raw angles | `as-printed` keeps them; `consistent` wraps |
//! | Step 6 | `i = i + 1; if i < obs_num`, counted from 1 | every obstacle is examined |
//! | Step 2 | i is never set back | every pass begins with the first obstacle |
//! | Step 8 | "largest change" | largest |change of heading|; option `reference` |
//! | Step 9 | no bound on the loop 9 -> 2 | 50 passes; reaching that is a counted event |
//! | "obstacles are ellipses" | against the disc of section III | the disc |

pub mod class;
pub mod equations;
pub mod memory;
pub mod options;
pub mod planner;
pub mod strategy;

pub use options::{Equations, Memory, Reference, Resume, ZhuangOptions};
pub use planner::Zhuang;
