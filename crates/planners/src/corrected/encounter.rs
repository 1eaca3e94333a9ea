//! What is remembered of each target: its class, own ship's duty, and whether she may act.

use super::options::CorrectedOptions;
use super::steady::{Alteration, Seen};
use geom::{
    EncounterClass, HeadOnSector, Relative, Vec2, class::OVERTAKING_SECTOR_RAD, classify,
    units::deg,
};
use planner_api::OwnState;

/// A track so bad that its prediction is off by more than this must not keep a stand-on ship from
/// acting, metres.
const STAND_ON_DOUBT_M_MAX: f64 = 60.0;
/// ... where this many standard deviations count.
const STAND_ON_SIGMAS: f64 = 2.0;
/// A class that has not changed for this long is as sure as it will be, seconds.
const SURE_AFTER_S: f64 = 30.0;
/// A class that is not sure has to last for this long before own ship gives way by it, seconds.
const LASTS_S: f64 = 6.0;

/// ... as a share of the speed.
const SURE_COURSE: f64 = 0.035;

/// An encounter from first risk until past and clear.
#[derive(Clone, Copy, Debug)]
pub struct Encounter {
    /// Number of the track.
    pub id: u32,
    /// Class at first risk.
    pub class: EncounterClass,
    /// Own course at first risk, radians clockwise from north.
    pub course_rad: f64,
    /// Relative bearing now, radians, positive to starboard.
    pub beta_rad: f64,
    /// The class was in doubt: it may be a crossing to the other ship.
    pub doubtful: bool,
    /// She was on own port side at first risk.
    pub was_to_port: bool,
    /// The class will not be looked at again.
    pub sure: bool,
    /// Since when this has been the class, seconds.
    pub since_s: f64,
    /// Own ship gives way, or stands on and has seen the other one do nothing (17(a)(ii)).
    pub may_act: bool,
    /// Stand-on: since when the prediction has been too close, seconds.
    pub too_close_since_s: Option<f64>,
    /// Where the target was last seen, and how she moved.
    pub last: LastSeen,
}

/// A target as she was last seen.
#[derive(Clone, Copy, Debug)]
pub struct LastSeen {
    /// Simulated time, seconds.
    pub t_s: f64,
    /// Metres north and east.
    pub position_m: Vec2,
    /// m/s north and east.
    pub velocity_mps: Vec2,
    /// Distance that was planned to her, metres.
    pub plan_m: f64,
}

impl LastSeen {
    /// Where she is if she went on so, metres.
    pub fn place_m(&self, t_s: f64) -> Vec2 {
        self.position_m + self.velocity_mps * (t_s - self.t_s)
    }
}

/// What the moment says about a target.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Simulated time, seconds.
    pub t_s: f64,
    /// Distance between reference points, as the stages of an encounter are measured, metres.
    pub range_m: f64,
    /// Rate of closing, m/s; negative when the range opens.
    pub closing_mps: f64,
    /// Relative bearing, radians, positive to starboard.
    pub beta_rad: f64,
    /// Standard deviation of the predicted distance, metres.
    pub cpa_sd_m: f64,
}

impl Encounter {
    /// A new one, with the class found from headings as they are now; `psi_rad` is the target's.
    pub fn begin(
        own: &OwnState,
        seen: &Seen,
        psi_rad: f64,
        last: LastSeen,
        options: &CorrectedOptions,
    ) -> Self {
        let track = &seen.track;
        let pose = Relative::new(own.position_m, own.psi_rad, track.position_m, psi_rad);
        let class = class_in_doubt(&pose, track.sog_mps, options);
        let may_act = !matches!(class, EncounterClass::CrossingPort | EncounterClass::Overtaken);
        let (id, beta_rad) = (track.id, pose.beta_rad);
        let doubtful = pose.alpha_rad.abs() <= OVERTAKING_SECTOR_RAD;
        Self {
            id,
            class,
            course_rad: own.cog_rad,
            beta_rad,
            doubtful,
            was_to_port: beta_rad < 0.0,
            sure: is_sure(seen),
            since_s: last.t_s,
            may_act,
            too_close_since_s: None,
            last,
        }
    }

    /// Looks at the class again until it is sure: the first seconds of a track say little of a
    /// course, and a bearing that stays says no less a minute later.
    pub fn class_again(
        &mut self,
        own: &OwnState,
        seen: &Seen,
        psi_rad: f64,
        options: &CorrectedOptions,
    ) {
        if self.sure {
            return;
        }
        // what she shows from an alteration on is not how the two have met
        match seen.altered {
            Alteration::Perhaps => return,
            Alteration::Seen(t_s) if t_s >= self.since_s => {
                self.sure = true;
                return;
            }
            _ => {}
        }
        let anew = Self::begin(own, seen, psi_rad, self.last, options);
        if anew.class == self.class {
            self.sure = anew.sure || self.last.t_s - self.since_s >= SURE_AFTER_S;
            return;
        }
        let course_rad = self.course_rad;
        *self = Self { course_rad, since_s: self.last.t_s, ..anew };
    }

