//! Which way a target alters under each duty: in sight (Rules 13 to 15 and 17), and by radar alone
//! (Rule 19); each scene in its mirror image, too.

mod scenes;

use geom::{Vec2, units::deg, wrap};
use record::{Conduct, Encounter, Intent, Manner, RunUntil, Trace, Visibility};
use scenes::{Meeting, Orders, hold, kinematic, mirrored, run};

const COMPLIES: Conduct = Conduct {
    manner: Manner::Complies,
    act_tcpa_s: 90.0,
    risk_dcpa_m: 200.0,
    course_change_rad: deg(20.0),
    stand_on_tcpa_s: 40.0,
    stand_on_dcpa_m: 100.0,
};

/// Own ship north at 7 m/s; the target on this course at this speed passes `miss_m` off after
/// 150 s, to starboard of own ship's motion relative to her where that is positive.
fn scene(course_deg: f64, target_mps: f64, miss_m: f64, conduct: Conduct) -> Encounter {
    let target_course_rad = deg(course_deg);
    let meeting = Meeting { target_course_rad, target_mps, miss_m, ..Meeting::default() };
    let mut encounter = meeting.encounter(kinematic(), kinematic());
    encounter.targets[0].intent = Intent::Duty(conduct);
    encounter
}

fn in_fog(mut encounter: Encounter, visual_range_m: f64) -> Encounter {
    encounter.visibility = Visibility::Restricted { visual_range_m };
    encounter
}

/// The target's largest alteration to either side, degrees, and when the first one began.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Altered {
    starboard_deg: f64,
    port_deg: f64,
    at_s: Option<usize>,
}

fn altered(trace: &Trace) -> Altered {
    let psi_rad = &trace.targets[0].psi_rad;
    let off_deg = |psi: &f64| wrap(psi - psi_rad[0]).to_degrees();
    Altered {
        starboard_deg: psi_rad.iter().map(off_deg).fold(0.0, f64::max),
        port_deg: psi_rad.iter().map(off_deg).fold(0.0, |most, off| most.max(-off)),
        at_s: psi_rad.iter().position(|psi| off_deg(psi).abs() > 1e-9).map(|at| at - 1),
    }
}

fn starboard(trace: &Trace) -> bool {
    let altered = altered(trace);
    altered.starboard_deg >= 20.0 - 1e-9 && altered.port_deg < 1e-9
}

fn port(trace: &Trace) -> bool {
    let altered = altered(trace);
    altered.port_deg >= 20.0 - 1e-9 && altered.starboard_deg < 1e-9
}

/// Bearing of own ship from the target's bow at a sample, degrees.
fn bearing_deg(trace: &Trace, k: usize) -> f64 {
    let (own, target) = (&trace.own, &trace.targets[0]);
    let bearing_rad = geom::angle::direction(own.position_m(k) - target.position_m(k));
    wrap(bearing_rad - target.psi_rad[k]).to_degrees()
}

/// The same when they are nearest.
fn bearing_when_nearest_deg(trace: &Trace) -> f64 {
    let (own, target) = (&trace.own, &trace.targets[0]);
    let range_m = |k: &usize| (own.position_m(*k) - target.position_m(*k)).norm();
    let nearest = (0..trace.samples()).min_by(|a, b| range_m(a).total_cmp(&range_m(b)));
    bearing_deg(trace, nearest.expect("a run has a sample"))
}

/// She comes up from astern, own ship a little to one side of her course: she turns to the other
/// one, and passes at a distance.
#[test]
fn overtaking_ship_turns_away_from_the_side_own_ship_is_on() {
    for course_deg in [0.0, 15.0, 25.0] {
        for miss_m in [15.0, 60.0] {
            let own_to_port = scene(course_deg, 11.0, miss_m, COMPLIES);
            let trace = run(&own_to_port, &mut hold());
            let image = run(&mirrored(&own_to_port), &mut hold());
            let (seen, turned) = (altered(&trace), altered(&image));
            assert_eq!(
                (seen.starboard_deg, seen.port_deg),
                (turned.port_deg, turned.starboard_deg)
            );
            assert!(starboard(&trace) != port(&trace), "{course_deg} {miss_m} {seen:?}");
            let own_bears_deg = bearing_deg(&trace, seen.at_s.unwrap());
            assert_eq!(starboard(&trace), own_bears_deg < 0.0, "{course_deg} {miss_m} {seen:?}");
            assert!(trace.pairs[0].minimum.hull_m > 150.0, "{:?}", trace.pairs[0].minimum);
        }
    }
}

