//! The corrected planner's beat.

use super::encounter::Encounter;
use super::land::Land;
use super::options::CorrectedOptions;
use super::own_motion::OwnMotion;
use super::path::{Agility, Path, Trial};
use super::search::{self, Reference, Target};
use super::steady::{Lookout, Seen};
use crate::clearance::Clearance;
use crate::guidance::{Guidance, Wish};
use geom::{HeadOnSector, HullOutline, Vec2, angle, units::deg, wrap};
use planner_api::{Command, Mission, OwnState, Planner, PlannerEvents, Situation};

/// Part of the margin that may be lost before a manoeuvre is chosen anew: what the prediction and
/// the ship's real turn differ by.
const TOLERATED_LOSS: f64 = 0.6;
/// A new manoeuvre must be better by this, metres, or the old one stays.
const WORTH_A_CHANGE_M: f64 = 10.0;
/// A return to the route must clear the planned distance by this, metres, or it would be taken
/// back a moment later.
const RETURN_SPARE_M: f64 = 25.0;
/// A second manoeuvre for the same encounters needs a lack of distance of this share of the margin.
const AGAIN_SHARE: f64 = 0.5;
/// A wish farther off the present course than this is the next leg of the route.
const LEG_CHANGE_RAD: f64 = deg(75.0);
/// Smallest alteration for land alone, degrees: it has no watch that must see it.
const LAND_ALTERATION_DEG: f64 = 10.0;
/// An alteration counts as made this much below its size, radians.
const MADE_WITHIN_RAD: f64 = deg(2.0);

/// The planner.
#[derive(Clone, Debug)]
pub struct ZhuangCorrected {
    pub(super) options: CorrectedOptions,
    pub(super) guidance: Guidance,
    pub(super) fixed: Option<Fixed>,
    pub(super) lookout: Lookout,
    pub(super) motion: OwnMotion,
    ordered_mps: Option<Vec2>,
    pub(super) seen: Vec<Seen>,
    pub(super) encounters: Vec<Encounter>,
    /// Encounters that were closed, the last of each track.
    pub(super) ended: Vec<Encounter>,
    pub(super) targets: Vec<Target>,
    pub(super) manoeuvre: Option<Manoeuvre>,
    /// A manoeuvre for the present encounters has ended.
    returned: bool,
    land: Land,
    path: Path,
    events: PlannerEvents,
}

/// What the mission fixes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fixed {
    half_length_m: f64,
    pub(super) clearance: Clearance,
    pub(super) agility: Agility,
    pub(super) safety_radius_m: f64,
    pub(super) speed_mps_max: f64,
    pub(super) hulls: Option<HullOutline>,
}

