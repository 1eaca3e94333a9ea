//! AIS and radar through one tracker: measurements wait for their latency, then feed tracks.

use super::Measurement;
use super::ais::Transponder;
use super::radar::Scanner;
use super::tracker::Tracker;
use crate::ship::Ship;
use planner_api::TargetTrack;
use record::{AisRadar, Encounter, Purpose, Stream, Streams};

/// Sensors and tracker of one run.
#[derive(Clone, Debug)]
pub struct Fused {
    settings: AisRadar,
    instruments: Instruments,
    waiting: Vec<Measurement>,
    /// Times at which a scan without any plot reaches the tracker.
    empty_scans_s: Vec<f64>,
    tracker: Tracker,
    frames: Stream,
    /// The picture of the last frame that was not dropped, and its time.
    picture: (f64, Vec<TargetTrack>),
    detected_s: Vec<Option<f64>>,
    tracked_s: Vec<Option<f64>>,
}

/// What measures.
#[derive(Clone, Debug)]
pub struct Instruments {
    transponders: Vec<Transponder>,
    scanner: Option<Scanner>,
}

impl Instruments {
    /// The instruments of an encounter.
    pub fn new(settings: &AisRadar, encounter: &Encounter, targets: &[Ship]) -> Self {
        let streams = Streams::new(encounter.seed, &encounter.id);
        let transponders = settings.ais.iter().flat_map(|ais| {
            let ships = targets.iter().zip(0u8..);
            ships.map(|(ship, index)| Transponder::new(ais, &streams, index, ship))
        });
        Self {
            transponders: transponders.collect(),
            scanner: settings.radar.map(|radar| Scanner::new(&radar, &streams, targets.len())),
        }
    }

    /// Measures at `t_s`; whether a scan of the radar was completed.
    pub fn measure(
        &mut self,
        settings: &AisRadar,
        t_s: f64,
        own: &Ship,
        targets: &[Ship],
        out: &mut Vec<Measurement>,
    ) -> bool {
        if let Some(ais) = &settings.ais {
            for (transponder, target) in self.transponders.iter_mut().zip(targets) {
                out.extend(transponder.hear(ais, t_s, target));
            }
        }
        match (&mut self.scanner, &settings.radar) {
            (Some(scanner), Some(radar)) => scanner.scan(radar, t_s, &own.pose, targets, out),
            _ => false,
        }
    }
}

impl Fused {
    /// The sensors of an encounter at time 0.
    pub fn new(settings: &AisRadar, encounter: &Encounter, targets: &[Ship]) -> Self {
        let streams = Streams::new(encounter.seed, &encounter.id);
        Self {
            settings: *settings,
            instruments: Instruments::new(settings, encounter, targets),
            waiting: Vec::new(),
            empty_scans_s: Vec::new(),
            tracker: Tracker::new(&settings.tracker),
            frames: streams.stream(Purpose::Tracker, 0),
            picture: (0.0, Vec::new()),
            detected_s: vec![None; targets.len()],
            tracked_s: vec![None; targets.len()],
        }
    }

    /// Looks at the world at `t_s` and writes the tracks.
    pub fn look(&mut self, t_s: f64, own: &Ship, targets: &[Ship], tracks: &mut Vec<TargetTrack>) {
        let plots_before = self.plots_waiting();
        let scanned =
            self.instruments.measure(&self.settings, t_s, own, targets, &mut self.waiting);
        if scanned && self.plots_waiting() == plots_before {
            let latency_s = self.settings.radar.map_or(0.0, |radar| radar.latency_s);
            self.empty_scans_s.push(t_s + latency_s);
        }
        self.deliver(t_s);
        self.tracker.drop_lost(t_s);
        for index in self.tracker.confirmed_origins() {
            self.tracked_s[usize::from(index)].get_or_insert(t_s);
        }
        if self.frames.uniform() >= self.settings.tracker.frame_drop {
            self.picture.0 = t_s;
            self.tracker.show(t_s, &mut self.picture.1);
        }
        let stale_s = t_s - self.picture.0;
        tracks.clear();
        tracks.extend(self.picture.1.iter().map(|track| TargetTrack {
            age_s: track.age_s + stale_s,
            since_update_s: track.since_update_s + stale_s,
            ..*track
        }));
    }

    fn plots_waiting(&self) -> usize {
        self.waiting.iter().filter(|m| m.report.is_none()).count()
    }

    /// Feeds the tracker with what is ready: reports one by one, plots scan by scan.
    fn deliver(&mut self, t_s: f64) {
        let mut ready: Vec<Measurement> = Vec::new();
        self.waiting.retain(|m| {
            let due = m.ready_s <= t_s;
            if due {
                ready.push(*m);
            }
            !due
        });
        for m in &ready {
            if let Some(origin) = m.origin {
                self.detected_s[usize::from(origin)].get_or_insert(t_s);
            }
            self.tracker.report(t_s, m);
        }
        let mut plots: Vec<Measurement> =
            ready.into_iter().filter(|m| m.report.is_none()).collect();
        while let Some(first) = plots.first() {
            let scan_s = first.t_s;
            let (scan, later) = plots.into_iter().partition(|m| m.t_s <= scan_s);
            let scan: Vec<Measurement> = scan;
            self.tracker.scan(t_s, &scan);
            plots = later;
        }
        let due = self.empty_scans_s.iter().filter(|ready_s| **ready_s <= t_s).count();
        for _ in 0..due {
            self.tracker.scan(t_s, &[]);
        }
        self.empty_scans_s.retain(|ready_s| *ready_s > t_s);
    }

    /// The target behind a track.
    pub fn target_of(&self, track: u32) -> Option<u8> {
        self.tracker.origin(track)
    }

    /// First detection and first confirmed track of target `index`, seconds.
    pub fn first_s(&self, index: usize) -> (Option<f64>, Option<f64>) {
        (self.detected_s[index], self.tracked_s[index])
    }

    /// The tracker, for what it counts of itself.
    pub fn tracker(&self) -> &Tracker {
        &self.tracker
    }
}