#[test]
fn ships_that_meet_end_on_pass_port_to_port() {
    for miss_m in [-120.0, -30.0, 0.0, 30.0, 120.0] {
        for course_deg in [172.0, 180.0, -172.0] {
            let trace = run(&scene(course_deg, 6.0, miss_m, COMPLIES), &mut hold());
            assert!(starboard(&trace), "{course_deg} {miss_m} {:?}", altered(&trace));
            assert!(bearing_when_nearest_deg(&trace) < 0.0, "{course_deg} {miss_m}");
            assert!(trace.pairs[0].minimum.centre_m > 190.0, "{:?}", trace.pairs[0].minimum);
        }
    }
}

/// A miss of either sign: she would pass ahead or astern, and passes astern.
#[test]
fn crossing_ship_that_gives_way_passes_astern() {
    for course_deg in [70.0, 90.0, 140.0] {
        for miss_m in [-120.0, 0.0, 120.0] {
            let trace = run(&scene(course_deg, 6.0, miss_m, COMPLIES), &mut hold());
            assert!(starboard(&trace), "{course_deg} {miss_m} {:?}", altered(&trace));
            assert!(bearing_when_nearest_deg(&trace) < 0.0, "{course_deg} {miss_m}");
            assert!(trace.pairs[0].minimum.centre_m > 190.0, "{:?}", trace.pairs[0].minimum);
        }
    }
}

/// Too late to pass astern, an alteration to starboard would bring her nearer: she keeps on.
#[test]
fn nobody_alters_into_a_nearer_passage() {
    let late = Conduct { act_tcpa_s: 15.0, ..COMPLIES };
    for miss_m in [150.0, -150.0] {
        let trace = run(&scene(90.0, 6.0, miss_m, late), &mut hold());
        let keeps = run(
            &scene(90.0, 6.0, miss_m, Conduct { manner: Manner::Neglects, ..late }),
            &mut hold(),
        );
        let (acts_m, keeps_m) = (trace.pairs[0].minimum.centre_m, keeps.pairs[0].minimum.centre_m);
        assert!(acts_m >= keeps_m - 1e-9, "{acts_m} {keeps_m}");
        let passes_ahead = bearing_when_nearest_deg(&keeps) > 0.0;
        assert_eq!(altered(&trace).at_s.is_none(), passes_ahead, "{miss_m}");
    }
}

/// From own starboard side she stands on: she holds while there is time, whatever the miss, and
/// acts in the end if own ship did nothing, never to port; where own ship gave way she does not.
#[test]
fn ship_that_stands_on_holds_and_then_acts_to_starboard() {
    for course_deg in [-40.0, -90.0, -140.0] {
        let encounter = scene(course_deg, 6.0, 0.0, COMPLIES);
        let trace = run(&encounter, &mut hold());
        assert!(starboard(&trace), "{course_deg} {:?}", altered(&trace));
        let relative_mps = geom::unit(deg(course_deg)) * 6.0 - Vec2::new(7.0, 0.0);
        let due_s = 150.0 - 40.0 - 20.0 / relative_mps.norm();
        assert!(
            (altered(&trace).at_s.unwrap() as f64 - due_s).abs() <= 1.0,
            "{:?}",
            altered(&trace)
        );
        // own ship goes astern of her
        let mut gives_way = Orders(vec![(0.0, 0.0, 7.0), (60.0, deg(50.0), 7.0)]);
        let trace = run(&encounter, &mut gives_way);
        assert_eq!(altered(&trace).at_s, None, "{course_deg}");
    }
}

#[test]
fn overtaken_ship_holds_and_then_turns_away() {
    let overtaken = scene(0.0, 3.0, 20.0, COMPLIES);
    let (trace, image) = (run(&overtaken, &mut hold()), run(&mirrored(&overtaken), &mut hold()));
    assert!(starboard(&trace) != starboard(&image) && port(&trace) != port(&image));
    assert!(altered(&trace).at_s.unwrap() > 100, "{:?}", altered(&trace));
    let keeps = scene(0.0, 3.0, 20.0, Conduct { manner: Manner::Neglects, ..COMPLIES });
    let keeps_m = run(&keeps, &mut hold()).pairs[0].minimum.centre_m;
    assert!(trace.pairs[0].minimum.centre_m > keeps_m, "{keeps_m}");
}

