//! A run, and what it leaves behind for the nominal track.
//!
//! In weather a ship that does not react to own ship goes through the same states on the nominal
//! track as in the run, to the last bit: the orders, the weather and the steps are the same. So the
//! nominal track takes them from her wake and integrates her on only where it outlasts the run, or
//! from where she reacted. In steady weather it goes in closed form, which the run does not, and
//! takes nothing.

use crate::intent::Script;
use crate::nominal;
use crate::pose::Pose;
use crate::ship::Ship;
use crate::weather::Environment;
use record::{Encounter, Nominal, Trace};
use std::ops::RangeInclusive;

/// A run that can make the nominal track of its encounter from what it knows already.
#[derive(Debug)]
pub struct Voyage {
    /// The run; `nominal` is left empty.
    pub trace: Trace,
    pub(crate) left: Option<Left>,
}

/// What is left of a world.
#[derive(Debug)]
pub(crate) struct Left {
    pub(crate) environment: Environment,
    /// Of each target.
    pub(crate) wakes: Vec<Wake>,
}

impl Voyage {
    /// The same as [`nominal()`](crate::nominal()) of the encounter that was run, bit for bit.
    pub fn nominal(&mut self, encounter: &Encounter) -> Option<Nominal> {
        match self.left.take() {
            Some(left) => Some(nominal::after(encounter, left, &self.trace.targets)),
            None => nominal::nominal(encounter),
        }
    }

    /// The run with its nominal track.
    pub fn into_trace(mut self, encounter: &Encounter) -> Trace {
        let nominal = self.nominal(encounter);
        Trace { nominal, ..self.trace }
    }
}

/// The wakes of all targets, or none where the nominal track takes nothing from the run.
#[derive(Debug, Default)]
pub(crate) struct Wakes(Vec<Wake>);

impl Wakes {
    pub(crate) fn new(targets: usize, room: usize) -> Self {
        let wake = || Wake { beats: Vec::with_capacity(room), after: None };
        Self(std::iter::repeat_with(wake).take(targets).collect())
    }

    /// A beat begins.
    pub(crate) fn begin(&mut self, targets: &[Ship]) {
        for (wake, target) in self.open(targets) {
            wake.beats.push([target.pose; 2]);
        }
    }

    /// The beat ends.
    pub(crate) fn end(&mut self, targets: &[Ship]) {
        for (wake, target) in self.open(targets) {
            if let Some(beat) = wake.beats.last_mut() {
                beat[1] = target.pose;
            }
        }
    }

    /// The run ended within a beat; on the nominal track there is no contact, and the steps that
    /// are `left` of the beat follow.
    pub(crate) fn finish(&mut self, targets: &mut [Ship], left: RangeInclusive<u64>, step_s: f64) {
        if self.0.is_empty() {
            return;
        }
        for step in left {
            targets.iter_mut().for_each(|t| t.advance((step + 1) as f64 * step_s, step_s));
        }
        self.end(targets);
    }

    /// From the start of this beat on a target is not followed; the first call counts.
    pub(crate) fn close(&mut self, index: usize, ship: impl FnOnce() -> (Ship, Script)) {
        if let Some(Wake { after: after @ None, .. }) = self.0.get_mut(index) {
            *after = Some(Box::new(ship()));
        }
    }

    /// All of them at the end of the run; `None` where there are none.
    pub(crate) fn closed(
        mut self,
        targets: impl Iterator<Item = (Ship, Script)>,
    ) -> Option<Vec<Wake>> {
        for (index, target) in targets.enumerate() {
            self.close(index, || target);
        }
        (!self.0.is_empty()).then_some(self.0)
    }

    fn open<'a>(
        &'a mut self,
        targets: &'a [Ship],
    ) -> impl Iterator<Item = (&'a mut Wake, &'a Ship)> {
        self.0.iter_mut().zip(targets).filter(|(wake, _)| wake.after.is_none())
    }
}

/// Where a target was at each beat, for as long as she did what she does by herself.
#[derive(Debug)]
pub(crate) struct Wake {
    /// Poses at the start and at the end of each whole beat. They are not in the trace: a sample
    /// holds no heading vector, and the end of a beat is still in the weather of that beat.
    beats: Vec<[Pose; 2]>,
    /// The ship as she was after them, once the wake is closed.
    after: Option<Box<(Ship, Script)>>,
}

impl Wake {
    /// Poses at the start and the end of beat `k`, if she was followed through it.
    pub(crate) fn beat(&self, k: usize) -> Option<[Pose; 2]> {
        self.beats.get(k).copied()
    }

    /// The ship after the last beat of a closed wake.
    pub(crate) fn after(self) -> (Ship, Script) {
        *self.after.expect("a wake is closed before it is handed on")
    }
}
