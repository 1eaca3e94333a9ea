//! `gate`: may this change of a planner be merged?

use super::gate_arms::{self, Arms, Side};
use crate::cli_gate::GateArgs;
use crate::embedded;
use crate::exit::Ended;
use crate::progress::Progress;
use crate::say::{say, say_text};
use crate::timing::Stopwatch;
use campaign::{Error, Plan};
use gate::memory::{Echo, Heard};
use gate::spec::PlannerSpec;
use gate::{Arm, ArmIdentity, Child, FreshKey, GateReport, GateSpec, Ledger, Paired, PairedRun};
use gate::{Record, Role};
use planner_api::Registry;
use std::cell::Cell;
use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};

/// Where a gate writes, unless it is told otherwise.
const OUT: &str = "reports/gate";
/// Where the cases of layer 1 lie, unless it is told otherwise.
pub(super) const CORPUS: &str = "tests/corpus";
/// Where the stored planners lie, unless it is told otherwise.
pub(super) const BASELINES: &str = "reports/baseline";
/// Where attempts are written, unless it is told otherwise.
const LEDGER: &str = "reports/gate-ledger.jsonl";
/// Cycles through the strata that are run beforehand, to say how long the gate may take.
const TIMED_CYCLES: u64 = 30;

pub(super) fn run(args: &GateArgs, registry: Registry) -> Result<Ended, Error> {
    // clap waives what an argument requires where another one conflicts with it
    if args.small && !args.self_test {
        return Err(Error::input("--small is a form of --self-test: give both"));
    }
    let out = args.out.clone().unwrap_or_else(|| OUT.into());
    if let Some(id) = &args.replay {
        return super::gate_replay::run(&out, id, registry);
    }
    let mut spec = GateSpec::parse(&embedded::campaign_text(&args.campaign)?, &args.campaign)?;
    if let Some(cap) = args.cap {
        spec.table.cap_pairs = cap;
    }
    if args.self_test {
        return super::gate_self_test::run(args, spec, registry);
    }
    Job { args, spec, out }.run(registry)
}

/// Whether Ctrl-C was pressed.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Whether somebody wants it to end.
pub(super) fn was_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Set by the first Ctrl-C; the second one ends the process at once.
pub(super) fn on_interrupt() -> Result<&'static AtomicBool, Error> {
    ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(crate::exit::INCOMPLETE));
        }
        eprintln!("stopping at the next look");
    })
    .map_err(|e| Error::Fault(format!("failed to handle Ctrl-C: {e}")))?;
    Ok(&INTERRUPTED)
}

struct Job<'a> {
    args: &'a GateArgs,
    spec: GateSpec,
    out: PathBuf,
}

/// What was settled before anything runs.
struct Declared {
    candidate: Plan,
    /// Options that were given for the candidate.
    changes: toml::Table,
    campaign_hash: String,
    key: FreshKey,
    series: String,
    plan: stats::GatePlan,
    feasibility: stats::Feasibility,
}

/// The arms of a gate, started.
struct Started {
    baseline: Heard<Child>,
    candidate: Heard<Child>,
    ratchets: Vec<Ratchet>,
    baseline_identity: ArmIdentity,
    candidate_identity: ArmIdentity,
    ratchet_identities: Vec<ArmIdentity>,
}

/// An older planner; one that stands in the gate already is not run twice.
enum Ratchet {
    Own(Box<Child>),
    Same(Echo),
}

