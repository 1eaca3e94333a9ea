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
    let shown: Vec<String> = cases
        .iter()
        .filter(|case| case.trace.samples() > 1)
        .take(CASES_MAX)
        .map(case_json)
        .collect::<Result<_, _>>()?;
    // `</script>` and `<!--` would end the element; in JSON `<` stands only inside strings.
    Ok(format!("[{}]", shown.join(",")).replace('<', "\\u003c"))
}

/// One encounter may take so many bytes, that all of them stay below 2 MB.
const CASE_BYTES_MAX: usize = 95_000;

/// The encounter with every sample, or with every so many samples that it is small enough.
fn case_json(case: &Case) -> Result<String, ReportError> {
    let mut every = 1;
    loop {
        let json = serde_json::to_string(&player_case(case, every)).map_err(ReportError::Player)?;
        if json.len() <= CASE_BYTES_MAX || every >= case.trace.samples() {
            return Ok(json);
        }
        every = (every + 1).max(every * json.len() / CASE_BYTES_MAX);
    }
}

/// Values of every so many samples, and of the last one.
fn thinned<T: Copy>(
    values: impl ExactSizeIterator<Item = T>,
    every: usize,
) -> impl Iterator<Item = T> {
    let last = values.len().saturating_sub(1);
    values
        .enumerate()
        .filter(move |(k, _)| k.is_multiple_of(every) || *k == last)
        .map(|(_, value)| value)
}

#[derive(Serialize)]
struct PlayerCase {
    id: String,
    outcome: &'static str,
    /// Interval of the samples, seconds; the last one may be shorter.
    sample_s: f64,
    /// When the last sample was taken, and the end of the run.
    last_s: f64,
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

fn player_case(case: &Case, every: usize) -> PlayerCase {
    let trace = &case.trace;
    let points = |list: &[geom::Vec2]| list.iter().map(|p| [tenths(p.x), tenths(p.y)]).collect();
    let route: Vec<geom::Vec2> = trace.route.iter().map(|w| w.position_m).collect();
    PlayerCase {
        id: case.row.id.to_string(),
        outcome: case.row.outcome.name(),
        sample_s: every as f64 * trace.sample_s,
        last_s: trace.samples().saturating_sub(1) as f64 * trace.sample_s,
        end_s: trace.end_s,
        safety_m: trace.safety_radius_m,
        distance: match trace.distance {
            DistanceKind::Hull => "hull",
            DistanceKind::Centre => "centre",
        },
        ships: std::iter::once(&trace.own)
            .chain(&trace.targets)
            .map(|track| ship(track, every))
            .collect(),
        pairs: (0..trace.pairs.len().min(trace.targets.len()))
            .map(|i| pair(case, i, every))
            .collect(),
        route: points(&route),
        hazards: case.encounter.hazards.iter().map(|hazard| points(hazard)).collect(),
        order_course: series(trace.orders.iter().map(|o| tenths(to_deg(o.course_rad))), every),
        order_speed: series(trace.orders.iter().map(|o| hundredths(o.speed_mps)), every),
        marks: marks(trace, &case.judgement)
            .into_iter()
            .map(|mark| PlayerMark { t: mark.time_s, text: mark.text, bad: mark.bad })
            .collect(),
        lanes: lanes(case),
    }
}

fn ship(track: &ShipTrack, every: usize) -> PlayerShip {
    let all = 0..track.len();
    PlayerShip {
        hull: (track.ship.hull.corners_body_m().iter())
            .map(|c| [hundredths(c.x), hundredths(c.y)])
            .collect(),
        north: series(track.north_m.iter().map(|&m| tenths(m)), every),
        east: series(track.east_m.iter().map(|&m| tenths(m)), every),
        psi: series(track.psi_rad.iter().map(|&psi| tenths(to_deg(psi))), every),
        cog: series(all.clone().map(|k| tenths(to_deg(track.cog_rad(k)))), every),
        sog: series(all.map(|k| hundredths(track.sog_mps(k))), every),
    }
}

fn pair(case: &Case, index: usize, every: usize) -> PlayerPair {
    let trace = &case.trace;
    let predicted: Vec<geom::Cpa> = predictions(trace, index);
    let facts = case.judgement.pairs.get(index);
    PlayerPair {
        range: series(ranges(trace, &trace.pairs[index], index).into_iter().map(tenths), every),
        tcpa: series(predicted.iter().map(|cpa| cpa.tcpa_s.map_or(NO_TIME, tenths)), every),
        dcpa: series(predicted.iter().map(|cpa| tenths(cpa.dcpa_m)), every),
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

fn ranges(trace: &Trace, pair: &Pair, index: usize) -> Vec<f64> {
    match trace.distance {
        DistanceKind::Hull => pair.hull_m.clone(),
        DistanceKind::Centre => {
            let target = &trace.targets[index];
            let samples = trace.own.len().min(target.len());
            let apart = |k| (target.position_m(k) - trace.own.position_m(k)).norm();
            (0..samples).map(apart).collect()
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

/// Every so many values, as differences from the one before.
fn series(values: impl ExactSizeIterator<Item = i64>, every: usize) -> Vec<i64> {
    thinned(values, every)
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

    fn added_up(series: Vec<i64>) -> Vec<i64> {
        let mut sum = 0;
        let add = |difference| {
            sum += difference;
            sum
        };
        series.into_iter().map(add).collect()
    }

    #[test]
    fn differences_add_up_again() {
        let values = [5, 7, -3, -3, 1000];
        assert_eq!(added_up(series(values.into_iter(), 1)), values);
    }

    /// A collision is at the very end.
    #[test]
    fn the_last_value_stays_when_values_are_left_out() {
        let values = [5, 7, -3, -3, 1000];
        assert_eq!(added_up(series(values.into_iter(), 3)), [5, -3, 1000]);
        assert_eq!(added_up(series(values.into_iter(), 4)), [5, 1000]);
        assert_eq!(added_up(series(values.into_iter(), 9)), [5, 1000]);
        assert_eq!(added_up(series(std::iter::empty(), 2)), [] as [i64; 0]);
    }
}
