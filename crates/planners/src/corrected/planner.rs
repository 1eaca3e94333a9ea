//! The corrected planner's beat.

use super::encounter::{Encounter, Moment};
use super::gap::Gap;
use super::options::CorrectedOptions;
use super::path::{Agility, Path, Trial};
use super::search::{self, Reference, Target};
use crate::clearance::Clearance;
use crate::guidance::{Guidance, Wish};
use geom::{HullOutline, Vec2, angle, cpa, units::deg, wrap};
use planner_api::{Alert, Command, Mission, OwnState, Planner, PlannerEvents, Situation};

/// Part of the margin that may be lost before a manoeuvre is chosen anew: what the prediction and
/// the ship's real turn differ by.
const TOLERATED_LOSS: f64 = 0.6;
/// A new manoeuvre must be better by this, metres, or the old one stays.
const WORTH_A_CHANGE_M: f64 = 10.0;
/// A return to the route must clear the planned distance by this, metres, or it would be taken
/// back a moment later.
const RETURN_SPARE_M: f64 = 15.0;
/// A wish farther off the present course than this is the next leg of the route.
const LEG_CHANGE_RAD: f64 = deg(75.0);
/// The closest point must lie this far back before an encounter is over, seconds: between hulls it
/// comes later than between reference points, and a return to the route moves it again.
const PAST_S: f64 = 10.0;
/// An alteration counts as made this much below its size, radians.
const MADE_WITHIN_RAD: f64 = deg(2.0);

/// The planner.
#[derive(Clone, Debug)]
pub struct ZhuangCorrected {
    options: CorrectedOptions,
    guidance: Guidance,
    fixed: Option<Fixed>,
    encounters: Vec<Encounter>,
    targets: Vec<Target>,
    manoeuvre: Option<Manoeuvre>,
    path: Path,
    events: PlannerEvents,
}

/// What the mission fixes.
#[derive(Clone, Copy, Debug)]
struct Fixed {
    clearance: Clearance,
    agility: Agility,
    safety_radius_m: f64,
    hulls: Option<HullOutline>,
}

/// A manoeuvre under way.
#[derive(Clone, Copy, Debug)]
struct Manoeuvre {
    reference: Reference,
    trial: Trial,
    /// The alteration has been readily apparent.
    made: bool,
}

impl ZhuangCorrected {
    /// With these parameters.
    pub fn new(options: CorrectedOptions) -> Self {
        Self {
            options,
            guidance: Guidance::default(),
            fixed: None,
            encounters: Vec::new(),
            targets: Vec::new(),
            manoeuvre: None,
            path: Path::default(),
            events: PlannerEvents::default(),
        }
    }

    /// Opens, watches and closes encounters, and lists the targets for the search.
    fn observe(&mut self, situation: &Situation<'_>, wish: Wish, fixed: Fixed) -> Vec<Alert> {
        let mut alerts = Vec::new();
        let own = &situation.own;
        self.encounters.retain(|e| situation.tracks.iter().any(|track| track.id == e.id));
        self.targets.clear();
        for track in situation.tracks {
            let hulls_m = fixed.clearance.hulls_m(track);
            let plan_m = fixed.clearance.radius_m(track) + self.options.margin_m;
            let hulls = fixed.hulls.filter(|_| fixed.clearance.hulls_m(track) > 0.0);
            let gap = Gap { own, track, hulls };
            let now = Now::new(situation.t_s, wish, gap, hulls_m);
            let known = self.encounters.iter().position(|e| e.id == track.id);
            let encounter = match known {
                Some(i)
                    if now.opens && track.position_m.metric_distance(&own.position_m) > plan_m =>
                {
                    self.encounters.swap_remove(i);
                    None
                }
                Some(i) => {
                    self.encounters[i].watch(now.moment, &self.options);
                    Some(self.encounters[i])
                }
                None if self.is_risk(&now, fixed) => {
                    let encounter = Encounter::begin(own, track, &self.options);
                    self.encounters.push(encounter);
                    alerts.push(alert(&encounter));
                    Some(encounter)
                }
                None => None,
            };
            self.targets.push(Target {
                from_own_m: track.position_m - own.position_m,
                velocity_mps: track.velocity_mps,
                sog_mps: track.sog_mps,
                cog_rad: track.cog_rad,
                plan_m,
                encounter,
            });
        }
        alerts
    }

    fn is_risk(&self, now: &Now, fixed: Fixed) -> bool {
        now.moment.range_m < self.options.risk_range_m
            && now.risk_tcpa_s <= self.options.risk_tcpa_s
            && now.risk_dcpa_m < fixed.safety_radius_m + self.options.margin_m
    }

    fn act(&mut self, own: &OwnState, wish: Wish, fixed: Fixed) -> Trial {
        let straight_on = self.straight_on(wish);
        let must_act = self.targets.iter().any(|t| t.encounter.is_some_and(|e| e.may_act));
        let Some(mut manoeuvre) = self.manoeuvre else {
            if !must_act || self.shortfall_m(own, straight_on, fixed) <= 0.0 {
                return straight_on;
            }
            let reference = self.reference(own, wish);
            let choice = self.search(own, reference, fixed);
            self.manoeuvre = Some(Manoeuvre { reference, trial: choice.trial, made: false });
            return choice.trial;
        };
        manoeuvre.made |= is_made(own, &manoeuvre);
        if (manoeuvre.made || !must_act) && self.is_clear(own, straight_on, fixed) {
            self.manoeuvre = None;
            return straight_on;
        }
        let lost_m = self.shortfall_m(own, manoeuvre.trial, fixed);
        if lost_m > TOLERATED_LOSS * self.options.margin_m {
            let choice = self.search(own, manoeuvre.reference, fixed);
            if choice.shortfall_m + WORTH_A_CHANGE_M < lost_m {
                manoeuvre.trial = choice.trial;
            }
        }
        self.manoeuvre = Some(manoeuvre);
        manoeuvre.trial
    }

