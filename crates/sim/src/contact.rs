//! What happens when hulls touch: a fresh rapier world takes the two ships over at the moment of
//! contact and gives impact speed, impulse and the energy lost.
//!
//! The ships enter as rigid bodies with the velocities of the marine model; water forces are left
//! out, for in the tenths of a second of a contact they are small against those of the hulls.
//! Impulse and energy are differences of momentum and kinetic energy over the burst, so they do
//! not depend on the engine's own bookkeeping.

use crate::hull::{Gap, Hull, Warm, rapier_pose, vector};
use crate::pose::Pose;
use crate::ship::Ship;
use crate::vessel::Model;
use geom::{HullOutline, Vec2};
use rapier2d_f64::prelude::{
    ColliderBuilder, IntegrationParameters, MassProperties, PhysicsWorld, RigidBodyBuilder,
    RigidBodyHandle, SharedShape, Vector,
};

/// One ship in a contact.
#[derive(Clone, Copy, Debug)]
pub struct Party<'a> {
    /// Her hull.
    pub hull: &'a Hull,
    /// Where she is and how she moves at the first touch.
    pub pose: Pose,
    /// Her mass.
    pub inertia: Inertia,
}

/// Mass and moment of inertia of a rigid body; infinite for what does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// kg.
    pub mass_kg: f64,
    /// About the reference point, kg m^2.
    pub yaw_kgm2: f64,
}

/// Density of sea water, kg/m^3.
const SEA_WATER_KGPM3: f64 = 1025.0;
/// Block coefficient of a hull of which only length and beam are known: between a motor boat's
/// 0.4 to 0.5 and a cargo ship's 0.7 to 0.85.
const BLOCK: f64 = 0.65;
/// Draught as a part of the beam, likewise: 1/2.5 for cargo ships, 1/5 for boats.
const DRAUGHT_PER_BEAM: f64 = 1.0 / 3.0;
/// Radius of gyration in yaw as a part of the length (Fossen 2011, section 7.1: 0.25 L).
const GYRATION_PER_LENGTH: f64 = 0.25;

impl Inertia {
    /// What a ship weighs in a contact: her model's displacement, or an estimate from her hull.
    pub(crate) fn of(ship: &Ship) -> Self {
        match ship.model {
            Model::ThreeDof(model) => {
                Self { mass_kg: model.displacement_kg, yaw_kgm2: model.inertia_kgm2 }
            }
            Model::Kinematic(_) | Model::Nomoto(_) => Self::of_outline(&ship.outline),
        }
    }

    /// An estimate from the dimensions of the hull; right to a factor of two or three, which is
    /// what impulse and energy of such a contact are worth.
    pub fn of_outline(hull: &HullOutline) -> Self {
        let draught_m = DRAUGHT_PER_BEAM * hull.beam_m;
        let mass_kg = SEA_WATER_KGPM3 * BLOCK * hull.length_m * hull.beam_m * draught_m;
        let radius_m = GYRATION_PER_LENGTH * hull.length_m;
        Self { mass_kg, yaw_kgm2: mass_kg * radius_m * radius_m }
    }
}

/// Numbers of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Closing speed at the point of contact along its normal, m/s.
    pub closing_mps: f64,
    /// Impulse, N s.
    pub impulse_ns: f64,
    /// Kinetic energy lost, J.
    pub energy_lost_j: f64,
}

/// Both ships after a burst.
#[derive(Clone, Copy, Debug)]
pub struct Aftermath {
    /// Numbers.
    pub impact: Impact,
    /// Velocity and yaw rate of the first ship after the contact.
    pub first: (Vec2, f64),
    /// The same of the second.
    pub second: (Vec2, f64),
}

