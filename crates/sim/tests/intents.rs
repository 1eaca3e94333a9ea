//! Targets that mind own ship, or fail to, and targets that run planners.

mod scenes;

use geom::{Vec2, units::deg, wrap};
use planner_api::{Command, Mission, Planner, Situation};
use record::{Conduct, Encounter, Intent, Manner, Outcome, RunUntil, Trace, Turn};
use scenes::{Meeting, Orders, Shy, hold, kinematic, run, viknes};
use std::sync::atomic::AtomicU64;

fn duty(manner: Manner, act_tcpa_s: f64) -> Intent {
    Intent::Duty(Conduct {
        manner,
        act_tcpa_s,
        risk_dcpa_m: 300.0,
        course_change_rad: deg(40.0),
        stand_on_tcpa_s: 10.0,
        stand_on_dcpa_m: 10.0,
    })
}

/// Own ship north at 7 m/s; the target on this course, passing 20 m off after 150 s.
fn meeting(course_deg: f64, intent: Intent) -> Encounter {
    let meeting = Meeting { target_course_rad: deg(course_deg), ..Meeting::default() };
    let mut encounter = meeting.encounter(kinematic(), kinematic());
    encounter.targets[0].intent = intent;
    encounter
}

/// When the target first leaves her course, and by how much she is off it 15 s later (degrees).
fn alteration(trace: &Trace) -> Option<(f64, f64)> {
    let psi_rad = &trace.targets[0].psi_rad;
    let at = psi_rad.iter().position(|psi| wrap(psi - psi_rad[0]).abs() > 1e-9)?;
    let later = psi_rad[(at + 15).min(psi_rad.len() - 1)];
    Some(((at - 1) as f64, wrap(later - psi_rad[0]).to_degrees()))
}

#[test]
fn duty_decides_who_alters_when_and_which_way() {
    // (target's course, what is enough where she has to give way): crossing from own starboard she
    // has own ship to port and stands on; from own port she gives way, and with the time that the
    // turn takes 40 degrees are not enough; reciprocal both give way
    for (course_deg, enough_deg) in [(-90.0, None), (90.0, Some(50.0)), (180.0, Some(40.0))] {
        let early = run(&meeting(course_deg, duty(Manner::Complies, 100.0)), &mut hold());
        let late = run(&meeting(course_deg, duty(Manner::Complies, 40.0)), &mut hold());
        // her bow is half her length, 20 m, ahead of the point that comes nearest
        let bow_s = 20.0 / (geom::unit(deg(course_deg)) * 6.0 - Vec2::new(7.0, 0.0)).norm();
        if let Some(enough_deg) = enough_deg {
            let (at_s, off_deg) = alteration(&early).unwrap();
            assert!((at_s - (50.0 - bow_s)).abs() <= 1.0, "{at_s}");
            assert!((off_deg - enough_deg).abs() < 1e-9_f64, "{off_deg}");
            assert!(early.pairs[0].minimum.centre_m >= 299.0, "{:?}", early.pairs[0].minimum);
            let (at_s, off_deg) = alteration(&late).unwrap();
            assert!((at_s - (110.0 - bow_s)).abs() <= 1.0, "{at_s}");
            assert!(off_deg >= 40.0 - 1e-9, "{off_deg}");
            assert!(early.pairs[0].minimum.centre_m > late.pairs[0].minimum.centre_m);
        } else {
            assert_eq!((alteration(&early), alteration(&late)), (None, None));
        }
        let neglects = run(&meeting(course_deg, duty(Manner::Neglects, 100.0)), &mut hold());
        assert_eq!(alteration(&neglects), None);
        let wrong = run(&meeting(course_deg, duty(Manner::WrongWay, 100.0)), &mut hold());
        let (at_s, off_deg) = alteration(&wrong).unwrap();
        assert!((at_s - (50.0 - bow_s)).abs() <= 1.0, "{at_s}");
        assert!((off_deg + 40.0).abs() < 1e-9, "{off_deg}");
    }
}

#[test]
fn nobody_alters_on_the_first_glance() {
    let (at_s, _) =
        alteration(&run(&meeting(90.0, duty(Manner::Complies, 140.0)), &mut hold())).unwrap();
    assert!((at_s - 30.0).abs() <= 1.0, "{at_s}");
}

#[test]
fn she_goes_back_to_her_course_when_clear() {
    let mut encounter = meeting(90.0, duty(Manner::Complies, 120.0));
    encounter.run.until = RunUntil::TimeIsUp;
    encounter.run.duration_s_max = 400.0;
    let trace = run(&encounter, &mut hold());
    let psi_rad = &trace.targets[0].psi_rad;
    assert!((psi_rad.last().unwrap() - psi_rad[0]).abs() < 1e-9, "{:?}", psi_rad.last());
}

