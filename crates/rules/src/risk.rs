//! Rule 7: when risk of collision opens and closes.
//!
//! Risk opens at the first sample of a stretch in which the predicted pass is close, ahead in time
//! and within the outer range of stage 2; it closes at the first sample of a stretch in which the
//! pass is well clear, or lies behind and the range grows. While either ship turns the state is
//! held: such a sample neither opens nor closes and breaks a stretch. Shape after the entry
//! criterion of Eriksen et al. 2020. Reference: rules specification, section 1.

use crate::pair::PairTracks;
use crate::ruleset::{RuleSet, StageMode};
use crate::signal::Kernel;
use geom::{EncounterClass, Relative, classify, cpa};
use record::ShipTrack;

/// Samples in which risk is open: from, and the first one after.
pub(crate) type Interval = (usize, usize);

/// What must be predicted for risk to open: a pass within the profile's distance of risk or, by
/// radar alone, within its distance of close quarters where that is larger (Rule 19(d): "a
/// close-quarters situation is developing and/or risk of collision exists").
pub(crate) fn opening_m(rules: &RuleSet, by_radar: bool) -> f64 {
    if by_radar {
        rules.risk.d_risk_m.max(rules.restricted_visibility.close_quarters_m)
    } else {
        rules.risk.d_risk_m
    }
}

/// How risk is looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scan {
    /// What must be predicted for it to open, metres.
    pub(crate) within_m: f64,
    /// At this sample risk must be there anew: what is open by its memory alone closes.
    pub(crate) anew: Option<usize>,
    /// Risk is open at this sample at the latest, as the onset on the nominal track binds whatever
    /// own ship has done since.
    pub(crate) forced: Option<usize>,
}

/// Finds the intervals of open risk; kept between traces for its memory.
#[derive(Debug, Default)]
pub(crate) struct RiskScanner {
    kernel: Kernel,
    smooth: Vec<f64>,
    turning: Vec<bool>,
}

impl RiskScanner {
    /// Intervals of open risk; `by_radar` where neither ship sees the other.
    pub(crate) fn scan(
        &mut self,
        pair: &PairTracks<'_>,
        sample_s: f64,
        rules: &RuleSet,
        by_radar: bool,
        intervals: &mut Vec<Interval>,
    ) {
        let how = Scan { within_m: opening_m(rules, by_radar), anew: None, forced: None };
        self.scan_as(pair, sample_s, rules, how, intervals);
    }

    /// The same, anew at a sample or forced open at one.
    pub(crate) fn scan_as(
        &mut self,
        pair: &PairTracks<'_>,
        sample_s: f64,
        rules: &RuleSet,
        Scan { within_m, anew, forced }: Scan,
        intervals: &mut Vec<Interval>,
    ) {
        intervals.clear();
        let n = pair.len();
        self.mark_turning(pair, sample_s, rules);
        // n samples span n - 1 intervals
        let needed = (rules.risk.persistence_s / sample_s).ceil() as usize + 1;
        let (mut open_since, mut stretch) = (None, 0);
        for k in 0..n {
            if forced == Some(k) && open_since.is_none() {
                (open_since, stretch) = (Some(k), 0);
            }
            let held = self.turning.get(k).copied().unwrap_or(false);
            if anew == Some(k) && !held && !opens(pair, k, within_m, rules) {
                (open_since, stretch) = (None, 0);
            }
            let holds = !held
                && if open_since.is_some() {
                    closes(pair, k, within_m, rules)
                } else {
                    opens(pair, k, within_m, rules)
                };
            stretch = if holds { stretch + 1 } else { 0 };
            if stretch == needed {
                let first = k + 1 - needed;
                match open_since.take() {
                    None => open_since = Some(first),
                    Some(since) => intervals.push((since, first.max(since))),
                }
                stretch = 0;
            }
        }
        intervals.extend(open_since.map(|since| (since, n)));
    }

    /// Marks the samples in which either ship turns; no marks where neither ever does.
    fn mark_turning(&mut self, pair: &PairTracks<'_>, sample_s: f64, rules: &RuleSet) {
        self.turning.clear();
        let limit_radps = rules.risk.held_above_yaw_rate_radps;
        self.kernel.prepare(rules.manoeuvre.heading_sigma_s, sample_s);
        for track in [pair.own, pair.target] {
            if !ever_turns(track, limit_radps) {
                continue;
            }
            self.turning.resize(pair.len(), false);
            // in a seaway a ship yaws faster than this all the time; her smoothed rate does not
            self.kernel.smooth(&track.yaw_rate_radps[..pair.len()], &mut self.smooth);
            for (mark, rate) in self.turning.iter_mut().zip(&self.smooth) {
                *mark |= rate.abs() > limit_radps;
            }
        }
    }
}

