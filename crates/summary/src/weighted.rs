//! Rates of the population that weighted encounters stand for, with bounds that hold for weights.
//!
//! The weights have mean 1 and are at most `weight_max`, which is known before the run, so
//! X_i = w_i y_i / weight_max lies in [0, 1] and its mean is the rate over `weight_max`: betting
//! bounds of such a mean are claims (statistics specification, sections 2, 3 and 4.4). Weights are
//! kept in bins: a rate takes their middles, a bound the end that cannot make it too narrow.

use crate::by_weight::{ByWeight, WeightBin, WeightCounts};
use crate::{PairedCounts, Tally};
use record::{Check, Status};
use serde::{Deserialize, Serialize};
use stats::{ImportanceFitness, MeanBets, RiskCounts, RiskEvent, WeightedCount};
use std::collections::BTreeMap;

/// Each side of a two-sided 95 % interval.
const ALPHA_EACH: f64 = 0.025;
/// What the bets are made for, declared here and so before any run: events about as often as this,
/// and at least so many of them. They hold at every rate and are sharpest near this one.
const PLANNED_RATE: f64 = 0.01;
const PLANNED_EVENTS_MIN: f64 = 10.0;

/// What a stratum says of the population that its weights stand for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedSummary {
    /// Largest weight that can be drawn; it scales every bound.
    pub weight_max: f64,
    /// Own ship hits a target.
    pub collision: WeightedRate,
    /// The safety radius is broken.
    pub safety_radius: WeightedRate,
    /// Collisions with avoiding over collisions without, of the runs that have a nominal track.
    pub collision_ratio: WeightedRatio,
    /// The same for breaches of the safety radius.
    pub safety_radius_ratio: WeightedRatio,
    /// Failures of each check among the encounters to which it applies; checks that never applied
    /// are left out.
    pub checks: BTreeMap<Check, WeightedRatio>,
    /// The headline rates among the encounters that some manoeuvre of own ship could have cleared;
    /// absent where none was searched.
    pub without_unavoidable: Option<WeightedAvoidable>,
}

/// A weighted rate, sum w y / n.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedRate {
    /// The rate; null where it rests on too little: fewer than 50 effective events, or one that is
    /// over 5 % of the sum. The bounds hold all the same.
    pub rate: Option<f64>,
    /// (sum w y)^2 / sum (w y)^2: what the events are worth.
    pub events_effective: f64,
    /// The largest w y over their sum; 1 without events.
    pub share_max: f64,
    /// Fay and Feuer's two-sided 95 % interval: approximate, for display, no claim. Null with
    /// `rate`.
    pub approximate_95: Option<[f64; 2]>,
    /// Lower betting bound, a claim: unknown runs count as none.
    pub lower_95: f64,
    /// Upper betting bound, a claim: unknown runs count as events.
    pub upper_95: f64,
}

impl WeightedRate {
    /// Of no runs.
    const UNKNOWN: Self = Self {
        rate: None,
        events_effective: 0.0,
        share_max: 1.0,
        approximate_95: None,
        lower_95: 0.0,
        upper_95: 1.0,
    };
}

/// A ratio of two weighted sums, with two-sided 95 % betting bounds, which are claims.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedRatio {
    /// The ratio; null where its events are too few, as for [`WeightedRate::rate`].
    pub ratio: Option<f64>,
    /// Lower bound: unknown runs count as no event.
    pub lower_95: f64,
    /// Upper bound: unknown runs count as events; null where nothing bounds it.
    pub upper_95: Option<f64>,
}

/// The headline rates of the encounters that are not unavoidable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedAvoidable {
    /// Own ship hits a target.
    pub collision: WeightedRatio,
    /// The safety radius is broken.
    pub safety_radius: WeightedRatio,
}

