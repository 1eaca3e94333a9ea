//! `gate`: may this change of a planner be merged?

use crate::cli::GateArgs;
use crate::exit::Ended;
use crate::progress::Progress;
use crate::say::{say, say_text};
use crate::{build, embedded};
use campaign::{Error, Plan};
use gate::child::Launch;
use gate::spec::PlannerSpec;
use gate::{Arm, ArmIdentity, Child, FreshKey, GateReport, GateSpec, Ledger, PairedRun};
use planner_api::Registry;
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where a gate writes, unless it is told otherwise.
const OUT: &str = "reports/gate";
/// Where the cases of layer 1 lie, unless it is told otherwise.
const CORPUS: &str = "tests/corpus";
/// Where attempts are written, unless it is told otherwise.
const LEDGER: &str = "reports/gate-ledger.jsonl";

pub(super) fn run(args: &GateArgs, registry: Registry) -> Result<Ended, Error> {
    let out = args.out.clone().unwrap_or_else(|| OUT.into());
    if let Some(id) = &args.replay {
        return super::gate_replay::run(&out, id, registry);
    }
    let mut spec = GateSpec::parse(&embedded::campaign_text(&args.campaign)?, &args.campaign)?;
    if let Some(cap) = args.cap {
        spec.table.cap_pairs = cap;
    }
    if args.self_test {
        return super::gate_self_test::run(args, &spec, registry);
    }
    let (Some(baseline), Some(candidate)) = (&args.baseline, &args.candidate) else {
        return Err(Error::input(
            "the gate compares two planners that run: name them with --baseline and --candidate",
        ));
    };
    refuse_folder(baseline)?;
    refuse_folder(candidate)?;
    Job { args, spec, out }.run(baseline, candidate, registry)
}

/// Fresh encounters need a baseline that runs.
fn refuse_folder(name: &str) -> Result<(), Error> {
    if Path::new(name).is_dir() {
        return Err(Error::input(format!(
            "`{name}` is a folder; a gate runs both planners on fresh encounters, so results of \
             another run cannot take part: name a planner, git:REV, exec:... or lib:..."
        )));
    }
    Ok(())
}

struct Job<'a> {
    args: &'a GateArgs,
    spec: GateSpec,
    out: PathBuf,
}

/// A planner with its plan and the binary that runs it.
struct Side {
    asked: String,
    plan: Plan,
    launch: Launch,
}

