//! Whether own ship crossed ahead of the target: a fact that Rules 13 and 15 and TURN share.
//!
//! Own ship's reference point crosses the line ahead of the target's bow. How far ahead is measured
//! from the bow to the nearest part of own hull (or between reference points in that kind of
//! distance). Rule 15 takes the target's course made good (Cockcroft & Lameijer p. 99), Rule 13 her
//! centre line, both in rules specification, sections 8 and 9.

use crate::case::Case;
use crate::pair::reach_m;
use geom::{Vec2, angle};
use record::DistanceKind;

/// Own ship crossed the target's line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrossedAhead {
    pub(crate) t_s: f64,
    /// Metres ahead of the target's bow, not negative.
    pub(crate) ahead_m: f64,
}

/// The target's line ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Line {
    /// Along her course made good.
    Track,
    /// Along her heading.
    Centreline,
}

/// The nearest crossing ahead within the preferred distance, in samples `from..=to`; across her
/// track, while risk is open (section 9, R15).
pub(crate) fn crossed_ahead(
    case: &Case<'_>,
    line: Line,
    from: usize,
    to: usize,
) -> Option<CrossedAhead> {
    let target = case.life.actual.target;
    let ahead = |k: usize| match line {
        Line::Track if target.velocity_mps(k).norm_squared() > 1e-6 => target.velocity_mps(k),
        _ => angle::unit(target.psi_rad[k]),
    };
    // own ship from the target's reference point: along her line and to starboard of it
    let seen = |k: usize| -> (Vec2, f64, f64) {
        let (direction, own_m) = (ahead(k), -case.life.actual.relative(k).0);
        (direction, direction.dot(&own_m), direction.perp(&own_m))
    };
    let open = |k: usize| line == Line::Centreline || case.at_risk(k - 1) || case.at_risk(k);
    let mut nearest: Option<CrossedAhead> = None;
    let mut before = seen(from);
    for k in from + 1..=to {
        let now = seen(k);
        let crosses = (before.2 > 0.0 && now.2 <= 0.0) || (before.2 < 0.0 && now.2 >= 0.0);
        if crosses && open(k) && before.1.max(now.1) > 0.0 {
            let fraction = before.2 / (before.2 - now.2);
            let along_m = (before.1 + fraction * (now.1 - before.1)) / now.0.norm();
            let found = gap(case, k, now.0 / now.0.norm(), along_m).map(|ahead_m| CrossedAhead {
                t_s: case.life.time_s(k - 1) + fraction * case.life.trace.sample_s,
                ahead_m,
            });
            let closer = |new: &CrossedAhead| nearest.is_none_or(|old| new.ahead_m < old.ahead_m);
            nearest = found.filter(closer).or(nearest);
        }
        before = now;
    }
    nearest.filter(|crossing| crossing.ahead_m <= case.rules().distance.r_pref_m)
}

/// Distance ahead of the bow in the campaign's kind; none where own ship crossed abaft it.
fn gap(case: &Case<'_>, k: usize, direction: Vec2, along_m: f64) -> Option<f64> {
    let (own, target) = (case.life.actual.own, case.life.actual.target);
    let bow_m = reach_m(&target.ship.hull, target.psi_rad[k], direction);
    match case.life.trace.distance {
        _ if along_m < bow_m => None,
        DistanceKind::Centre => Some(along_m),
        DistanceKind::Hull => {
            let own_m = reach_m(&own.ship.hull, own.psi_rad[k], -direction);
            Some((along_m - bow_m - own_m).max(0.0))
        }
    }
}