impl WeightedSummary {
    /// Of a tally whose weights have mean 1 and are at most `weight_max`.
    ///
    /// # Panics
    /// A weight is above `weight_max`: the bounds would not hold.
    pub fn new(tally: &Tally, weight_max: f64) -> Self {
        let weighed = Weighed { of: &tally.by_weight, n: tally.n, weight_max };
        let checks = Check::ALL.into_iter().filter_map(|check| {
            let applied =
                |status| status != Status::NotApplicable && status != Status::NotEvaluated;
            let tested = Status::ALL.into_iter().any(|s| applied(s) && tally.check(check, s) > 0);
            tested.then(|| (check, weighed.share(|c, worst| check_counts(c, check, worst))))
        });
        let pairs = |of: fn(&WeightCounts) -> &PairedCounts| {
            weighed.ratio(|counts, worst| of(counts).resolved(worst))
        };
        let searched = tally.avoidable + tally.unavoidable > 0;
        Self {
            weight_max,
            collision: weighed.rate(|c| (c.events.collisions, c.events.unknown_without_collision)),
            safety_radius: weighed.rate(|c| (c.events.breaches, c.events.unknown_without_breach)),
            collision_ratio: pairs(|counts| &counts.collision_pairs),
            safety_radius_ratio: pairs(|counts| &counts.safety_radius_pairs),
            checks: checks.collect(),
            without_unavoidable: searched.then(|| WeightedAvoidable {
                collision: weighed.share(|counts, worst| {
                    let (all, out) = (&counts.events, &counts.unavoidable_events);
                    let seen = all.collisions - out.collisions;
                    let unknown = all.unknown_without_collision - out.unknown_without_collision;
                    among(counts.n - counts.unavoidable, seen, unknown, worst)
                }),
                safety_radius: weighed.share(|counts, worst| {
                    let (all, out) = (&counts.events, &counts.unavoidable_events);
                    let seen = all.breaches - out.breaches;
                    let unknown = all.unknown_without_breach - out.unknown_without_breach;
                    among(counts.n - counts.unavoidable, seen, unknown, worst)
                }),
            }),
        }
    }
}

/// Events among `n` runs, as the cells of a ratio whose lower line is those runs.
fn among(n: u64, seen: u64, unknown: u64, unknown_is_event: bool) -> RiskCounts {
    let events = if unknown_is_event { seen + unknown } else { seen };
    RiskCounts { unresolved: events, removed: n - events, ..RiskCounts::default() }
}

fn check_counts(counts: &WeightCounts, check: Check, unknown_is_event: bool) -> RiskCounts {
    let [pass, warn, fail, open] = [Status::Pass, Status::Warn, Status::Fail, Status::Inconclusive]
        .map(|status| counts.check(check, status));
    among(pass + warn + fail + open, fail, open, unknown_is_event)
}

/// Runs by weight, and what bounds need to know of the weights.
struct Weighed<'a> {
    of: &'a ByWeight,
    n: u64,
    weight_max: f64,
}

/// Which weight of a bin.
type Place = fn(WeightBin) -> f64;

