//! `plain-vo`: velocity obstacles after Fiorini & Shiller 1998, blind to the rules.
//!
//! The control that should keep its distance and fail the rules. The grid of section 6.1 of the
//! seed planner's specification: the velocity nearest to the wish that meets no disc within the
//! horizon; where none is free, the one that meets it last.

use super::{cone::Cone, grid::Grid};
use crate::clearance::{Clearance, RadiusKind, UNKNOWN_LENGTH_M};
use crate::guidance::Guidance;
use planner_api::{Command, Mission, Planner, Situation};
use serde::{Deserialize, Serialize};

/// More than any squared distance between two candidates, (m/s)^2, so that a free one wins.
const HIT_PENALTY: f64 = 1e6;
/// Ranks what is not free by its time to the disc; (m/s)^2 times seconds.
const TIME_PENALTY: f64 = 1e6;
/// Counts a hit at once as one after this many seconds.
const TIME_FLOOR_S: f64 = 0.1;

/// Its options.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlainVoOptions {
    /// A disc that is met later than this does not count, seconds.
    pub horizon_s: f64,
    /// Courses lie within this of the wish, degrees (Fiorini & Shiller's grid in section 6.1: 90).
    pub course_deg_max: f64,
    /// Step of the courses, degrees (section 6.1: 2 to 3).
    pub course_step_deg: f64,
    /// Step of the speeds, m/s.
    pub speed_step_mps: f64,
    /// What R is.
    pub radius: RadiusKind,
    /// Added to R, metres: what the turn itself takes.
    pub buffer_m: f64,
    /// Length, metres, of a target that does not report one.
    pub unknown_length_m: f64,
}

impl Default for PlainVoOptions {
    fn default() -> Self {
        Self {
            horizon_s: 120.0,
            course_deg_max: 90.0,
            course_step_deg: 2.5,
            speed_step_mps: 0.5,
            radius: RadiusKind::Mission,
            buffer_m: 15.0,
            unknown_length_m: UNKNOWN_LENGTH_M,
        }
    }
}

impl PlainVoOptions {
    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        check_grid(self.course_deg_max, self.course_step_deg, self.speed_step_mps)?;
        check_positive("horizon_s", self.horizon_s)
    }
}

pub(crate) fn check_grid(max_deg: f64, step_deg: f64, step_mps: f64) -> Result<(), String> {
    if !(0.1..=180.0).contains(&step_deg) || !(0.0..=180.0).contains(&max_deg) {
        return Err(format!(
            "`course_step_deg` is {step_deg} and `course_deg_max` {max_deg}; they must be from 0.1 \
             and 0 to 180"
        ));
    }
    if !(0.01..=100.0).contains(&step_mps) {
        return Err(format!("`speed_step_mps` is {step_mps}; it must be from 0.01 to 100"));
    }
    Ok(())
}

pub(crate) fn check_positive(key: &str, value: f64) -> Result<(), String> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(format!("`{key}` is {value}; it must be above 0 and finite"))
}

/// The planner.
#[derive(Clone, Debug)]
pub struct PlainVo {
    options: PlainVoOptions,
    guidance: Guidance,
    grid: Grid,
    clearance: Option<Clearance>,
    cones: Vec<Cone>,
}

impl PlainVo {
    /// With these parameters.
    pub fn new(options: PlainVoOptions) -> Self {
        let PlainVoOptions { course_deg_max, course_step_deg, speed_step_mps, .. } = options;
        Self {
            options,
            guidance: Guidance::default(),
            grid: Grid::new(course_deg_max, course_step_deg, speed_step_mps),
            clearance: None,
            cones: Vec::new(),
        }
    }
}

impl Planner for PlainVo {
    fn reset(&mut self, mission: &Mission) {
        let PlainVoOptions { radius, unknown_length_m, buffer_m, .. } = self.options;
        let clearance = Clearance::new(mission, radius, unknown_length_m).widened(buffer_m);
        self.clearance = Some(clearance);
        self.guidance.reset(mission);
        self.grid.reset(mission.own.speed_mps_max);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let own_m = situation.own.position_m;
        let clearance = self.clearance.expect("reset comes before the first beat");
        let wish = self.guidance.wish(own_m);
        self.cones.clear();
        self.cones.extend(situation.tracks.iter().map(|t| Cone::new(own_m, t, clearance, 0.0)));
        let (cones, horizon_s) = (&self.cones, self.options.horizon_s);
        let velocity_mps = self.grid.cheapest(wish.velocity_mps(), wish.direction, |v| {
            let hits = cones.iter().filter_map(|cone| cone.time_to_hit_s(v));
            let first_s = hits.fold(f64::INFINITY, f64::min);
            if first_s > horizon_s {
                return 0.0;
            }
            HIT_PENALTY + TIME_PENALTY / first_s.max(TIME_FLOOR_S)
        });
        Command::velocity(velocity_mps)
    }
}
