//! What the seed planner remembers, beat by beat.

use crate::scene::{Scene, Vessel, planner, track};
use geom::{Vec2, units::deg};
use planner_api::{OwnState, Planner, Situation};

/// Shows own ship at the origin, on these compass courses at 8 m/s, one target in these places.
fn show(planner: &mut dyn Planner, beats: &[(f64, Vessel)]) -> u32 {
    planner.reset(&Scene::paper(6000.0, &[]).mission());
    for (beat, &(course_deg, vessel)) in beats.iter().enumerate() {
        let own = OwnState::steady(Vec2::zeros(), deg(course_deg), 8.0);
        let tracks = [track(4, vessel, 0.0)];
        let t_s = beat as f64;
        planner.plan(&Situation { t_s, own, tracks: &tracks, visual_range_m: None });
    }
    planner.events().class_changes
}

/// A target that crosses from starboard, and later lies near on the port bow.
const CROSSING: Vessel = Vessel(300.0, 400.0, 6.0, 180.0);
const ON_PORT_BOW: Vessel = Vessel(-30.0, 157.0, 6.0, 180.0);

/// Turned away the range opens, but with the goal velocity it would close: not yet clear.
#[test]
fn a_latch_outlives_a_turn_away() {
    let beats = [(0.0, CROSSING), (180.0, CROSSING), (0.0, ON_PORT_BOW)];
    assert_eq!(show(planner("zhuang-latched", "").as_mut(), &beats), 0);
    assert_eq!(show(planner("zhuang", "").as_mut(), &beats), 1);
}

/// Past and clear, the same target is a new encounter.
#[test]
fn a_latch_ends_when_past_and_clear() {
    let astern = Vessel(-300.0, -400.0, 6.0, 180.0);
    let beats = [(0.0, CROSSING), (0.0, astern), (0.0, ON_PORT_BOW)];
    assert_eq!(show(planner("zhuang-latched", "").as_mut(), &beats), 1);
    // inside R it is not clear, even if it opens
    let near_astern = Vessel(-90.0, -100.0, 6.0, 180.0);
    let beats = [(0.0, CROSSING), (0.0, near_astern), (0.0, ON_PORT_BOW)];
    assert_eq!(show(planner("zhuang-latched", "").as_mut(), &beats), 0);
}
