//! What own ship did for one target: side, size and moment of her action.
//!
//! Everything is searched in the window of action, from the start of the track (not only from the
//! onset of risk: a ship that acts early must not be failed for having nothing left to do) to the
//! closest point. Offsets are taken from the heading and speed before the first run, and count when
//! they are held. Reference: rules specification, sections 5 to 7.

use crate::life::PairLife;
use crate::runs::{SpeedRun, TurnRun};
use crate::signal::OwnSignals;

/// Own ship's action for one target.
#[derive(Debug)]
pub(crate) struct Action {
    /// First and last sample of the window of action.
    pub(crate) window: (usize, usize),
    /// From where offsets are searched: the last sample before the first run.
    pub(crate) search_from: usize,
    /// Heading departure before the action, radians.
    pub(crate) heading_0_rad: f64,
    /// Speed departure before the action, m/s.
    pub(crate) departure_0_mps: f64,
    /// Speed before the action, m/s.
    pub(crate) u_0_mps: f64,
    /// Course runs of the window that belong to this target.
    pub(crate) runs: Vec<TurnRun>,
    /// Speed runs likewise.
    pub(crate) speed_runs: Vec<SpeedRun>,
    /// The run whose side counts: the first substantial one that is no way back, else the first.
    pub(crate) turn: Option<TurnRun>,
    /// When `turn` could be seen, seconds.
    pub(crate) turn_seen_s: Option<f64>,
    /// Largest held offset on the side of `turn` before the first return, radians, not negative.
    pub(crate) x_act_rad: f64,
    /// Largest held offset to starboard, radians, not negative.
    pub(crate) x_stbd_rad: f64,
    /// Largest held cut of speed as a share of the speed before.
    pub(crate) x_u: f64,
    /// First detectable alteration of any kind, seconds.
    pub(crate) detectable_s: Option<f64>,
    /// First readily apparent one, seconds.
    pub(crate) apparent_s: Option<f64>,
    /// The same by course alone, seconds.
    pub(crate) turn_apparent_s: Option<f64>,
    /// Start of the first run that led to a substantial one (`t_man`), seconds.
    pub(crate) manoeuvre_s: Option<f64>,
}

/// Where to look for offsets: a signal and the level that it starts from.
struct Offsets<'a> {
    values: &'a [f64],
    level: f64,
    /// Speed over ground, where an offset counts only while she has way, m/s.
    way: Option<(&'a [f64], f64)>,
    /// Samples that an offset must be held for.
    held: usize,
    sample_s: f64,
}

impl Action {
    pub(crate) fn new(
        life: &PairLife<'_>,
        own: &OwnSignals,
        turns: impl Iterator<Item = TurnRun>,
        speeds: impl Iterator<Item = SpeedRun>,
        (from, released): (usize, Option<usize>),
    ) -> Self {
        let to = life.passed.map_or(own.heading_rad.len() - 1, |passed| passed.k);
        let to = released.map_or(to, |k| k.min(to));
        let inside = |start: usize| start >= from && start <= to;
        let runs = turns.filter(|run| inside(run.start));
        let runs: Vec<_> = runs.skip_while(|run| leads_back(life, own, run)).collect();
        let speed_runs = speeds.filter(|run| inside(run.start));
        let speed_runs: Vec<_> = speed_runs.skip_while(|run| regains(life, own, run)).collect();
        let mut action = Self {
            window: (from.min(to), to),
            search_from: 0,
            heading_0_rad: 0.0,
            departure_0_mps: 0.0,
            u_0_mps: 0.0,
            turn: None,
            turn_seen_s: None,
            x_act_rad: 0.0,
            x_stbd_rad: 0.0,
            x_u: 0.0,
            detectable_s: None,
            apparent_s: None,
            turn_apparent_s: None,
            manoeuvre_s: None,
            runs,
            speed_runs,
        };
        action.choose_turn(life, own);
        action.search_from = action.set_baseline(life, own);
        action.measure(life, own, action.search_from);
        action
    }

    /// +1 to starboard, -1 to port, 0 without a turn.
    pub(crate) fn side(&self) -> f64 {
        self.turn.map_or(0.0, |turn| turn.size_rad.signum())
    }

    /// Whether anything was done that another ship could see.
    pub(crate) fn detectable(&self) -> bool {
        self.detectable_s.is_some()
    }

    /// Largest held offset to one side in samples `from..to`, radians, not negative.
    pub(crate) fn held_offset_rad(
        &self,
        life: &PairLife<'_>,
        own: &OwnSignals,
        side: f64,
        range: std::ops::Range<usize>,
    ) -> f64 {
        self.headings(life, own).largest(side, range)
    }

    /// Largest held change of speed to one side (-1: slower) in a range, as a share.
    pub(crate) fn held_speed_share(
        &self,
        life: &PairLife<'_>,
        own: &OwnSignals,
        side: f64,
        range: std::ops::Range<usize>,
    ) -> f64 {
        if self.u_0_mps <= 0.0 {
            return 0.0;
        }
        self.speeds(life, own).largest(side, range) / self.u_0_mps
    }

