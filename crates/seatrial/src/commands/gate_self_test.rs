//! `gate --self-test`: what must not fail does not, and what must fail does.

use super::gate_arms::Arms;
use crate::cli_gate::GateArgs;
use crate::exit::Ended;
use crate::say::say;
use crate::timing::Stopwatch;
use campaign::{Error, Plan};
use gate::memory::Remembered;
use gate::self_test::{self, Report, SelfTest};
use gate::{Child, Event, FreshKey, GateSpec, mutants};
use planner_api::Registry;
use std::fs;
use std::sync::atomic::Ordering;

/// p-values for the test of uniformity, and encounters behind each.
const UNIFORM_SETS: (usize, u64) = (200, 70);
/// The same in the small self-test.
const UNIFORM_SETS_SMALL: (usize, u64) = (40, 35);
/// A planner that hangs costs this much in a self-test instead of the campaign's limit, seconds.
const HANG_LIMIT_S: f64 = 1.0;

pub(super) fn run(args: &GateArgs, mut spec: GateSpec, registry: Registry) -> Result<Ended, Error> {
    if args.small {
        self_test::make_small(&mut spec);
    }
    spec.file.run.planner_hang_limit_s = HANG_LIMIT_S;
    let baseline = args.baseline.as_deref().unwrap_or("zhuang");
    let names = candidates(&registry, baseline, args.small);
    let threads = super::campaign::threads(args.threads)?;
    let mut wanted: Vec<&str> = names.iter().map(String::as_str).collect();
    wanted.push(baseline);
    let arms = Arms::new(&spec, registry, threads)?.with(&wanted)?;
    let plan = |name: &str, seed: u64| arms.plan(name, toml::Table::new(), seed);
    let draft = plan(baseline, 0)?;
    let campaign = gate::fresh::campaign_hash(&draft, &spec.table)?;
    let seed = FreshKey::new(&campaign, "self-test").seed();
    let mine = plan(baseline, seed)?;
    let interrupted = super::gate::on_interrupt()?;
    let test = SelfTest {
        gate: spec.gate_plan(&mine.strata, 1, &[])?,
        events: spec.events(),
        near_m: spec.near_m(),
        tell: &|line| say!("  {line}"),
        stop: &|| interrupted.load(Ordering::Relaxed),
    };
    let start = |plan: Plan| Child::start(arms.mine.clone(), plan);
    let stopwatch = Stopwatch::start();
    // one baseline against many: its rows are kept
    let mut arm = Remembered::new(start(mine.clone())?);
    say!(
        "self-test of the gate {}, baseline {baseline}, seed {seed}, at most {} pairs each",
        spec.file.name,
        test.gate.cap_pairs()
    );
    let same = test.same(&mine, &mut arm, &mut start(mine.clone())?)?;
    say!("  {}", same.sentence(baseline));
    let sets = if args.small { UNIFORM_SETS_SMALL } else { UNIFORM_SETS };
    let mut other = start(self_test::independent(&mine))?;
    let uniform = test.uniform(Event::SafetyRadius, sets, &mut arm, &mut other)?;
    say!("  {}", uniform.sentence());
    let mut killings = Vec::new();
    for name in &names {
        let mut candidate = start(plan(name, seed)?)?;
        killings.push(test.kill(&mine, name, &mut arm, &mut candidate)?);
    }
    let report = Report {
        schema: 1,
        small: args.small,
        baseline: baseline.to_owned(),
        engine: mine.build.engine.clone(),
        seed,
        cap_pairs: test.gate.cap_pairs(),
        same,
        uniform,
        killings,
    };
    say!("  {}", report.sentence());
    say!("  {:.1} minutes on {threads} threads", stopwatch.elapsed_s() / 60.0);
    let out = args.out.clone().unwrap_or_else(|| "reports/gate-self-test".into());
    fs::create_dir_all(&out).map_err(Error::io("make", &out))?;
    let mut json = serde_json::to_string_pretty(&report)
        .map_err(|e| Error::Fault(format!("failed to encode the self-test: {e}")))?;
    json.push('\n');
    crate::files::write(&out.join("self-test.json"), json.as_bytes())?;
    crate::files::write(&out.join("self-test.md"), report.markdown().as_bytes())?;
    say!("  result: {}/self-test.json, self-test.md", out.display());
    Ok(if report.holds() { Ended::Done } else { Ended::Failed })
}

/// Planners that must not pass: negative controls, and mutants of the baseline.
fn candidates(registry: &Registry, baseline: &str, small: bool) -> Vec<String> {
    let mutant = |fault: &str| format!("{}{fault}:{baseline}", mutants::PREFIX);
    if small {
        let controls = self_test::SMALL_CONTROLS.map(str::to_owned);
        return controls.into_iter().chain(self_test::SMALL_FAULTS.map(mutant)).collect();
    }
    let controls = registry.entries().iter().filter(|entry| entry.caught_by.is_some());
    let faults = mutants::FAULTS.iter().map(|(_, fault, _)| mutant(fault));
    controls.map(|entry| entry.name.clone()).chain(faults).collect()
}
