//! A target that meets own ship as the rules ask, or fails to: gives way early or late, stands on
//! until it helps no more, neglects her duty, or turns the wrong way.
//!
//! She knows own ship's motion exactly and decides once a beat on the same snapshot as everybody.
//! What she owes is fixed at the first beat with risk (Rule 13(d): no later change of bearing makes
//! another vessel of her) and asked anew when the ships come in sight of one another, for Rule 19
//! holds before that. She alters once, keeps that course until the range opens and her old course
//! is clear, and goes back to it.
//!
//! Her alteration is the declared angle, and more in steps of ten degrees up to a right angle until
//! own ship is predicted to pass beyond the distance at which there is risk, on the side that the
//! rule asks for ([`Passage`]); where nothing reaches that she takes the best there is, and alters
//! not at all where each alteration would bring her nearer than her present course (Rule 8(d)).
//! Known limits: she answers by course alone (Rules 8(e) and 19(e) know speed, too), and sees
//! neither the other targets nor land.

use crate::passage::{Passage, Turning};
use crate::pose::Pose;
use crate::ship::Ship;
use crate::vessel::Helm;
use geom::{EncounterClass, HeadOnSector, Relative, Vec2, classify, cpa, units::deg, wrap};
use record::{Conduct, Manner};
use std::f64::consts::FRAC_PI_2;

/// Half-angle of the head-on sector in the eyes of a target: as the profiles for small craft have
/// it (13 degrees, the rules specification, section 2).
const HEAD_ON_HALF_ANGLE_RAD: f64 = deg(13.0);
/// Below this speed own ship is an obstacle, and a target keeps out of her way, m/s.
const MOVING_MPS_MIN: f64 = 0.2;
/// How long a target watches own ship before she acts, seconds: nobody alters on the first glance
/// (Rule 7(c)). Ours; a radar needs a minute for a trend (IMO MSC.192(79)), with ships ten times as
/// far off.
const WATCHES_S: f64 = 30.0;
/// Step by which an alteration that is not enough is made larger, and the largest one.
const MORE_RAD: f64 = deg(10.0);
const MOST_RAD: f64 = FRAC_PI_2;
/// Own ship is past and clear beyond so many distances of risk; what comes then is a new meeting.
const CLEAR_PER_RISK: f64 = 2.0;

/// A target under a duty.
#[derive(Clone, Debug)]
pub struct Duty {
    conduct: Conduct,
    course_rad: f64,
    speed_mps: f64,
    /// Beyond this range she knows own ship by radar alone; absent in clear weather.
    visual_range_m: Option<f64>,
    owes: Option<Owes>,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// On her course, watching.
    Keeping,
    /// Altered to this course, rad.
    Away(f64),
    /// Back on her course, own ship not yet far away.
    Past,
}

/// What a target owes own ship.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Owes {
    /// Whether she holds her course until that helps no more (Rule 17).
    stands_on: bool,
    way: Way,
    /// Found beyond the range of sight (Rule 19).
    by_radar: bool,
}

/// To which side she alters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// To starboard, so that own ship is left to port: Rules 14 and 15, and 19(d)(i).
    Starboard,
    /// To whichever side own ship is passed at the greater distance: Rule 13.
    Either,
    /// Away from own ship on this side (+1 starboard), abeam or abaft: Rule 19(d)(ii).
    AwayFrom(f64),
}

impl Duty {
    /// A target that has not met own ship yet.
    pub fn new(
        conduct: &Conduct,
        ship: &Ship,
        speed_mps: f64,
        visual_range_m: Option<f64>,
    ) -> Self {
        let velocity_mps = ship.pose.velocity_mps;
        let moves = velocity_mps.norm() > 0.0;
        let course_rad =
            if moves { geom::angle::direction(velocity_mps) } else { ship.state.psi_rad };
        // in calm water the course is the heading to the last bit
        let calm = ship.current_mps().norm_squared() <= 0.0;
        let course_rad = if calm { ship.state.psi_rad } else { wrap(course_rad) };
        let (conduct, phase) = (*conduct, Phase::Keeping);
        Self { conduct, course_rad, speed_mps, visual_range_m, owes: None, phase }
    }

