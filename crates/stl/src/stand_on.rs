//! The columns of Rule 17: what binds the ship that stands on, and until when.

use crate::action::Action;
use crate::checks::{Case, Claim};
use crate::life::Duty;
use crate::phi::{self, column as c};
use crate::risk::samples_of;
use crate::runs::Run;
use crate::signals::ABAFT_THE_BEAM_RAD;

impl Case<'_> {
    /// Rule 17(a)(i), from the entry of stage 2 until she may or shall act.
    pub(crate) fn stand_on(&self, duty: &Duty) -> Claim {
        let p = self.params;
        let Some(from) = duty.stages[0] else { return Claim::NotApplicable };
        let ends = [duty.may_act, duty.shall_act].into_iter().flatten().min();
        let to = ends.unwrap_or(duty.end + 1).min(duty.end + 1);
        let excused = self.excused();
        let bound = |k: usize| (from..to).contains(&k) && !excused[k];
        if !(from..to).any(bound) {
            return Claim::NotApplicable;
        }
        let speed_0 = self.deviation.speed_mps[from];
        let change_0 = self.deviation.speed_change_mps[from];
        // a share of next to no speed says nothing of what she does with it
        let moving = speed_0 >= p.run.moving_mps;
        let change = |v: &f64| if moving { (v - change_0).abs() / speed_0 } else { 0.0 };
        let changes = self.deviation.speed_change_mps.iter().map(change).collect();
        let made = |k: usize| k.checked_sub(self.hold).is_some_and(bound);
        let signals = self
            .signals_of(duty)
            .with(c::CLOCK, self.flags(bound))
            .with(c::SPEED_CLOCK, self.flags(made))
            .with(c::YAW_RAD, self.mean_yaw_rad(from, to))
            .with(c::SPEED_CHANGE, changes);
        // a meeting that the run cuts off is never a pass, though this duty had ended (section 4)
        let complete = duty.complete;
        Claim::Formula { formula: phi::stand_on(self.hold, p), signals, complete }
    }

    /// How far the centred mean of the heading lies from the mean before sample `from`. It stays
    /// inside the samples before `to`: it must not see what she did once she was free to act.
    fn mean_yaw_rad(&self, from: usize, to: usize) -> Vec<f64> {
        let heading_rad = &self.deviation.heading_rad;
        let mut sum = 0.0;
        let mut sums = vec![0.0];
        sums.extend(heading_rad.iter().map(|heading| {
            sum += heading;
            sum
        }));
        let mean = |a: usize, b: usize| (sums[b] - sums[a]) / (b - a) as f64;
        let span = samples_of(self.params.stand_on_mean_s, self.trace.sample_s);
        let before = mean(from.saturating_sub(span), from.max(1));
        let yaw = |k: usize| {
            let (a, b) = (k.saturating_sub(span / 2), (k + span / 2 + 1).min(to));
            (mean(a, b) - before).abs()
        };
        let bound = |k: usize| if (from..to).contains(&k) { yaw(k) } else { 0.0 };
        (0..heading_rad.len()).map(bound).collect()
    }

    /// Whether the present sample lies, or the latest alteration began, where she gives way to
    /// another ship: that duty forces what she does. The way back from it, and what is too small
    /// to break Rule 17, is no alteration of her own choice.
    fn excused(&self) -> Vec<bool> {
        let mut excused = vec![false; self.pair().samples()];
        for (_, life) in self.lives.iter().enumerate().filter(|(i, _)| *i != self.target) {
            let Some(duty) = life.in_sight.as_ref().filter(|duty| duty.gives_way()) else {
                continue;
            };
            let owed = |k: usize| (duty.onset..=duty.end).contains(&k);
            let (did, p) = (&self.deviation, self.params);
            let turns = did.turns.iter().filter(|run| {
                owed(run.start) || run.change.abs() >= p.turn_action_rad && !did.turns_back(run)
            });
            let speeds = did.speed_changes.iter().filter(|run| {
                let least_mps = p.speed_action * did.speed_mps[run.start];
                owed(run.start) || run.change.abs() >= least_mps && !did.regains(run)
            });
            let mut starts: Vec<usize> = turns.chain(speeds).map(|run| run.start).collect();
            starts.sort_unstable();
            for (k, excused) in excused.iter_mut().enumerate() {
                let latest = starts.iter().rfind(|start| **start <= k);
                *excused |= owed(k) || latest.is_some_and(|start| owed(*start));
            }
        }
        excused
    }

    /// Rule 17(c): off to port in stage 3 for a ship that was on the port side when she acted. When
    /// the turn was begun does not matter, but before risk opened it was free.
    pub(crate) fn not_to_port(&self, duty: &Duty, action: &Action) -> Claim {
        let p = self.params;
        let Some(stage_3) = duty.stages[1] else { return Claim::NotApplicable };
        let on_port = |run: Run| {
            let beta = self.pair().beta_rad(run.start);
            beta < 0.0 && beta > -ABAFT_THE_BEAM_RAD
        };
        // A run to starboard, such as the way back, says nothing of where she was.
        let before_return = |run: &&Run| action.returns.is_none_or(|back| run.start < back);
        let to_port = action.turns.iter().filter(before_return).find(|run| run.change < 0.0);
        if to_port.is_some_and(|run| !on_port(*run)) {
            return Claim::NotApplicable;
        }
        let stage_4 = duty.stages[2].filter(|_| !p.port_turn_fails_in_stage_4);
        let last = stage_4.unwrap_or(duty.end + 1);
        let forced = action.counted.is_some_and(|run| self.excused()[run.start]);
        let free = forced || self.turned_early(duty, action);
        let from = if free { last } else { stage_3.max(action.from) };
        let signals = self
            .signals_of(duty)
            .with(c::CLOCK, self.made_in(from..last))
            .with(c::TURN_RAD, action.turn_rad.clone());
        let formula = phi::not_to_port(self.hold, p);
        Claim::Formula { formula, signals, complete: duty.complete }
    }
}
