//! The tracker: plots and reports become tracks.
//!
//! * A report belongs to the track with its identity; the first one takes over the nearest radar
//!   track within the gate, or starts a track, which is confirmed at once.
//! * Plots of one scan and the tracks within the gate are paired nearest first (by squared
//!   Mahalanobis distance); a plot that is left over starts a tentative track. So many plots in so
//!   many scans confirm it, too few drop it.
//! * A track that nothing has fed for too long is lost. A radar track that cannot be told from a
//!   track with an identity is merged into it.
//! * A measurement that is older than its track is moved forward with the track's velocity.

use super::Measurement;
use super::kalman::{Cov, Kalman, inverse};
use geom::{Vec2, angle};
use planner_api::TargetTrack;
use record::Tracker as Settings;

/// The tracks of one run.
#[derive(Clone, Debug)]
pub struct Tracker {
    settings: Settings,
    tracks: Vec<Track>,
    next_id: u32,
    /// Squared Mahalanobis distances of all position updates, and how many there were.
    innovations: (f64, u64),
}

#[derive(Clone, Debug)]
struct Track {
    id: u32,
    filter: Kalman,
    t_s: f64,
    updated_s: f64,
    confirmed_s: Option<f64>,
    /// One bit a scan, the latest lowest: fed or not.
    scans: u32,
    scans_seen: u32,
    fed: bool,
    mmsi: Option<u32>,
    psi_rad: Option<f64>,
    size_m: Option<(f64, f64)>,
    origin: Option<u8>,
}

/// Below this speed a track has no course of its own, m/s; that of a trace.
const STOPPED_MPS: f64 = 1e-6;

