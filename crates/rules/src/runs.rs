//! Runs: the separate alterations of course and of speed that own ship made.
//!
//! A course run starts when the smoothed yaw rate reaches `q_on` and ends when it stays under half
//! of that for a while, changes sign, or the ship stops; a peak or a plateau of the rate never ends
//! one. Runs to one side with a short gap are one. A turn too slow for `q_on` is found by its size.
//! Smoothing spreads a turn to seconds before it began; when a run began is read from the heading
//! itself, so that a turn made in the very second of detection lies in the window of action.
//! Reference: rules specification, section 5, which mends the segmentation of Hagen and Tengesdal.

use crate::ruleset::RuleSet;
use crate::signal::OwnSignals;
use record::Ship;

/// One alteration of course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TurnRun {
    /// Last sample before the ship herself began to turn.
    pub(crate) start: usize,
    /// First quiet sample of the smoothed rate after it (or the last sample).
    pub(crate) end: usize,
    /// Last quiet sample of the smoothed rate before it: what was before the run is before this.
    pub(crate) edge: usize,
    /// Net change of the heading itself from `start` to `end`, radians, starboard positive:
    /// smoothing takes degrees off a turn that is followed at once by its return.
    pub(crate) size_rad: f64,
}

/// One alteration of speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeedRun {
    /// First sample at the rate that counts.
    pub(crate) start: usize,
    /// Net change, m/s.
    pub(crate) change_mps: f64,
}

/// Finds the course runs of at least the detectable size.
pub(crate) fn turn_runs(
    own: &OwnSignals,
    ship: &Ship,
    sample_s: f64,
    rules: &RuleSet,
    runs: &mut Vec<TurnRun>,
) {
    let m = &rules.manoeuvre;
    let start_radps = m.turn_rate_start_radps.min(ship.yaw_rate_radps_max / 2.0);
    runs.clear();
    let fast = Segmenter { rate: &own.rate_radps, start_radps, sample_s, own, rules };
    fast.collect(runs);
    let (low, high) = own
        .smooth_rad
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
    // a turn of this size in this time has this rate on average
    let slow_radps = m.substantial_turn_rad / m.slow_turn_s;
    if high - low >= m.substantial_turn_rad && slow_radps < start_radps {
        add_slow_runs(own, slow_radps, sample_s, rules, runs);
    }
    runs.retain(|run| run.size_rad.abs() >= m.detectable_turn_rad);
    for run in runs {
        run.start = begun(&own.heading_rad, run, m.detectable_turn_rad);
        run.size_rad = own.heading_rad[run.end] - own.heading_rad[run.start];
    }
}

/// How far the heading may have left what it was before a turn has begun, as a share of the
/// detectable turn.
const UNDISTURBED: f64 = 0.1;

/// The last sample at which the unsmoothed heading was what it was before the run.
fn begun(heading_rad: &[f64], run: &TurnRun, detectable_rad: f64) -> usize {
    let offset = |k: usize| (heading_rad[k] - heading_rad[run.edge]) * run.size_rad.signum();
    let mut before_rad = f64::INFINITY;
    let seen = (run.edge..=run.end).find(|&k| {
        before_rad = before_rad.min(offset(k));
        offset(k) - before_rad >= detectable_rad
    });
    let undisturbed = |&k: &usize| offset(k) <= before_rad + UNDISTURBED * detectable_rad;
    seen.and_then(|seen| (run.edge..seen).rev().find(undisturbed)).unwrap_or(run.start)
}

/// Turns that never reach the starting rate but change course by a substantial angle in time.
fn add_slow_runs(
    own: &OwnSignals,
    start_radps: f64,
    sample_s: f64,
    rules: &RuleSet,
    runs: &mut Vec<TurnRun>,
) {
    let m = &rules.manoeuvre;
    // waves would cut a slow turn to pieces: its rate is taken over the length of a gap
    let half = ((m.turn_gap_s / 2.0 / sample_s).round() as usize).max(1);
    let last = own.smooth_rad.len() - 1;
    let rate: Vec<f64> = (0..=last)
        .map(|k| {
            let (from, to) = (k.saturating_sub(half), (k + half).min(last));
            (own.smooth_rad[to] - own.smooth_rad[from]) / ((to - from).max(1) as f64 * sample_s)
        })
        .collect();
    let mut slow = Vec::new();
    Segmenter { rate: &rate, start_radps, sample_s, own, rules }.collect(&mut slow);
    let window = (m.slow_turn_s / sample_s).round() as usize;
    slow.retain(|run| {
        let change = |k: usize| own.smooth_rad[(k + window).min(run.end)] - own.smooth_rad[k];
        let enough = (run.edge..run.end).any(|k| change(k).abs() >= m.substantial_turn_rad);
        enough && !runs.iter().any(|fast| fast.edge < run.end && run.edge < fast.end)
    });
    runs.extend(slow);
    runs.sort_by_key(|run| run.start);
}

