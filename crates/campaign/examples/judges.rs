//! Every kind of disagreement between the two judges, with examples, and what the second one costs.
//!
//! `cargo run --release -p campaign --example judges -- campaigns/laboratory.toml zhuang 2000`
#![forbid(unsafe_code)]

mod common;

use campaign::judges::{Disagreement, Judges};
use campaign::spec::RunTable;
use campaign::worker::{Shop, Worker};
use campaign::{Error, Overrides};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

/// Ids shown of each kind.
const SHOWN: usize = 6;

#[expect(clippy::disallowed_methods, reason = "this program measures what judging costs")]
fn now() -> Instant {
    Instant::now()
}

fn main() -> Result<(), Error> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, planner, encounters] = &words[..] else {
        return Err(Error::input("usage: judges CAMPAIGN.toml PLANNER ENCOUNTERS_PER_STRATUM"));
    };
    let overrides = Overrides {
        planners: vec![planner.clone()],
        encounters: Some(encounters.parse().map_err(|_| Error::input("not a number"))?),
        ..Overrides::default()
    };
    let registry = planners::registry();
    let plans = common::plans(file, &overrides, &registry, |_| ())?;
    let plan = &plans[0];
    let shop = Shop::new(plan, &registry)?;
    let mut worker = Worker::new(&shop)?;
    let rule_set = plan.rules.rule_set()?;
    let asked = |second_judge| RunTable { second_judge, ..plan.run };
    let mut both = Judges::new(rule_set.clone(), &asked(true))?;
    let mut first = Judges::new(rule_set, &asked(false))?;
    let beat = AtomicU64::new(0);
    let (mut whole, mut one, mut two) = (Duration::ZERO, Duration::ZERO, Duration::ZERO);
    let mut kinds: BTreeMap<String, (u64, Vec<String>)> = BTreeMap::new();
    let (mut runs, mut disagreeing) = (0u64, 0u64);
    for stratum in 0..plan.strata.len() as u32 {
        for j in 0..plan.encounters_per_stratum {
            let start = now();
            let mut run = worker.run(stratum, j, &beat)?;
            let ran = now();
            first.judge(&run.encounter, &mut run.trace);
            let judged = now();
            let found =
                both.judge(&run.encounter, &mut run.trace).disagreements.unwrap_or_default();
            two += now() - judged;
            one += judged - ran;
            whole += ran - start;
            runs += 1;
            disagreeing += u64::from(!found.is_empty());
            for kind in found {
                let (count, ids) = kinds.entry(name(&kind)).or_default();
                *count += 1;
                if ids.len() < SHOWN {
                    ids.push(format!("{}", run.row.id));
                }
            }
        }
    }
    println!("{runs} runs, {disagreeing} with a disagreement");
    for (kind, (count, ids)) in kinds {
        println!("{count:>6}  {kind}: {}", ids.join(" "));
    }
    let second = two.saturating_sub(one);
    println!(
        "run, nominal track and both judges {whole:?}; first judge {one:?}; second {second:?}, \
         {:.1} % of the rest",
        100.0 * second.as_secs_f64() / (whole - second).as_secs_f64()
    );
    Ok(())
}

fn name(kind: &Disagreement) -> String {
    format!("{} {:?} {} / {:?}", kind.check.name(), kind.first, kind.detail, kind.second)
}
