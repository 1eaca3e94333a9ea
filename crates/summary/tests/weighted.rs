//! Rates of a population from encounters that were drawn otherwise: right, and honestly bounded.

use record::{
    Check, CheckCell, Digest, EncounterId, Outcome, PlannerEvents, Reaction, RunRow, Seed, Status,
};
use stats::{MeanBets, clopper_pearson};
use summary::{StratumSummary, Summary, SummaryHead, Tallies, Tally, WeightedSummary};

/// splitmix64: the simulations need no more than numbers that are not ours.
struct Draws(u64);

impl Draws {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn row(j: u64, weight: f64) -> RunRow {
    RunRow {
        id: EncounterId::new("traffic", j),
        outcome: Outcome::Completed,
        digest: Digest(j),
        weight,
        targets: 1,
        class: None,
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
        nominal_cpa_hull_m: Some(500.0),
        nominal_safety_radius_broken: Some(false),
        unavoidable: None,
        risk_s: None,
        reaction: Reaction::NoRisk,
        apparent: Reaction::NoRisk,
        first_turn_rad: None,
        extra_distance_m: None,
        goal_reached: true,
        impact_mps: None,
        impulse_ns: None,
        energy_lost_j: None,
        planner_detail: None,
        events: PlannerEvents::default(),
        checks: vec![CheckCell { status: Status::NotApplicable, margin: None }; Check::COUNT],
        judges_disagree: None,
    }
}

/// An encounter of a made-up traffic. One in ten passes near; near ones are drawn five times as
/// often, and speeds spread every weight by a half.
fn encounter(draws: &mut Draws, j: u64) -> RunRow {
    let near = draws.uniform() < 0.5;
    let spread = 0.5 + draws.uniform();
    let weight = spread * if near { 0.2 } else { 1.8 };
    // faster encounters, which weigh more, break the radius more often
    let chance = if near { 0.2 * spread } else { 0.004 };
    let without = if near { 0.8 } else { 0.002 };
    let mut row = row(j, weight);
    row.safety_radius_broken = draws.uniform() < chance;
    row.nominal_safety_radius_broken = Some(draws.uniform() < without);
    if near {
        let status = if draws.uniform() < 0.3 * spread { Status::Fail } else { Status::Pass };
        row.checks[Check::Turn as usize].status = status;
    }
    row
}

const WEIGHT_MAX: f64 = 1.8 * 1.5;
/// The mean of spread^2, for spread even in [0.5, 1.5].
const SPREAD_SQUARE: f64 = 1.0 + 1.0 / 12.0;
/// Rate of broken radii, of broken radii without avoiding, and of failures where the check applies.
const BROKEN: f64 = 0.1 * 0.2 * SPREAD_SQUARE + 0.9 * 0.004;
const NOMINAL: f64 = 0.1 * 0.8 + 0.9 * 0.002;
const FAILED: f64 = 0.3 * SPREAD_SQUARE;

fn traffic(seed: u64, n: u64) -> Tally {
    let mut draws = Draws(seed);
    let mut tally = Tally::new();
    (0..n).for_each(|j| tally.add(&encounter(&mut draws, j)));
    tally
}

#[test]
fn weighted_rates_are_those_of_the_population() {
    let tally = traffic(1, 100_000);
    let weighted = WeightedSummary::new(&tally, WEIGHT_MAX);
    let drawn = tally.safety_radius_broken as f64 / tally.n as f64;
    assert!(drawn > 3.0 * BROKEN, "the draws must not look like the population: {drawn}");
    let rate = weighted.safety_radius.rate.unwrap();
    assert!((rate / BROKEN - 1.0).abs() < 0.03, "{rate} {BROKEN}");
    let [low, high] = weighted.safety_radius.approximate_95.unwrap();
    assert!(low < BROKEN && BROKEN < high && high - low < 0.1 * BROKEN, "{low} {high}");
    let ratio = weighted.safety_radius_ratio.ratio.unwrap();
    assert!((ratio / (BROKEN / NOMINAL) - 1.0).abs() < 0.03, "{ratio}");
    let failed = weighted.checks[&Check::Turn].ratio.unwrap();
    assert!((failed / FAILED - 1.0).abs() < 0.03, "{failed}");
    assert!(!weighted.checks.contains_key(&Check::LastMinute), "it never applied");
    // no collision: nothing but a bound
    let none = weighted.collision;
    assert_eq!((none.rate, none.approximate_95), (None, None));
    assert!(none.lower_95 <= 0.0 && none.upper_95 < 1e-3 && none.upper_95 > 0.0, "{none:?}");
}

/// Each side may miss in 2.5 % of the data sets; 250 of them, and a miss more often than 4 standard
/// errors above that would be a wrong bound.
#[test]
fn the_bounds_hold_in_small_samples() {
    let sets = 250;
    let mut missed = [0_u32; 6];
    for set in 0..sets {
        let weighted = WeightedSummary::new(&traffic(1000 + set, 600), WEIGHT_MAX);
        let rate = weighted.safety_radius;
        let ratio = weighted.safety_radius_ratio;
        let check = weighted.checks[&Check::Turn];
        let misses = [
            rate.lower_95 > BROKEN,
            rate.upper_95 < BROKEN,
            ratio.lower_95 > BROKEN / NOMINAL,
            ratio.upper_95.unwrap() < BROKEN / NOMINAL,
            check.lower_95 > FAILED,
            check.upper_95.unwrap() < FAILED,
        ];
        missed.iter_mut().zip(misses).for_each(|(sum, miss)| *sum += u32::from(miss));
    }
    let allowed = 0.025 * sets as f64 + 4.0 * (0.025 * 0.975 * sets as f64).sqrt();
    assert!(missed.iter().all(|&k| f64::from(k) < allowed), "{missed:?} over {allowed}");
}

/// Bins cost nothing on the safe side: a bound is never narrower than that of the weights
/// themselves, and hardly wider.
#[test]
fn bins_only_widen_the_bounds() {
    let (mut draws, n) = (Draws(5), 4000);
    let rows: Vec<RunRow> = (0..n).map(|j| encounter(&mut draws, j)).collect();
    let mut tally = Tally::new();
    rows.iter().for_each(|row| tally.add(row));
    let weighted = WeightedSummary::new(&tally, WEIGHT_MAX).safety_radius;
    let events = rows.iter().filter(|row| row.safety_radius_broken);
    let values: Vec<f64> = events.map(|row| row.weight / WEIGHT_MAX).collect();
    let bets = MeanBets::planned(0.01 / WEIGHT_MAX, 40.0 / (WEIGHT_MAX * WEIGHT_MAX)).unwrap();
    let exact = bets.interval(&values, n, 0.05).unwrap();
    let (lower, upper) = (WEIGHT_MAX * exact.lower, WEIGHT_MAX * exact.upper);
    assert!(weighted.lower_95 <= lower && upper <= weighted.upper_95, "{weighted:?} {exact:?}");
    assert!(weighted.lower_95 > 0.99 * lower && weighted.upper_95 < 1.01 * upper, "{weighted:?}");
}

/// The price of a bound that would hold for weights, where there are none.
#[test]
fn bounds_of_equal_weights_are_near_the_exact_ones() {
    for (k, n) in [(20, 2000), (100, 10_000), (500, 10_000)] {
        let mut tally = Tally::new();
        for j in 0..n {
            let mut row = row(j, 1.0);
            row.safety_radius_broken = j < k;
            tally.add(&row);
        }
        let bets = WeightedSummary::new(&tally, 1.0).safety_radius;
        let exact = clopper_pearson(k, n, 0.05).unwrap();
        assert!(bets.lower_95 < exact.lower && exact.upper < bets.upper_95, "{bets:?} {exact:?}");
        let rate = k as f64 / n as f64;
        let (wide, narrow) = (bets.upper_95 - rate, exact.upper - rate);
        assert!(wide < 1.6 * narrow, "{k} of {n}: {wide} {narrow}");
        let (wide, narrow) = (rate - bets.lower_95, rate - exact.lower);
        assert!(wide < 1.6 * narrow, "{k} of {n}, below: {wide} {narrow}");
    }
}

/// An unknown run counts as none in the lower bound and as an event in the upper one.
#[test]
fn unknown_runs_widen_the_bounds() {
    let bounds = |unknown: u64| {
        let mut tally = Tally::new();
        for j in 0..1000 {
            let mut row = row(j, if j % 2 == 0 { 0.5 } else { 1.5 });
            row.unknown = j < unknown;
            row.safety_radius_broken = (500..600).contains(&j);
            tally.add(&row);
        }
        WeightedSummary::new(&tally, 1.5).safety_radius
    };
    let (all, some) = (bounds(0), bounds(100));
    assert!(some.upper_95 > all.upper_95 + 0.08, "{all:?} {some:?}");
    assert_eq!(some.lower_95.to_bits(), all.lower_95.to_bits());
    assert_eq!(some.rate.map(f64::to_bits), all.rate.map(f64::to_bits));
}

/// Encounters that nobody could have avoided are left out of both lines of the second rate.
#[test]
fn unavoidable_ones_are_left_out_by_weight() {
    let mut tally = Tally::new();
    for j in 0..4000 {
        let mut row = row(j, if j % 2 == 0 { 0.4 } else { 1.6 });
        // of the heavy half, a quarter is unavoidable and fails; of all others one in ten fails
        row.unavoidable = Some(j % 8 == 1);
        row.safety_radius_broken = j % 8 == 1 || j % 10 == 3;
        tally.add(&row);
    }
    let without = WeightedSummary::new(&tally, 1.6).without_unavoidable.unwrap().safety_radius;
    // by enumeration over one cycle of the pattern
    let (mut events, mut runs) = (0.0, 0.0);
    for j in (0..40).filter(|j| j % 8 != 1) {
        let weight = if j % 2 == 0 { 0.4 } else { 1.6 };
        runs += weight;
        events += if j % 10 == 3 { weight } else { 0.0 };
    }
    let truth = events / runs;
    assert!((without.ratio.unwrap() / truth - 1.0).abs() < 0.002, "{without:?} {truth}");
    assert!(without.lower_95 < truth && truth < without.upper_95.unwrap());
}

#[test]
#[should_panic(expected = "a weight of")]
fn a_weight_above_the_declared_one_is_no_number() {
    WeightedSummary::new(&traffic(3, 200), 1.0);
}

/// Without weights the file says nothing of them, and with them it can be read again.
#[test]
fn only_weighted_campaigns_have_the_key() {
    let mut tallies = Tallies::new();
    let mut draws = Draws(9);
    (0..300).for_each(|j| tallies.add(&encounter(&mut draws, j)));
    let head = SummaryHead {
        campaign: "test".into(),
        planner: "p".into(),
        seed: Seed(7),
        root_digest: "ab".into(),
    };
    let plain = Summary::new(head.clone(), &tallies, ["traffic"]).to_json();
    assert!(!plain.contains("\"weighted\""));
    let weighted = Summary::new(head, &tallies, ["traffic"])
        .with_weights(&tallies, |name| (name == "traffic").then_some(WEIGHT_MAX));
    let again: Summary = serde_json::from_str(&weighted.to_json()).unwrap();
    assert_eq!(again, weighted);
    let stratum = StratumSummary::new("traffic", tallies.stratum("traffic").unwrap());
    let stratum = stratum.with_weights(tallies.stratum("traffic").unwrap(), WEIGHT_MAX);
    assert_eq!(stratum, again.strata[0]);
}
