//! The planners of a gate: from a name on the command line to a process that runs.

use crate::exit::Ended;
use crate::{build, embedded};
use campaign::plan::PlannerChoice;
use campaign::{Error, Plan};
use gate::child::Launch;
use gate::spec::PlannerSpec;
use gate::{ArmIdentity, Child, GateSpec, Record};
use planner_api::Registry;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use toml::Table;

/// The word that makes this binary serve as an arm.
const ARM: &str = "gate-arm";

/// A planner with its plan and the binary that runs it.
#[derive(Clone)]
pub(super) struct Side {
    asked: String,
    plan: Plan,
    launch: Launch,
}

/// Everything that the names of planners are looked up with.
pub(super) struct Arms<'a> {
    pub(super) spec: &'a GateSpec,
    pub(super) registry: Registry,
    /// This binary, found before another is built in its place.
    pub(super) mine: Launch,
}

impl<'a> Arms<'a> {
    /// With the planners of a registry.
    pub(super) fn new(
        spec: &'a GateSpec,
        registry: Registry,
        threads: usize,
    ) -> Result<Self, Error> {
        Ok(Self { spec, registry, mine: launch(threads)? })
    }

    /// The registry with all planners from outside that are named.
    pub(super) fn with(mut self, names: &[&str]) -> Result<Self, Error> {
        for name in names {
            refuse_folder(name)?;
            if !name.starts_with("git:") && self.registry.get(name).is_err() {
                self.registry = super::with_outside(self.registry, &[(*name).to_owned()])?;
            }
        }
        Ok(self)
    }

    /// The plan of a planner on the encounters of this seed.
    pub(super) fn plan(&self, name: &str, options: Table, seed: u64) -> Result<Plan, Error> {
        let asked = PlannerSpec { name: name.to_owned(), options };
        self.spec.plan(&asked, seed, &self.registry, &embedded::rules_text, &build::build())
    }

    /// A planner of this build, or one of another commit. A commit without a planner's name has
    /// the planner that `otherwise` runs, with the options that were given for it (`changes`).
    ///
    /// Another commit is told these and no defaults of this build: it lays them over its own.
    pub(super) fn side(
        &self,
        name: &str,
        options: Table,
        otherwise: &Plan,
        changes: &Table,
    ) -> Result<Side, Error> {
        let Some(rest) = name.strip_prefix("git:") else {
            let plan = self.plan(name, options, otherwise.seed.0)?;
            return Ok(Side { asked: name.to_owned(), plan, launch: self.mine.clone() });
        };
        let (revision, planner) = rest.split_once(':').unwrap_or((rest, &otherwise.planner.name));
        if planner.starts_with("exec:") || planner.starts_with("lib:") {
            return Err(Error::input(format!(
                "{name}: `{planner}` is not built from this repository, so a revision of it says \
                 nothing of that planner; name its older file as --baseline exec:... or lib:..."
            )));
        }
        let options = if rest == revision && options.is_empty() {
            changes.clone()
        } else {
            self.spec.changes(&PlannerSpec { name: planner.to_owned(), options })
        };
        let planner =
            PlannerChoice { name: planner.to_owned(), options, files_sha256: BTreeMap::new() };
        let plan = Plan { planner, ..otherwise.clone() };
        let launch = match super::gate_git::build(revision)? {
            Some(program) => Launch { program, ..self.mine.clone() },
            None => self.mine.clone(),
        };
        Ok(Side { asked: name.to_owned(), plan, launch })
    }

    /// A stored planner. Its hashes are compared before anything is built.
    pub(super) fn stored(&self, record: &Record, otherwise: &Plan) -> Result<Side, Error> {
        let role = record.role.name();
        let mine = gate::serve::Identity::of(otherwise, &build::build())?;
        mine.must_agree(&record.identity, &format!("the stored {role}")).map_err(|e| {
            Error::input(format!("{e}, or store it anew: cargo xtask baseline --role {role}"))
        })?;
        let mut side =
            self.side(&record.named(), record.options.clone(), otherwise, &Table::new())?;
        side.asked = format!("{role} {}", record.named());
        Ok(side)
    }
}

impl Side {
    /// Of a plan in this binary.
    pub(super) fn of(asked: &str, plan: Plan, launch: Launch) -> Self {
        Self { asked: asked.to_owned(), plan, launch }
    }

    /// Starts the process, and hears who it is.
    pub(super) fn start(self) -> Result<(Child, ArmIdentity), Error> {
        let child = Child::start(self.launch, self.plan.clone())?;
        let identity = child.identity().clone();
        let mut plan = self.plan;
        plan.planner.options = child.options().clone();
        Ok((child, ArmIdentity { asked: self.asked, identity, plan }))
    }

    /// As it was named.
    pub(super) fn asked(&self) -> String {
        self.asked.clone()
    }

    /// Whether it gives the same bits as another: the same planner, run by the same binary.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.launch.program == other.launch.program && self.plan.planner == other.plan.planner
    }
}

/// This binary as an arm.
pub(super) fn launch(threads: usize) -> Result<Launch, Error> {
    let program = std::env::current_exe().map_err(Error::io("find", Path::new("seatrial")))?;
    Ok(Launch { program, arguments: vec![ARM.to_owned()], threads })
}

/// Fresh encounters need a planner that runs.
fn refuse_folder(name: &str) -> Result<(), Error> {
    if Path::new(name).is_dir() {
        return Err(Error::input(format!(
            "`{name}` is a folder; a gate runs both planners on fresh encounters, so results of \
             another run cannot take part: name a planner, git:REV, exec:... or lib:..."
        )));
    }
    Ok(())
}

/// `KEY=VALUE` in TOML's own notation, each.
pub(super) fn options(list: &[String]) -> Result<Table, Error> {
    let mut table = Table::new();
    for text in list {
        let one: Table = text.parse().map_err(|_| {
            Error::input(format!(
                "`{text}` is no option; one looks like radius_factor=0.9, or name='\"text\"'"
            ))
        })?;
        table.extend(one);
    }
    Ok(table)
}

/// What a planner from outside consists of, as far as one file tells.
pub(super) fn outside_bytes(name: &str) -> Result<Option<Vec<u8>>, Error> {
    let command = name.strip_prefix("exec:").or_else(|| name.strip_prefix("lib:"));
    let Some(command) = command else { return Ok(None) };
    // a script's interpreter comes first, so every word that is a file counts
    let mut bytes = Vec::new();
    for word in command.split_whitespace().map(PathBuf::from).filter(|word| word.is_file()) {
        bytes.extend(fs::read(&word).map_err(Error::io("read", &word))?);
    }
    Ok(Some(bytes))
}

/// The process that runs one planner for a gate.
pub(super) fn serve(threads: usize, registry: Registry) -> Result<Ended, Error> {
    campaign::engine::quiet_planner_panics();
    // Ctrl-C reaches the whole group; the gate decides when this process ends
    ctrlc::set_handler(|| {}).map_err(|e| Error::Fault(format!("failed to handle Ctrl-C: {e}")))?;
    gate::serve::serve(threads, &build::build(), |name| {
        super::with_outside(registry, &[name.to_owned()])
    })?;
    Ok(Ended::Done)
}
