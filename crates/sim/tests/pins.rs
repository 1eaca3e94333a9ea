//! Digests of laboratory runs, so that what is added to the world leaves the laboratory alone.
//!
//! A change here is a change of every number of every campaign and belongs in the change log.

mod scenes;

use geom::{Vec2, units::deg};
use record::{Digest, Encounter, Intent, Waypoint};
use scenes::{Meeting, Shy, kinematic, run, viknes};

fn digest(encounter: &Encounter) -> String {
    let mut trace = run(encounter, &mut Shy { course_rad: 0.0 });
    trace.nominal = sim::nominal(encounter);
    Digest::of_trace(&trace).to_string()
}

#[test]
fn laboratory_runs_keep_their_digests() {
    let meeting = |angle_deg: f64, miss_m: f64| Meeting {
        target_course_rad: deg(angle_deg),
        miss_m,
        ..Meeting::default()
    };
    let crossing = meeting(-90.0, 30.0).encounter(viknes(), kinematic());
    let mut altering = meeting(180.0, 10.0).encounter(viknes(), viknes());
    altering.targets[0].intent =
        Intent::Alter { at_s: 60.0, course_rad: deg(150.0), speed_mps: 4.0 };
    let mut routed = meeting(20.0, -40.0).encounter(kinematic(), kinematic());
    let via = Waypoint { position_m: Vec2::new(900.0, 300.0), speed_mps: Some(5.0) };
    let to = Waypoint { position_m: Vec2::new(4000.0, -200.0), speed_mps: None };
    routed.targets[0].intent = Intent::Track(vec![via, to]);
    let mut drifting = crossing.clone();
    drifting.weather.current_mps = Vec2::new(0.4, -0.7);
    let digests = [crossing, altering, routed, drifting].map(|e| digest(&e));
    assert_eq!(digests, PINNED);
}

const PINNED: [&str; 4] =
    ["dfd39ce70ef0ff76", "ecfe506089b0807e", "a59496281ca7c399", "21c413f4a740c05e"];
