//! Laws of the judge, over random voyages: shift, rotation, mirror, early action, larger distance.

use super::*;
use geom::EncounterClass;
use proptest::prelude::*;
use record::{DistanceKind, PairFacts, Reaction};

/// A random encounter: own ship north, turning once; the target to meet her.
#[derive(Clone, Copy, Debug)]
struct Draw {
    beta_deg: f64,
    psi_t_deg: f64,
    range_m: f64,
    miss_m: f64,
    speed_mps: f64,
    act_s: f64,
    turn_deg: f64,
}

fn draws() -> impl Strategy<Value = Draw> {
    (
        -179f64..179.0,
        -179f64..179.0,
        300f64..2600.0,
        -150f64..150.0,
        1f64..10.0,
        5f64..200.0,
        -60f64..60.0,
    )
        .prop_map(|(beta_deg, psi_t_deg, range_m, miss_m, speed_mps, act_s, turn_deg)| Draw {
            beta_deg,
            psi_t_deg,
            range_m,
            miss_m,
            speed_mps,
            act_s,
            turn_deg,
        })
}

impl Draw {
    /// The scene turned by `rotation_rad`, or seen in a mirror (`side` -1), or with a lead-in.
    fn scene(&self, rotation_rad: f64, side: f64, lead_s: f64) -> Scene {
        let beta = deg(self.beta_deg);
        let own_mps = geom::Vec2::new(6.0, 0.0);
        let target_mps = geom::unit(deg(self.psi_t_deg)) * self.speed_mps;
        let across = geom::unit(beta + deg(90.0)) * self.miss_m;
        let at =
            |v: geom::Vec2| geom::angle::rotate(geom::Vec2::new(v.x, side * v.y), rotation_rad);
        let own_m = at(own_mps * -lead_s);
        let target_m = at(geom::unit(beta) * self.range_m + across - target_mps * lead_s);
        let own = Script::new(ship(10.0, 3.0), own_m.x, own_m.y, rotation_rad, 6.0);
        let psi_t = rotation_rad + side * deg(self.psi_t_deg);
        let other = Script::new(ship(40.0, 8.0), target_m.x, target_m.y, psi_t, self.speed_mps);
        let own = own.hold(lead_s + self.act_s).turn(side * self.turn_deg, 3.0).hold(500.0);
        Scene::new(own, other.hold(720.0 + lead_s))
    }
}

fn statuses(judgement: &Judgement) -> Vec<(Check, Status, String)> {
    let told = |v: &Verdict| (v.check, v.status, v.detail.to_string());
    judgement.verdicts.iter().map(told).collect()
}

