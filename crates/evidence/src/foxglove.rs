//! One encounter as an MCAP recording for the viewers that robotics teams use: ships, route and
//! hazards in 3-D, fixes on a map, numbers to plot, and what the judge says at its moment.
//!
//! Frames: `world` has x to the east, y to the north, z up; a ship's frame has x ahead, y to port,
//! z up. Times count from the start of the encounter. Positions to 1 mm, on the map to 1 cm.

use crate::dnv::{ORIGIN, place};
use crate::foxglove_schema as schema;
use crate::mcap::{ChannelId, Recording};
use geom::units::to_deg;
use geom::{Vec2, cpa};
use record::{DistanceKind, PairFacts, ShipTrack, Trace};
use report::Case;
use serde_json::{Value, json};

const LIBRARY: &str = "seatrial";
/// What a fix has whose accuracy is not said.
const UNKNOWN_COVARIANCE: [f64; 9] = [0.0; 9];
const WORLD: &str = "world";

/// The recording of an encounter as the bytes of an `.mcap` file.
pub(crate) fn recording(case: &Case, campaign: &str, planner: &str) -> std::io::Result<Vec<u8>> {
    let mut recording = Recording::default();
    let row = &case.row;
    for (key, value) in [
        ("encounter", row.id.to_string()),
        ("campaign", campaign.to_owned()),
        ("planner", planner.to_owned()),
        ("outcome", row.outcome.name().to_owned()),
        ("digest", row.digest.to_string()),
        ("time", "counts from the start of the encounter".to_owned()),
        ("place", format!("the origin is laid at {} N, {} E", ORIGIN.0, ORIGIN.1)),
    ] {
        recording.metadata(key, value);
    }
    scene(&mut recording, case);
    transforms(&mut recording, &case.trace);
    ships(&mut recording, &case.trace);
    pairs(&mut recording, case);
    verdicts(&mut recording, case);
    recording.finish(LIBRARY)
}

/// Own ship first, each with its frame and its colour.
fn all_ships(trace: &Trace) -> impl Iterator<Item = (String, &ShipTrack, Value)> {
    let own = (frame(None), &trace.own, colour(OWN, 1.0));
    let target = |(i, track)| (frame(Some(i)), track, colour(TARGET, 1.0));
    std::iter::once(own).chain(trace.targets.iter().enumerate().map(target))
}

fn frame(target: Option<usize>) -> String {
    target.map_or_else(|| "own_ship".to_owned(), |i| format!("target_{}", i + 1))
}

/// Shapes that never change in their own frame, once at the start: hulls and the border that own
/// ship has to keep are locked to the ships, route, hazards and tracks to the world.
fn scene(recording: &mut Recording, case: &Case) {
    let trace = &case.trace;
    let mut entities = Vec::new();
    for (frame, track, colour_of_ship) in all_ships(trace) {
        let corners: Vec<Value> =
            track.ship.hull.corners_body_m().iter().map(|corner| body_point(*corner)).collect();
        // the hull is convex: a fan of triangles fills it
        let fan = (1..corners.len() - 1)
            .flat_map(|i| [0, i, i + 1].map(|corner| corners[corner].clone()));
        let label = json!({
            "pose": pose(0.0, 0.0), "billboard": true, "font_size": 14.0,
            "scale_invariant": true, "color": colour_of_ship, "text": frame,
        });
        let hull = triangles(&fan.collect::<Vec<_>>(), &colour_of_ship);
        entities.push(entity(&frame, "hull", &[], &[hull], &[label]));
    }
    let own = &trace.own.ship.hull;
    let border = line(LOOP, &border(trace, own), &colour(OWN, 0.6));
    entities.push(entity(&frame(None), "border", &[border], &[], &[]));
    let route: Vec<Value> = std::iter::once(trace.own.position_m(0))
        .chain(trace.route.iter().map(|waypoint| waypoint.position_m))
        .map(world_point)
        .collect();
    entities.push(entity(WORLD, "route", &[line(STRIP, &route, &colour(GREY, 0.8))], &[], &[]));
    for (i, hazard) in case.encounter.hazards.iter().enumerate() {
        let corners: Vec<Value> = hazard.iter().copied().map(world_point).collect();
        let outline = line(LOOP, &corners, &colour(GREY, 1.0));
        entities.push(entity(WORLD, &format!("hazard {}", i + 1), &[outline], &[], &[]));
    }
    for (frame, track, colour_of_ship) in all_ships(trace) {
        let points: Vec<Value> =
            (0..track.len()).map(|k| world_point(track.position_m(k))).collect();
        let way = line(STRIP, &points, &colour_of_ship);
        entities.push(entity(WORLD, &format!("track of {frame}"), &[way], &[], &[]));
    }
    let schema = recording.schema("foxglove.SceneUpdate", &schema::scene_update());
    let channel = recording.channel("/scene", schema);
    recording.message(channel, 0, &json!({ "deletions": [], "entities": entities }));
}