fn ever_turns(track: &ShipTrack, limit_radps: f64) -> bool {
    track.yaw_rate_radps.iter().any(|rate| rate.abs() > limit_radps)
}

fn opens(pair: &PairTracks<'_>, k: usize, within_m: f64, rules: &RuleSet) -> bool {
    let (position_m, velocity_mps) = pair.relative(k);
    let tcpa_s = cpa(position_m, velocity_mps).tcpa_s;
    if !tcpa_s.is_some_and(|t| t > 0.0 && t <= rules.risk.t_risk_s) {
        return false;
    }
    let range_m = position_m.norm();
    let closing_mps = (-position_m.dot(&velocity_mps) / range_m).max(0.0);
    let timed_m = closing_mps * rules.stages.t2_s;
    let near = range_m < rules.stages.r2_m
        || (range_m < timed_m
            && (rules.stages.mode == StageMode::Time || is_overtaking(pair, k, rules)));
    near && pair.dcpa_below(k, within_m)
}

fn closes(pair: &PairTracks<'_>, k: usize, within_m: f64, rules: &RuleSet) -> bool {
    let (position_m, velocity_mps) = pair.relative(k);
    let behind = cpa(position_m, velocity_mps).tcpa_s.is_some_and(|t| t < 0.0);
    let growing = position_m.dot(&velocity_mps) > 0.0;
    (behind && growing) || !pair.dcpa_below(k, rules.risk.close_factor * within_m)
}

fn is_overtaking(pair: &PairTracks<'_>, k: usize, rules: &RuleSet) -> bool {
    let seen = relative(pair, k);
    let class = classify(seen.beta_rad, seen.alpha_rad, rules.head_on());
    matches!(class, EncounterClass::Overtaking | EncounterClass::Overtaken)
}

/// Bearings at sample `k`, from the headings.
pub(crate) fn relative(pair: &PairTracks<'_>, k: usize) -> Relative {
    let (own, target) = (pair.own, pair.target);
    Relative::new(own.position_m(k), own.psi_rad[k], target.position_m(k), target.psi_rad[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Script, rules, ship};
    use geom::units::deg;
    use record::DistanceKind;

    fn intervals(own: Script, target: Script) -> Vec<Interval> {
        let (own, target) = (own.track(), target.track());
        let pair = PairTracks::new(&own, &target, DistanceKind::Centre);
        let mut found = Vec::new();
        RiskScanner::default().scan(&pair, 1.0, &rules(), false, &mut found);
        found
    }

    #[test]
    fn opens_at_the_outer_range_and_closes_after_cpa() {
        let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, 5.0).hold(400.0);
        let target = Script::new(ship(10.0, 3.0), 2405.0, 20.0, deg(180.0), 5.0).hold(400.0);
        // 2405 m less 10 m/s: inside 1900 m from 51 s on; CPA at 240.5 s
        assert_eq!(intervals(own, target), vec![(51, 241)]);
    }

    #[test]
    fn a_wide_pass_and_an_equal_velocity_open_nothing() {
        let own = || Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, 5.0).hold(400.0);
        let wide = Script::new(ship(10.0, 3.0), 1500.0, 201.0, deg(180.0), 5.0).hold(400.0);
        assert!(intervals(own(), wide).is_empty());
        let abreast = Script::new(ship(10.0, 3.0), 0.0, 60.0, 0.0, 5.0).hold(400.0);
        assert!(intervals(own(), abreast).is_empty());
    }

    /// Too wide to open, too narrow to close before she has passed (150 s).
    #[test]
    fn risk_that_the_plan_opened_is_open_as_sailed() {
        let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, 5.0).hold(400.0).track();
        let wide = Script::new(ship(10.0, 3.0), 1505.0, 220.0, deg(180.0), 5.0).hold(400.0).track();
        let pair = PairTracks::new(&own, &wide, DistanceKind::Centre);
        let open = |forced: Option<usize>| {
            let mut found = Vec::new();
            let how = Scan { within_m: opening_m(&rules(), false), anew: None, forced };
            RiskScanner::default().scan_as(&pair, 1.0, &rules(), how, &mut found);
            found
        };
        assert_eq!((open(None), open(Some(30))), (vec![], vec![(30, 151)]));
    }

    #[test]
    fn a_turn_holds_the_state() {
        // turns away from 20 s on, at a rate that a prediction must not be made from
        let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, 5.0).hold(20.0).turn(60.0, 0.5);
        let target = Script::new(ship(10.0, 3.0), 1500.0, 0.0, deg(180.0), 5.0).hold(300.0);
        let found = intervals(own.hold(100.0), target);
        assert_eq!(found.len(), 1);
        assert!(found[0].0 == 0 && found[0].1 >= 139, "{found:?}");
    }
}
