//! Everything that is counted of the runs of one stratum.

use crate::{BearingMap, ByWeight, EventCounts, FixedSum, PairedCounts, Times};
use record::{Check, EncounterClass, Outcome, RunRow, Status};
use serde::{Deserialize, Serialize};
use stats::{Bins, Histogram, QuantileValue};

const OUTCOMES: usize = Outcome::ALL.len();
const CLASSES: usize = EncounterClass::ALL.len();
const STATUSES: usize = Status::ALL.len();
const EVENTS: usize = 6;

/// Integers only: the tallies of any partition of the rows merge to the tally of all of them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tally {
    /// Rows.
    pub n: u64,
    /// Draws of the generator, rejected ones included; not known from rows.
    pub generated: u64,
    /// Draws that it rejected.
    pub rejected: u64,
    /// Runs in which own ship hit a target.
    pub collisions: u64,
    /// Runs in which the safety radius was broken.
    pub safety_radius_broken: u64,
    /// Planner failures and runs cut before CPA.
    pub unknown: u64,
    /// Those of them that did not collide before.
    pub unknown_without_collision: u64,
    /// Those of them that had not broken the safety radius before.
    pub unknown_without_breach: u64,
    /// Runs with an ambiguous class.
    pub ambiguous: u64,
    /// Runs that the bench found avoidable, and not avoidable, by any manoeuvre of own ship.
    pub avoidable: u64,
    /// See `avoidable`.
    pub unavoidable: u64,
    /// Unavoidable ones that collided, or are unknown.
    pub unavoidable_failed: u64,
    /// Unavoidable ones that collided, that broke the safety radius, and the unknown ones of each.
    pub unavoidable_events: EventCounts,
    /// Runs in which the last waypoint was reached.
    pub goal_reached: u64,
    /// Runs that the second judge was asked about, and those in which it disagreed.
    pub second_judge_asked: u64,
    /// See `second_judge_asked`.
    pub judges_disagree: u64,
    /// Runs for which the planner states its class.
    pub planner_class_stated: u64,
    /// Those in which its class is not the judge's.
    pub class_disagreements: u64,
    /// Failures of each check where the planner's class counts, in the order of `Check::ALL`.
    pub fails_by_planner_class: Vec<u64>,
    /// Sum of the importance weights.
    pub weight_sum: FixedSum,
    /// Sum of their squares.
    pub weight_square_sum: FixedSum,
    /// Runs whose weight is not 1.
    pub weighted: u64,
    /// The runs by the size of their weight.
    pub by_weight: ByWeight,
    /// Smallest hull-to-hull distance of the runs in which it is known, metres.
    pub cpa_hull_m: Histogram,
    /// Runs that have targets and whose smallest distance is unknown.
    pub cpa_unknown: u64,
    /// First detectable alteration.
    pub reaction: Times,
    /// First readily apparent alteration.
    pub apparent: Times,
    /// Failures over relative bearing and speed ratio.
    pub map: BearingMap,
    /// Collisions without and with avoiding.
    pub collision_pairs: PairedCounts,
    /// Breaches of the safety radius without and with avoiding.
    pub safety_radius_pairs: PairedCounts,
    outcomes: [u64; OUTCOMES],
    /// One more than there are classes: the last is for runs without one.
    class_checks: Vec<ClassCounts>,
    events: [u64; EVENTS],
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct ClassCounts {
    n: u64,
    checks: Vec<[u64; STATUSES]>,
}

/// Distances beyond this are counted together, metres.
const CPA_END_M: u32 = 20_000;

impl Default for Tally {
    fn default() -> Self {
        let class = ClassCounts { n: 0, checks: vec![[0; STATUSES]; Check::COUNT] };
        Self {
            n: 0,
            generated: 0,
            rejected: 0,
            collisions: 0,
            safety_radius_broken: 0,
            unknown: 0,
            unknown_without_collision: 0,
            unknown_without_breach: 0,
            ambiguous: 0,
            avoidable: 0,
            unavoidable: 0,
            unavoidable_failed: 0,
            unavoidable_events: EventCounts::default(),
            goal_reached: 0,
            second_judge_asked: 0,
            judges_disagree: 0,
            planner_class_stated: 0,
            class_disagreements: 0,
            fails_by_planner_class: vec![0; Check::COUNT],
            weight_sum: FixedSum::default(),
            weight_square_sum: FixedSum::default(),
            weighted: 0,
            by_weight: ByWeight::default(),
            cpa_hull_m: Histogram::new(Bins::tenths_up_to(CPA_END_M)),
            cpa_unknown: 0,
            reaction: Times::default(),
            apparent: Times::default(),
            map: BearingMap::default(),
            collision_pairs: PairedCounts::default(),
            safety_radius_pairs: PairedCounts::default(),
            outcomes: [0; OUTCOMES],
            class_checks: vec![class; CLASSES + 1],
            events: [0; EVENTS],
        }
    }
}

