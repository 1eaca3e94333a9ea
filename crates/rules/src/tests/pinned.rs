//! Some hundred voyages with everything that the judge says of them, written down in `pinned.txt`.
//!
//! The truth tables say what is right; this says that nothing else has moved. A change that is
//! meant is looked at line by line and then taken over: on a difference the test prints where the
//! new text lies.

use super::*;
use record::{
    Alert, DistanceKind, LastInstant, LastMinute, PairFacts, ShipTrack, Stopping, Visibility,
};
use std::fmt::Write;

const VOYAGES: u64 = 240;

/// Dice of single voyages, each chosen because a slip of the judge that the first hundreds do not
/// see changes what is said of it (`docs/measured/mutants.md`).
const CHOSEN: [u64; 59] = [
    1000, 1004, 1008, 1012, 1015, 1016, 1018, 1022, 1026, 1036, 1044, 1052, 1056, 1061, 1068, 1080,
    1083, 1100, 1110, 1116, 1119, 1140, 1144, 1146, 1204, 1206, 1228, 1264, 1279, 1283, 1371, 1394,
    1450, 1460, 1463, 1471, 1531, 1534, 1550, 1590, 1628, 1644, 1670, 1682, 1761, 1865, 1870, 2073,
    2075, 2196, 2229, 2303, 2535, 2629, 2631, 2665, 2778, 3019, 3038,
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
}

/// A ship with or without the models that she may declare.
fn any_ship(dice: &mut Dice, length_m: f64) -> record::Ship {
    let mut vessel = ship(length_m, length_m / 4.0);
    if dice.one_in(4) {
        vessel.yaw_rate_radps_max = deg(dice.between(0.5, 3.0));
    }
    if dice.one_in(3) {
        let reach_m = std::array::from_fn(|i| {
            let step = i as f64 + 1.0;
            step * step * length_m / 2.0
        });
        vessel.stopping = Some(Stopping { speed_mps_max: 10.0, reach_m });
        vessel.steerage_mps = Some(1.0);
    }
    vessel
}

/// What a ship does: holds, turns, slows, comes back, dithers.
fn sails(dice: &mut Dice, mut script: Script, speed_mps: f64) -> Script {
    script = script.hold(dice.between(0.0, 160.0));
    let mut off_deg = 0.0;
    for _ in 0..dice.word() % 5 {
        let rate = dice.between(0.2, 8.0);
        script = match dice.word() % 6 {
            0 | 1 => {
                let angle = dice.between(-75.0, 75.0);
                off_deg += angle;
                script.turn(angle, rate)
            }
            2 => {
                let angle = dice.between(-13.0, 13.0);
                (0..1 + dice.word() % 4)
                    .fold(script, |script, _| script.turn(angle, 3.0).hold(16.0))
            }
            3 => script.speed_to(dice.between(0.0, speed_mps * 1.3), dice.between(0.03, 0.6)),
            4 => (0..8).fold(script, |script, i| {
                script.turn(if i % 2 == 0 { 4.0 } else { -4.0 }, 2.0).hold(3.0)
            }),
            _ => {
                let back = script.turn(-off_deg, rate);
                off_deg = 0.0;
                back
            }
        };
        script = script.hold(dice.between(0.0, 90.0));
    }
    script
}

/// A target that would meet own ship of `own_mps` after a while, from any side.
fn meets(dice: &mut Dice, own_mps: f64) -> (Script, f64) {
    let psi_deg = match dice.word() % 6 {
        0 => 180.0 + dice.between(-17.0, 17.0),
        1 | 2 => dice.between(-20.0, 20.0),
        3 => 67.5 * if dice.one_in(2) { 1.0 } else { -1.0 } + dice.between(-3.0, 3.0),
        _ => dice.between(-180.0, 180.0),
    };
    let speed_mps = if dice.one_in(12) { 0.0 } else { dice.between(1.0, 10.0) };
    let after_s = dice.between(40.0, 420.0);
    let miss_m = dice.between(-250.0, 250.0);
    let velocity = geom::unit(deg(psi_deg)) * speed_mps;
    let aside = geom::unit(deg(dice.between(-180.0, 180.0))) * miss_m;
    let at = geom::Vec2::new(own_mps * after_s, 0.0) + aside - velocity * after_s;
    let length_m = dice.between(8.0, 60.0);
    let vessel = any_ship(dice, length_m);
    (Script::new(vessel, at.x, at.y, deg(psi_deg), speed_mps), speed_mps)
}

