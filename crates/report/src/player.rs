//! The data of the replay player: a few encounters, quantised, as JSON inside the page.
//!
//! Positions to 0.1 m, angles to 0.1 degree, speeds to 0.01 m/s, each array as differences from
//! the value before. The player shows these numbers and takes none of its own but the lines it
//! draws; what decides a verdict is in the verdict's sentence, from the full trace.

use crate::ReportError;
use crate::case_marks::marks;
use crate::input::Case;
use geom::units::to_deg;
use record::{Check, DistanceKind, Pair, ShipTrack, Status, Trace};
use serde::Serialize;

/// More encounters than this make the page heavy; the findings link to the replay command.
const CASES_MAX: usize = 20;

/// Stands for a time to CPA that there is not; the player knows it.
const NO_TIME: i64 = -9_999_999;

/// The encounters as JSON that may stand inside a `script` element.
pub(crate) fn data(cases: &[Case]) -> Result<String, ReportError> {
    let shown: Vec<PlayerCase> = cases
        .iter()
        .filter(|case| case.trace.samples() > 1)
        .take(CASES_MAX)
        .map(player_case)
        .collect();
    let json = serde_json::to_string(&shown).map_err(ReportError::Player)?;
    // `</script>` and `<!--` would end the element; in JSON `<` stands only inside strings.
    Ok(json.replace('<', "\\u003c"))
}

#[derive(Serialize)]
struct PlayerCase {
    id: String,
    outcome: &'static str,
    /// Interval of the samples, seconds.
    sample_s: f64,
    end_s: f64,
    safety_m: f64,
    /// `hull` or `centre`: what `safety_m` and `range` mean.
    distance: &'static str,
    /// Own ship first.
    ships: Vec<PlayerShip>,
    pairs: Vec<PlayerPair>,
    route: Vec<[i64; 2]>,
    hazards: Vec<Vec<[i64; 2]>>,
    /// Orders of each beat: course, speed.
    order_course: Vec<i64>,
    order_speed: Vec<i64>,
    marks: Vec<PlayerMark>,
    lanes: Vec<Lane>,
}

#[derive(Serialize)]
struct PlayerShip {
    /// Corners of the hull in the body frame, cm forward and to starboard.
    hull: Vec<[i64; 2]>,
    north: Vec<i64>,
    east: Vec<i64>,
    psi: Vec<i64>,
    cog: Vec<i64>,
    sog: Vec<i64>,
}

#[derive(Serialize)]
struct PlayerPair {
    range: Vec<i64>,
    /// Predicted with both velocities kept, between reference points: time (0.1 s, negative when
    /// past) and distance (0.1 m).
    tcpa: Vec<i64>,
    dcpa: Vec<i64>,
    /// Disc of the velocity obstacle, metres; absent where the planner has none.
    obstacle_m: Option<f64>,
    class: String,
    role: String,
    /// Onset of risk, entries of stages 2 to 4, finally past and clear: seconds.
    risk_s: Option<f64>,
    stages_s: [Option<f64>; 3],
    released_s: Option<f64>,
}

#[derive(Serialize)]
struct PlayerMark {
    t: f64,
    text: String,
    bad: bool,
}

/// A check over time: undecided until its moment.
#[derive(Serialize)]
struct Lane {
    title: &'static str,
    status: &'static str,
    t: Option<f64>,
}

fn player_case(case: &Case) -> PlayerCase {
    let trace = &case.trace;
    let points = |list: &[geom::Vec2]| list.iter().map(|p| [tenths(p.x), tenths(p.y)]).collect();
    let route: Vec<geom::Vec2> = trace.route.iter().map(|w| w.position_m).collect();
    PlayerCase {
        id: case.row.id.to_string(),
        outcome: case.row.outcome.name(),
        sample_s: trace.sample_s,
        end_s: trace.end_s,
        safety_m: trace.safety_radius_m,
        distance: match trace.distance {
            DistanceKind::Hull => "hull",
            DistanceKind::Centre => "centre",
        },
        ships: std::iter::once(&trace.own).chain(&trace.targets).map(ship).collect(),
        pairs: (0..trace.pairs.len().min(trace.targets.len())).map(|i| pair(case, i)).collect(),
        route: points(&route),
        hazards: case.encounter.hazards.iter().map(|hazard| points(hazard)).collect(),
        order_course: differences(trace.orders.iter().map(|o| tenths(to_deg(o.course_rad)))),
        order_speed: differences(trace.orders.iter().map(|o| hundredths(o.speed_mps))),
        marks: marks(trace, &case.judgement)
            .into_iter()
            .map(|mark| PlayerMark { t: mark.time_s, text: mark.text, bad: mark.bad })
            .collect(),
        lanes: lanes(case),
    }
}

