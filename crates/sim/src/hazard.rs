//! Own hull against land, piers and shoals: distance, and the first touch.
//!
//! A hazard is a simple polygon, whole or with bays. Own ship starts outside, so she can reach it
//! over an edge alone: every edge is a hull of two corners that does not move, looked at by the
//! same code as another ship. An edge whose lower bound lies above the smallest distance so far
//! is left out, so the smallest distance is exact and most edges cost a square root.
//! Targets do not run aground: they know their waters.

use crate::approach::Approach;
use crate::contact::{Impact, Inertia, Party, collide};
use crate::hull::Hull;
use crate::interval::{Hulls, Interval};
use crate::pose::Pose;
use crate::ship::Ship;
use geom::{Vec2, polygon};

/// The hazards of one run.
#[derive(Clone, Debug)]
pub struct Hazards {
    edges: Vec<Edge>,
    least_m: f64,
}

#[derive(Clone, Debug)]
struct Edge {
    hazard: u8,
    hull: Hull,
    pose: Pose,
    approach: Approach,
}

/// Where own hull touches first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Fraction of the step.
    pub fraction: f64,
    /// Number of the hazard.
    pub hazard: u8,
    edge: usize,
}

impl Hazards {
    /// The hazards at time 0.
    pub fn new(polygons: &[Vec<Vec2>], own: &Ship) -> Self {
        let mut hazards = Self { edges: Vec::new(), least_m: f64::INFINITY };
        for (index, corners) in polygons.iter().enumerate() {
            for [from_m, to_m] in polygon::edges(corners) {
                let pose = Pose {
                    position_m: (from_m + to_m) * 0.5,
                    velocity_mps: Vec2::zeros(),
                    heading: Vec2::new(1.0, 0.0),
                    yaw_rate_radps: 0.0,
                };
                let hull = Hull::of_edge((to_m - from_m) * 0.5);
                let hulls = Hulls { own: &own.hull, target: &hull };
                let approach = Approach::new(f64::INFINITY, hulls, &own.pose, &pose);
                hazards.least_m = hazards.least_m.min(approach.minimum().hull_m);
                hazards.edges.push(Edge { hazard: index as u8, hull, pose, approach });
            }
        }
        hazards
    }

    /// Smallest distance so far, metres; absent without hazards.
    pub fn least_m(&self) -> Option<f64> {
        self.least_m.is_finite().then_some(self.least_m)
    }

    /// Goes through one step of own ship; the first touch, if there is one.
    pub fn advance(&mut self, own: &Ship, start_s: f64, dt_s: f64) -> Option<Touch> {
        let mut first: Option<Touch> = None;
        for (index, edge) in self.edges.iter_mut().enumerate() {
            edge.approach.set_near_m(self.least_m);
            let step = Interval {
                start_s,
                dt_s,
                own: [&own.before, &own.pose],
                target: [&edge.pose, &edge.pose],
            };
            let touch = edge.approach.advance(&step, Hulls { own: &own.hull, target: &edge.hull });
            self.least_m = self.least_m.min(edge.approach.minimum().hull_m);
            if let Some(fraction) = touch
                && first.is_none_or(|first| fraction < first.fraction)
            {
                first = Some(Touch { fraction, hazard: edge.hazard, edge: index });
            }
        }
        first
    }

    /// What the touch does to own ship, a body of `inertia` that is at `pose`.
    pub fn impact(&self, touch: &Touch, hull: &Hull, pose: Pose, inertia: Inertia) -> Impact {
        let edge = &self.edges[touch.edge];
        let fixed = Inertia { mass_kg: f64::INFINITY, yaw_kgm2: f64::INFINITY };
        let land = Party { hull: &edge.hull, pose: edge.pose, inertia: fixed };
        collide(&Party { hull, pose, inertia }, &land).impact
    }
}