fn instant(dice: &mut Dice) -> LastInstant {
    match dice.word() % 6 {
        0 => LastInstant::NeverCritical,
        1 => LastInstant::BeforeStart,
        2 => LastInstant::Indicative(dice.between(10.0, 300.0).round()),
        _ => LastInstant::At(dice.between(10.0, 300.0).round()),
    }
}

fn voyage(dice: &mut Dice) -> Trace {
    let own_mps = dice.between(2.0, 9.0);
    let own = Script::new(any_ship(dice, 10.0), 0.0, 0.0, 0.0, own_mps);
    let own = if dice.one_in(7) { own.drift(0.4, -0.9) } else { own };
    let own = sails(dice, own, own_mps);
    let own = own.hold(if dice.one_in(8) { 10.0 } else { 300.0 });
    let (start, speed_mps) = meets(dice, own_mps);
    let alters = dice.one_in(4);
    let goes = if alters { sails(dice, start.clone(), speed_mps) } else { start.clone() };
    let mut scene = Scene::new(own, goes.hold(1000.0));
    if dice.one_in(3) {
        let (other, _) = meets(dice, own_mps);
        scene = scene.and(other.hold(1000.0));
    } else if alters && dice.one_in(2) {
        scene = scene.nominal_targets(vec![start.hold(1500.0)]);
    }
    if dice.one_in(7) {
        scene = scene.without_nominal();
    }
    if dice.one_in(6) {
        scene = scene.centre();
    }
    if dice.one_in(6) {
        scene.visibility = Visibility::Restricted { visual_range_m: dice.between(30.0, 1500.0) };
    }
    let mut trace = scene.trace();
    for (i, pair) in trace.pairs.iter_mut().enumerate() {
        if dice.one_in(3) {
            let tracked_s = dice.between(0.0, 150.0).round();
            (pair.detected_s, pair.tracked_s) = (Some(tracked_s), Some(tracked_s));
        }
        if dice.one_in(3) {
            let t_s = dice.between(0.0, 300.0);
            trace.alerts.push(Alert { t_s, target: i as u8, rule: String::new() });
        }
    }
    if trace.nominal.is_some() && dice.one_in(2) {
        let one = |dice: &mut Dice| LastMinute {
            own: instant(dice),
            own_any_turn: instant(dice),
            own_near_miss: instant(dice),
            target: instant(dice),
        };
        trace.last_minute = Some(trace.pairs.iter().map(|_| Some(one(dice))).collect());
    }
    if dice.one_in(4) {
        let half_angle_rad = deg(dice.between(4.0, 25.0));
        let reciprocal_rad = half_angle_rad * 2.0;
        trace.planner_sector = Some(geom::HeadOnSector { half_angle_rad, reciprocal_rad });
    }
    if dice.one_in(40) {
        let k = trace.own.len() / 2;
        trace.targets[0].psi_rad[k] = f64::NAN;
    }
    trace
}

/// The same way in twice the time, sampled every two seconds.
pub(super) fn in_slow_motion(trace: &mut Trace) {
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

/// The default rule set, and what its options make of it.
fn rule_sets() -> [RuleSet; 4] {
    let text = rules().text().to_owned();
    let other = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        RuleSet::parse(&text.replace(from, to)).unwrap()
    };
    let by_time = text.replace("mode = \"range\"", "mode = \"time\"");
    let early = by_time.replace("may_act_early = false", "may_act_early = true");
    [
        rules(),
        RuleSet::parse(&by_time).unwrap(),
        RuleSet::parse(&early).unwrap(),
        other("port_in_stage_4 = \"warn\"", "port_in_stage_4 = \"fail\"")
            .with("close_quarters_m", 420.0)
            .unwrap()
            .with("react_fail_s", 80.0)
            .unwrap(),
    ]
}

fn told(facts: &PairFacts) -> String {
    let time = |t_s: Option<f64>| t_s.map_or("-".to_owned(), |t_s| format!("{t_s:.1}"));
    let stages = facts.stages_s.map(time).join(" ");
    let class = facts.class.map_or("-", EncounterClass::name);
    let planner = facts.class_by_planner.map_or("-", EncounterClass::name);
    format!(
        "risk {} {class} {planner} {:?} doubt {} cpa {} stages {stages} released {} {:.1?} {:.1?} \
         turn {:.3?}",
        time(facts.risk_s),
        facts.role,
        facts.ambiguous,
        time(facts.cpa_s),
        time(facts.released_s),
        facts.reaction,
        facts.apparent,
        facts.first_turn_rad
    )
}

