//! How often does the gate block a change that is no worse, and pass one that is as bad as the
//! margin?
//!
//! Two planners run on disjoint encounters of `campaigns/gate.toml`, on the real engine. A coin
//! keyed by the place of each encounter decides who is called the candidate, so p10 = p01 by
//! construction, whatever the planners do: every FAIL is a false one.
//!
//! For the false PASS the difference must be the margin d to the last bit, which no planner has by
//! itself. So a second coin turns a share d of the pairs into a break, whatever was run, and all
//! other pairs stay as they are: D = d * 1 + (1 - d) * 0 = d exactly, with the nuisance rates of
//! real runs. Only the metric `near` is asked, because every further metric makes a PASS rarer.
//! Both studies look after every cycle, and both use the same rows.
//!
//! `cargo run --release -p gate --example false_alarms -- GATES PAIRS_EACH MUTANT MARGIN`

use campaign::plan::Build;
use campaign::worker::Shop;
use gate::arm::{Arm, ArmRow, InProcess, beats, place};
use gate::spec::{GateSpec, PlannerSpec};
use gate::{Event, mutants};
use planner_api::Registry;
use record::{EncounterId, Purpose, Seed, Streams};
use stats::{CorpusResult, Gate, GatePlan, GateVerdict, Margin, Observation, PairRow};
use std::error::Error;

const GATE: &str = include_str!("../../../campaigns/gate.toml");
const RULES: &str = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");
/// Seed of encounters and coins.
const SEED: u64 = 20_261_122;

/// PASS, FAIL, INCONCLUSIVE, and the pairs of gates that were decided before the cap.
#[derive(Default)]
struct Verdicts {
    counts: [u64; 3],
    pairs: Vec<u64>,
}

impl Verdicts {
    fn add(&mut self, gate: &Gate) {
        let verdict = gate.result().verdict;
        self.counts[verdict as usize] += 1;
        if verdict != GateVerdict::Inconclusive {
            self.pairs.push(gate.result().pairs);
        }
    }

    fn told(&mut self) -> String {
        self.pairs.sort_unstable();
        let [pass, fail, inconclusive] = self.counts;
        let median = self.pairs.get(self.pairs.len() / 2);
        let median = median.map_or(String::new(), |pairs| format!("; decided after {pairs} pairs"));
        format!("{fail} FAIL, {pass} PASS, {inconclusive} INCONCLUSIVE{median} (median)")
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let gates: u64 = arguments.next().unwrap_or("100".into()).parse()?;
    let pairs: u64 = arguments.next().unwrap_or("700".into()).parse()?;
    let name = arguments.next().unwrap_or("mutant:late-5s:zhuang".into());
    let margin: f64 = arguments.next().unwrap_or("0.02".into()).parse()?;
    let registry = mutants::with_mutant(planners::registry(), &name)?;
    let wide = spec(gates * pairs, 0.5)?;
    let (a, b) = (plan(&wide, &registry, "zhuang")?, plan(&wide, &registry, &name)?);
    let (shop_a, shop_b) = (Shop::new(&a, &registry)?, Shop::new(&b, &registry)?);
    let threads = std::thread::available_parallelism()?.get();
    let (beats_a, beats_b) = (beats(threads), beats(threads));
    let mut arm_a = InProcess::new(&shop_a, &a, &beats_a)?;
    let mut arm_b = InProcess::new(&shop_b, &b, &beats_b)?;
    // all metrics at a margin that takes most of the cap to show: most gates fail or reach the cap
    let blocking = spec(pairs, 9.0 / pairs as f64)?.gate_plan(&a.strata, 1, &[])?;
    let passing = only_near(spec(pairs, margin)?.gate_plan(&a.strata, 1, &[])?);
    let study = Study { events: wide.events(), near_m: wide.near_m(), margin };
    let (mut equal, mut at_margin, mut neutral) =
        (Verdicts::default(), Verdicts::default(), Verdicts::default());
    let (mut differ, mut near) = (0u64, [0u64; 2]);
    for gate in 0..gates {
        let from = gate * blocking.cap_pairs();
        let ids: Vec<u64> = (from..from + blocking.cap_pairs()).collect();
        let rows = (arm_a.rows(&ids)?, arm_b.rows(&ids)?);
        let pairs: Vec<Pair<'_>> =
            rows.0.iter().zip(&rows.1).map(|(x, y)| study.pair(x, y)).collect();
        differ += pairs.iter().filter(|pair| pair.mine.digest != pair.was.digest).count() as u64;
        for pair in &pairs {
            let had = |row| Event::Near.of(row, study.near_m) == Observation::Event;
            near[0] += u64::from(had(pair.mine) && !had(pair.was));
            near[1] += u64::from(!had(pair.mine) && had(pair.was));
        }
        equal.add(&study.gate(&blocking, &pairs, |pair, id| study.whole(pair, id))?);
        at_margin.add(&study.gate(&passing, &pairs, |pair, id| study.near(pair, id, true))?);
        neutral.add(&study.gate(&passing, &pairs, |pair, id| study.near(pair, id, false))?);
    }
    let each = blocking.cap_pairs();
    println!("{gates} gates of at most {each} pairs, `zhuang` and `{name}` by a coin");
    println!("  runs differ in {differ} of {} pairs", gates * each);
    println!("  `near`: {} breaks, {} fixes", near[0], near[1]);
    println!("  D = 0, {} metrics, a_F = .01: {}", study.events.len(), equal.told());
    println!("  D = d = {margin}, `near` alone, a_P = .05: {}", at_margin.told());
    println!("  D = 0, d = {margin}, `near` alone, a_P = .05: {}", neutral.told());
    Ok(())
}

/// Two runs of one encounter, in the roles that the coin gave them.
struct Pair<'r> {
    mine: &'r ArmRow,
    was: &'r ArmRow,
    stratum: usize,
    /// Uniform on [0, 1): below the margin, the pair is called a break.
    forced: f64,
}