impl Track {
    fn bring_to(&mut self, t_s: f64, density: f64) {
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

    fn distance2(&self, m: &Measurement) -> f64 {
        let (position_m, noise_m2) = self.at_track_time(m);
        self.filter.distance2(position_m, &noise_m2)
    }

    fn feed(&mut self, m: &Measurement) -> f64 {
        let (position_m, noise_m2) = self.at_track_time(m);
        let distance2 = self.filter.update_position(position_m, &noise_m2);
        self.updated_s = self.updated_s.max(m.t_s);
        self.fed = true;
        self.origin = m.origin;
        if let Some(report) = &m.report {
            self.filter.update_velocity(report.velocity_mps, &report.velocity_mps2);
            self.mmsi = Some(report.mmsi);
            self.psi_rad = report.psi_rad;
            self.size_m = report.size_m;
        }
        distance2
    }

    fn shown(&self, t_s: f64, density: f64) -> Option<TargetTrack> {
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

impl Tracker {
    /// No tracks yet.
    pub fn new(settings: &Settings) -> Self {
        Self { settings: *settings, tracks: Vec::new(), next_id: 0, innovations: (0.0, 0) }
    }

    fn density(&self) -> f64 {
        self.settings.acceleration_sd_mps2 * self.settings.acceleration_sd_mps2
    }

    /// Takes in one AIS report at `t_s`.
    pub fn report(&mut self, t_s: f64, m: &Measurement) {
        let Some(report) = &m.report else { return };
        let density = self.density();
        for track in &mut self.tracks {
            track.bring_to(m.t_s, density);
        }
        let known = self.tracks.iter().position(|track| track.mmsi == Some(report.mmsi));
        let near = || {
            let nameless = self.tracks.iter().enumerate().filter(|(_, t)| t.mmsi.is_none());
            let within = nameless.map(|(i, t)| (i, t.distance2(m)));
            let within = within.filter(|(_, distance2)| *distance2 <= self.settings.gate);
            within.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
        };
        let index = known.or_else(near).unwrap_or_else(|| self.start(m));
        let new = self.tracks[index].updated_s < 0.0;
        let distance2 = self.tracks[index].feed(m);
        if !new {
            self.count(distance2);
        }
        self.tracks[index].confirmed_s.get_or_insert(t_s);
    }

    /// Takes in the plots of one scan, all of one time, at `t_s`.
    pub fn scan(&mut self, t_s: f64, plots: &[Measurement]) {
        let density = self.density();
        let true_s = plots.first().map_or(t_s, |plot| plot.t_s);
        for track in &mut self.tracks {
            track.bring_to(true_s, density);
            track.fed = false;
        }
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (i, track) in self.tracks.iter().enumerate() {
            for (k, plot) in plots.iter().enumerate() {
                let distance2 = track.distance2(plot);
                if distance2 <= self.settings.gate {
                    pairs.push((distance2, i, k));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut used = vec![false; plots.len()];
        for (distance2, i, k) in pairs {
            if !used[k] && !self.tracks[i].fed {
                used[k] = true;
                self.tracks[i].feed(&plots[k]);
                self.count(distance2);
            }
        }
        for (plot, _) in plots.iter().zip(&used).filter(|(_, used)| !**used) {
            let index = self.start(plot);
            let track = &mut self.tracks[index];
            (track.fed, track.updated_s) = (true, plot.t_s);
        }
        self.confirm(t_s);
        self.merge();
    }

    /// Forgets tracks that nothing has fed for too long.
    pub fn drop_lost(&mut self, t_s: f64) {
        let settings = &self.settings;
        self.tracks.retain(|track| {
            let named = track.mmsi.is_some();
            let most_s = if named { settings.ais_coast_s_max } else { settings.radar_coast_s_max };
            t_s - track.updated_s <= most_s
        });
    }

    /// The confirmed tracks at `t_s`.
    pub fn show(&self, t_s: f64, shown: &mut Vec<TargetTrack>) {
        shown.clear();
        shown.extend(self.tracks.iter().filter_map(|track| track.shown(t_s, self.density())));
    }

    /// The target behind a track, by its latest measurement.
    pub fn origin(&self, id: u32) -> Option<u8> {
        self.tracks.iter().find(|track| track.id == id).and_then(|track| track.origin)
    }

    /// Targets with a confirmed track.
    pub fn confirmed_origins(&self) -> impl Iterator<Item = u8> + '_ {
        self.tracks.iter().filter(|t| t.confirmed_s.is_some()).filter_map(|t| t.origin)
    }

    /// Sum of the squared Mahalanobis distances of all position updates, and how many.
    pub fn innovations(&self) -> (f64, u64) {
        self.innovations
    }

    fn count(&mut self, distance2: f64) {
        self.innovations.0 += distance2;
        self.innovations.1 += 1;
    }

    /// A new track at a measurement, which has not fed it yet; its index.
    fn start(&mut self, m: &Measurement) -> usize {
        let speed_mps2 = self.settings.speed_sd_mps * self.settings.speed_sd_mps;
        let (velocity_mps, velocity_mps2) = (Vec2::zeros(), Cov::identity() * speed_mps2);
        // a report feeds its track right away; twice the same position would count double
        let wide = if m.report.is_some() { 1e6 } else { 1.0 };
        let filter = Kalman::new(m.position_m, m.position_m2 * wide, velocity_mps, velocity_mps2);
        self.tracks.push(Track {
            id: self.next_id,
            filter,
            t_s: m.t_s,
            updated_s: -1.0,
            confirmed_s: None,
            scans: 0,
            scans_seen: 0,
            fed: false,
            mmsi: None,
            psi_rad: None,
            size_m: None,
            origin: m.origin,
        });
        self.next_id += 1;
        self.tracks.len() - 1
    }

    fn confirm(&mut self, t_s: f64) {
        let Settings { confirm_hits, confirm_scans, .. } = self.settings;
        let window = if confirm_scans >= 32 { u32::MAX } else { (1 << confirm_scans) - 1 };
        for track in &mut self.tracks {
            track.scans = (track.scans << 1 | u32::from(track.fed)) & window;
            track.scans_seen = track.scans_seen.saturating_add(1);
            if track.confirmed_s.is_none() && track.scans.count_ones() >= confirm_hits {
                track.confirmed_s = Some(t_s);
            }
        }
        self.tracks.retain(|t| t.confirmed_s.is_some() || t.scans_seen < confirm_scans);
    }

    /// Merges radar tracks into the tracks with an identity that they cannot be told from.
    fn merge(&mut self) {
        let gate = self.settings.gate;
        let mut k = 0;
        while k < self.tracks.len() {
            let other = &self.tracks[k];
            let same = |track: &Track| {
                let off_m = track.filter.position_m - other.filter.position_m;
                let off_mps = track.filter.velocity_mps - other.filter.velocity_mps;
                let sum_m2 = track.filter.position_m2 + other.filter.position_m2;
                let sum_mps2 = track.filter.velocity_mps2 + other.filter.velocity_mps2;
                off_m.dot(&(inverse(&sum_m2) * off_m)) <= gate
                    && off_mps.dot(&(inverse(&sum_mps2) * off_mps)) <= gate
            };
            let home = if other.mmsi.is_none() {
                self.tracks.iter().position(|track| track.mmsi.is_some() && same(track))
            } else {
                None
            };
            match home {
                Some(home) => {
                    let sharper = other.filter.position_m2.trace()
                        < self.tracks[home].filter.position_m2.trace();
                    let (filter, updated_s) = (other.filter, other.updated_s);
                    let kept = &mut self.tracks[home];
                    if sharper {
                        kept.filter = filter;
                    }
                    kept.updated_s = kept.updated_s.max(updated_s);
                    self.tracks.remove(k);
                }
                None => k += 1,
            }
        }
    }
}