impl Weighed<'_> {
    /// Each bin's number of events, with the weight that is asked for, never above the largest.
    fn events(&self, place: Place, of: impl Fn(&WeightCounts) -> u64) -> Vec<WeightedCount> {
        let bins = self.of.iter().map(|(bin, counts)| (bin, of(counts)));
        let bins = bins.filter(|(_, count)| *count > 0);
        bins.map(|(bin, count)| WeightedCount { weight: self.weight(place, bin), count }).collect()
    }

    fn weight(&self, place: Place, bin: WeightBin) -> f64 {
        // the largest weight may be drawn, and rounding may put it a last digit above
        let allowed = self.weight_max * (1.0 + 1e-12);
        assert!(bin.low() <= allowed, "a weight of {} or more over {allowed}", bin.low());
        place(bin).min(self.weight_max)
    }

    /// `of` gives the runs in which the event was seen, and those in which it is unknown.
    fn rate(&self, of: impl Fn(&WeightCounts) -> (u64, u64)) -> WeightedRate {
        const VALID: &str = "weights lie in (0, weight_max], and events are not above runs";
        if self.n == 0 {
            return WeightedRate::UNKNOWN;
        }
        let seen = |counts: &WeightCounts| of(counts).0;
        let feared = |counts: &WeightCounts| of(counts).0 + of(counts).1;
        let middles = self.events(WeightBin::middle, seen);
        // one run has no standard error, which is not asked for
        let fitness = ImportanceFitness::of_counts(&middles, self.n.max(2)).expect(VALID);
        let bets = self.bets();
        let scaled = |mut events: Vec<WeightedCount>| {
            events.iter_mut().for_each(|event| event.weight /= self.weight_max);
            events
        };
        let low = scaled(self.events(WeightBin::low, seen));
        let high = scaled(self.events(WeightBin::high, feared));
        let lower = bets.lower(&low, self.n, ALPHA_EACH).expect(VALID);
        let upper = bets.upper(&high, self.n, ALPHA_EACH).expect(VALID);
        let enough = fitness.is_publishable();
        WeightedRate {
            rate: enough.then_some(fitness.rate),
            events_effective: fitness.events_effective,
            share_max: fitness.share_max,
            approximate_95: enough.then(|| {
                let feared = self.events(WeightBin::middle, feared);
                [self.fay_feuer(middles).0, self.fay_feuer(feared).1.min(1.0)]
            }),
            lower_95: self.weight_max * lower,
            upper_95: (self.weight_max * upper).min(1.0),
        }
    }

    fn bets(&self) -> MeanBets {
        let events = (self.n as f64 * PLANNED_RATE).max(PLANNED_EVENTS_MIN);
        // an event is worth about 1 of at most weight_max, so a stake may be that much larger
        let planned = MeanBets::planned(
            PLANNED_RATE / self.weight_max.max(1.0),
            events / (self.weight_max * self.weight_max),
        );
        planned.expect("a planned rate below 1 and some events")
    }

    fn fay_feuer(&self, mut events: Vec<WeightedCount>) -> (f64, f64) {
        let n = self.n as f64;
        events.iter_mut().for_each(|event| event.weight /= n);
        let interval = stats::fay_feuer(&events, self.weight_max / n, self.n, 2.0 * ALPHA_EACH);
        let interval = interval.expect("weights lie in (0, weight_max]");
        (interval.lower, interval.upper)
    }

    /// A ratio of two weighted sums; `of` gives the cells of a bin, unknown runs counted as events
    /// or as none.
    fn ratio(&self, of: impl Fn(&WeightCounts, bool) -> RiskCounts) -> WeightedRatio {
        let cells = |worst: bool, either: Place, induced: Place, removed: Place| {
            let mut events = Vec::new();
            for (bin, counts) in self.of.iter() {
                let cells = of(counts, worst);
                for (count, planner, nominal, place) in [
                    (cells.unresolved, true, true, either),
                    (cells.induced, true, false, induced),
                    (cells.removed, false, true, removed),
                ] {
                    let weight = self.weight(place, bin);
                    events.push(RiskEvent { weight, planner, nominal, count });
                }
            }
            events.retain(|event| event.count > 0);
            events
        };
        let sides: [Place; 2] = [WeightBin::low, WeightBin::high];
        let [low, high] = sides;
        // w (y - R z) of an event on both tracks changes its sign at R = 1, where it is nothing:
        // the worse of both ends holds on either side
        let lower = sides.map(|either| {
            let events = cells(false, either, low, high);
            stats::betting_ratio_lower(&events, self.weight_max, ALPHA_EACH)
                .expect("weights lie in (0, weight_max]")
        });
        let upper = sides.map(|either| {
            let events = cells(true, either, high, low);
            // without enough events below the line there is no bound, which is the only error
            stats::betting_ratio_upper(&events, self.weight_max, ALPHA_EACH).ok()
        });
        let middles = cells(false, WeightBin::middle, WeightBin::middle, WeightBin::middle);
        WeightedRatio {
            ratio: self.plain_ratio(&middles),
            lower_95: lower[0].min(lower[1]),
            upper_95: upper[0].zip(upper[1]).map(|(a, b)| a.max(b)),
        }
    }

    /// The ratio, where enough events stand above the line.
    fn plain_ratio(&self, events: &[RiskEvent]) -> Option<f64> {
        let side = |of: fn(&RiskEvent) -> bool| -> Vec<WeightedCount> {
            let chosen = events.iter().filter(|event| of(event));
            chosen.map(|e| WeightedCount { weight: e.weight, count: e.count }).collect()
        };
        let fitness = |side: &[WeightedCount]| ImportanceFitness::of_counts(side, self.n).ok();
        let above = fitness(&side(|event| event.planner)).filter(ImportanceFitness::is_publishable);
        let below = fitness(&side(|event| event.nominal)).filter(|below| below.rate > 0.0);
        above.zip(below).map(|(above, below)| above.rate / below.rate)
    }

    /// A ratio of a part to the whole: at most 1.
    fn share(&self, of: impl Fn(&WeightCounts, bool) -> RiskCounts) -> WeightedRatio {
        let mut share = self.ratio(of);
        share.upper_95 = Some(share.upper_95.unwrap_or(1.0).min(1.0));
        share
    }
}
