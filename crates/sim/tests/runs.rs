//! Whole runs: outcomes, laws, and what the judge must find in the trace.

mod scenes;

use geom::{Vec2, units::deg};
use planner_api::{Command, FailureKind, Mission, Planner, PlannerFailure, Situation};
use proptest::prelude::*;
use record::{
    ContactWith, Digest, Encounter, Outcome, RunUntil, Sensing, ShipTrack, Trace, Vessel,
};
use scenes::{Meeting, Orders, Shy, hold, kinematic, mirrored, moved, run, viknes};
use std::sync::atomic::{AtomicU64, Ordering};

fn meeting(angle_deg: f64, miss_m: f64) -> Meeting {
    Meeting { target_course_rad: deg(angle_deg), miss_m, ..Meeting::default() }
}

#[test]
fn holding_into_a_head_on_meeting_is_a_collision_when_the_bows_meet() {
    for (own, target) in [(kinematic(), kinematic()), (viknes(), kinematic())] {
        let encounter = meeting(180.0, 0.0).encounter(own, target);
        let trace = run(&encounter, &mut hold());
        assert_eq!(trace.outcome, Outcome::Collision);
        let contact = trace.contact.unwrap();
        // 13 m/s of closing over the half lengths of 8.45 and 40 m; the sweep stops 1 mm short
        let expected_s = 150.0 - (4.225 + 20.0) / 13.0;
        assert!((contact.t_s - expected_s).abs() < 3e-4, "{} {expected_s}", contact.t_s);
        assert_eq!(contact.with, ContactWith::Target(0));
        assert!((contact.impact_mps - 13.0).abs() < 1e-6);
        assert!(contact.energy_lost_j > 0.0 && contact.impulse_ns > 0.0);
        assert!((trace.end_s - contact.t_s).abs() <= 0.0);
        assert!(trace.pairs[0].minimum.hull_m <= 0.0);
        assert_eq!(trace.samples(), 149);
        assert_eq!(trace.orders.len(), 149);
    }
}

#[test]
fn passing_is_completed_and_release_can_be_seen() {
    for angle_deg in [180.0, -90.0, 90.0, 30.0] {
        let encounter = meeting(angle_deg, 100.0).encounter(viknes(), kinematic());
        let trace = run(&encounter, &mut hold());
        assert_eq!(trace.outcome, Outcome::Completed, "{angle_deg}");
        let n = trace.samples();
        assert_eq!(trace.end_s.to_bits(), ((n - 1) as f64).to_bits());
        for k in n - 11..n {
            let offset = trace.targets[0].position_m(k) - trace.own.position_m(k);
            let relative = trace.targets[0].velocity_mps(k) - trace.own.velocity_mps(k);
            assert!(offset.dot(&relative) > 0.0 && offset.norm() > 300.0, "{angle_deg} {k}");
        }
        let minimum = trace.pairs[0].minimum;
        assert!((minimum.centre_m - 100.0).abs() < 1e-6);
        let least = trace.pairs[0].hull_m.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        assert!((least - minimum.hull_m).abs() < 1e-12);
    }
}

#[test]
fn far_pass_still_has_an_exact_minimum() {
    let trace = run(&meeting(-90.0, 900.0).encounter(kinematic(), kinematic()), &mut hold());
    let minimum = trace.pairs[0].minimum;
    assert!((minimum.centre_m - 900.0).abs() < 1e-6);
    // hull distance is less than the centre distance by no more than both radii
    assert!(minimum.hull_m < 900.0 - 4.0 && minimum.hull_m > 900.0 - 25.0);
    assert!((minimum.hull_s - 150.0).abs() < 5.0);
    assert!(trace.pairs[0].hull_m.iter().all(|bound| *bound <= minimum.hull_m || *bound > 300.0));
}

