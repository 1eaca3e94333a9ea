//! Current, wind and waves as ships feel them, one draw a beat.
//!
//! First-order Gauss-Markov processes in their exact discretisation (Gillespie 1996, Physical
//! Review E 54), started from their stationary law. Current and gusts are the same for all ships
//! and come from the environment stream of ship 0; waves are each ship's own. Nothing depends on
//! what a ship does but the leeway, which goes with her heading and speed; so what was drawn for a
//! run is kept, and the nominal track goes through it again ([`Environment::rewind`]).

use crate::ship::{Disturbance, Ship};
use crate::vessel::{Helm, Model};
use geom::{HullOutline, Vec2, math};
use record::{Encounter, Motion, Purpose, Stream, Streams, Vessel, Weather};

/// The weather of one run.
#[derive(Clone, Debug)]
pub struct Environment {
    weather: Weather,
    steady: bool,
    common: Stream,
    current_off: [Process; 2],
    gust: Process,
    seas: Vec<Sea>,
    /// What was drawn, beat after beat: current north and east and gust, then of each of the seas
    /// drift north and east and yaw.
    drawn: Vec<[f64; 3]>,
    /// Beats begun since the start or since it was rewound.
    beats: usize,
}

/// The waves of one ship.
#[derive(Clone, Debug)]
struct Sea {
    stream: Stream,
    share: f64,
    drift: [Process; 2],
    yaw: Process,
}

/// A first-order Gauss-Markov process.
#[derive(Clone, Copy, Debug)]
pub struct Process {
    sd: f64,
    keep: f64,
    value: Option<f64>,
}

impl Process {
    /// A process of a standard deviation and a time constant, drawn every `dt_s` seconds.
    pub fn new(sd: f64, time_constant_s: f64, dt_s: f64) -> Self {
        Self { sd, keep: math::exp(-dt_s / time_constant_s), value: None }
    }

    /// The next value.
    pub fn next(&mut self, stream: &mut Stream) -> f64 {
        let draw = stream.normal();
        let fresh = (1.0 - self.keep * self.keep).sqrt();
        let value = match self.value {
            None => self.sd * draw,
            Some(value) => self.keep * value + self.sd * fresh * draw,
        };
        self.value = Some(value);
        value
    }
}

impl Environment {
    /// The weather of an encounter before the first beat.
    pub fn new(encounter: &Encounter) -> Self {
        let weather = encounter.weather;
        let beat_s = encounter.run.beat_s;
        let streams = Streams::new(encounter.seed, &encounter.id);
        let steady =
            weather.current_noise.is_none() && weather.wind.is_none() && weather.waves.is_none();
        let process = |sd, time_constant_s| Process::new(sd, time_constant_s, beat_s);
        let current = weather
            .current_noise
            .map_or(process(0.0, 1.0), |noise| process(noise.sd_mps, noise.time_constant_s));
        let gust = weather.wind.map_or(process(0.0, 1.0), |wind| {
            process(wind.gusts.sd_mps, wind.gusts.time_constant_s)
        });
        let own_m = encounter.own.hull.length_m;
        let lengths_m =
            std::iter::once(own_m).chain(encounter.targets.iter().map(|t| t.hull.length_m));
        let seas = weather.waves.iter().flat_map(|waves| {
            let ships = lengths_m.clone().zip(0u8..);
            ships.map(|(length_m, ship)| Sea {
                stream: streams.stream(Purpose::Environment, ship.saturating_add(1)),
                share: (waves.length_m_ref / length_m).min(1.0),
                drift: [process(waves.drift_sd_mps, waves.time_constant_s); 2],
                yaw: process(waves.yaw_rate_sd_radps, waves.time_constant_s),
            })
        });
        Self {
            steady,
            common: streams.stream(Purpose::Environment, 0),
            current_off: [current; 2],
            gust,
            seas: seas.collect(),
            drawn: Vec::new(),
            beats: 0,
            weather,
        }
    }

    /// Whether nothing but a constant current moves the ships.
    pub fn is_steady(&self) -> bool {
        self.steady
    }

    /// Goes on to the next beat; the first call makes time 0.
    pub fn advance(&mut self) {
        if self.steady {
            return;
        }
        self.beats += 1;
        if self.drawn.len() >= self.beats * (1 + self.seas.len()) {
            return;
        }
        let Self { common, current_off: [north, east], gust, seas, drawn, .. } = self;
        drawn.push([north.next(common), east.next(common), gust.next(common)]);
        for Sea { stream, drift: [north, east], yaw, .. } in seas {
            drawn.push([north.next(stream), east.next(stream), yaw.next(stream)]);
        }
    }

    /// Goes back to before the first beat. What comes is what came, and new draws beyond it.
    pub(crate) fn rewind(&mut self) {
        self.beats = 0;
    }

