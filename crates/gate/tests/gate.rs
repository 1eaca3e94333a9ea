//! The gate over real runs: a planner against itself, mutants, negative controls, order.

use campaign::plan::Build;
use campaign::worker::Shop;
use campaign::{Error, Plan};
use gate::arm::{Arm, ArmRow, InProcess, beats};
use gate::child::Launch;
use gate::self_test::SelfTest;
use gate::spec::{GateSpec, PlannerSpec};
use gate::{Child, Event, mutants};
use planner_api::Registry;
use record::Outcome;
use stats::GateVerdict;

const GATE: &str = include_str!("../../../campaigns/gate.toml");
const RULES: &str = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");

fn build() -> Build {
    Build {
        tool_version: "0".into(),
        git_commit: "unknown".into(),
        git_clean: true,
        engine: "e".into(),
        planners: "p".into(),
        cargo_lock_sha256: "l".into(),
        rustc: "r".into(),
    }
}

fn plan(spec: &GateSpec, registry: &Registry, name: &str, seed: u64) -> Plan {
    let asked = PlannerSpec { name: name.into(), ..PlannerSpec::default() };
    spec.plan(&asked, seed, registry, &|_| Ok(RULES.to_owned()), &build()).expect("it is valid")
}

/// The gate of the repository with a small cap.
fn spec(cap: u64) -> GateSpec {
    let mut spec = GateSpec::parse(GATE, "gate").expect("it is valid");
    spec.table.cap_pairs = cap;
    spec.table.look_every_pairs = 70;
    // the margins of the repository need more pairs than a test has
    spec.table.absolute.clear();
    for metric in &mut spec.table.metric {
        metric.margin = stats::Margin::Absolute { difference: 0.05 };
        metric.discordance_plan = 0.01;
    }
    spec
}

fn self_test(spec: &GateSpec, strata: &[String]) -> SelfTest<'static> {
    SelfTest {
        gate: spec.gate_plan(strata, 1, &[]).expect("it is valid"),
        events: spec.events(),
        near_m: spec.near_m(),
        tell: &|_| {},
        stop: &|| false,
    }
}

/// What the gate says of a candidate against the seed planner.
fn verdict(candidate: &str, cap: u64) -> (GateVerdict, Vec<String>) {
    let registry = mutants::with_mutant(planners::registry(), candidate).expect("it is valid");
    let spec = spec(cap);
    let (a, b) = (plan(&spec, &registry, "zhuang", 7), plan(&spec, &registry, candidate, 7));
    let (shop_a, shop_b) = (
        Shop::new(&a, &registry).expect("it is valid"),
        Shop::new(&b, &registry).expect("it is valid"),
    );
    let (beats_a, beats_b) = (beats(2), beats(2));
    let mut arm_a = InProcess::new(&shop_a, &a, &beats_a).expect("it is valid");
    let mut arm_b = InProcess::new(&shop_b, &b, &beats_b).expect("it is valid");
    let test = self_test(&spec, &a.strata);
    let killing = test.kill(&a, candidate, &mut arm_a, &mut arm_b).expect("it is valid");
    (killing.verdict, killing.worse)
}

/// Twice the same planner, on one thread and on three: not one bit may differ.
#[test]
fn a_planner_against_itself_differs_in_no_bit_and_never_fails() {
    let registry = planners::registry();
    let spec = spec(420);
    let plan = plan(&spec, &registry, "zhuang", 11);
    let shop = Shop::new(&plan, &registry).unwrap();
    let (one, three) = (beats(1), beats(3));
    let mut a = InProcess::new(&shop, &plan, &one).unwrap();
    let mut b = InProcess::new(&shop, &plan, &three).unwrap();
    let same = self_test(&spec, &plan.strata).same(&plan, &mut a, &mut b).unwrap();
    assert!(same.holds(), "{same:?}");
    assert_eq!(same.verdict, GateVerdict::Pass, "{same:?}");
}