/// The border that no hull, or no reference point, may cross, in own ship's frame.
fn border(trace: &Trace, hull: &geom::HullOutline) -> Vec<Value> {
    const STEPS: usize = 72;
    let corners = match trace.distance {
        DistanceKind::Hull => hull.corners_body_m().to_vec(),
        DistanceKind::Centre => vec![Vec2::zeros()],
    };
    (0..STEPS)
        .filter_map(|i| {
            let direction = geom::angle::unit(i as f64 * std::f64::consts::TAU / STEPS as f64);
            let farthest =
                corners.iter().max_by(|a, b| direction.dot(a).total_cmp(&direction.dot(b)))?;
            Some(body_point(farthest + direction * trace.safety_radius_m))
        })
        .collect()
}

fn transforms(recording: &mut Recording, trace: &Trace) {
    let schema = recording.schema("foxglove.FrameTransforms", &schema::frame_transforms());
    let channel = recording.channel("/tf", schema);
    for k in 0..trace.samples() {
        let transforms: Vec<Value> = all_ships(trace)
            .filter(|(_, track, _)| k < track.len())
            .map(|(frame, track, _)| {
                json!({
                    "timestamp": timestamp(time_ns(trace, k)),
                    "parent_frame_id": WORLD,
                    "child_frame_id": frame,
                    "translation": world_point(track.position_m(k)),
                    "rotation": rotation(track.psi_rad[k]),
                })
            })
            .collect();
        recording.message(channel, time_ns(trace, k), &json!({ "transforms": transforms }));
    }
}

/// A fix for the map and numbers for plots, for each ship.
fn ships(recording: &mut Recording, trace: &Trace) {
    let fix_schema = recording.schema("foxglove.LocationFix", &schema::location_fix());
    let ship_schema = recording.schema("seatrial.Ship", &schema::ship());
    for (i, (frame, track, colour_of_ship)) in all_ships(trace).enumerate() {
        let fixes = recording.channel(&format!("/{frame}/fix"), fix_schema);
        let states = recording.channel(&format!("/{frame}/state"), ship_schema);
        for k in 0..track.len() {
            let (latitude_deg, longitude_deg) = place(track.position_m(k));
            let fix = json!({
                "timestamp": timestamp(time_ns(trace, k)),
                "frame_id": frame,
                "latitude": fine(latitude_deg),
                "longitude": fine(longitude_deg),
                "altitude": 0.0,
                "position_covariance": UNKNOWN_COVARIANCE,
                "position_covariance_type": 0,
                "heading": fine(track.psi_rad[k]),
                "color": colour_of_ship,
            });
            recording.message(fixes, time_ns(trace, k), &fix);
            let order = trace.orders.get(k).filter(|_| i == 0);
            let state = json!({
                "north_m": milli(track.north_m[k]),
                "east_m": milli(track.east_m[k]),
                "heading_deg": course_deg(track.psi_rad[k]),
                "course_deg": course_deg(track.cog_rad(k)),
                "speed_mps": milli(track.sog_mps(k)),
                "ordered_course_deg": order.map(|order| course_deg(order.course_rad)),
                "ordered_speed_mps": order.map(|order| milli(order.speed_mps)),
            });
            recording.message(states, time_ns(trace, k), &state);
        }
    }
}

fn pairs(recording: &mut Recording, case: &Case) {
    let trace = &case.trace;
    let schema = recording.schema("seatrial.Pair", &schema::pair());
    for (i, (pair, target)) in trace.pairs.iter().zip(&trace.targets).enumerate() {
        let channel = recording.channel(&format!("/{}/pair", frame(Some(i))), schema);
        let facts = case.judgement.pairs.get(i);
        for k in 0..trace.samples().min(target.len()).min(pair.hull_m.len()) {
            let apart_m = target.position_m(k) - trace.own.position_m(k);
            let predicted = cpa(apart_m, target.velocity_mps(k) - trace.own.velocity_mps(k));
            let (risk_stage, state) = stage_and_state(facts, k as f64 * trace.sample_s);
            let message = json!({
                "hull_distance_m": milli(pair.hull_m[k]),
                "centre_distance_m": milli(apart_m.norm()),
                "predicted_cpa_m": milli(predicted.dcpa_m),
                "time_to_cpa_s": predicted.tcpa_s.map(milli),
                "risk_stage": risk_stage,
                "state": state,
            });
            recording.message(channel, time_ns(trace, k), &message);
        }
    }
}

/// The stage of risk as a number to plot (0 none, 1 to 4, 5 past and clear) and in words.
pub(crate) fn stage_and_state(facts: Option<&PairFacts>, time_s: f64) -> (u8, String) {
    let come = |moment_s: Option<f64>| moment_s.is_some_and(|moment_s| time_s >= moment_s);
    let Some(facts) = facts.filter(|facts| come(facts.risk_s)) else {
        return (0, "no risk".to_owned());
    };
    if come(facts.released_s) {
        return (5, "past and clear".to_owned());
    }
    let later = facts.stages_s.iter().rposition(|&entry_s| come(entry_s));
    let stage = later.map_or(1, |i| i as u8 + 2);
    let class = facts.class.map_or("no class", |class| class.name()).replace('_', " ");
    (stage, format!("{class}, stage {stage}"))
}

