//! F15: beside the border of two classes, a degree of noise in a target's course changes the side
//! on every beat.

use crate::scene::{Scene, Vessel, course_speed, planner, track};
use geom::{Vec2, units::deg, wrap};
use planner_api::{OwnState, Planner, Situation};

/// A target 700 m ahead on a collision course; its course is seen 9.5 degrees from reciprocal, then
/// 10.5, and so on. The head-on sector ends at 10.
fn changes_of_side(planner: &mut dyn Planner) -> u32 {
    planner.reset(&Scene::paper(6000.0, &[]).mission());
    let own = OwnState::steady(Vec2::zeros(), 0.0, 8.0);
    let mut changes = 0;
    let mut last = 0.0;
    for beat in 0..20 {
        let course_deg = if beat % 2 == 0 { -80.5 } else { -79.5 };
        let (x, y) = (-700.0 * geom::math::sin(deg(4.0)), 700.0 * geom::math::cos(deg(4.0)));
        let tracks = [track(1, Vessel(x, y, 6.0, course_deg), 0.0)];
        let t_s = f64::from(beat);
        let situation = Situation { t_s, own, tracks: &tracks, visual_range_m: None };
        let (course_rad, _) = course_speed(planner.plan(&situation), 0.0);
        let offset_rad = wrap(course_rad);
        assert!(offset_rad.abs() > deg(5.0), "a danger is answered: {offset_rad}");
        changes += u32::from(beat > 0 && offset_rad.signum() * last < 0.0);
        last = offset_rad.signum();
    }
    changes
}

#[test]
fn f15_the_side_changes_with_every_degree_of_noise() {
    let mut zhuang = planner("zhuang", "");
    assert_eq!(changes_of_side(zhuang.as_mut()), 19);
    assert_eq!(zhuang.events().class_changes, 19);
    let mut latched = planner("zhuang-latched", "");
    assert_eq!(changes_of_side(latched.as_mut()), 0);
}
