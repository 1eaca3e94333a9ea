//! Every encounter is what its stratum promised: class, miss distance, time, range and side.

use crate::common::{campaign, generator, laboratory, model, run_settings};
use encounter::spec::{AlsoSpec, AlterSpec, IntentSpec};
use encounter::{Distribution, Generator, class_at_start, nominal_cpa};
use geom::units::{deg, to_deg};
use geom::{EncounterClass, HeadOnSector, Relative, Vec2, angle, unit};
use proptest::prelude::*;
use record::{Encounter, Seed};

const WIDE: HeadOnSector = HeadOnSector::wide(deg(13.0));

/// Signed miss distance by another way than the generator's: where the target is, seen along own
/// ship's motion relative to it, at the moment when the range stops falling.
fn signed_miss_m(encounter: &Encounter) -> f64 {
    let (own, target) = (&encounter.own.start, &encounter.targets[0].start);
    let own_mps = unit(own.psi_rad) * own.speed_mps;
    let relative_mps = own_mps - unit(target.psi_rad) * target.speed_mps;
    let way_m = target.position_m - own.position_m;
    let off_rad = geom::wrap(angle::direction(way_m) - angle::direction(relative_mps));
    way_m.norm() * geom::math::sin(off_rad)
}

fn lie(encounter: &Encounter) -> Relative {
    let (own, target) = (&encounter.own.start, &encounter.targets[0].start);
    Relative::new(own.position_m, own.psi_rad, target.position_m, target.psi_rad)
}

fn mirrored(encounter: &Encounter) -> Encounter {
    let mut mirror = encounter.clone();
    for start in [&mut mirror.own.start, &mut mirror.targets[0].start] {
        start.position_m.y = -start.position_m.y;
        start.psi_rad = -start.psi_rad;
    }
    mirror
}

fn keeps_promise(encounter: &Encounter, head_on: HeadOnSector) -> Result<(), TestCaseError> {
    let asked = encounter.asked.unwrap();
    let cpa = nominal_cpa(encounter)[0];
    prop_assert!((cpa.dcpa_m - asked.miss_m.abs()).abs() < 1e-6, "{cpa:?} {asked:?}");
    prop_assert!((cpa.tcpa_s.unwrap() - asked.tcpa_s).abs() < 1e-6, "{cpa:?} {asked:?}");
    prop_assert!((signed_miss_m(encounter) - asked.miss_m).abs() < 1e-6);
    prop_assert_eq!(class_at_start(encounter, 0, head_on), Some(asked.class));
    let mirror = mirrored(encounter);
    prop_assert_eq!(class_at_start(&mirror, 0, head_on), Some(asked.class.mirrored()));
    prop_assert!((signed_miss_m(&mirror) + asked.miss_m).abs() < 1e-6);
    Ok(())
}

