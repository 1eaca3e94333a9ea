//! A planner's process: limits, one line out for one line in, and the end of its whole group.
//!
//! Nothing here trusts the process. Its pipes never block the bench, standard error is emptied
//! while an answer is awaited, an answer has a limit in time and in bytes, and whatever the process
//! started dies with it. A process that moves to a session of its own escapes the last of these.
#![expect(
    unsafe_code,
    reason = "limits, waiting and the end of a process group have no safe form in std"
)]

use crate::tail::Tail;
use std::io::{ErrorKind, Read, Write};
use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::process::CommandExt as _;
use std::process::{ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// How long one wait lasts before the process is looked after: a grandchild may hold the pipes of a
/// process that is dead.
const WATCH: Duration = Duration::from_millis(20);
/// How long a process may take to end once its input is closed.
const FAREWELL: Duration = Duration::from_millis(300);
/// How long a process may live on after it has closed its output.
const CLOSED: Duration = Duration::from_millis(200);
const CHUNK_BYTES: usize = 1 << 16;

/// What a planner's process may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Longest time for one answer, on the wall clock.
    pub(crate) call: Duration,
    /// Longest time from the start to the answer to `hello`.
    pub(crate) start: Duration,
    /// Largest address space, bytes.
    pub(crate) memory_bytes: u64,
    /// Longest answer, bytes.
    pub(crate) output_bytes: usize,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Trouble {
    /// The process ended, or closed its pipes.
    #[error("its process ended ({0})")]
    Ended(String),
    /// No whole line within the limit.
    #[error("no answer within {limit_s} s{}", if *.half_a_line { ", but half a line" } else { "" })]
    Silent {
        /// The limit.
        limit_s: f64,
        /// Whether a line had begun.
        half_a_line: bool,
    },
    /// A line without end.
    #[error("more than {0} bytes without the end of a line")]
    Flooded(usize),
}

/// A running process.
#[derive(Debug)]
pub(crate) struct Child {
    process: std::process::Child,
    input: Option<ChildStdin>,
    output: ChildStdout,
    error: Option<ChildStderr>,
    unread: Vec<u8>,
    chunk: Vec<u8>,
    tail: Tail,
    reaped: bool,
}

impl Child {
    /// Starts `argv` in a process group of its own.
    pub(crate) fn start(argv: &[String], limits: Limits) -> std::io::Result<Self> {
        let (program, arguments) = argv.split_first().ok_or(ErrorKind::InvalidInput)?;
        let mut command = Command::new(program);
        command.args(arguments).process_group(0);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Sums of several threads and sets of hashed strings would differ between two runs.
        for (name, value) in [
            ("OMP_NUM_THREADS", "1"),
            ("OPENBLAS_NUM_THREADS", "1"),
            ("MKL_NUM_THREADS", "1"),
            ("PYTHONHASHSEED", "0"),
        ] {
            command.env(name, value);
        }
        // SAFETY: the closure runs between fork and exec, where only async-signal-safe calls are
        // allowed; setrlimit is one, and what it is given outlives the calls.
        unsafe {
            command.pre_exec(move || {
                let memory = limit(limits.memory_bytes);
                let no_core = limit(0);
                if libc::setrlimit(libc::RLIMIT_AS, &raw const memory) != 0
                    || libc::setrlimit(libc::RLIMIT_CORE, &raw const no_core) != 0
                {
                    return Err(std::io::Error::last_os_error());
                }
                Ok(())
            });
        }
        let mut process = command.spawn()?;
        let (input, output, error) =
            (process.stdin.take(), process.stdout.take(), process.stderr.take());
        let (Some(input), Some(output), Some(error)) = (input, output, error) else {
            unreachable!("all three pipes were asked for");
        };
        for pipe in [input.as_raw_fd(), output.as_raw_fd(), error.as_raw_fd()] {
            set_non_blocking(pipe)?;
        }
        Ok(Self {
            process,
            input: Some(input),
            output,
            error: Some(error),
            unread: Vec::new(),
            chunk: vec![0; CHUNK_BYTES],
            tail: Tail::default(),
            reaped: false,
        })
    }

    /// Sends `request`, a whole line, and puts the next line of the process into `answer`.
    pub(crate) fn exchange(
        &mut self,
        request: &[u8],
        answer: &mut String,
        limit: Duration,
        output_bytes: usize,
    ) -> Result<(), Trouble> {
        let deadline = now() + limit;
        let mut look = now() + WATCH;
        let mut unsent = self.send(request)?;
        loop {
            if unsent.is_empty() && self.take_line(answer, output_bytes)? {
                return Ok(());
            }
            let left = deadline.saturating_duration_since(now());
            if left.is_zero() {
                let half_a_line = !self.unread.is_empty();
                return Err(Trouble::Silent { limit_s: limit.as_secs_f64(), half_a_line });
            }
            let (has_output, has_error) = self.wait(!unsent.is_empty(), left.min(WATCH));
            if !unsent.is_empty() {
                unsent = self.send(unsent)?;
            }
            if has_error {
                self.read_error();
            }
            let open = !has_output || self.read_output();
            if !unsent.is_empty() && self.unread.len() > output_bytes {
                return Err(Trouble::Flooded(output_bytes));
            }
            let answered = self.unread.contains(&b'\n');
            if !open && !answered {
                return Err(Trouble::Ended(self.after_closing()));
            }
            if now() >= look {
                look = now() + WATCH;
                if !answered && self.has_exited() && !self.read_more() {
                    return Err(Trouble::Ended(self.status()));
                }
            }
        }
    }

    /// Ends a process that does not deserve a farewell.
    pub(crate) fn kill(mut self) {
        if !self.reaped {
            self.status();
        }
    }

    /// The last lines on standard error, to go behind a message.
    pub(crate) fn said(&mut self) -> String {
        for _ in 0..16 {
            self.read_error();
        }
        self.tail.said()
    }

    /// Writes what the pipe takes; the rest is returned.
    fn send<'a>(&mut self, bytes: &'a [u8]) -> Result<&'a [u8], Trouble> {
        let Some(input) = &mut self.input else { return Ok(&[]) };
        match input.write(bytes) {
            Ok(count) => Ok(&bytes[count..]),
            Err(error) if is_transient(&error) => Ok(bytes),
            Err(_) => Err(Trouble::Ended(self.after_closing())),
        }
    }

    /// Moves the first whole line from what is unread into `answer`.
    fn take_line(&mut self, answer: &mut String, output_bytes: usize) -> Result<bool, Trouble> {
        let end = self.unread.iter().position(|byte| *byte == b'\n');
        if end.unwrap_or(self.unread.len()) > output_bytes {
            return Err(Trouble::Flooded(output_bytes));
        }
        let Some(end) = end else { return Ok(false) };
        answer.clear();
        answer.push_str(&String::from_utf8_lossy(&self.unread[..end]));
        self.unread.drain(..=end);
        Ok(true)
    }

    /// Reads standard output once; false at its end.
    fn read_output(&mut self) -> bool {
        match self.output.read(&mut self.chunk) {
            Ok(0) => false,
            Ok(count) => {
                self.unread.extend_from_slice(&self.chunk[..count]);
                true
            }
            Err(error) => is_transient(&error),
        }
    }

    /// Whether a last look finds more output.
    fn read_more(&mut self) -> bool {
        let before = self.unread.len();
        self.read_output();
        self.unread.len() > before
    }

    fn read_error(&mut self) {
        let Some(error) = &mut self.error else { return };
        match error.read(&mut self.chunk) {
            Ok(0) => self.error = None,
            Ok(count) => self.tail.push(&self.chunk[..count]),
            Err(error) if is_transient(&error) => {}
            Err(_) => self.error = None,
        }
    }

    /// Sleeps until a pipe has something, at most `limit`; whether output and error have.
    fn wait(&self, unsent: bool, limit: Duration) -> (bool, bool) {
        let nobody = -1;
        let input = self.input.as_ref().filter(|_| unsent).map_or(nobody, AsRawFd::as_raw_fd);
        let error = self.error.as_ref().map_or(nobody, AsRawFd::as_raw_fd);
        let watch = |fd, events| libc::pollfd { fd, events, revents: 0 };
        let mut pipes = [
            watch(input, libc::POLLOUT),
            watch(self.output.as_raw_fd(), libc::POLLIN),
            watch(error, libc::POLLIN),
        ];
        let milliseconds = i32::try_from(limit.as_millis().max(1)).unwrap_or(i32::MAX);
        // SAFETY: the pointer and the length describe `pipes`, which outlives the call.
        unsafe { libc::poll(pipes.as_mut_ptr(), pipes.len() as libc::nfds_t, milliseconds) };
        (pipes[1].revents != 0, pipes[2].revents != 0)
    }

    /// Whether the process has ended. It is not reaped, so that its group keeps its number.
    fn has_exited(&self) -> bool {
        let mut info = std::mem::MaybeUninit::<libc::siginfo_t>::zeroed();
        let flags = libc::WEXITED | libc::WNOHANG | libc::WNOWAIT;
        // SAFETY: `info` is valid for a write, and all zeroes is a valid siginfo_t where nothing is
        // written; the process is our child and not yet reaped.
        unsafe {
            let result = libc::waitid(libc::P_PID, self.process.id(), info.as_mut_ptr(), flags);
            result == 0 && info.assume_init().si_pid() != 0
        }
    }

    /// How a process ended that closed a pipe; it is given a moment to do so.
    fn after_closing(&mut self) -> String {
        if self.wait_for_exit(CLOSED) { self.status() } else { "it closed its pipes".to_owned() }
    }

    fn wait_for_exit(&self, limit: Duration) -> bool {
        let deadline = now() + limit;
        while !self.has_exited() {
            if now() >= deadline {
                return false;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        true
    }

    /// The exit status of a process that has ended; ends its group.
    fn status(&mut self) -> String {
        self.kill_group();
        self.reaped = true;
        let half = if self.unread.is_empty() { "" } else { ", in the middle of a line" };
        match self.process.wait() {
            Ok(status) => format!("{status}{half}"),
            Err(error) => format!("no status: {error}"),
        }
    }

    /// Kills the process and all that it started. Only before it is reaped: after that the number
    /// of the group may be somebody else's.
    fn kill_group(&self) {
        if let Ok(group) = libc::pid_t::try_from(self.process.id()) {
            // SAFETY: no memory is involved; the group is that of our own child, not yet reaped.
            unsafe { libc::kill(-group, libc::SIGKILL) };
        }
    }
}

impl Drop for Child {
    /// Closes the input, which asks the process to end, and ends it.
    fn drop(&mut self) {
        self.input = None;
        if !self.reaped {
            self.wait_for_exit(FAREWELL);
            self.status();
        }
    }
}

const fn limit(most: u64) -> libc::rlimit {
    libc::rlimit { rlim_cur: most, rlim_max: most }
}

fn set_non_blocking(pipe: RawFd) -> std::io::Result<()> {
    // SAFETY: no memory is involved; the descriptor is open and ours.
    let result = unsafe {
        let flags = libc::fcntl(pipe, libc::F_GETFL);
        libc::fcntl(pipe, libc::F_SETFL, flags | libc::O_NONBLOCK)
    };
    if result == -1 { Err(std::io::Error::last_os_error()) } else { Ok(()) }
}

fn is_transient(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

#[expect(
    clippy::disallowed_methods,
    reason = "the limit of a planner's answer is on the wall clock"
)]
fn now() -> Instant {
    Instant::now()
}
