//! The generator: encounter `j` of a stratum, as a function of (seed, stratum, j) and nothing else.
//!
//! Geometry is drawn first and classified after; see [`crate::placement`] for the law that this
//! gives each variable. Own ship draws from the geometry stream of ship 0, target `i` from that of
//! ship `1 + i`, so that one more draw of a ship moves nothing else. Every encounter closes. Within
//! a stratum this is a crude Monte Carlo draw of weight 1, unless the model asks for the rate of a
//! traffic ([`crate::encounter_rate`]).

use crate::Error;
use crate::encounter_rate::Rate;
use crate::hazard::corners;
use crate::limits::either;
use crate::placement::Placed;
use crate::spec::{KINEMATIC, Model};
use crate::target::{Made, Own, Rated, Request, own_course_rad};
use geom::{HullOutline, Vec2, unit};
use record::{
    Asked, DistanceKind, Encounter, EncounterId, Motion, OwnShip, Purpose, RunLimits, Seed,
    Streams, Vessel, Visibility, Waypoint, Weather,
};
use std::sync::Arc;

/// What every encounter of a campaign takes over from the table `[run]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSettings {
    /// Clock and end of a run.
    pub limits: RunLimits,
    /// Distance that own ship shall keep, metres.
    pub safety_radius_m: f64,
    /// How it is measured.
    pub distance: DistanceKind,
}

/// One encounter and what it cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The encounter.
    pub encounter: Encounter,
    /// Draws of target speed and course that were refused on the way.
    pub rejected: u64,
}

/// Draws the encounters of a model.
#[derive(Clone, Debug)]
pub struct Generator {
    model: Model,
    run: RunSettings,
    strata: Vec<Arc<str>>,
    /// One for each stratum, where the model asks for the rate of a traffic.
    rates: Vec<Rate>,
}

impl Generator {
    /// Refuses a model that contradicts itself or asks for a class that its ships cannot make.
    pub fn new(model: &Model, run: &RunSettings) -> Result<Self, Error> {
        run.validate()?;
        model.validate(run)?;
        let generator = Self {
            model: model.clone(),
            run: *run,
            strata: model.stratum.iter().map(|s| Arc::from(s.name.as_str())).collect(),
            rates: model.rates(),
        };
        if model.encounter_rate.is_some() {
            return Ok(generator);
        }
        for stratum in &model.stratum {
            for request in Request::all(model, stratum) {
                request.try_extremes()?;
            }
        }
        Ok(generator)
    }

    /// Names of the strata, in order.
    pub fn strata(&self) -> &[Arc<str>] {
        &self.strata
    }

    /// Encounter `j` of the stratum with this index.
    pub fn draw(&self, seed: Seed, stratum: usize, j: u64) -> Result<Drawn, Error> {
        let id = EncounterId::new(Arc::clone(&self.strata[stratum]), j);
        let spec = &self.model.stratum[stratum];
        let streams = Streams::new(seed, &id);
        let mut own_stream = streams.stream(Purpose::Geometry, 0);
        if let Some(rate) = self.rates.get(stratum) {
            let request = Request::first(&self.model, spec);
            let duration_s_max = self.run.limits.duration_s_max;
            let Rated { own, weight, made } =
                request.make_at_rate(rate, &mut own_stream, &streams, &id, duration_s_max)?;
            return Ok(self.drawn((id, seed), weight, own, &streams, vec![made]));
        }
        let own_speed_mps = self.model.own.speed_mps.draw(&mut own_stream);
        let own_psi_rad = own_course_rad(&self.model, &mut own_stream);
        let own = Own { speed_mps: own_speed_mps, psi_rad: own_psi_rad };
        let mut all: Vec<Made> = Vec::with_capacity(1);
        for request in Request::all(&self.model, spec) {
            let first_tcpa_s = all.first().map(|first| first.placed.tcpa_s);
            let limit_s = self.run.limits.duration_s_max;
            all.push(request.make(own, first_tcpa_s, &streams, &id, limit_s)?);
        }
        Ok(self.drawn((id, seed), 1.0, own, &streams, all))
    }

