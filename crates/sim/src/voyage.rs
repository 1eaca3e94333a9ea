//! A run, and what it leaves behind for the nominal track.
//!
//! In weather a ship that does not react to own ship goes through the same states on the nominal
//! track as in the run, to the last bit: the orders, the weather and the steps are the same. So the
//! nominal track takes them from her wake and integrates her on only where it outlasts the run, or
//! from where she reacted. It takes nothing in steady weather, where it goes in closed form and the
//! run does not, and nothing from a run that ended in a contact.

use crate::intent::Script;
use crate::nominal;
use crate::pose::Pose;
use crate::ship::Ship;
use crate::weather::Environment;
use record::{Encounter, Trace};

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
    /// The run with its nominal track: that of [`nominal()`](crate::nominal()), bit for bit, but
    /// for own ship, who goes on until the end of a run that outlasts it.
    pub fn into_trace(self, encounter: &Encounter) -> Trace {
        let samples = self.trace.samples();
        let nominal = match self.left {
            Some(left) => Some(nominal::after(encounter, left, &self.trace.targets, samples)),
            None => nominal::lasting(encounter, samples),
        };
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