/// Beyond the range of sight nobody stands on: not to port for a ship forward of the beam, whatever
/// side she is on, not towards one abeam or abaft it.
#[test]
fn by_radar_every_ship_acts_as_rule_19_asks() {
    for (course_deg, target_mps) in [(-140.0, 6.0), (-90.0, 9.0), (90.0, 9.0), (180.0, 6.0)] {
        let trace = run(&in_fog(scene(course_deg, target_mps, 0.0, COMPLIES), 300.0), &mut hold());
        assert!(starboard(&trace), "{course_deg} {:?}", altered(&trace));
        assert!(altered(&trace).at_s.unwrap() < 65, "{course_deg} {:?}", altered(&trace));
        assert!(trace.pairs[0].minimum.centre_m > 190.0, "{course_deg}");
    }
    // slow, own ship comes up from abaft her beam on this or that side: she turns away from her
    for (course_deg, turns_to_port) in [(-30.0, false), (30.0, true), (-60.0, false), (60.0, true)]
    {
        let trace = run(&in_fog(scene(course_deg, 2.0, 0.0, COMPLIES), 100.0), &mut hold());
        assert_eq!(
            (starboard(&trace), port(&trace)),
            (!turns_to_port, turns_to_port),
            "{course_deg}"
        );
    }
}

/// A ship overtaken may be passed on either side in fog, too: 19(d)(i) leaves her out.
#[test]
fn by_radar_an_overtaking_ship_turns_to_either_side() {
    let astern = in_fog(scene(0.0, 11.0, 20.0, COMPLIES), 100.0);
    let (trace, image) = (run(&astern, &mut hold()), run(&mirrored(&astern), &mut hold()));
    assert!(starboard(&trace) && port(&image) || port(&trace) && starboard(&image));
}

/// The duty of Rule 17 begins where the ships come in sight: one who has not acted by radar by then
/// stands on.
#[test]
fn coming_in_sight_changes_the_rule() {
    let late = Conduct { act_tcpa_s: 60.0, stand_on_tcpa_s: 20.0, ..COMPLIES };
    let meeting = scene(-90.0, 6.0, 0.0, late);
    // 9.2 m/s of approach: in sight at 90 s or at 30 s to the closest point
    let seen_first = run(&in_fog(meeting.clone(), 830.0), &mut hold());
    let radar_first = run(&in_fog(meeting, 280.0), &mut hold());
    let at_s = |trace: &Trace| altered(trace).at_s.unwrap() as f64;
    assert!((at_s(&radar_first) - (90.0 - 2.2)).abs() <= 1.0, "{}", at_s(&radar_first));
    assert!((at_s(&seen_first) - (130.0 - 2.2)).abs() <= 1.0, "{}", at_s(&seen_first));
}

#[test]
fn wrong_way_is_the_nearer_passage_where_either_side_would_do() {
    let wrong = Conduct { manner: Manner::WrongWay, ..COMPLIES };
    for (course_deg, target_mps) in [(0.0, 11.0), (20.0, 11.0), (0.0, 3.0)] {
        for miss_m in [-90.0, 90.0] {
            let sails = |conduct| run(&scene(course_deg, target_mps, miss_m, conduct), &mut hold());
            let (astray, right) =
                (sails(wrong), sails(Conduct { stand_on_tcpa_s: 90.0, ..COMPLIES }));
            let least_m = |trace: &Trace| trace.pairs[0].minimum.centre_m;
            assert!(least_m(&astray) < least_m(&right), "{course_deg} {target_mps} {miss_m}");
        }
    }
    let port_crossing = run(&scene(-90.0, 6.0, 0.0, wrong), &mut hold());
    assert!(port(&port_crossing));
}

/// Past and clear she goes back, and a second meeting would be a new one.
#[test]
fn she_goes_back_only_where_that_brings_her_no_nearer() {
    for course_deg in [0.0, 35.0] {
        let mut encounter = scene(course_deg, 11.0, 15.0, COMPLIES);
        encounter.run.until = RunUntil::TimeIsUp;
        encounter.run.duration_s_max = 900.0;
        let trace = run(&encounter, &mut hold());
        let psi_rad = &trace.targets[0].psi_rad;
        assert!((psi_rad.last().unwrap() - psi_rad[0]).abs() < 1e-9, "{course_deg}");
        assert!(trace.pairs[0].minimum.hull_m > 150.0, "{:?}", trace.pairs[0].minimum);
    }
}