/// A manoeuvre under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Manoeuvre {
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
            lookout: Lookout::default(),
            motion: OwnMotion::default(),
            ordered_mps: None,
            seen: Vec::new(),
            encounters: Vec::new(),
            ended: Vec::new(),
            targets: Vec::new(),
            manoeuvre: None,
            returned: false,
            land: Land::default(),
            path: Path::default(),
            events: PlannerEvents::default(),
        }
    }

    fn act(&mut self, own: &OwnState, wish: Wish, fixed: Fixed) -> Trial {
        let straight_on = self.straight_on(wish);
        let ships_ask = self.targets.iter().any(|t| t.encounter.is_some_and(|e| e.asks_to_act()));
        self.path.predict(own, straight_on, fixed.agility);
        let must_act = ships_ask || self.land.lack_m(&self.path) > 0.0;
        let Some(mut manoeuvre) = self.manoeuvre else {
            // after a return the doubt must be larger, or own ship would waver
            let least_m = if self.returned { AGAIN_SHARE * self.options.margin_m } else { 0.0 };
            if !must_act || self.shortfall_m(own, straight_on, fixed) <= least_m {
                return straight_on;
            }
            let alteration_deg =
                if ships_ask { self.options.alteration_deg } else { LAND_ALTERATION_DEG };
            let reference = self.reference(own, wish, deg(alteration_deg));
            let choice = self.search(own, reference, fixed);
            self.manoeuvre = Some(Manoeuvre { reference, trial: choice.trial, made: false });
            // own ship's heading says nothing of the class from here on
            self.encounters.iter_mut().for_each(|e| e.sure = true);
            return choice.trial;
        };
        manoeuvre.made |= is_made(own, &manoeuvre);
        if (manoeuvre.made || !must_act) && self.is_clear(own, straight_on, fixed) {
            self.manoeuvre = None;
            self.returned = true;
            return straight_on;
        }
        if ships_ask {
            // what began for land alone has to be apparent from here on
            manoeuvre.reference.alteration_rad = deg(self.options.alteration_deg);
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
    fn reference(&self, own: &OwnState, wish: Wish, alteration_rad: f64) -> Reference {
        let drift_mps = self.motion.drift_mps();
        let through_water_mps = wish.velocity_mps() - drift_mps;
        let wished_rad = angle::direction(through_water_mps);
        let turning = wrap(wished_rad - own.psi_rad).abs() > LEG_CHANGE_RAD;
        Reference {
            psi_rad: if turning { own.psi_rad } else { wished_rad },
            stw_mps: through_water_mps.norm(),
            drift_mps,
            alteration_rad,
            wish_mps: wish.velocity_mps(),
        }
    }

    /// The order passes every target that still closes with more than the planned distance.
    fn is_clear(&mut self, own: &OwnState, trial: Trial, fixed: Fixed) -> bool {
        self.path.predict(own, trial, fixed.agility);
        let path = &self.path;
        self.land.lack_m(path) <= 0.0
            && self.targets.iter().all(|target| {
                let passing = path.passing(target.from_own_m, target.velocity_mps);
                let range_m = target.from_own_m.norm();
                passing.range_m_min
                    >= (target.plan_m + RETURN_SPARE_M).min(range_m - RETURN_SPARE_M)
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
        let around = (self.targets.as_slice(), &self.land);
        search::cheapest(own, reference, around, fixed.agility, &mut self.path)
    }

    /// By how much the order misses the planned distance to the worst target, metres.
    fn shortfall_m(&mut self, own: &OwnState, trial: Trial, fixed: Fixed) -> f64 {
        self.path.predict(own, trial, fixed.agility);
        search::judge(&self.path, &self.targets, &self.land).0
    }
}

impl Planner for ZhuangCorrected {
    fn reset(&mut self, mission: &Mission) {
        let CorrectedOptions { radius, unknown_length_m, trusted_share, lag_s, .. } = self.options;
        self.guidance.reset(mission);
        self.land.reset(mission);
        self.fixed = Some(Fixed {
            half_length_m: 0.5 * mission.own.length_m,
            clearance: Clearance::new(mission, radius, unknown_length_m),
            agility: Agility::new(&mission.own, trusted_share, lag_s),
            safety_radius_m: mission.safety_radius_m,
            speed_mps_max: mission.own.speed_mps_max,
            hulls: Some(HullOutline::centred(mission.own.length_m, mission.own.beam_m)),
        });
        self.lookout.clear();
        self.motion.clear();
        self.ordered_mps = None;
        self.encounters.clear();
        self.ended.clear();
        self.manoeuvre = None;
        self.returned = false;
        self.events = PlannerEvents::default();
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let fixed = self.fixed.expect("reset comes before the first beat");
        let wish = self.guidance.wish(situation.own.position_m);
        let own = self.motion.note(situation.t_s, &situation.own, self.ordered_mps);
        let alerts = self.observe(situation, &own, wish, fixed);
        self.returned &= !self.encounters.is_empty();
        let keep_m = self.options.land_m + fixed.half_length_m;
        self.land.look(own.position_m, fixed.speed_mps_max, keep_m);
        let nobody = self.encounters.is_empty() && self.manoeuvre.is_none();
        let trial = if nobody && !self.land.is_near() {
            Trial { course_rad: wish.course_rad(), speed_mps: wish.speed_mps }
        } else {
            self.act(&own, wish, fixed)
        };
        let mut velocity_mps = angle::unit(trial.course_rad) * trial.speed_mps;
        if self.manoeuvre.is_some() {
            // what the helm does not know of the drift would turn her at low speed
            velocity_mps += self.motion.helm_mps() - self.motion.drift_mps();
        }
        let speed_mps = velocity_mps.norm().min(fixed.speed_mps_max);
        let course_rad = if self.manoeuvre.is_some() {
            angle::direction(velocity_mps)
        } else {
            trial.course_rad
        };
        self.ordered_mps = Some(angle::unit(course_rad) * speed_mps);
        Command { alerts, ..Command::course_speed(course_rad, speed_mps) }
    }

    fn events(&self) -> PlannerEvents {
        self.events
    }

    fn head_on_sector(&self) -> Option<HeadOnSector> {
        Some(HeadOnSector::wide(deg(self.options.head_on_half_angle_deg)))
    }
}

/// The alteration is as large as ordered, or the apparent one; or the speed is cut by half.
fn is_made(own: &OwnState, manoeuvre: &Manoeuvre) -> bool {
    let reference = manoeuvre.reference;
    let turned_rad = wrap(own.psi_rad - reference.psi_rad).abs();
    let turned = turned_rad >= reference.alteration_rad - MADE_WITHIN_RAD;
    turned || own.stw_mps <= 0.5 * reference.stw_mps
}