/// What own ship does moves a target that minds her, and moves no other; on the nominal track
/// nobody reacts.
#[test]
fn only_a_duty_reacts_and_the_nominal_track_never_does() {
    let turns = Intent::Turns(vec![
        Turn { at_s: 20.0, course_rad: deg(130.0) },
        Turn { at_s: 50.0, course_rad: deg(60.0) },
    ]);
    let away = || Orders(vec![(0.0, 0.0, 7.0), (10.0, deg(-90.0), 7.0)]);
    for (intent, reacts) in [(turns, false), (duty(Manner::Complies, 100.0), true)] {
        let encounter = meeting(90.0, intent);
        let (one, other) = (run(&encounter, &mut hold()), run(&encounter, &mut away()));
        let least = one.samples().min(other.samples());
        let same = one.targets[0].psi_rad[..least] == other.targets[0].psi_rad[..least];
        assert_eq!(same, !reacts);
        let nominal = sim::nominal(&encounter).unwrap();
        let least = nominal.own.len().min(one.samples());
        let same = nominal.targets[0].psi_rad[..least] == one.targets[0].psi_rad[..least];
        assert_eq!(same, !reacts);
    }
}

#[test]
fn turns_are_made_at_their_times() {
    let turns = vec![
        Turn { at_s: 20.0, course_rad: deg(130.0) },
        Turn { at_s: 50.5, course_rad: deg(60.0) },
    ];
    let trace = run(&meeting(90.0, Intent::Turns(turns.clone())), &mut hold());
    let psi_rad = &trace.targets[0].psi_rad;
    for (k, expected_deg) in [(20, 90.0), (40, 130.0), (51, 130.0), (70, 60.0)] {
        assert!((psi_rad[k] - deg(expected_deg)).abs() < 1e-9, "{k}");
    }
    let backwards = turns.into_iter().rev().collect();
    let refused = sim::check(&meeting(90.0, Intent::Turns(backwards))).unwrap_err();
    assert_eq!(refused.to_string(), "turn 1 of target 0 comes before the one before it");
}

fn run_among(encounter: &Encounter, peers: &mut sim::MakePeer<'_>) -> Trace {
    let (mut scratch, beat) = (sim::Scratch::default(), AtomicU64::new(0));
    sim::run_among(encounter, &mut Shy { course_rad: 0.0 }, peers, &mut scratch, &beat)
}

/// Head-on at no offset, one planner on both ships: turned by half a turn the scene is its own
/// image, so both tracks are, to rounding.
#[test]
fn a_planner_meets_itself() {
    let head_on = Meeting {
        target_course_rad: deg(180.0),
        miss_m: 30.0,
        target_mps: 7.0,
        target_length_m: 8.45,
        ..Meeting::default()
    };
    let mut encounter = head_on.encounter(viknes(), viknes());
    encounter.targets[0].intent = Intent::Planner("shy".to_owned());
    let trace = run_among(&encounter, &mut |name| {
        assert_eq!(name, "shy");
        Some(Box::new(Shy { course_rad: deg(180.0) }))
    });
    assert_eq!(trace.outcome, Outcome::Completed);
    let target = &trace.targets[0];
    let centre_m = (trace.own.position_m(0) + target.position_m(0)) * 0.5;
    for k in 0..trace.samples() {
        let image_m = centre_m * 2.0 - target.position_m(k);
        assert!((image_m - trace.own.position_m(k)).norm() < 1e-6, "{k}");
    }
    let straight = run(&head_on.encounter(viknes(), viknes()), &mut Shy { course_rad: 0.0 });
    assert!(trace.pairs[0].minimum.centre_m > straight.pairs[0].minimum.centre_m + 1.0);
    assert!(target.psi_rad.iter().any(|psi| wrap(psi - deg(180.0)).abs() > 0.1));
}

#[test]
fn a_peer_that_fails_makes_the_encounter_invalid() {
    struct Panics(f64);
    impl Planner for Panics {
        fn reset(&mut self, _: &Mission) {}
        fn plan(&mut self, situation: &Situation<'_>) -> Command {
            assert!(situation.t_s < 5.0, "on purpose");
            assert_eq!(situation.tracks.len(), 1);
            Command::course_speed(self.0, 6.0)
        }
    }
    let encounter = meeting(90.0, Intent::Planner("any".to_owned()));
    assert_eq!(run_among(&encounter, &mut |_| None).outcome, Outcome::Invalid);
    let panics = run_among(&encounter, &mut |_| Some(Box::new(Panics(1.0))));
    assert_eq!((panics.outcome, panics.end_s.round() as i32), (Outcome::Invalid, 5));
    let nonsense = run_among(&encounter, &mut |_| Some(Box::new(Panics(f64::NAN))));
    assert_eq!(nonsense.outcome, Outcome::Invalid);
}