/// Part of the closing speed that comes back. Ships crumple: collision mechanics takes them as
/// entirely inelastic (Pedersen and Zhang 1998, Marine Structures 11; cited from memory, the paper
/// was not at hand); a little keeps light touches apart.
const RESTITUTION: f64 = 0.1;
/// Steel on steel, wet (the same paper takes 0.3 to 0.6, likewise from memory).
const FRICTION: f64 = 0.3;
/// Step of the burst: a hull at 10 m/s enters the other by 2 cm before she is pushed out.
const STEP_S: f64 = 0.002;
/// The burst is over when momentum has not changed for this many steps after the first change.
const QUIET_STEPS: u32 = 25;
/// Longest burst.
const STEPS_MAX: u32 = 500;

/// Lets two touching ships collide.
pub fn collide(first: &Party<'_>, second: &Party<'_>) -> Aftermath {
    let gap = first.hull.gap(&first.pose, second.hull, &second.pose, &mut Warm::default());
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        integration_parameters: IntegrationParameters { dt: STEP_S, ..Default::default() },
        ..Default::default()
    };
    let bodies = [first, second].map(|party| insert(&mut world, party));
    let energy_before_j = energy_j(&world, bodies);
    let before = world.bodies[bodies[0]].linvel();
    let (mut last, mut quiet, mut struck) = (before, 0, false);
    for _ in 0..STEPS_MAX {
        world.step();
        let now = world.bodies[bodies[0]].linvel();
        let changed = now != last;
        (struck, last) = (struck | changed, now);
        quiet = if changed { 0 } else { quiet + 1 };
        if quiet >= QUIET_STEPS && struck {
            break;
        }
    }
    let after = |body: RigidBodyHandle| {
        let (velocity, yaw_rate) = (world.bodies[body].linvel(), world.bodies[body].angvel());
        (Vec2::new(velocity.x, velocity.y), yaw_rate)
    };
    let impulse = (world.bodies[bodies[0]].linvel() - before) * first.inertia.mass_kg;
    Aftermath {
        impact: Impact {
            closing_mps: closing_mps(&first.pose, &second.pose, &gap),
            impulse_ns: impulse.length(),
            energy_lost_j: (energy_before_j - energy_j(&world, bodies)).max(0.0),
        },
        first: after(bodies[0]),
        second: after(bodies[1]),
    }
}

fn insert(world: &mut PhysicsWorld, party: &Party<'_>) -> RigidBodyHandle {
    let Inertia { mass_kg, yaw_kgm2 } = party.inertia;
    let moves = mass_kg.is_finite();
    let body = if moves { RigidBodyBuilder::dynamic() } else { RigidBodyBuilder::fixed() };
    let body = body
        .pose(rapier_pose(&party.pose))
        .linvel(vector(party.pose.velocity_mps))
        .angvel(party.pose.yaw_rate_radps)
        .can_sleep(false);
    let shape = match party.hull.corners() {
        &[from, to] => SharedShape::segment(from, to),
        corners => SharedShape::convex_hull(corners)
            .expect("an outline of positive length and beam is a convex polygon"),
    };
    let collider = ColliderBuilder::new(shape).restitution(RESTITUTION).friction(FRICTION);
    let collider = if moves {
        collider.mass_properties(MassProperties::new(Vector::ZERO, mass_kg, yaw_kgm2))
    } else {
        collider
    };
    world.insert(body, collider).0
}

fn energy_j(world: &PhysicsWorld, bodies: [RigidBodyHandle; 2]) -> f64 {
    world.bodies[bodies[0]].kinetic_energy() + world.bodies[bodies[1]].kinetic_energy()
}

/// Closing speed along the normal of the contact. Hulls that overlap have no normal; the line
/// between the reference points stands in.
fn closing_mps(first: &Pose, second: &Pose, gap: &Gap) -> f64 {
    if gap.normal.norm_squared() > 0.0 {
        return (-gap.opening_mps).max(0.0);
    }
    let offset = second.position_m - first.position_m;
    let relative_mps = second.velocity_mps - first.velocity_mps;
    let range_m = offset.norm();
    if range_m > 0.0 { (-relative_mps.dot(&offset) / range_m).max(0.0) } else { 0.0 }
}