impl Job<'_> {
    fn run(&self, baseline: &str, candidate: &str, registry: Registry) -> Result<Ended, Error> {
        let build = build::build();
        let registry = super::with_outside(registry, &[candidate.to_owned()])?;
        let options = |list: &[String]| options(list);
        let asked = PlannerSpec {
            name: candidate.to_owned(),
            options: options(&self.args.candidate_options)?,
        };
        let find: campaign::spec::FindRules<'_> = &embedded::rules_text;
        let draft = self.spec.plan(&asked, 0, &registry, find, &build)?;
        let campaign_hash = gate::fresh::campaign_hash(&draft, &self.spec.table)?;
        let outside = outside_bytes(candidate)?;
        let hash = gate::fresh::candidate_hash(&draft, outside.as_deref())?;
        let key = FreshKey::new(&campaign_hash, &hash);

        let series = self.args.series.clone().unwrap_or_else(branch);
        let path = self.args.ledger.clone().unwrap_or_else(|| LEDGER.into());
        let mut ledger = Ledger::open(&path)?;
        let attempt = ledger.attempt(&series, &key);
        let declared = self.spec.gate_plan(&draft.strata, attempt, &[])?;
        let feasibility = declared.feasibility().map_err(|e| Error::input(e.to_string()))?;
        say!(
            "gate {}: {candidate} against {baseline}, seed {}, attempt {attempt} of `{series}`, at \
             most {} pairs",
            self.spec.file.name,
            key.seed(),
            feasibility.cap
        );
        say!("  {}", gate::text::expectation(&feasibility));

        let threads = super::campaign::threads(self.args.threads)?;
        let mine = Launch {
            program: std::env::current_exe().map_err(Error::io("find", Path::new("seatrial")))?,
            arguments: vec!["gate-arm".to_owned()],
            threads,
        };
        let candidate_plan = Plan { seed: record::Seed(key.seed()), ..draft };
        let candidate =
            Side { asked: candidate.to_owned(), plan: candidate_plan, launch: mine.clone() };
        let baseline = self.baseline(baseline, &candidate, mine, registry, &key)?;
        let entry = gate::ledger::Entry {
            previous: String::new(),
            series: series.clone(),
            attempt,
            key: key.clone(),
            campaign_hash: campaign_hash.clone(),
            baseline: baseline.asked.clone(),
            candidate: candidate.asked.clone(),
            cap_pairs: feasibility.cap,
            state: "started".to_owned(),
        };
        let (mut baseline, baseline_identity) = start(baseline)?;
        let (mut candidate, candidate_identity) = start(candidate)?;
        candidate_identity.identity.must_agree(&baseline_identity.identity, "the baseline")?;
        ledger.append(entry.clone())?;

        let folder = self.args.corpus.clone().unwrap_or_else(|| CORPUS.into());
        let corpus = gate::corpus::replay(
            &gate::corpus::read(&folder)?,
            &embedded::rules_text,
            &mut |question| baseline.case(question),
            &mut |question| candidate.case(question),
        )?;
        let paired = self.pairs(
            &declared,
            &candidate_identity.plan,
            corpus.clone(),
            (&mut baseline, &mut candidate),
        )?;
        let verdict = paired.result.verdict;
        let state = gate::text::word(verdict).to_owned();
        ledger.append(gate::ledger::Entry { state, ..entry })?;
        let report = GateReport {
            schema: 1,
            verdict,
            title: self.spec.file.title.clone(),
            campaign_hash,
            key,
            series,
            baseline: baseline_identity,
            candidate: candidate_identity,
            ratchets: Vec::new(),
            false_alarm_budget: declared.alpha_fail + declared.alpha_absolute,
            declared,
            feasibility,
            result: paired.result,
            corpus,
            different: paired.different,
            new_failures: paired.new_failures,
        };
        self.write(&report)?;
        say_text!("{}", gate::text::terminal(&report, &self.out.display().to_string()));
        Ok(match gate::run::exit_code(verdict) {
            0 => Ended::Done,
            1 => Ended::Failed,
            _ => Ended::Inconclusive,
        })
    }

    fn baseline(
        &self,
        name: &str,
        candidate: &Side,
        mine: Launch,
        registry: Registry,
        key: &FreshKey,
    ) -> Result<Side, Error> {
        if let Some(rest) = name.strip_prefix("git:") {
            let (revision, planner) = rest.split_once(':').unwrap_or((rest, &candidate.asked));
            let program = super::gate_git::build(revision)?;
            let mut plan = candidate.plan.clone();
            if planner != candidate.plan.planner.name {
                let asked = PlannerSpec { name: planner.to_owned(), ..PlannerSpec::default() };
                plan = self.spec.plan(
                    &asked,
                    key.seed(),
                    &registry,
                    &embedded::rules_text,
                    &build::build(),
                )?;
            }
            return Ok(Side { asked: name.to_owned(), plan, launch: Launch { program, ..mine } });
        }
        let registry = if registry.get(name).is_ok() {
            registry
        } else {
            super::with_outside(registry, &[name.to_owned()])?
        };
        let asked =
            PlannerSpec { name: name.to_owned(), options: options(&self.args.baseline_options)? };
        let build = build::build();
        let plan = self.spec.plan(&asked, key.seed(), &registry, &embedded::rules_text, &build)?;
        Ok(Side { asked: name.to_owned(), plan, launch: mine })
    }

    fn pairs(
        &self,
        declared: &stats::GatePlan,
        plan: &Plan,
        corpus: stats::CorpusResult,
        (baseline, candidate): (&mut dyn Arm, &mut dyn Arm),
    ) -> Result<gate::Paired, Error> {
        let progress = Progress::new("gate", declared.cap_pairs(), self.args.quiet);
        let seen = Cell::new(0);
        let paired = PairedRun {
            gate: declared.clone(),
            plan,
            events: &self.spec.events(),
            near_m: self.spec.near_m(),
            corpus,
            baseline,
            candidate,
            ratchets: Vec::new(),
            progress: &|pairs| {
                progress.add(pairs - seen.get());
                seen.set(pairs);
            },
        }
        .run();
        progress.end();
        paired
    }

    fn write(&self, report: &GateReport) -> Result<(), Error> {
        fs::create_dir_all(&self.out).map_err(Error::io("make", &self.out))?;
        let folder = self.out.display().to_string();
        let mut json = serde_json::to_string_pretty(report)
            .map_err(|e| Error::Fault(format!("failed to encode the result: {e}")))?;
        json.push('\n');
        crate::files::write(&self.out.join("gate.json"), json.as_bytes())?;
        let xml = gate::junit::xml(report, &folder)
            .map_err(|e| Error::Fault(format!("failed to encode JUnit XML: {e}")))?;
        crate::files::write(&self.out.join("junit.xml"), xml.as_bytes())?;
        let page = gate::text::markdown(report, &folder);
        crate::files::write(&self.out.join("summary.md"), page.as_bytes())?;
        // the one variable that is read: CI names the page of its job by it
        if let Some(path) = std::env::var_os("GITHUB_STEP_SUMMARY").map(PathBuf::from) {
            append(&path, &page)?;
        }
        Ok(())
    }
}