/// Failures and warnings at the moment that decided them; those without one at the end.
fn verdicts(recording: &mut Recording, case: &Case) {
    const WARNING: u8 = 3;
    const ERROR: u8 = 4;
    let schema = recording.schema("foxglove.Log", &schema::log());
    let channel: ChannelId = recording.channel("/verdicts", schema);
    for verdict in &case.judgement.verdicts {
        let level = match verdict.status {
            record::Status::Fail => ERROR,
            record::Status::Warn => WARNING,
            _ => continue,
        };
        let at_s = verdict.t_s.filter(|t_s| t_s.is_finite()).unwrap_or(case.trace.end_s);
        let time_ns = nanoseconds(at_s);
        let message = verdict.sentence.clone().unwrap_or_else(|| verdict.detail.to_string());
        let log = json!({
            "timestamp": timestamp(time_ns),
            "level": level,
            "message": message,
            "name": verdict.check.title(),
            "file": "",
            "line": 0,
        });
        recording.message(channel, time_ns, &log);
    }
}

fn nanoseconds(time_s: f64) -> u64 {
    (time_s.max(0.0) * 1e9).round() as u64
}

fn time_ns(trace: &Trace, k: usize) -> u64 {
    nanoseconds(k as f64 * trace.sample_s)
}

fn timestamp(time_ns: u64) -> Value {
    json!({ "sec": time_ns / 1_000_000_000, "nsec": time_ns % 1_000_000_000 })
}

fn milli(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

/// For degrees of latitude and radians: to 1e-7, a centimetre on the Earth.
fn fine(value: f64) -> f64 {
    (value * 1e7).round() / 1e7
}

fn course_deg(angle_rad: f64) -> f64 {
    milli(to_deg(angle_rad).rem_euclid(360.0))
}

/// North and east to the axes of `world`.
fn world_point(north_east_m: Vec2) -> Value {
    point(north_east_m.y, north_east_m.x)
}

/// Ahead and to starboard to the axes of a ship's frame.
fn body_point(ahead_starboard_m: Vec2) -> Value {
    point(ahead_starboard_m.x, -ahead_starboard_m.y)
}

fn point(x: f64, y: f64) -> Value {
    // no negative zero: it would be another text for the same number
    json!({ "x": milli(x) + 0.0, "y": milli(y) + 0.0, "z": 0.0 })
}

/// The rotation about z that turns x, ahead, to a heading clockwise from north.
fn rotation(psi_rad: f64) -> Value {
    let half_rad = (std::f64::consts::FRAC_PI_2 - psi_rad) / 2.0;
    let (sin, cos) = geom::math::sin_cos(half_rad);
    json!({ "x": 0.0, "y": 0.0, "z": fine(sin), "w": fine(cos) })
}

fn pose(x: f64, y: f64) -> Value {
    json!({
        "position": point(x, y),
        "orientation": { "x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0 },
    })
}

/// Colours of the report.
const OWN: [u8; 3] = [0x1f, 0x5f, 0xbf];
const TARGET: [u8; 3] = [0xd6, 0x33, 0x84];
const GREY: [u8; 3] = [0x8b, 0x95, 0xa1];

fn colour([r, g, b]: [u8; 3], opacity: f64) -> Value {
    let [r, g, b] = [r, g, b].map(|part| milli(f64::from(part) / 255.0));
    json!({ "r": r, "g": g, "b": b, "a": opacity })
}

const STRIP: u8 = 0;
const LOOP: u8 = 1;

fn line(kind: u8, points: &[Value], colour: &Value) -> Value {
    json!({
        "type": kind, "pose": pose(0.0, 0.0), "thickness": 2.0, "scale_invariant": true,
        "points": points, "color": colour, "colors": [], "indices": [],
    })
}

fn triangles(points: &[Value], colour: &Value) -> Value {
    json!({
        "pose": pose(0.0, 0.0), "points": points, "color": colour, "colors": [], "indices": [],
    })
}

fn entity(frame: &str, id: &str, lines: &[Value], triangles: &[Value], texts: &[Value]) -> Value {
    json!({
        "timestamp": timestamp(0),
        "frame_id": frame,
        "id": if frame == WORLD { id.to_owned() } else { format!("{id} of {frame}") },
        "lifetime": timestamp(0),
        "frame_locked": true,
        "metadata": [],
        "arrows": [], "cubes": [], "spheres": [], "cylinders": [],
        "lines": lines,
        "triangles": triangles,
        "texts": texts,
        "models": [],
    })
}
