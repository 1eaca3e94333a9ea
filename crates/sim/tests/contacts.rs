//! The sweep and the burst against a rapier world that is stepped all the time.

mod scenes;

use geom::{HullOutline, Vec2, units::deg};
use proptest::prelude::*;
use rapier2d_f64::prelude::{
    ColliderBuilder, IntegrationParameters, MassProperties, PhysicsWorld, Pose as RapierPose,
    RigidBodyBuilder, RigidBodyHandle, SharedShape, Vector,
};
use record::{Encounter, EncounterId, Intent, Outcome, Purpose, Seed, Streams};
use scenes::{Meeting, Orders, kinematic, run};
use sim::contact::{Inertia, Party, collide};
use sim::hull::{Hull, Warm};
use sim::pose::Pose;
use sim::vessel::{Helm, Model, State};

/// Ships that pass within a decimetre or so of touching, some of them turning on the way.
fn grazing(k: u32, step_s: f64) -> (Encounter, Orders) {
    let id = EncounterId::new("grazing", u64::from(k));
    let mut draw = Streams::new(Seed(1), &id).stream(Purpose::Geometry, 0);
    let course_rad = draw.uniform_in(deg(-175.0), deg(175.0));
    let length_m = draw.uniform_in(10.0, 50.0);
    let miss_m = draw.uniform_in(-0.5, 0.5) * (length_m + 12.0);
    let target_mps = draw.uniform_in(3.0, 9.0);
    let (target_length_m, target_course_rad) = (length_m, course_rad);
    let meeting =
        Meeting { target_course_rad, target_mps, target_length_m, miss_m, tcpa_s: 12.0, step_s };
    let mut encounter = meeting.encounter(kinematic(), kinematic());
    if k.is_multiple_of(3) {
        let course_rad = course_rad + deg(40.0);
        encounter.targets[0].intent = Intent::Alter { at_s: 4.0, course_rad, speed_mps: 5.0 };
    }
    let turn_rad = if k.is_multiple_of(2) { 0.0 } else { deg(50.0) };
    (encounter, Orders(vec![(0.0, 0.0, 7.0), (6.0, turn_rad, 7.0)]))
}

/// A rapier world stepped from start to end, its velocities set from the marine model at every
/// step: whether the hulls pushed one another, and the smallest gap at the samples.
fn stepped_always(encounter: &Encounter, orders: &Orders, duration_s: f64) -> (bool, f64) {
    const STEP_S: f64 = 0.005;
    let start = |m: &record::Motion| State::ahead(m.position_m, m.psi_rad, m.speed_mps);
    let target = &encounter.targets[0];
    let model = Model::of(&encounter.own.vessel).expect("a kinematic vessel");
    let mut states = [start(&encounter.own.start), start(&target.start)];
    let outlines = [encounter.own.hull, target.hull];
    let hulls = outlines.map(|outline| Hull::new(&outline));
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        integration_parameters: IntegrationParameters { dt: STEP_S, ..Default::default() },
        ..Default::default()
    };
    let bodies = [0, 1].map(|i| insert(&mut world, &outlines[i], &states[i]));
    let calm = Vec2::zeros();
    let mut helms = states.map(|s| Helm::over_ground(s.psi_rad, s.surge_mps, calm));
    let mut gap_m = f64::INFINITY;
    for k in 0..(duration_s / STEP_S) as usize {
        let t_s = k as f64 * STEP_S;
        // orders take effect at the beat, as in a run
        if k % 200 == 0 {
            let &(_, course_rad, speed_mps) = orders
                .0
                .iter()
                .rev()
                .find(|order| order.0 <= t_s + 1e-9)
                .expect("an order for time 0");
            helms[0] = Helm::over_ground(course_rad, speed_mps, calm);
            if let Intent::Alter { at_s, course_rad, speed_mps } = target.intent
                && at_s <= t_s + 1e-9
            {
                helms[1] = Helm::over_ground(geom::wrap(course_rad), speed_mps, calm);
            }
        }
        for i in 0..2 {
            let next = model.step(&states[i], &helms[i], calm, STEP_S);
            let velocity = (next.position_m - states[i].position_m) / STEP_S;
            let body = &mut world.bodies[bodies[i]];
            body.set_linvel(Vector::new(velocity.x, velocity.y), true);
            body.set_angvel(geom::wrap(next.psi_rad - states[i].psi_rad) / STEP_S, true);
            states[i] = next;
        }
        let wanted = bodies.map(|b| (world.bodies[b].linvel(), world.bodies[b].angvel()));
        world.step();
        let got = bodies.map(|b| (world.bodies[b].linvel(), world.bodies[b].angvel()));
        let poses = states.map(|s| Pose::of(&s, calm));
        gap_m = gap_m
            .min(hulls[0].gap(&poses[0], &hulls[1], &poses[1], &mut Warm::default()).distance_m);
        if wanted != got {
            return (true, gap_m);
        }
    }
    (false, gap_m)
}

