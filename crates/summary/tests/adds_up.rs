//! Parts add up to the whole, and the whole says what the rows say.

use proptest::prelude::*;
use record::{
    Check, CheckCell, Digest, EncounterClass, EncounterId, Outcome, PlannerEvents, Reaction,
    RunRow, Seed, Status,
};
use summary::{AvoidableRates, BoundedRate, Summary, SummaryHead, Tallies};

fn row(stratum: &str, j: u64) -> RunRow {
    RunRow {
        id: EncounterId::new(stratum, j),
        outcome: Outcome::Completed,
        digest: Digest(j),
        weight: 1.0,
        targets: 1,
        class: Some(EncounterClass::HeadOn),
        class_by_planner: None,
        fails_by_planner_class: None,
        ambiguous: false,
        intents: "hold_course".into(),
        sensing: "perfect".into(),
        own_speed_mps: 6.0,
        target_speed_mps: Some(9.0),
        target_length_m: Some(40.0),
        beta_rad: Some(0.02),
        alpha_rad: Some(-0.01),
        range_m: Some(1500.0),
        miss_m: Some(20.0),
        tcpa_s: Some(100.0),
        end_s: 300.0,
        cpa_hull_m: Some(160.0),
        cpa_centre_m: Some(190.0),
        cpa_s: Some(110.0),
        unknown: false,
        safety_radius_broken: false,
        nominal_cpa_hull_m: Some(0.0),
        nominal_safety_radius_broken: Some(true),
        unavoidable: None,
        risk_s: Some(1.0),
        reaction: Reaction::After(4.2),
        apparent: Reaction::After(8.4),
        first_turn_rad: Some(0.4),
        extra_distance_m: Some(31.0),
        goal_reached: false,
        impact_mps: None,
        impulse_ns: None,
        energy_lost_j: None,
        planner_detail: None,
        events: PlannerEvents::default(),
        checks: vec![CheckCell { status: Status::Pass, margin: Some(1.0) }; Check::COUNT],
        judges_disagree: None,
    }
}

fn head() -> SummaryHead {
    SummaryHead {
        campaign: "test".into(),
        planner: "p".into(),
        seed: Seed(7),
        root_digest: "00".into(),
    }
}

fn summary_of(rows: &[RunRow]) -> Summary {
    let mut tallies = Tallies::new();
    rows.iter().for_each(|row| tallies.add(row));
    Summary::new(head(), &tallies, ["head_on"])
}

/// The judge's class decides; what the planner's would make of it stands beside.
#[test]
fn failures_under_the_planners_class_stand_beside_the_judges() {
    let mut rows: Vec<_> = (0..10).map(|j| row("head_on", j)).collect();
    for row in &mut rows[..6] {
        row.class_by_planner = Some(record::EncounterClass::CrossingStbd);
        row.checks[Check::Turn as usize].status = Status::Fail;
        row.checks[Check::R15 as usize].status = Status::Pass;
    }
    rows[0].fails_by_planner_class = Some("none".to_owned());
    rows[1].fails_by_planner_class = Some("turn+r15".to_owned());
    let class = summary_of(&rows).planner_class;
    assert_eq!((class.stated, class.disagree), (6, 2));
    let expected = [("r15".to_owned(), [0, 1]), ("turn".to_owned(), [6, 5])];
    assert_eq!(class.fails, expected.into_iter().collect());
}

