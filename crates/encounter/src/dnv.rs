//! Situations of other tools: DNV's traffic-situation JSON, schema 0.2.0 (`maritime-schema`).
//!
//! One file is one encounter; its title is the stratum, with `j` = 0. Geographic positions become
//! metres on the plane that touches WGS-84 at own ship's first waypoint
//! ([`crate::geographic`]), knots become m/s. How the schema is read:
//!
//! * A leg's properties stand at the waypoint where it ends; `leg.data.sog` goes before `leg.sog`;
//!   a leg without a speed keeps the one before it.
//! * A ship starts at `initial`, or else at her first waypoint; either way she is on her first leg,
//!   and follows the waypoints from the second one on. With one waypoint she keeps her course.
//! * Speed at the start: `initial.sog`, else the first leg's, else the first waypoint's. Heading:
//!   on a route `initial.heading`, else `cog`, else the first leg's course; without a route the
//!   course made good goes before the heading, because she has no other way to keep to it.
//! * `a`, `b`, `c`, `d` place the reference point; they must add up to length and width.
//! * All ships are kinematic, with limits scaled by length.
//! * A current is taken over; wind and waves act on no ship of ours and are passed over, as are
//!   turn radii and cross-track limits. `visibility` is the range at which ships see one another.
//! * A delayed start and Bezier paths are refused, because they would be another situation.

use crate::dnv_ship::{Ship, geographic};
use crate::geographic::TangentPlane;
use crate::json::{Node, Wrong};
use crate::limits::{ScaledLimits, positive};
use crate::nominal::last_cpa_s;
use crate::sensing::SensingSpec;
use crate::{Error, RunSettings};
use geom::units::{NAUTICAL_MILE_M, deg};
use record::{Encounter, EncounterId, RunLimits, Seed, Visibility, Weather};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The table `[situations]`: how situations of other tools are taken over.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SituationSettings {
    /// A run ends this long after the last nominal closest point, seconds, or at the run's
    /// `duration_s_max` if that is earlier.
    pub after_last_cpa_s: f64,
    /// Length of a ship that states none, metres.
    pub length_m_if_unknown: f64,
    /// Beam of a ship that states none, as a share of her length.
    pub beam_per_length_if_unknown: f64,
    /// Limits of every ship.
    pub scaled_limits: ScaledLimits,
    /// What own ship perceives.
    pub sensing: SensingSpec,
}

impl SituationSettings {
    fn validate(&self) -> Result<(), Error> {
        const TABLE: &str = "situations";
        positive(TABLE, "after_last_cpa_s", self.after_last_cpa_s)?;
        positive(TABLE, "length_m_if_unknown", self.length_m_if_unknown)?;
        positive(TABLE, "beam_per_length_if_unknown", self.beam_per_length_if_unknown)?;
        self.scaled_limits.validate("situations.scaled_limits")?;
        self.sensing.validate("situations.sensing")
    }
}

/// Reads one file, or every `*.json` of a folder in the order of their names. The encounters carry
/// seed 0; the campaign sets its own. Titles that repeat get a number: `HO`, `HO (2)`.
pub fn read_situations(
    path: &Path,
    how: &SituationSettings,
    run: &RunSettings,
) -> Result<Vec<Encounter>, Error> {
    run.validate()?;
    how.validate()?;
    let mut titles: Vec<String> = Vec::new();
    let mut encounters = Vec::new();
    for file in files(path)? {
        let text = std::fs::read_to_string(&file).map_err(|e| unreadable(&file, &e))?;
        let title = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into());
        let wrong = |Wrong { at, problem }| Error::Situation { file: file.clone(), at, problem };
        let mut encounter = situation(&text, &title, how, run).map_err(wrong)?;
        for target in &encounter.targets {
            let own_length_m = encounter.own.hull.length_m;
            run.validate_centre_radius(own_length_m, target.hull.length_m)?;
        }
        let title = unique(encounter.id.stratum.to_string(), &titles);
        encounter.id = EncounterId::new(title.as_str(), 0);
        titles.push(title);
        encounters.push(encounter);
    }
    Ok(encounters)
}

fn files(path: &Path) -> Result<Vec<PathBuf>, Error> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(|e| unreadable(path, &e))? {
        let file = entry.map_err(|e| unreadable(path, &e))?.path();
        if file.extension().is_some_and(|extension| extension == "json") {
            files.push(file);
        }
    }
    if files.is_empty() {
        let problem = "the folder holds no *.json".to_owned();
        return Err(Error::Unreadable { path: path.to_owned(), problem });
    }
    files.sort();
    Ok(files)
}

