//! Traces that cannot be judged: missing samples, samples that are not finite, a refused rule set.
//!
//! Nothing is guessed across a gap: every check of the pair is inconclusive, but a contact that was
//! seen is a failure all the same. Reference: rules specification, sections 0 and 16.

use crate::ruleset::RuleSet;
use crate::ruling::Ruling;
use record::{Check, DistanceKind, Judgement, PairFacts, Reaction, Role, ShipTrack, Status, Trace};

/// Why own ship's samples cannot be judged.
pub(crate) fn own_flaw(trace: &Trace) -> Option<&'static str> {
    let nominal = trace.nominal.as_ref();
    track_flaw(&trace.own, trace.samples()).or_else(|| {
        let nominal = nominal?;
        let targets = nominal.targets.len() == trace.targets.len();
        let flaw = track_flaw(&nominal.own, nominal.own.len());
        flaw.or((!targets).then_some("MISSING-SAMPLES"))
    })
}

/// Why this target cannot be judged.
pub(crate) fn target_flaw(trace: &Trace, target: usize, rules: &RuleSet) -> Option<&'static str> {
    let Some(pair) = trace.pairs.get(target) else { return Some("MISSING-SAMPLES") };
    let track = &trace.targets[target];
    let nominal = trace.nominal.as_ref().and_then(|nominal| nominal.targets.get(target));
    let lengths = (trace.own.ship.hull.length_m, track.ship.hull.length_m);
    let refused = trace.distance == DistanceKind::Centre
        && rules.admits_centre_distance(lengths.0, lengths.1).is_err();
    let known = pair.minimum.hull_m.is_finite() && pair.minimum.centre_m.is_finite();
    track_flaw(track, trace.samples())
        .or_else(|| nominal.and_then(|track| track_flaw(track, track.len())))
        .or((pair.hull_m.len() != trace.samples()).then_some("MISSING-SAMPLES"))
        .or((!known || !all_finite(&pair.hull_m)).then_some("NON-FINITE-SAMPLES"))
        .or(refused.then_some("R_COL-INSIDE-HULLS"))
}

fn track_flaw(track: &ShipTrack, samples: usize) -> Option<&'static str> {
    let signals = [
        &track.north_m,
        &track.east_m,
        &track.psi_rad,
        &track.vel_north_mps,
        &track.vel_east_mps,
        &track.yaw_rate_radps,
    ];
    if samples == 0 || signals.iter().any(|signal| signal.len() != samples) {
        return Some("MISSING-SAMPLES");
    }
    let finite = signals.iter().all(|signal| all_finite(signal));
    (!finite).then_some("NON-FINITE-SAMPLES")
}

/// Any NaN or infinity makes the sum of zero times each value NaN; this runs over whole vectors.
fn all_finite(values: &[f64]) -> bool {
    let mut lanes = [0.0; 8];
    let chunks = values.chunks_exact(lanes.len());
    let rest: f64 = chunks.remainder().iter().map(|value| value * 0.0).sum();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value * 0.0;
        }
    }
    (lanes.iter().sum::<f64>() + rest).is_finite()
}

/// A pair whose samples cannot be read: contact is a failure all the same, the rest is open.
pub(crate) fn unreadable(trace: &Trace, target: usize, flaw: &'static str, out: &mut Judgement) {
    let refused = flaw == "R_COL-INSIDE-HULLS";
    let status = if refused { Status::NotEvaluated } else { Status::Inconclusive };
    let with_target = record::ContactWith::Target(target as u8);
    let touched = trace.contact.is_some_and(|contact| contact.with == with_target);
    for check in Check::ALL {
        let ruling = if check == Check::Safe && touched {
            Ruling::new(check, target, Status::Fail).detail("FAIL-COLLISION")
        } else {
            Ruling::new(check, target, status).detail(flaw)
        };
        out.verdicts.push(ruling.done());
    }
    out.pairs.push(PairFacts {
        target: target as u8,
        risk_s: None,
        class: None,
        class_by_bearings: None,
        class_by_planner: None,
        role: Role::None,
        ambiguous: false,
        beta_rad: None,
        alpha_rad: None,
        range_m: None,
        cpa_s: None,
        stages_s: [None; 3],
        released_s: None,
        reaction: Reaction::Unknown,
        apparent: Reaction::Unknown,
        first_turn_rad: None,
    });
}