    /// What was drawn for this beat: 0 is current and gust, `1 + i` the sea of ship `i`.
    fn now(&self, index: usize) -> [f64; 3] {
        // before the first beat nothing blows
        let Some(beat) = self.beats.checked_sub(1) else { return [0.0; 3] };
        self.drawn[beat * (1 + self.seas.len()) + index]
    }

    /// Puts a ship into the weather of this beat: own ship is number 0, target `i` is `1 + i`.
    pub fn apply(&self, number: usize, ship: &mut Ship) {
        if self.steady {
            return;
        }
        let way = Way { heading: ship.state.heading, ahead_mps: ship.state.surge_mps };
        let leeway_mps = self.leeway_mps(&ship.model, way, 0.0);
        let known_mps = self.known_mps(number, leeway_mps);
        let [north_mps, east_mps, gust_mps] = self.now(0);
        let mut drift_mps = Vec2::new(north_mps, east_mps);
        let mut yaw_rate_radps = 0.0;
        if gust_mps.abs() > 0.0 {
            drift_mps += self.leeway_mps(&ship.model, way, gust_mps) - leeway_mps;
        }
        if let Some(sea) = self.seas.get(number) {
            let [north_mps, east_mps, yaw_radps] = self.now(1 + number);
            drift_mps += Vec2::new(north_mps, east_mps) * sea.share;
            yaw_rate_radps = yaw_radps * sea.share;
        }
        drift_mps += known_mps;
        ship.disturb(Disturbance { known_mps, drift_mps, yaw_rate_radps });
    }

    /// The part of the drift that a ship's navigator knows, m/s: constant current, leeway in the
    /// mean wind, mean drift by waves.
    fn known_mps(&self, number: usize, leeway_mps: Vec2) -> Vec2 {
        let mut known_mps = self.weather.current_mps + leeway_mps;
        if let (Some(waves), Some(sea)) = (&self.weather.waves, self.seas.get(number)) {
            known_mps += waves.drift_mps * sea.share;
        }
        known_mps
    }

    /// Leeway of a ship, m/s, in the mean wind and a gust along it: by the wind on her projected
    /// areas, or where her model has none a share of the wind across her heading.
    fn leeway_mps(&self, model: &Model, way: Way, gust_mps: f64) -> Vec2 {
        let Some(wind) = &self.weather.wind else { return Vec2::zeros() };
        let mean_mps = wind.velocity_mps.norm();
        if mean_mps <= 0.0 {
            return Vec2::zeros();
        }
        let wind_mps = wind.velocity_mps * (1.0 + gust_mps / mean_mps);
        let Way { heading, ahead_mps } = way;
        let abeam = Vec2::new(-heading.y, heading.x);
        let leeway_mps = match model {
            Model::ThreeDof(ship) => {
                let air_mps = wind_mps - self.weather.current_mps;
                ship.leeway_mps([air_mps.dot(&heading) - ahead_mps, air_mps.dot(&abeam)])
            }
            Model::Kinematic(_) | Model::Nomoto(_) => wind.leeway * wind_mps.dot(&abeam),
        };
        abeam * leeway_mps
    }

    /// Own ship and the targets at time 0; `None` where a model is not known.
    pub fn ships(&self, encounter: &Encounter) -> Option<(Ship, Vec<Ship>)> {
        let own = &encounter.own;
        let own = self.ship(0, own.hull, &own.vessel, &own.start)?;
        let targets = encounter.targets.iter().zip(1..);
        let targets = targets.map(|(t, number)| self.ship(number, t.hull, &t.vessel, &t.start));
        Some((own, targets.collect::<Option<_>>()?))
    }

    /// A ship at time 0, on the course and at the speed over ground that she is to start with; so
    /// she lies across her course as far as the drift that she knows asks. `None` where no model
    /// has the name that `vessel` asks for.
    fn ship(
        &self,
        number: usize,
        hull: HullOutline,
        vessel: &Vessel,
        start: &Motion,
    ) -> Option<Ship> {
        let model = Model::of(vessel)?;
        let mut way = Way { heading: geom::unit(start.psi_rad), ahead_mps: start.speed_mps };
        let mut known_mps = self.known_mps(number, self.leeway_mps(&model, way, 0.0));
        // leeway and the angle at which she lies depend on one another
        for _ in 0..LIES_ROUNDS {
            let lies = Helm::over_ground(start.psi_rad, start.speed_mps, known_mps);
            if start.speed_mps > 0.0 {
                way = Way { heading: lies.direction, ahead_mps: lies.speed_mps };
            }
            known_mps = self.known_mps(number, self.leeway_mps(&model, way, 0.0));
        }
        Ship::new(hull, vessel, start, known_mps)
    }
}

/// Heading and speed through the water.
#[derive(Clone, Copy, Debug)]
struct Way {
    heading: Vec2,
    ahead_mps: f64,
}

/// Rounds in which a ship finds the angle at which she lies at the start.
const LIES_ROUNDS: usize = 4;
