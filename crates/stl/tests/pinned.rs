//! Some hundred voyages with every finding and robustness of the second judge, written down in
//! `pinned.txt`.
//!
//! The other tests say what is right; this says that nothing else has moved. A change that is
//! meant is looked at line by line and then taken over: on a difference the test prints where the
//! new text lies.

#![expect(clippy::unwrap_used, reason = "a test: a panic is its failure")]

mod common;

use common::{Script, USV, deg, run};
use record::{DistanceKind, LastInstant, LastMinute, ShipTrack, Trace, Visibility};
use std::fmt::Write;
use stl::{Finding, Params, StageClock, WITH_FORMULA, judge};

const VOYAGES: u64 = 600;

/// Dice of single voyages, each chosen because a slip of the judge that the first hundreds do not
/// see changes what is said of it (`docs/measured/mutants.md`).
const CHOSEN: [u64; 41] = [
    1027, 1049, 1065, 1067, 1082, 1113, 1167, 1171, 1195, 1277, 1283, 1289, 1292, 1360, 1408, 1412,
    1502, 1518, 1525, 1529, 1585, 1589, 1700, 1739, 1789, 1897, 1963, 2136, 2170, 2272, 2304, 2356,
    2427, 2488, 2641, 2824, 2880, 3093, 3117, 3333, 3449,
];

/// The sequence of Steele, Lea and Flood's SplitMix64, for numbers that never change.
struct Dice(u64);

impl Dice {
    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.word() >> 11) as f64 / (1u64 << 53) as f64;
        // two decimals: the voyages can be read, and rounding decides nothing
        ((low + (high - low) * share) * 100.0).round() / 100.0
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.word().is_multiple_of(n)
    }

    fn below(&mut self, n: u64) -> usize {
        (self.word() % n) as usize
    }
}

/// What a ship does: turns, comes back, slows and speeds up, dithers.
fn sails(dice: &mut Dice, mut script: Script) -> Script {
    let mut at_s = 5 + dice.below(140);
    let mut off_deg = 0.0;
    for _ in 0..dice.below(5) {
        match dice.below(7) {
            0 | 1 => {
                let angle_deg = dice.between(-70.0, 70.0);
                off_deg += angle_deg;
                let rate = dice.between(0.3, 6.0);
                let seconds = (angle_deg.abs() / rate).ceil().max(1.0);
                script.turns.push((at_s, angle_deg / seconds, seconds as usize));
            }
            2 => {
                let angle_deg = dice.between(-13.0, 13.0);
                for i in 0..1 + dice.below(4) {
                    script = script.turn(at_s + 16 * i, angle_deg);
                    off_deg += angle_deg;
                }
            }
            3 => {
                let by_mps = dice.between(-0.8, 0.6) * script.speed_mps;
                script = script.change_speed(at_s, by_mps);
            }
            4 => script.speeds.push((at_s, dice.between(-0.04, 0.04), 50)),
            5 => {
                for i in 0..8 {
                    let rate = if i % 2 == 0 { 1.6 } else { -1.6 };
                    script.turns.push((at_s + 5 * i, rate, 2));
                }
            }
            _ => {
                script = script.turn(at_s, -off_deg);
                off_deg = 0.0;
            }
        }
        at_s += 10 + dice.below(90);
    }
    script
}

/// A target that would meet own ship after a while, from any side.
fn meets(dice: &mut Dice, own_mps: f64) -> Script {
    let psi_deg = match dice.below(6) {
        0 | 4 => 180.0 + dice.between(-17.0, 17.0),
        1 | 2 => dice.between(-20.0, 20.0),
        3 => 67.5 * if dice.one_in(2) { 1.0 } else { -1.0 } + dice.between(-3.0, 3.0),
        _ => dice.between(-180.0, 180.0),
    };
    let speed_mps = if dice.one_in(12) { 0.0 } else { dice.between(1.0, 10.0) };
    let after_s = dice.between(30.0, 250.0);
    let aside_rad = deg(dice.between(-180.0, 180.0));
    let miss_m = dice.between(-220.0, 220.0);
    let (sin, cos) = libm::sincos(deg(psi_deg));
    let north_m = own_mps * after_s + miss_m * libm::cos(aside_rad) - speed_mps * after_s * cos;
    let east_m = miss_m * libm::sin(aside_rad) - speed_mps * after_s * sin;
    Script::straight(north_m, east_m, psi_deg, speed_mps)
}

fn instant(dice: &mut Dice) -> LastInstant {
    let t_s = dice.between(0.0, 260.0).round();
    match dice.below(6) {
        0 => LastInstant::NeverCritical,
        1 => LastInstant::BeforeStart,
        2 => LastInstant::Indicative(t_s),
        _ => LastInstant::At(t_s),
    }
}

