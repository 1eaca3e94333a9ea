//! The child's side of an arm: a process that runs one planner on the places it is asked for.
//!
//! It is a process of its own because a planner that hangs, aborts or overflows its stack takes
//! its process with it, and because the planner of another commit lives in another binary.
//! Standard input: one line with the plan as JSON, then a line for each request: places, or
//! `case {question}` for a case of the corpus.
//!
//! Options that the plan does not give are those of this build: the defaults of a planner are part
//! of its sources, and a change of one is a change that the gate must see.
//!
//! Standard output, line by line: `hello {greeting}`, `b PLACE` (begins), `r {row}` (ended),
//! `e` (request done), `c [events]` (answer to a case), `x KIND message` (an error: `input` or
//! `fault`).

use crate::arm::{self, InProcess, Step};
use crate::corpus::{self, Question};
use crate::fresh;
use campaign::plan::{Build, PlannerChoice};
use campaign::worker::Shop;
use campaign::{Error, Plan, engine};
use planner_api::Registry;
use serde::{Deserialize, Serialize};
use std::io::{BufRead, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// How often the watchdog looks.
const WATCH_EVERY: Duration = Duration::from_millis(100);

/// The three hashes that must agree before two builds may be compared, and the build.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Sources that decide a number, Cargo.lock and rustc.
    pub engine: String,
    /// The resolved tables that encounters are drawn from.
    pub encounter_model: String,
    /// The rule set.
    pub rule_set: String,
    /// Sources of the planners; may differ.
    pub planners: String,
    /// Commit of the sources.
    pub git_commit: String,
}

/// What a child says first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Hello {
    pub(crate) identity: Identity,
    /// Every option of the planner that it runs.
    pub(crate) options: toml::Table,
}

impl Identity {
    /// Of a plan in a build.
    pub fn of(plan: &Plan, build: &Build) -> Result<Self, Error> {
        Ok(Self {
            engine: build.engine.clone(),
            encounter_model: fresh::encounter_model(plan)?,
            rule_set: plan.rules.hash.clone(),
            planners: build.planners.clone(),
            git_commit: build.git_commit.clone(),
        })
    }

    /// Refuses to compare across builds whose numbers mean different things.
    pub fn must_agree(&self, other: &Self, whose: &str) -> Result<(), Error> {
        for (name, mine, theirs) in [
            ("engine", &self.engine, &other.engine),
            ("encounter_model", &self.encounter_model, &other.encounter_model),
            ("rule_set", &self.rule_set, &other.rule_set),
        ] {
            if mine != theirs {
                return Err(Error::input(format!(
                    "{whose} has another `{name}` ({} there, {} here): the two cannot be compared; \
                     take one of the same {name}",
                    short(theirs),
                    short(mine)
                )));
            }
        }
        Ok(())
    }
}

fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// Serves requests until standard input ends. `registry` makes the planner that the plan names.
pub fn serve(
    threads: usize,
    build: &Build,
    registry: impl FnOnce(&str) -> Result<Registry, Error>,
) -> Result<(), Error> {
    let ended = answer(threads, build, registry);
    if let Err(error) = &ended {
        let (kind, message) = match error {
            Error::Input(message) | Error::Incomplete(message) => ("input", message.clone()),
            Error::Fault(message) => ("fault", message.clone()),
            io @ (Error::Io { .. } | Error::Stage { .. }) => ("fault", io.to_string()),
        };
        say(&format!("x {kind} {}", message.replace('\n', " ")));
    }
    ended
}

fn answer(
    threads: usize,
    build: &Build,
    registry: impl FnOnce(&str) -> Result<Registry, Error>,
) -> Result<(), Error> {
    let mut lines = std::io::stdin().lock().lines();
    let mut line = || lines.next().and_then(Result::ok);
    let Some(first) = line() else { return Ok(()) };
    let mut plan: Plan = serde_json::from_str(&first)
        .map_err(|e| Error::input(format!("this build cannot read the plan: {e}")))?;
    plan.build = build.clone();
    let registry = registry(&plan.planner.name)?;
    plan.planner.options = whole_options(&plan.planner, &registry)?;
    let shop = Shop::new(&plan, &registry)?;
    let beats = arm::beats(threads);
    let mut arm = InProcess::new(&shop, &plan, &beats)?;
    let identity = Identity::of(&plan, build)?;
    let hello = Hello { identity, options: plan.planner.options.clone() };
    let hello = serde_json::to_string(&hello);
    say(&format!("hello {}", hello.map_err(|e| Error::Fault(e.to_string()))?));
    let limit_s = plan.run.planner_hang_limit_s;
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| watch(&beats, limit_s, &stop));
        let mut ended = Ok(());
        while let Some(request) = line() {
            if let Some(question) = request.strip_prefix("case ") {
                ended = case(question, &plan, &registry, &beats[0]);
                if ended.is_err() {
                    break;
                }
                continue;
            }
            let ids: Result<Vec<u64>, _> = request.split_whitespace().map(str::parse).collect();
            ended = match ids {
                Ok(ids) => arm.rows_telling(&ids, &tell).map(drop),
                Err(_) => Err(Error::Fault(format!("`{request}` is no list of places"))),
            };
            if ended.is_err() {
                break;
            }
            say("e");
        }
        stop.store(true, Ordering::Relaxed);
        ended
    })
}