fn insert(world: &mut PhysicsWorld, outline: &HullOutline, state: &State) -> RigidBodyHandle {
    let corners: Vec<Vector> =
        outline.corners_body_m().iter().map(|c| Vector::new(c.x, c.y)).collect();
    let body = RigidBodyBuilder::dynamic()
        .pose(RapierPose::new(Vector::new(state.position_m.x, state.position_m.y), state.psi_rad))
        .can_sleep(false);
    let inertia = Inertia::of_outline(outline);
    let collider =
        ColliderBuilder::new(SharedShape::convex_hull(&corners).expect("a convex outline"))
            .mass_properties(MassProperties::new(Vector::ZERO, inertia.mass_kg, inertia.yaw_kgm2));
    world.insert(body, collider).0
}

/// Among 400 grazing encounters the two may differ only where the hulls pass within a centimetre
/// and a half: rapier pushes hulls that would meet within its next step, and lets them sink in by
/// its slop of half a centimetre.
#[test]
fn contacts_are_those_of_a_rapier_world_stepped_always() {
    let (mut contacts, mut clear, mut marginal) = (0, 0, 0);
    for k in 0..400 {
        let step_s = [0.25, 0.5, 1.0][k as usize % 3];
        let (mut encounter, orders) = grazing(k, step_s);
        encounter.run.duration_s_max = 24.0;
        if sim::check(&encounter).is_err() {
            continue;
        }
        let trace = run(&encounter, &mut orders.clone());
        let (touched, gap_m) = stepped_always(&encounter, &orders, 24.0);
        let swept = trace.outcome == Outcome::Collision;
        match (swept, touched) {
            (true, true) => contacts += 1,
            (false, false) => clear += 1,
            (true, false) => {
                assert!(gap_m < 0.015, "{k}: the sweep sees a contact at {gap_m} m");
                marginal += 1;
            }
            (false, true) => {
                let gap_m = trace.pairs[0].minimum.hull_m;
                assert!(gap_m < 0.015, "{k}: the sweep misses a contact, it saw {gap_m} m");
                marginal += 1;
            }
        }
    }
    println!("{contacts} contacts, {clear} clear, {marginal} marginal");
    assert!(contacts > 100 && clear > 50 && marginal <= 4, "{contacts} {clear} {marginal}");
}

