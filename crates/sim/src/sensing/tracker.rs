//! The tracker: plots and reports become tracks.
//!
//! * A report belongs to the track with its identity; the first one takes over the nearest radar
//!   track within the gate, or starts a track, which is confirmed at once. A report outside the
//!   gate of its own track starts the filter anew; plots that had led the track elsewhere go on as
//!   a track without a name.
//! * Plots of one scan and the tracks within the gate are paired, confirmed tracks first and then
//!   by likelihood; a plot that is left over starts a tentative track. So many plots in so many
//!   scans confirm it, too few drop it.
//! * A track that nothing has fed for too long is lost.
//! * A confirmed track without a name is taken for a ship with one if the two cannot be told
//!   apart, or if nothing has fed the ship's own track since and she could be there after a
//!   manoeuvre. Never if the same scans fed both: then there are two ships.
//! * A measurement that is older than its track is moved forward with the track's velocity.

use super::Measurement;
use super::track::Track;
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

/// How much more a ship that alters accelerates than the filter expects.
const MANOEUVRE: f64 = 12.0;
/// So many plots of nothing may have fed one of two tracks of the same ship beside her own.
const SHARED_BY_CLUTTER: u32 = 1;

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
        let gate = self.settings.gate;
        let known = self.tracks.iter().position(|track| track.mmsi == Some(report.mmsi));
        if let Some(index) = known.filter(|i| self.tracks[*i].distance2(m) > gate) {
            self.begin_again(index, m);
        }
        let near = || {
            let nameless = self.tracks.iter().enumerate().filter(|(_, t)| t.mmsi.is_none());
            let within = nameless.map(|(i, t)| (i, t.distance2(m)));
            let within = within.filter(|(_, distance2)| *distance2 <= gate);
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

    /// Starts the filter of a named track anew at a report outside its gate. If enough plots led
    /// it there since the report before, they are another ship's, and keep what they made.
    fn begin_again(&mut self, index: usize, m: &Measurement) {
        let fresh = self.start(m);
        let fresh = self.tracks.remove(fresh);
        let track = &mut self.tracks[index];
        let mut led = track.clone();
        led.plots.scans = led.plots.since_report;
        (track.filter, track.t_s, track.updated_s) = (fresh.filter, fresh.t_s, fresh.updated_s);
        track.plots = fresh.plots;
        if led.plots.led() >= self.settings.confirm_hits {
            let (psi_rad, size_m) = (None, None);
            self.tracks.push(Track { id: fresh.id, mmsi: None, psi_rad, size_m, ..led });
        }
    }

    /// Takes in the plots of one scan, all of one time, at `t_s`.
    pub fn scan(&mut self, t_s: f64, plots: &[Measurement]) {
        let density = self.density();
        let true_s = plots.first().map_or(t_s, |plot| plot.t_s);
        for track in &mut self.tracks {
            track.bring_to(true_s, density);
        }
        let mut used = vec![false; plots.len()];
        for (i, k) in self.pairs(plots) {
            if !used[k] && !self.tracks[i].plots.fed {
                used[k] = true;
                let distance2 = self.tracks[i].feed(&plots[k]);
                self.count(distance2);
            }
        }
        for (plot, _) in plots.iter().zip(&used).filter(|(_, used)| !**used) {
            let index = self.start(plot);
            let track = &mut self.tracks[index];
            track.updated_s = plot.t_s;
            track.plots.take(plot.t_s);
        }
        self.confirm(t_s);
        self.recognise();
    }

    /// Tracks and plots within the gate of each other, the best pair first.
    fn pairs(&self, plots: &[Measurement]) -> Vec<(usize, usize)> {
        let mut pairs: Vec<(bool, f64, usize, usize)> = Vec::new();
        for (i, track) in self.tracks.iter().enumerate() {
            for (k, plot) in plots.iter().enumerate() {
                if track.distance2(plot) <= self.settings.gate {
                    pairs.push((track.confirmed_s.is_none(), track.surprise(plot), i, k));
                }
            }
        }
        let order = |p: &(bool, f64, usize, usize)| (p.0, p.2, p.3);
        pairs.sort_by(|a, b| {
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then_with(|| order(a).cmp(&order(b)))
        });
        pairs.into_iter().map(|(_, _, i, k)| (i, k)).collect()
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
        self.tracks.push(Track::new(self.next_id, m, speed_mps2));
        self.next_id += 1;
        self.tracks.len() - 1
    }

    fn confirm(&mut self, t_s: f64) {
        let Settings { confirm_hits, confirm_scans, .. } = self.settings;
        for track in &mut self.tracks {
            track.plots.close_scan();
            if track.confirmed_s.is_none() && track.plots.hits(confirm_scans) >= confirm_hits {
                track.confirmed_s = Some(t_s);
            }
        }
        self.tracks.retain(|t| t.confirmed_s.is_some() || t.plots.scans_seen < confirm_scans);
    }

    /// Takes nameless tracks for the named ships that they are of.
    fn recognise(&mut self) {
        let mut k = 0;
        while k < self.tracks.len() {
            let other = &self.tracks[k];
            let nameless = other.mmsi.is_none() && other.confirmed_s.is_some();
            let named = |i: &usize| nameless && self.tracks[*i].mmsi.is_some();
            let home = (0..self.tracks.len()).filter(named).find_map(|i| {
                let track = &self.tracks[i];
                let turned = self.has_turned(track, other);
                (turned || self.are_same(track, other)).then_some((i, turned))
            });
            match home {
                Some((i, turned)) => {
                    let other = self.tracks[k].clone();
                    self.tracks[i].take_over(&other, turned);
                    self.tracks.remove(k);
                }
                None => k += 1,
            }
        }
    }

    /// Whether a nameless track cannot be told from a named one.
    fn are_same(&self, named: &Track, nameless: &Track) -> bool {
        named.plots.shared(&nameless.plots) <= SHARED_BY_CLUTTER
            && named.may_be(nameless, self.settings.gate, 0.0, 0.0)
    }

    /// Whether the ship of a named track could be where a nameless one is after a manoeuvre that
    /// led her out of the gate of her own. The second plot of the nameless one counts, for its
    /// first may have been a plot of nothing.
    fn has_turned(&self, named: &Track, nameless: &Track) -> bool {
        let density = self.density() * MANOEUVRE * MANOEUVRE;
        let since_s = nameless.t_s - named.updated_s;
        nameless.plots.again_s.is_some_and(|again_s| again_s >= named.updated_s)
            && named.plots.shared(&nameless.plots) == 0
            && named.may_be(nameless, self.settings.gate, density, since_s)
    }
}
