//! The life of one pair's encounter: onset of risk, class, doubt, closest point.
//!
//! Onset, class and role come from the nominal track where there is one, so that they are the same
//! for every planner; without it from the actual track. The class is found once, from headings,
//! and locked. Reference: rules specification, sections 1 to 3.

use crate::pair::PairTracks;
use crate::risk::{Interval, RiskScanner, Scan, opening_m, relative};
use crate::ruleset::RuleSet;
use geom::{EncounterClass, Relative, Vec2, classify, wrap};
use record::{ContactWith, LastMinute, Pair, Trace, Visibility};

/// One pair, whatever role it is judged under.
#[derive(Debug)]
pub(crate) struct PairLife<'a> {
    pub(crate) trace: &'a Trace,
    pub(crate) rules: &'a RuleSet,
    pub(crate) target: usize,
    pub(crate) actual: PairTracks<'a>,
    pub(crate) nominal: Option<PairTracks<'a>>,
    /// When risk is open, in samples.
    pub(crate) risk: Vec<Interval>,
    pub(crate) onset: Option<Onset>,
    /// Closest point, if the run went past it.
    pub(crate) passed: Option<Passed>,
}

/// The moment that fixes class and role.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Onset {
    pub(crate) k: usize,
    pub(crate) seen: Relative,
    /// Class by the two-variable test.
    pub(crate) class: EncounterClass,
    /// Class whose duties decide: what Rules 13(c) and 14(c) prefer in doubt.
    pub(crate) decides: EncounterClass,
    /// Every class within the doubt, in the order of `EncounterClass::ALL`.
    pub(crate) reachable: [bool; EncounterClass::ALL.len()],
    /// Own ship is stopped: only her passing distance can be judged.
    pub(crate) own_stopped: bool,
}

/// How the ships lay at their closest point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed {
    pub(crate) t_s: f64,
    /// Last sample at or before it.
    pub(crate) k: usize,
    pub(crate) alpha_rad: f64,
    pub(crate) beta_rad: f64,
}

impl<'a> PairLife<'a> {
    pub(crate) fn new(
        trace: &'a Trace,
        rules: &'a RuleSet,
        target: usize,
        scanner: &mut RiskScanner,
    ) -> Self {
        let actual = PairTracks::new(&trace.own, &trace.targets[target], trace.distance);
        let nominal = trace
            .nominal
            .as_ref()
            .map(|n| PairTracks::new(&n.own, &n.targets[target], trace.distance));
        let mut life = Self {
            trace,
            rules,
            target,
            actual,
            nominal,
            risk: Vec::with_capacity(1),
            onset: None,
            passed: None,
        };
        let judged = life.nominal.unwrap_or(actual);
        let by_radar = matches!(trace.visibility, Visibility::Restricted { .. });
        scanner.scan(&judged, trace.sample_s, rules, by_radar, &mut life.risk);
        let opens = life.risk.first().map(|&(k, _)| k);
        if by_radar && opens.is_some_and(|k| life.in_sight_by(k)) {
            // seen before Rule 19 had anything to say: the risk of Rule 7 decides
            scanner.scan(&judged, trace.sample_s, rules, false, &mut life.risk);
        }
        life.onset = life.risk.first().map(|&(k, _)| Onset::new(&judged, k, rules));
        life.passed = life.closest();
        life
    }

    /// The same pair from sample `from` on, judged by what is seen (Rule 19: on coming in sight).
    /// Risk that is open then opens anew at that sample, unless the pass is wide enough by then
    /// that it would not open.
    pub(crate) fn in_sight_from(&self, from: usize, scanner: &mut RiskScanner) -> Self {
        let mut risk = Vec::with_capacity(1);
        let within_m = opening_m(self.rules, false);
        let how = Scan { within_m, anew: Some(from), forced: None };
        scanner.scan_as(&self.actual, self.trace.sample_s, self.rules, how, &mut risk);
        risk.retain(|&(_, until)| until > from);
        if let Some(first) = risk.first_mut() {
            first.0 = first.0.max(from);
        }
        let onset = risk.first().map(|&(k, _)| Onset::new(&self.actual, k, self.rules));
        Self {
            risk,
            onset,
            trace: self.trace,
            rules: self.rules,
            target: self.target,
            actual: self.actual,
            nominal: self.nominal,
            passed: self.passed,
        }
    }