fn pose(x: f64, y: f64, psi_rad: f64, velocity_mps: Vec2, yaw_rate_radps: f64) -> Pose {
    Pose { position_m: Vec2::new(x, y), velocity_mps, heading: geom::unit(psi_rad), yaw_rate_radps }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn contact_conserves_momentum_and_gains_no_energy(
        bearing in -3.1f64..3.1, psi in -3.1f64..3.1, other_psi in -3.1f64..3.1,
        speed in 1f64..10.0, other_speed in 0f64..10.0, length in 6f64..60.0, yaw in -0.2f64..0.2,
    ) {
        let outlines =
            [HullOutline::centred(8.45, 2.71), HullOutline::centred(length, length / 5.0)];
        let hulls = outlines.map(|o| Hull::new(&o));
        let towards = geom::unit(bearing);
        // the second ship just off the first, found by pulling her in along the bearing
        let mut range = 100.0;
        for _ in 0..60 {
            let gap = hulls[0].gap(
                &pose(0.0, 0.0, psi, Vec2::zeros(), 0.0), &hulls[1],
                &pose(towards.x * range, towards.y * range, other_psi, Vec2::zeros(), 0.0),
                &mut Warm::default(),
            );
            range -= (gap.distance_m - 1e-3).max(0.0);
        }
        let first = Party {
            hull: &hulls[0],
            pose: pose(0.0, 0.0, psi, towards * speed, yaw),
            inertia: Inertia::of_outline(&outlines[0]),
        };
        let second = Party {
            hull: &hulls[1],
            pose: Pose {
                position_m: towards * range,
                ..pose(0.0, 0.0, other_psi, towards * -other_speed, -yaw)
            },
            inertia: Inertia::of_outline(&outlines[1]),
        };
        // hulls whose nearest points swing apart do not collide
        let gap = hulls[0].gap(&first.pose, &hulls[1], &second.pose, &mut Warm::default());
        prop_assume!(gap.opening_mps < -0.05);
        let after = collide(&first, &second);
        let (m, n) = (first.inertia.mass_kg, second.inertia.mass_kg);
        let before = first.pose.velocity_mps * m + second.pose.velocity_mps * n;
        let drift = (after.first.0 * m + after.second.0 * n - before).norm();
        prop_assert!(drift < 1e-9 * (m * speed + n * other_speed), "{drift}");
        let energy = |p: &Party<'_>, (v, r): (Vec2, f64)| {
            0.5 * (p.inertia.mass_kg * v.norm_squared() + p.inertia.yaw_kgm2 * r * r)
        };
        let start = energy(&first, (first.pose.velocity_mps, yaw))
            + energy(&second, (second.pose.velocity_mps, -yaw));
        let end = energy(&first, after.first) + energy(&second, after.second);
        prop_assert!(end <= start * (1.0 + 1e-9), "{start} -> {end}");
        prop_assert!((after.impact.energy_lost_j - (start - end).max(0.0)).abs() < 1e-6 * start);
        prop_assert!(after.impact.closing_mps > 0.0 && after.impact.impulse_ns > 0.0);
    }
}

/// Two equal ships bow to bow: the impulse is (1 + e) m v, the loss (1 - e^2) m v^2, with e the
/// restitution of 0.1 (less what the engine's soft contact takes).
#[test]
fn central_impact_has_the_textbook_impulse() {
    let outline = HullOutline::centred(20.0, 5.0);
    let hull = Hull::new(&outline);
    let inertia = Inertia { mass_kg: 50_000.0, yaw_kgm2: 1e6 };
    let first = Party { hull: &hull, pose: pose(0.0, 0.0, 0.0, Vec2::new(4.0, 0.0), 0.0), inertia };
    let second = Party {
        hull: &hull,
        pose: pose(20.001, 0.0, std::f64::consts::PI, Vec2::new(-4.0, 0.0), 0.0),
        inertia,
    };
    let impact = collide(&first, &second).impact;
    assert!((impact.closing_mps - 8.0).abs() < 1e-9);
    let (plastic, elastic_tenth) = (50_000.0 * 4.0, 1.1 * 50_000.0 * 4.0);
    assert!(impact.impulse_ns > 0.99 * plastic && impact.impulse_ns < 1.01 * elastic_tenth);
    let energy = 50_000.0 * 16.0;
    assert!(impact.energy_lost_j > 0.98 * energy && impact.energy_lost_j <= energy * (1.0 + 1e-9));
}