    /// Gives the ship her order of the beat; `own` is absent where she does not react.
    pub fn steer(&mut self, ship: &mut Ship, t_s: f64, own: Option<&Pose>) {
        let before = self.phase;
        if let Some(own) = own {
            self.decide(ship, t_s, own);
        }
        let course_rad = match (before, self.phase) {
            (Phase::Keeping, Phase::Away(course_rad)) => course_rad,
            (Phase::Away(_), Phase::Past) => self.course_rad,
            _ => {
                if t_s <= 0.0 {
                    ship.hold(t_s);
                }
                return;
            }
        };
        ship.steer(Helm::over_ground(course_rad, self.speed_mps, ship.current_mps()), t_s);
    }

    /// Whether she does anything but keep her course because of own ship.
    pub(crate) fn has_reacted(&self) -> bool {
        self.phase != Phase::Keeping
    }

    fn decide(&mut self, ship: &Ship, t_s: f64, own: &Pose) {
        let offset_m = own.position_m - ship.pose.position_m;
        let relative_mps = own.velocity_mps - ship.pose.velocity_mps;
        let now = cpa(offset_m, relative_mps);
        let left_s = now.tcpa_s.filter(|tcpa_s| *tcpa_s > 0.0).map(|tcpa_s| {
            // her bow is there before she is
            tcpa_s - 0.5 * ship.outline.length_m / relative_mps.norm()
        });
        match self.phase {
            Phase::Keeping => {
                let Some(left_s) = left_s else { return };
                if now.dcpa_m > self.conduct.risk_dcpa_m {
                    return;
                }
                let owes = self.owes(ship, own);
                if t_s >= WATCHES_S && self.is_due(owes, left_s, now.dcpa_m) {
                    let change_rad = self.change_rad(ship, own, owes.way);
                    let away = |change_rad: f64| Phase::Away(wrap(self.course_rad + change_rad));
                    self.phase = change_rad.map_or(Phase::Keeping, away);
                }
            }
            Phase::Away(course_rad) => {
                if left_s.is_none() && self.may_go_back(ship, own, course_rad) {
                    self.phase = Phase::Past;
                }
            }
            Phase::Past => {
                if offset_m.norm() > CLEAR_PER_RISK * self.conduct.risk_dcpa_m {
                    (self.phase, self.owes) = (Phase::Keeping, None);
                }
            }
        }
    }

    /// What she owes, found once for those in sight and once for those that are not.
    fn owes(&mut self, ship: &Ship, own: &Pose) -> Owes {
        let range_m = (own.position_m - ship.pose.position_m).norm();
        let by_radar = self.visual_range_m.is_some_and(|visual_range_m| range_m > visual_range_m);
        let kept = self.owes.filter(|owes| owes.by_radar == by_radar);
        *self.owes.insert(kept.unwrap_or_else(|| owed(ship, own, by_radar)))
    }

    /// Whether the time to act has come.
    fn is_due(&self, owes: Owes, left_s: f64, dcpa_m: f64) -> bool {
        let Conduct { manner, act_tcpa_s, stand_on_tcpa_s, stand_on_dcpa_m, .. } = self.conduct;
        match manner {
            Manner::Neglects => false,
            Manner::WrongWay => left_s <= act_tcpa_s,
            Manner::Complies if owes.stands_on => {
                left_s <= stand_on_tcpa_s && dcpa_m <= stand_on_dcpa_m
            }
            Manner::Complies => left_s <= act_tcpa_s,
        }
    }

