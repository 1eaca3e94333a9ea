//! `kuwata-vo`: velocity obstacles with the regions that the rules forbid, after Kuwata, Wolf,
//! Zarzhitsky & Huntsberger 2014 (IEEE J. Oceanic Eng. 39(1):110-119).
//!
//! Head-on, overtaking and crossing from starboard forbid V1, the velocities that pass with the
//! target on own starboard hand; crossing from port and being overtaken forbid none. A rule is
//! chosen when the target first fails the pre-collision check and stays until it is passed or
//! has failed to be a danger for a while (hysteresis). The paper's text was not available: the
//! regions were checked against a public re-implementation, the term in tau is from memory, and
//! the penalties 1000 and 100 are the re-implementation's.

use super::plain::{check_grid, check_positive};
use super::{cone::Cone, grid::Grid};
use crate::clearance::{Clearance, RadiusKind, UNKNOWN_LENGTH_M};
use crate::guidance::Guidance;
use geom::{EncounterClass, HeadOnSector, Relative, Vec2, classify, cpa, units::deg};
use planner_api::{Command, Mission, OwnState, Planner, Situation, TargetTrack};
use serde::{Deserialize, Serialize};

/// Counts a hit at once as one after this many seconds.
const TAU_FLOOR_S: f64 = 0.1;

/// Its options.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KuwataOptions {
    /// Pre-collision check: time to CPA at most this, seconds. 60 in the re-implementation, for
    /// boats of a few metres and d_min = 20 m; scaled here to a safety radius of 150 m.
    pub t_max_s: f64,
    /// Pre-collision check: distance at CPA at most R plus this, metres.
    pub d_min_beyond_radius_m: f64,
    /// A disc that is met later than this does not count, seconds.
    pub horizon_s: f64,
    /// Total width of the head-on box, degrees (re-implementation: 30).
    pub head_on_width_deg: f64,
    /// A rule goes on for this long after the target stopped being a danger, seconds.
    pub hysteresis_s: f64,
    /// Cost of a velocity inside an obstacle (re-implementation: 1000), (m/s)^2.
    pub vo_penalty: f64,
    /// Cost of a velocity that a rule forbids (re-implementation: 100), (m/s)^2.
    pub rule_penalty: f64,
    /// Weight of 1/tau, tau being the time to the disc; (m/s)^2 times seconds.
    pub tau_weight: f64,
    /// R grows by this many standard deviations of the track's position.
    pub sigmas: f64,
    /// Courses lie within this of the wish, degrees (re-implementation: 120).
    pub course_deg_max: f64,
    /// Step of the courses, degrees (re-implementation: 2.5).
    pub course_step_deg: f64,
    /// Step of the speeds, m/s (re-implementation: 0.5).
    pub speed_step_mps: f64,
    /// What R is.
    pub radius: RadiusKind,
    /// Added to R, metres (re-implementation: 15).
    pub buffer_m: f64,
    /// Length, metres, of a target that does not report one.
    pub unknown_length_m: f64,
}

impl Default for KuwataOptions {
    fn default() -> Self {
        Self {
            t_max_s: 180.0,
            d_min_beyond_radius_m: 50.0,
            horizon_s: 180.0,
            head_on_width_deg: 30.0,
            hysteresis_s: 10.0,
            vo_penalty: 1000.0,
            rule_penalty: 100.0,
            tau_weight: 100.0,
            sigmas: 2.0,
            course_deg_max: 120.0,
            course_step_deg: 2.5,
            speed_step_mps: 0.5,
            radius: RadiusKind::Mission,
            buffer_m: 15.0,
            unknown_length_m: UNKNOWN_LENGTH_M,
        }
    }
}

impl KuwataOptions {
    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        check_grid(self.course_deg_max, self.course_step_deg, self.speed_step_mps)?;
        check_positive("t_max_s", self.t_max_s)?;
        check_positive("horizon_s", self.horizon_s)?;
        check_positive("vo_penalty", self.vo_penalty)?;
        check_positive("rule_penalty", self.rule_penalty)
    }
}

/// A rule in force for one target.
#[derive(Clone, Copy, Debug)]
struct RuleInForce {
    id: u32,
    class: EncounterClass,
    danger_until_s: f64,
}

/// A target in velocity space, with R in metres.
#[derive(Clone, Copy, Debug)]
struct Seen {
    cone: Cone,
    radius_m: f64,
}

/// The planner.
#[derive(Clone, Debug)]
pub struct KuwataVo {
    options: KuwataOptions,
    guidance: Guidance,
    grid: Grid,
    clearance: Option<Clearance>,
    rules: Vec<RuleInForce>,
    cones: Vec<(Cone, bool)>,
}

