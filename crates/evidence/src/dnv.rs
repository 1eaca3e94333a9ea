//! An encounter as a DNV traffic situation, schema 0.2.0 (`maritime-schema`), so that it opens in
//! other tools. Read back by [`encounter::read_situations`], it is the same geometry.
//!
//! Left out because the schema has no word for it: the vessel models and their limits, sensing,
//! a target that alters course at a time, hazards, and the safety radius.

use encounter::geographic::{Geographic, TangentPlane};
use geom::units::{NAUTICAL_MILE_M, to_deg, to_knots};
use geom::{HullOutline, Vec2, math, units};
use record::encounter::{Intent, Motion, Visibility, Waypoint};
use report::Case;
use serde_json::{Value, json};

/// Where an encounter's own origin is laid, degrees north and east: open water in the North Sea.
/// Encounters have no place of their own.
pub(crate) const ORIGIN: (f64, f64) = (57.0, 4.0);
/// Metres in a degree of latitude, roughly: the steps of the search below are checked by the plane.
const DEGREE_M: f64 = 111_000.0;
/// A search that has not come this near by then would be a fault of the plane, metres.
const NEAR_M: f64 = 1e-4;

/// Latitude and longitude, degrees, of a point of the plane at [`ORIGIN`].
pub(crate) fn place(position_m: Vec2) -> (f64, f64) {
    let plane = TangentPlane::new(Geographic { lat_deg: ORIGIN.0, lon_deg: ORIGIN.1 });
    let mut found = Geographic { lat_deg: ORIGIN.0, lon_deg: ORIGIN.1 };
    let cos_lat = math::sin_cos(units::deg(ORIGIN.0)).1;
    for _ in 0..30 {
        let off_m = position_m - plane.position_m(found);
        if off_m.norm() < NEAR_M {
            break;
        }
        found.lat_deg += off_m.x / DEGREE_M;
        found.lon_deg += off_m.y / (DEGREE_M * cos_lat);
    }
    (found.lat_deg, found.lon_deg)
}

/// The traffic situation of an encounter before it was run.
pub(crate) fn traffic_situation(case: &Case) -> Value {
    let encounter = &case.encounter;
    let own = &encounter.own;
    let targets: Vec<Value> = (encounter.targets.iter().enumerate())
        .map(|(i, target)| {
            let route: &[Waypoint] = match &target.intent {
                Intent::Track(route) => route,
                _ => &[],
            };
            ship(i as u64 + 2, &target.hull, &target.start, route, target.start.speed_mps)
        })
        .collect();
    let mut situation = json!({
        "version": "0.2.0",
        "title": encounter.id.to_string(),
        "description": format!(
            "seatrial, seed {}; the origin of the encounter is laid at {} N, {} E; outcome {}",
            encounter.seed, ORIGIN.0, ORIGIN.1, case.row.outcome.name()
        ),
        "ownShip": ship(1, &own.hull, &own.start, &own.route, own.cruise_mps),
        "targetShips": targets,
    });
    let mut environment = serde_json::Map::new();
    let current_mps = encounter.weather.current_mps;
    if current_mps.norm() > 0.0 {
        let towards = to_deg(geom::angle::direction(current_mps)).rem_euclid(360.0);
        environment.insert("currentSpeed".to_owned(), json!(current_mps.norm()));
        environment.insert("currentDirection".to_owned(), json!(towards));
    }
    if let Visibility::Restricted { visual_range_m } = encounter.visibility {
        environment.insert("visibility".to_owned(), json!(visual_range_m / NAUTICAL_MILE_M));
    }
    if !environment.is_empty() {
        situation["environment"] = Value::Object(environment);
    }
    situation
}

fn ship(id: u64, hull: &HullOutline, start: &Motion, route: &[Waypoint], cruise_mps: f64) -> Value {
    let mut speed_mps = cruise_mps;
    let mut waypoints = vec![json!({ "position": position(start.position_m) })];
    for waypoint in route {
        speed_mps = waypoint.speed_mps.unwrap_or(speed_mps);
        waypoints.push(json!({
            "position": position(waypoint.position_m),
            "leg": { "sog": to_knots(speed_mps) },
        }));
    }
    let heading_deg = to_deg(start.psi_rad).rem_euclid(360.0);
    json!({
        "static": { "id": id, "dimensions": {
            "length": hull.length_m,
            "width": hull.beam_m,
            "a": hull.length_m / 2.0 + hull.midships_forward_m,
            "b": hull.length_m / 2.0 - hull.midships_forward_m,
            "c": hull.beam_m / 2.0 - hull.midships_starboard_m,
            "d": hull.beam_m / 2.0 + hull.midships_starboard_m,
        }},
        "initial": {
            "position": position(start.position_m),
            "sog": to_knots(start.speed_mps),
            "cog": heading_deg,
            "heading": heading_deg,
        },
        "waypoints": waypoints,
    })
}

pub(crate) fn position(position_m: Vec2) -> Value {
    let (lat, lon) = place(position_m);
    json!({ "lat": lat, "lon": lon })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_lies_where_the_plane_says() {
        let plane = TangentPlane::new(Geographic { lat_deg: ORIGIN.0, lon_deg: ORIGIN.1 });
        for wanted in [Vec2::new(0.0, 0.0), Vec2::new(3000.0, -4000.0), Vec2::new(-2e4, 3e4)] {
            let (lat_deg, lon_deg) = place(wanted);
            let there = plane.position_m(Geographic { lat_deg, lon_deg });
            assert!((there - wanted).norm() < 1e-3, "{wanted:?} {there:?}");
        }
    }
}
