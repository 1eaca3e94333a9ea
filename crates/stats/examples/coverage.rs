//! The coverage study: 20,000 data sets at five rates for every interval, and how long the paired
//! test takes to decide. `cargo run --release -p stats --example coverage [SETS]`.

#[path = "../tests/it/generator.rs"]
mod generator;
#[path = "../tests/it/simulation.rs"]
mod simulation;

use generator::Generator;
use simulation::{METHODS, study};
use stats::{Harm, PairedCounts, unpaired_needed};

const RATES: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];

fn main() {
    let sets = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(20_000);
    println!("# Coverage of two-sided 95 % intervals, {sets} data sets at each rate");
    println!();
    println!("Lower and upper are the shares in which that limit held (nominal 97.5 % each);");
    println!("`declined` counts data sets for which the method gives no interval.");
    println!();
    println!("| method | claim | rate | lower % | upper % | both % | declined |");
    println!("|---|---|---|---|---|---|---|");
    let mut least_claim = 100.0_f64;
    for rate in RATES {
        for (studied, cover) in METHODS.iter().zip(study(sets, rate)) {
            let percent = |missed: u64| 100.0 * (1.0 - missed as f64 / cover.sets.max(1) as f64);
            let both = percent(cover.missed_low + cover.missed_high);
            if studied.is_claim() {
                least_claim = least_claim.min(both);
            }
            println!(
                "| {} | {} | {rate:.0e} | {:.2} | {:.2} | {both:.2} | {} |",
                studied.name,
                if studied.is_claim() { "yes" } else { "no" },
                percent(cover.missed_low),
                percent(cover.missed_high),
                cover.declined,
            );
        }
    }
    println!();
    println!("Least coverage of a claim-bearing interval: {least_claim:.2} % (must be >= 94.5 %).");
    println!();
    time_to_decision(sets.div_ceil(10));
}

/// p10 = 1.5e-4, p01 = 0.5e-4, a = .05: encounters until E_harm reaches 20, looking after each.
fn time_to_decision(sets: u64) {
    let harm = Harm::default();
    let ln_level = libm::log(20.0);
    let mut taken: Vec<u64> = (0..sets)
        .map(|set| {
            let mut draw = Generator::new(set.wrapping_mul(0x2545_f491_4f6c_dd1d));
            let mut counts = PairedCounts::default();
            while harm.ln_e(&counts) < ln_level {
                counts.n00 += draw.gap(2e-4) - 1;
                let breaks = draw.uniform() < 0.75;
                counts.add(breaks, !breaks);
            }
            counts.n()
        })
        .collect();
    taken.sort_unstable();
    let mean = taken.iter().sum::<u64>() as f64 / taken.len() as f64;
    let unpaired = unpaired_needed(1.0e-3, 1.1e-3, 0.05, 0.9).expect("rates are rates");
    println!("# Encounters until harm is shown: p10 = 1.5e-4, p01 = 0.5e-4, a = .05, {sets} runs");
    println!();
    println!(
        "mean {mean:.3e}, median {:.3e}, 90 % quantile {:.3e}; unpaired fixed size {unpaired:.3e} \
         per arm, {:.1} times the mean",
        taken[taken.len() / 2] as f64,
        taken[taken.len() * 9 / 10] as f64,
        unpaired / mean,
    );
}
