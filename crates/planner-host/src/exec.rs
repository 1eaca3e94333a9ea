//! `exec:`: a planner in a process of its own.
//!
//! One process for each worker, kept alive over encounters. Any failure ends the process; the next
//! encounter meets a new one. A `reset` that fails in a process which has already served is tried
//! once more in a new one, so that what is left over from one encounter is not charged to the next.

use crate::child::{Child, Limits, Trouble};
use crate::non_finite::with_nulls;
use crate::tail::shortened;
use crate::wire::{self, Feature, Hello, HelloRequest, OrderAnswer, PROTOCOL, Ready};
use planner_api::{Command, FailureKind, Mission, Planner, PlannerFailure, Situation};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::time::Duration;

/// A planner behind a process.
#[derive(Debug)]
pub(crate) struct ExecPlanner {
    argv: Vec<String>,
    limits: Limits,
    running: Option<Running>,
    request: Vec<u8>,
    answer: String,
    tracks: Vec<wire::Track>,
}

#[derive(Debug)]
struct Running {
    child: Child,
    hello: Hello,
    seq: u64,
}

impl ExecPlanner {
    /// Nothing is started before the first `reset`.
    pub(crate) fn new(argv: Vec<String>, limits: Limits) -> Self {
        let (request, answer, tracks) = (Vec::new(), String::new(), Vec::new());
        Self { argv, limits, running: None, request, answer, tracks }
    }

    fn start(&mut self) -> Result<(), PlannerFailure> {
        let child = Child::start(&self.argv, self.limits).map_err(|error| {
            let program = self.argv.join(" ");
            failure(FailureKind::Crashed, format!("`{program}` cannot be started: {error}"))
        })?;
        let hello = Hello {
            r#type: wire::HelloTag::Hello,
            protocol: PROTOCOL,
            name: String::new(),
            version: String::new(),
            beat_s: None,
            needs: Vec::new(),
        };
        self.running = Some(Running { child, hello, seq: 0 });
        let request = HelloRequest {
            r#type: wire::HelloTag::Hello,
            protocol: PROTOCOL,
            offers: Feature::OFFERED.to_vec(),
        };
        let hello: Hello = self.exchange(&request, "hello", self.limits.start)?;
        self.accept(hello)
    }

    fn accept(&mut self, hello: Hello) -> Result<(), PlannerFailure> {
        if hello.protocol != PROTOCOL {
            let theirs = hello.protocol;
            return Err(self.broken(format!("speaks protocol {theirs}, the bench {PROTOCOL}")));
        }
        let offered = |need: &String| Feature::OFFERED.iter().any(|one| one.name() == need);
        if let Some(need) = hello.needs.iter().find(|need| !offered(need)) {
            let all: Vec<&str> = Feature::OFFERED.iter().map(|one| one.name()).collect();
            let (need, all) = (shortened(need), all.join(", "));
            return Err(self.broken(format!("needs `{need}`; the bench offers {all}")));
        }
        if let Some(running) = &mut self.running {
            running.hello = hello;
        }
        Ok(())
    }

    fn try_reset(&mut self, mission: &Mission) -> Result<(), PlannerFailure> {
        if self.running.is_none() {
            self.start()?;
        }
        let beat_s = self.running.as_ref().and_then(|running| running.hello.beat_s);
        if let Some(beat_s) = beat_s.filter(|beat_s| (beat_s - mission.beat_s).abs() > 0.0) {
            let asked_s = mission.beat_s;
            return Err(self.broken(format!("plans every {beat_s} s, the campaign {asked_s} s")));
        }
        let seq = self.next_seq();
        let request = wire::Reset {
            r#type: wire::ResetTag::Reset,
            seq,
            mission: wire::Mission::from(mission),
        };
        let ready: Ready = self.exchange(&request, "ready", self.limits.call)?;
        self.check_seq("ready", ready.seq, seq)
    }