/// The plan's options over the defaults of this build's planner.
fn whole_options(planner: &PlannerChoice, registry: &Registry) -> Result<toml::Table, Error> {
    let input = |e: &dyn std::fmt::Display| Error::input(e.to_string());
    let entry = registry.get(&planner.name).map_err(|e| input(&e))?;
    entry.resolve(&planner.options).map_err(|e| input(&e))
}

/// One case of the corpus, with a planner made anew.
fn case(json: &str, plan: &Plan, registry: &Registry, beat: &AtomicU64) -> Result<(), Error> {
    let question: Question =
        serde_json::from_str(json).map_err(|e| Error::input(format!("a case: {e}")))?;
    let planner = (plan.planner.name.as_str(), &plan.planner.options);
    let had = corpus::events(&question, registry, planner, beat)?;
    let had = serde_json::to_string(&had).map_err(|e| Error::Fault(e.to_string()))?;
    say(&format!("c {had}"));
    Ok(())
}

fn tell(step: Step<'_>) {
    match step {
        Step::Begins(id) => say(&format!("b {id}")),
        Step::Ended(row) => match serde_json::to_string(row) {
            Ok(row) => say(&format!("r {row}")),
            Err(error) => say(&format!("x fault {error}")),
        },
    }
}

/// A parent that no longer listens is gone; standard input ends then.
fn say(line: &str) {
    let mut out = std::io::stdout().lock();
    drop(writeln!(out, "{line}").and_then(|()| out.flush()));
}

/// Ends the process when a planner call lasts too long: a thread cannot be killed.
fn watch(beats: &[AtomicU64], limit_s: f64, stop: &AtomicBool) {
    let looks_max = (limit_s / WATCH_EVERY.as_secs_f64()).ceil() as u64;
    let mut seen: Vec<(u64, u64)> = vec![(0, 0); beats.len()];
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(WATCH_EVERY);
        for (beat, (before, looks)) in beats.iter().zip(&mut seen) {
            let now = beat.load(Ordering::Relaxed);
            // odd while the planner thinks
            *looks = if now % 2 == 1 && now == *before { *looks + 1 } else { 0 };
            *before = now;
            if *looks >= looks_max {
                std::process::exit(i32::from(engine::EXIT_HUNG));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A default that differs between two commits is what a gate between them must see.
    #[test]
    fn an_option_that_is_not_given_has_the_default_of_the_build_that_runs() {
        let registry = planners::registry();
        let entry = registry.get("zhuang").unwrap();
        let (key, value) = entry.options.iter().next().unwrap();
        let choice = |options: toml::Table| PlannerChoice {
            name: "zhuang".into(),
            options,
            files_sha256: std::collections::BTreeMap::new(),
        };
        assert_eq!(whole_options(&choice(toml::Table::new()), &registry).unwrap(), entry.options);
        let given = toml::Table::from_iter([(key.clone(), toml::Value::from("given"))]);
        let whole = whole_options(&choice(given), &registry).unwrap();
        assert_eq!(whole.len(), entry.options.len());
        assert_eq!(whole[key].as_str(), Some("given"));
        assert_ne!(whole[key], *value);
        let unknown = toml::Table::from_iter([("no_such".to_owned(), toml::Value::from(1))]);
        let refused = whole_options(&choice(unknown), &registry).unwrap_err().to_string();
        assert!(refused.contains("no_such"), "{refused}");
    }

    #[test]
    fn builds_that_differ_in_one_hash_are_refused_by_its_name_and_planners_may_differ() {
        let mine = Identity {
            engine: "e".into(),
            encounter_model: "m".into(),
            rule_set: "r".into(),
            planners: "p".into(),
            git_commit: "c".into(),
        };
        let other = Identity { planners: "q".into(), git_commit: "d".into(), ..mine.clone() };
        assert!(mine.must_agree(&other, "the baseline").is_ok());
        for (name, other) in [
            ("engine", Identity { engine: "x".into(), ..mine.clone() }),
            ("encounter_model", Identity { encounter_model: "x".into(), ..mine.clone() }),
            ("rule_set", Identity { rule_set: "x".into(), ..mine.clone() }),
        ] {
            let refused = mine.must_agree(&other, "the anchor").unwrap_err().to_string();
            let says = format!("the anchor has another `{name}` (x there");
            assert!(refused.starts_with(&says), "{refused}");
        }
    }
}