impl Job<'_> {
    fn run(&self, registry: Registry) -> Result<Ended, Error> {
        let args = self.args;
        let folder = args.baselines.clone().unwrap_or_else(|| BASELINES.into());
        let stored = |role| Record::read(&folder, role);
        let current = if args.baseline.is_none() { stored(Role::Current)? } else { None };
        let Some(candidate) = &args.candidate else { return Err(self.nameless()) };
        if args.baseline.is_none() && current.is_none() {
            return Err(self.nameless());
        }
        let mut older = Vec::new();
        for role in [Role::Release, Role::Anchor] {
            older.extend(stored(role)?);
        }
        let threads = super::campaign::threads(args.threads)?;
        let arms = Arms::new(&self.spec, registry, threads)?;
        let names = [Some(candidate), args.baseline.as_ref()];
        let names: Vec<&str> = names.into_iter().flatten().map(String::as_str).collect();
        let arms = arms.with(&names)?;
        let mut ledger = Ledger::open(&args.ledger.clone().unwrap_or_else(|| LEDGER.into()))?;
        let declared = self.declare(candidate, &arms, &ledger, &older)?;
        // before anything is built: an interrupted build must put back what it replaced
        let interrupted = on_interrupt()?;
        let baseline = match (&args.baseline, &current) {
            (Some(name), _) => {
                let options = gate_arms::options(&args.baseline_options)?;
                arms.side(name, options, &declared.candidate, &declared.changes)?
            }
            (None, Some(record)) => arms.stored(record, &declared.candidate)?,
            (None, None) => return Err(self.nameless()),
        };
        let mut ratchets = Vec::new();
        for record in &older {
            ratchets.push(arms.stored(record, &declared.candidate)?);
        }
        let mine = Side::of(candidate, declared.candidate.clone(), arms.mine.clone());
        if interrupted.load(Ordering::Relaxed) {
            return Err(Error::Incomplete("interrupted before the first pair".to_owned()));
        }
        let mut started = start(baseline, mine, ratchets)?;
        let entry = self.entry(&declared, &started);
        ledger.append(entry.clone())?;
        let ended = self.answer(&declared, &mut started, threads, interrupted);
        let state = match &ended {
            Ok((_, paired)) => gate::text::word(paired.result.verdict),
            Err(Error::Incomplete(_)) => "interrupted",
            Err(_) => "no verdict",
        };
        ledger.append(gate::ledger::Entry { state: state.to_owned(), ..entry })?;
        let (corpus, paired) = ended?;
        let report = self.report(declared, started, corpus, paired);
        super::gate_write::write(&self.out, &report)?;
        say_text!("{}", gate::text::terminal(&report, &self.out.display().to_string()));
        Ok(match gate::run::exit_code(report.verdict) {
            0 => Ended::Done,
            1 => Ended::Failed,
            _ => Ended::Inconclusive,
        })
    }

    fn nameless(&self) -> Error {
        let what = if self.args.candidate.is_none() {
            "name the planner that wants to be merged with --candidate"
        } else {
            "name the planner of today with --baseline, or store one with `cargo xtask baseline`"
        };
        Error::input(format!("the gate compares two planners that run: {what}"))
    }

    /// Fixes the encounters, the attempt and the levels; refuses what the cap can never show.
    fn declare(
        &self,
        candidate: &str,
        arms: &Arms<'_>,
        ledger: &Ledger,
        older: &[Record],
    ) -> Result<Declared, Error> {
        if candidate.starts_with("git:") {
            return Err(Error::input(format!(
                "--candidate {candidate}: the candidate is run by this build; check out that \
                 revision and name its planner, and give the other as --baseline git:REV"
            )));
        }
        let options = gate_arms::options(&self.args.candidate_options)?;
        let changes = self
            .spec
            .changes(&PlannerSpec { name: candidate.to_owned(), options: options.clone() });
        let draft = arms.plan(candidate, options, 0)?;
        let campaign_hash = gate::fresh::campaign_hash(&draft, &self.spec.table)?;
        let outside = gate_arms::outside_bytes(candidate)?;
        let hash = gate::fresh::candidate_hash(&draft, outside.as_deref())?;
        let key = FreshKey::new(&campaign_hash, &hash);
        let series = self.args.series.clone().unwrap_or_else(branch);
        let attempt = ledger.attempt(&series, &key);
        let table = &self.spec.table;
        let factors = older.iter().map(|record| match record.role {
            Role::Anchor => table.anchor_margin_factor,
            Role::Current | Role::Release => table.release_margin_factor,
        });
        let names = older.iter().map(|record| record.role.name().to_owned());
        let ratchets: Vec<(String, f64)> = names.zip(factors).collect();
        let plan = self.spec.gate_plan(&draft.strata, attempt, &ratchets)?;
        let feasibility = plan.feasibility().map_err(|e| Error::input(e.to_string()))?;
        say!(
            "gate {}: {candidate}, seed {}, attempt {attempt} of `{series}`, at most {} pairs",
            self.spec.file.name,
            key.seed(),
            feasibility.cap
        );
        say!("  {}", gate::text::expectation(&feasibility));
        let candidate = Plan { seed: record::Seed(key.seed()), ..draft };
        Ok(Declared { candidate, changes, campaign_hash, key, series, plan, feasibility })
    }

    fn entry(&self, declared: &Declared, started: &Started) -> gate::ledger::Entry {
        gate::ledger::Entry {
            previous: String::new(),
            series: declared.series.clone(),
            attempt: declared.plan.attempt,
            key: declared.key.clone(),
            campaign_hash: declared.campaign_hash.clone(),
            baseline: started.baseline_identity.asked.clone(),
            candidate: started.candidate_identity.asked.clone(),
            cap_pairs: declared.feasibility.cap,
            state: "started".to_owned(),
        }
    }

    /// Layer 1, then all others.
    fn answer(
        &self,
        declared: &Declared,
        started: &mut Started,
        threads: usize,
        interrupted: &AtomicBool,
    ) -> Result<(stats::CorpusResult, Paired), Error> {
        let folder = self.args.corpus.clone().unwrap_or_else(|| CORPUS.into());
        let corpus = gate::corpus::replay(
            &gate::corpus::read(&folder)?,
            &embedded::rules_text,
            &mut |question| started.baseline.arm.case(question),
            &mut |question| started.candidate.arm.case(question),
        )?;
        started.foretell(declared, threads)?;
        let progress = Progress::new("gate", declared.plan.cap_pairs(), self.args.quiet);
        let seen = Cell::new(0);
        let ratchets = started.ratchets.iter_mut().map(Ratchet::arm);
        let paired = PairedRun {
            gate: declared.plan.clone(),
            plan: &declared.candidate,
            events: &self.spec.events(),
            near_m: self.spec.near_m(),
            corpus: corpus.clone(),
            baseline: &mut started.baseline,
            candidate: &mut started.candidate,
            ratchets: ratchets.collect(),
            progress: &|pairs| {
                progress.add(pairs - seen.get());
                seen.set(pairs);
            },
            stop: &|| interrupted.load(Ordering::Relaxed),
        }
        .run();
        progress.end();
        paired.map(|paired| (corpus, paired))
    }

    fn report(
        &self,
        declared: Declared,
        started: Started,
        corpus: stats::CorpusResult,
        paired: Paired,
    ) -> GateReport {
        GateReport {
            schema: 1,
            verdict: paired.result.verdict,
            title: self.spec.file.title.clone(),
            campaign_hash: declared.campaign_hash,
            key: declared.key,
            series: declared.series,
            baseline: started.baseline_identity,
            candidate: started.candidate_identity,
            ratchets: started.ratchet_identities,
            false_alarm_budget: declared.plan.alpha_fail + declared.plan.alpha_absolute,
            declared: declared.plan,
            feasibility: declared.feasibility,
            result: paired.result,
            corpus,
            different: paired.different,
            ended_by_wall_clock: paired.clocked,
            new_failures: paired.new_failures,
        }
    }
}

