//! Wall-clock and host facts: for `timing.json` alone. Nothing hashes it, no report reads it.

use serde::Serialize;
use std::collections::BTreeMap;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Seconds of each stage, measured as they pass.
#[derive(Debug)]
pub(crate) struct Stopwatch {
    started: Instant,
    last: Instant,
    stages_s: BTreeMap<&'static str, f64>,
}

#[derive(Serialize)]
struct Timing<'a> {
    schema: u32,
    finished_unix_s: u64,
    wall_s: f64,
    stages_s: &'a BTreeMap<&'static str, f64>,
    threads: usize,
    processors: usize,
    encounters: u64,
    encounters_per_s: f64,
    os: &'static str,
    architecture: &'static str,
}

#[expect(clippy::disallowed_methods, reason = "timing.json is where wall-clock facts belong")]
fn now() -> Instant {
    Instant::now()
}

impl Stopwatch {
    /// Starts.
    pub(crate) fn start() -> Self {
        Self { started: now(), last: now(), stages_s: BTreeMap::new() }
    }

    /// Seconds since the start.
    pub(crate) fn elapsed_s(&self) -> f64 {
        (now() - self.started).as_secs_f64()
    }

    /// Ends a stage.
    pub(crate) fn lap(&mut self, stage: &'static str) {
        let at = now();
        self.stages_s.insert(stage, (at - self.last).as_secs_f64());
        self.last = at;
    }

    /// `timing.json`.
    pub(crate) fn json(&self, threads: usize, encounters: u64) -> String {
        #[expect(clippy::disallowed_methods, reason = "timing.json says when it was written")]
        let finished = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let run_s = self.stages_s.get("run").copied().unwrap_or(0.0);
        let timing = Timing {
            schema: 1,
            finished_unix_s: finished.as_secs(),
            wall_s: (self.last - self.started).as_secs_f64(),
            stages_s: &self.stages_s,
            threads,
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            encounters,
            encounters_per_s: if run_s > 0.0 { encounters as f64 / run_s } else { 0.0 },
            os: std::env::consts::OS,
            architecture: std::env::consts::ARCH,
        };
        let mut text = serde_json::to_string_pretty(&timing).unwrap_or_default();
        text.push('\n');
        text
    }
}
