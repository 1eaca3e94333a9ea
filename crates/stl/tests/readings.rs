//! One encounter for each reading of the specification that another reading would decide
//! otherwise.

mod common;

use common::{Script, USV, run};
use record::{Check, Trace};
use stl::action::{Action, Deviation};
use stl::life::lives;
use stl::runs::speed_runs;
use stl::{Finding, Robustness, judge};

fn own() -> Script {
    Script::straight(0.0, 0.0, 0.0, 5.0)
}

fn ahead() -> Script {
    Script::straight(1500.0, 0.0, 180.0, 5.0)
}

/// Stage 3 begins at 52 s.
fn from_port() -> Script {
    Script::straight(750.0, -750.0, 90.0, 5.0)
}

fn finding(trace: &Trace, check: Check) -> Robustness {
    judge(trace, &USV)[check as usize]
}

#[test]
fn port_after_starboard_is_not_port_before_starboard() {
    let trace = run(&own().turn(20, 20.0).turn(60, -40.0), &[ahead()], 300);
    assert_eq!(finding(&trace, Check::R14).status, Finding::Holds);
}

#[test]
fn a_small_action_suffices_only_if_it_added_distance() {
    // Planned to pass at 164 m hull to hull, with the target a little to starboard.
    let aside = || Script::straight(1500.0, 170.0, 180.0, 5.0);
    let toward = run(&own().turn(20, 5.0), &[aside()], 300);
    assert_eq!(finding(&toward, Check::Safe).status, Finding::Holds);
    assert_eq!(finding(&toward, Check::R8Magnitude).status, Finding::Violated);
    // Slowing down by 4 % neither adds distance here nor excuses the turn.
    let slower = run(&own().turn(20, 5.0).change_speed(20, -0.2), &[aside()], 320);
    assert_eq!(finding(&slower, Check::R8Magnitude).status, Finding::Violated);
    let away = run(&own().turn(20, -5.0), &[aside()], 300);
    assert_eq!(finding(&away, Check::R8Magnitude).status, Finding::Holds);
}

#[test]
fn a_step_back_while_still_in_danger_is_no_return() {
    // 8 degrees, 5 back and 9 more make 12; too late to pass well clear.
    let hesitant = own().turn(60, 8.0).turn(80, -5.0).turn(100, 9.0);
    let trace = run(&hesitant, &[ahead()], 300);
    assert_eq!(finding(&trace, Check::Safe).status, Finding::Violated);
    let rho = finding(&trace, Check::R8Magnitude).rho.unwrap();
    assert!((rho - 0.2).abs() < 1e-6, "{rho}");
}

#[test]
fn the_mean_heading_of_a_stand_on_ship_does_not_see_what_came_later() {
    let mut free = own();
    free.turns.push((52, 10.0, 9));
    let trace = run(&free, &[from_port()], 300);
    let duty = lives(&trace, &USV).remove(0).in_sight.unwrap();
    assert_eq!(duty.stages[..2], [Some(0), Some(52)]);
    assert_eq!(finding(&trace, Check::R17Hold).status, Finding::Holds);
    assert_eq!(duty.may_act, Some(52));
    // Where risk opens inside stage 3 she must first have seen for 5 s that nothing is done.
    let near = Script::straight(400.0, -400.0, 90.0, 5.0);
    let late = run(&own(), &[near], 200);
    assert_eq!(lives(&late, &USV)[0].in_sight.as_ref().unwrap().may_act, Some(5));
}

#[test]
fn turning_in_on_an_overtaken_ship_is_violated_though_she_keeps_clear() {
    // to the north, and east by south
    for psi_deg in [0.0, 100.0] {
        let (sin, cos) = libm::sincos(common::deg(psi_deg));
        let slow = || Script::straight(400.0 * cos, 400.0 * sin, psi_deg, 2.0);
        let fast = || Script { psi_deg, speed_mps: 6.0, ..own() }.turn(10, 25.0).turn(74, -25.0);
        let steady = run(&fast(), &[slow()], 300);
        assert_eq!(finding(&steady, Check::R13).status, Finding::Holds);
        let swerve = run(&fast().turn(101, -40.0).turn(118, 40.0), &[slow()], 300);
        assert_eq!(finding(&swerve, Check::Safe).status, Finding::Holds);
        assert_eq!(finding(&swerve, Check::R13).status, Finding::Violated);
    }
}

