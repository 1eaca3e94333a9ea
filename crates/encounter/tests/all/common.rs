//! The campaign files of the repository, read as the campaign stage reads them.

use encounter::{Generator, Model, RunSettings};
use record::{DistanceKind, RunLimits, RunUntil};
use std::path::PathBuf;

/// The parsed file `campaigns/<name>.toml`.
pub(crate) fn campaign(name: &str) -> toml::Table {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../campaigns")
        .join(format!("{name}.toml"));
    std::fs::read_to_string(&path).unwrap().parse().unwrap()
}

/// What the table `[run]` says.
pub(crate) fn run_settings(file: &toml::Table) -> RunSettings {
    let run = &file["run"];
    let number = |key: &str| run[key].as_float().unwrap();
    RunSettings {
        limits: RunLimits {
            step_s: number("step_s"),
            beat_s: number("beat_s"),
            duration_s_max: number("duration_s_max"),
            until: RunUntil::PastAndClear,
        },
        safety_radius_m: number("safety_radius_m"),
        distance: match run["distance"].as_str().unwrap() {
            "hull" => DistanceKind::Hull,
            "centre" => DistanceKind::Centre,
            other => panic!("distance {other}"),
        },
    }
}

/// The table `[model]` of a campaign.
pub(crate) fn model(file: &toml::Table) -> Model {
    file["model"].clone().try_into().unwrap()
}

/// The generator of a campaign.
pub(crate) fn generator(name: &str) -> Generator {
    let file = campaign(name);
    Generator::new(&model(&file), &run_settings(&file)).unwrap()
}

/// A generator that every case of a property test shares.
pub(crate) fn laboratory() -> &'static Generator {
    static LABORATORY: std::sync::OnceLock<Generator> = std::sync::OnceLock::new();
    LABORATORY.get_or_init(|| generator("laboratory"))
}