fn ship(track: &ShipTrack) -> PlayerShip {
    let all = 0..track.len();
    PlayerShip {
        hull: (track.ship.hull.corners_body_m().iter())
            .map(|c| [hundredths(c.x), hundredths(c.y)])
            .collect(),
        north: differences(track.north_m.iter().map(|&m| tenths(m))),
        east: differences(track.east_m.iter().map(|&m| tenths(m))),
        psi: differences(track.psi_rad.iter().map(|&psi| tenths(to_deg(psi)))),
        cog: differences(all.clone().map(|k| tenths(to_deg(track.cog_rad(k))))),
        sog: differences(all.map(|k| hundredths(track.sog_mps(k)))),
    }
}

fn pair(case: &Case, index: usize) -> PlayerPair {
    let trace = &case.trace;
    let predicted: Vec<geom::Cpa> = predictions(trace, index);
    let facts = case.judgement.pairs.get(index);
    PlayerPair {
        range: differences(ranges(trace, &trace.pairs[index], index).map(tenths)),
        tcpa: differences(predicted.iter().map(|cpa| cpa.tcpa_s.map_or(NO_TIME, tenths))),
        dcpa: differences(predicted.iter().map(|cpa| tenths(cpa.dcpa_m))),
        obstacle_m: case.obstacle_radius_m.as_ref().and_then(|all| all.get(index).copied()),
        class: facts
            .and_then(|facts| facts.class)
            .map_or("no class", |class| class.name())
            .replace('_', " "),
        role: facts.map_or(String::new(), |facts| {
            match facts.role {
                record::Role::GiveWay => "own ship gives way",
                record::Role::StandOn => "own ship stands on",
                record::Role::Both => "both alter",
                record::Role::None => "",
            }
            .to_owned()
        }),
        risk_s: facts.and_then(|facts| facts.risk_s),
        stages_s: facts.map_or([None; 3], |facts| facts.stages_s),
        released_s: facts.and_then(|facts| facts.released_s),
    }
}

fn predictions(trace: &Trace, index: usize) -> Vec<geom::Cpa> {
    let (own, target) = (&trace.own, &trace.targets[index]);
    (0..own.len().min(target.len()))
        .map(|k| {
            geom::cpa(
                target.position_m(k) - own.position_m(k),
                target.velocity_mps(k) - own.velocity_mps(k),
            )
        })
        .collect()
}

fn ranges<'a>(
    trace: &'a Trace,
    pair: &'a Pair,
    index: usize,
) -> Box<dyn Iterator<Item = f64> + 'a> {
    match trace.distance {
        DistanceKind::Hull => Box::new(pair.hull_m.iter().copied()),
        DistanceKind::Centre => {
            let target = &trace.targets[index];
            let samples = trace.own.len().min(target.len());
            let apart = |k| (target.position_m(k) - trace.own.position_m(k)).norm();
            Box::new((0..samples).map(apart))
        }
    }
}

/// The checks that applied, with the moment that decided each.
fn lanes(case: &Case) -> Vec<Lane> {
    let silent = |status| matches!(status, Status::NotApplicable | Status::NotEvaluated);
    Check::ALL
        .into_iter()
        .filter_map(|check| case.judgement.worst(check))
        .filter(|verdict| !silent(verdict.status))
        .map(|verdict| Lane {
            title: verdict.check.title(),
            status: verdict.status.name(),
            t: verdict.t_s.filter(|t| t.is_finite()),
        })
        .collect()
}

fn tenths(value: f64) -> i64 {
    (value * 10.0).round() as i64
}

fn hundredths(value: f64) -> i64 {
    (value * 100.0).round() as i64
}

fn differences(values: impl Iterator<Item = i64>) -> Vec<i64> {
    values
        .scan(0, |before, value| {
            let difference = value - *before;
            *before = value;
            Some(difference)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_add_up_again() {
        let values = [5, 7, -3, -3, 1000];
        let mut sum = 0;
        let again: Vec<i64> = differences(values.into_iter())
            .into_iter()
            .map(|difference| {
                sum += difference;
                sum
            })
            .collect();
        assert_eq!(again, values);
    }
}
