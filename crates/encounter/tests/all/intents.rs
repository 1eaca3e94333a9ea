//! Mixes of intents: shares, streams, and what is refused.

use crate::common::{campaign, run_settings};
use encounter::{Generator, Model};
use record::{Encounter, Intent, Manner, Seed};

const CONDUCT: &str = r#"
[model.target.conduct]
early_tcpa_s = { uniform = [60.0, 150.0] }
late_tcpa_s = { uniform = [15.0, 30.0] }
course_change_deg = { uniform = [20.0, 60.0] }
risk_dcpa_m = 250.0
stand_on_tcpa_s = { uniform = [20.0, 60.0] }
stand_on_dcpa_m = 100.0
random_turn_every_s = 120.0
random_turn_deg = { uniform = [-60.0, 60.0] }
planner = "hold-course"
[model.target.conduct.track]
legs = 4
leg_s = { uniform = [60.0, 120.0] }
course_off_deg = { uniform = [-90.0, 90.0] }
speed_factor = { uniform = [0.5, 1.2] }
[model.geometry]"#;

fn generator(mix: &str) -> Result<Generator, String> {
    let path = format!("{}/../../campaigns/laboratory.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the campaign is there");
    let text = text
        .replacen("intent = \"hold_course\"", &format!("intent = \"hold_course\"\n{mix}"), 1)
        .replacen("[model.geometry]", CONDUCT, 1);
    let file: toml::Table = text.parse().expect("the text is TOML");
    let model: Model = file["model"].clone().try_into().map_err(|e| format!("{e}"))?;
    Generator::new(&model, &run_settings(&campaign("laboratory"))).map_err(|e| e.to_string())
}

fn draw(generator: &Generator, j: u64) -> Encounter {
    generator.draw(Seed(5), 1, j).expect("the model can be drawn").encounter
}

#[test]
fn shares_are_those_of_the_file() {
    let mix = "intent_mix = { hold_course = 0.3, comply = 0.25, late = 0.15, neglect = 0.1, \
               wrong_way = 0.08, random = 0.05, track = 0.02, planner = 0.05 }";
    let generator = generator(mix).unwrap();
    let n = 4000;
    let mut counts = [0u32; 8];
    for j in 0..n {
        let encounter = draw(&generator, j);
        let kind = match &encounter.targets[0].intent {
            Intent::HoldCourse => 0,
            Intent::Duty(c) if c.manner == Manner::Complies && c.act_tcpa_s >= 60.0 => 1,
            Intent::Duty(c) if c.manner == Manner::Complies => 2,
            Intent::Duty(c) if c.manner == Manner::Neglects => 3,
            Intent::Duty(_) => 4,
            Intent::Turns(turns) => {
                assert!(turns.windows(2).all(|pair| pair[0].at_s <= pair[1].at_s));
                5
            }
            Intent::Track(_) => 6,
            Intent::Planner(name) => {
                assert_eq!(name, "hold-course");
                7
            }
            other => panic!("{other:?}"),
        };
        counts[kind] += 1;
    }
    for (count, share) in counts.into_iter().zip([0.3, 0.25, 0.15, 0.1, 0.08, 0.05, 0.02, 0.05f64])
    {
        let sd = (share * (1.0 - share) / n as f64).sqrt();
        let found = f64::from(count) / n as f64;
        assert!((found - share).abs() < 4.5 * sd, "{found} for {share}");
    }
}

/// Turns at random come as a Poisson process: the mean number in 1200 s is 10, and so is the
/// variance.
#[test]
fn random_turns_have_their_rate() {
    let generator = generator("intent_mix = { random = 1.0 }").unwrap();
    let n = 1500;
    let (mut sum, mut squares) = (0.0, 0.0);
    for j in 0..n {
        let Intent::Turns(turns) = &draw(&generator, j).targets[0].intent else { panic!("{j}") };
        let count = turns.len() as f64;
        sum += count;
        squares += count * count;
    }
    let mean = sum / n as f64;
    let variance = squares / n as f64 - mean * mean;
    // 4.5 standard errors of the mean, and of the variance of a Poisson law
    assert!((mean - 10.0).abs() < 4.5 * (10.0 / n as f64).sqrt(), "{mean}");
    assert!((variance - 10.0).abs() < 4.5 * 10.0 * (2.1 / n as f64).sqrt(), "{variance}");
}

/// The first leg is the encounter that was asked for; later legs keep within their laws.
#[test]
fn tracks_are_drawn_from_their_laws() {
    let generator = generator("intent_mix = { track = 1.0 }").unwrap();
    let mut sum_deg = 0.0;
    for j in 0..500 {
        let target = draw(&generator, j).targets.remove(0);
        let Intent::Track(waypoints) = &target.intent else { panic!("{j}") };
        assert_eq!(waypoints.len(), 4);
        let mut from_m = target.start.position_m;
        for (leg, waypoint) in waypoints.iter().enumerate() {
            let (way_m, speed_mps) = (waypoint.position_m - from_m, waypoint.speed_mps.unwrap());
            let leg_s = way_m.norm() / speed_mps;
            assert!((60.0 - 1e-9..=120.0 + 1e-9).contains(&leg_s), "{leg_s}");
            let off_rad = geom::wrap(geom::angle::direction(way_m) - target.start.psi_rad);
            let factor = speed_mps / target.start.speed_mps;
            if leg == 0 {
                assert!(off_rad.abs() < 1e-9 && (factor - 1.0).abs() < 1e-12);
            } else {
                assert!(off_rad.abs().to_degrees() <= 90.0 + 1e-9, "{off_rad}");
                assert!((0.5..=1.2).contains(&factor), "{factor}");
                sum_deg += off_rad.to_degrees();
            }
            from_m = waypoint.position_m;
        }
    }
    // 1500 draws of a law with a standard deviation of 52 degrees
    assert!((sum_deg / 1500.0).abs() < 4.5 * 52.0 / 1500f64.sqrt(), "{sum_deg}");
}

/// The same ships in the same places, whatever the mix.
#[test]
fn a_mix_moves_no_ship() {
    let plain = generator("").unwrap();
    let mixed = generator("intent_mix = { random = 0.5, comply = 0.5 }").unwrap();
    for j in 0..50 {
        let (mut mixed, plain) = (draw(&mixed, j), draw(&plain, j));
        assert_ne!(mixed.targets[0].intent, plain.targets[0].intent);
        mixed.targets[0].intent = Intent::HoldCourse;
        assert_eq!(mixed, plain);
    }
}

#[test]
fn wrong_mixes_are_refused() {
    let refused = |mix: &str| generator(mix).unwrap_err();
    assert!(refused("intent_mix = { comply = 0.7, late = 0.2 }").contains("sum to 0.8999"));
    assert!(refused("intent_mix = { comply = 1.5, late = -0.5 }").contains("must be a share"));
    assert!(refused("intent_mix = { obey = 1.0 }").contains("unknown field `obey`"));
}
