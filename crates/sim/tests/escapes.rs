//! A fork of the nominal track against the same manoeuvre in a whole run.

mod scenes;

use geom::units::deg;
use proptest::prelude::*;
use record::{Encounter, Order, Vessel};
use scenes::{Meeting, Orders, kinematic, run, viknes};
use sim::{Escapes, Evasions, Manoeuvre, Side};
use std::f64::consts::PI;
use std::sync::atomic::AtomicU64;

/// The smallest hull distance of a run in which own ship does what a manoeuvre says, metres, and
/// whether the ships still came nearer when it ended.
fn sailed(encounter: &Encounter, manoeuvre: Manoeuvre, at_s: f64) -> (f64, bool) {
    let sign = if manoeuvre.side() == Some(Side::Port) { -1.0 } else { 1.0 };
    let (course_rad, speed_mps) = match manoeuvre {
        Manoeuvre::QuarterTurn(_) => (deg(90.0), 7.0),
        // an order straight back would leave the side open
        Manoeuvre::HalfTurn(_) => (deg(160.0), 7.0),
        Manoeuvre::TurnAndStop(_) => (deg(90.0), 0.0),
        Manoeuvre::CrashStop => (0.0, 0.0),
    };
    let mut orders = vec![(0.0, 0.0, 7.0), (at_s, sign * course_rad, speed_mps)];
    if let Manoeuvre::HalfTurn(_) = manoeuvre {
        orders.push((at_s + 7.0, sign * PI, 7.0));
    }
    let mut orders = Orders(orders);
    let trace = run(encounter, &mut orders);
    let minimum = trace.pairs[0].minimum;
    (minimum.hull_m, minimum.hull_s >= trace.end_s - encounter.run.beat_s)
}

/// The smallest hull distance of a fork, metres, by bisection of what it clears.
fn forked_m(escapes: &mut Escapes<'_>, manoeuvre: Manoeuvre, instant: usize) -> f64 {
    let (mut low_m, mut high_m) = (0.0, 5000.0);
    if escapes.own_clears(0, instant, manoeuvre, low_m).is_none() {
        return 0.0;
    }
    while high_m - low_m > 1e-3 {
        let middle_m = 0.5 * (low_m + high_m);
        if escapes.own_clears(0, instant, manoeuvre, middle_m).is_some() {
            low_m = middle_m;
        } else {
            high_m = middle_m;
        }
    }
    high_m
}

fn fork_is_the_run(meeting: &Meeting, own: Vessel, instant: usize, manoeuvre: Manoeuvre) {
    let encounter = meeting.encounter(own, kinematic());
    let nominal = sim::nominal(&encounter).expect("the encounter is sound");
    let mut escapes = Escapes::new(&encounter, &nominal).expect("both have models");
    let instant = instant.min(escapes.instants(0) - 1);
    let forked_m = forked_m(&mut escapes, manoeuvre, instant);
    let (sailed_m, nearing) = sailed(&encounter, manoeuvre, escapes.time_s(instant));
    // what is left of a heading and a speed when they count as reached
    let tolerance_m = 0.1 + 0.001 * sailed_m;
    // a fork goes on for ever: nearly the same velocity brings the closest point after the run
    assert!(
        (forked_m - sailed_m).abs() < tolerance_m || nearing && forked_m < sailed_m,
        "{manoeuvre:?} at {instant}: {forked_m} m, sailed {sailed_m} m"
    );
}

