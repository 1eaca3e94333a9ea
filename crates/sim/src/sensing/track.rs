//! One track of the tracker: a filter, when it was fed and by what, and what its ship says of
//! herself.

use super::Measurement;
use super::kalman::{Cov, Kalman, inverse};
use geom::{Vec2, angle};
use planner_api::TargetTrack;

/// A track.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) id: u32,
    pub(super) filter: Kalman,
    /// The time of the filter, seconds.
    pub(super) t_s: f64,
    /// When the latest measurement that fed it was true, seconds.
    pub(super) updated_s: f64,
    pub(super) confirmed_s: Option<f64>,
    pub(super) plots: Plots,
    pub(super) mmsi: Option<u32>,
    pub(super) psi_rad: Option<f64>,
    /// Length and beam, metres.
    pub(super) size_m: Option<(f64, f64)>,
    pub(super) origin: Option<u8>,
}

/// Which scans of the radar fed a track.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plots {
    /// One bit a scan, the latest lowest: fed or not.
    pub(super) scans: u64,
    pub(super) scans_seen: u32,
    /// Whether the scan at hand fed it.
    pub(super) fed: bool,
    /// Those since the last report of its ship, or since it began.
    pub(super) since_report: u64,
    /// The time of the second of these: the first may be of another ship or of nothing.
    pub(super) again_s: Option<f64>,
}

impl Plots {
    /// A plot of the scan at hand, at `t_s`.
    pub(super) fn take(&mut self, t_s: f64) {
        self.fed = true;
        if self.since_report.count_ones() == 1 {
            self.again_s = Some(t_s);
        }
    }

    /// Closes the scan at hand.
    pub(super) fn close_scan(&mut self) {
        self.scans = self.scans << 1 | u64::from(self.fed);
        self.since_report = self.since_report << 1 | u64::from(self.fed);
        self.scans_seen = self.scans_seen.saturating_add(1);
        self.fed = false;
    }

    /// In how many scans it was fed since the last report of its ship.
    pub(super) fn led(&self) -> u32 {
        self.since_report.count_ones()
    }

    /// In how many of the latest scans it was fed.
    pub(super) fn hits(&self, scans: u32) -> u32 {
        let window = if scans >= u64::BITS { u64::MAX } else { (1 << scans) - 1 };
        (self.scans & window).count_ones()
    }

    /// How many scans fed both.
    pub(super) fn shared(&self, other: &Self) -> u32 {
        (self.scans & other.scans).count_ones()
    }
}

/// Below this speed a track has no course of its own, m/s; that of a trace.
const STOPPED_MPS: f64 = 1e-6;

impl Track {
    /// A track at a measurement, which has not fed it yet; `speed_mps2` is the variance of each
    /// component of the unknown velocity.
    pub(super) fn new(id: u32, m: &Measurement, speed_mps2: f64) -> Self {
        let (velocity_mps, velocity_mps2) = (Vec2::zeros(), Cov::identity() * speed_mps2);
        // a report feeds its track right away; twice the same position would count double
        let wide = if m.report.is_some() { 1e6 } else { 1.0 };
        Self {
            id,
            filter: Kalman::new(m.position_m, m.position_m2 * wide, velocity_mps, velocity_mps2),
            t_s: m.t_s,
            updated_s: -1.0,
            confirmed_s: None,
            plots: Plots::default(),
            mmsi: None,
            psi_rad: None,
            size_m: None,
            origin: m.origin,
        }
    }

    pub(super) fn bring_to(&mut self, t_s: f64, density: f64) {
        if t_s > self.t_s {
            self.filter.predict(t_s - self.t_s, density);
            self.t_s = t_s;
        }
    }

    /// The measured position at the time of the track, and its covariance.
    fn at_track_time(&self, m: &Measurement) -> (Vec2, Cov) {
        let late_s = (self.t_s - m.t_s).max(0.0);
        let drift_m2 = self.filter.velocity_mps2 * (late_s * late_s);
        (m.position_m + self.filter.velocity_mps * late_s, m.position_m2 + drift_m2)
    }