#[test]
fn truncated_and_time_is_up() {
    let mut encounter = meeting(-90.0, 200.0).encounter(kinematic(), kinematic());
    encounter.run.duration_s_max = 100.0;
    let cut = run(&encounter, &mut hold());
    assert_eq!((cut.outcome, cut.samples()), (Outcome::Truncated, 101));
    encounter.run.duration_s_max = 500.0;
    encounter.run.until = RunUntil::TimeIsUp;
    assert_eq!(run(&encounter, &mut hold()).samples(), 501);
    encounter.run.until = RunUntil::GoalReached;
    encounter.own.route[0].position_m = Vec2::new(3000.0, 0.0);
    let there = run(&encounter, &mut hold());
    assert_eq!(there.outcome, Outcome::Completed);
    assert!(there.goal_reached);
    // turning radius 7 m/s / 6 deg/s = 66.8 m before the goal
    assert!((there.end_s - (3000.0 - 66.8) / 7.0).abs() < 1.0, "{}", there.end_s);
}

/// What a planner does at 20 s.
type Failure = fn(&AtomicU64) -> Command;

struct Failing(Failure, std::sync::Arc<AtomicU64>);

impl Planner for Failing {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        if situation.t_s >= 20.0 { self.0(&self.1) } else { Command::course_speed(0.0, 7.0) }
    }
}

#[test]
fn planner_failures_are_outcomes() {
    let encounter = meeting(-90.0, 200.0).encounter(kinematic(), kinematic());
    let cases: [(Failure, Outcome); 5] = [
        (|_| panic!("planted"), Outcome::PlannerPanicked),
        (|_| Command::course_speed(f64::NAN, 7.0), Outcome::PlannerNonFinite),
        (|_| Command::course_speed(0.0, f64::INFINITY), Outcome::PlannerNonFinite),
        (|_| Command::course_speed(7.0, 7.0), Outcome::PlannerOutOfRange),
        (|_| Command::course_speed(0.0, 12.1), Outcome::PlannerOutOfRange),
    ];
    for (failure, outcome) in cases {
        let beat = std::sync::Arc::new(AtomicU64::new(0));
        let mut planner = Failing(failure, beat.clone());
        let trace = sim::run(&encounter, &mut planner, &mut sim::Scratch::default(), &beat);
        assert_eq!(trace.outcome, outcome);
        assert!((trace.end_s - 20.0).abs() < 1e-12);
        assert_eq!((trace.samples(), trace.orders.len()), (21, 20));
        // its sector, reset, 21 beats, events: two counts each
        assert_eq!(beat.load(Ordering::Relaxed), 48);
    }
}

/// What a planner says of its own failure reaches the trace, and changes no digest.
#[test]
fn last_words_of_a_planner_are_kept() {
    let encounter = meeting(-90.0, 200.0).encounter(kinematic(), kinematic());
    let failed = |failure: Failure| {
        let beat = std::sync::Arc::new(AtomicU64::new(0));
        let mut planner = Failing(failure, beat.clone());
        sim::run(&encounter, &mut planner, &mut sim::Scratch::default(), &beat)
    };
    let crash: Failure = |_| {
        let detail = "exit status 3; it said: no memory".to_owned();
        PlannerFailure { kind: FailureKind::Crashed, detail }.raise()
    };
    let other: Failure = |_| {
        PlannerFailure { kind: FailureKind::Crashed, detail: "another word".to_owned() }.raise()
    };
    let crashed = failed(crash);
    assert_eq!(crashed.outcome, Outcome::PlannerCrashed);
    assert_eq!(crashed.planner_detail.as_deref(), Some("exit status 3; it said: no memory"));
    assert_eq!(record::Digest::of_trace(&crashed), record::Digest::of_trace(&failed(other)));
    assert_eq!(failed(|_| panic!("planted")).planner_detail.as_deref(), Some("planted"));
    assert_eq!(run(&encounter, &mut hold()).planner_detail, None);
}

