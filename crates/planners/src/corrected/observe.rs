//! What the corrected planner sees at a beat: encounters are opened, watched, handed over and
//! closed.

use super::encounter::{Encounter, LastSeen, Moment};
use super::gap::Gap;
use super::planner::{Fixed, ZhuangCorrected};
use super::search::Target;
use super::steady::Seen;
use crate::guidance::Wish;
use crate::zhuang::class::STATIC_SPEED_MPS;
use geom::{Vec2, angle, cpa, wrap};
use planner_api::{Alert, OwnState, Situation};

/// The closest point must lie this far back before an encounter is over, seconds: between hulls it
/// comes later than between reference points, and a return to the route moves it again.
const PAST_S: f64 = 10.0;
/// A target whose track is lost is kept for this long, seconds: another track of hers may follow.
const LOST_S: f64 = 20.0;
/// A new track this near to where a lost target must be is hers, metres.
const HAND_OVER_M: f64 = 100.0;
/// A target nearer than this, in seconds to the closest point, is not watched any longer before she
/// is classed.
const URGENT_S: f64 = 60.0;
/// A course is known when the velocity is uncertain by less than this share of the speed.
const KNOWN_COURSE: f64 = 0.08;

impl ZhuangCorrected {
    /// Opens, watches and closes encounters, and lists the targets for the search.
    pub(super) fn observe(
        &mut self,
        situation: &Situation<'_>,
        own: &OwnState,
        wish: Wish,
        fixed: Fixed,
    ) -> Vec<Alert> {
        let t_s = situation.t_s;
        self.lookout.keep(situation.tracks);
        let mut seen = std::mem::take(&mut self.seen);
        seen.clear();
        seen.extend(situation.tracks.iter().map(|track| self.lookout.see(t_s, track)));
        self.hand_over(t_s, &seen);
        let mut alerts = Vec::new();
        self.targets.clear();
        for seen in &seen {
            self.observe_one(t_s, own, seen, (wish, fixed), &mut alerts);
        }
        // who is lost from sight sails on in the mind
        for &encounter in &self.encounters {
            let lost = seen.iter().all(|seen| seen.track.id != encounter.id);
            if lost {
                let place_m = encounter.last.place_m(t_s);
                self.targets.push(target(own, place_m, &encounter.last, Some(encounter)));
            }
        }
        self.seen = seen;
        alerts
    }

    /// Gives the encounter of a track that was lost to the track that has taken its place.
    fn hand_over(&mut self, t_s: f64, seen: &[Seen]) {
        let is_seen = |id: u32| seen.iter().any(|seen| seen.track.id == id);
        for i in 0..self.encounters.len() {
            if is_seen(self.encounters[i].id) {
                continue;
            }
            let place_m = self.encounters[i].last.place_m(t_s);
            let distance_m = |s: &Seen| s.track.position_m.metric_distance(&place_m);
            let heir = seen
                .iter()
                .filter(|s| self.encounters.iter().all(|e| e.id != s.track.id))
                .filter(|s| distance_m(s) < HAND_OVER_M)
                .min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
            if let Some(heir) = heir {
                self.encounters[i].id = heir.track.id;
            }
        }
        self.encounters.retain(|e| is_seen(e.id) || t_s - e.last.t_s <= LOST_S);
    }

    fn observe_one(
        &mut self,
        t_s: f64,
        own: &OwnState,
        seen: &Seen,
        (wish, fixed): (Wish, Fixed),
        alerts: &mut Vec<Alert>,
    ) {
        let track = &seen.track;
        let hulls_m = fixed.clearance.hulls_m(track);
        let hulls = fixed.hulls.filter(|_| hulls_m > 0.0);
        let now = Now::new(t_s, wish, (own, seen), hulls_m);
        let doubt_m = (self.options.sigmas * now.moment.cpa_sd_m).min(self.options.sigma_m_max);
        let plan_m = fixed.clearance.radius_m(track) + self.options.margin_m + doubt_m;
        let (position_m, velocity_mps) = (track.position_m, track.velocity_mps);
        let last = LastSeen { t_s, position_m, velocity_mps, plan_m };
        let known = self.encounters.iter().position(|e| e.id == track.id);
        let encounter = match known {
            Some(i) if now.opens && now.moment.range_m > plan_m => {
                let ended = self.encounters.swap_remove(i);
                self.ended.retain(|e| e.id != ended.id);
                self.ended.push(ended);
                None
            }
            Some(i) => {
                let dcpa_m = || Gap { own, track, hulls }.least_m(now.tcpa_s);
                if self.manoeuvre.is_none() {
                    let psi_rad = self.heading_rad(seen);
                    self.encounters[i].class_again(own, seen, psi_rad, &self.options);
                }
                self.encounters[i].watch(now.moment, dcpa_m, &self.options);
                self.encounters[i].last = last;
                Some(self.encounters[i])
            }
            None if self.is_risk(&now, fixed) && self.is_watched(seen, &now) => {
                let psi_rad = self.heading_rad(seen);
                let mut encounter = Encounter::begin(own, seen, psi_rad, last, &self.options);
                encounter.keep_overtaking(&self.ended);
                self.encounters.push(encounter);
                alerts.push(alert(&encounter));
                Some(encounter)
            }
            None => None,
        };
        self.targets.push(target(own, position_m, &last, encounter));
    }