    /// Squared Mahalanobis distance of a measurement.
    pub(super) fn distance2(&self, m: &Measurement) -> f64 {
        let (position_m, noise_m2) = self.at_track_time(m);
        self.filter.distance2(position_m, &noise_m2)
    }

    /// How unlikely a measurement is: less two times the logarithm of its density, but for a
    /// constant.
    pub(super) fn surprise(&self, m: &Measurement) -> f64 {
        let (position_m, noise_m2) = self.at_track_time(m);
        let spread_m2 = self.filter.position_m2 + noise_m2;
        self.filter.distance2(position_m, &noise_m2) + geom::math::ln(spread_m2.determinant())
    }

    /// Takes in a measurement; its squared Mahalanobis distance.
    pub(super) fn feed(&mut self, m: &Measurement) -> f64 {
        let (position_m, noise_m2) = self.at_track_time(m);
        let distance2 = self.filter.update_position(position_m, &noise_m2);
        self.updated_s = self.updated_s.max(m.t_s);
        self.origin = m.origin;
        match &m.report {
            Some(report) => {
                self.filter.update_velocity(report.velocity_mps, &report.velocity_mps2);
                self.mmsi = Some(report.mmsi);
                self.psi_rad = report.psi_rad;
                self.size_m = report.size_m;
                (self.plots.since_report, self.plots.again_s) = (0, None);
            }
            None => self.plots.take(m.t_s),
        }
        distance2
    }

    /// Whether two tracks cannot be told from each other at a gate, after white acceleration of
    /// `density` that the filter of this one did not expect, for `extra_s`.
    pub(super) fn may_be(&self, other: &Self, gate: f64, density: f64, extra_s: f64) -> bool {
        let mut filter = self.filter;
        let unit = Cov::identity() * (density * extra_s);
        filter.position_m2 += unit * (extra_s * extra_s / 3.0);
        filter.velocity_mps2 += unit;
        let off_m = filter.position_m - other.filter.position_m;
        let off_mps = filter.velocity_mps - other.filter.velocity_mps;
        let sum_m2 = filter.position_m2 + other.filter.position_m2;
        let sum_mps2 = filter.velocity_mps2 + other.filter.velocity_mps2;
        off_m.dot(&(inverse(&sum_m2) * off_m)) <= gate
            && off_mps.dot(&(inverse(&sum_mps2) * off_mps)) <= gate
    }

    /// Goes on with what a nameless track of the same ship knows: with its filter if she has
    /// `turned` or if it is sharper.
    pub(super) fn take_over(&mut self, other: &Self, turned: bool) {
        if turned || other.filter.position_m2.trace() < self.filter.position_m2.trace() {
            (self.filter, self.t_s) = (other.filter, other.t_s);
        }
        if other.updated_s >= self.updated_s {
            (self.updated_s, self.origin) = (other.updated_s, other.origin);
        }
        self.plots.scans |= other.plots.scans;
        self.plots.since_report |= other.plots.since_report;
    }

    /// What a planner is shown of a confirmed track.
    pub(super) fn shown(&self, t_s: f64, density: f64) -> Option<TargetTrack> {
        let age_s = t_s - self.confirmed_s?;
        let mut now = self.filter;
        now.predict((t_s - self.t_s).max(0.0), density);
        let sog_mps = now.velocity_mps.norm();
        let stopped = sog_mps < STOPPED_MPS;
        Some(TargetTrack {
            id: self.id,
            position_m: now.position_m,
            velocity_mps: now.velocity_mps,
            cog_rad: if stopped { 0.0 } else { geom::wrap(angle::direction(now.velocity_mps)) },
            sog_mps,
            psi_rad: self.psi_rad,
            length_m: self.size_m.map(|size_m| size_m.0),
            beam_m: self.size_m.map(|size_m| size_m.1),
            covariance: now.covariance(),
            age_s,
            since_update_s: t_s - self.updated_s,
        })
    }
}