fn voyage(dice: &mut Dice) -> Trace {
    let own_mps = dice.between(2.0, 9.0);
    let start = Script::straight(0.0, 0.0, 0.0, own_mps);
    let own = if dice.one_in(3) {
        let (at_s, angle_deg) = (5 + dice.below(90), dice.between(20.0, 60.0));
        let side = if dice.one_in(4) { -1.0 } else { 1.0 };
        let turned = start.turn(at_s, side * angle_deg);
        turned.turn(at_s + 60 + dice.below(120), -side * angle_deg)
    } else {
        sails(dice, start)
    };
    let targets: Vec<Script> = (0..1 + dice.below(2) + dice.below(2) / 2)
        .map(|_| {
            let target = meets(dice, own_mps);
            if dice.one_in(4) { sails(dice, target) } else { target }
        })
        .collect();
    let samples = if dice.one_in(8) { 120 } else { 420 };
    let mut trace = run(&own, &targets, samples);
    if dice.one_in(6) {
        // her route has the turns that she made
        let own = trace.own.clone();
        trace.nominal.as_mut().unwrap().own = own;
    }
    if dice.one_in(5) {
        // the targets altered because of own ship
        let held: Vec<Script> =
            targets.iter().map(|t| Script { turns: vec![], speeds: vec![], ..t.clone() }).collect();
        let planned = run(&own, &held, samples).nominal;
        trace.nominal = planned;
    }
    if dice.one_in(8) {
        trace.nominal = None;
    }
    if dice.one_in(6) {
        trace.distance = DistanceKind::Centre;
    }
    if dice.one_in(4) {
        trace.visibility = Visibility::Restricted { visual_range_m: dice.between(30.0, 1200.0) };
    }
    for pair in &mut trace.pairs {
        if dice.one_in(3) {
            pair.tracked_s = Some(dice.between(0.0, 60.0).round());
        }
    }
    if dice.one_in(2) {
        let pairs: Vec<_> = (0..trace.pairs.len())
            .map(|_| {
                let (own, target) = (instant(dice), instant(dice));
                let last = LastMinute { own, own_any_turn: own, own_near_miss: own, target };
                (!dice.one_in(4)).then_some(last)
            })
            .collect();
        trace.last_minute = Some(pairs);
    }
    if dice.one_in(6) {
        in_slow_motion(&mut trace);
    }
    trace
}

/// The same way in twice the time, sampled every two seconds.
fn in_slow_motion(trace: &mut Trace) {
    trace.sample_s = 2.0;
    trace.end_s *= 2.0;
    let slow = |track: &mut ShipTrack| {
        for signal in [
            &mut track.vel_north_mps,
            &mut track.vel_east_mps,
            &mut track.stw_mps,
            &mut track.yaw_rate_radps,
        ] {
            signal.iter_mut().for_each(|value| *value /= 2.0);
        }
    };
    slow(&mut trace.own);
    trace.targets.iter_mut().for_each(slow);
    if let Some(nominal) = &mut trace.nominal {
        slow(&mut nominal.own);
        nominal.targets.iter_mut().for_each(slow);
    }
    let minima = trace.nominal.iter_mut().flat_map(|nominal| nominal.minima.iter_mut());
    for minimum in minima.chain(trace.pairs.iter_mut().map(|pair| &mut pair.minimum)) {
        minimum.hull_s *= 2.0;
        minimum.centre_s *= 2.0;
    }
    if let Some(contact) = &mut trace.contact {
        contact.t_s *= 2.0;
    }
}

fn name(finding: Finding) -> &'static str {
    match finding {
        Finding::Holds => "holds",
        Finding::Violated => "violated",
        Finding::Undecided => "undecided",
        Finding::NotApplicable => "-",
        Finding::Inconclusive => "inconclusive",
        Finding::NotEvaluated => "not evaluated",
    }
}

fn written() -> String {
    let mut dice = Dice(20_261_203);
    let mut text = String::new();
    for n in 0..VOYAGES {
        write_down(&mut text, n, &voyage(&mut dice));
    }
    for seed in CHOSEN {
        write_down(&mut text, seed, &voyage(&mut Dice(seed)));
    }
    text
}

fn write_down(text: &mut String, n: u64, trace: &Trace) {
    let params = Params {
        stage_clock: if n % 4 == 3 { StageClock::Time } else { StageClock::Range },
        close_quarters_m: if n.is_multiple_of(3) { 400.0 } else { 200.0 },
        port_turn_fails_in_stage_4: n.is_multiple_of(5),
        ..USV
    };
    let all = judge(trace, &params);
    for target in 0..trace.targets.len() {
        write!(text, "{n:03}.{target}").unwrap();
        for check in WITH_FORMULA {
            let said =
                all.iter().find(|r| r.check == check && usize::from(r.target) == target).unwrap();
            write!(text, "; {} {}", check.name(), name(said.status)).unwrap();
            if let Some(rho) = said.rho {
                write!(text, " {rho:.6}").unwrap();
            }
        }
        text.push('\n');
    }
}

#[test]
fn every_finding_is_what_it_was() {
    let (was, is) = (include_str!("pinned.txt"), written());
    if was == is {
        return;
    }
    let path = std::env::temp_dir().join("pinned-stl.txt");
    std::fs::write(&path, &is).unwrap();
    let other = was.lines().zip(is.lines()).find(|(was, is)| was != is);
    let others = was.lines().zip(is.lines()).filter(|(was, is)| was != is).count();
    panic!("{others} pairs are judged otherwise, first {other:#?}; all: {}", path.display());
}

/// The voyages put every formula to the test, and every finding occurs that it can have.
#[test]
fn the_voyages_reach_every_formula() {
    let text = include_str!("pinned.txt");
    for check in WITH_FORMULA {
        for finding in [Finding::Holds, Finding::Violated, Finding::Inconclusive] {
            let said = format!("; {} {}", check.name(), name(finding));
            assert!(text.contains(&said), "no voyage has{said}");
        }
    }
}
