//! Everything that both judges say of single encounters, with own ship's heading.
//!
//! `cargo run --release -p campaign --example verdicts -- campaigns/laboratory.toml zhuang 9 ID`,
//! with an ID such as `head_on/8`.
#![forbid(unsafe_code)]

mod common;

use campaign::judges::params;
use campaign::worker::{Shop, Worker};
use campaign::{Error, Overrides};
use std::sync::atomic::AtomicU64;

fn main() -> Result<(), Error> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, planner, encounters, ids @ ..] = &words[..] else {
        return Err(Error::input("usage: verdicts CAMPAIGN.toml PLANNER PER_STRATUM STRATUM/J..."));
    };
    let number = |word: &str| word.parse::<u64>().map_err(|_| Error::input("not a number"));
    let overrides = Overrides {
        planners: vec![planner.clone()],
        encounters: Some(number(encounters)?),
        ..Overrides::default()
    };
    let registry = planners::registry();
    let plans = common::plans(file, &overrides, &registry, |_| ())?;
    let plan = &plans[0];
    let shop = Shop::new(plan, &registry)?;
    let mut worker = Worker::new(&shop)?;
    let rule_set = plan.rules.rule_set()?;
    let second = params(&rule_set)?;
    let mut first = rules::Judge::new(rule_set);
    for id in ids {
        let (name, j) = id.split_once('/').ok_or_else(|| Error::input("an id is STRATUM/J"))?;
        let stratum = plan.strata.iter().position(|stratum| stratum == name);
        let stratum = stratum.ok_or_else(|| Error::input(format!("no stratum {name}")))?;
        let run = worker.run(stratum as u32, number(j)?, &AtomicU64::new(0))?;
        println!("{id}");
        for (k, psi_rad) in run.trace.own.psi_rad.iter().enumerate().step_by(1) {
            let t_s = k as f64 * run.trace.sample_s;
            print!("{t_s:.0}:{:.1}@{:.1} ", psi_rad.to_degrees(), run.trace.own.sog_mps(k));
        }
        let nominal = run.trace.nominal.as_ref();
        println!("\noff the nominal heading");
        for (k, off) in deviation_rad(&run.trace, &second).iter().enumerate() {
            print!("{:.0}:{:.2} ", k as f64 * run.trace.sample_s, off.to_degrees());
        }
        let minima = nominal.map(|n| n.minima.iter().map(|m| m.of(run.trace.distance)));
        println!("\nnominal {:?}", minima.map(Iterator::collect::<Vec<_>>));
        let judgement = first.judge(&run.trace);
        println!("\n{:?}", judgement.pairs);
        for v in &judgement.verdicts {
            let numbers: Vec<String> =
                v.evidence.iter().map(|e| format!("{} {:.3}", e.name, e.value)).collect();
            let (check, status) = (v.check.name(), v.status.name());
            println!("  {check} {status} {} {:?}; {}", v.detail, v.t_s, numbers.join(", "));
        }
        let lives = stl::life::lives(&run.trace, &second);
        let deviation = stl::action::Deviation::of(&run.trace, &second);
        for (target, life) in lives.iter().enumerate() {
            for duty in life.in_sight.iter().chain(&life.by_radar) {
                let sample_s = run.trace.sample_s;
                let did =
                    stl::action::Action::of(&deviation, &lives, target, duty, &second, sample_s);
                println!(
                    "  second, target {target}: tracked {:?}, begin {}, onset {}, may act {:?}",
                    run.trace.pairs[target].tracked_s, duty.begin, duty.onset, duty.may_act
                );
                println!("  {:?} back {:?} from {}", did.counted, did.returns, did.from);
                println!("  {:?}", did.turns);
                println!("  {:?}", did.speed_changes);
            }
        }
        for said in stl::judge(&run.trace, &second) {
            if said.status == stl::Finding::NotEvaluated {
                continue;
            }
            println!("  second: {} {:?} {:?}", said.check.name(), said.status, said.rho);
        }
    }
    Ok(())
}

/// Own ship's heading less the nominal one, radians.
fn deviation_rad(trace: &record::Trace, params: &stl::params::Params) -> Vec<f64> {
    stl::action::Deviation::of(trace, params).heading_rad
}