    /// A target's heading: as she reports it, or the direction of her motion through water that
    /// drifts as it does under own ship.
    fn heading_rad(&self, seen: &Seen) -> f64 {
        let through_water_mps = seen.track.velocity_mps - self.motion.drift_mps();
        let moves = seen.velocity_sd_mps > 0.0 && through_water_mps.norm() > STATIC_SPEED_MPS;
        let found_rad =
            if moves { angle::direction(through_water_mps) } else { seen.track.cog_rad };
        seen.track.psi_rad.unwrap_or(found_rad)
    }

    /// Known well enough to be classed, or too near to wait.
    fn is_watched(&self, seen: &Seen, now: &Now) -> bool {
        seen.watched_s >= self.options.watch_s
            || seen.velocity_sd_mps <= KNOWN_COURSE * seen.track.sog_mps
            || now.risk_tcpa_s <= URGENT_S
            || now.moment.range_m <= self.options.stand_on_range_m
    }

    fn is_risk(&self, now: &Now, fixed: Fixed) -> bool {
        let range_m = if now.moment.cpa_sd_m > 0.0 {
            self.options.noisy_risk_range_m
        } else {
            self.options.risk_range_m
        };
        now.moment.range_m < range_m
            && now.risk_tcpa_s <= self.options.risk_tcpa_s
            && now.risk_dcpa_m < fixed.safety_radius_m + self.options.margin_m
    }
}

fn alert(encounter: &Encounter) -> Alert {
    use geom::EncounterClass::{CrossingPort, CrossingStbd, HeadOn, Overtaken, Overtaking, Static};
    let rule = match encounter.class {
        HeadOn => "14",
        CrossingStbd => "15",
        CrossingPort | Overtaken => "17",
        Overtaking => "13",
        Static => "8",
    };
    let (rule, why) = (rule.to_owned(), encounter.class.name().to_owned());
    Alert { track: encounter.id, rule, why }
}

/// A target for the search, at this place.
fn target(own: &OwnState, place_m: Vec2, last: &LastSeen, encounter: Option<Encounter>) -> Target {
    Target {
        from_own_m: place_m - own.position_m,
        velocity_mps: last.velocity_mps,
        plan_m: last.plan_m,
        encounter,
    }
}

/// One target at this moment, at own ship's present velocity and at the wished one.
struct Now {
    moment: Moment,
    /// Time to the closest point at the present velocity, seconds; 0 once it lies behind.
    tcpa_s: f64,
    /// At both velocities the closest point lies well behind.
    opens: bool,
    /// The nearer of the two predictions that lie ahead, metres as the mission measures.
    risk_dcpa_m: f64,
    /// Its time, seconds; infinite if neither lies ahead.
    risk_tcpa_s: f64,
}

impl Now {
    fn new(t_s: f64, wish: Wish, (own, seen): (&OwnState, &Seen), hulls_m: f64) -> Self {
        let track = &seen.track;
        let los_m = track.position_m - own.position_m;
        let relative = |own_mps: Vec2| track.velocity_mps - own_mps;
        let present = cpa(los_m, relative(own.velocity_mps));
        let wished = cpa(los_m, relative(wish.velocity_mps()));
        let closing_mps = -los_m.dot(&relative(own.velocity_mps)) / los_m.norm().max(1e-9);
        let mut risk = (f64::INFINITY, f64::INFINITY);
        for prediction in [present, wished] {
            let ahead_s = prediction.tcpa_s.filter(|&t| t > 0.0);
            if let Some(tcpa_s) = ahead_s.filter(|_| prediction.dcpa_m < risk.0) {
                risk = (prediction.dcpa_m, tcpa_s);
            }
        }
        let is_past = |tcpa_s: Option<f64>| tcpa_s.is_none_or(|t_s| t_s < -PAST_S);
        let moment = Moment {
            t_s,
            range_m: los_m.norm(),
            closing_mps,
            beta_rad: wrap(angle::direction(los_m) - own.psi_rad),
            cpa_sd_m: seen.cpa_sd_m(if risk.1.is_finite() { risk.1 } else { 0.0 }),
        };
        Self {
            moment,
            tcpa_s: present.tcpa_s.unwrap_or(0.0).max(0.0),
            opens: is_past(present.tcpa_s) && is_past(wished.tcpa_s),
            risk_dcpa_m: risk.0 - hulls_m,
            risk_tcpa_s: risk.1,
        }
    }
}