#[test]
fn inside_a_call_the_count_is_odd() {
    let encounter = meeting(-90.0, 200.0).encounter(kinematic(), kinematic());
    let beat = std::sync::Arc::new(AtomicU64::new(0));
    let look = |beat: &AtomicU64| {
        assert_eq!(beat.load(Ordering::Relaxed) % 2, 1);
        Command::course_speed(0.0, 7.0)
    };
    let trace =
        sim::run(&encounter, &mut Failing(look, beat.clone()), &mut sim::Scratch::default(), &beat);
    assert_eq!(trace.outcome, Outcome::Completed);
}

#[test]
fn refused_encounters_are_invalid_and_say_why() {
    let good = meeting(-90.0, 200.0).encounter(kinematic(), kinematic());
    let spoil = |f: fn(&mut Encounter)| {
        let mut bad = good.clone();
        f(&mut bad);
        let trace = sim::run(&bad, &mut hold(), &mut sim::Scratch::default(), &AtomicU64::new(0));
        assert_eq!((trace.outcome, trace.samples()), (Outcome::Invalid, 0));
        assert!(sim::nominal(&bad).is_none());
        sim::check(&bad).unwrap_err().to_string()
    };
    let unknown = spoil(|e| e.own.vessel = Vessel::Model("titanic".to_owned()));
    assert!(unknown.contains("titanic") && unknown.contains("viknes"), "{unknown}");
    assert!(spoil(|e| e.targets.clear()).contains("no target"));
    assert!(spoil(|e| e.run.step_s = 0.3).contains("does not divide"));
    assert!(spoil(|e| e.targets[0].start.position_m.x = f64::NAN).contains("target 0"));
    assert!(spoil(|e| e.own.start.speed_mps = 13.0).contains("largest speed"));
    assert!(spoil(|e| e.targets[0].start.position_m = Vec2::new(1.0, 1.0)).contains("overlap"));
}

#[test]
fn tracks_appear_within_detection_range() {
    struct Look(Vec<(f64, usize)>);
    impl Planner for Look {
        fn reset(&mut self, _: &Mission) {}
        fn plan(&mut self, situation: &Situation<'_>) -> Command {
            self.0.push((situation.t_s, situation.tracks.len()));
            Command::course_speed(0.0, 7.0)
        }
    }
    let mut encounter = meeting(180.0, 200.0).encounter(kinematic(), kinematic());
    encounter.sensing = Sensing::Perfect { detection_range_m: Some(650.0) };
    let mut look = Look(Vec::new());
    let trace = run(&encounter, &mut look);
    // along-track range 13 (150 - t), across 200: 650 m when 13 (150 - t) = 618.5 m
    let first_s = trace.pairs[0].detected_s.unwrap();
    assert!((first_s - 103.0).abs() < 1e-12, "{first_s}");
    assert_eq!(trace.pairs[0].tracked_s, trace.pairs[0].detected_s);
    assert!(look.0.iter().all(|&(t_s, tracks)| (tracks == 1) == ((103.0..=197.0).contains(&t_s))));
}

#[test]
fn nominal_is_the_run_of_a_ship_that_holds() {
    for (own, tolerance_m) in [(kinematic(), 1e-9), (viknes(), 1e-8)] {
        for miss_m in [0.0, 60.0, 700.0] {
            let encounter = meeting(-100.0, miss_m).encounter(own.clone(), kinematic());
            let nominal = sim::nominal(&encounter).unwrap();
            let trace = run(&encounter, &mut hold());
            let n = trace.samples();
            if miss_m > 0.0 {
                assert_eq!(nominal.own.len(), n);
                let gap_m = (nominal.minima[0].hull_m - trace.pairs[0].minimum.hull_m).abs();
                assert!(gap_m < 1e-6, "{miss_m}: {gap_m} m");
            } else {
                assert!(nominal.own.len() > n, "the nominal track goes on through a contact");
                assert!(nominal.minima[0].hull_m <= 0.0);
                assert!((nominal.minima[0].hull_s - trace.end_s).abs() < 1e-3);
            }
            assert!((nominal.minima[0].centre_m - miss_m).abs() < 1e-6);
            for k in 0..n {
                assert!((nominal.own.position_m(k) - trace.own.position_m(k)).norm() < tolerance_m);
            }
            let same = |track: &ShipTrack| track.north_m[..n].to_vec();
            assert_eq!(same(&nominal.targets[0]), same(&trace.targets[0]));
        }
    }
}