/// Turning in counts where the pass becomes closer by it: 30 degrees lead from 26 m ahead of her to
/// 70 m astern, 12 degrees lead into her.
#[test]
fn turning_in_must_make_the_pass_closer() {
    let other = || Script::straight(487.0, -900.0, 0.0, 3.0);
    // at 6 degrees a second
    let swerves = |seconds: usize| {
        let turns = vec![(126, -6.0, seconds), (129 + seconds, 6.0, seconds + 13)];
        let own = Script { psi_deg: -40.0, speed_mps: 8.0, turns, ..own() };
        let trace = run(&own, &[other()], 500);
        assert_eq!(finding(&trace, Check::Safe).status, Finding::Holds);
        finding(&trace, Check::R13).status
    };
    assert_eq!(swerves(5), Finding::Holds);
    assert_eq!(swerves(2), Finding::Violated);
}

/// Own ship turns away from the other's line, and the other turns toward own ship meanwhile.
#[test]
fn the_turn_of_the_overtaken_ship_is_none_of_own_ship() {
    let other = Script { turns: vec![(116, 3.0, 15)], ..Script::straight(650.0, -900.0, 0.0, 3.0) };
    let turns = vec![(126, 6.0, 2), (146, 6.0, 12)];
    let trace = run(&Script { psi_deg: -40.0, speed_mps: 8.0, turns, ..own() }, &[other], 500);
    assert_eq!(finding(&trace, Check::Safe).status, Finding::Holds);
    assert_eq!(finding(&trace, Check::R13).status, Finding::Holds);
}

/// What a duty to give way to another forced is excused with its way back, however late; another
/// alteration after that duty is not.
#[test]
fn the_way_back_from_a_forced_turn_is_excused() {
    // gives way to the one from 0 to about 55 s; the other, from port, is met at 150 s
    let starboard = Script::straight(300.0, 300.0, 270.0, 5.0);
    let port = Script::straight(750.0, -900.0, 90.0, 5.0);
    let holds = |own: Script| {
        let trace = run(&own, &[starboard.clone(), port.clone()], 300);
        let lives = lives(&trace, &USV);
        let ends = lives.iter().map(|life| life.in_sight.as_ref().unwrap().end).collect::<Vec<_>>();
        assert!(ends[0] < 70 && ends[1] > 100, "{ends:?}");
        judge(&trace, &USV)[Check::COUNT + Check::R17Hold as usize].status
    };
    let forced = || own().turn(15, 40.0);
    assert_ne!(holds(forced().turn(75, -40.0)), Finding::Violated);
    assert_ne!(holds(forced().turn(75, -10.0)), Finding::Violated);
    assert_eq!(holds(forced().turn(75, 30.0)), Finding::Violated);
}

/// The same by speed: what she takes up again is excused, and so is what is too small to break the
/// rule; to slow down once more is her own choice.
#[test]
fn the_way_back_from_a_forced_loss_of_speed_is_excused() {
    let starboard = Script::straight(300.0, 300.0, 270.0, 5.0);
    let port = Script::straight(750.0, -900.0, 90.0, 5.0);
    let holds = |then: (usize, f64, usize)| {
        let mut own = own();
        own.speeds = vec![(15, -0.5, 5), then];
        let trace = run(&own, &[starboard.clone(), port.clone()], 300);
        let duty = lives(&trace, &USV).remove(0).in_sight.unwrap();
        assert!(duty.end < 72, "{duty:?}");
        judge(&trace, &USV)[Check::COUNT + Check::R17Hold as usize].status
    };
    assert_ne!(holds((75, 0.1, 25)), Finding::Violated);
    assert_ne!(holds((75, -0.4, 1)), Finding::Violated);
    assert_eq!(holds((75, -0.5, 3)), Finding::Violated);
}