struct Segmenter<'a> {
    rate: &'a [f64],
    start_radps: f64,
    sample_s: f64,
    own: &'a OwnSignals,
    rules: &'a RuleSet,
}

impl Segmenter<'_> {
    fn collect(&self, runs: &mut Vec<TurnRun>) {
        let m = &self.rules.manoeuvre;
        let mut k = 0;
        while k < self.rate.len() {
            if self.rate[k].abs() < self.start_radps || self.own.speed_mps[k] < m.moving_mps {
                k += 1;
                continue;
            }
            let run = self.run_from(k);
            k = run.end.max(k + 1);
            let gap_s = |before: &TurnRun| (run.start - before.end) as f64 * self.sample_s;
            match runs.last_mut() {
                Some(before)
                    if before.size_rad * run.size_rad > 0.0 && gap_s(before) < m.turn_gap_s =>
                {
                    before.end = run.end;
                    before.size_rad =
                        self.own.heading_rad[run.end] - self.own.heading_rad[before.start];
                }
                _ => runs.push(run),
            }
        }
    }

    fn run_from(&self, start: usize) -> TurnRun {
        let m = &self.rules.manoeuvre;
        let side = self.rate[start].signum();
        let quiet_radps = self.start_radps / 2.0;
        let quiet_samples = (m.turn_quiet_s / self.sample_s).ceil() as usize;
        let mut edge = start;
        while edge > 0 && self.rate[edge] * side >= quiet_radps {
            edge -= 1;
        }
        let (mut end, mut quiet) = (self.rate.len() - 1, 0);
        for k in start + 1..self.rate.len() {
            let rate = self.rate[k] * side;
            if rate < 0.0 || self.own.speed_mps[k] < m.moving_mps {
                end = k - quiet;
                break;
            }
            quiet = if rate < quiet_radps { quiet + 1 } else { 0 };
            // n samples span n - 1 intervals
            if quiet > quiet_samples {
                end = k + 1 - quiet;
                break;
            }
        }
        let size_rad = self.own.heading_rad[end] - self.own.heading_rad[start];
        TurnRun { start, end, edge, size_rad }
    }
}

