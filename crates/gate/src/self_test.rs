//! The gate tests itself: what must not fail does not, and what must fail does.
//!
//! A planner against itself must agree bit for bit; two independent sets of encounters must give
//! uniform p-values; every mutant and negative control must FAIL within the cap, and one that ends
//! INCONCLUSIVE is a survivor. Source: statistics specification, section 5, items 6 and 7.

use crate::arm::ArmRow;
use crate::run::{Paired, PairedRun};
use crate::{Arm, Event};
use campaign::{Error, Plan};
use record::{EncounterId, Purpose, Seed, Streams};
use serde::{Deserialize, Serialize};
use stats::{CorpusResult, GatePlan, GateVerdict, Harmed, Observation};

/// What all parts of a self-test share.
pub struct SelfTest<'a> {
    /// What is declared; the cap is that of one comparison.
    pub gate: GatePlan,
    /// What is counted.
    pub events: Vec<Event>,
    /// The distance below which a run is near, metres.
    pub near_m: f64,
    /// Hears a line for everything that is found.
    pub tell: &'a dyn Fn(&str),
}

impl std::fmt::Debug for SelfTest<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SelfTest").field("gate", &self.gate).finish_non_exhaustive()
    }
}

/// A planner against itself.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Sameness {
    /// Pairs.
    pub pairs: u64,
    /// Pairs that differ in any bit.
    pub different: u64,
    /// Breaks and fixes of all metrics, undetermined ones left out.
    pub discordant: u64,
    /// The verdict, which must not be FAIL.
    pub verdict: GateVerdict,
}

impl Sameness {
    /// Whether the gate behaved.
    pub fn holds(&self) -> bool {
        self.different == 0 && self.discordant == 0 && self.verdict != GateVerdict::Fail
    }
}

/// A planner that must not pass.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Killing {
    /// The planner.
    pub candidate: String,
    /// What the gate said.
    pub verdict: GateVerdict,
    /// Pairs until then.
    pub pairs: u64,
    /// Pairs in which its run differs in any bit from the baseline's.
    pub different: u64,
    /// The metrics that were found worse.
    pub worse: Vec<String>,
}

impl Killing {
    /// Whether the gate caught it.
    pub fn killed(&self) -> bool {
        self.verdict == GateVerdict::Fail
    }

    /// One line for a human reader.
    pub fn sentence(&self) -> String {
        if self.killed() {
            let worse = if self.worse.is_empty() { "corpus".into() } else { self.worse.join(", ") };
            format!("{:34} FAIL after {:>7} pairs ({worse})", self.candidate, self.pairs)
        } else {
            let verdict = crate::text::word(self.verdict);
            format!(
                "{:34} SURVIVED: {verdict} after {} pairs, {} runs differ",
                self.candidate, self.pairs, self.different
            )
        }
    }
}

/// Randomised p-values of a planner against itself on independent encounters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Uniformity {
    /// Data sets.
    pub sets: usize,
    /// Encounters in each.
    pub encounters: u64,
    /// Largest distance between the p-values' distribution and the uniform one.
    pub distance: f64,
    /// What it must stay below (Kolmogorov-Smirnov at 1e-3).
    pub limit: f64,
}

impl Uniformity {
    /// Whether the p-values pass.
    pub fn holds(&self) -> bool {
        self.distance < self.limit
    }
}

