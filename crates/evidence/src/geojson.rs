//! Tracks as GeoJSON (RFC 7946), for maps. Encounters have no place on Earth: they are laid at the
//! origin of [`encounter::geographic`]'s plane that [`ORIGIN`] names, and the file says so.

use crate::dnv::{ORIGIN, place};
use geom::units::to_deg;
use record::ShipTrack;
use report::Case;
use serde_json::{Value, json};

/// One feature for each ship's track, one for each end of a track.
pub(crate) fn tracks(case: &Case) -> Value {
    let trace = &case.trace;
    let ships = std::iter::once(("own ship".to_owned(), &trace.own))
        .chain(trace.targets.iter().enumerate().map(|(i, t)| (format!("target {}", i + 1), t)));
    let mut features = Vec::new();
    for (name, track) in ships.filter(|(_, track)| !track.is_empty()) {
        let line: Vec<Value> = (0..track.len()).map(|k| point(track, k)).collect();
        let times_s: Vec<f64> = (0..track.len()).map(|k| k as f64 * trace.sample_s).collect();
        let speeds_mps: Vec<f64> = (0..track.len()).map(|k| track.sog_mps(k)).collect();
        let last = track.len() - 1;
        // a line of one point is no line to RFC 7946
        let geometry = if last == 0 {
            json!({ "type": "Point", "coordinates": line[0] })
        } else {
            json!({ "type": "LineString", "coordinates": line })
        };
        features.push(json!({
            "type": "Feature",
            "geometry": geometry,
            "properties": {
                "ship": name,
                "encounter": case.row.id.to_string(),
                "length_m": track.ship.hull.length_m,
                "beam_m": track.ship.hull.beam_m,
                "time_s": times_s,
                "sog_mps": speeds_mps,
                "heading_deg_at_end": to_deg(track.psi_rad[last]).rem_euclid(360.0),
            },
        }));
    }
    json!({
        "type": "FeatureCollection",
        "features": features,
        "seatrial": {
            "encounter": case.row.id.to_string(),
            "outcome": case.row.outcome.name(),
            "digest": case.row.digest.to_string(),
            "origin": format!(
                "the encounter has no place on Earth; its origin is laid at {} N, {} E",
                ORIGIN.0, ORIGIN.1
            ),
        },
    })
}

fn point(track: &ShipTrack, k: usize) -> Value {
    let (latitude_deg, longitude_deg) = place(track.position_m(k));
    json!([longitude_deg, latitude_deg])
}
