//! What happened in an encounter as a DNV situation output, schema 0.2.0 (`maritime-schema`):
//! the planner's orders and the targets at those moments, the bench's events and verdicts.
//!
//! The schema wants a route of the system under test; a planner of this bench orders a course and
//! a speed. Each order becomes a leg of [`AHEAD_S`] from where own ship is. It wants what the
//! system had detected; a trace has what was true. Both are said in the file.

use crate::dnv::position;
use crate::foxglove::stage_and_state;
use geom::units::{NAUTICAL_MILE_M, to_deg, to_knots};
use geom::{EncounterClass, cpa};
use record::{ContactWith, Order, ShipTrack, Status, Trace};
use report::Case;
use serde_json::{Map, Value, json};

/// An order that differs by less is the same manoeuvre: radians, m/s.
const SAME_ORDER: (f64, f64) = (geom::units::deg(1.0), 0.1);
/// Length of the leg that an order is shown as, seconds.
const AHEAD_S: f64 = 60.0;

/// What a situation output says of the two systems beside the encounter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Systems<'a> {
    pub(crate) planner: &'a str,
    pub(crate) options: &'a toml::Table,
    pub(crate) planners_hash: &'a str,
    pub(crate) tool_version: &'a str,
    pub(crate) engine_hash: &'a str,
}

/// The situation output of an encounter that was run.
pub(crate) fn situation_output(case: &Case, systems: &Systems<'_>) -> Value {
    let trace = &case.trace;
    let mut planner = Map::new();
    planner.insert("name".to_owned(), json!(systems.planner));
    planner.insert("vendor".to_owned(), json!("see the name"));
    planner.insert("version".to_owned(), json!(systems.planners_hash));
    for (key, value) in systems.options {
        planner.insert(format!("vendor_{key}"), json!(value));
    }
    let orders: Vec<Value> =
        manoeuvres(trace).into_iter().map(|k| order_event(case, k, &trace.orders[k])).collect();
    json!({
        "version": "0.2.0",
        "title": case.row.id.to_string(),
        "description":
            "Clock: seconds since the start of the encounter, laid at 2000-01-01T00:00:00Z. \
             waypoints: where the ordered course and speed lead in 60 s; the planner orders no \
             route. targetShips: true states, not tracks.",
        "systemUnderTest": { "configuration": planner, "eventData": orders },
        "simulator": {
            "configuration": {
                "name": "seatrial",
                "vendor": "seatrial",
                "version": systems.tool_version,
                "vendor_engine": systems.engine_hash,
                "vendor_encounter": case.row.id.to_string(),
                "vendor_seed": case.encounter.seed.to_string(),
                "vendor_outcome": case.row.outcome.name(),
                "vendor_digest": case.row.digest.to_string(),
            },
            "eventData": simulator_events(case),
        },
    })
}

/// The samples at which the order became another one; the first is always among them.
fn manoeuvres(trace: &Trace) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    for (k, order) in trace.orders.iter().enumerate().take(trace.samples()) {
        let same = found.last().is_some_and(|&last| {
            let before = &trace.orders[last];
            geom::wrap(order.course_rad - before.course_rad).abs() < SAME_ORDER.0
                && (order.speed_mps - before.speed_mps).abs() < SAME_ORDER.1
        });
        if !same {
            found.push(k);
        }
    }
    found
}

fn order_event(case: &Case, k: usize, order: &Order) -> Value {
    let trace = &case.trace;
    let from_m = trace.own.position_m(k);
    let to_m = from_m + geom::unit(order.course_rad) * (order.speed_mps * AHEAD_S);
    let targets: Vec<Value> = (0..trace.targets.len())
        .filter(|&i| k < trace.targets[i].len())
        .map(|i| target_ship(case, i, k))
        .collect();
    json!({
        "time": clock(k as f64 * trace.sample_s),
        "ownShip": state(&trace.own, k),
        "targetShips": targets,
        "waypoints": [
            { "position": position(from_m) },
            { "position": position(to_m), "leg": { "sog": to_knots(order.speed_mps) } },
        ],
        "orderedCourse": degrees(order.course_rad),
        "orderedSpeed": to_knots(order.speed_mps),
    })
}