/// A sample of what the full self-test kills. The gate stops at the first look that shows harm,
/// so of several true faults any one may be named: the list holds those that the planner has.
#[test]
fn mutants_and_negative_controls_fail_and_a_fault_of_theirs_is_named() {
    for (candidate, faults) in [
        ("mutant:sign-flip:zhuang", &["turn", "r14", "r15", "r17c"][..]),
        ("always-port", &["turn", "r14", "r17ai", "r17c"]),
        ("hold-course", &["safety_radius", "near", "safe"]),
    ] {
        let (verdict, worse) = verdict(candidate, 1400);
        assert_eq!(verdict, GateVerdict::Fail, "{candidate}: {worse:?}");
        let named = |name: &String| faults.contains(&name.split(' ').next().unwrap_or_default());
        assert!(worse.iter().any(named), "{candidate}: {worse:?}");
    }
}

/// An arm whose rows come in another order is a fault of the bench, never a number.
#[test]
fn rows_in_completion_order_are_refused() {
    struct Reversed<'a>(InProcess<'a>);
    impl Arm for Reversed<'_> {
        fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
            let mut rows = self.0.rows(ids)?;
            rows.reverse();
            Ok(rows)
        }
    }
    let registry = planners::registry();
    let spec = spec(140);
    let plan = plan(&spec, &registry, "hold-course", 3);
    let shop = Shop::new(&plan, &registry).unwrap();
    let (one, two) = (beats(1), beats(1));
    let mut a = InProcess::new(&shop, &plan, &one).unwrap();
    let mut b = Reversed(InProcess::new(&shop, &plan, &two).unwrap());
    let error = self_test(&spec, &plan.strata).compare(&plan, &mut a, &mut b).unwrap_err();
    assert!(matches!(error, Error::Fault(_)), "{error}");
}

/// Runs that the wall clock ended are counted by arm: their verdict is one of this machine.
#[test]
fn runs_that_the_wall_clock_ended_are_counted_for_the_planner_that_was_ended() {
    struct Slow<'a>(InProcess<'a>, u64);
    impl Arm for Slow<'_> {
        fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
            let mut rows = self.0.rows(ids)?;
            for row in rows.iter_mut().filter(|row| row.id % self.1 == 0) {
                (row.outcome, row.unknown) = (Outcome::PlannerHung, true);
            }
            Ok(rows)
        }
    }
    let registry = planners::registry();
    let spec = spec(70);
    let plan = plan(&spec, &registry, "hold-course", 3);
    let shop = Shop::new(&plan, &registry).unwrap();
    let (one, two) = (beats(1), beats(1));
    let mut a = Slow(InProcess::new(&shop, &plan, &one).unwrap(), 1000);
    let mut b = Slow(InProcess::new(&shop, &plan, &two).unwrap(), 10);
    let paired = self_test(&spec, &plan.strata).compare(&plan, &mut a, &mut b).unwrap();
    let said = paired.clocked.sentence().unwrap();
    assert_eq!((paired.clocked.baseline, paired.clocked.candidate), (1, 7), "{said}");
    assert!(said.contains("7 runs of the candidate, 1 of the baseline"), "{said}");
    assert_eq!(gate::run::Clocked::default().sentence(), None);
}

/// The two gates differ in their world alone, and that of the second is the open sea's.
#[test]
fn the_gate_on_the_open_sea_is_the_gate_in_another_world() {
    const OPEN_SEA: &str = include_str!("../../../campaigns/open-sea.toml");
    const GATE_OPEN_SEA: &str = include_str!("../../../campaigns/gate-open-sea.toml");
    GateSpec::parse(GATE_OPEN_SEA, "gate-open-sea").expect("it is valid");
    let table = |text: &str| text.parse::<toml::Table>().unwrap();
    let (mut there, mut gate, open_sea) = (table(GATE_OPEN_SEA), table(GATE), table(OPEN_SEA));
    for world in ["sensing", "weather"] {
        let taken = |file: &mut toml::Table| file["model"].as_table_mut().unwrap().remove(world);
        assert_eq!(taken(&mut there).as_ref(), open_sea["model"].get(world), "{world}");
        taken(&mut gate);
    }
    for key in ["intent", "intent_mix", "conduct"] {
        let target = |file: &mut toml::Table| {
            file["model"].as_table_mut().unwrap()["target"].as_table_mut().unwrap().remove(key)
        };
        assert_eq!(target(&mut there).as_ref(), open_sea["model"]["target"].get(key), "{key}");
        target(&mut gate);
    }
    for own in ["name", "title"] {
        assert_ne!(there.remove(own), gate.remove(own), "{own}");
    }
    assert_eq!(there, gate);
}