    pub(crate) fn pair(&self) -> &'a Pair {
        &self.trace.pairs[self.target]
    }

    pub(crate) fn time_s(&self, k: usize) -> f64 {
        k as f64 * self.trace.sample_s
    }

    /// The last sample at or before a time.
    pub(crate) fn sample(&self, t_s: f64) -> usize {
        ((t_s / self.trace.sample_s) as usize).min(self.actual.len().saturating_sub(1))
    }

    pub(crate) fn last_minute(&self) -> Option<&'a LastMinute> {
        self.trace.last_minute.as_ref().and_then(|all| all.get(self.target)?.as_ref())
    }

    /// Smallest distance of the run in the campaign's kind, metres.
    pub(crate) fn distance_m(&self) -> f64 {
        self.pair().minimum.of(self.trace.distance).0
    }

    /// Whether this pair's hulls touched.
    pub(crate) fn touched(&self) -> bool {
        let with_target = ContactWith::Target(self.target as u8);
        self.pair().minimum.hull_m <= 0.0
            || self.trace.contact.is_some_and(|contact| contact.with == with_target)
    }

    /// Distance at a sample in the campaign's kind, metres (a lower bound where far apart).
    pub(crate) fn distance_at_m(&self, k: usize) -> f64 {
        match self.trace.distance {
            record::DistanceKind::Hull => self.pair().hull_m[k],
            record::DistanceKind::Centre => self.actual.range_m(k),
        }
    }

    /// Whether the ships saw one another at sample `k` or before.
    pub(crate) fn in_sight_by(&self, k: usize) -> bool {
        match self.trace.visibility {
            Visibility::InSight => true,
            Visibility::Restricted { visual_range_m } => {
                (0..=k.min(self.actual.len() - 1)).any(|j| self.actual.range_m(j) <= visual_range_m)
            }
        }
    }

    /// When risk is open on the way that was really gone, from the onset on.
    pub(crate) fn open_as_sailed(&self, onset: usize, scanner: &mut RiskScanner) -> Vec<Interval> {
        let mut open = Vec::new();
        let within_m = opening_m(self.rules, false);
        let how = Scan { within_m, anew: None, forced: Some(onset) };
        scanner.scan_as(&self.actual, self.trace.sample_s, self.rules, how, &mut open);
        open
    }

    /// Whether risk is open at sample `k`.
    pub(crate) fn at_risk(&self, k: usize) -> bool {
        self.risk.iter().any(|&(from, until)| k >= from && k < until)
    }

    /// Whether sample `k` lies in a risk interval or up to `lead` samples before one.
    pub(crate) fn near_risk(&self, k: usize, lead: usize) -> bool {
        self.risk.iter().any(|&(from, until)| k + lead >= from && k < until)
    }

    fn closest(&self) -> Option<Passed> {
        let last = self.actual.len().checked_sub(1)?;
        let (distance_m, t_s) = self.pair().minimum.of(self.trace.distance);
        let still_closing = self.actual.closing(last)
            && self.actual.tcpa_s(last).is_some()
            && self.actual.dcpa_m(last) < distance_m;
        if still_closing && !self.touched() {
            return None;
        }
        let k = self.sample(t_s);
        let seen = self.seen_between(k, t_s / self.trace.sample_s - k as f64);
        Some(Passed { t_s, k, alpha_rad: seen.alpha_rad, beta_rad: seen.beta_rad })
    }

    /// Bearings a fraction of a sample after sample `k`.
    fn seen_between(&self, k: usize, fraction: f64) -> Relative {
        let next = (k + 1).min(self.actual.len() - 1);
        let position = |track: &record::ShipTrack| -> Vec2 {
            track.position_m(k) * (1.0 - fraction) + track.position_m(next) * fraction
        };
        let psi = |track: &record::ShipTrack| -> f64 {
            let turn_rad = wrap(track.psi_rad[next] - track.psi_rad[k]);
            wrap(track.psi_rad[k] + fraction * turn_rad)
        };
        let (own, target) = (self.actual.own, self.actual.target);
        Relative::new(position(own), psi(own), position(target), psi(target))
    }
}