fn append(path: &Path, text: &str) -> Result<(), Error> {
    use std::io::Write;
    let file = fs::OpenOptions::new().create(true).append(true).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(Error::io("append to", path))
}

/// An arm that runs, and who it is.
fn start(side: Side) -> Result<(Child, ArmIdentity), Error> {
    let child = Child::start(side.launch, side.plan.clone())?;
    let identity = child.identity().clone();
    Ok((child, ArmIdentity { asked: side.asked, identity, plan: side.plan }))
}

/// `KEY=VALUE` in TOML's own notation, each.
fn options(list: &[String]) -> Result<toml::Table, Error> {
    let mut table = toml::Table::new();
    for text in list {
        let one: toml::Table = text.parse().map_err(|_| {
            Error::input(format!("`{text}` is no option; one looks like radius_factor=0.9"))
        })?;
        table.extend(one);
    }
    Ok(table)
}

/// What a planner from outside consists of, as far as one file tells.
fn outside_bytes(name: &str) -> Result<Option<Vec<u8>>, Error> {
    let command = name.strip_prefix("exec:").or_else(|| name.strip_prefix("lib:"));
    let Some(command) = command else { return Ok(None) };
    // a script's interpreter comes first, so every word that is a file counts
    let mut bytes = Vec::new();
    for word in command.split_whitespace().filter(|word| Path::new(word).is_file()) {
        bytes.extend(fs::read(word).map_err(Error::io("read", Path::new(word)))?);
    }
    Ok(Some(bytes))
}

/// The branch of the working folder, the default name of a change series.
fn branch() -> String {
    let output = Command::new("git").args(["rev-parse", "--abbrev-ref", "HEAD"]).output();
    let text = output
        .ok()
        .filter(|o| o.status.success())
        .and_then(|o| String::from_utf8(o.stdout).ok().map(|name| name.trim().to_owned()));
    text.filter(|name| !name.is_empty()).unwrap_or_else(|| "unnamed".to_owned())
}

/// The process that runs one planner for a gate.
pub(super) fn arm(threads: usize, registry: Registry) -> Result<Ended, Error> {
    campaign::engine::quiet_planner_panics();
    gate::serve::serve(threads, &build::build(), |name| {
        super::with_outside(registry, &[name.to_owned()])
    })?;
    Ok(Ended::Done)
}