    /// Rule 13(d): who was overtaking goes on overtaking, when her encounter opens once more.
    pub fn keep_overtaking(&mut self, ended: &[Self]) {
        let before = ended.iter().find(|e| e.id == self.id).map(|e| e.class);
        let overtakes =
            |class| matches!(class, EncounterClass::Overtaking | EncounterClass::Overtaken);
        if let Some(class) = before.filter(|&class| overtakes(class)) {
            self.class = class;
            self.may_act = class == EncounterClass::Overtaking;
            self.sure = true;
        }
    }

    /// Own ship gives way or may act, and by a class that has lasted.
    pub fn asks_to_act(&self) -> bool {
        self.may_act && (self.sure || self.last.t_s - self.since_s >= LASTS_S)
    }

    /// Lets a stand-on ship act once the other one has plainly done nothing. `dcpa_m` is the
    /// distance predicted at the present velocities, hull to hull (between centres where the
    /// mission says so), metres.
    pub fn watch(
        &mut self,
        moment: Moment,
        dcpa_m: impl FnOnce() -> f64,
        options: &CorrectedOptions,
    ) {
        self.beta_rad = moment.beta_rad;
        if self.may_act {
            return;
        }
        let limit_m = if self.class == EncounterClass::Overtaken {
            options.overtaken_range_m.max(moment.closing_mps * options.overtaken_time_s)
        } else {
            options.stand_on_range_m
        };
        // a pass that may as well be wide enough is left to the other ship
        let doubt_m = (STAND_ON_SIGMAS * moment.cpa_sd_m).min(STAND_ON_DOUBT_M_MAX);
        let too_close = moment.range_m <= limit_m
            && moment.closing_mps > 0.0
            && dcpa_m() + doubt_m < options.stand_on_dcpa_m;
        if !too_close {
            self.too_close_since_s = None;
            return;
        }
        let since_s = *self.too_close_since_s.get_or_insert(moment.t_s);
        self.may_act = moment.t_s - since_s >= options.stand_on_patience_s;
    }

    /// Whether own ship may alter to port for this one: never in head-on or crossing encounters,
    /// nor in what may be one, and not towards an overtaker.
    pub fn admits_port(&self) -> bool {
        match self.class {
            EncounterClass::Overtaking => !self.doubtful,
            EncounterClass::Static => true,
            EncounterClass::Overtaken => self.beta_rad > 0.0,
            _ => false,
        }
    }

    /// The course to port of which a return to the route must not go yet: Rule 17(c) looks at the
    /// whole time until the closest point, at every ship that may be one that crosses from port. A
    /// range that opens during own alteration may close again
    /// on the way back, so the limit lasts as long as the encounter.
    pub fn port_limit_rad(&self) -> Option<f64> {
        let free = match self.class {
            EncounterClass::Overtaking => !self.doubtful,
            EncounterClass::Static | EncounterClass::Overtaken => true,
            _ => false,
        };
        (!free && self.was_to_port).then_some(self.course_rad)
    }

    /// Whether the target has to be left on own port hand (port to port; astern of it).
    pub fn wants_target_to_port(&self) -> bool {
        matches!(self.class, EncounterClass::HeadOn | EncounterClass::CrossingStbd)
    }
}

/// Whether the target's heading is known well enough to stop looking: reported, or from a velocity
/// that is good to two degrees.
fn is_sure(seen: &Seen) -> bool {
    let reported = seen.track.psi_rad.is_some();
    reported || seen.velocity_sd_mps <= SURE_COURSE * seen.track.sog_mps
}

