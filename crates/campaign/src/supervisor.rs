//! The supervisor: keeps an engine process going until every part is there.
//!
//! A thread cannot be killed and a pool waits for it, so a planner that hangs, aborts or overflows
//! its stack costs its process. When the engine dies, the supervisor runs each encounter that was
//! in flight alone, notes the guilty, and starts the engine again; the guilty encounter then gets
//! a row made from its id and outcome alone.

use crate::engine::EXIT_HUNG;
use crate::inflight::{InFlight, Suspect};
use crate::part::{PART_ENCOUNTERS, PartKey};
use crate::{Error, Folder, Plan};
use record::Outcome;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

/// Engines that die without anybody being guilty, before the harness itself is suspected.
const UNEXPLAINED_DEATHS_MAX: u32 = 3;

/// An encounter that takes its process with it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lost {
    /// Index of the stratum.
    pub stratum: u32,
    /// Which draw.
    pub j: u64,
    /// How the process ended.
    pub outcome: Outcome,
}

/// How to start an engine process of this binary, and whom to tell of progress.
pub struct Supervisor<'a> {
    /// The binary.
    pub program: PathBuf,
    /// Worker threads.
    pub threads: usize,
    /// Set when the user wants to stop.
    pub interrupted: &'a AtomicBool,
    /// Told of encounters done, those of earlier parts first.
    pub progress: &'a dyn Fn(u64),
}

impl std::fmt::Debug for Supervisor<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Supervisor").field("program", &self.program).finish_non_exhaustive()
    }
}

impl Supervisor<'_> {
    /// Runs every missing part among `keys`.
    ///
    /// # Errors
    /// `Incomplete` when the user stopped it; the parts so far stay.
    pub fn run(&self, plan: &Plan, folder: &Folder, keys: &[PartKey]) -> Result<(), Error> {
        let mut unexplained = 0;
        let done: u64 =
            keys.iter().filter(|&&key| is_there(folder, key)).map(|&key| rows_of(plan, key)).sum();
        (self.progress)(done);
        while keys.iter().any(|&key| !is_there(folder, key)) {
            self.stop_if_interrupted(folder)?;
            let ended = self.run_engine(folder, keys)?;
            self.stop_if_interrupted(folder)?;
            if ended.success() {
                continue;
            }
            if let Some(code @ 2..=4) = ended.code() {
                return Err(self.engine_error(code));
            }
            let guilty = self.find_guilty(plan, folder)?;
            if guilty.is_empty() {
                unexplained += 1;
                if unexplained >= UNEXPLAINED_DEATHS_MAX {
                    return Err(Error::Fault(format!(
                        "the engine process died {unexplained} times ({ended}) and no encounter \
                         in flight ends it when run alone; is there enough memory?"
                    )));
                }
            }
            for lost in guilty {
                note_lost(folder, &lost)?;
            }
        }
        Ok(())
    }

    fn engine(&self, folder: &Folder) -> Command {
        let mut command = Command::new(&self.program);
        command.arg("engine").arg(folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
        command
    }

    fn run_engine(&self, folder: &Folder, keys: &[PartKey]) -> Result<ExitStatus, Error> {
        let list = folder.path().join("state").join("keys.json");
        let missing: Vec<PartKey> =
            keys.iter().copied().filter(|&key| !is_there(folder, key)).collect();
        let text = serde_json::to_vec(&missing)
            .map_err(|e| Error::Fault(format!("failed to encode the list of parts: {e}")))?;
        crate::part::write_whole(&list, &text).map_err(Error::io("write", &list))?;
        let mut child = self
            .engine(folder)
            .arg("--threads")
            .arg(self.threads.to_string())
            .spawn()
            .map_err(Error::io("start", &self.program))?;
        self.listen(&mut child);
        child.wait().map_err(Error::io("wait for", &self.program))
    }

    /// Reads the engine's lines until it closes them.
    fn listen(&self, child: &mut Child) {
        let Some(stdout) = child.stdout.take() else { return };
        for line in BufReader::new(stdout).lines().map_while(Result::ok) {
            let rows = line.rsplit(' ').next().and_then(|n| n.parse().ok()).unwrap_or(0);
            (self.progress)(rows);
            if self.interrupted.load(Ordering::Relaxed) {
                // its parts are whole files: nothing is lost but what was in flight
                drop(child.kill());
            }
        }
    }

    /// Runs each suspect alone.
    fn find_guilty(&self, plan: &Plan, folder: &Folder) -> Result<Vec<Lost>, Error> {
        let mut guilty = Vec::new();
        for (stratum, j) in InFlight::suspects(&folder.inflight())? {
            self.stop_if_interrupted(folder)?;
            if let Some(outcome) = self.trial(folder, (stratum, j))? {
                assert!((stratum as usize) < plan.strata.len(), "slot names stratum {stratum}");
                guilty.push(Lost { stratum, j, outcome });
            }
        }
        Ok(guilty)
    }

    fn trial(&self, folder: &Folder, (stratum, j): Suspect) -> Result<Option<Outcome>, Error> {
        let ended = self
            .engine(folder)
            .arg("--suspect")
            .arg(format!("{stratum}/{j}"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .and_then(|mut child| {
                // `wait` closes the child's standard input, which tells it that we are gone
                let open = child.stdin.take();
                let ended = child.wait();
                drop(open);
                ended
            })
            .map_err(Error::io("start", &self.program))?;
        Ok(match ended.code() {
            Some(0) => None,
            Some(code) if code == i32::from(EXIT_HUNG) => Some(Outcome::PlannerHung),
            Some(code @ 2..=4) => return Err(self.engine_error(code)),
            _ => Some(Outcome::PlannerCrashed),
        })
    }

    /// The engine has said on standard error what is wrong; here it only gets its exit code.
    fn engine_error(&self, code: i32) -> Error {
        let what = "the engine process stopped, see the message above".to_owned();
        match code {
            2 => Error::Input(what),
            3 => Error::Incomplete(what),
            _ => Error::Fault(what),
        }
    }

    fn stop_if_interrupted(&self, folder: &Folder) -> Result<(), Error> {
        if self.interrupted.load(Ordering::Relaxed) {
            return Err(Error::Incomplete(format!(
                "stopped; what was done is kept in {}; go on with the same command and --resume",
                folder.path().display()
            )));
        }
        Ok(())
    }
}

/// Whether a part is there, whole.
pub fn is_there(folder: &Folder, key: PartKey) -> bool {
    folder.parts().join(key.file_name()).exists()
}

fn rows_of(plan: &Plan, key: PartKey) -> u64 {
    let range = key.range(plan.encounters_per_stratum);
    debug_assert!(range.end - range.start <= PART_ENCOUNTERS);
    range.end - range.start
}

/// The encounters known to take their process with them.
pub fn read_lost(folder: &Folder) -> Result<Vec<Lost>, Error> {
    let path = folder.lost();
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
    // a line that a kill cut short is noted again when its encounter is met again
    Ok(text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect())
}

fn note_lost(folder: &Folder, lost: &Lost) -> Result<(), Error> {
    let path = folder.lost();
    let line = serde_json::to_string(lost)
        .map_err(|e| Error::Fault(format!("failed to encode a lost encounter: {e}")))?;
    fs::OpenOptions::new()
        .create(true)
        .append(true)
        .open(&path)
        .and_then(|mut file| file.write_all(format!("{line}\n").as_bytes()))
        .map_err(Error::io("write", &path))
}
