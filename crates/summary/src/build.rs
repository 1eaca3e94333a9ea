//! From tallies to `summary.json`.

use crate::summary::SCHEMA;
use crate::{
    AvoidableRates, BoundedRate, CpaSummary, PairedCounts, PairedRates, PlannerClass, SecondJudge,
    StratumSummary, Summary, SummaryHead, Tallies, Tally, TimeSummary, Times, WeightedSummary,
};
use record::{Check, EncounterClass, Outcome, Status};
use std::collections::BTreeMap;

/// Of a two-sided 95 % interval.
const ALPHA: f64 = 0.05;

impl Summary {
    /// The summary of a campaign. `order` names the strata as the campaign lists them; one that
    /// has no tally yet is shown with n = 0, one that is not listed follows in order of name.
    pub fn new<'a>(
        head: SummaryHead,
        tallies: &Tallies,
        order: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let listed: Vec<&str> = order.into_iter().collect();
        let empty = Tally::new();
        let sum = |of: fn(&Tally) -> u64| tallies.iter().map(|(_, tally)| of(tally)).sum();
        let second_judge = SecondJudge {
            asked: sum(|tally| tally.second_judge_asked),
            disagree: sum(|tally| tally.judges_disagree),
            ids: Vec::new(),
        };
        let planner_class = planner_class(tallies);
        let mut strata: Vec<StratumSummary> = listed
            .iter()
            .map(|name| StratumSummary::new(name, tallies.stratum(name).unwrap_or(&empty)))
            .collect();
        strata.extend(
            tallies
                .iter()
                .filter(|(name, _)| !listed.contains(name))
                .map(|(name, tally)| StratumSummary::new(name, tally)),
        );
        Self {
            schema: SCHEMA,
            campaign: head.campaign,
            planner: head.planner,
            seed: head.seed,
            encounters: strata.iter().map(|stratum| stratum.n).sum(),
            root_digest: head.root_digest,
            ended_by_wall_clock: strata.iter().map(StratumSummary::ended_by_wall_clock).sum(),
            second_judge,
            planner_class,
            strata,
        }
    }
}

/// The failures under the judge's and under the planner's classes, over all strata.
fn planner_class(tallies: &Tallies) -> PlannerClass {
    let mut found = PlannerClass::default();
    let mut theirs = [0; Check::COUNT];
    let mut judges = [0; Check::COUNT];
    for (_, tally) in tallies.iter() {
        found.stated += tally.planner_class_stated;
        found.disagree += tally.class_disagreements;
        for check in Check::ALL {
            theirs[check as usize] += tally.fails_by_planner_class[check as usize];
            judges[check as usize] += tally.check(check, Status::Fail);
        }
    }
    let counts = Check::ALL.into_iter().zip(judges.into_iter().zip(theirs));
    let differ = counts.filter(|(_, (judge, planner))| judge != planner);
    found.fails = differ
        .map(|(check, (judge, planner))| (check.name().to_owned(), [judge, planner]))
        .collect();
    found
}

impl StratumSummary {
    /// Runs that a limit on the wall clock ended.
    fn ended_by_wall_clock(&self) -> u64 {
        let ended = self.outcomes.iter().filter(|(outcome, _)| outcome.is_wall_clock());
        ended.map(|(_, count)| count).sum()
    }

    /// The summary of one stratum, or of any other group of runs.
    pub fn new(name: &str, tally: &Tally) -> Self {
        let statuses = |check: Check| -> BTreeMap<Status, u64> {
            Status::ALL.into_iter().map(|status| (status, tally.check(check, status))).collect()
        };
        Self {
            name: name.to_owned(),
            n: tally.n,
            generated: tally.generated,
            rejected: tally.rejected,
            collision: BoundedRate::new(tally.collisions, tally.unknown_without_collision, tally.n),
            safety_radius: BoundedRate::new(
                tally.safety_radius_broken,
                tally.unknown_without_breach,
                tally.n,
            ),
            unknown: tally.unknown,
            turn_direction: statuses(Check::Turn),
            reaction_time_s: TimeSummary::new(&tally.reaction),
            apparent_manoeuvre_s: TimeSummary::new(&tally.apparent),
            min_cpa_m: CpaSummary {
                p01: tally.cpa_quantile_m(10),
                p05: tally.cpa_quantile_m(50),
                median: tally.cpa_quantile_m(500),
            },
            outcomes: Outcome::ALL.into_iter().map(|o| (o, tally.outcome(o))).collect(),
            classes: EncounterClass::ALL
                .into_iter()
                .map(|class| (class, tally.class(Some(class))))
                .collect(),
            checks: Check::ALL.into_iter().map(|check| (check, statuses(check))).collect(),
            collision_pairs: PairedRates::new(&tally.collision_pairs),
            safety_radius_pairs: PairedRates::new(&tally.safety_radius_pairs),
            unavoidable: (tally.avoidable + tally.unavoidable > 0).then_some(tally.unavoidable),
            without_unavoidable: AvoidableRates::new(tally),
            n_effective: (tally.weighted > 0).then(|| {
                let sum = tally.weight_sum.value();
                sum * sum / tally.weight_square_sum.value()
            }),
            weighted: None,
        }
    }

