//! Land on the chart: the corrected planner gives way without running aground, and lets land that
//! is not in the way alone.

use crate::scene::{Run, Scene, Vessel, planner};
use geom::{Vec2, polygon, segment_min_distance};

/// Head-on, with a quay to starboard; the quay's near side lies `off_m` from the route.
fn beside_a_quay(off_m: f64) -> Scene {
    let quay = vec![(off_m, 150.0), (off_m, 1100.0), (off_m + 40.0, 1100.0), (off_m + 40.0, 150.0)];
    Scene {
        own: Vessel(0.0, 0.0, 5.0, 90.0),
        cruise_mps: 5.0,
        radius_m: 50.0,
        detection_m: 2000.0,
        land: vec![quay],
        ..Scene::paper(2500.0, &[Vessel(0.0, 1200.0, 4.0, -90.0)])
    }
}

/// Smallest distance of the reference point from land, metres; 0 on it.
fn off_land_m(run: &Run, scene: &Scene) -> f64 {
    let hazards = scene.mission().hazards;
    let mut least_m = f64::INFINITY;
    for beat in &run.beats {
        for outline in &hazards {
            if polygon::contains(outline, beat.position_m) {
                return 0.0;
            }
            for [from_m, to_m] in polygon::edges(outline) {
                let off = |corner_m: Vec2| corner_m - beat.position_m;
                least_m = least_m.min(segment_min_distance(off(from_m), off(to_m)).0);
            }
        }
    }
    least_m
}

#[test]
fn giving_way_does_not_lead_aground() {
    let run = |scene: &Scene| scene.run(planner("zhuang-corrected", "").as_mut());
    for off_m in [70.0, 100.0, 150.0, 200.0] {
        let scene = beside_a_quay(off_m);
        let seeing = run(&scene);
        let (off_m, range_m) = (off_land_m(&seeing, &scene), seeing.range_m_min());
        assert!(off_m > 15.0, "{off_m}");
        assert!(range_m > 50.0, "{range_m}");
        assert!(seeing.goal_s.is_some());
    }
    let near = beside_a_quay(70.0);
    let blind = run(&Scene { land: Vec::new(), ..near.clone() });
    assert!(off_land_m(&blind, &near) <= 0.0, "the scene does not need the chart");
}

#[test]
fn land_out_of_the_way_changes_nothing() {
    let scene = beside_a_quay(-700.0);
    let with = scene.run(planner("zhuang-corrected", "").as_mut());
    let without = Scene { land: Vec::new(), ..scene }.run(planner("zhuang-corrected", "").as_mut());
    let places = |run: &Run| run.beats.iter().map(|beat| beat.position_m).collect::<Vec<_>>();
    assert_eq!(places(&with), places(&without));
}