    /// By how much she alters, rad, positive to starboard; absent where no alteration helps.
    fn change_rad(&self, ship: &Ship, own: &Pose, way: Way) -> Option<f64> {
        let (least_rad, risk_m) = (self.conduct.course_change_rad, self.conduct.risk_dcpa_m);
        let turning = self.turning(ship, self.course_rad);
        let passes = |change_rad: f64| (change_rad, turning.passage(change_rad, own));
        if self.conduct.manner == Manner::WrongWay {
            return Some(match way {
                Way::Starboard => -least_rad,
                Way::AwayFrom(side) => side * least_rad,
                Way::Either => nearer(passes(least_rad), passes(-least_rad)).0,
            });
        }
        let mut best: Option<(f64, Passage)> = None;
        let mut size_rad = least_rad;
        loop {
            let found = match way {
                Way::Starboard => passes(size_rad),
                Way::AwayFrom(side) => passes(-side * size_rad),
                Way::Either => farther(passes(size_rad), passes(-size_rad)),
            };
            let is_right = |passage: &Passage| way != Way::Starboard || passage.to_port;
            if is_right(&found.1) && found.1.dcpa_m >= risk_m {
                return Some(found.0);
            }
            let better = best.is_none_or(|(_, best)| {
                let rank = |p: &Passage| (is_right(p), p.dcpa_m);
                rank(&found.1) > rank(&best)
            });
            if better {
                best = Some(found);
            }
            size_rad += MORE_RAD;
            if size_rad > MOST_RAD {
                break;
            }
        }
        let keeping = turning.passage(0.0, own);
        best.filter(|(_, passage)| passage.dcpa_m > keeping.dcpa_m)
            .map(|(change_rad, _)| change_rad)
    }

    /// Whether own ship passes no nearer than she is, or than what is no risk, on the old course.
    fn may_go_back(&self, ship: &Ship, own: &Pose, course_rad: f64) -> bool {
        /// What the prediction may be out by.
        const NEARER: f64 = 0.95;
        let range_m = (own.position_m - ship.pose.position_m).norm();
        let back = self.turning(ship, course_rad).passage(wrap(self.course_rad - course_rad), own);
        back.dcpa_m >= NEARER * range_m.min(self.conduct.risk_dcpa_m)
    }

    fn turning(&self, ship: &Ship, course_rad: f64) -> Turning {
        Turning {
            position_m: ship.pose.position_m,
            course_rad,
            speed_mps: self.speed_mps,
            yaw_rate_radps: ship.model.limits().yaw_rate_radps_max,
        }
    }
}

/// An alteration, rad, and what it leads to.
type Choice = (f64, Passage);

fn farther(starboard: Choice, port: Choice) -> Choice {
    if port.1.dcpa_m > starboard.1.dcpa_m { port } else { starboard }
}

fn nearer(starboard: Choice, port: Choice) -> Choice {
    if starboard.1.dcpa_m < port.1.dcpa_m { starboard } else { port }
}

/// What a ship owes own ship by how they lie to one another (Rules 13 to 15 and 17 in sight, 19
/// by radar).
fn owed(ship: &Ship, own: &Pose, by_radar: bool) -> Owes {
    let own_psi_rad = geom::angle::direction(own.heading);
    let offset_m: Vec2 = own.position_m - ship.pose.position_m;
    let lie = Relative::new(Vec2::zeros(), ship.state.psi_rad, offset_m, own_psi_rad);
    let sector = HeadOnSector::wide(HEAD_ON_HALF_ANGLE_RAD);
    let class = if own.velocity_mps.norm() < MOVING_MPS_MIN {
        EncounterClass::Static
    } else {
        classify(lie.beta_rad, lie.alpha_rad, sector)
    };
    let (stands_on, way) = match class {
        EncounterClass::Overtaking | EncounterClass::Static => (false, Way::Either),
        _ if by_radar && lie.beta_rad.abs() >= FRAC_PI_2 => {
            (false, Way::AwayFrom(if lie.beta_rad < 0.0 { -1.0 } else { 1.0 }))
        }
        _ if by_radar => (false, Way::Starboard),
        EncounterClass::HeadOn | EncounterClass::CrossingStbd => (false, Way::Starboard),
        // Rule 17(c): not to port for a ship on her port side
        EncounterClass::CrossingPort => (true, Way::Starboard),
        EncounterClass::Overtaken => (true, Way::Either),
    };
    Owes { stands_on, way, by_radar }
}
