//! The nominal track from the wakes of a run is the one that is sailed alone, bit for bit.

mod scenes;

use geom::{Vec2, units::deg};
use planner_api::{Command, Mission, Planner, Situation};
use record::{
    Conduct, Digest, Encounter, Intent, Manner, Nominal, Outcome, RunUntil, ShipTrack, Trace, Turn,
    Vessel, Waypoint, Weather,
};
use scenes::{Meeting, Orders, Shy, hold, kinematic, rough, viknes};
use std::sync::atomic::AtomicU64;

fn duty(manner: Manner) -> Intent {
    Intent::Duty(Conduct {
        manner,
        act_tcpa_s: 80.0,
        risk_dcpa_m: 300.0,
        course_change_rad: deg(40.0),
        stand_on_tcpa_s: 30.0,
        stand_on_dcpa_m: 100.0,
    })
}

fn intents() -> Vec<Intent> {
    let point = |x: f64, y: f64| Waypoint { position_m: Vec2::new(x, y), speed_mps: Some(5.0) };
    let turn = |at_s, course_deg: f64| Turn { at_s, course_rad: deg(course_deg) };
    vec![
        Intent::HoldCourse,
        Intent::Alter { at_s: 60.0, course_rad: deg(150.0), speed_mps: 4.0 },
        Intent::Alter { at_s: 500.0, course_rad: deg(150.0), speed_mps: 4.0 },
        Intent::Track(vec![point(900.0, 300.0), point(500.0, -900.0)]),
        Intent::Turns(vec![turn(40.0, 130.0), turn(90.0, 60.0), turn(400.0, -30.0)]),
        duty(Manner::Complies),
        duty(Manner::Neglects),
        duty(Manner::WrongWay),
        Intent::Planner("shy".to_owned()),
    ]
}

/// One target of each vessel under an intent, and another ship that goes far off.
fn meeting(vessel: Vessel, intent: &Intent, miss_m: f64) -> Encounter {
    let meeting = Meeting { target_course_rad: deg(95.0), miss_m, ..Meeting::default() };
    let mut encounter = meeting.encounter(viknes(), vessel);
    let mut second = encounter.targets[0].clone();
    encounter.targets[0].intent = intent.clone();
    second.start.position_m += Vec2::new(2000.0, 900.0);
    encounter.targets.push(second);
    encounter.weather = rough();
    encounter.run.duration_s_max = 700.0;
    encounter
}

/// The trace of a run with its nominal track from the wakes, which is as the one sailed alone.
fn sailed(encounter: &Encounter, planner: &mut dyn Planner) -> Trace {
    let mut shy = |_: &str| -> Option<Box<dyn Planner>> { Some(Box::new(Shy { course_rad: 1.6 })) };
    let (mut scratch, beat) = (sim::Scratch::default(), AtomicU64::new(0));
    let voyage = sim::voyage(encounter, planner, &mut shy, &mut scratch, &beat);
    let alone = sim::nominal(encounter).expect("the encounter is sound");
    let mut expected = voyage.trace.clone();
    let trace = voyage.into_trace(encounter);
    let nominal = trace.nominal.as_ref().expect("the encounter is sound");
    assert_eq!(nominal.minima, alone.minima);
    for (one, other) in nominal.targets.iter().zip(&alone.targets) {
        assert_eq!(one.len(), other.len());
        assert!(one == other, "a target went another way");
    }
    let n = nominal.own.len();
    assert_eq!(n, alone.own.len().max(trace.samples()));
    goes_on(&nominal.own, encounter);
    expected.nominal = Some(Nominal { own: nominal.own.clone(), ..alone });
    assert_eq!(Digest::of_trace(&trace), Digest::of_trace(&expected));
    trace
}

/// Own ship's track is the one that she has where nothing ends it but the time, as far as it goes.
fn goes_on(own: &ShipTrack, encounter: &Encounter) {
    let mut endless = encounter.clone();
    endless.run.until = RunUntil::TimeIsUp;
    let on = sim::nominal(&endless).expect("the encounter is sound").own;
    let columns = |t: &ShipTrack| {
        [&t.north_m, &t.east_m, &t.psi_rad, &t.vel_north_mps, &t.vel_east_mps, &t.yaw_rate_radps]
            .map(|column| column[..own.len()].to_vec())
    };
    assert_eq!(columns(own), columns(&on));
}