impl Tally {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one run.
    pub fn add(&mut self, row: &RunRow) {
        let (collided, breach) = (row.collided(), row.safety_radius_broken);
        self.n += 1;
        self.collisions += u64::from(collided);
        self.safety_radius_broken += u64::from(breach);
        self.unknown += u64::from(row.unknown);
        self.unknown_without_collision += u64::from(row.unknown && !collided);
        self.unknown_without_breach += u64::from(row.unknown && !breach);
        self.ambiguous += u64::from(row.ambiguous);
        self.avoidable += u64::from(row.unavoidable == Some(false));
        self.unavoidable += u64::from(row.unavoidable == Some(true));
        self.unavoidable_failed +=
            u64::from(row.unavoidable == Some(true) && (collided || row.unknown));
        if row.unavoidable == Some(true) {
            self.unavoidable_events.add(row);
        }
        self.goal_reached += u64::from(row.goal_reached);
        self.second_judge_asked += u64::from(row.judges_disagree.is_some());
        self.judges_disagree += u64::from(row.judges_disagree == Some(true));
        self.add_planner_class(row);
        self.add_weight(row.weight);
        self.add_cpa(row);
        self.reaction.add(row.reaction);
        self.apparent.add(row.apparent);
        self.map.add(row);
        let nominal_collision = row.nominal_cpa_hull_m.map(|distance_m| distance_m <= 0.0);
        let known = |event: bool| (event || !row.unknown).then_some(event);
        let collision = (nominal_collision, known(collided));
        let safety_radius = (row.nominal_safety_radius_broken, known(breach));
        self.collision_pairs.add(collision.0, collision.1);
        self.safety_radius_pairs.add(safety_radius.0, safety_radius.1);
        self.by_weight.add(row, collision, safety_radius);
        self.outcomes[row.outcome as usize] += 1;
        self.add_checks(row);
        let e = &row.events;
        let counts = [
            e.inner_loop_cap,
            e.limited,
            e.inside_called_safe,
            e.class_changes,
            e.receding_flagged,
            e.passes,
        ];
        self.events.iter_mut().zip(counts).for_each(|(sum, count)| *sum += u64::from(count));
    }

    /// Adds draws of the generator.
    pub fn add_draws(&mut self, generated: u64, rejected: u64) {
        self.generated += generated;
        self.rejected += rejected;
    }

    /// Adds the runs of another part.
    pub fn merge(&mut self, other: &Self) {
        for (sum, add) in self.counts_mut().into_iter().zip(other.clone().counts_mut()) {
            *sum += *add;
        }
        self.weight_sum.merge(other.weight_sum);
        self.weight_square_sum.merge(other.weight_square_sum);
        self.cpa_hull_m
            .merge(&other.cpa_hull_m)
            .expect("all distance histograms have the same bins");
        self.reaction.merge(&other.reaction);
        self.apparent.merge(&other.apparent);
        self.map.merge(&other.map);
        self.collision_pairs.merge(&other.collision_pairs);
        self.safety_radius_pairs.merge(&other.safety_radius_pairs);
        self.by_weight.merge(&other.by_weight);
    }

    /// Runs that ended so.
    pub fn outcome(&self, outcome: Outcome) -> u64 {
        self.outcomes[outcome as usize]
    }

    /// Runs of this class, as the judge found it; `None`: risk never opened.
    pub fn class(&self, class: Option<EncounterClass>) -> u64 {
        self.class_checks[class_index(class)].n
    }

    /// Runs in which a check came to this status.
    pub fn check(&self, check: Check, status: Status) -> u64 {
        self.class_checks.iter().map(|class| class.checks[check as usize][status as usize]).sum()
    }

    /// The same for the runs of one class.
    pub fn check_in_class(
        &self,
        class: Option<EncounterClass>,
        check: Check,
        status: Status,
    ) -> u64 {
        self.class_checks[class_index(class)].checks[check as usize][status as usize]
    }