proptest! {
    /// Found: a miss distance of the wrong sign when the normal was turned to port.
    #[test]
    fn laboratory_has_class_miss_distance_time_range_and_goal(
        seed in any::<u64>(), stratum in 0usize..9, j in 0u64..1_000_000_000,
    ) {
        let generator = laboratory();
        let encounter = generator.draw(Seed(seed), stratum, j).unwrap().encounter;
        keeps_promise(&encounter, WIDE)?;
        let asked = encounter.asked.unwrap();
        prop_assert!((90.0..=300.0).contains(&asked.tcpa_s));
        let range_m = lie(&encounter).range_m;
        let nearest_m = 375.0 + encounter.targets[0].hull.length_m / 2.0;
        prop_assert!(range_m >= nearest_m - 1e-6 && range_m <= 3000.0 + 1e-6, "{range_m}");
        let speed_mps = encounter.own.start.speed_mps;
        let goal_m = Vec2::new(speed_mps * (2.0 * asked.tcpa_s + 300.0), 0.0);
        prop_assert!((encounter.own.route[0].position_m - goal_m).norm() < 1e-6);
        prop_assert_eq!(encounter.weight.to_bits(), 1f64.to_bits());
        if let Some(class) = EncounterClass::from_name(&encounter.id.stratum) {
            prop_assert_eq!(asked.class, class);
        }
    }

    #[test]
    fn the_papers_world_keeps_its_promise_in_every_direction(
        seed in any::<u64>(), stratum in 0usize..5, j in 0u64..1_000_000_000,
    ) {
        let generator = generator("paper-random");
        let encounter = generator.draw(Seed(seed), stratum, j).unwrap().encounter;
        let head_on = HeadOnSector { half_angle_rad: deg(10.0), reciprocal_rad: deg(10.0) };
        keeps_promise(&encounter, head_on)?;
        let class = EncounterClass::from_name(&encounter.id.stratum);
        prop_assert_eq!(Some(encounter.asked.unwrap().class), class);
        prop_assert!(lie(&encounter).range_m >= 2.5 * 150.0 - 1e-6);
        prop_assert!(encounter.asked.unwrap().miss_m.abs() <= 0.9 * 150.0);
    }

    #[test]
    fn beside_a_border_the_angle_is_within_its_limit(
        seed in any::<u64>(), stratum in 5usize..9, j in 0u64..1_000_000_000,
    ) {
        use EncounterClass::{CrossingPort, CrossingStbd, HeadOn, Overtaken, Overtaking};
        let encounter = laboratory().draw(Seed(seed), stratum, j).unwrap().encounter;
        let class = encounter.asked.unwrap().class;
        let lie = lie(&encounter);
        let (beta_deg, alpha_deg) = (to_deg(lie.beta_rad).abs(), to_deg(lie.alpha_rad).abs());
        let (from_border_deg, allowed): (f64, &[EncounterClass]) = match &*encounter.id.stratum {
            "boundary_head_on" => {
                (beta_deg.max(alpha_deg) - 13.0, &[HeadOn, CrossingPort, CrossingStbd])
            }
            "boundary_bow" => (beta_deg, &[CrossingPort, CrossingStbd]),
            "boundary_overtaking" => {
                (alpha_deg - 112.5, &[Overtaking, CrossingPort, CrossingStbd])
            }
            "boundary_overtaken" => (beta_deg - 112.5, &[Overtaken, CrossingPort, CrossingStbd]),
            other => panic!("{other}"),
        };
        prop_assert!(from_border_deg.abs() <= 3.0 + 1e-9, "{from_border_deg}");
        prop_assert!(allowed.contains(&class), "{class:?}");
    }

    /// Own heading is drawn after everything else that own ship draws, and turns the whole scene.
    #[test]
    fn rotation_turns_the_scene_and_nothing_else(
        seed in any::<u64>(), stratum in 0usize..5, j in 0u64..1_000_000_000,
    ) {
        let file = campaign("paper-random");
        let mut model = model(&file);
        let turned = Generator::new(&model, &run_settings(&file)).unwrap();
        model.geometry.random_rotation = false;
        let north = Generator::new(&model, &run_settings(&file)).unwrap();
        let a = north.draw(Seed(seed), stratum, j).unwrap().encounter;
        let b = turned.draw(Seed(seed), stratum, j).unwrap().encounter;
        let psi_rad = b.own.start.psi_rad;
        prop_assert!(psi_rad > -std::f64::consts::PI && psi_rad <= std::f64::consts::PI);
        let position_m = angle::rotate(a.targets[0].start.position_m, psi_rad);
        prop_assert!((b.targets[0].start.position_m - position_m).norm() < 1e-6);
        let goal_m = angle::rotate(a.own.route[0].position_m, psi_rad);
        prop_assert!((b.own.route[0].position_m - goal_m).norm() < 1e-6);
        let (a_asked, b_asked) = (a.asked.unwrap(), b.asked.unwrap());
        prop_assert_eq!(a_asked.class, b_asked.class);
        prop_assert!((a_asked.tcpa_s - b_asked.tcpa_s).abs() < 1e-9);
    }

    #[test]
    fn an_encounter_depends_on_seed_stratum_and_number_alone(
        seed in any::<u64>(), stratum in 0usize..9, j in 0u64..1_000_000_000,
    ) {
        let file = campaign("laboratory");
        let all = laboratory();
        let mut alone = model(&file);
        alone.stratum = vec![alone.stratum[stratum].clone()];
        let alone = Generator::new(&alone, &run_settings(&file)).unwrap();
        let drawn = all.draw(Seed(seed), stratum, j).unwrap();
        // draws in between leave no trace
        all.draw(Seed(seed), (stratum + 1) % 9, j + 1).unwrap();
        prop_assert_eq!(&drawn, &all.draw(Seed(seed), stratum, j).unwrap());
        prop_assert_eq!(&drawn, &alone.draw(Seed(seed), 0, j).unwrap());
        let other = all.draw(Seed(seed), stratum, j + 1).unwrap();
        prop_assert!(drawn.encounter.asked != other.encounter.asked);
    }
}