    /// With the rates of the population that the weights stand for: they have mean 1 and are at
    /// most `weight_max`.
    #[must_use]
    pub fn with_weights(mut self, tally: &Tally, weight_max: f64) -> Self {
        self.weighted = Some(WeightedSummary::new(tally, weight_max));
        self
    }
}

impl AvoidableRates {
    /// Of a tally; absent where no run was searched for an escape.
    pub fn new(tally: &Tally) -> Option<Self> {
        if tally.avoidable + tally.unavoidable == 0 {
            return None;
        }
        let (left_out, n) = (&tally.unavoidable_events, tally.n - tally.unavoidable);
        Some(Self {
            collision: BoundedRate::new(
                tally.collisions - left_out.collisions,
                tally.unknown_without_collision - left_out.unknown_without_collision,
                n,
            ),
            safety_radius: BoundedRate::new(
                tally.safety_radius_broken - left_out.breaches,
                tally.unknown_without_breach - left_out.unknown_without_breach,
                n,
            ),
        })
    }
}

impl BoundedRate {
    /// `k` events and `unknown` further runs in `n`. Without runs nothing is known: [0, 1].
    pub fn new(k: u64, unknown: u64, n: u64) -> Self {
        if n == 0 {
            return Self { k, n, rate: None, lower_95: 0.0, upper_95: 1.0 };
        }
        let counts = "a tally never counts more events than runs";
        Self {
            k,
            n,
            rate: Some(k as f64 / n as f64),
            lower_95: stats::clopper_pearson_lower(k, n, ALPHA / 2.0).expect(counts),
            upper_95: stats::clopper_pearson_upper(k + unknown, n, ALPHA / 2.0).expect(counts),
        }
    }
}

/// The rate of failures of a check among the runs to which it applied: inconclusive ones are
/// unknown. `of` gives the number of runs with a status.
pub fn check_rate(of: impl Fn(Status) -> u64) -> BoundedRate {
    let [pass, warn, fail, inconclusive] =
        [Status::Pass, Status::Warn, Status::Fail, Status::Inconclusive].map(of);
    BoundedRate::new(fail, inconclusive, pass + warn + fail + inconclusive)
}

impl TimeSummary {
    /// The summary of counted times.
    pub fn new(times: &Times) -> Self {
        let quantile = |permille| times.histogram.quantile_permille(permille).number();
        Self {
            n: times.n(),
            median: quantile(500),
            p95: quantile(950),
            max: times.histogram.largest().number(),
            censored: times.never + times.cut_short,
            early: times.early,
        }
    }
}

impl PairedRates {
    fn new(counts: &PairedCounts) -> Self {
        // Without a nominal event the ratio has no number, which is the only error there is.
        let seen = stats::exact_ratio(&counts.resolved(false), ALPHA).ok();
        let feared = stats::exact_ratio(&counts.resolved(true), ALPHA).ok();
        Self {
            nominal: counts.resolved(false).nominal(),
            removed: counts.removed,
            left: counts.left,
            caused: counts.caused,
            neither: counts.neither,
            unknown: counts.unknown_with_nominal + counts.unknown_only,
            without_nominal: counts.without_nominal,
            risk_ratio: seen.map(|ratio| ratio.value),
            lower_95: seen.map(|ratio| ratio.lower),
            upper_95: feared.map(|ratio| ratio.upper),
        }
    }
}
