//! How often does the gate block a change that is no worse?
//!
//! A' is the baseline where a coin keyed by the encounter's place shows 0 and a mutant where it
//! shows 1; B' is the opposite. Then p10 = p01 by construction, and the two differ as often as
//! baseline and mutant do. Gates run on disjoint encounters and look after every cycle.
//!
//! `cargo run --release -p gate --example false_alarms -- GATES PAIRS_EACH MUTANT`

use campaign::plan::Build;
use campaign::worker::Shop;
use gate::arm::{Arm, InProcess, beats, place};
use gate::mutants;
use gate::spec::{GateSpec, PlannerSpec};
use stats::{CorpusResult, Gate, GateVerdict, Observation, PairRow};
use std::error::Error;

const GATE: &str = include_str!("../../../campaigns/gate.toml");
const RULES: &str = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let gates: u64 = arguments.next().unwrap_or("100".into()).parse()?;
    let pairs: u64 = arguments.next().unwrap_or("140".into()).parse()?;
    let name = arguments.next().unwrap_or("mutant:sign-flip:zhuang".into());
    let mut spec = GateSpec::parse(GATE, "gate")?;
    spec.table.absolute.clear();
    spec.table.cap_pairs = pairs;
    spec.table.look_every_pairs = 1;
    for metric in &mut spec.table.metric {
        // a margin that nobody passes: every gate runs to its cap or fails
        metric.margin = stats::Margin::Absolute { difference: 0.9 / pairs as f64 * 10.0 };
    }
    let registry = mutants::with_mutant(planners::registry(), &name)?;
    let find = |_: &str| Ok(RULES.to_owned());
    let plan = |name: &str| {
        let asked = PlannerSpec { name: name.into(), ..PlannerSpec::default() };
        let mut wide = spec.clone();
        wide.table.cap_pairs = gates * pairs;
        wide.plan(&asked, 20_261_122, &registry, &find, &unknown_build())
    };
    let (a, b) = (plan("zhuang")?, plan(&name)?);
    let (shop_a, shop_b) = (Shop::new(&a, &registry)?, Shop::new(&b, &registry)?);
    let (beats_a, beats_b) = (beats(2), beats(2));
    let mut arm_a = InProcess::new(&shop_a, &a, &beats_a)?;
    let mut arm_b = InProcess::new(&shop_b, &b, &beats_b)?;
    let declared = spec.gate_plan(&a.strata, 1, &[])?;
    let (events, near_m) = (spec.events(), spec.near_m());
    let mut verdicts = [0u64; 3];
    for gate in 0..gates {
        let from = gate * declared.cap_pairs();
        let ids: Vec<u64> = (from..from + declared.cap_pairs()).collect();
        let (rows_a, rows_b) = (arm_a.rows(&ids)?, arm_b.rows(&ids)?);
        let mut rule = Gate::new(declared.clone(), CorpusResult::default())?;
        for (i, (row_a, row_b)) in rows_a.iter().zip(&rows_b).enumerate() {
            let see = |row| -> Vec<Observation> {
                events.iter().map(|event| event.of(row, near_m)).collect()
            };
            let swap = blake3::hash(&row_a.id.to_le_bytes()).as_bytes()[0] & 1 == 1;
            let (baseline, candidate) = if swap { (row_b, row_a) } else { (row_a, row_b) };
            let pair = PairRow {
                id: i as u64,
                stratum: place(&a, row_a.id).0 as usize,
                candidate: see(candidate),
                baseline: see(baseline),
                ratchets: Vec::new(),
            };
            if rule.take(&[pair])?.is_some() {
                break;
            }
        }
        verdicts[match rule.result().verdict {
            GateVerdict::Pass => 0,
            GateVerdict::Fail => 1,
            GateVerdict::Inconclusive => 2,
        }] += 1;
    }
    let [pass, fail, inconclusive] = verdicts;
    println!(
        "{gates} gates of at most {} pairs, zhuang and {name} by a coin: {fail} FAIL, {pass} PASS, \
         {inconclusive} INCONCLUSIVE",
        declared.cap_pairs()
    );
    Ok(())
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
