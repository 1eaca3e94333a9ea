//! Radar: plots of targets and of nothing, once a turn of the antenna.
//!
//! Every target has a stream of its own and draws the same numbers in every scan, seen or not;
//! clutter has another. So what own ship does changes no error, and one target more or less changes
//! nobody else's.

use super::Measurement;
use super::ais::VARIANCE_MIN;
use super::kalman::oriented;
use crate::pose::Pose;
use crate::ship::Ship;
use geom::{Vec2, angle, math};
use record::{Purpose, Radar, Stream, Streams};
use std::f64::consts::PI;

/// The radar of own ship.
#[derive(Clone, Debug)]
pub struct Scanner {
    targets: Vec<Stream>,
    clutter: Stream,
    next_s: f64,
}

impl Scanner {
    /// A radar at a random phase of its turn.
    pub fn new(radar: &Radar, streams: &Streams, targets: usize) -> Self {
        let mut clutter = streams.stream(Purpose::Radar, 0);
        let next_s = clutter.uniform() * radar.rotation_s;
        let targets = (0..targets).map(|i| streams.stream(Purpose::Radar, i as u8 + 1)).collect();
        Self { targets, clutter, next_s }
    }

    /// Whether a scan was completed by `t_s`; its plots, all of the beat's instant, are added.
    pub fn scan(
        &mut self,
        radar: &Radar,
        t_s: f64,
        own: &Pose,
        targets: &[Ship],
        plots: &mut Vec<Measurement>,
    ) -> bool {
        if t_s < self.next_s {
            return false;
        }
        self.next_s += radar.rotation_s;
        let plot = |range_m: f64, direction: Vec2, origin: Option<u8>| {
            let along = radar.range_sd_m * radar.range_sd_m;
            let across_m = range_m * radar.bearing_sd_rad;
            Measurement {
                t_s,
                ready_s: t_s + radar.latency_s,
                origin,
                position_m: own.position_m + direction * range_m,
                position_m2: oriented(
                    direction,
                    along.max(VARIANCE_MIN),
                    (across_m * across_m).max(VARIANCE_MIN),
                ),
                report: None,
            }
        };
        for ((stream, target), index) in self.targets.iter_mut().zip(targets).zip(0u8..) {
            let chance = stream.uniform();
            let range_error_m = radar.range_sd_m * stream.normal();
            let bearing_error_rad = radar.bearing_sd_rad * stream.normal();
            let offset_m = target.pose.position_m - own.position_m;
            let range_m = offset_m.norm();
            if chance < probability(radar, range_m) {
                let direction = angle::rotate(offset_m / range_m, bearing_error_rad);
                plots.push(plot((range_m + range_error_m).max(1.0), direction, Some(index)));
            }
        }
        for _ in 0..poisson(radar.clutter_per_scan, &mut self.clutter) {
            let range_m = radar.clutter_range_m * self.clutter.uniform().sqrt();
            let direction = angle::unit(self.clutter.uniform_in(-PI, PI));
            plots.push(plot(range_m.max(1.0), direction, None));
        }
        true
    }
}

/// Probability of a plot of a target at a range.
pub fn probability(radar: &Radar, range_m: f64) -> f64 {
    if range_m > radar.range_m_max || range_m <= 0.0 {
        return 0.0;
    }
    let share = range_m / radar.range_m_half;
    let square = share * share;
    radar.detection_probability / (1.0 + square * square)
}

/// A draw of a Poisson law, by counting exponential waits; for means of a few.
fn poisson(mean: f64, stream: &mut Stream) -> u32 {
    if mean <= 0.0 {
        return 0;
    }
    let (mut count, floor) = (0, math::exp(-mean));
    let mut product = stream.uniform();
    while product > floor {
        count += 1;
        product *= stream.uniform();
    }
    count
}