/// Finds the speed runs of at least the detectable size.
pub(crate) fn speed_runs(
    own: &OwnSignals,
    sample_s: f64,
    rules: &RuleSet,
    runs: &mut Vec<SpeedRun>,
) {
    let m = &rules.manoeuvre;
    let least = m.speed_rate_mps2 * sample_s;
    let u = &own.departure_mps;
    runs.clear();
    let mut k = 1;
    while k < u.len() {
        let step = u[k] - u[k - 1];
        if step.abs() < least {
            k += 1;
            continue;
        }
        let start = k - 1;
        while k + 1 < u.len() && (u[k + 1] - u[k]) * step.signum() >= least {
            k += 1;
        }
        let change_mps = u[k] - u[start];
        if change_mps.abs() >= m.detectable_speed_fraction * own.speed_mps[start] {
            runs.push(SpeedRun { start, change_mps });
        }
        k += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Script, rules, ship};
    use geom::units::{deg, to_deg};

    fn runs_of(script: Script) -> Vec<TurnRun> {
        runs_sampled(script, 1)
    }

    /// With a sample every so many seconds.
    fn runs_sampled(script: Script, every_s: usize) -> Vec<TurnRun> {
        let mut track = script.track();
        for signal in [
            &mut track.psi_rad,
            &mut track.vel_north_mps,
            &mut track.vel_east_mps,
            &mut track.stw_mps,
        ] {
            *signal = signal.iter().copied().step_by(every_s).collect();
        }
        let (mut own, mut runs) = (OwnSignals::default(), Vec::new());
        own.fill(&track, None, every_s as f64, &rules());
        turn_runs(&own, &track.ship, every_s as f64, &rules(), &mut runs);
        runs
    }

    fn start() -> Script {
        Script::new(ship(10.0, 3.0), 0.0, 0.0, deg(170.0), 6.0).hold(40.0)
    }

    /// The unit test of section 5: a yaw rate's peak or plateau must not split a turn.
    #[test]
    fn one_clean_turn_is_one_run_at_every_rate() {
        for rate in [0.25, 1.0, 3.0, 6.0] {
            for side in [1.0, -1.0] {
                let runs = runs_of(start().turn(side * 35.0, rate).hold(60.0));
                assert_eq!(runs.len(), 1, "{rate} deg/s: {runs:?}");
                let error = to_deg(runs[0].size_rad) - side * 35.0;
                assert!(error.abs() <= 2.0, "{rate} deg/s: off by {error} deg");
            }
        }
    }

    #[test]
    fn a_pause_makes_two_runs() {
        let runs = runs_of(start().turn(15.0, 3.0).hold(20.0).turn(20.0, 3.0).hold(60.0));
        let sizes: Vec<f64> = runs.iter().map(|run| to_deg(run.size_rad)).collect();
        assert_eq!(sizes.len(), 2, "{sizes:?}");
        assert!((sizes[0] - 15.0).abs() < 2.0 && (sizes[1] - 20.0).abs() < 2.0);
    }

    #[test]
    fn a_short_pause_does_not() {
        let runs = runs_of(start().turn(15.0, 3.0).hold(8.0).turn(20.0, 3.0).hold(60.0));
        assert_eq!(runs.len(), 1, "{runs:?}");
        assert!((to_deg(runs[0].size_rad) - 35.0).abs() < 2.0);
    }

    #[test]
    fn five_small_turns_are_five_runs() {
        let script = (0..5).fold(start(), |script, _| script.turn(8.0, 2.0).hold(20.0));
        assert_eq!(runs_of(script).len(), 5);
    }

    /// The size is that of the heading: in the smoothed one an immediate return takes the rate
    /// times sigma times sqrt(2 / pi) off the peak, here 4.8 degrees.
    #[test]
    fn a_turn_and_its_return_are_two_runs() {
        let runs = runs_of(start().turn(30.0, 3.0).turn(-30.0, 3.0).hold(60.0));
        assert_eq!(runs.len(), 2, "{runs:?}");
        assert!((to_deg(runs[0].size_rad) - 30.0).abs() < 1.0, "{runs:?}");
        assert!((to_deg(runs[1].size_rad) + 30.0).abs() < 1.0, "{runs:?}");
    }

    /// The smoothed rate rises two to three seconds before a brisk turn does.
    #[test]
    fn a_run_begins_when_the_ship_herself_does() {
        for (rate, side) in [(5.0, 1.0), (5.0, -1.0), (1.0, 1.0), (0.25, -1.0)] {
            let begins = runs_of(start().turn(side * 20.0, rate).hold(60.0))[0].start;
            assert!(begins.abs_diff(40) <= 1, "{rate} deg/s: {begins}");
        }
        let reversed = runs_of(start().turn(30.0, 3.0).turn(-30.0, 3.0).hold(60.0));
        assert!(reversed[1].start.abs_diff(50) <= 1, "{reversed:?}");
    }

    #[test]
    fn a_small_yaw_is_none() {
        assert!(runs_of(start().turn(1.5, 1.0).hold(60.0)).is_empty());
    }

    /// 15 degrees at a rate too slow for a run; a drift after it is no part of it.
    #[test]
    fn a_slow_turn_ends_before_a_drift() {
        for every_s in [1, 2] {
            let runs = runs_sampled(start().turn(15.0, 0.15).turn(3.0, 0.03).hold(60.0), every_s);
            assert_eq!(runs.len(), 1, "{runs:?}");
            assert!((to_deg(runs[0].size_rad) - 15.0).abs() < 0.6, "{runs:?}");
            assert!((every_s * runs[0].end).abs_diff(140) <= 8, "{runs:?}");
        }
    }

    /// 12 degrees in 200 s, and never 10 of them in two minutes.
    #[test]
    fn a_turn_slower_than_slow_is_none() {
        for every_s in [1, 2] {
            let runs_of = |script: Script| runs_sampled(script.hold(60.0), every_s).len();
            assert_eq!(runs_of(start().turn(4.5, 0.09).turn(7.5, 0.05)), 0);
            assert_eq!(runs_of(start().turn(4.5, 0.09).turn(7.5, 0.083)), 1);
        }
    }

    #[test]
    fn slowing_down_is_a_speed_run() {
        let track = start().speed_to(3.0, 0.2).hold(30.0).track();
        let (mut own, mut runs) = (OwnSignals::default(), Vec::new());
        own.fill(&track, None, 1.0, &rules());
        speed_runs(&own, 1.0, &rules(), &mut runs);
        assert_eq!(runs.len(), 1);
        assert!((runs[0].change_mps + 3.0).abs() < 0.21 && runs[0].start.abs_diff(40) <= 1);
    }
}
