//! The parent's side of an arm in a process of its own; `serve` is the other side.
//!
//! When the process ends in the middle of a request, the encounters that were in flight are run
//! alone in a fresh process: the one that ends it again is a lost run, whatever the others did.

use crate::Event;
use crate::arm::{self, Arm, ArmRow};
use crate::corpus::Question;
use crate::serve::{Hello, Identity};
use campaign::{Error, Plan, engine};
use record::Outcome;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{ChildStdin, ChildStdout, Command, Stdio};

/// How to start the process.
#[derive(Clone, Debug)]
pub struct Launch {
    /// The binary.
    pub program: PathBuf,
    /// The word that makes it serve, and what comes with it but the number of threads.
    pub arguments: Vec<String>,
    /// Worker threads.
    pub threads: usize,
}

/// An arm in a process of its own.
#[derive(Debug)]
pub struct Child {
    launch: Launch,
    plan: Plan,
    hello: Option<Hello>,
    process: Option<Process>,
}

#[derive(Debug)]
struct Process {
    child: std::process::Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

/// How a request ended.
enum Ended {
    Whole,
    /// The process is gone, with these in flight.
    Lost(Outcome, BTreeSet<u64>),
}

impl Child {
    /// Starts the process; it has said who it is when this returns.
    pub fn start(launch: Launch, plan: Plan) -> Result<Self, Error> {
        let mut child = Self { launch, plan, hello: None, process: None };
        child.ensure()?;
        Ok(child)
    }

    /// Who the process said it is.
    pub fn identity(&self) -> &Identity {
        &self.hello().identity
    }

    /// Every option of the planner that the process runs.
    pub fn options(&self) -> &toml::Table {
        &self.hello().options
    }

    fn hello(&self) -> &Hello {
        self.hello.as_ref().expect("a started child has said who it is")
    }

    fn ensure(&mut self) -> Result<(), Error> {
        if self.process.is_some() {
            return Ok(());
        }
        let name = self.launch.program.display().to_string();
        let mut child = Command::new(&self.launch.program)
            .args(&self.launch.arguments)
            .args(["--threads", &self.launch.threads.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(Error::io("start", &self.launch.program))?;
        let (Some(mut input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Error::Fault("a process without pipes".to_owned()));
        };
        let mut output = BufReader::new(output);
        let plan = serde_json::to_string(&self.plan).map_err(|e| Error::Fault(e.to_string()))?;
        // a process that refuses is heard below
        drop(writeln!(input, "{plan}").and_then(|()| input.flush()));
        let mut line = String::new();
        let read = output.read_line(&mut line).map_err(Error::io("read", &self.launch.program))?;
        let said = line.trim();
        if let Some(error) = said.strip_prefix("x ") {
            return Err(refusal(error));
        }
        let hello = said.strip_prefix("hello ").and_then(|json| serde_json::from_str(json).ok());
        let Some(hello) = hello else {
            drop(child.wait());
            return Err(Error::input(if read == 0 {
                format!("{name} cannot serve as an arm of the gate (older than the gate?)")
            } else {
                format!("{name} is no arm of the gate: it said `{said}`")
            }));
        };
        if self.hello.as_ref().is_some_and(|before| *before != hello) {
            return Err(Error::Fault(format!("{name} became another build while the gate ran")));
        }
        self.hello = Some(hello);
        self.process = Some(Process { child, input: Some(input), output });
        Ok(())
    }

    /// One request; rows are added as they come.
    fn ask(&mut self, ids: &[u64], rows: &mut BTreeMap<u64, ArmRow>) -> Result<Ended, Error> {
        self.ensure()?;
        let process = self.process.as_mut().expect("ensured above");
        let request: Vec<String> = ids.iter().map(u64::to_string).collect();
        if let Some(input) = &mut process.input {
            // a process that is gone is noticed below
            drop(writeln!(input, "{}", request.join(" ")).and_then(|()| input.flush()));
        }
        let mut inflight = BTreeSet::new();
        let mut line = String::new();
        loop {
            line.clear();
            let read = process.output.read_line(&mut line).unwrap_or(0);
            if read == 0 || !line.ends_with('\n') {
                break;
            }
            let said = line.trim_end();
            match said.split_once(' ') {
                None if said == "e" => return Ok(Ended::Whole),
                Some(("b", id)) => {
                    inflight.insert(id.parse().map_err(|_| garbled(said))?);
                }
                Some(("r", row)) => {
                    let row: ArmRow = serde_json::from_str(row).map_err(|_| garbled(said))?;
                    inflight.remove(&row.id);
                    rows.insert(row.id, row);
                }
                Some(("x", error)) => return Err(refusal(error)),
                _ => return Err(garbled(said)),
            }
        }
        let status = process.child.wait().map_err(|e| Error::Fault(e.to_string()))?;
        self.process = None;
        let hung = status.code() == Some(i32::from(engine::EXIT_HUNG));
        let outcome = if hung { Outcome::PlannerHung } else { Outcome::PlannerCrashed };
        Ok(Ended::Lost(outcome, inflight))
    }

    /// A case of the corpus; none when the planner took its process with it.
    pub fn case(&mut self, question: &Question) -> Result<Option<Vec<Event>>, Error> {
        self.ensure()?;
        let process = self.process.as_mut().expect("ensured above");
        let json = serde_json::to_string(question).map_err(|e| Error::Fault(e.to_string()))?;
        if let Some(input) = &mut process.input {
            drop(writeln!(input, "case {json}").and_then(|()| input.flush()));
        }
        let mut line = String::new();
        if process.output.read_line(&mut line).unwrap_or(0) == 0 {
            drop(process.child.wait());
            self.process = None;
            return Ok(None);
        }
        let said = line.trim_end();
        match said.split_once(' ') {
            Some(("c", events)) => {
                serde_json::from_str(events).map(Some).map_err(|_| garbled(said))
            }
            Some(("x", error)) => Err(refusal(error)),
            _ => Err(garbled(said)),
        }
    }

    /// Runs the encounters that were in flight alone.
    fn suspects(
        &mut self,
        suspects: BTreeSet<u64>,
        rows: &mut BTreeMap<u64, ArmRow>,
    ) -> Result<(), Error> {
        if suspects.is_empty() {
            return Err(Error::Fault(
                "an arm of the gate ended while no encounter was running".to_owned(),
            ));
        }
        for id in suspects {
            if let Ended::Lost(outcome, _) = self.ask(&[id], rows)? {
                let encounter = arm::encounter_id(&self.plan, id);
                rows.insert(id, ArmRow::lost(id, &encounter, outcome));
            }
        }
        Ok(())
    }
}

fn refusal(error: &str) -> Error {
    match error.split_once(' ') {
        Some(("input", message)) => Error::input(message),
        Some((_, message)) => Error::Fault(message.to_owned()),
        None => garbled(error),
    }
}

fn garbled(said: &str) -> Error {
    Error::Fault(format!("an arm of the gate said `{said}`"))
}

impl Arm for Child {
    fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
        let mut rows = BTreeMap::new();
        loop {
            let missing: Vec<u64> =
                ids.iter().copied().filter(|id| !rows.contains_key(id)).collect();
            if missing.is_empty() {
                return Ok(rows.into_values().collect());
            }
            if let Ended::Lost(_, suspects) = self.ask(&missing, &mut rows)? {
                self.suspects(suspects, &mut rows)?;
            }
        }
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        if let Some(mut process) = self.process.take() {
            // its standard input ends, and it with it
            drop(process.input.take());
            drop(process.child.wait());
        }
    }
}
