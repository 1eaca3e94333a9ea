//! The readings of the paper, as options of the planner's own table in a campaign file.

use crate::clearance::{RadiusKind, UNKNOWN_LENGTH_M};
use serde::{Deserialize, Serialize};

/// How the equations are read. Together with `memory = none`, either is the paper's planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Equations {
    /// atan in (4), NaN in (2) inside the circle, raw comparisons in (19)-(23), the target exactly
    /// on the edge and tested with `<=`, no limit on (18) and (24). A speed below 0, or an order
    /// that is not a number (own ship at rest divides (18) by zero), is ordered as it comes out;
    /// the bench records that. Only the largest speed is kept.
    AsPrinted,
    /// atan2 and V_s > 0, wrapped comparisons, mu = pi/2 for D <= R, an edge passed by 1e-6 rad,
    /// speed kept in [0, largest], the change of heading of one pass at most a right angle.
    Consistent,
}

/// When own ship returns to her route: the paper says only "headed for the goal".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Resume {
    /// The goal velocity once it is outside every cone, else Steps 3-9 from the present velocity.
    /// The only reading that gives the paper's Figs. 14 to 16.
    Hold,
    /// Steps 3-9 from the goal velocity, every beat.
    GoalFirst,
    /// The goal velocity, unchecked, whenever the present velocity is safe.
    WhenSafe,
}

/// What is remembered of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Memory {
    /// Nothing: classified again with the trial velocity of every inner pass.
    None,
    /// The class, found with the velocity at which Steps 3-9 begin, holds for the beat.
    ClassInBeat,
    /// Class and side hold from first risk until finally past and clear (Rule 13(d)): range opening
    /// with the present and with the goal velocity, and D > R.
    Latched,
}

/// Which obstacle's change is carried out in a pass (Step 8).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// The largest change of heading: the paper.
    LargestChange,
    /// The least time to the closest point: a repair, for what Step 8 overlooks.
    MostUrgent,
}

/// Every option of the seed planner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZhuangOptions {
    /// Reading of equations (2) to (4) and (17) to (24).
    pub equations: Equations,
    /// Step 1 and Step 10, "headed for the goal": from which velocity Steps 3 to 9 begin.
    pub resume: Resume,
    /// The class that chooses between (19) to (23), and the side that they choose: for how long.
    pub memory: Memory,
    /// Step 8: the reference obstacle.
    pub reference: Reference,
    /// Half-angle of the head-on sector of Fig. 1, inside which (21) rules; degrees. The paper
    /// gives none.
    pub head_on_half_angle_deg: f64,
    /// What R is in (2), the radius of the disc around B.
    pub radius: RadiusKind,
    /// R in (2) is this many times what `radius` says.
    pub radius_factor: f64,
    /// Length, metres, of a target that does not report one (`radius = hull`).
    pub unknown_length_m: f64,
    /// The beat of Steps 1 to 10 in calls: plans on every so many and repeats the order between.
    pub beat_calls: u32,
    /// Largest number of passes of the loop from Step 9 to Step 2 in one beat; reaching it is
    /// counted (`inner_loop_cap` of the planner's events).
    pub inner_loop_cap: u32,
}

impl Default for ZhuangOptions {
    fn default() -> Self {
        Self {
            equations: Equations::Consistent,
            resume: Resume::Hold,
            memory: Memory::None,
            reference: Reference::LargestChange,
            head_on_half_angle_deg: 10.0,
            radius: RadiusKind::Mission,
            radius_factor: 1.0,
            unknown_length_m: UNKNOWN_LENGTH_M,
            beat_calls: 1,
            inner_loop_cap: 50,
        }
    }
}

impl ZhuangOptions {
    /// The paper letter by letter.
    pub fn as_printed() -> Self {
        Self { equations: Equations::AsPrinted, ..Self::default() }
    }

    /// The reading that starts from the goal velocity.
    pub fn goal_first() -> Self {
        Self { resume: Resume::GoalFirst, ..Self::default() }
    }

    /// The reading that resumes the goal velocity unchecked.
    pub fn when_safe() -> Self {
        Self { resume: Resume::WhenSafe, ..Self::default() }
    }

    /// The reading whose class holds for the beat.
    pub fn class_in_beat() -> Self {
        Self { memory: Memory::ClassInBeat, ..Self::default() }
    }

    /// The smallest repair: class and side are kept.
    pub fn latched() -> Self {
        Self { memory: Memory::Latched, ..Self::default() }
    }

    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        let half_angle_deg = self.head_on_half_angle_deg;
        if !(0.0..=67.5).contains(&half_angle_deg) {
            return Err(format!(
                "`head_on_half_angle_deg` is {half_angle_deg}; it must be from 0 to 67.5"
            ));
        }
        if !(self.radius_factor > 0.0 && self.radius_factor.is_finite()) {
            let factor = self.radius_factor;
            return Err(format!("`radius_factor` is {factor}; it must be above 0 and finite"));
        }
        if !(self.unknown_length_m >= 0.0 && self.unknown_length_m.is_finite()) {
            let length_m = self.unknown_length_m;
            return Err(format!("`unknown_length_m` is {length_m}; it must be 0 or more, finite"));
        }
        if self.beat_calls == 0 || self.inner_loop_cap == 0 {
            return Err("`beat_calls` and `inner_loop_cap` must be 1 or more".to_owned());
        }
        Ok(())
    }
}
