//! The generator: encounter `j` of a stratum, as a function of (seed, stratum, j) and nothing else.
//!
//! Geometry is drawn first and classified after; see [`crate::placement`] for the law that this
//! gives each variable. Own ship draws from the geometry stream of ship 0, target `i` from that of
//! ship `1 + i`, so that one more draw of a ship moves nothing else. Every encounter closes, and
//! has weight 1: within a stratum this is a crude Monte Carlo draw.

use crate::Error;
use crate::hazard::corners;
use crate::limits::either;
use crate::placement::Placed;
use crate::spec::{KINEMATIC, Model};
use crate::target::{Made, Own, Request};
use geom::{HullOutline, Vec2, unit};
use record::{
    Asked, DistanceKind, Encounter, EncounterId, Motion, OwnShip, Purpose, RunLimits, Seed,
    Streams, Vessel, Visibility, Waypoint, Weather,
};
use std::f64::consts::PI;
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
        };
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
        let own_speed_mps = self.model.own.speed_mps.draw(&mut own_stream);
        let own_psi_rad = if self.model.geometry.random_rotation {
            // the upper end is the one that belongs to the circle (-pi, pi]
            -own_stream.uniform_in(-PI, PI)
        } else {
            0.0
        };

        let own = Own { speed_mps: own_speed_mps, psi_rad: own_psi_rad };

        let (mut asked, mut last_s, mut rejected) = (None, 0.0, 0);
        let mut targets = Vec::with_capacity(1);
        for request in Request::all(&self.model, spec) {
            let Made { target, placed } =
                request.make(own, &streams, &id, self.run.limits.duration_s_max)?;
            let Placed { class, miss_m, tcpa_s, .. } = placed;
            asked = asked.or(Some(Asked { class, miss_m, tcpa_s }));
            last_s = tcpa_s.max(last_s);
            rejected += placed.rejected;
            targets.push(target);
        }
        let encounter = Encounter {
            id,
            seed,
            weight: 1.0,
            own: self.own_ship(own, last_s),
            targets,
            hazards: self
                .model
                .hazard
                .iter()
                .flatten()
                .map(|polygon| corners(polygon, own.psi_rad))
                .collect(),
            weather: self
                .model
                .weather
                .as_ref()
                .map_or_else(Weather::default, |w| w.draw(&streams)),
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
        Ok(Drawn { encounter, rejected })
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