/// The gate of the repository is feasible, and a cap that can never show a margin is refused with
/// the cap that it needs.
#[test]
fn the_built_in_gate_is_feasible_and_a_small_cap_is_refused_with_what_it_needs() {
    let spec = GateSpec::parse(GATE, "gate").unwrap();
    let registry = planners::registry();
    let strata = plan(&spec, &registry, "zhuang", 1).strata;
    assert_eq!(strata.len(), 7);
    let feasible = spec.gate_plan(&strata, 1, &[]).unwrap().feasibility().unwrap();
    assert!(feasible.neutral_change_passes(), "{feasible:?}");
    let mut small = spec.clone();
    small.table.cap_pairs = 20_000;
    let refused = small.gate_plan(&strata, 1, &[]).unwrap().feasibility().unwrap_err();
    assert!(refused.to_string().contains("needs a cap of"), "{refused}");
    for event in [Event::Collision, Event::PlannerFailure, Event::SafetyRadius, Event::Near] {
        assert!(spec.events().contains(&event), "{}", event.name());
    }
}

/// An arm in a process of its own gives the rows that this process gives, and a planner that takes
/// its process with it costs the encounters that it loses and no others.
#[test]
fn a_planner_that_takes_its_process_with_it_costs_its_own_rows_only() {
    let program = std::env::current_exe().unwrap();
    let program = program.parent().unwrap().parent().unwrap().join("examples").join("arm");
    let launch = Launch { program, arguments: Vec::new(), threads: 2 };
    let registry = planners::registry();
    let spec = spec(210);
    let ids: Vec<u64> = (0..210).collect();
    let good = plan(&spec, &registry, "zhuang", 5);
    let shop = Shop::new(&good, &registry).unwrap();
    let counters = beats(2);
    let here = InProcess::new(&shop, &good, &counters).unwrap().rows(&ids).unwrap();
    let mut there = Child::start(launch.clone(), good.clone()).unwrap();
    assert_eq!(there.rows(&ids).unwrap(), here);
    for (name, outcome) in [
        ("panics", Outcome::PlannerPanicked),
        ("aborts", Outcome::PlannerCrashed),
        ("spins", Outcome::PlannerHung),
    ] {
        let mut bad = plan(&spec, &registry, name, 5);
        bad.run.planner_hang_limit_s = 0.5;
        // enough that 210 encounters hold some
        bad.planner.options.insert("share".into(), 0.03.into());
        let mut arm = Child::start(launch.clone(), bad).unwrap();
        let rows = arm.rows(&ids).unwrap();
        let lost = rows.iter().filter(|row| row.outcome == outcome).count();
        assert!(lost > 0 && lost < 20, "{name} lost {lost} of 210");
        for (row, was) in rows.iter().zip(&here) {
            assert_eq!(row.id, was.id);
            if row.outcome == outcome {
                assert!(row.unknown, "{name}: place {} must count against it", row.id);
            } else {
                assert_eq!(row, was, "{name} changed place {}", row.id);
            }
        }
    }
}

/// Ctrl-C between two blocks: no verdict, nothing counted as one, and the way to go on is said.
#[test]
fn a_gate_that_is_interrupted_has_no_verdict() {
    let registry = planners::registry();
    let spec = spec(420);
    let plan = plan(&spec, &registry, "hold-course", 3);
    let shop = Shop::new(&plan, &registry).unwrap();
    let (one, two) = (beats(1), beats(1));
    let mut a = InProcess::new(&shop, &plan, &one).unwrap();
    let mut b = InProcess::new(&shop, &plan, &two).unwrap();
    let asked = std::cell::Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() > 2
    };
    let test = SelfTest { stop: &stop, ..self_test(&spec, &plan.strata) };
    let error = test.compare(&plan, &mut a, &mut b).unwrap_err();
    assert!(matches!(&error, Error::Incomplete(why) if why.contains("140 pairs")), "{error}");
}
