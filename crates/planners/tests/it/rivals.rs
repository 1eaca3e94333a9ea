//! The rivals do what their papers say of them.

use crate::figures::{fig_14, fig_15, fig_16, fig_16_mirrored};
use crate::scene::{Scene, Vessel, planner};

fn in_sight(scene: Scene) -> Scene {
    Scene { detection_m: f64::INFINITY, ..scene }
}

/// Starboard for head-on and for crossing from starboard, and at least R from everybody.
#[test]
fn rivals_that_know_the_rules_turn_to_starboard() {
    for name in ["kuwata-vo", "sb-mpc", "zhuang-corrected"] {
        for scene in [in_sight(fig_15()), in_sight(fig_16())] {
            let run = scene.run(planner(name, "").as_mut());
            // more than one step of the grid: the search of `kuwata-vo` wavers by that much
            assert!(run.first_turn(3.0) > 0.0, "{name} {scene:?}");
            assert!(run.range_m_min() >= 150.0, "{name}: {}", run.range_m_min());
            assert!(run.cpa[0].bearing_rad < 0.0, "{name}: passed to port");
            assert!(run.goal_s.is_some(), "{name}");
        }
    }
}

/// Crossing from starboard passes ahead or astern as it pleases: to port here.
#[test]
fn plain_vo_is_blind_to_the_rules_and_keeps_its_distance() {
    let scenes = [fig_14(), fig_15(), fig_16(), fig_16_mirrored()].map(in_sight);
    for scene in &scenes {
        let run = scene.run(planner("plain-vo", "").as_mut());
        assert!(run.range_m_min() >= 150.0, "{}", run.range_m_min());
    }
    let crossing = scenes[2].run(planner("plain-vo", "").as_mut());
    assert!(crossing.first_turn(2.0) < 0.0);
}

/// Without the regions of the rules it is plain velocity obstacles.
#[test]
fn the_regions_of_the_rules_make_the_side() {
    let options = "rule_penalty = 1e-9";
    let without = in_sight(fig_16()).run(planner("kuwata-vo", options).as_mut());
    assert!(without.first_turn(2.0) < 0.0);
}

/// The paper's asymmetry, pinned: a target that is passed on either side at the same cost is
/// passed to starboard, and a cheap port side turns that around. kappa = 0 leaves only the gains.
#[test]
fn sb_mpc_pays_more_for_port() {
    let scene = in_sight(Scene::paper(4500.0, &[Vessel(0.0, 1500.0, 0.0, 0.0)]));
    let first = |options: &str| scene.run(planner("sb-mpc", options).as_mut()).first_turn(2.0);
    assert!(first("kappa = 0.0") > 0.0);
    let cheap_port = "kappa = 0.0\nk_chi_port = 0.1\nk_dchi_port = 0.1";
    assert!(first(cheap_port) < 0.0);
}

/// An overtaken target may be passed on either side; the corrected planner keeps the one it chose.
#[test]
fn the_corrected_planner_overtakes_with_one_apparent_alteration() {
    let run = in_sight(fig_14()).run(planner("zhuang-corrected", "").as_mut());
    let (starboard_deg, port_deg) = run.offsets_deg();
    assert!((30.0..70.0).contains(&starboard_deg.max(port_deg)), "{starboard_deg} {port_deg}");
    assert!(run.range_m_min() >= 200.0, "{}", run.range_m_min());
}

/// Stand-on: straight on until 700 m, then not to port.
#[test]
fn the_corrected_planner_stands_on_and_then_acts_to_starboard_or_slows() {
    let scene = in_sight(fig_16_mirrored());
    let run = scene.run(planner("zhuang-corrected", "").as_mut());
    let target = scene.targets[0];
    let mut own_m = geom::Vec2::zeros();
    for beat in &run.beats {
        let los_m = target.position_m() + target.velocity_mps() * beat.t_s - own_m;
        if los_m.norm() < 700.0 {
            break;
        }
        assert!(beat.psi_rad.abs() < 1e-9 && (beat.speed_mps - 8.0).abs() < 1e-9, "{beat:?}");
        own_m += geom::angle::unit(beat.psi_rad) * beat.speed_mps;
    }
    let (_, port_deg) = run.offsets_deg();
    assert!(run.first_turn(2.0) > 0.0 && port_deg < 15.0, "{port_deg}");
    assert!(run.range_m_min() >= 150.0, "{}", run.range_m_min());
}