struct Study {
    events: Vec<Event>,
    near_m: f64,
    margin: f64,
}

impl Study {
    fn pair<'r>(&self, a: &'r ArmRow, b: &'r ArmRow) -> Pair<'r> {
        let streams = Streams::new(Seed(SEED), &EncounterId::new("false alarms", a.id));
        let mut coin = streams.stream(Purpose::Geometry, 0);
        let (swap, forced) = (coin.uniform() < 0.5, coin.uniform());
        let (mine, was) = if swap { (b, a) } else { (a, b) };
        Pair { mine, was, stratum: (a.id % STRATA) as usize, forced }
    }

    fn gate(
        &self,
        plan: &GatePlan,
        pairs: &[Pair<'_>],
        row: impl Fn(&Pair<'_>, u64) -> PairRow,
    ) -> Result<Gate, Box<dyn Error>> {
        let mut gate = Gate::new(plan.clone(), CorpusResult::default())?;
        for (id, pair) in (0..).zip(pairs) {
            if gate.take(&[row(pair, id)])?.is_some() {
                break;
            }
        }
        Ok(gate)
    }

    /// All metrics.
    fn whole(&self, pair: &Pair<'_>, id: u64) -> PairRow {
        let see = |row| self.events.iter().map(|event| event.of(row, self.near_m)).collect();
        let (candidate, baseline) = (see(pair.mine), see(pair.was));
        PairRow { id, stratum: pair.stratum, candidate, baseline, ratchets: Vec::new() }
    }

    /// `near` alone; undetermined is no event, so that D is what the coins make it.
    fn near(&self, pair: &Pair<'_>, id: u64, at_margin: bool) -> PairRow {
        let see = |row| match Event::Near.of(row, self.near_m) {
            Observation::Event => Observation::Event,
            _ => Observation::NoEvent,
        };
        let (candidate, baseline) = if at_margin && pair.forced < self.margin {
            (Observation::Event, Observation::NoEvent)
        } else {
            (see(pair.mine), see(pair.was))
        };
        PairRow {
            id,
            stratum: pair.stratum,
            candidate: vec![candidate],
            baseline: vec![baseline],
            ratchets: Vec::new(),
        }
    }
}

/// Strata of the campaign, which a test of this crate holds it to.
const STRATA: u64 = 7;

/// The campaign with one margin for every metric, and a look after every cycle.
fn spec(cap: u64, margin: f64) -> Result<GateSpec, Box<dyn Error>> {
    let mut spec = GateSpec::parse(GATE, "gate")?;
    spec.table.absolute.clear();
    spec.table.cap_pairs = cap;
    spec.table.look_every_pairs = 1;
    for metric in &mut spec.table.metric {
        metric.margin = Margin::Absolute { difference: margin };
        metric.discordance_plan = margin;
    }
    Ok(spec)
}

fn only_near(mut plan: GatePlan) -> GatePlan {
    plan.metrics.retain(|metric| metric.name == Event::Near.name());
    plan
}

fn plan(
    spec: &GateSpec,
    registry: &Registry,
    name: &str,
) -> Result<campaign::Plan, Box<dyn Error>> {
    let asked = PlannerSpec { name: name.into(), ..PlannerSpec::default() };
    let plan = spec.plan(&asked, SEED, registry, &|_| Ok(RULES.to_owned()), &unknown_build())?;
    assert_eq!(plan.strata.len() as u64, STRATA, "the campaign has other strata");
    assert_eq!(place(&plan, 1).0, 1);
    Ok(plan)
}

fn unknown_build() -> Build {
    let unknown = || "unknown".to_owned();
    Build {
        tool_version: unknown(),
        git_commit: unknown(),
        git_clean: false,
        engine: unknown(),
        planners: unknown(),
        cargo_lock_sha256: unknown(),
        rustc: unknown(),
    }
}
