//! The conformance kit: what every planner must satisfy, whoever wrote it.
//!
//! An author's own test is one line:
//!
//! ```
//! # use planner_api::{Command, Mission, Planner, Situation, conformance};
//! # struct Mine { course_rad: f64 }
//! # impl Planner for Mine {
//! #     fn reset(&mut self, mission: &Mission) {
//! #         let goal_m = mission.goal_m();
//! #         self.course_rad = 0.0 * goal_m.x;
//! #     }
//! #     fn plan(&mut self, situation: &Situation<'_>) -> Command {
//! #         Command::course_speed(situation.own.cog_rad, situation.own.sog_mps)
//! #     }
//! # }
//! let findings = conformance::check(&|| Box::new(Mine { course_rad: 0.0 }));
//! assert!(findings.is_empty(), "{findings:#?}");
//! ```
//!
//! The kit shows a planner a few dozen scripted scenes in open water: own ship and up to four
//! targets on straight lines, whatever is ordered. So the same inputs can be shown again turned,
//! moved or in another order, and the answers compared beat by beat. The scenes come from a fixed
//! stream and are nowhere symmetric, so that rounding cannot tip a balance. Costs some 10,000
//! calls and 200 makings of the planner.

mod answers;
mod scene;
#[cfg(test)]
mod tests;

use crate::Planner;
use geom::Vec2;
use scene::Scene;
use std::fmt;

/// What is asked of a planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Check {
    /// It answers: no panic.
    Answers,
    /// Its orders are finite and in range ([`Order::checked`]).
    InRange,
    /// Two planners made alike answer alike, bit for bit.
    Deterministic,
    /// After `reset` it answers as a new one would, bit for bit, and its events start again.
    ResetsCompletely,
    /// Another planner at work beside it changes nothing, bit for bit: no shared state, no random
    /// numbers but its own stream.
    OwnStreamOnly,
    /// A turned scene turns the order by as much.
    RotationIndifferent,
    /// A moved scene leaves the order as it is.
    TranslationIndifferent,
    /// The order of the tracks does not matter.
    PermutationStable,
}

impl Check {
    /// All of them, in order.
    pub const ALL: [Self; 8] = [
        Self::Answers,
        Self::InRange,
        Self::Deterministic,
        Self::ResetsCompletely,
        Self::OwnStreamOnly,
        Self::RotationIndifferent,
        Self::TranslationIndifferent,
        Self::PermutationStable,
    ];
}

/// A check that a planner does not satisfy.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The check.
    pub check: Check,
    /// Scenes in which it fails.
    pub scenes_failed: usize,
    /// Scenes in all.
    pub scenes: usize,
    /// The first of them.
    pub example: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { check, scenes_failed, scenes, example } = self;
        write!(f, "{check:?}: fails in {scenes_failed} of {scenes} scenes, first {example}")
    }
}

const SCENES: u64 = 24;
/// Turns in radians; odd ones, so that every quadrant boundary is crossed.
const TURNS_RAD: [f64; 3] = [0.83, 2.31, -1.97];
const SHIFT_M: Vec2 = Vec2::new(12_345.25, -6_789.5);

/// Every check that the planner fails, in the order of [`Check`]; none if it conforms.
pub fn check(make: &dyn Fn() -> Box<dyn Planner>) -> Vec<Finding> {
    let mut findings: Vec<Finding> = Vec::new();
    let mut used = make();
    let scenes = SCENES as usize;
    for number in 0..SCENES {
        let scene = Scene::new(number);
        for (check, what) in check_scene(make, used.as_mut(), &scene) {
            let example = format!("scene {number}: {what}");
            match findings.iter_mut().find(|finding| finding.check == check) {
                Some(finding) => finding.scenes_failed += 1,
                None => {
                    findings.push(Finding { check, scenes_failed: 1, scenes, example });
                }
            }
            if check == Check::Answers {
                used = make();
            }
        }
    }
    findings.sort_by_key(|finding| finding.check);
    findings
}

/// At most one failure of each check.
fn check_scene(
    make: &dyn Fn() -> Box<dyn Planner>,
    used: &mut dyn Planner,
    scene: &Scene,
) -> Vec<(Check, String)> {
    let mut failed = Vec::new();
    let Some(alone) = scene.run(make().as_mut()) else {
        return vec![(Check::Answers, "it panicked".to_owned())];
    };
    let in_range = alone.orders.iter().zip(1..).find_map(|(order, beat)| {
        order.as_ref().err().map(|error| format!("beat {beat}: {error}"))
    });
    failed.extend(in_range.map(|what| (Check::InRange, what)));

    let mut other = make();
    let again = scene.run(other.as_mut());
    failed.extend(alone.differs_in_a_bit(again.as_ref()).map(|w| (Check::Deterministic, w)));
    // `used` comes from another scene
    let reset = scene.run(used);
    failed.extend(alone.differs_in_a_bit(reset.as_ref()).map(|w| (Check::ResetsCompletely, w)));
    let beside = scene.run_beside(make().as_mut(), other.as_mut());
    failed.extend(alone.differs_in_a_bit(beside.as_ref()).map(|w| (Check::OwnStreamOnly, w)));

    let mut compare = |check: Check, changed: &Scene, turn_rad: f64| {
        let answers = changed.run(make().as_mut());
        let difference = alone.differs_by_more_than_rounding(answers.as_ref(), turn_rad);
        if let Some(what) = difference
            && failed.iter().all(|(known, _)| *known != check)
        {
            failed.push((check, what));
        }
    };
    for turn_rad in TURNS_RAD {
        compare(Check::RotationIndifferent, &scene.turned(turn_rad), turn_rad);
    }
    compare(Check::TranslationIndifferent, &scene.moved(SHIFT_M), 0.0);
    compare(Check::PermutationStable, &scene.permuted(), 0.0);
    failed
}