#[test]
fn a_run_is_a_function_of_encounter_and_planner() {
    let mut scratch = sim::Scratch::default();
    let beat = AtomicU64::new(0);
    let first = meeting(-70.0, 30.0).encounter(viknes(), viknes());
    let second = meeting(110.0, 5.0).encounter(viknes(), kinematic());
    let mut digest = |encounter: &Encounter| {
        let mut planner = Shy { course_rad: 0.0 };
        Digest::of_trace(&sim::run(encounter, &mut planner, &mut scratch, &beat))
    };
    let (a, b) = (digest(&first), digest(&second));
    assert_ne!(a, b);
    assert_eq!((digest(&second), digest(&first)), (b, a));
    assert_eq!(Digest::of_trace(&run(&first, &mut Shy { course_rad: 0.0 })), a);
}

fn bits(values: &[f64]) -> Vec<u64> {
    // zero has two signs; a mirror exchanges them
    values.iter().map(|v| (v + 0.0).to_bits()).collect()
}

fn negated_bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| (-v + 0.0).to_bits()).collect()
}

fn assert_mirrored(track: &ShipTrack, image: &ShipTrack) {
    assert_eq!(bits(&track.north_m), bits(&image.north_m));
    assert_eq!(bits(&track.east_m), negated_bits(&image.east_m));
    assert_eq!(bits(&track.psi_rad), negated_bits(&image.psi_rad));
    assert_eq!(bits(&track.vel_east_mps), negated_bits(&image.vel_east_mps));
    assert_eq!(bits(&track.stw_mps), bits(&image.stw_mps));
    assert_eq!(bits(&track.yaw_rate_radps), negated_bits(&image.yaw_rate_radps));
}

fn worst_m(a: &Trace, b: &Trace, place: impl Fn(Vec2) -> Vec2) -> f64 {
    let gap = |x: &ShipTrack, y: &ShipTrack, k| (place(x.position_m(k)) - y.position_m(k)).norm();
    (0..a.samples())
        .map(|k| gap(&a.own, &b.own, k).max(gap(&a.targets[0], &b.targets[0], k)))
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn mirror_world_gives_mirror_tracks_bit_for_bit(
        angle in -179.0..179.0, miss in -150.0..150.0, speed in 1.0..9.0,
        three_dof in any::<bool>(),
    ) {
        prop_assume!(f64::abs(miss) > 0.01);
        let vessel = if three_dof { viknes() } else { kinematic() };
        let (own, other) = (vessel.clone(), vessel);
        let meeting = Meeting { target_mps: speed, ..meeting(angle, miss) };
        let encounter = meeting.encounter(own, other);
        let trace = run(&encounter, &mut Shy { course_rad: 0.0 });
        let image = run(&mirrored(&encounter), &mut Shy { course_rad: 0.0 });
        prop_assert_eq!(trace.outcome, image.outcome);
        if trace.outcome != Outcome::Collision {
            prop_assert_eq!(trace.end_s.to_bits(), image.end_s.to_bits());
        }
        assert_mirrored(&trace.own, &image.own);
        assert_mirrored(&trace.targets[0], &image.targets[0]);
        let (m, n) = (trace.pairs[0].minimum, image.pairs[0].minimum);
        prop_assert_eq!(m.centre_m.to_bits(), n.centre_m.to_bits());
        prop_assert!((m.hull_m - n.hull_m).abs() < 1e-9);
    }

    #[test]
    fn turning_and_shifting_the_world_changes_nothing(
        angle in -179.0..179.0, miss in -150.0..150.0,
        turn in -3.0..3.0, x in -1e4..1e4, y in -1e4..1e4,
        three_dof in any::<bool>(),
    ) {
        let vessel = if three_dof { viknes() } else { kinematic() };
        let (own, other) = (vessel.clone(), vessel);
        let encounter = meeting(angle, miss).encounter(own, other);
        let shift = Vec2::new(x, y);
        let trace = run(&encounter, &mut Shy { course_rad: 0.0 });
        let turned = run(&moved(&encounter, turn, shift), &mut Shy { course_rad: turn });
        prop_assert_eq!(trace.outcome, turned.outcome);
        prop_assert_eq!(trace.samples(), turned.samples());
        let gap = worst_m(&trace, &turned, |p| geom::angle::rotate(p, turn) + shift);
        prop_assert!(gap < 1e-6, "{gap} m");
        let (m, n) = (trace.pairs[0].minimum, turned.pairs[0].minimum);
        prop_assert!((m.hull_m - n.hull_m).abs() < 1e-6 && (m.centre_m - n.centre_m).abs() < 1e-6);
    }
}

