//! What the C interface costs of whole encounters with the seed planner:
//! `cargo run --config .cargo/optimised.toml -p campaign --example abi_cost -- FILE.toml N ROUNDS`
//!
//! Each of N encounters of every stratum is drawn, run and judged twice, in alternating order: by
//! the seed planner alone, and by the seed planner with a library in C asked beside it at every
//! beat, which answers at once and whose answer is not used. So both runs have the same bits, and
//! differ by the interface alone: the mission and every situation made into C, the calls, and the
//! answer made into an order. Needs `cc`.
#![forbid(unsafe_code)]

mod common;

use campaign::worker::{Shop, Worker};
use campaign::{Error, Overrides};
use planner_api::{
    Command, HeadOnSector, Mission, Planner, PlannerEntry, PlannerEvents, Situation,
};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicU64;

const SEED_PLANNER: &str = "zhuang";
const WITH_LIBRARY: &str = "zhuang-and-library";

const LIBRARY: &str = r#"
#include "seatrial_planner.h"
#include <stdlib.h>

static void *create(void) { return malloc(1); }

static int32_t reset(void *it, const struct SeatrialMission *mission) {
    (void)it; (void)mission;
    return 0;
}

static int32_t plan(void *it, const struct SeatrialSituation *seen, struct SeatrialCommand *out) {
    (void)it;
    out->kind = SEATRIAL_COURSE_SPEED;
    out->course_rad = seen->own.psi_rad;
    out->speed_mps = seen->own.stw_mps;
    return 0;
}

static const struct SeatrialPlanner planner = {
    SEATRIAL_PLANNER_ABI, "at-once", "1", create, reset, plan, free,
};

const struct SeatrialPlanner *seatrial_planner_v1(void) { return &planner; }
"#;

/// The seed planner, and whom to ask beside it.
struct Beside {
    seed: Box<dyn Planner>,
    library: Box<dyn Planner>,
}

impl Planner for Beside {
    fn reset(&mut self, mission: &Mission) {
        self.library.reset(mission);
        self.seed.reset(mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        std::hint::black_box(self.library.plan(situation));
        self.seed.plan(situation)
    }

    fn events(&self) -> PlannerEvents {
        self.seed.events()
    }

    fn head_on_sector(&self) -> Option<HeadOnSector> {
        self.seed.head_on_sector()
    }
}

fn main() -> Result<(), Error> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, n, rounds] = &words[..] else {
        return Err(Error::input("usage: abi_cost CAMPAIGN.toml PER_STRATUM ROUNDS"));
    };
    let number = |word: &str| word.parse::<u64>().map_err(|_| Error::input("not a number"));
    let (n, rounds) = (number(n)?, number(rounds)?);
    let folder = tempfile::tempdir().map_err(Error::io("make", Path::new("a folder")))?;
    let library = compile(folder.path())?;
    let registry = planners::registry().with(entry(format!("lib:{}", library.display()))?);
    let overrides = Overrides {
        planners: vec![SEED_PLANNER.to_owned(), WITH_LIBRARY.to_owned()],
        encounters: Some(n),
        ..Overrides::default()
    };
    let mut plans = common::plans(file, &overrides, &registry, |_| ())?;
    plans.iter_mut().for_each(|plan| plan.run.twice_run_share = 0.0);
    let shops = [Shop::new(&plans[0], &registry)?, Shop::new(&plans[1], &registry)?];
    let mut workers = [Worker::new(&shops[0])?, Worker::new(&shops[1])?];
    let (mut shares, mut beats) = (Vec::new(), 0);
    let mut both = [0.0; 2];
    for round in 0..rounds {
        let mut taken_s = [0.0; 2];
        for (stratum, j) in
            (0..plans[0].strata.len() as u32).flat_map(|s| (0..n).map(move |j| (s, j)))
        {
            let mut digests = [None, None];
            for turn in 0..2 {
                let who = ((turn + j + round) % 2) as usize;
                let before_s = clock_s();
                let run = workers[who].run(stratum, j, &AtomicU64::new(0))?;
                taken_s[who] += clock_s() - before_s;
                beats += run.trace.orders.len();
                digests[who] = Some(run.row.digest);
            }
            assert!(digests[0] == digests[1], "the library changed {stratum}/{j}");
        }
        shares.push(100.0 * (taken_s[1] / taken_s[0] - 1.0));
        both = [both[0] + taken_s[0], both[1] + taken_s[1]];
    }
    shares.sort_by(f64::total_cmp);
    let encounters = n * plans[0].strata.len() as u64 * rounds;
    println!(
        "{encounters} encounters: {:.3} ms each alone, {:.2} % more with the interface \
         (rounds: {:.2} to {:.2} %, median {:.2} %), {} orders each",
        1e3 * both[0] / encounters as f64,
        100.0 * (both[1] / both[0] - 1.0),
        shares[0],
        shares[shares.len() - 1],
        shares[shares.len() / 2],
        beats as u64 / encounters / 2,
    );
    Ok(())
}

fn compile(folder: &Path) -> Result<PathBuf, Error> {
    let (source, library) = (folder.join("at_once.c"), folder.join("at_once.so"));
    std::fs::write(&source, LIBRARY).map_err(Error::io("write", &source))?;
    let compiled = std::process::Command::new("cc")
        .args(["-O2", "-shared", "-fPIC", "-I"])
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/../planner-host/include"))
        .args([source.as_os_str(), "-o".as_ref(), library.as_os_str()])
        .status()
        .map_err(Error::io("start", Path::new("cc")))?;
    if compiled.success() { Ok(library) } else { Err(Error::input("cc failed")) }
}

fn entry(library: String) -> Result<PlannerEntry, Error> {
    let wrong = |e: planner_api::OptionsError| Error::input(e.to_string());
    let registry = planners::registry();
    let options = registry.get(SEED_PLANNER).map_err(wrong)?.options.clone();
    let outside = planner_host::outside(&library).ok_or_else(|| Error::input(library.clone()))?;
    let outside = outside.map_err(wrong)?;
    Ok(PlannerEntry {
        name: WITH_LIBRARY.to_owned(),
        summary: "the seed planner, with a library asked beside it".to_owned(),
        caught_by: None,
        options,
        make: Box::new(move |options| {
            let seed = (registry.get(SEED_PLANNER)?.make)(options)?;
            let library = (outside.make)(&outside.options)?;
            Ok(Box::new(Beside { seed, library }))
        }),
    })
}

/// Time that this thread had a processor; the machine may be busy with other work.
fn clock_s() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ns: f64 = text.split(' ').next().and_then(|ns| ns.parse().ok()).unwrap_or(f64::NAN);
    ns * 1e-9
}