    /// Largest held change of speed to one side of a level in a range, m/s, not negative.
    pub(crate) fn held_change_mps(
        &self,
        life: &PairLife<'_>,
        own: &OwnSignals,
        level_mps: f64,
        side: f64,
        range: std::ops::Range<usize>,
    ) -> f64 {
        Offsets::new(life, &own.departure_mps, level_mps).largest(side, range)
    }

    fn choose_turn(&mut self, life: &PairLife<'_>, own: &OwnSignals) {
        let m = &life.rules.manoeuvre;
        let first = self.runs.first().copied();
        let goes_back = |run: &TurnRun| {
            first.is_some_and(|first| {
                let off_rad = |k: usize, side: f64| {
                    (own.smooth_rad[k] - own.smooth_rad[first.edge]) * side.signum()
                };
                // past the first course it is an action, unless it leads back from a real one: the
                // way back to the line of the route goes past its course
                let past = off_rad(run.end, run.size_rad) >= m.substantial_turn_rad;
                let acted = off_rad(run.edge, first.size_rad) >= m.substantial_turn_rad;
                returns_from(life, &first, run) && (!past || acted)
            })
        };
        let acts = |run: &&TurnRun| run.size_rad.abs() >= m.substantial_turn_rad && !goes_back(run);
        self.turn = self.runs.iter().find(acts).or(self.runs.first()).copied();
        self.turn_seen_s = self.turn.map(|run| {
            // the smoothed rate rises before the ship turns: the heading itself says when
            let before = own.heading_rad[run.edge];
            let headings = Offsets { level: before, held: 0, ..self.headings(life, own) };
            let seen =
                headings.first(run.size_rad.signum(), m.detectable_turn_rad, run.edge..run.end + 1);
            seen.unwrap_or(life.time_s(run.start))
        });
    }

    /// Sets the heading and speed before the action, and says from where offsets are searched.
    fn set_baseline(&mut self, life: &PairLife<'_>, own: &OwnSignals) -> usize {
        let turn = self.runs.first().map(|run| run.edge);
        let speed = self.speed_runs.first().map(|run| run.start);
        let first = [turn, speed].into_iter().flatten().min();
        let last = own.heading_rad.len() - 1;
        let end = first.or(life.onset.map(|onset| onset.k)).unwrap_or(self.window.0).min(last);
        let length = (life.rules.manoeuvre.baseline_s / life.trace.sample_s).round() as usize;
        let begin = (end + 1).saturating_sub(length.max(1));
        let mean =
            |values: &[f64]| values[begin..=end].iter().sum::<f64>() / (end + 1 - begin) as f64;
        self.heading_0_rad = mean(&own.heading_rad);
        self.departure_0_mps = mean(&own.departure_mps);
        self.u_0_mps = mean(&own.speed_mps);
        end.max(self.window.0)
    }

    fn measure(&mut self, life: &PairLife<'_>, own: &OwnSignals, search: usize) {
        let m = &life.rules.manoeuvre;
        let whole = search..self.window.1 + 1;
        let side = self.side();
        let before_return = search..self.first_return(life).unwrap_or(self.window.1 + 1);
        self.x_act_rad = if side.abs() > 0.0 {
            self.headings(life, own).largest(side, before_return)
        } else {
            0.0
        };
        self.x_stbd_rad = self.headings(life, own).largest(1.0, whole.clone());
        self.x_u = self.held_speed_share(life, own, -1.0, whole.clone());
        let headings = self.headings(life, own);
        let speeds = self.speeds(life, own);
        let moving = self.u_0_mps > 0.0;
        let slower = |share: f64| {
            if moving { speeds.first(-1.0, share * self.u_0_mps, whole.clone()) } else { None }
        };
        let faster = |share: f64| {
            if moving { speeds.first(1.0, share * self.u_0_mps, whole.clone()) } else { None }
        };
        let turned = |side: f64, angle: f64| headings.first(side, angle, whole.clone());
        let earliest = |times: &[Option<f64>]| times.iter().flatten().copied().reduce(f64::min);
        let seen_turn = m.detectable_turn_rad;
        let seen_share = m.detectable_speed_fraction;
        let detectable_s = earliest(&[
            turned(1.0, seen_turn),
            turned(-1.0, seen_turn),
            slower(seen_share),
            faster(seen_share),
        ]);
        let turned_s = if side.abs() > 0.0 { turned(side, m.apparent_turn_rad) } else { None };
        let apparent_s = earliest(&[turned_s, slower(m.apparent_speed_fraction)]);
        let by_course = (self.x_act_rad >= m.substantial_turn_rad)
            .then(|| self.runs.iter().find(|run| run.size_rad * side > 0.0))
            .flatten()
            .map(|run| life.time_s(run.start));
        let by_speed = (self.x_u >= m.substantial_speed_fraction)
            .then(|| {
                let slowing = self.speed_runs.iter().find(|run| run.change_mps < 0.0);
                slowing.map(|run| life.time_s(run.start)).or(slower(seen_share))
            })
            .flatten();
        self.detectable_s = detectable_s;
        self.apparent_s = apparent_s;
        self.turn_apparent_s = turned_s;
        self.manoeuvre_s = earliest(&[by_course, by_speed]);
    }

