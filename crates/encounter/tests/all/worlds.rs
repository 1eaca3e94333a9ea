//! The campaign files of the harder worlds can be drawn from, and say what they promise.

use crate::common::{campaign, generator, laboratory};
use encounter::Generator;
use record::{Encounter, Intent, Seed, Sensing, Visibility};

fn draw(generator: &Generator, stratum: usize, j: u64) -> Encounter {
    generator.draw(Seed(20_261_121), stratum, j).expect("the model can be drawn").encounter
}

/// The open sea meets the ships of the laboratory in the same places.
#[test]
fn the_open_sea_is_the_laboratory_with_weather_noise_and_intents() {
    let (open, perfect) = (generator("open-sea"), laboratory());
    let mut minding = 0;
    for stratum in 0..9 {
        for j in 0..20 {
            let lab = draw(perfect, stratum, j);
            let mut sea = draw(&open, stratum, j);
            assert!(matches!(sea.sensing, Sensing::AisRadar(_)));
            assert!(sea.weather.wind.is_some() && sea.weather.current_mps.norm() < 0.8);
            minding += u32::from(sea.targets[0].intent != Intent::HoldCourse);
            sea.targets[0].intent = Intent::HoldCourse;
            (sea.weather, sea.sensing) = (lab.weather, lab.sensing.clone());
            assert_eq!(sea, lab);
        }
    }
    assert!((40..110).contains(&minding), "{minding} of 180");
}

/// `quick` and `open-sea` differ in name, title and number of encounters, and in nothing else: what
/// is found in the one holds in the other.
#[test]
fn quick_is_the_world_of_the_open_sea() {
    let (mut quick, mut open) = (campaign("quick"), campaign("open-sea"));
    for file in [&mut quick, &mut open] {
        for own in ["name", "title", "encounters_per_stratum"] {
            assert!(file.remove(own).is_some(), "{own}");
        }
    }
    assert_eq!(quick, open);
}

/// `traffic` is the open sea with another law of who is met: every miss distance within a
/// kilometre, at the encounter rate.
#[test]
fn the_traffic_is_that_of_the_open_sea() {
    let (mut traffic, mut open) = (campaign("traffic"), campaign("open-sea"));
    for file in [&mut traffic, &mut open] {
        for own in ["name", "title", "encounters_per_stratum"] {
            assert!(file.remove(own).is_some(), "{own}");
        }
        let model = file["model"].as_table_mut().unwrap();
        assert!(model.remove("stratum").is_some());
        assert!(model["geometry"].as_table_mut().unwrap().remove("miss_m").is_some());
    }
    assert!(traffic["model"].as_table_mut().unwrap().remove("encounter_rate").is_some());
    assert_eq!(traffic, open);
    let generator = generator("traffic");
    let weights: Vec<f64> = (0..200).map(|j| draw(&generator, 0, j).weight).collect();
    assert!(weights.iter().all(|&w| w > 0.0 && w <= generator.weight_max(0)));
    let mean = weights.iter().sum::<f64>() / 200.0;
    assert!((mean - 1.0).abs() < 0.25 && generator.weight_max(0) < 4.0, "{mean}");
}

#[test]
fn fog_restricts_visibility_and_the_harbour_has_land() {
    let fog = draw(&generator("fog"), 0, 0);
    assert_eq!(fog.visibility, Visibility::Restricted { visual_range_m: 400.0 });
    let harbour = generator("harbour");
    let most = (0..harbour.strata().len()).map(|s| draw(&harbour, s, 3).targets.len()).max();
    assert_eq!(most, Some(3));
    assert_eq!(draw(&harbour, 0, 0).hazards.len(), 3);
}