/// Further targets are placed like the first, and leave it where it is.
#[test]
fn further_targets_keep_their_promise_and_move_nothing() {
    let file = campaign("laboratory");
    let mut three = model(&file);
    three.stratum.truncate(1);
    let also = |class| AlsoSpec {
        class,
        target_speed_mps: None,
        relative_course_deg: None,
        tcpa_after_first_s: None,
    };
    let further = [EncounterClass::CrossingStbd, EncounterClass::Overtaken];
    three.stratum[0].also = Some(further.map(also).to_vec());
    let three = Generator::new(&three, &run_settings(&file)).unwrap();
    for j in 0..200 {
        let one = laboratory().draw(Seed(9), 0, j).unwrap();
        let all = three.draw(Seed(9), 0, j).unwrap();
        assert_eq!(all.encounter.targets.len(), 3);
        assert_eq!(all.encounter.targets[0], one.encounter.targets[0]);
        assert_eq!(all.encounter.asked, one.encounter.asked);
        for (i, class) in further.into_iter().enumerate() {
            assert_eq!(class_at_start(&all.encounter, i + 1, WIDE), Some(class));
        }
        let cpa = nominal_cpa(&all.encounter);
        let last_s = cpa.iter().map(|c| c.tcpa_s.unwrap()).fold(0.0, f64::max);
        let goal_m = all.encounter.own.start.speed_mps * (2.0 * last_s + 300.0);
        assert!((all.encounter.own.route[0].position_m.x - goal_m).abs() < 1e-6);
    }
}

/// A declared arrival is her time to CPA less the first target's, with exactly its law, whatever
/// class and speeds it goes with; the first target stays where it is.
#[test]
fn further_targets_arrive_as_declared() {
    let file = campaign("laboratory");
    let mut two = model(&file);
    two.stratum.truncate(1);
    two.stratum[0].also = Some(vec![AlsoSpec {
        class: EncounterClass::CrossingStbd,
        target_speed_mps: None,
        relative_course_deg: None,
        tcpa_after_first_s: Some(Distribution::Uniform([-20.0, 40.0])),
    }]);
    let generator = Generator::new(&two, &run_settings(&file)).unwrap();
    let mut after: Vec<f64> = Vec::new();
    for j in 0..2000 {
        let drawn = generator.draw(Seed(9), 0, j).unwrap().encounter;
        let one = laboratory().draw(Seed(9), 0, j).unwrap().encounter;
        assert_eq!(drawn.targets[0], one.targets[0]);
        assert_eq!(class_at_start(&drawn, 1, WIDE), Some(EncounterClass::CrossingStbd));
        let cpa = nominal_cpa(&drawn);
        after.push(cpa[1].tcpa_s.unwrap() - cpa[0].tcpa_s.unwrap());
    }
    after.sort_by(f64::total_cmp);
    // Kolmogorov and Smirnov's distance at 1e-3 is 1.95 / sqrt(n)
    let n = after.len() as f64;
    let off = |(i, x): (usize, &f64)| ((x + 20.0) / 60.0 - (i as f64 + 0.5) / n).abs();
    let distance = after.iter().enumerate().map(off).fold(0.0, f64::max);
    assert!(distance < 1.95 / n.sqrt(), "{distance}");

    let also = two.stratum[0].also.as_mut().unwrap();
    also[0].tcpa_after_first_s = Some(Distribution::Uniform([-95.0, 0.0]));
    let said = Generator::new(&two, &run_settings(&file)).unwrap_err().to_string();
    assert!(said.contains("also.1.tcpa_after_first_s` reaches -95"), "{said}");
    let also = two.stratum[0].also.as_mut().unwrap();
    also[0].tcpa_after_first_s = Some(Distribution::Uniform([0.0, 30_000.0]));
    let said = Generator::new(&two, &run_settings(&file)).unwrap_err().to_string();
    assert!(said.contains("narrow tcpa_after_first_s"), "{said}");
}