impl Onset {
    fn new(pair: &PairTracks<'_>, k: usize, rules: &RuleSet) -> Self {
        let seen = relative(pair, k);
        let c = &rules.classification;
        let own_stopped = pair.own.sog_mps(k) < c.stopped_mps;
        let mut reachable = [false; EncounterClass::ALL.len()];
        if pair.target.sog_mps(k) < c.stopped_mps {
            let class = EncounterClass::Static;
            reachable[class as usize] = true;
            return Self { k, seen, class, decides: class, reachable, own_stopped };
        }
        let class = classify(seen.beta_rad, seen.alpha_rad, rules.head_on());
        for own_error in [-1.0, 0.0, 1.0] {
            for target_error in [-1.0, 0.0, 1.0] {
                let beta_rad = wrap(seen.beta_rad + own_error * c.doubt_rad);
                let alpha_rad = wrap(seen.alpha_rad + target_error * c.doubt_rad);
                reachable[classify(beta_rad, alpha_rad, rules.head_on()) as usize] = true;
            }
        }
        let decides = preferred(class, reachable);
        Self { k, seen, class, decides, reachable, own_stopped }
    }

    /// Whether another class lies within the doubt.
    pub(crate) fn ambiguous(&self) -> bool {
        self.reachable.iter().filter(|&&reachable| reachable).count() > 1
    }
}

/// The class that Rules 13(c) and 14(c) prefer: overtaking over crossing, head-on over crossing,
/// and giving way over standing on where the target is nearly ahead.
fn preferred(
    class: EncounterClass,
    reachable: [bool; EncounterClass::ALL.len()],
) -> EncounterClass {
    use EncounterClass::{CrossingPort, CrossingStbd, HeadOn, Overtaking};
    if !matches!(class, CrossingStbd | CrossingPort) {
        return class;
    }
    for candidate in [Overtaking, HeadOn, CrossingStbd] {
        if reachable[candidate as usize] {
            return candidate;
        }
    }
    class
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Script, rules, ship};
    use geom::units::deg;
    use record::DistanceKind;

    fn onset(north_m: f64, east_m: f64, psi_t_deg: f64) -> Onset {
        let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, 5.0).hold(2.0).track();
        let target = Script::new(ship(10.0, 3.0), north_m, east_m, deg(psi_t_deg), 5.0).hold(2.0);
        Onset::new(&PairTracks::new(&own, &target.track(), DistanceKind::Hull), 0, &rules())
    }

    #[test]
    fn doubt_prefers_giving_way() {
        // one degree to port: a crossing from port, in doubt with one from starboard
        let bow = onset(1000.0, -17.0, 90.0);
        assert_eq!(bow.class, EncounterClass::CrossingPort);
        assert_eq!(bow.decides, EncounterClass::CrossingStbd);
        assert!(bow.ambiguous());
        // 14 degrees on the bow, reciprocal: one degree outside the head-on sector
        let near = onset(1000.0, 249.0, 194.0);
        assert_eq!(
            (near.class, near.decides),
            (EncounterClass::CrossingStbd, EncounterClass::HeadOn)
        );
        // a clear crossing
        let clear = onset(1000.0, 1000.0, -90.0);
        assert_eq!((clear.class, clear.ambiguous()), (EncounterClass::CrossingStbd, false));
    }

    #[test]
    fn doubt_whether_overtaking_is_overtaking() {
        // own ship seen 111 degrees from the target's bow
        let alpha_rad = deg(111.0);
        let psi_t = 180.0 - 111.0;
        let coming_up = onset(1000.0, 0.0, psi_t);
        assert!((coming_up.seen.alpha_rad - alpha_rad).abs() < 1e-9);
        assert_eq!(coming_up.class, EncounterClass::CrossingStbd);
        assert_eq!(coming_up.decides, EncounterClass::Overtaking);
    }
}
