//! What moves a ship: one file for each kind of model, one list of named parameter sets.
//!
//! Every model follows the same order, a heading and a speed through the water ([`Helm`]), within
//! the limits of its actuators. The state is relative to the water; a constant current carries it.

mod autopilot;
mod frigate;
mod gunnerus;
mod helm;
mod kinematic;
mod nomoto;
mod slew;
mod stopping;
mod three_dof;
pub mod trial;
mod viknes;
mod windage;

pub use autopilot::Autopilot;
pub use frigate::FRIGATE;
pub use gunnerus::GUNNERUS;
pub use helm::Helm;
pub use kinematic::Kinematic;
pub use nomoto::{Gains, Nomoto};
pub use slew::{Actuators, Rates, Steering};
pub use stopping::stopping;
pub use three_dof::{Damping, MassMatrix, Propulsion, ThreeDof};
pub use viknes::VIKNES;
pub use windage::Windage;

use geom::Vec2;
use record::Vessel;

/// Where a ship is and how she moves through the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Position of the reference point, metres north and east.
    pub position_m: Vec2,
    /// Heading, radians clockwise from north, wrapped.
    pub psi_rad: f64,
    /// The unit vector of the heading.
    pub heading: Vec2,
    /// Speed ahead through the water, m/s.
    pub surge_mps: f64,
    /// Speed to starboard through the water, m/s.
    pub sway_mps: f64,
    /// Yaw rate, rad/s, positive to starboard.
    pub yaw_rate_radps: f64,
    /// Where rudder and engine stand, for models whose actuators take time.
    pub actuators: Actuators,
}

impl State {
    /// A ship that goes straight ahead.
    pub fn ahead(position_m: Vec2, psi_rad: f64, surge_mps: f64) -> Self {
        let psi_rad = geom::wrap(psi_rad);
        Self {
            position_m,
            psi_rad,
            heading: geom::unit(psi_rad),
            surge_mps,
            sway_mps: 0.0,
            yaw_rate_radps: 0.0,
            actuators: Actuators::default(),
        }
    }

    /// Velocity through the water, north and east, m/s.
    pub fn through_water_mps(&self) -> Vec2 {
        let (h, u, v) = (self.heading, self.surge_mps, self.sway_mps);
        Vec2::new(h.x * u - h.y * v, h.y * u + h.x * v)
    }
}

/// What a model declares of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest yaw rate, rad/s.
    pub yaw_rate_radps_max: f64,
    /// Largest speed through the water, m/s.
    pub speed_mps_max: f64,
    /// Largest acceleration that is also possible as a deceleration, m/s^2.
    pub acceleration_mps2_max: f64,
    /// Slowest speed at which she steers, m/s; absent where the model declares none.
    pub steerage_mps: Option<f64>,
}

/// A model, ready to step.
#[derive(Clone, Copy, Debug)]
pub enum Model {
    /// Turns and accelerates at once, within limits.
    Kinematic(Kinematic),
    /// Surge, sway and yaw with mass, damping and actuators.
    ThreeDof(&'static ThreeDof),
    /// Yaw by Nomoto's first-order equation, no drift.
    Nomoto(&'static Nomoto),
}

/// A parameter set and the name by which campaigns call it.
struct Named {
    name: &'static str,
    model: Model,
    length_m: f64,
}

/// Every named parameter set.
const MODELS: [Named; 3] = [
    Named { name: "viknes", model: Model::ThreeDof(&VIKNES), length_m: 8.45 },
    Named { name: "gunnerus", model: Model::ThreeDof(&GUNNERUS), length_m: 31.25 },
    Named { name: "frigate", model: Model::Nomoto(&FRIGATE), length_m: 100.0 },
];

/// The names that [`Vessel::Model`] may have.
pub fn known_models() -> impl Iterator<Item = &'static str> {
    MODELS.iter().map(|named| named.name)
}

/// The length over all of the ship behind a name, metres.
pub fn length_m(name: &str) -> Option<f64> {
    MODELS.iter().find(|named| named.name == name).map(|named| named.length_m)
}

/// What a vessel declares; `None` for a name that is not among [`known_models`].
pub fn limits(vessel: &Vessel) -> Option<Limits> {
    Model::of(vessel).map(|model| model.limits())
}

impl Model {
    /// The model of a vessel; `None` for a name that is not among [`known_models`].
    pub fn of(vessel: &Vessel) -> Option<Self> {
        match vessel {
            Vessel::Kinematic { yaw_rate_radps_max, acceleration_mps2_max, speed_mps_max } => {
                Some(Self::Kinematic(Kinematic {
                    yaw_rate_radps_max: *yaw_rate_radps_max,
                    acceleration_mps2_max: *acceleration_mps2_max,
                    speed_mps_max: *speed_mps_max,
                }))
            }
            Vessel::Model(name) => {
                MODELS.iter().find(|named| named.name == name.as_str()).map(|named| named.model)
            }
        }
    }

    /// What the model declares.
    pub fn limits(&self) -> Limits {
        match self {
            Self::Kinematic(kinematic) => Limits {
                yaw_rate_radps_max: kinematic.yaw_rate_radps_max,
                speed_mps_max: kinematic.speed_mps_max,
                acceleration_mps2_max: kinematic.acceleration_mps2_max,
                steerage_mps: None,
            },
            Self::ThreeDof(model) => model.limits(),
            Self::Nomoto(model) => model.limits(),
        }
    }

    /// The state with actuators that hold its speed, as those of a ship that has been under way.
    pub fn settled(&self, state: State) -> State {
        match self {
            Self::ThreeDof(model) => model.settled(state),
            Self::Kinematic(_) | Self::Nomoto(_) => state,
        }
    }

    /// Moves the ship through `dt_s` seconds.
    #[inline]
    pub fn step(&self, state: &State, helm: &Helm, current_mps: Vec2, dt_s: f64) -> State {
        match self {
            Self::Kinematic(kinematic) => kinematic.step(state, helm, current_mps, dt_s),
            Self::ThreeDof(model) => model.step(state, helm, current_mps, dt_s),
            Self::Nomoto(model) => model.step(state, helm, current_mps, dt_s),
        }
    }

    /// Whether the order changes nothing, so that the ship goes straight on at constant speed.
    pub fn is_steady(&self, state: &State, helm: &Helm) -> bool {
        let speed_mps = helm.speed_mps.clamp(0.0, self.limits().speed_mps_max);
        let none = |x: f64| x.abs() <= 0.0;
        none(state.sway_mps)
            && none(state.yaw_rate_radps)
            && none(state.psi_rad - helm.psi_rad)
            && none(state.surge_mps - speed_mps)
    }
}