/// Unknown runs stay in n, weigh on the upper bound only, and not twice.
#[test]
fn unknown_runs_count_against_the_planner_once() {
    let mut rows: Vec<_> = (0..100).map(|j| row("head_on", j)).collect();
    rows[0].outcome = Outcome::Collision;
    rows[0].safety_radius_broken = true;
    rows[0].cpa_hull_m = Some(0.0);
    for lost in &mut rows[1..4] {
        lost.outcome = Outcome::PlannerHung;
        lost.unknown = true;
        lost.cpa_hull_m = Some(500.0);
        lost.reaction = Reaction::Unknown;
    }
    rows[1].safety_radius_broken = true;
    let stratum = &summary_of(&rows).strata[0];
    assert_eq!((stratum.n, stratum.unknown), (100, 3));
    assert_eq!((stratum.collision.k, stratum.safety_radius.k), (1, 2));
    // Clopper-Pearson, two-sided 95 %: 1 of 100 from 0.000253, 4 of 100 up to 0.0992569.
    assert!((stratum.collision.lower_95 - 0.000_253_146).abs() < 1e-8);
    assert!((stratum.collision.upper_95 - 0.099_256_9).abs() < 1e-6);
    assert_eq!(stratum.safety_radius.upper_95.to_bits(), stratum.collision.upper_95.to_bits());
    // The three unknown distances rank lowest, whatever was seen before the planner failed.
    assert_eq!(stratum.min_cpa_m.p01, None);
    assert_eq!(stratum.min_cpa_m.p05, Some(160.0));
    assert_eq!((stratum.reaction_time_s.censored, stratum.reaction_time_s.max), (3, None));
    assert_eq!(stratum.reaction_time_s.p95, Some(4.2));
    assert_eq!(stratum.outcomes[&Outcome::PlannerHung], 3);
    // One of the hundred nominal collisions is left for sure, three more at worst.
    let pairs = stratum.collision_pairs;
    assert_eq!((pairs.removed, pairs.left, pairs.caused, pairs.unknown), (96, 1, 0, 3));
    assert_eq!(pairs.risk_ratio, Some(0.01));
    assert!(pairs.lower_95.unwrap() < 0.01 && pairs.upper_95.unwrap() > 0.099_256_9);
}

#[test]
fn json_has_the_promised_words() {
    let text = summary_of(&[row("head_on", 0)]).to_json();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    for key in ["schema", "campaign", "planner", "seed", "encounters", "root_digest", "strata"] {
        assert!(value.get(key).is_some(), "{key}");
    }
    let stratum = &value["strata"][0];
    for (key, inner) in [
        ("collision", &["k", "n", "rate", "lower_95", "upper_95"][..]),
        ("safety_radius", &["k", "n", "rate", "lower_95", "upper_95"]),
        (
            "turn_direction",
            &["pass", "warn", "fail", "inconclusive", "not_applicable", "not_evaluated"],
        ),
        ("reaction_time_s", &["median", "p95", "max", "censored", "early"]),
        ("apparent_manoeuvre_s", &["median", "p95", "max", "censored", "early"]),
        ("min_cpa_m", &["p01", "p05", "median"]),
        ("outcomes", &["completed", "planner_protocol", "invalid"]),
    ] {
        for name in inner {
            assert!(stratum[key].get(name).is_some(), "{key}.{name}");
        }
    }
    for key in ["name", "n", "generated", "rejected", "unknown"] {
        assert!(stratum.get(key).is_some(), "{key}");
    }
    assert_eq!(stratum["outcomes"]["completed"], 1);
    for check in Check::ALL {
        assert_eq!(stratum["checks"][check.name()]["pass"], 1, "{}", check.name());
    }
    let read: Summary = serde_json::from_str(&text).unwrap();
    assert_eq!(read.to_json(), text);
}

#[test]
fn strata_come_in_the_order_of_the_campaign() {
    let mut tallies = Tallies::new();
    tallies.add(&row("overtaken", 0));
    tallies.add(&row("aside", 0));
    tallies.stratum_mut("overtaken").add_draws(7, 6);
    let summary = Summary::new(head(), &tallies, ["overtaken", "head_on"]);
    let names: Vec<_> = summary.strata.iter().map(|s| (s.name.as_str(), s.n)).collect();
    assert_eq!(names, [("overtaken", 1), ("head_on", 0), ("aside", 1)]);
    assert_eq!((summary.strata[0].generated, summary.strata[0].rejected), (7, 6));
    assert_eq!(summary.strata[1].collision, BoundedRate::new(0, 0, 0));
    assert_eq!(summary.strata[1].collision.rate, None);
    assert_eq!(summary.encounters, 2);
}