    fn try_plan(&mut self, situation: &Situation<'_>) -> Result<Command, PlannerFailure> {
        let mut tracks = std::mem::take(&mut self.tracks);
        tracks.clear();
        tracks.extend(situation.tracks.iter().copied().map(wire::Track::from));
        let seq = self.next_seq();
        let request = wire::Plan {
            r#type: wire::PlanTag::Plan,
            seq,
            t_s: situation.t_s,
            own: wire::Own::from(situation.own),
            tracks: &tracks,
            visual_range_m: situation.visual_range_m,
        };
        let answer = self.exchange::<_, OrderAnswer>(&request, "order", self.limits.call);
        self.tracks = tracks;
        let answer = answer?;
        self.check_seq("order", answer.seq, seq)?;
        Ok(Command::from(answer))
    }

    fn next_seq(&mut self) -> u64 {
        self.running.as_mut().map_or(0, |running| {
            running.seq += 1;
            running.seq
        })
    }

    /// Sends one message and reads the answer to it, of the type `expected`.
    fn exchange<Q: Serialize, A: DeserializeOwned>(
        &mut self,
        request: &Q,
        expected: &str,
        limit: Duration,
    ) -> Result<A, PlannerFailure> {
        let Some(running) = &mut self.running else {
            let what = "it was asked to plan after a failed reset";
            return Err(failure(FailureKind::Crashed, what.to_owned()));
        };
        self.request.clear();
        serde_json::to_writer(&mut self.request, request)
            .expect("plain numbers and words can be written");
        self.request.push(b'\n');
        let bytes = self.limits.output_bytes;
        match running.child.exchange(&self.request, &mut self.answer, limit, bytes) {
            Ok(()) => self.read(expected),
            Err(trouble) => {
                let kind = match trouble {
                    Trouble::Ended(_) => FailureKind::Crashed,
                    Trouble::Silent { .. } => FailureKind::Hung,
                    Trouble::Flooded(_) => FailureKind::Protocol,
                };
                Err(self.fail(kind, format!("waiting for `{expected}`: {trouble}")))
            }
        }
    }

    fn read<A: DeserializeOwned>(&mut self, expected: &str) -> Result<A, PlannerFailure> {
        let error = match serde_json::from_str(&self.answer) {
            Ok(answer) => return Ok(answer),
            Err(error) => error,
        };
        // Only a line that is no JSON is looked through again: numbers that JSON has no word for.
        let finite = with_nulls(&self.answer);
        if let Some(answer) = finite.and_then(|line| serde_json::from_str(&line).ok()) {
            return Ok(answer);
        }
        let line = shortened(&self.answer);
        Err(self.broken(format!("answered what is no `{expected}`: {error}; it wrote: {line}")))
    }

    fn check_seq(&mut self, word: &str, got: u64, seq: u64) -> Result<(), PlannerFailure> {
        if got == seq {
            return Ok(());
        }
        Err(self.broken(format!("answered `{word}` number {got} to request number {seq}")))
    }

    fn broken(&mut self, what: String) -> PlannerFailure {
        self.fail(FailureKind::Protocol, what)
    }

    /// Ends the process and says what happened and what it last said.
    fn fail(&mut self, kind: FailureKind, what: String) -> PlannerFailure {
        let Some(mut running) = self.running.take() else { return failure(kind, what) };
        let hello = &running.hello;
        let name = if hello.name.is_empty() {
            format!("`{}`", self.argv.join(" "))
        } else {
            format!("`{}` {}", shortened(&hello.name), shortened(&hello.version))
        };
        let said = running.child.said();
        running.child.kill();
        failure(kind, format!("planner {name} {what}{said}"))
    }
}

const fn failure(kind: FailureKind, detail: String) -> PlannerFailure {
    PlannerFailure { kind, detail }
}

impl Planner for ExecPlanner {
    fn reset(&mut self, mission: &Mission) {
        let has_served = self.running.is_some();
        let mut result = self.try_reset(mission);
        if result.is_err() && has_served {
            result = self.try_reset(mission);
        }
        if let Err(failure) = result {
            failure.raise();
        }
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        match self.try_plan(situation) {
            Ok(command) => command,
            Err(failure) => failure.raise(),
        }
    }
}