fn said(verdict: &Verdict) -> String {
    let mut line = format!("{} {}", verdict.check.name(), verdict.status.name());
    let number = |name: &str, value: Option<f64>, line: &mut String| {
        if let Some(value) = value {
            write!(line, " {name}{value:.3}").unwrap();
        }
    };
    write!(line, " {}", verdict.detail).unwrap();
    number("m", verdict.margin, &mut line);
    number("r", verdict.robustness, &mut line);
    number("s", verdict.score, &mut line);
    number("t", verdict.t_s, &mut line);
    let by = verdict.stages_by.map_or("-", |by| if by == StageClock::Range { "R" } else { "T" });
    write!(line, " {by}").unwrap();
    for entry in &verdict.evidence {
        write!(line, " {}={:.3}", entry.name, entry.value).unwrap();
    }
    write!(line, " {}", verdict.sentence.as_deref().unwrap_or("")).unwrap();
    line.trim_end().to_owned()
}

/// A short sum of a text (FNV-1a): the whole would be a megabyte.
fn sum(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |sum, byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// One line for each voyage: its facts, every status that is not "not applicable", and a sum of all
/// the rest that was said (margins, scores, times, evidence, sentences).
fn written() -> String {
    let mut dice = Dice(7);
    let mut judges = rule_sets().map(Judge::new);
    let mut text = String::new();
    for i in 0..VOYAGES {
        write_down(&mut text, i, &voyage(&mut dice), &mut judges[(i % 4) as usize]);
    }
    for seed in CHOSEN {
        let mut trace = voyage(&mut Dice(seed));
        if seed.is_multiple_of(4) {
            in_slow_motion(&mut trace);
        }
        write_down(&mut text, seed, &trace, &mut judges[(seed / 4 % 4) as usize]);
    }
    text
}

fn write_down(text: &mut String, n: u64, trace: &Trace, judge: &mut Judge) {
    assert!(matches!(trace.distance, DistanceKind::Hull | DistanceKind::Centre));
    let judgement = judge.judge(trace);
    let facts: Vec<String> = judgement.pairs.iter().map(told).collect();
    let mut line = format!("{n:03} {}", facts.join(" / "));
    let mut all = String::new();
    for verdict in judgement.verdicts.iter().chain(judgement.by_planner_class.iter().flatten()) {
        if verdict.status != Status::NotApplicable || !verdict.detail.is_empty() {
            let (check, status) = (verdict.check.name(), verdict.status.name());
            write!(line, "; {check} {status} {}", verdict.detail).unwrap();
        }
        all.push_str(&said(verdict));
        all.push('\n');
    }
    writeln!(text, "{line}; {:08x}", sum(&all)).unwrap();
}

#[test]
fn every_word_is_what_it_was() {
    let (was, is) = (include_str!("pinned.txt"), written());
    if was == is {
        return;
    }
    let path = std::env::temp_dir().join("pinned.txt");
    std::fs::write(&path, &is).unwrap();
    let other = was.lines().zip(is.lines()).find(|(was, is)| was != is);
    let others = was.lines().zip(is.lines()).filter(|(was, is)| was != is).count();
    panic!("{others} voyages are judged otherwise, first {other:#?}; all: {}", path.display());
}

/// The first look finds the same facts as the whole judgement.
#[test]
fn the_facts_alone_are_those_of_the_judgement() {
    let mut dice = Dice(20_260_101);
    let mut judge = Judge::new(rules());
    for _ in 0..60 {
        let trace = voyage(&mut dice);
        let (looked, judged) = (judge.pairs(&trace), judge.judge(&trace).pairs);
        assert_eq!(format!("{looked:?}"), format!("{judged:?}"));
    }
}

/// The voyages put every check to the test, and every status occurs.
#[test]
fn the_voyages_reach_every_check() {
    let text = include_str!("pinned.txt");
    for check in Check::ALL {
        let name = check.name();
        assert!(text.contains(&format!("; {name} pass")), "no voyage passes {name}");
        let bad = ["fail", "warn"].iter().any(|s| text.contains(&format!("; {name} {s}")));
        assert!(bad || check == Check::R17May, "no voyage fails {name}");
    }
}