/// Starts every process, and refuses to compare those whose numbers mean different things.
fn start(baseline: Side, candidate: Side, older: Vec<Side>) -> Result<Started, Error> {
    let (mine, theirs) = (candidate.clone(), baseline.clone());
    let (child, baseline_identity) = baseline.start()?;
    let baseline = Heard::new(child);
    let (child, candidate_identity) = candidate.start()?;
    let candidate = Heard::new(child);
    let agree = |identity: &ArmIdentity, whose: &str| {
        candidate_identity.identity.must_agree(&identity.identity, whose)
    };
    agree(&baseline_identity, "the baseline")?;
    let (mut ratchets, mut ratchet_identities) = (Vec::new(), Vec::new());
    for side in older {
        let same = if side.is(&theirs) {
            Some((baseline.echo(), &baseline_identity))
        } else if side.is(&mine) {
            Some((candidate.echo(), &candidate_identity))
        } else {
            None
        };
        if let Some((echo, identity)) = same {
            ratchet_identities.push(ArmIdentity { asked: side.asked(), ..identity.clone() });
            ratchets.push(Ratchet::Same(echo));
        } else {
            let (child, identity) = side.start()?;
            agree(&identity, &identity.asked)?;
            ratchet_identities.push(identity);
            ratchets.push(Ratchet::Own(Box::new(child)));
        }
    }
    Ok(Started {
        baseline,
        candidate,
        ratchets,
        baseline_identity,
        candidate_identity,
        ratchet_identities,
    })
}

impl Ratchet {
    fn arm(&mut self) -> &mut dyn Arm {
        match self {
            Self::Own(child) => child.as_mut(),
            Self::Same(echo) => echo,
        }
    }
}

impl Started {
    /// Runs a few pairs, and says how long the gate takes if it goes to its cap.
    fn foretell(&mut self, declared: &Declared, threads: usize) -> Result<(), Error> {
        let pairs = (TIMED_CYCLES * declared.plan.cycle()).min(declared.plan.cap_pairs());
        let ids: Vec<u64> = (0..pairs).collect();
        let stopwatch = Stopwatch::start();
        self.baseline.rows(&ids)?;
        self.candidate.rows(&ids)?;
        for ratchet in &mut self.ratchets {
            ratchet.arm().rows(&ids)?;
        }
        let pair_s = stopwatch.elapsed_s() / pairs as f64;
        let minutes = |pairs: u64| pair_s * pairs as f64 / 60.0;
        say!(
            "  about {:.1} minutes for 20000 pairs, {:.1} to the cap, on {threads} threads",
            minutes(20_000),
            minutes(declared.plan.cap_pairs())
        );
        Ok(())
    }
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
