//! One ship of a running world: her model, her state, the order she carries out.

use crate::hull::Hull;
use crate::pose::Pose;
use crate::vessel::{self, Helm, Model, State};
use geom::{HullOutline, Vec2};
use record::{Motion, Stopping, Vessel};

/// A ship under way.
#[derive(Clone, Debug)]
pub struct Ship {
    /// Her outline.
    pub outline: HullOutline,
    /// The same, ready for distances.
    pub hull: Hull,
    /// What moves her.
    pub model: Model,
    /// In what distance she stops.
    pub stopping: Option<Stopping>,
    /// Where she is now.
    pub state: State,
    /// Where she was at the start of the step.
    pub before: Pose,
    /// Where she is now, over ground.
    pub pose: Pose,
    /// Whether a model with inertia, too, goes straight in closed form while nothing changes.
    /// Kinematic ships always do. In a run under a planner an inertial model is integrated all the
    /// time, so that its cost and its rounding do not depend on what it happens to do.
    pub closed_form: bool,
    helm: Helm,
    /// While nothing changes: position and time from which she goes straight on.
    straight: Option<(Vec2, f64)>,
    current_mps: Vec2,
    drift_mps: Vec2,
    yaw_disturbance_radps: f64,
}

/// What the weather does to a ship for one beat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance {
    /// The part of the drift that her navigator knows and steers against, m/s north and east.
    pub known_mps: Vec2,
    /// All of the drift, m/s.
    pub drift_mps: Vec2,
    /// Yaw rate that waves impose, rad/s.
    pub yaw_rate_radps: f64,
}

impl Ship {
    /// A ship at time 0 in a drift that she knows; `None` where no model has the name that `vessel`
    /// asks for. `start` is over ground: she lies across her course as far as the drift asks.
    pub fn new(
        outline: HullOutline,
        vessel: &Vessel,
        start: &Motion,
        current_mps: Vec2,
    ) -> Option<Self> {
        let model = Model::of(vessel)?;
        let lies = Helm::over_ground(start.psi_rad, start.speed_mps, current_mps);
        // ordered to stand still she lies as she did, and drifts
        let psi_rad = if start.speed_mps > 0.0 { lies.psi_rad } else { start.psi_rad };
        let speed_mps = if start.speed_mps > 0.0 { lies.speed_mps } else { 0.0 };
        let speed_mps = speed_mps.min(model.limits().speed_mps_max.max(start.speed_mps));
        let state = model.settled(State::ahead(start.position_m, psi_rad, speed_mps));
        let pose = Pose::of(&state, current_mps);
        let helm = Helm { psi_rad: state.psi_rad, direction: state.heading, speed_mps };
        let hull = Hull::new(&outline);
        Some(Self {
            outline,
            hull,
            model,
            stopping: vessel::stopping(vessel),
            state,
            before: pose,
            pose,
            closed_form: matches!(model, Model::Kinematic(_)),
            helm,
            straight: None,
            current_mps,
            drift_mps: current_mps,
            yaw_disturbance_radps: 0.0,
        })
    }

    /// Takes an order at time `t_s`.
    pub fn steer(&mut self, helm: Helm, t_s: f64) {
        if helm != self.helm || self.straight.is_none() {
            self.helm = helm;
            self.straight = self.goes_straight().then_some((self.state.position_m, t_s));
        }
    }

    /// The order that she carries out.
    pub(crate) fn helm(&self) -> Helm {
        self.helm
    }

    /// The same ship carrying out another order. In weather only, where no closed form hangs on it.
    pub(crate) fn with_helm(self, helm: Helm) -> Self {
        Self { helm, ..self }
    }

    /// Keeps the heading and speed that she has.
    pub fn hold(&mut self, t_s: f64) {
        let State { psi_rad, heading, surge_mps, .. } = self.state;
        self.steer(Helm { psi_rad, direction: heading, speed_mps: surge_mps }, t_s);
    }

    /// Puts her into the weather of a beat. She is not in closed form any more.
    pub fn disturb(&mut self, disturbance: Disturbance) {
        self.current_mps = disturbance.known_mps;
        self.drift_mps = disturbance.drift_mps;
        self.yaw_disturbance_radps = disturbance.yaw_rate_radps;
        self.closed_form = false;
        self.straight = None;
        self.pose = self.pose_of_state();
    }

    fn pose_of_state(&self) -> Pose {
        let mut pose = Pose::of(&self.state, self.drift_mps);
        if self.yaw_disturbance_radps.abs() > 0.0 {
            pose.yaw_rate_radps += self.yaw_disturbance_radps;
        }
        pose
    }

    /// Set and drift that she knows of, metres a second north and east: the current, in calm.
    pub fn current_mps(&self) -> Vec2 {
        self.current_mps
    }

    /// Whether she is going straight on, in closed form, until she gets another order.
    pub fn is_straight(&self) -> bool {
        self.straight.is_some()
    }

    fn goes_straight(&self) -> bool {
        self.closed_form && self.model.is_steady(&self.state, &self.helm)
    }

    /// Moves through the `dt_s` seconds that end at `to_s`.
    #[inline]
    pub fn advance(&mut self, to_s: f64, dt_s: f64) {
        self.before = self.pose;
        if let Some((position_m, since_s)) = self.straight {
            let position_m = position_m + self.pose.velocity_mps * (to_s - since_s);
            self.state.position_m = position_m;
            self.pose.position_m = position_m;
            return;
        }
        self.state = self.model.step(&self.state, &self.helm, self.drift_mps, dt_s);
        if self.yaw_disturbance_radps.abs() > 0.0 {
            let psi_rad = geom::wrap(self.state.psi_rad + self.yaw_disturbance_radps * dt_s);
            (self.state.psi_rad, self.state.heading) = (psi_rad, geom::unit(psi_rad));
        }
        self.pose = self.pose_of_state();
        if self.goes_straight() {
            self.straight = Some((self.state.position_m, to_s));
        }
    }
}