    /// Start of the first run back, once the pass is predicted clear or lies behind.
    pub(crate) fn first_return(&self, life: &PairLife<'_>) -> Option<usize> {
        let turn = self.turn?;
        self.runs.iter().find(|run| returns_from(life, &turn, run)).map(|run| run.start)
    }

    fn headings<'b>(&self, life: &PairLife<'_>, own: &'b OwnSignals) -> Offsets<'b> {
        let way = Some((&own.speed_mps[..], life.rules.manoeuvre.moving_mps));
        Offsets { way, ..Offsets::new(life, &own.heading_rad, self.heading_0_rad) }
    }

    fn speeds<'b>(&self, life: &PairLife<'_>, own: &'b OwnSignals) -> Offsets<'b> {
        Offsets::new(life, &own.departure_mps, self.departure_0_mps)
    }
}

/// Whether a run leads back to the nominal heading from a departure too slow to be a run itself,
/// when there is nothing left to avoid.
fn leads_back(life: &PairLife<'_>, own: &OwnSignals, run: &TurnRun) -> bool {
    let side = run.size_rad.signum();
    let [before, after] = [run.start, run.end].map(|k| own.heading_rad[k] * side);
    life.nominal.is_some()
        && before < 0.0
        && after < life.rules.manoeuvre.detectable_turn_rad
        && settled(life, run.start)
}

/// Whether a run brings back the nominal speed after a loss too slow to be a run itself, when there
/// is nothing left to avoid.
fn regains(life: &PairLife<'_>, own: &OwnSignals, run: &SpeedRun) -> bool {
    let before_mps = own.departure_mps[run.start];
    let beyond_mps = life.rules.manoeuvre.detectable_speed_fraction * own.speed_mps[run.start];
    life.nominal.is_some()
        && run.change_mps > 0.0
        && before_mps < 0.0
        && before_mps + run.change_mps < beyond_mps
        && settled(life, run.start)
}

/// Whether the pass is predicted clear, or lies behind.
fn settled(life: &PairLife<'_>, k: usize) -> bool {
    life.actual.tcpa_s(k).is_some_and(|t| t < 0.0)
        || !life.actual.dcpa_below(k, life.rules.distance.r_min_m)
}

/// Whether a run leads back from an earlier one: to the other side, when the pass was predicted
/// clear or lay behind (section 5).
fn returns_from(life: &PairLife<'_>, earlier: &TurnRun, run: &TurnRun) -> bool {
    run.start > earlier.start && run.size_rad * earlier.size_rad < 0.0 && settled(life, run.start)
}

impl<'a> Offsets<'a> {
    fn new(life: &PairLife<'_>, values: &'a [f64], level: f64) -> Self {
        let sample_s = life.trace.sample_s;
        let held = (life.rules.manoeuvre.offset_held_s / sample_s).ceil() as usize;
        Self { values, level, way: None, held, sample_s }
    }

    /// The offset to `side` at a sample. How a ship lies that has no way is no manoeuvre.
    fn at(&self, side: f64, k: usize) -> f64 {
        match self.way {
            Some((speed_mps, moving_mps)) if speed_mps[k] < moving_mps => 0.0,
            _ => (self.values[k] - self.level) * side,
        }
    }

    /// Largest offset to `side` that is held, over the samples at which it may begin.
    fn largest(&self, side: f64, range: std::ops::Range<usize>) -> f64 {
        let mut best = 0.0;
        for k in range.start..range.end.min(self.values.len().saturating_sub(self.held)) {
            // nothing held from here on can exceed the offset here
            if self.at(side, k) > best {
                let least = (k..=k + self.held).map(|j| self.at(side, j));
                best = least.fold(f64::INFINITY, f64::min).max(best);
            }
        }
        best
    }

    /// First time at which an offset of `size` to `side` begins that is held, seconds; refined
    /// between samples.
    fn first(&self, side: f64, size: f64, range: std::ops::Range<usize>) -> Option<f64> {
        let offset = |k: usize| self.at(side, k);
        let last = range.end.min(self.values.len().saturating_sub(self.held));
        let k = (range.start..last)
            .find(|&k| offset(k) >= size && (k..=k + self.held).all(|j| offset(j) >= size))?;
        let before = k.checked_sub(1).map(offset).filter(|before| *before < size);
        let back = before.map_or(0.0, |before| (offset(k) - size) / (offset(k) - before));
        Some((k as f64 - back) * self.sample_s)
    }
}
