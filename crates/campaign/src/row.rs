//! From encounter, trace and judgement to one flat row.

use geom::{Relative, Vec2};
use record::{
    Check, CheckCell, Digest, Encounter, Outcome, PlannerEvents, Reaction, RunRow, ShipTrack,
    Status, Trace,
    verdict::{Judgement, PairFacts},
};

/// The row of a run that left a trace.
pub fn of_run(encounter: &Encounter, trace: &Trace, digest: Digest, judged: &Judgement) -> RunRow {
    let mut row = start(encounter, trace.outcome, digest);
    let closest = trace
        .pairs
        .iter()
        .enumerate()
        .min_by(|(_, a), (_, b)| {
            a.minimum.of(trace.distance).0.total_cmp(&b.minimum.of(trace.distance).0)
        })
        .map(|(index, pair)| (index, pair.minimum));
    let least = |of: fn(&record::PairMinimum) -> f64| {
        trace.pairs.iter().map(|pair| of(&pair.minimum)).min_by(f64::total_cmp)
    };
    row.end_s = trace.end_s;
    row.cpa_hull_m = least(|m| m.hull_m);
    row.cpa_centre_m = least(|m| m.centre_m);
    if let Some((index, minimum)) = closest {
        let (distance_m, at_s) = minimum.of(trace.distance);
        row.cpa_s = Some(at_s);
        row.safety_radius_broken = distance_m < trace.safety_radius_m;
        row.class = judged.pairs.get(index).and_then(|pair| pair.class);
        row.class_by_planner = judged.pairs.get(index).and_then(|pair| pair.class_by_planner);
        row.ambiguous = judged.pairs.get(index).is_some_and(|pair| pair.ambiguous);
    }
    // a run that was cut may have come closer later: its distance so far proves only a breach
    row.unknown = trace.outcome.is_planner_failure()
        || trace.outcome == Outcome::Invalid
        || (trace.outcome == Outcome::Truncated
            && judged.pairs.iter().any(|pair| pair.cpa_s.is_none() && pair.risk_s.is_some()));
    if let Some(nominal) = &trace.nominal {
        let hull = nominal.minima.iter().map(|m| m.hull_m).min_by(f64::total_cmp);
        let kind = nominal.minima.iter().map(|m| m.of(trace.distance).0).min_by(f64::total_cmp);
        row.nominal_cpa_hull_m = hull;
        row.nominal_safety_radius_broken = kind.map(|m| m < trace.safety_radius_m);
    }
    row.unavoidable = trace.unavoidable;
    reactions(&mut row, judged);
    route(&mut row, encounter, trace);
    if let Some(contact) = trace.contact {
        row.impact_mps = Some(contact.impact_mps);
        row.impulse_ns = Some(contact.impulse_ns);
        row.energy_lost_j = Some(contact.energy_lost_j);
    }
    row.fails_by_planner_class = judged.fails_by_planner_class().map(|checks| {
        let names: Vec<&str> = checks.into_iter().map(Check::name).collect();
        if names.is_empty() { "none".to_owned() } else { names.join("+") }
    });
    row.events = trace.events;
    row.planner_detail = trace.planner_detail.clone();
    row.checks = Check::ALL
        .into_iter()
        .map(|check| match judged.worst(check) {
            Some(verdict) => CheckCell { status: verdict.status, margin: verdict.margin },
            None => CheckCell { status: Status::NotEvaluated, margin: None },
        })
        .collect();
    row
}

/// The row of a run that took its process with it, or could not be run; `detail` says how.
pub fn of_lost_run(encounter: &Encounter, outcome: Outcome, detail: Option<String>) -> RunRow {
    let mut row = start(encounter, outcome, Digest::of_lost_run(&encounter.id, outcome));
    row.unknown = true;
    row.planner_detail = detail;
    row
}