/// Convention of the signed miss distance: own ship heads north at 8 m/s, the target comes south on
/// a line 100 m to the east of her. It passes to starboard of own ship's relative motion.
#[test]
fn a_target_that_passes_to_starboard_has_a_positive_miss_distance() {
    let mut encounter = laboratory().draw(Seed(1), 0, 0).unwrap().encounter;
    encounter.own.start.speed_mps = 8.0;
    encounter.targets[0].start = record::Motion {
        position_m: Vec2::new(2000.0, 100.0),
        psi_rad: std::f64::consts::PI,
        speed_mps: 6.0,
    };
    assert!((signed_miss_m(&encounter) - 100.0).abs() < 1e-9);
    for j in 0..200 {
        let head_on = laboratory().draw(Seed(1), 0, j).unwrap().encounter;
        // among reciprocal courses the target's side at the start tells the sign, when it is far
        // enough off the line of relative motion
        let asked = head_on.asked.unwrap();
        assert!((signed_miss_m(&head_on) - asked.miss_m).abs() < 1e-6);
    }
}

/// A target that alters does so before the promised closest point, from the same start.
#[test]
fn an_alteration_is_timed_from_the_promised_closest_point() {
    let file = campaign("laboratory");
    let mut altering = model(&file);
    altering.target.intent = IntentSpec::Alter(AlterSpec {
        before_cpa_s: Distribution::Uniform([50.0, 70.0]),
        course_change_deg: Distribution::Constant(40.0),
        speed_factor: Distribution::Constant(0.5),
    });
    let altering = Generator::new(&altering, &run_settings(&file)).unwrap();
    for j in 0..100 {
        let encounter = altering.draw(Seed(9), 1, j).unwrap().encounter;
        let target = &encounter.targets[0];
        assert_eq!(
            target.start,
            laboratory().draw(Seed(9), 1, j).unwrap().encounter.targets[0].start
        );
        let record::Intent::Alter { at_s, course_rad, speed_mps } = target.intent else {
            panic!("{:?}", target.intent)
        };
        let before_s = encounter.asked.unwrap().tcpa_s - at_s;
        assert!((50.0..=70.0).contains(&before_s), "{before_s}");
        assert!((geom::wrap(course_rad - target.start.psi_rad) - deg(40.0)).abs() < 1e-12);
        assert!((speed_mps - 0.5 * target.start.speed_mps).abs() < 1e-12);
    }
}

/// Pins one encounter: a change here changes every campaign.
#[test]
fn the_first_encounters_of_the_laboratory_are_pinned() {
    let generator = laboratory();
    let digest: Vec<String> = (0..9)
        .map(|stratum| {
            let drawn = generator.draw(Seed(20_261_121), stratum, 0).unwrap();
            let target = &drawn.encounter.targets[0].start;
            format!(
                "{} {} {:016x} {:016x}",
                drawn.encounter.id,
                drawn.rejected,
                target.position_m.x.to_bits(),
                target.psi_rad.to_bits()
            )
        })
        .collect();
    assert_eq!(digest, PINNED);
}

const PINNED: [&str; 9] = [
    "head_on/000000 1 409b48e6d9e73969 4008032d6ee60a1a",
    "crossing_stbd/000000 3 409108e3d650d685 bffe12ab080b8e19",
    "crossing_port/000000 0 40814ddd3c7401d7 3feda5b1b14d8fb8",
    "overtaking/000000 4 4091231920f8e0f1 3fdf0deca0022dac",
    "overtaken/000000 3 c083b8b1242c3b38 3fba72bb93456fb0",
    "boundary_head_on/000000 0 4090a61928674d58 c0080767d7b63e58",
    "boundary_bow/000000 100 4099dbf0b9576daf c0070030a2087a88",
    "boundary_overtaking/000000 19 409075a5615823f8 bfe85978df087cf0",
    "boundary_overtaken/000000 169 c06572e0e515a1b2 3fc29a59ab0a9d50",
];
