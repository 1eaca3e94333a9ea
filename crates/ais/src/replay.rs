//! A campaign that sails the encounters of a file again, with own ship in the place of one vessel.
//!
//! Each encounter stands in it twice, once for each ship that own ship replaces. The other sails
//! the track that was recorded, with its speeds, whatever own ship does. Own ship begins where the
//! vessel was, on her course and at her speed, and goes straight on: what the vessel did later may
//! have been avoidance, and that is own ship's to do.

use crate::meetings::{BEFORE_S, Meeting};
use crate::model_file::{IN_MEMORY, Source};
use crate::tracks::Track;
use geom::units::to_deg;
use geom::{Vec2, angle};
use std::fmt::Write as _;

/// Length of a vessel whose reports do not say it, metres.
const LENGTH_M_IF_UNKNOWN: f64 = 30.0;
/// Beam of a vessel whose reports do not say it, as a share of her length.
const BEAM_PER_LENGTH_IF_UNKNOWN: f64 = 0.2;
/// A track has a place so often, seconds; nearer ones would sail the errors of positions.
const PLACE_EVERY_S: f64 = 30.0;
/// A track ends so long after the closest point at the latest, seconds.
const AFTER_S: f64 = 300.0;
/// Planned is the speed at the start; a ship that leaves a harbour makes more of it later.
const SPEED_MAX_PER_PLANNED: f64 = 4.0;

/// The campaign; clock, sensing and limits are the template's. `None` without encounters.
///
/// # Errors
/// What the template lacks.
pub fn replay(
    template: &str,
    source: &Source,
    tracks: &[Track],
    meetings: &[Meeting],
) -> Result<Option<String>, String> {
    if meetings.is_empty() {
        return Ok(None);
    }
    let head = head(template, source)?;
    let text = toml::to_string(&head).map_err(|e| e.to_string())?;
    let Source { name, blake3, tool, .. } = source;
    Ok(Some(format!(
        "# Encounters of {name} (BLAKE3 {blake3}), made by {tool}.\n\
         # Each stands here twice, with own ship in the place of either vessel; the other sails\n\
         # the track that was recorded. Vessels whose reports give no length have \
         {LENGTH_M_IF_UNKNOWN} m.\n\n{text}\n{}",
        situations(tracks, meetings)
    )))
}

fn head(template: &str, source: &Source) -> Result<toml::Table, String> {
    let template: toml::Table = template.parse().map_err(|e| format!("{e}"))?;
    let at = |table: &toml::Table, key: &str| {
        table.get(key).cloned().ok_or_else(|| format!("`{key}` is not in it"))
    };
    let table = |value: toml::Value, key: &str| match value {
        toml::Value::Table(table) => Ok(table),
        _ => Err(format!("`{key}` is no table")),
    };
    let model = table(at(&template, "model")?, "model")?;
    let [own, target] = ["own", "target"].map(|key| at(&model, key).and_then(|v| table(v, key)));
    let (own, target) = (own?, target?);
    let limits = at(&target, "scaled_limits")?;
    let mut fast = table(limits.clone(), "scaled_limits")?;
    fast.insert("speed_max_per_planned".to_owned(), SPEED_MAX_PER_PLANNED.into());
    let own = toml::Table::from_iter([
        ("vessel".to_owned(), "kinematic".into()),
        ("length_m".to_owned(), at(&own, "length_m")?),
        ("beam_m".to_owned(), at(&own, "beam_m")?),
        ("scaled_limits".to_owned(), limits),
    ]);
    let target = toml::Table::from_iter([
        ("intent".to_owned(), "hold_course".into()),
        ("scaled_limits".to_owned(), fast.into()),
    ]);
    let set = toml::Table::from_iter([
        ("own".to_owned(), own.into()),
        ("target".to_owned(), target.into()),
        ("sensing".to_owned(), at(&model, "sensing")?),
    ]);
    let mut head = toml::Table::new();
    for key in ["schema", "seed", "planners", "rules", "run"] {
        head.insert(key.to_owned(), at(&template, key)?);
    }
    head.insert("name".to_owned(), "ais-replay".into());
    head.insert("title".to_owned(), format!("Encounters of {}, sailed again", source.name).into());
    head.insert("encounters_per_stratum".to_owned(), 1.into());
    head.insert("set".to_owned(), set.into());
    Ok(head)
}

fn situations(tracks: &[Track], meetings: &[Meeting]) -> String {
    let mut text = String::new();
    for (k, meeting) in meetings.iter().enumerate() {
        for (role, [own, other]) in [[0, 1], [1, 0]].into_iter().enumerate() {
            let (start, target) = (&meeting.start[own], &meeting.start[other]);
            let origin_m = start.position_m;
            let goal_m = start.velocity_mps * (3.0 * BEFORE_S);
            let vessel = &tracks[meeting.ships[other]];
            let length_m = vessel.length_m.unwrap_or(LENGTH_M_IF_UNKNOWN);
            // a slip of the unit or of the key makes a beam beyond the length
            let beam_m = vessel.width_m.filter(|width_m| *width_m < length_m);
            let beam_m = beam_m.unwrap_or(BEAM_PER_LENGTH_IF_UNKNOWN * length_m);
            writeln!(
                text,
                "[[situation]]\nname = \"pair_{k:04}_{role}\"\n\
                 own = {{ {} }}\ngoal = {{ north_m = {:.2}, east_m = {:.2} }}\n\
                 targets = [ {{ {}, length_m = {length_m:.1}, beam_m = {beam_m:.2}, \
                 intent = {{ track = [{}] }} }} ]\n",
                placed(Vec2::zeros(), start.velocity_mps),
                goal_m.x,
                goal_m.y,
                placed(target.position_m - origin_m, target.velocity_mps),
                track(vessel, meeting.cpa_s, origin_m),
            )
            .expect(IN_MEMORY);
        }
    }
    text
}

/// Her places from the start of the encounter on, as far as she was heard.
fn track(vessel: &Track, cpa_s: f64, origin_m: Vec2) -> String {
    let start_s = cpa_s - BEFORE_S;
    let count = ((BEFORE_S + AFTER_S) / PLACE_EVERY_S) as usize;
    let times = (0..=count).map(|k| start_s + PLACE_EVERY_S * k as f64);
    let heard: Vec<(f64, Vec2)> =
        times.filter_map(|t_s| Some((t_s, vessel.at(t_s)?.position_m))).collect();
    let legs = heard.windows(2).map(|pair| {
        let [(from_s, from_m), (to_s, to_m)] = [pair[0], pair[1]];
        let speed_mps = (to_m - from_m).norm() / (to_s - from_s);
        let place_m = to_m - origin_m;
        format!(
            " {{ north_m = {:.2}, east_m = {:.2}, speed_mps = {speed_mps:.3} }}",
            place_m.x, place_m.y
        )
    });
    legs.collect::<Vec<String>>().join(",")
}

fn placed(position_m: Vec2, velocity_mps: Vec2) -> String {
    let course_deg = to_deg(angle::direction(velocity_mps));
    // thousandths of a degree from 0 up to 360, which is 0 again
    let thousandths = ((course_deg * 1000.0).round() as i64).rem_euclid(360_000);
    format!(
        "north_m = {:.2}, east_m = {:.2}, course_deg = {:.3}, speed_mps = {:.3}",
        position_m.x,
        position_m.y,
        thousandths as f64 / 1000.0,
        velocity_mps.norm()
    )
}