#[test]
fn fixed_ranges_bind_all_but_the_overtaking_roles() {
    let onset = |own: Script, target: Script| {
        let trace = run(&own, &[target], 200);
        lives(&trace, &USV)[0].in_sight.as_ref().map(|duty| duty.onset)
    };
    let speed = |speed_mps: f64| Script { speed_mps, ..own() };
    // Closing at 20 m/s from 3000 m: under 1900 m from 56 s.
    assert_eq!(onset(speed(10.0), Script::straight(3000.0, 0.0, 180.0, 10.0)), Some(56));
    // Overtaking at 11 m/s: 190 s are 2090 m.
    assert_eq!(onset(speed(12.0), Script::straight(2050.0, 0.0, 0.0, 1.0)), Some(0));
    assert_eq!(onset(speed(1.0), Script::straight(-2050.0, 0.0, 0.0, 12.0)), Some(0));
}

#[test]
fn exactly_at_the_limit_is_undecided() {
    let mut trace = run(&own().turn(20, 30.0), &[ahead()], 300);
    trace.pairs[0].minimum.hull_m = USV.minimum_m;
    let found = finding(&trace, Check::Safe);
    assert_eq!((found.status, found.rho), (Finding::Undecided, Some(0.0)));
}

/// A speed run is contiguous from sample to sample, and detectable as a share of the speed that is
/// really made, not of what is left of it when the plan's is taken off.
#[test]
fn speed_runs_are_measured_from_sample_to_sample() {
    let runs = |change_mps: &[f64], speed_mps: f64| {
        let speed_mps = vec![speed_mps; change_mps.len()];
        let found = speed_runs(change_mps, &speed_mps, &USV, 1.0);
        found.into_iter().map(|run| (run.start, run.end)).collect::<Vec<_>>()
    };
    // 0.09 m/s in one second: a mean over two would be under 0.05 m/s^2
    let step = [0.0, 0.0, -0.09, -0.09, -0.09];
    assert_eq!(runs(&step, 1.0), [(1, 2)]);
    // 1.5 % of the speed
    assert!(runs(&step, 6.0).is_empty());
    // slower, faster, and a pause between
    let three = [0.0, -0.5, -1.0, -0.6, -0.6, 0.0];
    assert_eq!(runs(&three, 5.0), [(0, 2), (2, 3), (4, 5)]);
    assert!(runs(&[1.0], 5.0).is_empty() && runs(&[], 5.0).is_empty());
}

/// A quarter of next to no speed is nothing: from 0.15 m/s to 0.3 breaks no duty to hold, from 5 to
/// 3.5 does.
#[test]
fn a_ship_that_lies_nearly_still_keeps_her_speed() {
    let holds = |from_mps: f64, to_mps: f64| {
        let mut trace = run(&own(), &[from_port()], 300);
        for (k, north_mps) in trace.own.vel_north_mps.iter_mut().enumerate() {
            *north_mps = if k < 20 { from_mps } else { to_mps };
        }
        assert_eq!(lives(&trace, &USV)[0].in_sight.as_ref().unwrap().stages[0], Some(0));
        finding(&trace, Check::R17Hold).status
    };
    assert_eq!(holds(0.15, 0.3), Finding::Holds);
    assert_eq!(holds(5.0, 3.5), Finding::Violated);
}

/// Small turns to starboard, and before the closest point a way back to the line of the route that
/// goes far past its course: the side of the action is starboard all the same. A yaw of 3 degrees
/// is no action to return from.
#[test]
fn a_way_back_past_the_first_course_is_a_return() {
    let risk = |own: &Script| {
        let trace = run(own, &[ahead()], 300);
        let lives = lives(&trace, &USV);
        let duty = lives[0].in_sight.as_ref().unwrap();
        let did = Action::of(&Deviation::of(&trace, &USV), &lives, 0, duty, &USV, 1.0);
        (did.side > 0.0, did.returns)
    };
    let small = own().turn(2, 8.5).turn(26, 8.5).turn(50, 8.5).turn(74, 8.5);
    let (side, returns) = risk(&small.turn(105, -75.0));
    assert_eq!((side, returns), (true, Some(105)));
    assert!(!risk(&own().turn(5, 3.0).turn(30, -40.0)).0);
}