/// Not so near a border of the judge's that rounding may decide.
fn robust(judgement: &Judgement) -> bool {
    judgement.verdicts.iter().all(|v| v.robustness.is_none_or(|r| r.abs() > 1e-6))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn rotation_changes_no_verdict(draw in draws(), rotation in -3.1f64..3.1) {
        let here = judge(&draw.scene(0.0, 1.0, 0.0));
        let there = judge(&draw.scene(rotation, 1.0, 0.0));
        prop_assume!(robust(&here) && robust(&there));
        prop_assert_eq!(statuses(&here), statuses(&there));
    }

    /// A straight lead-in moves every time and changes nothing, where risk opens after the start.
    #[test]
    fn time_shift_shifts_times_only(draw in draws()) {
        let (here, later) = (draw.scene(0.0, 1.0, 0.0).trace(), draw.scene(0.0, 1.0, 60.0).trace());
        let (here, later) = (judge_by(rules(), &here), judge_by(rules(), &later));
        let onset = |j: &Judgement| j.pairs[0].risk_s;
        prop_assume!(onset(&here).is_none_or(|t| t > 0.0));
        // of ships that draw apart the lead-in would be the closest part
        let cpa = |j: &Judgement| j.pairs[0].cpa_s.unwrap_or(0.0);
        prop_assume!(cpa(&here) > 1.0 && cpa(&later) > 61.0);
        prop_assume!(onset(&later).is_none_or(|t| t > 60.0) && robust(&here) && robust(&later));
        prop_assert_eq!(onset(&here).map(|t| t + 60.0), onset(&later));
        prop_assert_eq!(statuses(&here), statuses(&later));
        let close = |a: Reaction, b: Reaction| match (a, b) {
            (Reaction::After(a), Reaction::After(b)) => (a - b).abs() < 1e-6,
            (a, b) => a == b,
        };
        prop_assert!(close(here.pairs[0].reaction, later.pairs[0].reaction));
    }

    /// Section 0: signals and times are bit-equal, signed angles negated, crossings exchanged.
    #[test]
    fn a_mirror_image_has_mirrored_facts_bit_for_bit(draw in draws()) {
        let here = judge(&draw.scene(0.0, 1.0, 0.0));
        let mirror = judge(&draw.scene(0.0, -1.0, 0.0));
        let (a, b): (&PairFacts, &PairFacts) = (&here.pairs[0], &mirror.pairs[0]);
        prop_assume!(a.beta_rad.is_none_or(|beta| beta.abs() > 1e-9));
        prop_assert_eq!(a.risk_s, b.risk_s);
        prop_assert_eq!(a.class_by_bearings.map(EncounterClass::mirrored), b.class_by_bearings);
        prop_assert_eq!(a.beta_rad.map(f64::to_bits), b.beta_rad.map(|x| (-x).to_bits()));
        prop_assert_eq!(a.alpha_rad.map(f64::to_bits), b.alpha_rad.map(|x| (-x).to_bits()));
        prop_assert_eq!(a.range_m.map(f64::to_bits), b.range_m.map(f64::to_bits));
        let turned = b.first_turn_rad.map(|turn| (-turn).to_bits());
        prop_assert_eq!(a.first_turn_rad.map(f64::to_bits), turned);
        prop_assert_eq!((a.reaction, a.apparent), (b.reaction, b.apparent));
        prop_assert_eq!((a.cpa_s, a.ambiguous), (b.cpa_s, b.ambiguous));
        let crossing = [EncounterClass::CrossingStbd, EncounterClass::CrossingPort];
        if !a.ambiguous && a.class_by_bearings.is_some_and(|class| !crossing.contains(&class)) {
            prop_assert_eq!(a.stages_s, b.stages_s);
        }
        // SAFE sees no side
        let safe = |j: &Judgement| verdict(j, Check::Safe).margin.map(f64::to_bits);
        prop_assert_eq!(safe(&here), safe(&mirror));
    }

    /// The table of section 0 for the verdicts that have a side.
    #[test]
    fn a_mirror_exchanges_the_sided_verdicts(turn in 12f64..60.0, act in 45f64..100.0) {
        let meet = |side: f64| judge(&Scene::new(
            own(6.0).hold(act).turn(side * turn, 3.0).hold(500.0),
            target(2400.0, side * 10.0, 180.0, 6.0),
        ));
        let (starboard, port) = (meet(1.0), meet(-1.0));
        prop_assert_ne!(starboard.status(Check::R14), Status::Fail);
        expect(&starboard, Check::Turn, Status::Pass, "");
        expect(&port, Check::R14, Status::Fail, "FAIL-14-PORT");
        expect(&port, Check::Turn, Status::Fail, "FAIL-14-PORT");
        let cross = |side: f64| judge(&Scene::new(
            own(6.0).hold(40.0 + act).turn(side * turn, 3.0).hold(600.0),
            target(1800.0, side * 1800.0, -side * 90.0, 6.0),
        ));
        expect(&cross(1.0), Check::Turn, Status::Pass, "");
        expect(&cross(-1.0), Check::Turn, Status::Fail, "FAIL-17C");
    }

    /// She acts before risk opens, and enough that it never would: nothing to fail her for.
    #[test]
    fn early_action_never_fails(
        psi_t_deg in 110f64..250.0, speed in 6f64..10.0, miss in -150f64..150.0,
        act in 2f64..20.0, turn in 30f64..60.0, port in prop::bool::ANY,
    ) {
        // meets own ship 1800 m ahead of where she starts, after 300 s
        let velocity_mps = geom::unit(deg(psi_t_deg)) * speed;
        let start_m = geom::Vec2::new(1800.0, miss) - velocity_mps * 300.0;
        let turn_deg = if port { -turn } else { turn };
        let judgement = judge(&Scene::new(
            own(6.0).hold(act).turn(turn_deg, 5.0).hold(700.0),
            target(start_m.x, start_m.y, psi_t_deg, speed),
        ));
        let facts = &judgement.pairs[0];
        prop_assume!(facts.risk_s.is_some_and(|t| t > act + 1.0));
        prop_assert_eq!(facts.reaction, Reaction::Early);
        // SAFE binds whatever she did before
        prop_assume!(verdict(&judgement, Check::Safe).status == Status::Pass);
        for check in Check::ALL {
            prop_assert_ne!(judgement.status(check), Status::Fail, "{:?}: {:#?}", check, judgement);
        }
    }

    #[test]
    fn a_larger_distance_never_lowers_the_score(a in 0f64..300.0, b in 0f64..300.0) {
        let voyage = own(6.0).hold(60.0).turn(35.0, 3.0).hold(400.0);
        let mut trace = Scene::new(voyage, head_on()).trace();
        let mut score = |d: f64| {
            trace.pairs[0].minimum.hull_m = d;
            let judgement = judge_by(rules(), &trace);
            verdict(&judgement, Check::Safe).score.unwrap()
        };
        prop_assert!(score(a.min(b)) <= score(a.max(b)));
    }

    /// Whatever own ship does after onset, class and role stay what they were there.
    #[test]
    fn no_voyage_changes_the_role(draw in draws(), other_turn in -60f64..60.0, act in 5f64..200.0) {
        let facts = |draw: Draw| judge(&draw.scene(0.0, 1.0, 0.0)).pairs[0].clone();
        let (a, b) = (facts(draw), facts(Draw { turn_deg: other_turn, act_s: act, ..draw }));
        prop_assert_eq!((a.risk_s, a.class, a.role), (b.risk_s, b.class, b.role));
        prop_assert_eq!(a.ambiguous, b.ambiguous);
    }

    /// A sentence names the moment at which the verdict stands: a figure shows it there.
    #[test]
    fn a_sentence_stands_at_its_moment(draw in draws(), alert in prop::option::of(1f64..300.0)) {
        let mut trace = draw.scene(0.0, 1.0, 0.0).trace();
        trace.alerts.extend(alert.map(|t_s| record::Alert { t_s, target: 0, rule: String::new() }));
        for verdict in judge_by(rules(), &trace).verdicts {
            if let Some(sentence) = &verdict.sentence {
                let t_s = verdict.t_s.unwrap() as u64;
                let clock = format!("At {:02}:{:02}", t_s / 60, t_s % 60);
                prop_assert!(sentence.starts_with(&clock), "{} in {:#?}", clock, verdict);
            }
        }
    }

    /// A failure never has a positive margin, and a pass never a negative one.
    #[test]
    fn margins_agree_with_the_status(draw in draws(), hull in prop::bool::ANY) {
        let scene = draw.scene(0.0, 1.0, 0.0);
        let scene = if hull { scene } else { scene.centre() };
        let trace = scene.trace();
        prop_assert_eq!(trace.distance == DistanceKind::Hull, hull);
        for verdict in judge_by(rules(), &trace).verdicts {
            if let (Some(margin), Some(robustness)) = (verdict.margin, verdict.robustness) {
                prop_assert!(verdict.status != Status::Fail || margin <= 0.0, "{:#?}", verdict);
                prop_assert!(verdict.status != Status::Pass || margin >= 0.0, "{:#?}", verdict);
                prop_assert!((-1.0..=1.0).contains(&robustness));
            }
            prop_assert!(verdict.score.is_none_or(|score| (0.0..=1.0).contains(&score)));
        }
    }
}
