//! The supervisor: keeps an engine process going until every part is there.
//!
//! A thread cannot be killed and a pool waits for it, so a planner that hangs, aborts or overflows
//! its stack costs its process. When the engine dies, the supervisor runs each encounter that was
//! in flight alone, notes the guilty, and starts the engine again; the guilty encounter then gets
//! a row made from its id and outcome alone.

use crate::engine::{EXIT_HUNG, FAREWELL};
use crate::inflight::{InFlight, Suspect};
use crate::part::PartKey;
use crate::{Error, Folder, Plan};
use planner_host::tail::Tail;
use record::Outcome;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::process::ExitStatusExt as _;
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::Duration;

/// Engines that die without anybody being guilty, before the harness itself is suspected.
const UNEXPLAINED_DEATHS_MAX: u32 = 3;

/// How a campaign is taken up again.
pub const GO_ON: &str = "go on with the same command and --resume";

/// How often a running process is looked at.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// An encounter that takes its process with it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lost {
    /// Index of the stratum.
    pub stratum: u32,
    /// Which draw.
    pub j: u64,
    /// How the process ended.
    pub outcome: Outcome,
    /// The same in words, and the last lines it said.
    pub detail: String,
}

/// How to start an engine process of this binary, and whom to tell of progress.
pub struct Supervisor<'a> {
    /// The binary.
    pub program: PathBuf,
    /// Worker threads.
    pub threads: usize,
    /// Set when the user wants to stop.
    pub interrupted: &'a AtomicBool,
    /// Told of encounters as they are done.
    pub progress: &'a (dyn Fn(u64) + Sync),
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
        while keys.iter().any(|&key| !is_there(folder, key)) {
            self.stop_if_interrupted(folder)?;
            let (ended, of_its_own) = self.run_engine(folder, keys)?;
            self.stop_if_interrupted(folder)?;
            match ended.code() {
                Some(0) if of_its_own => continue,
                Some(code @ 2..=4) if of_its_own => return Err(engine_error(folder, code)),
                _ => {}
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

    /// How an engine ended, and whether of its own will.
    fn run_engine(&self, folder: &Folder, keys: &[PartKey]) -> Result<(ExitStatus, bool), Error> {
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
        let lines = child.stdout.take();
        std::thread::scope(|scope| {
            let listener = scope.spawn(|| self.listen(lines));
            let ended = self.wait(&mut child)?;
            Ok((ended, listener.join().unwrap_or(false)))
        })
    }

    /// Reads the engine's lines until it closes them; whether it said that it ends. Libraries may
    /// write lines of their own between them.
    fn listen(&self, lines: Option<ChildStdout>) -> bool {
        let mut of_its_own = false;
        for line in lines.into_iter().flat_map(|l| BufReader::new(l).lines()).map_while(Result::ok)
        {
            of_its_own |= line == FAREWELL;
            let part = line.strip_prefix("part ").and_then(|part| part.rsplit(' ').next());
            (self.progress)(part.and_then(|rows| rows.parse().ok()).unwrap_or(0));
        }
        of_its_own
    }

    /// Waits for a process, or ends it when the user wants to stop. Its parts are whole files, so
    /// nothing is lost but what was in flight; and it may be in the middle of a call that takes
    /// its time, or does not return.
    fn wait(&self, child: &mut Child) -> Result<ExitStatus, Error> {
        loop {
            if let Some(ended) = child.try_wait().map_err(Error::io("wait for", &self.program))? {
                return Ok(ended);
            }
            if self.interrupted.load(Ordering::Relaxed) {
                drop(child.kill());
            }
            std::thread::sleep(LOOK_EVERY);
        }
    }

    /// Runs each suspect alone.
    fn find_guilty(&self, plan: &Plan, folder: &Folder) -> Result<Vec<Lost>, Error> {
        let mut guilty = Vec::new();
        for (stratum, j) in InFlight::suspects(&folder.inflight())? {
            self.stop_if_interrupted(folder)?;
            let limit_s = plan.run.planner_hang_limit_s;
            if let Some((outcome, detail)) = self.trial(folder, (stratum, j), limit_s)? {
                assert!((stratum as usize) < plan.strata.len(), "slot names stratum {stratum}");
                guilty.push(Lost { stratum, j, outcome, detail });
            }
        }
        Ok(guilty)
    }

    /// How an encounter ends that is run alone in a process of its own, in words too; `None` where
    /// the process does not end with it. `folder` has the plan and is not finished.
    ///
    /// # Errors
    /// `Incomplete` when the user stopped it; the engine's own errors.
    pub fn trial(
        &self,
        folder: &Folder,
        (stratum, j): Suspect,
        limit_s: f64,
    ) -> Result<Option<(Outcome, String)>, Error> {
        let mut child = self
            .engine(folder)
            .arg("--suspect")
            .arg(format!("{stratum}/{j}"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(Error::io("start", &self.program))?;
        let farewell = child.stdout.take().map(last_words);
        let said = child.stderr.take().map(last_words);
        let ended = self.wait(&mut child)?;
        // killed because the user wants to stop, it is no proof against the planner
        self.stop_if_interrupted(folder)?;
        let hear = |words: Option<mpsc::Receiver<String>>| {
            words.and_then(|words| words.recv_timeout(LAST_WORDS).ok()).unwrap_or_default()
        };
        let of_its_own = hear(farewell).contains(FAREWELL);
        let said = || hear(said);
        Ok(match ended.code() {
            Some(0) if of_its_own => None,
            Some(code) if code == i32::from(EXIT_HUNG) => {
                let how = format!("no answer within {limit_s} s");
                Some((Outcome::PlannerHung, how + &said()))
            }
            Some(code @ 2..=4) if of_its_own => return Err(engine_error(folder, code)),
            _ => {
                let how = format!("it ended its process ({})", shown(ended));
                Some((Outcome::PlannerCrashed, how + &said()))
            }
        })
    }

    fn stop_if_interrupted(&self, folder: &Folder) -> Result<(), Error> {
        if self.interrupted.load(Ordering::Relaxed) {
            return Err(Error::stopped(folder.path(), GO_ON));
        }
        Ok(())
    }
}

/// The engine has said on standard error what is wrong; here it only gets its exit code.
fn engine_error(folder: &Folder, code: i32) -> Error {
    let what = "the engine process stopped, see the message above";
    match code {
        2 => Error::input(what),
        3 => Error::Incomplete(format!(
            "{what}; what was done is kept in {}; when it is mended, go on with the same command \
             and --resume",
            folder.path().display()
        )),
        _ => Error::Fault(what.to_owned()),
    }
}

/// How long to wait for the end of standard error once the process has ended: what the planner has
/// started may hold it open.
const LAST_WORDS: Duration = Duration::from_millis(300);

/// The last lines of a stream, once it has ended.
fn last_words(mut stream: impl Read + Send + 'static) -> mpsc::Receiver<String> {
    let (tell, hear) = mpsc::channel();
    std::thread::spawn(move || {
        let (mut tail, mut chunk) = (Tail::default(), vec![0; 1 << 14]);
        while let Ok(count @ 1..) = stream.read(&mut chunk) {
            tail.push(&chunk[..count]);
        }
        // nobody listens any more where the stream outlived the process
        drop(tell.send(without_thread_numbers(&tail.said())));
    });
    hear
}

/// `thread 'main' (4711) has overflowed its stack` without the number, which differs in every run
/// and would make two tables differ.
fn without_thread_numbers(text: &str) -> String {
    let mut parts = text.split("' (");
    let mut clean = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(')') {
            Some((number, rest)) if number.bytes().all(|c| c.is_ascii_digit()) => {
                clean.push('\'');
                clean.push_str(rest);
            }
            _ => {
                clean.push_str("' (");
                clean.push_str(part);
            }
        }
    }
    clean
}

/// Without whether a core was dumped, which is a setting of the machine.
fn shown(ended: ExitStatus) -> String {
    let status = ended.signal().map_or(ended, ExitStatus::from_raw);
    status.to_string()
}

/// Whether a part is there, whole.
pub fn is_there(folder: &Folder, key: PartKey) -> bool {
    folder.parts().join(key.file_name()).exists()
}

/// Encounters of these parts, and how many of them are there already.
pub fn encounters(plan: &Plan, folder: &Folder, keys: &[PartKey]) -> (u64, u64) {
    let rows = |key: &PartKey| {
        let range = key.range(plan.encounters_per_stratum);
        range.end - range.start
    };
    let done = keys.iter().filter(|&&key| is_there(folder, key)).map(rows).sum();
    (keys.iter().map(rows).sum(), done)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A table must not depend on numbers of threads or on whether the machine keeps cores.
    #[test]
    fn what_a_lost_process_said_is_the_same_in_every_run() {
        let said = "thread 'main' (4711) has overflowed its stack\nf('a' (b) 'c' (12)";
        let clean = "thread 'main' has overflowed its stack\nf('a' (b) 'c'";
        assert_eq!(without_thread_numbers(said), clean);
        assert_eq!(without_thread_numbers("nothing"), "nothing");
        let with_core = ExitStatus::from_raw(11 | 0x80);
        assert_eq!(shown(with_core), "signal: 11 (SIGSEGV)");
        assert_eq!(shown(ExitStatus::from_raw(3 << 8)), "exit status: 3");
    }
}