fn unreadable(path: &Path, e: &std::io::Error) -> Error {
    Error::Unreadable { path: path.to_owned(), problem: e.to_string() }
}

fn unique(title: String, taken: &[String]) -> String {
    if !taken.contains(&title) {
        return title;
    }
    (2_u64..)
        .map(|n| format!("{title} ({n})"))
        .find(|numbered| !taken.contains(numbered))
        .expect("some number is free")
}

/// One file's encounter; `title` stands in where it has none.
fn situation(
    text: &str,
    title: &str,
    how: &SituationSettings,
    run: &RunSettings,
) -> Result<Encounter, Wrong> {
    let value: serde_json::Value = serde_json::from_str(text)
        .map_err(|e| Wrong { at: "$".to_owned(), problem: format!("is not JSON: {e}") })?;
    let root = Node::root(&value);
    if root.get("systemUnderTest")?.is_some() {
        return Err(root.wrong("is the output of a run; this reader takes traffic situations"));
    }
    check_version(&root)?;
    let own = root.need("ownShip")?;
    let first = own.need("waypoints")?;
    let first = first.list()?.into_iter().next().ok_or_else(|| first.wrong("is empty"))?;
    let plane = TangentPlane::new(geographic(&first.need("position")?)?);
    let (weather, visibility) = environment(&root)?;

    let own = Ship::read(&own, &plane, how)?;
    let ships = match root.get("targetShips")? {
        Some(ships) => ships.list()?,
        None => Vec::new(),
    };
    if ships.is_empty() {
        return Err(root.wrong("has no target in `targetShips`; an encounter needs one"));
    }
    let targets: Result<Vec<Ship>, Wrong> =
        ships.iter().map(|ship| Ship::read(ship, &plane, how)).collect();
    let current_mps = weather.current_mps;
    let own_ship = own
        .own_ship(current_mps, run)
        .map_err(|problem| Wrong { at: "$.ownShip".to_owned(), problem: problem.to_owned() })?;
    let targets = targets?.iter().map(|ship| ship.target(current_mps)).collect();
    let title = match root.get("title")? {
        Some(node) if !node.text()?.trim().is_empty() => node.text()?.trim(),
        _ => title,
    };
    let mut encounter = Encounter {
        id: EncounterId::new(title, 0),
        seed: Seed(0),
        weight: 1.0,
        own: own_ship,
        targets,
        hazards: Vec::new(),
        weather,
        sensing: how.sensing.sensing(),
        visibility,
        asked: None,
        safety_radius_m: run.safety_radius_m,
        distance: run.distance,
        run: run.limits,
    };
    encounter.run = limits(&encounter, how);
    Ok(encounter)
}

/// The run's limits, ended after the last nominal closest point, in whole beats.
fn limits(encounter: &Encounter, how: &SituationSettings) -> RunLimits {
    let run = encounter.run;
    let end_s = last_cpa_s(encounter) + how.after_last_cpa_s;
    let beats = (end_s / run.beat_s).ceil();
    RunLimits { duration_s_max: (beats * run.beat_s).min(run.duration_s_max), ..run }
}

/// The schema calls it `version`; DNV's own generator writes `schemaVersion`.
fn check_version(root: &Node<'_>) -> Result<(), Wrong> {
    let version = match root.get("version")? {
        Some(version) => version,
        None => root.get("schemaVersion")?.ok_or_else(|| {
            root.wrong("lacks `version`; this reader knows traffic situations of schema 0.2.0")
        })?,
    };
    if version.text()?.starts_with("0.2.") {
        return Ok(());
    }
    Err(version.wrong(format!("= {:?} is not known; this reader knows 0.2.0", version.text()?)))
}

fn environment(root: &Node<'_>) -> Result<(Weather, Visibility), Wrong> {
    let Some(environment) = root.get("environment")? else {
        return Ok((Weather::default(), Visibility::InSight));
    };
    let mut weather = Weather::default();
    if let Some(speed_mps) = environment.number_at("currentSpeed", 0.0, 10.0)? {
        // a current without a direction cannot be set; one that does not flow needs none
        if speed_mps > 0.0 {
            let towards_deg = environment.need("currentDirection")?.number(0.0, 360.0)?;
            weather.current_mps = geom::unit(deg(towards_deg)) * speed_mps;
        }
    }
    let visibility = match environment.number_at("visibility", 0.0, f64::MAX)? {
        Some(range_nm) => Visibility::Restricted { visual_range_m: range_nm * NAUTICAL_MILE_M },
        None => Visibility::InSight,
    };
    Ok((weather, visibility))
}
