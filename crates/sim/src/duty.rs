//! A target that meets own ship as the rules ask, or fails to: gives way early or late, neglects
//! her duty, or turns the wrong way.
//!
//! She knows own ship's motion exactly and decides once a beat on the same snapshot as everybody.
//! Her class is fixed at the first beat with risk (Rule 13(d): no later change of bearing makes
//! another vessel of her). She alters once, by a declared angle, keeps that course until the range
//! opens and her old course is clear, and goes back to it.

use crate::pose::Pose;
use crate::ship::Ship;
use crate::vessel::Helm;
use geom::{EncounterClass, HeadOnSector, Relative, Vec2, classify, cpa, units::deg, wrap};
use record::{Conduct, Manner};

/// Half-angle of the head-on sector in the eyes of a target: as the profiles for small craft have
/// it (13 degrees, the rules specification, section 2).
const HEAD_ON_HALF_ANGLE_RAD: f64 = deg(13.0);
/// Below this speed own ship is an obstacle, and a target keeps out of her way, m/s.
const MOVING_MPS_MIN: f64 = 0.2;

/// A target under a duty.
#[derive(Clone, Debug)]
pub struct Duty {
    conduct: Conduct,
    course_rad: f64,
    speed_mps: f64,
    /// Whether she will alter; known from the first beat with risk.
    acts: Option<bool>,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// On her course, watching.
    Keeping,
    /// Altered.
    Away,
    /// Back on her course for good.
    Past,
}

impl Duty {
    /// A target that has not met own ship yet.
    pub fn new(conduct: &Conduct, ship: &Ship, speed_mps: f64) -> Self {
        let velocity_mps = ship.pose.velocity_mps;
        let moves = velocity_mps.norm() > 0.0;
        let course_rad =
            if moves { geom::angle::direction(velocity_mps) } else { ship.state.psi_rad };
        // in calm water the course is the heading to the last bit
        let calm = ship.current_mps().norm_squared() <= 0.0;
        let course_rad = if calm { ship.state.psi_rad } else { wrap(course_rad) };
        Self { conduct: *conduct, course_rad, speed_mps, acts: None, phase: Phase::Keeping }
    }

    /// Gives the ship her order of the beat; `own` is absent where she does not react.
    pub fn steer(&mut self, ship: &mut Ship, t_s: f64, own: Option<&Pose>) {
        let before = self.phase;
        if let Some(own) = own {
            self.decide(ship, own);
        }
        if self.phase != before {
            let side = match self.conduct.manner {
                Manner::WrongWay => -1.0,
                Manner::Complies | Manner::Neglects => 1.0,
            };
            let away = self.phase == Phase::Away;
            let change_rad = if away { side * self.conduct.course_change_rad } else { 0.0 };
            let course_rad = wrap(self.course_rad + change_rad);
            ship.steer(Helm::over_ground(course_rad, self.speed_mps, ship.current_mps()), t_s);
        } else if t_s <= 0.0 {
            ship.hold(t_s);
        }
    }

    fn decide(&mut self, ship: &Ship, own: &Pose) {
        let Conduct { act_tcpa_s, risk_dcpa_m, .. } = self.conduct;
        let offset_m = own.position_m - ship.pose.position_m;
        let now = cpa(offset_m, own.velocity_mps - ship.pose.velocity_mps);
        let closes = now.tcpa_s.is_some_and(|tcpa_s| tcpa_s > 0.0);
        match self.phase {
            Phase::Keeping => {
                let tcpa_s = now.tcpa_s.unwrap_or(f64::INFINITY);
                if !closes || now.dcpa_m > risk_dcpa_m {
                    return;
                }
                let acts = *self.acts.get_or_insert_with(|| self.conduct.acts(ship, own));
                if acts && tcpa_s <= act_tcpa_s {
                    self.phase = Phase::Away;
                }
            }
            Phase::Away => {
                let old_mps = geom::unit(self.course_rad) * self.speed_mps;
                let back = cpa(offset_m, own.velocity_mps - old_mps);
                let clear = back.tcpa_s.is_none_or(|tcpa_s| tcpa_s <= 0.0);
                if !closes && clear {
                    self.phase = Phase::Past;
                }
            }
            Phase::Past => {}
        }
    }
}

/// What a conduct makes of a meeting.
trait Acts {
    fn acts(&self, ship: &Ship, own: &Pose) -> bool;
}

impl Acts for Conduct {
    fn acts(&self, ship: &Ship, own: &Pose) -> bool {
        match self.manner {
            Manner::Neglects => false,
            Manner::WrongWay => true,
            Manner::Complies => gives_way(ship, own),
        }
    }
}

/// Whether the ship must keep out of own ship's way (Rules 13 to 15).
fn gives_way(ship: &Ship, own: &Pose) -> bool {
    if own.velocity_mps.norm() < MOVING_MPS_MIN {
        return true;
    }
    let own_psi_rad = geom::angle::direction(own.heading);
    let offset_m: Vec2 = own.position_m - ship.pose.position_m;
    let lie = Relative::new(Vec2::zeros(), ship.state.psi_rad, offset_m, own_psi_rad);
    let sector = HeadOnSector::wide(HEAD_ON_HALF_ANGLE_RAD);
    match classify(lie.beta_rad, lie.alpha_rad, sector) {
        EncounterClass::HeadOn
        | EncounterClass::CrossingStbd
        | EncounterClass::Overtaking
        | EncounterClass::Static => true,
        EncounterClass::CrossingPort | EncounterClass::Overtaken => false,
    }
}