fn manoeuvres() -> impl Strategy<Value = Manoeuvre> {
    (0..Manoeuvre::ALL.len()).prop_map(|index| Manoeuvre::ALL[index])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// What is said of a fork is what a run under those orders does, for both kinds of model.
    #[test]
    fn fork_is_a_run_under_the_same_orders(
        course in -3.1f64..3.1, speed in 2f64..11.0, length in 8f64..100.0, miss in -60f64..60.0,
        instant in 60usize..150, manoeuvre in manoeuvres(), inertia in any::<bool>(),
    ) {
        let meeting = meeting_with(course, speed, length, miss);
        prop_assume!(meeting_is_apart(&meeting));
        fork_is_the_run(&meeting, if inertia { viknes() } else { kinematic() }, instant, manoeuvre);
    }

    /// A whole run that ends in the manoeuvre says what the fork says, where no hulls graze.
    #[test]
    fn evasion_is_what_the_fork_says(
        course in -3.1f64..3.1, speed in 2f64..11.0, length in 8f64..100.0, miss in -60f64..60.0,
        instant in 60usize..150, manoeuvre in manoeuvres(), inertia in any::<bool>(),
    ) {
        let meeting = meeting_with(course, speed, length, miss);
        prop_assume!(meeting_is_apart(&meeting));
        let own = if inertia { viknes() } else { kinematic() };
        let encounter = meeting.encounter(own, kinematic());
        let nominal = sim::nominal(&encounter).unwrap();
        let mut escapes = Escapes::new(&encounter, &nominal).unwrap();
        let instant = instant.min(escapes.instants(0) - 1);
        let orders = vec![Order { course_rad: 0.0, speed_mps: 7.0 }; instant];
        let (mut scratch, beat) = (sim::Scratch::default(), AtomicU64::new(0));
        let evasions = Evasions::new(&encounter, &orders);
        let means = (&mut scratch, &beat);
        let clears = evasions.clears(instant, Some(manoeuvre), &mut |_| None, means);
        let forked_m = forked_m(&mut escapes, manoeuvre, instant);
        // where they differ the hulls graze: what is left of a heading and a speed decides
        if clears != (forked_m > 0.0) {
            let (sailed_m, nearing) = sailed(&encounter, manoeuvre, escapes.time_s(instant));
            let graze = forked_m < 0.3 && (sailed_m < 0.3 || nearing);
            prop_assert!(graze, "{} {}: {}", clears, forked_m, sailed_m);
        }
    }

    /// What is promised of an instant later holds.
    #[test]
    fn slack_shrinks_no_faster_than_promised(
        course in -3.1f64..3.1, speed in 2f64..11.0, length in 8f64..100.0,
        instant in 0usize..120, manoeuvre in manoeuvres(),
    ) {
        let meeting = Meeting {
            target_course_rad: course,
            target_mps: speed,
            target_length_m: length,
            ..Meeting::default()
        };
        prop_assume!(meeting_is_apart(&meeting));
        let encounter = meeting.encounter(viknes(), kinematic());
        let nominal = sim::nominal(&encounter).unwrap();
        let mut escapes = Escapes::new(&encounter, &nominal).unwrap();
        let loss_m = escapes.own_loss_m(0).expect("both go straight");
        let target_loss_m = escapes.target_loss_m(0).expect("both go straight");
        let instant = instant.min(escapes.instants(0) - 2);
        if let Some(slack_m) = escapes.own_clears(0, instant, manoeuvre, 0.0) {
            let later_m = forked_m(&mut escapes, manoeuvre, instant + 1);
            prop_assert!(later_m + 1e-2 >= slack_m - loss_m, "{slack_m} {later_m} {loss_m}");
        }
        if let Some(slack_m) = escapes.target_clears(0, instant, manoeuvre, 0.0) {
            let than_m = slack_m - target_loss_m - 1e-6;
            let later = escapes.target_clears(0, instant + 1, manoeuvre, than_m.max(0.0));
            prop_assert!(later.is_some() || than_m <= 0.0, "{slack_m}");
        }
    }
}

/// Far enough apart at the start to begin.
fn meeting_with(course_rad: f64, speed_mps: f64, length_m: f64, miss_m: f64) -> Meeting {
    Meeting {
        target_course_rad: course_rad,
        target_mps: speed_mps,
        target_length_m: length_m,
        miss_m,
        ..Meeting::default()
    }
}

fn meeting_is_apart(meeting: &Meeting) -> bool {
    let encounter = meeting.encounter(viknes(), kinematic());
    sim::check(&encounter).is_ok()
        && encounter.targets[0].start.position_m.norm() > 150.0 + meeting.target_length_m
}
