//! Runs: the single alterations of course and of speed that a stretch of track is made of
//! (rules specification, section 5).

use crate::params::{Params, RunParams};
use crate::risk::samples_of;

/// One alteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Last sample before the ship herself did anything.
    pub start: usize,
    /// Last sample.
    pub end: usize,
    /// Net change: radians (positive to starboard) or m/s (positive ahead).
    pub change: f64,
}

/// Runs of the heading. `heading_rad` is unwrapped; `yaw_rate_on_radps` is `q_on`.
pub fn heading_runs(
    heading_rad: &[f64],
    speed_mps: &[f64],
    yaw_rate_on_radps: f64,
    params: &Params,
    sample_s: f64,
) -> Vec<Run> {
    if extent(heading_rad) < params.turn_detectable_rad || heading_rad.len() < 2 {
        return Vec::new();
    }
    let smooth = smoothed(heading_rad, params.run.smoothing_s, sample_s);
    let rate = derivative(&smooth, sample_s);
    let fast = fast_runs(&rate, speed_mps, yaw_rate_on_radps, &params.run, sample_s);
    let gap = |a: usize, b: usize| (b - a) as f64 * sample_s;
    let mut merged: Vec<Run> = Vec::new();
    for run in fast {
        let (start, end, sign) = run;
        let change = heading_rad[end] - heading_rad[start];
        match merged.last_mut() {
            Some(last) if last.change * sign > 0.0 && gap(last.end, start) < params.run.gap_s => {
                last.end = end;
                last.change = heading_rad[end] - heading_rad[last.start];
            }
            _ if change * sign > 0.0 => merged.push(Run { start, end, change }),
            _ => {}
        }
    }
    merged.retain(|run| run.change.abs() >= params.turn_detectable_rad);
    let mut all = with_slow_runs(merged, &smooth, (heading_rad, speed_mps), params, sample_s);
    let blur = samples_of(3.0 * params.run.smoothing_s, sample_s);
    let mut before = 0;
    for run in &mut all {
        let from = run.start.saturating_sub(blur).max(before).min(run.start);
        run.start = last_unturned(&heading_rad[from..=run.end], run, params) + from;
        run.change = heading_rad[run.end] - heading_rad[run.start];
        before = run.end;
    }
    all
}

/// The mean shows a turn seconds before it is made; the heading itself tells when it was: at the
/// last sample that is as far to the other side as any before the turn can be seen.
fn last_unturned(heading_rad: &[f64], run: &Run, params: &Params) -> usize {
    let as_far_rad = params.turn_detectable_rad / 10.0;
    let sign = run.change.signum();
    let (mut at, mut furthest) = (0, sign * heading_rad[0]);
    for (k, heading) in heading_rad.iter().enumerate() {
        let now = sign * heading;
        if now <= furthest + as_far_rad {
            (at, furthest) = (k, furthest.min(now));
        } else if now >= furthest + params.turn_detectable_rad {
            break;
        }
    }
    at
}

/// Runs of the speed: contiguous intervals between samples in which it changes by
/// `acceleration_mps2` or more, and by a detectable share of the speed in all. A mean over two
/// intervals would halve a change made in one. `change_mps` is what is left of the speed when the
/// plan's is taken off.
pub fn speed_runs(
    change_mps: &[f64],
    speed_mps: &[f64],
    params: &Params,
    sample_s: f64,
) -> Vec<Run> {
    let rates: Vec<f64> = change_mps.windows(2).map(|u| (u[1] - u[0]) / sample_s).collect();
    let side = |rate: &f64| {
        if rate.abs() < params.run.acceleration_mps2 { 0.0 } else { rate.signum() }
    };
    let mut runs: Vec<Run> = Vec::new();
    let mut start = 0;
    for stretch in rates.chunk_by(|a, b| side(a).total_cmp(&side(b)).is_eq()) {
        let end = start + stretch.len();
        let change = change_mps[end] - change_mps[start];
        let seen = change.abs() >= params.speed_detectable * speed_mps[start];
        if side(&stretch[0]).abs() > 0.0 && seen {
            runs.push(Run { start, end, change });
        }
        start = end;
    }
    runs
}