/// What was given up slowly, and is taken up again when the pass is clear.
#[test]
fn speed_taken_up_again_is_no_action() {
    let mut slow = own();
    slow.speeds = vec![(20, -0.02, 40), (120, 0.2, 4)];
    let aside = Script::straight(1500.0, 130.0, 180.0, 5.0);
    let trace = run(&slow, &[aside], 300);
    let lives = lives(&trace, &USV);
    let duty = lives[0].in_sight.as_ref().unwrap();
    let did = Action::of(&Deviation::of(&trace, &USV), &lives, 0, duty, &USV, 1.0);
    assert_eq!(did.speed_changes, []);
    let most = did.speed_cut.iter().copied().fold(0.0, f64::max);
    assert!((most - 0.16).abs() < 1e-9, "{most}");
}

/// The stand-on ship that acts by right is asked for size: one that did next to nothing broke Rule
/// 8, and is not excused for a close pass.
#[test]
fn a_small_action_by_right_is_a_breach() {
    let acted = |degrees: f64| run(&own().turn(60, degrees), &[from_port()], 300);
    let small = acted(3.0);
    assert_eq!(finding(&small, Check::R17Hold).status, Finding::Holds);
    assert_eq!(finding(&small, Check::R8Magnitude).status, Finding::Violated);
    assert_eq!(finding(&acted(40.0), Check::R8Magnitude).status, Finding::Holds);
    // before she may act it is 17(a)(i) that asks
    let early = run(&own().turn(20, 5.0), &[from_port()], 300);
    assert_eq!(finding(&early, Check::R8Magnitude).status, Finding::NotApplicable);
    // what she did decides whether a close pass is the other's fault
    let near = |mut trace: Trace| {
        trace.contact = None;
        trace.pairs[0].minimum.hull_m = 80.0;
        finding(&trace, Check::Safe).status
    };
    assert_eq!(near(small), Finding::Violated);
    assert_eq!(near(acted(40.0)), Finding::Holds);
}

/// The mean heading shows a turn seconds before the ship made it.
#[test]
fn a_turn_made_in_the_second_of_detection_is_the_action() {
    // Risk opens at 70 s.
    let far = Script::straight(2600.0, 0.0, 180.0, 5.0);
    let mut trace = run(&own().turn(60, 20.0), &[far], 400);
    trace.pairs[0].tracked_s = Some(60.0);
    assert_eq!(finding(&trace, Check::R14).status, Finding::Holds);
    assert_eq!(finding(&trace, Check::R8Magnitude).status, Finding::Holds);
    trace.pairs[0].tracked_s = Some(70.0);
    assert_eq!(finding(&trace, Check::R14).status, Finding::Violated);
}

#[test]
fn a_ship_that_leaves_her_plan_before_an_overtaker_was_forced() {
    let slow = Script::straight(500.0, 0.0, 0.0, 2.0);
    let fast = Script { speed_mps: 6.0, ..own() }.turn(65, 60.0).turn(125, -60.0);
    let mut trace = run(&fast, &[slow.clone().turn(60, -20.0)], 300);
    assert_eq!(finding(&trace, Check::R13).status, Finding::Holds);
    trace.nominal.as_mut().unwrap().targets = run(&fast, &[slow], 300).nominal.unwrap().targets;
    assert_eq!(finding(&trace, Check::R13).status, Finding::Violated);
}

/// What is done after release, to where the ships meet again and closer, is no part of the duty.
#[test]
fn the_duty_ends_at_release_though_the_ships_come_closer_later() {
    let she = || Script::straight(1250.0, -1550.0, 90.0, 5.0);
    let trace = run(&own().turn(400, 140.0), &[she().change_speed(400, -4.0)], 900);
    let life = lives(&trace, &USV).remove(0);
    let duty = life.in_sight.unwrap();
    assert!(life.cpa > 450 && duty.end < 400 && duty.complete, "{} {}", life.cpa, duty.end);
    assert_eq!(finding(&trace, Check::R17Hold).status, Finding::Holds);
}