fn start(encounter: &Encounter, outcome: Outcome, digest: Digest) -> RunRow {
    let own = &encounter.own.start;
    let first = encounter.targets.first();
    let lie = first.map(|target| {
        let start = &target.start;
        Relative::new(own.position_m, own.psi_rad, start.position_m, start.psi_rad)
    });
    let intents: Vec<&str> = encounter.targets.iter().map(|t| t.intent.name()).collect();
    RunRow {
        id: encounter.id.clone(),
        outcome,
        digest,
        weight: encounter.weight,
        targets: encounter.targets.len() as u8,
        class: None,
        class_by_planner: None,
        fails_by_planner_class: None,
        ambiguous: false,
        intents: intents.join("+"),
        sensing: encounter.sensing.name().to_owned(),
        own_speed_mps: own.speed_mps,
        target_speed_mps: first.map(|t| t.start.speed_mps),
        target_length_m: first.map(|t| t.hull.length_m),
        beta_rad: lie.map(|lie| lie.beta_rad),
        alpha_rad: lie.map(|lie| lie.alpha_rad),
        range_m: lie.map(|lie| lie.range_m),
        miss_m: encounter.asked.map(|asked| asked.miss_m),
        tcpa_s: encounter.asked.map(|asked| asked.tcpa_s),
        end_s: 0.0,
        cpa_hull_m: None,
        cpa_centre_m: None,
        cpa_s: None,
        unknown: false,
        safety_radius_broken: false,
        nominal_cpa_hull_m: None,
        nominal_safety_radius_broken: None,
        unavoidable: None,
        risk_s: None,
        reaction: Reaction::Unknown,
        apparent: Reaction::Unknown,
        first_turn_rad: None,
        extra_distance_m: None,
        goal_reached: false,
        impact_mps: None,
        impulse_ns: None,
        energy_lost_j: None,
        events: PlannerEvents::default(),
        planner_detail: None,
        checks: Vec::new(),
        judges_disagree: None,
    }
}

/// The reaction to the first target at risk; `NoRisk` only where no pair ever was.
fn reactions(row: &mut RunRow, judged: &Judgement) {
    let first = judged
        .pairs
        .iter()
        .filter(|pair| pair.risk_s.is_some())
        .min_by(|a, b| a.risk_s.unwrap_or(f64::MAX).total_cmp(&b.risk_s.unwrap_or(f64::MAX)));
    let shown: Option<&PairFacts> = first.or(judged.pairs.first());
    if let Some(pair) = shown {
        row.risk_s = pair.risk_s;
        row.reaction = pair.reaction;
        row.apparent = pair.apparent;
        row.first_turn_rad = pair.first_turn_rad;
    }
}

/// Whether the goal was reached, and the distance beyond the planned one.
fn route(row: &mut RunRow, encounter: &Encounter, trace: &Trace) {
    row.goal_reached = trace.goal_reached;
    if trace.own.is_empty() || encounter.own.route.is_empty() {
        return;
    }
    let mut places: Vec<Vec2> = vec![encounter.own.start.position_m];
    places.extend(encounter.own.route.iter().map(|waypoint| waypoint.position_m));
    let planned_m: f64 = places.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
    row.extra_distance_m = Some(way_m(&trace.own, &places[1..]) - planned_m);
}

/// Distance sailed up to the passage of the last place, and from there to it, metres. A place is
/// passed where the ship comes nearest to it after the passage of the one before; one to which she
/// is nearest at the end of her track is still ahead, and the rest of the way counts as straight.
/// What she sails beyond the last place is no part of it.
fn way_m(own: &ShipTrack, places: &[Vec2]) -> f64 {
    let last = own.len() - 1;
    let mut at = Passage { k: 0, position_m: own.position_m(0), sailed_m: 0.0 };
    for (number, place) in places.iter().enumerate() {
        let nearest = nearest_passage(own, &at, *place);
        at = nearest;
        if at.k == last {
            let ahead = std::iter::once(&at.position_m).chain(&places[number..]);
            let ahead: Vec<Vec2> = ahead.copied().collect();
            let to_go_m: f64 = ahead.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
            return at.sailed_m + to_go_m;
        }
    }
    places.last().map_or(at.sailed_m, |goal| at.sailed_m + (goal - at.position_m).norm())
}

/// A point of a track: at sample `k`, or between it and the next.
#[derive(Clone, Copy)]
struct Passage {
    k: usize,
    position_m: Vec2,
    sailed_m: f64,
}