impl KuwataVo {
    /// With these parameters.
    pub fn new(options: KuwataOptions) -> Self {
        let KuwataOptions { course_deg_max, course_step_deg, speed_step_mps, .. } = options;
        Self {
            options,
            guidance: Guidance::default(),
            grid: Grid::new(course_deg_max, course_step_deg, speed_step_mps),
            clearance: None,
            rules: Vec::new(),
            cones: Vec::new(),
        }
    }

    /// Whether V1 of this target is forbidden now; begins and ends its rule.
    fn forbids_v1(
        &mut self,
        t_s: f64,
        own: &OwnState,
        wish_mps: Vec2,
        track: &TargetTrack,
        seen: Seen,
    ) -> bool {
        // the wish counts too: while own ship avoids, her own velocity is no danger
        let danger = [own.velocity_mps, wish_mps].into_iter().any(|v| self.is_danger(v, seen));
        let approach = cpa(seen.cone.los_m, track.velocity_mps - own.velocity_mps);
        let past = approach.tcpa_s.is_some_and(|t| t < 0.0);
        let passed = past && seen.cone.los_m.norm() > seen.radius_m;
        let known = self.rules.iter().position(|rule| rule.id == track.id);
        let until_s = t_s + self.options.hysteresis_s;
        match known {
            Some(i) if danger => self.rules[i].danger_until_s = until_s,
            Some(i) if passed || t_s > self.rules[i].danger_until_s => {
                self.rules.remove(i);
                return false;
            }
            Some(_) => {}
            None if danger => {
                let class = self.class(own, track);
                self.rules.push(RuleInForce { id: track.id, class, danger_until_s: until_s });
            }
            None => return false,
        }
        let class = self.rules.iter().find(|rule| rule.id == track.id).map(|rule| rule.class);
        matches!(
            class,
            Some(
                EncounterClass::HeadOn | EncounterClass::Overtaking | EncounterClass::CrossingStbd
            )
        )
    }

    /// The pre-collision check, and every disc that the search will count: or a velocity could be
    /// avoided before there is a rule for it.
    fn is_danger(&self, velocity_mps: Vec2, Seen { cone, radius_m }: Seen) -> bool {
        let approach = cpa(cone.los_m, cone.velocity_mps - velocity_mps);
        let in_time = approach.tcpa_s.is_some_and(|t| (0.0..=self.options.t_max_s).contains(&t));
        let near = approach.dcpa_m <= radius_m + self.options.d_min_beyond_radius_m;
        let hits = cone.time_to_hit_s(velocity_mps).is_some_and(|t| t <= self.options.horizon_s);
        (in_time && near) || hits
    }

    fn class(&self, own: &OwnState, track: &TargetTrack) -> EncounterClass {
        let psi_rad = track.psi_rad.unwrap_or(track.cog_rad);
        let pose = Relative::new(own.position_m, own.psi_rad, track.position_m, psi_rad);
        let sector = HeadOnSector::wide(deg(0.5 * self.options.head_on_width_deg));
        classify(pose.beta_rad, pose.alpha_rad, sector)
    }
}

impl Planner for KuwataVo {
    fn reset(&mut self, mission: &Mission) {
        let KuwataOptions { radius, unknown_length_m, buffer_m, .. } = self.options;
        let clearance = Clearance::new(mission, radius, unknown_length_m).widened(buffer_m);
        self.clearance = Some(clearance);
        self.guidance.reset(mission);
        self.grid.reset(mission.own.speed_mps_max);
        self.rules.clear();
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let own = &situation.own;
        let clearance = self.clearance.expect("reset comes before the first beat");
        let wish = self.guidance.wish(own.position_m);
        let mut cones = std::mem::take(&mut self.cones);
        cones.clear();
        for track in situation.tracks {
            let cone = Cone::new(own.position_m, track, clearance, self.options.sigmas);
            let seen = Seen { cone, radius_m: clearance.radius_m(track) };
            let wish_mps = wish.velocity_mps();
            cones.push((cone, self.forbids_v1(situation.t_s, own, wish_mps, track, seen)));
        }
        let options = &self.options;
        let velocity_mps = self.grid.cheapest(wish.velocity_mps(), wish.direction, |v| {
            let mut tau_s = f64::INFINITY;
            let mut forbidden = false;
            for (cone, forbids_v1) in &cones {
                tau_s = tau_s.min(cone.time_to_hit_s(v).unwrap_or(f64::INFINITY));
                forbidden |= *forbids_v1 && cone.keeps_target_to_starboard(v);
            }
            let rule = if forbidden { options.rule_penalty } else { 0.0 };
            if tau_s > options.horizon_s {
                return rule;
            }
            rule + options.vo_penalty + options.tau_weight / tau_s.max(TAU_FLOOR_S)
        });
        self.cones = cones;
        Command::velocity(velocity_mps)
    }

    fn head_on_sector(&self) -> Option<HeadOnSector> {
        Some(HeadOnSector::wide(deg(0.5 * self.options.head_on_width_deg)))
    }
}