/// She stops, and then her head swings by 20 degrees: fast, and too slowly for a rate. That is no
/// manoeuvre of a ship without way, and one of a ship that has a little (section 5).
#[test]
fn a_ship_that_lies_still_and_swings_has_not_turned() {
    for (rate, seconds) in [(2.0, 10), (0.25, 80)] {
        let judged = |left_mps: f64| {
            let mut own = own().change_speed(20, left_mps - 5.0);
            own.turns.push((50, rate, seconds));
            let trace = run(&own, &[ahead()], 300);
            let turns = Deviation::of(&trace, &USV).turns.len();
            (turns, finding(&trace, Check::R14).status)
        };
        assert_eq!(judged(0.1), (0, Finding::Violated), "{rate}");
        assert_eq!(judged(0.5), (1, Finding::Holds), "{rate}");
    }
}

/// Risk that opens in the very sample of the closest point opens while Rules 8 and 14 to 17 are
/// asked; a sample later it does not.
#[test]
fn risk_that_opens_at_the_closest_point_is_judged() {
    let judged = |cpa_s: f64| {
        let mut trace = run(&own(), &[Script::straight(1000.0, 60.0, 180.0, 5.0)], 200);
        // on the plan she comes within 1900 m at 100 s
        let plan = run(&own(), &[Script::straight(2895.0, 60.0, 180.0, 5.0)], 200);
        trace.nominal = plan.nominal;
        trace.pairs[0].minimum.hull_s = cpa_s;
        let duty = lives(&trace, &USV).remove(0).in_sight;
        (duty.map(|duty| (duty.onset, duty.end)), finding(&trace, Check::R14).status)
    };
    assert_eq!(judged(100.0), (Some((100, 100)), Finding::Violated));
    assert_eq!(judged(99.0), (None, Finding::NotApplicable));
}

/// On the plan they meet at 100 s; as it was sailed the other comes later, and own ship turns
/// before that: it is her action though the risk of the plan is over, and after the closest point
/// it is none.
#[test]
fn a_run_after_the_planned_meeting_answers_one_that_was_put_off() {
    let judged = |from_s: usize| {
        let comes = Script::straight(750.0, 750.0, 270.0, 5.0);
        let mut trace = run(&own().turn(from_s, 40.0), &[comes], 300);
        let plan = run(&own(), &[Script::straight(500.0, 500.0, 270.0, 5.0)], 300);
        trace.nominal = plan.nominal;
        let lives = lives(&trace, &USV);
        assert!(lives[0].attention.iter().all(|open| open.end < 110), "{:?}", lives[0].attention);
        let duty = lives[0].in_sight.as_ref().unwrap();
        let deviation = Deviation::of(&trace, &USV);
        let action = Action::of(&deviation, &lives, 0, duty, &USV, 1.0);
        (action.turns.len(), finding(&trace, Check::R8Magnitude).status)
    };
    assert_eq!(judged(112), (1, Finding::Holds));
    assert_eq!(judged(190), (0, Finding::Violated));
}

/// The smallest distance so far lies long before the end of a run that is cut off while the ships
/// still close: the clock goes on to its end, and what was kept so far is no pass though the duty
/// to hold had ended before (at 52 s she may act).
#[test]
fn a_run_that_is_cut_before_a_closer_pass_is_judged_to_its_end() {
    let cut = |samples: usize| {
        let mut trace = run(&own().turn(samples - 20, 12.0), &[from_port()], samples);
        trace.pairs[0].minimum.hull_s = 20.0;
        trace.pairs[0].minimum.centre_s = 20.0;
        let life = lives(&trace, &USV).remove(0);
        ((life.cpa, life.cpa_passed), finding(&trace, Check::R17Hold).status)
    };
    assert_eq!(cut(120), ((119, false), Finding::Inconclusive));
}