/// The point of a track, from a passage on, that is nearest to a place.
fn nearest_passage(own: &ShipTrack, from: &Passage, place: Vec2) -> Passage {
    let (mut nearest, mut here) = (*from, *from);
    let mut least_m2 = (place - from.position_m).norm_squared();
    for next in from.k + 1..own.len() {
        let position_m = own.position_m(next);
        let step = position_m - here.position_m;
        let (length_m2, along_m2) = (step.norm_squared(), (place - here.position_m).dot(&step));
        let length_m = length_m2.sqrt();
        // the foot lies within the step
        if along_m2 > 0.0 && along_m2 < length_m2 {
            let share = along_m2 / length_m2;
            let foot_m = here.position_m + step * share;
            let distance_m2 = (place - foot_m).norm_squared();
            if distance_m2 < least_m2 {
                least_m2 = distance_m2;
                let sailed_m = here.sailed_m + share * length_m;
                nearest = Passage { k: next - 1, position_m: foot_m, sailed_m };
            }
        }
        here = Passage { k: next, position_m, sailed_m: here.sailed_m + length_m };
        let distance_m2 = (place - position_m).norm_squared();
        if distance_m2 < least_m2 {
            (least_m2, nearest) = (distance_m2, here);
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::HullOutline;
    use record::Ship;

    /// A track through these places, a sample at each.
    fn track(places: &[(f64, f64)]) -> ShipTrack {
        let hull = HullOutline::centred(8.45, 2.71);
        let ship = Ship {
            hull,
            yaw_rate_radps_max: 0.3,
            speed_mps_max: 12.0,
            steerage_mps: None,
            stopping: None,
        };
        let mut track = ShipTrack::with_capacity(ship, places.len());
        track.north_m = places.iter().map(|place| place.0).collect();
        track.east_m = places.iter().map(|place| place.1).collect();
        track
    }

    fn extra_m(sailed: &[(f64, f64)], route: &[(f64, f64)]) -> f64 {
        let places: Vec<Vec2> = route.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
        let planned_m: f64 = places.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        way_m(&track(sailed), &places[1..]) - planned_m
    }

    /// It was twice the way that a run goes on beyond the goal.
    #[test]
    fn keeping_straight_on_costs_no_distance_wherever_the_run_ends() {
        for end in [3, 40, 70, 142, 143, 144, 200] {
            let sailed: Vec<_> = (0..=end).map(|k| (7.0 * f64::from(k), 0.0)).collect();
            let extra_m = extra_m(&sailed, &[(0.0, 0.0), (1000.0, 0.0)]);
            assert!(extra_m.abs() < 1e-9, "{extra_m} m at {end}");
        }
    }

    #[test]
    fn way_around_is_counted_to_the_passage_of_the_goal() {
        // 3-4-5 triangles out and back, and 500 m beyond
        let sailed = [(0.0, 0.0), (400.0, 300.0), (800.0, 0.0), (1300.0, 0.0)];
        assert!((extra_m(&sailed, &[(0.0, 0.0), (800.0, 0.0)]) - 200.0).abs() < 1e-9);
        // passed 300 m abeam: what is still to sail is counted too
        let abeam = [(0.0, 0.0), (400.0, 300.0), (1200.0, 300.0)];
        assert!((extra_m(&abeam, &[(0.0, 0.0), (800.0, 0.0)]) - 400.0).abs() < 1e-9);
    }

    #[test]
    fn waypoints_are_passed_in_their_order() {
        let out_and_back = [(0.0, 0.0), (1000.0, 0.0), (1000.0, 500.0)];
        assert!(extra_m(&out_and_back, &out_and_back).abs() < 1e-9);
        // the run ends before the first waypoint: the rest of the route is still ahead
        let early = [(0.0, 0.0), (600.0, 0.0)];
        assert!(extra_m(&early, &out_and_back).abs() < 1e-9);
        // back at the start, which is the goal
        let round = [(0.0, 0.0), (900.0, 0.0), (0.0, 0.0)];
        assert!(extra_m(&round, &round).abs() < 1e-9);
    }
}
