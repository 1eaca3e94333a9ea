//! Every check finds the fault that it is for.

use super::*;
use crate::{Command, Mission, Planner, PlannerStream, Situation};
use geom::wrap;
use std::sync::atomic::{AtomicU64, Ordering};

/// A planner with one fault, or none.
#[derive(Default)]
struct Faulty {
    fault: Option<Check>,
    beats: u32,
    made: u64,
    stream: Option<PlannerStream>,
}

static MADE: AtomicU64 = AtomicU64::new(0);
static CALLS: AtomicU64 = AtomicU64::new(0);

impl Planner for Faulty {
    fn reset(&mut self, mission: &Mission) {
        self.stream = Some(PlannerStream::new(mission.stream_seed));
        if self.fault != Some(Check::ResetsCompletely) {
            self.beats = 0;
        }
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        self.beats += 1;
        let calls = CALLS.fetch_add(1, Ordering::Relaxed);
        let own_m = situation.own.position_m;
        let first = situation.tracks[0].position_m - own_m;
        let nearest = situation.tracks.iter().map(|t| (t.position_m - own_m).norm());
        let range_m = nearest.fold(f64::INFINITY, f64::min);
        // Lawful: its own stream, time since reset, what lies around.
        let noise = self.stream.as_mut().expect("reset").uniform();
        let speed = 3.0 + noise + 0.01 * f64::from(self.beats) + 1e-3 * range_m.min(1e3);
        let (course, speed) = match self.fault {
            None | Some(Check::ResetsCompletely) => (0.0, speed),
            Some(Check::Answers) if self.beats == 7 => panic!("on purpose"),
            Some(Check::InRange) if self.beats == 7 => (0.0, -1.0),
            Some(Check::Deterministic) => (0.0, speed + 1e-12 * self.made as f64),
            Some(Check::OwnStreamOnly) => (0.0, speed + 1e-3 * (calls % 2) as f64),
            Some(Check::RotationIndifferent) => (0.1 * situation.own.psi_rad, speed),
            Some(Check::TranslationIndifferent) => (1e-4 * own_m.norm(), speed),
            Some(Check::PermutationStable) => (1e-4 * first.norm(), speed),
            _ => (0.0, speed),
        };
        Command::course_speed(wrap(situation.own.cog_rad + course), speed)
    }
}

fn failed(fault: Option<Check>) -> Vec<Check> {
    let make = || -> Box<dyn Planner> {
        let made = MADE.fetch_add(1, Ordering::Relaxed);
        Box::new(Faulty { fault, made, ..Faulty::default() })
    };
    check(&make).into_iter().map(|finding| finding.check).collect()
}

#[test]
fn a_planner_without_fault_has_no_finding() {
    assert_eq!(failed(None), []);
}

/// Every check finds the fault that it is for, and most of them nothing else.
#[test]
fn every_fault_is_found() {
    for fault in [
        Check::Answers,
        Check::InRange,
        Check::ResetsCompletely,
        Check::RotationIndifferent,
        Check::TranslationIndifferent,
        Check::PermutationStable,
    ] {
        assert_eq!(failed(Some(fault)), [fault]);
    }
    assert!(failed(Some(Check::Deterministic)).contains(&Check::Deterministic));
}

/// A planner that takes the north of an estimate for the whole of it is found by the scenes at sea.
#[test]
fn a_covariance_is_turned_with_its_scene() {
    struct NorthOnly;
    impl Planner for NorthOnly {
        fn reset(&mut self, _: &Mission) {}
        fn plan(&mut self, situation: &Situation<'_>) -> Command {
            let norths_m2 = situation.tracks.iter().map(|track| track.covariance[0][0]);
            let sd_m = norths_m2.fold(0.0, f64::max).sqrt();
            Command::course_speed(situation.own.cog_rad, 3.0 + 0.01 * sd_m)
        }
    }
    let findings = check(&|| Box::new(NorthOnly));
    let [Finding { check, scenes_failed, .. }] = &findings[..] else {
        panic!("{findings:#?}");
    };
    assert_eq!((*check, *scenes_failed), (Check::RotationIndifferent, SCENES as usize / 3));
}

/// A counter that all planners share is found when another one works beside.
#[test]
fn shared_state_is_found() {
    assert!(failed(Some(Check::OwnStreamOnly)).contains(&Check::OwnStreamOnly));
}
