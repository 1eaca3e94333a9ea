//! One ship of a running world: her model, her state, the order she carries out.

use crate::hull::Hull;
use crate::pose::Pose;
use crate::vessel::{Helm, Model, State};
use geom::{HullOutline, Vec2};
use record::{Motion, Vessel};

/// A ship under way.
#[derive(Clone, Debug)]
pub struct Ship {
    /// Her outline.
    pub outline: HullOutline,
    /// The same, ready for distances.
    pub hull: Hull,
    /// What moves her.
    pub model: Model,
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
}

impl Ship {
    /// A ship at time 0; `None` where no model has the name that `vessel` asks for.
    pub fn new(
        outline: HullOutline,
        vessel: &Vessel,
        start: &Motion,
        current_mps: Vec2,
    ) -> Option<Self> {
        let model = Model::of(vessel)?;
        let state = State::ahead(start.position_m, start.psi_rad, start.speed_mps);
        let pose = Pose::of(&state, current_mps);
        let helm =
            Helm { psi_rad: state.psi_rad, direction: state.heading, speed_mps: start.speed_mps };
        let hull = Hull::new(&outline);
        Some(Self {
            outline,
            hull,
            model,
            state,
            before: pose,
            pose,
            closed_form: matches!(model, Model::Kinematic(_)),
            helm,
            straight: None,
            current_mps,
        })
    }

    /// Takes an order at time `t_s`.
    pub fn steer(&mut self, helm: Helm, t_s: f64) {
        if helm != self.helm || self.straight.is_none() {
            self.helm = helm;
            self.straight = self.goes_straight().then_some((self.state.position_m, t_s));
        }
    }

    /// Keeps the heading and speed that she has.
    pub fn hold(&mut self, t_s: f64) {
        let State { psi_rad, heading, surge_mps, .. } = self.state;
        self.steer(Helm { psi_rad, direction: heading, speed_mps: surge_mps }, t_s);
    }

    /// Current, metres a second north and east.
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
        self.state = self.model.step(&self.state, &self.helm, self.current_mps, dt_s);
        self.pose = Pose::of(&self.state, self.current_mps);
        if self.goes_straight() {
            self.straight = Some((self.state.position_m, to_s));
        }
    }
}
