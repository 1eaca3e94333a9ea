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
random_turn_every_s = 120.0
random_turn_deg = { uniform = [-60.0, 60.0] }
planner = "hold-course"
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
               wrong_way = 0.08, random = 0.07, planner = 0.05 }";
    let generator = generator(mix).unwrap();
    let n = 4000;
    let mut counts = [0u32; 7];
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
            Intent::Planner(name) => {
                assert_eq!(name, "hold-course");
                6
            }
            other => panic!("{other:?}"),
        };
        counts[kind] += 1;
    }
    for (count, share) in counts.into_iter().zip([0.3, 0.25, 0.15, 0.1, 0.08, 0.07, 0.05f64]) {
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