/// The class, with doubt resolved towards overtaking, head-on and giving way.
fn class_in_doubt(
    pose: &Relative,
    target_sog_mps: f64,
    options: &CorrectedOptions,
) -> EncounterClass {
    if target_sog_mps < crate::zhuang::class::STATIC_SPEED_MPS {
        return EncounterClass::Static;
    }
    let doubt_rad = deg(options.doubt_deg);
    if pose.alpha_rad.abs() > OVERTAKING_SECTOR_RAD - doubt_rad {
        return EncounterClass::Overtaking;
    }
    let sector = HeadOnSector::wide(deg(options.head_on_half_angle_deg));
    match classify(pose.beta_rad, pose.alpha_rad, sector) {
        EncounterClass::CrossingPort if pose.beta_rad > -doubt_rad => EncounterClass::CrossingStbd,
        class => class,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stand_on() -> Encounter {
        Encounter {
            id: 1,
            class: EncounterClass::CrossingPort,
            course_rad: 0.0,
            beta_rad: -1.0,
            doubtful: false,
            was_to_port: true,
            sure: true,
            since_s: 0.0,
            may_act: false,
            too_close_since_s: None,
            last: LastSeen {
                t_s: 0.0,
                position_m: Vec2::zeros(),
                velocity_mps: Vec2::zeros(),
                plan_m: 200.0,
            },
        }
    }

    fn moment(t_s: f64, range_m: f64, cpa_sd_m: f64) -> Moment {
        Moment { t_s, range_m, closing_mps: 10.0, beta_rad: -1.0, cpa_sd_m }
    }

    #[test]
    fn a_stand_on_ship_waits_for_range_nearness_and_time() {
        let options = CorrectedOptions::default();
        let mut encounter = stand_on();
        for (t_s, range_m, dcpa_m, may_act) in [
            (0.0, 800.0, 0.0, false),
            (10.0, 689.0, 0.0, false),
            (15.0, 650.0, 150.0, false),
            // the other ship seemed to act: the wait begins again
            (16.0, 640.0, 50.0, false),
            (21.0, 600.0, 50.0, false),
            (22.0, 590.0, 50.0, true),
            // and what it may do it may go on doing
            (23.0, 580.0, 300.0, true),
        ] {
            encounter.watch(moment(t_s, range_m, 0.0), || dcpa_m, &options);
            assert_eq!(encounter.may_act, may_act, "{t_s}");
        }
    }

    /// 80 m are too close if they are sure, and not if they may be 100.
    #[test]
    fn a_doubtful_prediction_is_no_reason_to_act() {
        let options = CorrectedOptions::default();
        for (cpa_sd_m, may_act) in [(0.0, true), (30.0, false)] {
            let mut encounter = stand_on();
            for beat in 0..20 {
                let t_s = f64::from(beat);
                encounter.watch(moment(t_s, 600.0 - 10.0 * t_s, cpa_sd_m), || 80.0, &options);
            }
            assert_eq!(encounter.may_act, may_act, "{cpa_sd_m}");
        }
    }

    /// Rule 13(d), also where the range has opened in between.
    #[test]
    fn an_overtaker_stays_one_and_any_other_is_looked_at_again() {
        let ended = |class| Encounter { class, ..stand_on() };
        let again = |before: &[Encounter]| {
            let mut encounter = Encounter { sure: false, ..ended(EncounterClass::HeadOn) };
            encounter.may_act = true;
            encounter.keep_overtaking(before);
            (encounter.class, encounter.may_act, encounter.sure)
        };
        let (overtaken, overtaking) = (EncounterClass::Overtaken, EncounterClass::Overtaking);
        assert_eq!(again(&[ended(overtaken)]), (overtaken, false, true));
        assert_eq!(again(&[ended(overtaking)]), (overtaking, true, true));
        let looked_at = (EncounterClass::HeadOn, true, false);
        assert_eq!(again(&[ended(EncounterClass::CrossingPort)]), looked_at);
        assert_eq!(again(&[Encounter { id: 2, ..ended(overtaken) }]), looked_at);
    }

    /// A crossing from port that turns towards own bow is no head-on encounter.
    #[test]
    fn the_class_is_fixed_once_the_target_has_altered() {
        let own = OwnState::steady(Vec2::zeros(), 0.0, 8.0);
        let psi_rad = deg(-175.0);
        let track = planner_api::TargetTrack {
            id: 1,
            position_m: Vec2::new(1000.0, -50.0),
            velocity_mps: geom::unit(psi_rad) * 5.0,
            cog_rad: psi_rad,
            sog_mps: 5.0,
            psi_rad: None,
            length_m: None,
            beam_m: None,
            covariance: [[0.0; 4]; 4],
            age_s: 60.0,
            since_update_s: 0.0,
        };
        let options = CorrectedOptions::default();
        for (altered, class, sure) in [
            (Alteration::None, EncounterClass::HeadOn, false),
            (Alteration::Perhaps, EncounterClass::CrossingPort, false),
            (Alteration::Seen(5.0), EncounterClass::CrossingPort, true),
            // before they met: it says nothing
            (Alteration::Seen(-5.0), EncounterClass::HeadOn, false),
        ] {
            let (position_sd_m, velocity_sd_mps, watched_s) = (5.0, 0.5, 60.0);
            let seen = Seen { track, position_sd_m, velocity_sd_mps, watched_s, altered };
            let mut encounter = Encounter { sure: false, ..stand_on() };
            encounter.class_again(&own, &seen, psi_rad, &options);
            assert_eq!((encounter.class, encounter.sure), (class, sure), "{altered:?}");
        }
    }

    #[test]
    fn doubt_is_resolved_as_the_rules_say() {
        let class = |beta_deg: f64, alpha_deg: f64| {
            let pose = Relative {
                range_m: 1000.0,
                bearing_rad: 0.0,
                beta_rad: deg(beta_deg),
                alpha_rad: deg(alpha_deg),
            };
            class_in_doubt(&pose, 5.0, &CorrectedOptions::default())
        };
        assert_eq!(class(14.0, -14.0), EncounterClass::HeadOn, "14(c)");
        assert_eq!(class(40.0, 111.0), EncounterClass::Overtaking, "13(c)");
        assert_eq!(class(-1.5, 60.0), EncounterClass::CrossingStbd);
        assert_eq!(class(-3.0, 60.0), EncounterClass::CrossingPort);
        assert_eq!(class(-113.0, 10.0), EncounterClass::Overtaken);
    }
}
