//! The paper's Figs. 14 to 17 and two mirrors (specification of the seed planner, section 4.2):
//! what the paper says of each, and what comes out.

use crate::scene::{Scene, Vessel, planner};

pub(crate) fn fig_14() -> Scene {
    Scene::paper(6000.0, &[Vessel(0.0, 900.0, 3.5, 90.0)])
}

pub(crate) fn fig_15() -> Scene {
    Scene::paper(4500.0, &[Vessel(0.0, 3000.0, 6.0, -90.0)])
}

pub(crate) fn fig_16() -> Scene {
    Scene::paper(4500.0, &[Vessel(1500.0, 2000.0, 6.0, 180.0)])
}

pub(crate) fn fig_16_mirrored() -> Scene {
    Scene::paper(4500.0, &[Vessel(-1500.0, 2000.0, 6.0, 0.0)])
}

pub(crate) fn fig_17() -> Scene {
    let targets = [
        Vessel(-900.0, 1200.0, 6.0, 0.0),
        Vessel(1690.0, 2600.0, 5.0, 180.0),
        Vessel(20.0, 5200.0, 5.0, -90.0),
    ];
    Scene { radius_m: 120.0, detection_m: 700.0, ..Scene::paper(5500.0, &targets) }
}

/// The scenes that come out alike in every memory: side of the turn, and R kept to a metre.
#[test]
fn overtaking_and_crossing_come_out_as_the_paper_says() {
    let fig_14b = Scene::paper(6000.0, &[Vessel(-80.0, 900.0, 3.5, 85.0)]);
    let scenes = [(fig_14(), 1.0), (fig_14b, -1.0), (fig_16(), 1.0), (fig_16_mirrored(), -1.0)];
    for name in ["zhuang-as-printed", "zhuang", "zhuang-latched"] {
        for (scene, side) in &scenes {
            let run = scene.run(planner(name, "").as_mut());
            let turn = run.first_turn(2.0);
            assert!((turn - side).abs() < 0.5, "{name} {scene:?}: {turn}");
            let range_m = run.range_m_min();
            assert!((149.0..151.0).contains(&range_m), "{name} {scene:?}: {range_m}");
            assert!(run.goal_s.is_some(), "{name} {scene:?}");
        }
    }
}

/// Fig. 15 needs the memory that the paper does not have.
#[test]
fn head_on_is_the_papers_picture_only_when_latched() {
    let latched = fig_15().run(planner("zhuang-latched", "").as_mut());
    assert!(latched.first_turn(2.0) > 0.0);
    assert!(latched.reversal_deg() < 0.1, "{}", latched.reversal_deg());
    assert!((149.0..151.0).contains(&latched.range_m_min()) && latched.goal_s.is_some());
    assert!(latched.cpa[0].bearing_rad < 0.0, "port to port");
    let zhuang = fig_15().run(planner("zhuang", "").as_mut());
    assert!(zhuang.reversal_deg() > 10.0, "F1: {}", zhuang.reversal_deg());
}

/// Fig. 17: first to port for obstacle 1, which the paper calls compliant and Rule 17(c) does not.
#[test]
fn three_obstacles_are_passed_after_a_turn_to_port() {
    for name in ["zhuang", "zhuang-latched"] {
        let run = fig_17().run(planner(name, "").as_mut());
        assert!(run.first_turn(2.0) < 0.0, "{name}");
        assert!(run.range_m_min() > 119.0 && run.goal_s.is_some(), "{name}: {}", run.range_m_min());
    }
}
