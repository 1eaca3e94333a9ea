//! `gate --self-test`: what must not fail does not, and what must fail does.

use crate::cli::GateArgs;
use crate::exit::Ended;
use crate::say::say;
use crate::{build, embedded};
use campaign::{Error, Plan};
use gate::child::Launch;
use gate::self_test::{self, Killing, Sameness, SelfTest, Uniformity};
use gate::spec::PlannerSpec;
use gate::{Child, Event, FreshKey, GateSpec, mutants};
use planner_api::Registry;
use serde::Serialize;
use std::fs;
use std::path::Path;

/// p-values for the test of uniformity, and encounters behind each.
const UNIFORM_SETS: (usize, u64) = (200, 70);

/// What is kept of a self-test.
#[derive(Serialize)]
struct Report {
    schema: u32,
    baseline: String,
    seed: u64,
    cap_pairs: u64,
    same: Sameness,
    uniform: Uniformity,
    killings: Vec<Killing>,
    killed: usize,
}

pub(super) fn run(args: &GateArgs, spec: &GateSpec, registry: Registry) -> Result<Ended, Error> {
    let baseline = args.baseline.as_deref().unwrap_or("zhuang");
    let mut names: Vec<String> = registry
        .entries()
        .iter()
        .filter(|entry| entry.caught_by.is_some())
        .map(|entry| entry.name.clone())
        .collect();
    let faults = mutants::FAULTS.iter();
    names.extend(faults.map(|(_, fault, _)| format!("{}{fault}:{baseline}", mutants::PREFIX)));
    let mut wanted = names.clone();
    wanted.push(baseline.to_owned());
    let registry = super::with_outside(registry, &wanted)?;
    let threads = super::campaign::threads(args.threads)?;
    let program = std::env::current_exe().map_err(Error::io("find", Path::new("seatrial")))?;
    let launch = Launch { program, arguments: vec!["gate-arm".to_owned()], threads };
    let plan = |name: &str, seed: u64| -> Result<Plan, Error> {
        let asked = PlannerSpec { name: name.to_owned(), ..PlannerSpec::default() };
        spec.plan(&asked, seed, &registry, &embedded::rules_text, &build::build())
    };
    let draft = plan(baseline, 0)?;
    let campaign = gate::fresh::campaign_hash(&draft, &spec.table)?;
    let seed = FreshKey::new(&campaign, "self-test").seed();
    let mine = plan(baseline, seed)?;
    let test = SelfTest {
        gate: spec.gate_plan(&mine.strata, 1, &[])?,
        events: spec.events(),
        near_m: spec.near_m(),
        tell: &|line| say!("  {line}"),
    };
    let start = |plan: Plan| Child::start(launch.clone(), plan);
    let mut arm = start(mine.clone())?;
    say!("self-test of the gate {}, baseline {baseline}, seed {seed}", spec.file.name);
    let same = test.same(&mine, &mut arm, &mut start(mine.clone())?)?;
    say!(
        "  {baseline} against itself: {} pairs, {} differ in a bit, {} breaks and fixes",
        same.pairs,
        same.different,
        same.discordant
    );
    let mut other = start(self_test::independent(&mine))?;
    let uniform = test.uniform(Event::SafetyRadius, UNIFORM_SETS, &mut arm, &mut other)?;
    say!(
        "  on independent encounters: {} p-values, distance from uniform {:.3}, limit {:.3}",
        uniform.sets,
        uniform.distance,
        uniform.limit
    );
    let mut killings = Vec::new();
    for name in &names {
        let mut candidate = start(plan(name, seed)?)?;
        killings.push(test.kill(&mine, name, &mut arm, &mut candidate)?);
    }
    let (killed, of) = self_test::kill_rate(&killings);
    say!("  {killed} of {of} negative controls and mutants were caught");
    let holds = same.holds() && uniform.holds() && killed == of;
    let report = Report {
        schema: 1,
        baseline: baseline.to_owned(),
        seed,
        cap_pairs: test.gate.cap_pairs(),
        same,
        uniform,
        killings,
        killed,
    };
    let out = args.out.clone().unwrap_or_else(|| "reports/gate-self-test".into());
    fs::create_dir_all(&out).map_err(Error::io("make", &out))?;
    let mut json = serde_json::to_string_pretty(&report)
        .map_err(|e| Error::Fault(format!("failed to encode the self-test: {e}")))?;
    json.push('\n');
    crate::files::write(&out.join("self-test.json"), json.as_bytes())?;
    say!("  result: {}", out.join("self-test.json").display());
    Ok(if holds { Ended::Done } else { Ended::Failed })
}