/// First sample, last sample and side of every stretch that is turned at `q_on` or more.
fn fast_runs(
    rate: &[f64],
    speed_mps: &[f64],
    on_radps: f64,
    rule: &RunParams,
    sample_s: f64,
) -> Vec<(usize, usize, f64)> {
    let quiet = samples_of(rule.quiet_s, sample_s);
    let last = rate.len() - 1;
    let mut runs = Vec::new();
    let mut k = 0;
    while k <= last {
        if rate[k].abs() < on_radps || speed_mps[k] < rule.moving_mps {
            k += 1;
            continue;
        }
        let (start, sign) = (k, rate[k].signum());
        let mut quiet_for = 0;
        let mut end = last;
        for (at, (q, speed)) in rate.iter().zip(speed_mps).enumerate().skip(start + 1) {
            if q * sign < 0.0 || *speed < rule.moving_mps {
                end = at - quiet_for;
                break;
            }
            quiet_for = if q.abs() < on_radps / 2.0 { quiet_for + 1 } else { 0 };
            if quiet_for > quiet {
                end = at - quiet;
                break;
            }
        }
        runs.push((start, end, sign));
        k = end.max(start) + 1;
    }
    runs
}

/// Adds the turns that are large enough but too slow to reach `q_on`, between the others and while
/// she has way: a ship that lies still and swings does not manoeuvre.
fn with_slow_runs(
    fast: Vec<Run>,
    smooth: &[f64],
    (heading_rad, speed_mps): (&[f64], &[f64]),
    params: &Params,
    sample_s: f64,
) -> Vec<Run> {
    let mut all = Vec::with_capacity(fast.len());
    let between = |from: usize, to: usize, all: &mut Vec<Run>| {
        let has_way = |k: &usize| speed_mps[*k] >= params.run.moving_mps;
        let mut begin = from;
        while let Some(start) = (begin..=to).find(has_way) {
            let end = (start..=to).find(|k| !has_way(k)).map_or(to, |still| still - 1);
            slow_runs(smooth, heading_rad, start, end, params, sample_s, all);
            begin = end + 1;
        }
    };
    let mut from = 0;
    for run in &fast {
        between(from, run.start, &mut all);
        all.push(*run);
        from = run.end;
    }
    between(from, smooth.len() - 1, &mut all);
    all
}

fn slow_runs(
    smooth: &[f64],
    heading_rad: &[f64],
    from: usize,
    to: usize,
    params: &Params,
    sample_s: f64,
    all: &mut Vec<Run>,
) {
    let enough_rad = params.turn_action_rad;
    if to <= from || extent(&smooth[from..=to]) < enough_rad {
        return;
    }
    let window = samples_of(params.run.slow_s, sample_s);
    let patience = samples_of(params.run.gap_s, sample_s);
    let mut begin = from;
    let mut k = from + 1;
    while k <= to {
        let first = begin.max(k.saturating_sub(window));
        // The latest sample that is far enough away: the turn is as short as it can be.
        let Some(start) = (first..k).rev().find(|i| (smooth[k] - smooth[*i]).abs() >= enough_rad)
        else {
            k += 1;
            continue;
        };
        let sign = (smooth[k] - smooth[start]).signum();
        let mut end = k;
        for at in k + 1..=to {
            if (smooth[at] - smooth[end]) * sign > 0.0 {
                end = at;
            } else if at - end >= patience {
                break;
            }
        }
        all.push(Run { start, end, change: heading_rad[end] - heading_rad[start] });
        begin = end;
        k = end + 1;
    }
}

/// Gaussian mean, the kernel cut at three standard deviations and at the ends of the track.
pub(crate) fn smoothed(values: &[f64], deviation_s: f64, sample_s: f64) -> Vec<f64> {
    let reach = (3.0 * deviation_s / sample_s).ceil();
    let reach = if reach > 0.0 { reach as usize } else { 0 };
    let weight = |i: usize| {
        let z = i as f64 * sample_s / deviation_s;
        libm::exp(-0.5 * z * z)
    };
    let kernel: Vec<f64> = (0..=reach).map(weight).collect();
    let total = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
    let last = values.len().saturating_sub(1);
    // Beyond its ends the signal goes on as it came, turned about its end point: a ship that starts
    // the run turning has her rate from the first sample on.
    let at = |k: isize| match usize::try_from(k) {
        Err(_) => 2.0 * values[0] - values[k.unsigned_abs().min(last)],
        Ok(k) if k > last => 2.0 * values[last] - values[last - (k - last).min(last)],
        Ok(k) => values[k],
    };
    let smooth = |k: usize| {
        let around = kernel.iter().enumerate().skip(1);
        let sum: f64 =
            around.map(|(i, w)| w * (at(k as isize - i as isize) + at((k + i) as isize))).sum();
        (kernel[0] * values[k] + sum) / total
    };
    (0..values.len()).map(smooth).collect()
}

/// Central difference, one-sided at the ends.
fn derivative(values: &[f64], sample_s: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|k| {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
            if b > a { (values[b] - values[a]) / ((b - a) as f64 * sample_s) } else { 0.0 }
        })
        .collect()
}

fn extent(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    high - low
}