impl SelfTest<'_> {
    /// Runs two planners against each other.
    pub fn compare(
        &self,
        plan: &Plan,
        baseline: &mut dyn Arm,
        candidate: &mut dyn Arm,
    ) -> Result<Paired, Error> {
        PairedRun {
            gate: self.gate.clone(),
            plan,
            events: &self.events,
            near_m: self.near_m,
            corpus: CorpusResult::default(),
            baseline,
            candidate,
            ratchets: Vec::new(),
            progress: &|_| {},
        }
        .run()
    }

    /// A against A: not one bit may differ.
    pub fn same(&self, plan: &Plan, a: &mut dyn Arm, b: &mut dyn Arm) -> Result<Sameness, Error> {
        let paired = self.compare(plan, a, b)?;
        let metrics = paired.result.metrics.iter();
        // what is undetermined in both is a break in one count and a fix in the other, by rule
        let discordant = metrics
            .map(|m| {
                let found = m.counts_pass.n10 + m.counts_fail.n01;
                found.saturating_sub(2 * m.undetermined)
            })
            .sum();
        Ok(Sameness {
            pairs: paired.result.pairs,
            different: paired.different,
            discordant,
            verdict: paired.result.verdict,
        })
    }

    /// A planner that must not pass.
    pub fn kill(
        &self,
        plan: &Plan,
        name: &str,
        baseline: &mut dyn Arm,
        candidate: &mut dyn Arm,
    ) -> Result<Killing, Error> {
        let paired = self.compare(plan, baseline, candidate)?;
        let worse = paired.result.metrics.iter().filter(|metric| metric.harmed.is_some());
        let mut worse: Vec<String> = worse
            .map(|metric| match metric.harmed {
                Some(Harmed::Joint) => format!("{} (joint)", metric.name),
                _ => metric.name.clone(),
            })
            .collect();
        let violated = paired.result.absolutes.iter();
        worse.extend(
            violated
                .filter(|absolute| absolute.verdict == stats::LayerVerdict::Fail)
                .map(|absolute| format!("violated: {}", absolute.name)),
        );
        let killing = Killing {
            candidate: name.to_owned(),
            verdict: paired.result.verdict,
            pairs: paired.result.pairs,
            different: paired.different,
            worse,
        };
        (self.tell)(&killing.sentence());
        Ok(killing)
    }

    /// A on one set of encounters against A on another: `event` gives one randomised p-value for
    /// each of `sets` blocks of `encounters`.
    pub fn uniform(
        &self,
        event: Event,
        (sets, encounters): (usize, u64),
        a: &mut dyn Arm,
        other: &mut dyn Arm,
    ) -> Result<Uniformity, Error> {
        let mut p_values = Vec::with_capacity(sets);
        for set in 0..sets as u64 {
            let ids: Vec<u64> = (set * encounters..(set + 1) * encounters).collect();
            let (first, second) = (a.rows(&ids)?, other.rows(&ids)?);
            let had = |row: &ArmRow| event.of(row, self.near_m) == Observation::Event;
            let pairs = || first.iter().zip(&second);
            let n10 = pairs().filter(|(x, y)| had(x) && !had(y)).count() as u64;
            let n01 = pairs().filter(|(x, y)| !had(x) && had(y)).count() as u64;
            let id = EncounterId::new("gate self-test", set);
            let u = Streams::new(Seed(1), &id).stream(Purpose::Geometry, 0).uniform();
            let p = stats::mcnemar_randomised(n10, n01, u);
            p_values.push(p.map_err(|e| Error::Fault(e.to_string()))?);
        }
        Ok(Uniformity { sets, encounters, distance: ks(&mut p_values), limit: ks_limit(sets) })
    }
}

/// Largest distance between the distribution of the values and the uniform one.
fn ks(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let at = |(i, &p): (usize, &f64)| (p - i as f64 / n).max((i + 1) as f64 / n - p);
    values.iter().enumerate().map(at).fold(0.0, f64::max)
}

/// Critical distance at 1e-3 for n values: sqrt(ln(2/1e-3)/2) = 1.9495, over Stephens' (1970)
/// sqrt(n) + 0.12 + 0.11/sqrt(n).
fn ks_limit(n: usize) -> f64 {
    let root = (n as f64).sqrt();
    1.9495 / (root + 0.12 + 0.11 / root)
}

/// The share of planners that were caught.
pub fn kill_rate(killings: &[Killing]) -> (usize, usize) {
    (killings.iter().filter(|killing| killing.killed()).count(), killings.len())
}

/// The plans of one planner on the fresh set and on another, independent one.
pub fn independent(plan: &Plan) -> Plan {
    let mut other = plan.clone();
    other.seed = Seed(plan.seed.0 ^ 0x5eed_0000_0000_0001);
    other
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known answers: the distance of an even grid is half a step, of a constant nearly 1.
    #[test]
    fn the_distance_from_uniform_is_right_on_known_samples() {
        let mut even: Vec<f64> = (0..100).map(|i| (f64::from(i) + 0.5) / 100.0).collect();
        assert!((ks(&mut even) - 0.005).abs() < 1e-12);
        assert!((ks(&mut vec![0.01; 50]) - 0.99).abs() < 1e-12);
        // Smirnov's table: 0.19 for n = 100 at 1e-3 (1.95 / sqrt(n) asymptotically)
        assert!((ks_limit(100) - 0.192).abs() < 1e-3);
    }
}