    /// Offsets count from the wish, so that a second manoeuvre on the way back does not add to the
    /// first; but on the way into another leg of the route from the present course.
    fn reference(&self, own: &OwnState, wish: Wish) -> Reference {
        let wished_rad = wish.course_rad();
        let turning = wrap(wished_rad - own.cog_rad).abs() > LEG_CHANGE_RAD;
        Reference {
            course_rad: if turning { own.cog_rad } else { wished_rad },
            speed_mps: wish.speed_mps,
            alteration_rad: deg(self.options.alteration_deg),
            wish_mps: wish.velocity_mps(),
        }
    }

    /// The order passes every target that still closes with more than the planned distance.
    fn is_clear(&mut self, own: &OwnState, trial: Trial, fixed: Fixed) -> bool {
        self.path.predict(own, trial, fixed.agility);
        let path = &self.path;
        self.targets.iter().all(|target| {
            let passing = path.passing(target.from_own_m, target.velocity_mps);
            let range_m = target.from_own_m.norm();
            passing.range_m_min >= (target.plan_m + RETURN_SPARE_M).min(range_m - RETURN_SPARE_M)
                || target.encounter.is_none() && passing.range_m_min >= target.plan_m
        })
    }

    /// The wish, but not to port of the course that a stand-on ship had when risk began.
    fn straight_on(&self, wish: Wish) -> Trial {
        let mut course_rad = wish.course_rad();
        for limit_rad in self.encounters.iter().filter_map(Encounter::port_limit_rad) {
            if wrap(course_rad - limit_rad) < 0.0 {
                course_rad = limit_rad;
            }
        }
        Trial { course_rad, speed_mps: wish.speed_mps }
    }

    fn search(&mut self, own: &OwnState, reference: Reference, fixed: Fixed) -> search::Choice {
        self.events.passes += 1;
        search::cheapest(own, reference, &self.targets, fixed.agility, &mut self.path)
    }

    /// By how much the order misses the planned distance to the worst target, metres.
    fn shortfall_m(&mut self, own: &OwnState, trial: Trial, fixed: Fixed) -> f64 {
        self.path.predict(own, trial, fixed.agility);
        search::judge(&self.path, &self.targets).0
    }
}

impl Planner for ZhuangCorrected {
    fn reset(&mut self, mission: &Mission) {
        let CorrectedOptions { radius, unknown_length_m, trusted_share, lag_s, .. } = self.options;
        self.guidance.reset(mission);
        self.fixed = Some(Fixed {
            clearance: Clearance::new(mission, radius, unknown_length_m),
            agility: Agility::new(&mission.own, trusted_share, lag_s),
            safety_radius_m: mission.safety_radius_m,
            hulls: Some(HullOutline::centred(mission.own.length_m, mission.own.beam_m)),
        });
        self.encounters.clear();
        self.manoeuvre = None;
        self.events = PlannerEvents::default();
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let fixed = self.fixed.expect("reset comes before the first beat");
        let wish = self.guidance.wish(situation.own.position_m);
        let alerts = self.observe(situation, wish, fixed);
        let trial = if self.encounters.is_empty() && self.manoeuvre.is_none() {
            Trial { course_rad: wish.course_rad(), speed_mps: wish.speed_mps }
        } else {
            self.act(&situation.own, wish, fixed)
        };
        Command { alerts, ..Command::course_speed(trial.course_rad, trial.speed_mps) }
    }

    fn events(&self) -> PlannerEvents {
        self.events
    }
}

/// The alteration is as large as ordered, or the apparent one; or the speed is cut by half.
fn is_made(own: &OwnState, manoeuvre: &Manoeuvre) -> bool {
    let reference = manoeuvre.reference;
    let turned_rad = wrap(own.cog_rad - reference.course_rad).abs();
    let turned = turned_rad >= reference.alteration_rad - MADE_WITHIN_RAD;
    turned || own.sog_mps <= 0.5 * reference.speed_mps
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

/// One target at this moment, at own ship's present velocity and at the wished one.
struct Now {
    moment: Moment,
    /// At both velocities the closest point lies well behind.
    opens: bool,
    /// The nearer of the two predictions that lie ahead, metres as the mission measures.
    risk_dcpa_m: f64,
    /// Its time, seconds; infinite if neither lies ahead.
    risk_tcpa_s: f64,
}

impl Now {
    fn new(t_s: f64, wish: Wish, gap: Gap<'_>, hulls_m: f64) -> Self {
        let Gap { own, track, .. } = gap;
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
            dcpa_m: gap.least_m(present.tcpa_s.unwrap_or(0.0).max(0.0)),
            closing_mps,
            beta_rad: wrap(angle::direction(los_m) - own.psi_rad),
        };
        Self {
            moment,
            opens: is_past(present.tcpa_s) && is_past(wished.tcpa_s),
            risk_dcpa_m: risk.0 - hulls_m,
            risk_tcpa_s: risk.1,
        }
    }
}