/// Halving the step changes the minimum by far less than a decimetre, with a planner that answers
/// what it sees.
#[test]
fn halving_the_step_changes_little() {
    let mut changes_m: Vec<f64> = Vec::new();
    for k in 0..60 {
        let angle_deg = -170.0 + 5.7 * f64::from(k);
        let closest = |step_s: f64| {
            let meeting = Meeting { step_s, ..meeting(angle_deg, f64::from(k % 9) * 10.0 - 40.0) };
            let encounter = meeting.encounter(viknes(), viknes());
            run(&encounter, &mut Shy { course_rad: 0.0 }).pairs[0].minimum.hull_m
        };
        changes_m.push((closest(0.5) - closest(0.25)).abs());
    }
    changes_m.sort_by(f64::total_cmp);
    assert!(changes_m[58] < 0.02, "{:?}", &changes_m[50..]);
}

#[test]
fn current_moves_both_and_course_over_ground_is_kept() {
    for vessel in [kinematic(), viknes()] {
        let mut encounter = meeting(-90.0, 150.0).encounter(vessel, kinematic());
        encounter.weather.current_mps = Vec2::new(0.0, 1.0);
        encounter.run.until = RunUntil::TimeIsUp;
        encounter.run.duration_s_max = 200.0;
        let mut north = Orders(vec![(0.0, 0.0, 6.0)]);
        let trace = run(&encounter, &mut north);
        let last = trace.samples() - 1;
        assert!(trace.own.cog_rad(last).abs() < deg(0.05), "{}", trace.own.cog_rad(last));
        assert!((trace.own.sog_mps(last) - 6.0).abs() < 0.01);
        // heading into the current by asin(1 / |water speed|)
        let expected_rad = -geom::math::atan(1.0 / 6.0);
        assert!((trace.own.psi_rad[last] - expected_rad).abs() < deg(0.1));
        // everybody starts on the course and at the speed over ground that were asked for, and
        // the target keeps both with the heading that she has
        let start_mps = encounter.own.start.speed_mps;
        assert!((trace.own.sog_mps(0) - start_mps).abs() < 1e-9);
        assert!(trace.own.cog_rad(0).abs() < 1e-9, "{}", trace.own.cog_rad(0));
        assert!((trace.own.psi_rad[0] + geom::math::atan(1.0 / start_mps)).abs() < 1e-9);
        let target_mps = encounter.targets[0].start.speed_mps;
        assert!((trace.targets[0].sog_mps(last) - target_mps).abs() < 1e-9);
        assert!((trace.targets[0].cog_rad(last) - deg(-90.0)).abs() < 1e-9);
    }
}