fn target_ship(case: &Case, i: usize, k: usize) -> Value {
    let (own, target) = (&case.trace.own, &case.trace.targets[i]);
    let apart_m = target.position_m(k) - own.position_m(k);
    let predicted = cpa(apart_m, target.velocity_mps(k) - own.velocity_mps(k));
    let mut ship = state(target, k);
    ship["id"] = json!(i + 2);
    ship["range"] = json!(apart_m.norm() / NAUTICAL_MILE_M);
    ship["cpa"] = json!(predicted.dcpa_m / NAUTICAL_MILE_M);
    if let Some(tcpa_s) = predicted.tcpa_s {
        ship["tcpa"] = json!(tcpa_s);
    }
    let facts = case.judgement.pairs.get(i);
    let (stage, _) = stage_and_state(facts, k as f64 * case.trace.sample_s);
    let open = (1..=4).contains(&stage);
    if let Some(name) = encounter_type(facts.and_then(|f| f.class).filter(|_| open)) {
        ship["encounterType"] = json!(name);
    }
    ship
}

/// The schema's name of a class; it has none for a target that does not move.
const fn encounter_type(class: Option<EncounterClass>) -> Option<&'static str> {
    Some(match class {
        None => "No Risk",
        Some(EncounterClass::HeadOn) => "Head-on",
        Some(EncounterClass::CrossingStbd) => "Crossing give-way",
        Some(EncounterClass::CrossingPort) => "Crossing stand-on",
        Some(EncounterClass::Overtaking) => "Overtaking give-way",
        Some(EncounterClass::Overtaken) => "Overtaking stand-on",
        Some(EncounterClass::Static) => return None,
    })
}

fn state(track: &ShipTrack, k: usize) -> Value {
    json!({
        "position": position(track.position_m(k)),
        "sog": to_knots(track.sog_mps(k)),
        "cog": degrees(track.cog_rad(k)),
        "heading": degrees(track.psi_rad[k]),
    })
}

/// Closest points, contact, verdicts and the end, in order of time.
fn simulator_events(case: &Case) -> Vec<Value> {
    let trace = &case.trace;
    let mut events: Vec<(f64, Value)> = Vec::new();
    for (i, pair) in trace.pairs.iter().enumerate() {
        let (distance_m, time_s) = pair.minimum.of(trace.distance);
        let event = json!({ "event": "closest point", "target": i + 2, "distance_m": distance_m });
        events.push((time_s, event));
    }
    if let Some(contact) = &trace.contact {
        let with = match contact.with {
            ContactWith::Target(i) => json!({ "target": u64::from(i) + 2 }),
            ContactWith::Hazard(i) => json!({ "hazard": u64::from(i) + 1 }),
        };
        let event = json!({ "event": "contact", "with": with, "impact_mps": contact.impact_mps });
        events.push((contact.t_s, event));
    }
    for verdict in &case.judgement.verdicts {
        if !matches!(verdict.status, Status::Fail | Status::Warn) {
            continue;
        }
        let mut event = json!({
            "event": "verdict",
            "check": verdict.check.name(),
            "status": verdict.status.name(),
            "sentence": verdict.sentence.as_deref().unwrap_or(&verdict.detail),
        });
        if let Some(target) = verdict.target {
            event["target"] = json!(u64::from(target) + 2);
        }
        let time_s = verdict.t_s.filter(|t_s| t_s.is_finite()).unwrap_or(trace.end_s);
        events.push((time_s, event));
    }
    events.push((trace.end_s, json!({ "event": "end", "outcome": case.row.outcome.name() })));
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let timed = |(time_s, mut event): (f64, Value)| {
        event["time"] = json!(clock(time_s));
        event
    };
    events.into_iter().map(timed).collect()
}

/// In [0, 360).
fn degrees(angle_rad: f64) -> f64 {
    to_deg(angle_rad).rem_euclid(360.0)
}

/// A time of the encounter in the schema's form, to a millisecond; runs end within hours.
fn clock(time_s: f64) -> String {
    let milliseconds = (time_s.max(0.0) * 1000.0).round() as u64;
    let (seconds, rest) = (milliseconds / 1000, milliseconds % 1000);
    let fraction = if rest == 0 { String::new() } else { format!(".{rest:03}") };
    let (day, hour) = (1 + seconds / 86_400, seconds / 3600 % 24);
    format!("2000-01-{day:02}T{hour:02}:{:02}:{:02}{fraction}Z", seconds / 60 % 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_of_the_form_that_the_schema_asks_for() {
        assert_eq!(clock(0.0), "2000-01-01T00:00:00Z");
        assert_eq!(clock(3_723.25), "2000-01-01T01:02:03.250Z");
        assert_eq!(clock(90_061.0), "2000-01-02T01:01:01Z");
    }
}