/// The judges take her nominal heading off that of the run: one that ended before the run would
/// leave all that the weather turns her by.
#[test]
fn own_ship_goes_on_where_the_run_outlasts_her_nominal_track() {
    let mut calm = meeting(viknes(), &duty(Manner::WrongWay), 20.0);
    calm.weather = Weather::default();
    for encounter in [meeting(viknes(), &duty(Manner::Complies), 20.0), calm] {
        let trace = sailed(&encounter, &mut Orders(vec![(0.0, deg(95.0), 7.0)]));
        let nominal = trace.nominal.as_ref().unwrap();
        let over = nominal.targets[0].len();
        assert!(trace.samples() > over + 20, "{} {over}", trace.samples());
        assert_eq!(nominal.own.len(), trace.samples());
    }
}

#[test]
fn every_intent_leaves_the_wake_that_it_has_alone() {
    for intent in intents() {
        for vessel in [viknes(), kinematic(), Vessel::Model("frigate".to_owned())] {
            let encounter = meeting(vessel, &intent, 150.0);
            let trace = sailed(&encounter, &mut Shy { course_rad: 0.0 });
            assert!(trace.samples() > 100, "{intent:?}");
            // it outlasts the run here, and there it is the shorter one
            let mut long = encounter.clone();
            long.run.until = RunUntil::GoalReached;
            sailed(&long, &mut Orders(vec![(0.0, deg(20.0), 3.0)]));
            long.run.until = RunUntil::TimeIsUp;
            sailed(&long, &mut hold());
        }
    }
}

/// What own ship does changes a target under a duty, so that her wake must end: without that the
/// test above would say nothing of it.
#[test]
fn a_target_that_reacts_parts_from_her_nominal_track() {
    let encounter = meeting(viknes(), &duty(Manner::Complies), 20.0);
    let trace = sailed(&encounter, &mut hold());
    let nominal = trace.nominal.as_ref().unwrap();
    let least = trace.samples().min(nominal.targets[0].len());
    let (ran, alone) = (&trace.targets[0].psi_rad[..least], &nominal.targets[0].psi_rad[..least]);
    let parted = ran.iter().zip(alone).position(|(a, b)| (a - b).abs() > 0.0).unwrap();
    assert!((30..least).contains(&parted), "{parted}");
}

/// A planner that gives up at this beat.
struct GivesUp(usize);

impl Planner for GivesUp {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, _: &Situation<'_>) -> Command {
        self.0 = self.0.checked_sub(1).expect("gives up");
        Command::course_speed(0.0, 7.0)
    }
}

#[test]
fn the_nominal_track_outlasts_a_run_that_is_cut_short() {
    for intent in intents() {
        for beats in [0, 1, 61] {
            let encounter = meeting(viknes(), &intent, 150.0);
            let trace = sailed(&encounter, &mut GivesUp(beats));
            assert_eq!((trace.outcome, trace.samples()), (Outcome::PlannerPanicked, beats + 1));
        }
    }
    let (mut within, mut collided) = (0, 0);
    for step in 0..12 {
        for intent in [Intent::HoldCourse, duty(Manner::Neglects), intents()[4].clone()] {
            let mut encounter = meeting(viknes(), &intent, f64::from(step) - 6.0);
            // four steps a beat
            encounter.run.step_s = 0.25;
            encounter.weather.waves = None;
            let trace = sailed(&encounter, &mut Orders(vec![(0.0, 0.0, 7.0)]));
            let contact_s = trace.contact.map_or(0.0, |contact| contact.t_s);
            collided += u32::from(trace.outcome == Outcome::Collision);
            within += u32::from((contact_s.fract() * 4.0).floor() < 3.0 && contact_s > 0.0);
        }
    }
    assert!(collided > 10 && within > 5, "{collided} collided, {within} within a beat");
}

#[test]
fn an_encounter_that_cannot_be_run_has_none_either_way() {
    let mut encounter = meeting(viknes(), &Intent::HoldCourse, 150.0);
    encounter.run.step_s = f64::NAN;
    let (mut scratch, beat) = (sim::Scratch::default(), AtomicU64::new(0));
    let voyage = sim::voyage(&encounter, &mut hold(), &mut |_| None, &mut scratch, &beat);
    assert!(voyage.into_trace(&encounter).nominal.is_none());
}
