//! What a report costs: `cargo run --config .cargo/optimised.toml -p report --example report_cost`.
//!
//! Milliseconds of this thread's processor to render one (nothing is written), and its bytes: for
//! few and many encounters, since what it holds is counts, and with and without the encounters that
//! are shown with their tracks.

#[path = "../tests/fixture/mod.rs"]
mod fixture;

use record::{EncounterClass, Seed};
use report::{Case, ReportInput, render};
use summary::{Summary, SummaryHead, Tallies};

const ROUNDS: u32 = 5;

fn main() -> Result<(), report::ReportError> {
    println!("{:>10} {:>6} {:>8} {:>12}", "encounters", "shown", "ms", "bytes");
    for (per_class, shown) in [(40, 0), (40, 20), (20_000, 0), (20_000, 20)] {
        let strata: Vec<&str> = EncounterClass::ALL[..5].iter().map(|class| class.name()).collect();
        let mut tallies = Tallies::new();
        for stratum in &strata {
            (0..per_class).for_each(|j| tallies.add(&fixture::row(stratum, j, 100)));
        }
        let head = SummaryHead {
            campaign: "cost".into(),
            planner: "zhuang".into(),
            seed: Seed(1),
            root_digest: String::new(),
        };
        let summary = Summary::new(head, &tallies, strata.iter().copied());
        // ten minutes, a sample each second, one target or two
        let case = |j: u64| fixture::case(j, 35.0, (j % 2) as usize, 600, 5000.0);
        let cases: Vec<Case> = (0..shown).map(case).collect();
        let card = fixture::card();
        let input = ReportInput {
            card: &card,
            summary: &summary,
            tallies: &tallies,
            findings: &[],
            cases: &cases,
            scenes: &[],
        };
        let before_ms = clock_ms();
        let mut bytes = 0;
        for _ in 0..ROUNDS {
            bytes = render(&input)?.iter().map(|file| file.text.len()).sum();
        }
        let each_ms = (clock_ms() - before_ms) / f64::from(ROUNDS);
        println!("{:>10} {shown:>6} {each_ms:>8.1} {bytes:>12}", 5 * per_class);
    }
    Ok(())
}

/// Time that this thread had a processor; the machine may be busy with other work.
fn clock_ms() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ns: f64 = text.split(' ').next().and_then(|ns| ns.parse().ok()).unwrap_or(f64::NAN);
    ns * 1e-6
}