    /// The largest weight that an encounter of this stratum can have; 1 for crude draws.
    pub fn weight_max(&self, stratum: usize) -> f64 {
        self.rates.get(stratum).map_or(1.0, |rate| rate.weight_max)
    }

    /// The encounter of ships that are placed.
    fn drawn(
        &self,
        (id, seed): (EncounterId, Seed),
        weight: f64,
        own: Own,
        streams: &Streams,
        all: Vec<Made>,
    ) -> Drawn {
        let asked = all.first().map(|first| {
            let Placed { class, miss_m, tcpa_s, .. } = first.placed;
            Asked { class, miss_m, tcpa_s }
        });
        let last_s = all.iter().map(|made| made.placed.tcpa_s).fold(0.0, f64::max);
        let rejected = all.iter().map(|made| made.placed.rejected).sum();
        let encounter = Encounter {
            id,
            seed,
            weight,
            own: self.own_ship(own, last_s),
            targets: all.into_iter().map(|made| made.target).collect(),
            hazards: self
                .model
                .hazard
                .iter()
                .flatten()
                .map(|polygon| corners(polygon, own.psi_rad))
                .collect(),
            weather: self.model.weather.as_ref().map_or_else(Weather::default, |w| w.draw(streams)),
            sensing: self.model.sensing.sensing(),
            visibility: match self.model.visual_range_m {
                None => Visibility::InSight,
                Some(visual_range_m) => Visibility::Restricted { visual_range_m },
            },
            asked,
            safety_radius_m: self.run.safety_radius_m,
            distance: self.run.distance,
            run: self.run.limits,
        };
        Drawn { encounter, rejected }
    }

    /// Own ship; her goal lies beyond the last closest point.
    fn own_ship(&self, start: Own, last_s: f64) -> OwnShip {
        let (own, geometry) = (&self.model.own, &self.model.geometry);
        let Own { speed_mps, psi_rad } = start;
        let goal_s = geometry.goal_tcpa_factor * last_s + geometry.goal_extra_s;
        let goal_m = unit(psi_rad) * (speed_mps * goal_s);
        OwnShip {
            hull: HullOutline::centred(own.length_m, own.beam_m),
            vessel: own_vessel(&own.vessel, || {
                let limits = (own.limits.as_ref(), own.scaled_limits.as_ref());
                either(limits.0, limits.1, own.length_m, speed_mps)
            }),
            start: Motion { position_m: Vec2::zeros(), psi_rad, speed_mps },
            route: vec![Waypoint { position_m: goal_m, speed_mps: None }],
            cruise_mps: speed_mps,
        }
    }
}

impl RunSettings {
    /// Refuses a radius that is no distance.
    pub(crate) fn validate(&self) -> Result<(), Error> {
        crate::limits::positive("run", "safety_radius_m", self.safety_radius_m)
    }

    /// Between centres a radius below half of both hulls would call a collision safe.
    pub(crate) fn validate_centre_radius(
        &self,
        own_length_m: f64,
        target_length_m: f64,
    ) -> Result<(), Error> {
        let hulls_m = (own_length_m + target_length_m) / 2.0;
        crate::error::require(
            self.distance == DistanceKind::Hull || self.safety_radius_m >= hulls_m,
            || "run.safety_radius_m".to_owned(),
            || {
                format!(
                    "= {} is below half of both hulls, {hulls_m} m, with distance = \"centre\"; \
                     write at least that, or distance = \"hull\"",
                    self.safety_radius_m
                )
            },
        )
    }
}

/// A named parameter set, or what the limits make of a kinematic vessel.
pub(crate) fn own_vessel(name: &str, kinematic: impl FnOnce() -> Option<Vessel>) -> Vessel {
    if name == KINEMATIC {
        kinematic().expect("a validated kinematic vessel has limits")
    } else {
        Vessel::Model(name.to_owned())
    }
}