    /// What the planner counted of itself, summed, with the names of `PlannerEvents`.
    pub fn events(&self) -> [(&'static str, u64); EVENTS] {
        let names = [
            "inner_loop_cap",
            "limited",
            "inside_called_safe",
            "class_changes",
            "receding_flagged",
            "passes",
        ];
        std::array::from_fn(|i| (names[i], self.events[i]))
    }

    /// Quantile of the smallest hull-to-hull distance, metres. Runs in which it is unknown rank
    /// below every number, so a planner cannot gain by failing; there is no number among them.
    pub fn cpa_quantile_m(&self, permille: u32) -> Option<f64> {
        let n = u128::from(self.cpa_hull_m.n() + self.cpa_unknown);
        let rank = (n * u128::from(permille)).div_ceil(1000).max(1) as u64;
        let known = rank.checked_sub(self.cpa_unknown).filter(|&rank| rank > 0)?;
        match self.cpa_hull_m.at_rank(known) {
            QuantileValue::Bin(value) => Some(value),
            _ => None,
        }
    }

    fn add_weight(&mut self, weight: f64) {
        self.weight_sum.add(weight);
        self.weight_square_sum.add(weight * weight);
        self.weighted += u64::from(weight.to_bits() != 1f64.to_bits());
    }

    fn add_cpa(&mut self, row: &RunRow) {
        if row.targets == 0 {
            return;
        }
        match row.cpa_hull_m.filter(|distance_m| !row.unknown && !distance_m.is_nan()) {
            Some(distance_m) => {
                self.cpa_hull_m.add(distance_m.max(0.0)).expect("a distance is a number");
            }
            None => self.cpa_unknown += 1,
        }
    }

    fn add_planner_class(&mut self, row: &RunRow) {
        self.planner_class_stated += u64::from(row.class_by_planner.is_some());
        let theirs = row.fails_by_planner_class.as_deref();
        self.class_disagreements += u64::from(theirs.is_some());
        for (check, count) in Check::ALL.into_iter().zip(&mut self.fails_by_planner_class) {
            let fails = theirs.map_or(row.check(check).status == Status::Fail, |names| {
                names.split('+').any(|name| name == check.name())
            });
            *count += u64::from(fails);
        }
    }

    fn add_checks(&mut self, row: &RunRow) {
        let class = &mut self.class_checks[class_index(row.class)];
        class.n += 1;
        for check in Check::ALL {
            class.checks[check as usize][row.check(check).status as usize] += 1;
        }
    }

    /// Every plain count, in a fixed order, so that merging forgets none: the pattern names all
    /// fields and does not compile when one is added.
    fn counts_mut(&mut self) -> Vec<&mut u64> {
        let Self {
            n,
            generated,
            rejected,
            collisions,
            safety_radius_broken,
            unknown,
            unknown_without_collision,
            unknown_without_breach,
            ambiguous,
            avoidable,
            unavoidable,
            unavoidable_failed,
            unavoidable_events:
                EventCounts {
                    collisions: unavoidable_collisions,
                    breaches: unavoidable_breaches,
                    unknown_without_collision: unavoidable_unknown_without_collision,
                    unknown_without_breach: unavoidable_unknown_without_breach,
                },
            goal_reached,
            second_judge_asked,
            judges_disagree,
            planner_class_stated,
            class_disagreements,
            fails_by_planner_class,
            weight_sum: _,
            weight_square_sum: _,
            weighted,
            by_weight: _,
            cpa_hull_m: _,
            cpa_unknown,
            reaction: _,
            apparent: _,
            map: _,
            collision_pairs: _,
            safety_radius_pairs: _,
            outcomes,
            class_checks,
            events,
        } = self;
        let mut counts = vec![
            n,
            generated,
            rejected,
            collisions,
            safety_radius_broken,
            unknown,
            unknown_without_collision,
            unknown_without_breach,
            ambiguous,
            avoidable,
            unavoidable,
            unavoidable_failed,
            unavoidable_collisions,
            unavoidable_breaches,
            unavoidable_unknown_without_collision,
            unavoidable_unknown_without_breach,
            goal_reached,
            second_judge_asked,
            judges_disagree,
            planner_class_stated,
            class_disagreements,
            weighted,
            cpa_unknown,
        ];
        counts.extend(fails_by_planner_class);
        counts.extend(outcomes);
        counts.extend(events);
        for class in class_checks {
            counts.push(&mut class.n);
            counts.extend(class.checks.iter_mut().flatten());
        }
        counts
    }
}

fn class_index(class: Option<EncounterClass>) -> usize {
    class.map_or(CLASSES, |class| class as usize)
}
