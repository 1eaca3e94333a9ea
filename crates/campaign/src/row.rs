//! From encounter, trace and judgement to one flat row.

use geom::{Relative, Vec2};
use record::{
    Check, CheckCell, Digest, Encounter, Outcome, PlannerEvents, Reaction, RunRow, Status, Trace,
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
    row.extra_distance_m = Some(trace.own.way_m(&places[1..]) - planned_m);
}
