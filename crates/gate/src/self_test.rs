//! The gate tests itself: what must not fail does not, and what must fail does.
//!
//! A planner against itself must agree bit for bit; two independent sets of encounters must give
//! uniform p-values; every mutant and negative control must FAIL within the cap, and one that ends
//! INCONCLUSIVE is a survivor. Source: statistics specification, section 5, items 6 and 7.

use crate::arm::ArmRow;
use crate::run::{Paired, PairedRun};
use crate::{Arm, Event, GateSpec};
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
    /// Whether somebody wants it to end.
    pub stop: &'a dyn Fn() -> bool,
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
    /// One line for a human reader.
    pub fn sentence(&self, baseline: &str) -> String {
        format!(
            "{baseline} against itself: {}, {} pairs, {} differ in a bit, {} breaks and fixes",
            crate::text::word(self.verdict),
            self.pairs,
            self.different,
            self.discordant
        )
    }

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
    /// One line for a human reader.
    pub fn sentence(&self) -> String {
        format!(
            "on independent encounters: {} p-values of {} pairs each, distance from uniform {:.3}, \
             limit {:.3}",
            self.sets, self.encounters, self.distance, self.limit
        )
    }

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
            stop: self.stop,
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

/// What is kept of a self-test.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// 1.
    pub schema: u32,
    /// Whether it was the small one.
    pub small: bool,
    /// The planner against which all others ran.
    pub baseline: String,
    /// Hash of the sources that decide a number.
    pub engine: String,
    /// Seed of the encounters.
    pub seed: u64,
    /// The largest number of pairs of each comparison.
    pub cap_pairs: u64,
    /// The planner against itself.
    pub same: Sameness,
    /// The planner against itself on other encounters.
    pub uniform: Uniformity,
    /// Planners that must fail.
    pub killings: Vec<Killing>,
}

impl Report {
    fn killed(&self) -> usize {
        self.killings.iter().filter(|killing| killing.killed()).count()
    }

    /// Whether the gate behaved throughout.
    pub fn holds(&self) -> bool {
        self.same.holds() && self.uniform.holds() && self.killed() == self.killings.len()
    }

    /// One line for a human reader.
    pub fn sentence(&self) -> String {
        let most = self.killings.iter().filter(|k| k.killed()).map(|k| k.pairs).max();
        format!(
            "{} of {} negative controls and mutants were caught, the slowest after {} pairs",
            self.killed(),
            self.killings.len(),
            most.unwrap_or(0)
        )
    }

    /// A page.
    pub fn markdown(&self) -> String {
        let mut lines = vec![
            format!("* {}", self.same.sentence(&self.baseline)),
            format!("* {}", self.uniform.sentence()),
            format!("* {} (cap {} pairs)", self.sentence(), self.cap_pairs),
            String::new(),
            "| planner | verdict | pairs | of them differ | worse in |".to_owned(),
            "|---|---|---|---|---|".to_owned(),
        ];
        lines.extend(self.killings.iter().map(|killing| {
            let worse = killing.worse.join(", ");
            let verdict = crate::text::word(killing.verdict);
            let Killing { candidate, pairs, different, .. } = killing;
            format!("| `{candidate}` | {verdict} | {pairs} | {different} | {worse} |")
        }));
        lines.join("\n") + "\n"
    }
}

/// Negative controls of the small self-test.
pub const SMALL_CONTROLS: [&str; 3] = ["hold-course", "always-port", "late"];
/// Faults of its mutants.
pub const SMALL_FAULTS: [&str; 2] = ["sign-flip", "short-sighted"];
/// Its margins are this much wider than the campaign's: a neutral change passes after a thousand
/// pairs instead of thirty thousand.
const SMALL_MARGIN_FACTOR: f64 = 30.0;

/// Makes a gate small enough for every push.
pub fn make_small(spec: &mut GateSpec) {
    spec.table.cap_pairs = 2800;
    spec.table.look_every_pairs = 70;
    spec.table.absolute.clear();
    for metric in &mut spec.table.metric {
        metric.margin = metric.margin.scaled(SMALL_MARGIN_FACTOR);
        metric.discordance_plan *= SMALL_MARGIN_FACTOR;
    }
}

/// The plan on another, independent set of encounters.
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