fn any_row() -> impl Strategy<Value = RunRow> {
    let reaction = prop_oneof![
        Just(Reaction::NoRisk),
        Just(Reaction::Early),
        (0.0..900.0).prop_map(Reaction::After),
        Just(Reaction::Never),
        Just(Reaction::Unknown),
    ];
    let status = (0..6_usize).prop_map(|i| Status::ALL[i]);
    (
        (0..3_usize, 0..1000_u64, 0..11_usize, 0.0..4.0_f64, prop::option::of(0..6_usize)),
        (any::<bool>(), any::<bool>(), prop::option::of(0.0..30_000.0_f64), any::<bool>()),
        (reaction, prop::option::of(-3.2..3.2_f64), 0.0..12.0_f64, prop::option::of(any::<bool>())),
        prop::collection::vec(status, Check::COUNT),
    )
        .prop_map(|(which, flags, more, statuses)| {
            let mut row = row(["head_on", "aside", "overtaken"][which.0], which.1);
            row.outcome = Outcome::ALL[which.2];
            row.weight = which.3;
            row.class = which.4.map(|i| EncounterClass::ALL[i]);
            (row.unknown, row.safety_radius_broken, row.cpa_hull_m, row.ambiguous) = flags;
            row.reaction = more.0;
            row.beta_rad = more.1;
            row.target_speed_mps = Some(more.2);
            (row.unavoidable, row.judges_disagree) = (more.3, more.3);
            row.nominal_safety_radius_broken = more.3;
            row.events.passes = which.1 as u32;
            for (cell, status) in row.checks.iter_mut().zip(statuses) {
                cell.status = status;
            }
            row
        })
}

proptest! {
    #[test]
    fn any_partition_gives_the_same_bytes(
        rows in prop::collection::vec((any_row(), 0..4_usize), 0..60),
    ) {
        let mut whole = Tallies::new();
        let mut parts = vec![Tallies::new(); 4];
        for (row, part) in &rows {
            whole.add(row);
            parts[*part].add(row);
        }
        let mut merged = Tallies::new();
        for part in parts.iter().rev() {
            let text = serde_json::to_string(part).unwrap();
            merged.merge(&serde_json::from_str(&text).unwrap());
        }
        prop_assert_eq!(
            serde_json::to_string(&merged).unwrap(),
            serde_json::to_string(&whole).unwrap()
        );
        let json = |tallies| {
            let summary = Summary::new(head(), tallies, ["head_on"]);
            summary.with_weights(tallies, |_| Some(4.0)).to_json()
        };
        prop_assert_eq!(json(&merged), json(&whole));
    }

    #[test]
    fn every_row_is_counted_once_in_each_table(rows in prop::collection::vec(any_row(), 1..60)) {
        let summary = summary_of(&rows);
        prop_assert_eq!(summary.encounters, rows.len() as u64);
        for stratum in &summary.strata {
            prop_assert_eq!(stratum.outcomes.values().sum::<u64>(), stratum.n);
            for statuses in stratum.checks.values() {
                prop_assert_eq!(statuses.values().sum::<u64>(), stratum.n);
            }
            let pairs = stratum.safety_radius_pairs;
            prop_assert_eq!(
                pairs.neither
                    + pairs.removed
                    + pairs.left
                    + pairs.caused
                    + pairs.unknown
                    + pairs.without_nominal,
                stratum.n
            );
            for rate in [stratum.collision, stratum.safety_radius] {
                if let Some(value) = rate.rate {
                    prop_assert!(rate.lower_95 <= value && value <= rate.upper_95);
                }
            }
        }
    }
}

/// Encounters that nobody could avoid stay in the headline rates; a second line leaves them out.
#[test]
fn unavoidable_runs_stay_in_the_rates_and_are_left_out_of_the_second_line() {
    let rows: Vec<RunRow> = (0..10)
        .map(|j| {
            let mut row = row("head_on", j);
            row.unavoidable = Some(j < 3);
            if j < 4 {
                (row.outcome, row.cpa_hull_m) = (Outcome::Collision, Some(0.0));
                row.safety_radius_broken = true;
            }
            row.unknown = j == 2 || j == 9;
            row
        })
        .collect();
    let stratum = &summary_of(&rows).strata[0];
    assert_eq!((stratum.collision.k, stratum.collision.n), (4, 10));
    assert_eq!(stratum.unavoidable, Some(3));
    let without = AvoidableRates {
        collision: BoundedRate::new(1, 1, 7),
        safety_radius: BoundedRate::new(1, 1, 7),
    };
    assert_eq!(stratum.without_unavoidable, Some(without));
    let plain = summary_of(&[row("head_on", 0)]);
    assert_eq!(plain.strata[0].without_unavoidable, None, "nobody asked");
}
