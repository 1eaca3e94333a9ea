//! Whether an encounter can be run at all.

use crate::approach::Approach;
use crate::hazard::Hazards;
use crate::interval::Hulls;
use crate::vessel::{known_models, limits};
use crate::weather::Environment;
use geom::polygon::{self, PolygonFault};
use geom::{HullOutline, Vec2};
use record::{
    AisRadar, Encounter, Fluctuation, Intent, Motion, Sensing, Turn, Vessel, Waypoint, Weather,
};

/// What is wrong with an encounter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// No parameter set has this name.
    #[error("{ship} is a `{name}`, which is no known model; there are {known}")]
    UnknownModel {
        /// Which ship.
        ship: String,
        /// The name.
        name: String,
        /// Those there are.
        known: String,
    },
    /// A number that is not finite or not in its range.
    #[error("{what} is {value}; it must be {range}")]
    OutOfRange {
        /// Which number.
        what: String,
        /// Its value.
        value: f64,
        /// Where it must lie.
        range: &'static str,
    },
    /// Nothing to meet.
    #[error("there is no target and no hazard")]
    NothingToMeet,
    /// More targets than an index can name.
    #[error("there are {0} targets; at most 255 can be told apart")]
    TooManyTargets(usize),
    /// Own ship has nowhere to go.
    #[error("own ship has no waypoint; give her a goal")]
    NoRoute,
    /// The beat is not a whole number of steps.
    #[error("the step of {step_s} s does not divide the beat of {beat_s} s")]
    StepDoesNotDivideBeat {
        /// Step.
        step_s: f64,
        /// Beat.
        beat_s: f64,
    },
    /// Hulls overlap at the start.
    #[error("own ship and target {0} overlap at the start")]
    Overlap(usize),
    /// Turns that are not in the order of time.
    #[error("turn {turn} of target {target} comes before the one before it")]
    TurnsOutOfOrder {
        /// Index of the target.
        target: usize,
        /// Index of the turn.
        turn: usize,
    },
    /// More hazards than an index can name.
    #[error("there are {0} hazards; at most 255 can be told apart")]
    TooManyHazards(usize),
    /// A hazard that is no simple polygon.
    #[error("hazard {hazard}: {fault}")]
    NoPolygon {
        /// Index.
        hazard: usize,
        /// What is wrong with it.
        fault: PolygonFault,
    },
    /// Own ship lies on a hazard at the start.
    #[error("own ship touches hazard {0} at the start")]
    Aground(usize),
}

/// Checks an encounter; [`crate::run`] gives `Outcome::Invalid` for what fails here.
pub fn check(encounter: &Encounter) -> Result<(), SetupError> {
    let Encounter { own, targets, hazards, run, .. } = encounter;
    if targets.is_empty() && hazards.is_empty() {
        return Err(SetupError::NothingToMeet);
    }
    if targets.len() > usize::from(u8::MAX) {
        return Err(SetupError::TooManyTargets(targets.len()));
    }
    if hazards.len() > usize::from(u8::MAX) {
        return Err(SetupError::TooManyHazards(hazards.len()));
    }
    for (hazard, corners) in hazards.iter().enumerate() {
        if let Some(fault) = polygon::fault(corners) {
            return Err(SetupError::NoPolygon { hazard, fault });
        }
    }
    if own.route.is_empty() {
        return Err(SetupError::NoRoute);
    }
    positive("the step", run.step_s)?;
    positive("the beat", run.beat_s)?;
    positive("the longest duration", run.duration_s_max)?;
    not_negative("the safety radius", encounter.safety_radius_m)?;
    not_negative("the cruise speed", own.cruise_mps)?;
    finite("the current", encounter.weather.current_mps)?;
    check_weather(&encounter.weather)?;
    if let Sensing::AisRadar(sensing) = &encounter.sensing {
        check_sensing(sensing, run.beat_s)?;
    }
    let steps = run.beat_s / run.step_s;
    if (steps - steps.round()).abs() > 1e-9 * steps || steps.round() < 1.0 {
        let (step_s, beat_s) = (run.step_s, run.beat_s);
        return Err(SetupError::StepDoesNotDivideBeat { step_s, beat_s });
    }
    check_ship("own ship", &own.hull, &own.vessel, &own.start)?;
    check_route("own ship", &own.route)?;
    for (index, target) in targets.iter().enumerate() {
        let name = format!("target {index}");
        check_ship(&name, &target.hull, &target.vessel, &target.start)?;
        check_intent(index, &name, &target.intent)?;
    }
    check_apart(encounter)
}

fn check_ship(
    ship: &str,
    hull: &HullOutline,
    vessel: &Vessel,
    start: &Motion,
) -> Result<(), SetupError> {
    positive(&format!("the length of {ship}"), hull.length_m)?;
    positive(&format!("the beam of {ship}"), hull.beam_m)?;
    let reference = Vec2::new(hull.midships_forward_m, hull.midships_starboard_m);
    finite(&format!("the reference point of {ship}"), reference)?;
    finite(&format!("the position of {ship}"), start.position_m)?;
    finite(&format!("the heading of {ship}"), Vec2::new(start.psi_rad, 0.0))?;
    not_negative(&format!("the speed of {ship}"), start.speed_mps)?;
    if let Vessel::Kinematic { yaw_rate_radps_max, acceleration_mps2_max, speed_mps_max } = vessel {
        positive(&format!("the turn rate of {ship}"), *yaw_rate_radps_max)?;
        positive(&format!("the acceleration of {ship}"), *acceleration_mps2_max)?;
        not_negative(&format!("the largest speed of {ship}"), *speed_mps_max)?;
    }
    let Some(limits) = limits(vessel) else {
        let Vessel::Model(name) = vessel else { unreachable!("kinematic vessels have limits") };
        let known: Vec<&str> = known_models().collect();
        let (ship, name, known) = (ship.to_owned(), name.clone(), known.join(", "));
        return Err(SetupError::UnknownModel { ship, name, known });
    };
    // room for the conversion from knots
    if start.speed_mps > limits.speed_mps_max * (1.0 + 1e-9) {
        let what = format!("the speed of {ship}");
        let range = "at most the largest speed of her model";
        return Err(SetupError::OutOfRange { what, value: start.speed_mps, range });
    }
    Ok(())
}

fn check_intent(index: usize, name: &str, intent: &Intent) -> Result<(), SetupError> {
    match intent {
        Intent::HoldCourse => Ok(()),
        Intent::Track(waypoints) => check_route(name, waypoints),
        Intent::Alter { at_s, course_rad, speed_mps } => {
            finite(&format!("the alteration of {name}"), Vec2::new(*at_s, *course_rad))?;
            not_negative(&format!("the new speed of {name}"), *speed_mps)
        }
        Intent::Turns(turns) => check_turns(index, name, turns),
        Intent::Duty(conduct) => {
            positive(&format!("the time to act of {name}"), conduct.act_tcpa_s)?;
            positive(&format!("the distance of risk of {name}"), conduct.risk_dcpa_m)?;
            let stand_on = |what: &str| format!("the {what} of {name} standing on");
            positive(&stand_on("time to act"), conduct.stand_on_tcpa_s)?;
            positive(&stand_on("distance to act"), conduct.stand_on_dcpa_m)?;
            positive(&format!("the alteration of {name}"), conduct.course_change_rad)
        }
        // whether there is a planner of this name is for the registry to say
        Intent::Planner(_) => Ok(()),
    }
}

fn check_weather(weather: &Weather) -> Result<(), SetupError> {
    let noise = |what: &str, noise: &Fluctuation| {
        not_negative(&format!("the strength of {what}"), noise.sd_mps)?;
        positive(&format!("the time constant of {what}"), noise.time_constant_s)
    };
    if let Some(current) = &weather.current_noise {
        noise("the current's noise", current)?;
    }
    if let Some(wind) = &weather.wind {
        finite("the wind", wind.velocity_mps)?;
        noise("gusts", &wind.gusts)?;
        not_negative("leeway", wind.leeway)?;
    }
    if let Some(waves) = &weather.waves {
        finite("the drift by waves", waves.drift_mps)?;
        let drift =
            Fluctuation { sd_mps: waves.drift_sd_mps, time_constant_s: waves.time_constant_s };
        noise("waves", &drift)?;
        not_negative("the yaw by waves", waves.yaw_rate_sd_radps)?;
        positive("the reference length of waves", waves.length_m_ref)?;
    }
    Ok(())
}

fn check_sensing(sensing: &AisRadar, beat_s: f64) -> Result<(), SetupError> {
    let share = |what: &str, value: f64| {
        let ok = (0.0..=1.0).contains(&value);
        if ok { Ok(()) } else { Err(out_of_range(what, value, "from 0 to 1")) }
    };
    if let Some(ais) = &sensing.ais {
        share("the share of ships with AIS", ais.carried)?;
        share("the share of lost AIS reports", ais.dropout)?;
        share("the share of wrong dimensions", ais.static_wrong)?;
        share("the share of dimensions", ais.static_wrong + ais.static_missing)?;
        not_negative("the error of AIS positions", ais.position_sd_m)?;
        not_negative("the error of AIS speeds", ais.sog_sd_mps)?;
        not_negative("the error of AIS courses", ais.cog_sd_rad)?;
        not_negative("the error of AIS headings", ais.heading_sd_rad)?;
        not_negative("the delay of first reports", ais.first_delay_s_mean)?;
        not_negative("the latency of AIS", ais.latency_s)?;
    }
    if let Some(radar) = &sensing.radar {
        if !(radar.rotation_s >= beat_s && radar.rotation_s.is_finite()) {
            let range = "finite and at least the beat";
            return Err(out_of_range("the turn of the radar", radar.rotation_s, range));
        }
        share("the probability of a plot", radar.detection_probability)?;
        not_negative("the error of radar ranges", radar.range_sd_m)?;
        not_negative("the error of radar bearings", radar.bearing_sd_rad)?;
        positive("the range of half the radar's probability", radar.range_m_half)?;
        positive("the range of the radar", radar.range_m_max)?;
        if !(0.0..=50.0).contains(&radar.clutter_per_scan) {
            return Err(out_of_range("the clutter", radar.clutter_per_scan, "from 0 to 50"));
        }
        not_negative("the range of clutter", radar.clutter_range_m)?;
        not_negative("the latency of the radar", radar.latency_s)?;
    }
    let tracker = &sensing.tracker;
    positive("the tracker's acceleration", tracker.acceleration_sd_mps2)?;
    positive("the tracker's speed", tracker.speed_sd_mps)?;
    positive("the tracker's gate", tracker.gate)?;
    positive("the longest time without a plot", tracker.radar_coast_s_max)?;
    positive("the longest time without a report", tracker.ais_coast_s_max)?;
    share("the share of dropped frames", tracker.frame_drop)?;
    let (hits, scans) = (tracker.confirm_hits, tracker.confirm_scans);
    if hits == 0 || hits > scans || scans > 32 {
        let range = "from 1 to the number of scans, which is at most 32";
        return Err(out_of_range("the plots that confirm", f64::from(hits), range));
    }
    Ok(())
}

fn check_turns(target: usize, name: &str, turns: &[Turn]) -> Result<(), SetupError> {
    for turn in turns {
        finite(&format!("a turn of {name}"), Vec2::new(turn.at_s, turn.course_rad))?;
    }
    match turns.windows(2).position(|pair| pair[1].at_s < pair[0].at_s) {
        Some(before) => Err(SetupError::TurnsOutOfOrder { target, turn: before + 1 }),
        None => Ok(()),
    }
}

fn check_route(ship: &str, route: &[Waypoint]) -> Result<(), SetupError> {
    for waypoint in route {
        finite(&format!("a waypoint of {ship}"), waypoint.position_m)?;
        if let Some(speed_mps) = waypoint.speed_mps {
            not_negative(&format!("the speed at a waypoint of {ship}"), speed_mps)?;
        }
    }
    Ok(())
}

fn check_apart(encounter: &Encounter) -> Result<(), SetupError> {
    let ships = Environment::new(encounter).ships(encounter);
    let (own, targets) = ships.expect("the models were checked before");
    for (index, target) in targets.iter().enumerate() {
        let hulls = Hulls { own: &own.hull, target: &target.hull };
        if Approach::new(1.0, hulls, &own.pose, &target.pose).overlaps() {
            return Err(SetupError::Overlap(index));
        }
    }
    for (index, corners) in encounter.hazards.iter().enumerate() {
        let touches = Hazards::new(std::slice::from_ref(corners), &own).least_m() <= Some(0.0);
        if touches || polygon::contains(corners, own.pose.position_m) {
            return Err(SetupError::Aground(index));
        }
    }
    Ok(())
}

fn out_of_range(what: &str, value: f64, range: &'static str) -> SetupError {
    SetupError::OutOfRange { what: what.to_owned(), value, range }
}

fn positive(what: &str, value: f64) -> Result<(), SetupError> {
    let ok = value.is_finite() && value > 0.0;
    if ok { Ok(()) } else { Err(out_of_range(what, value, "finite and above 0")) }
}

fn not_negative(what: &str, value: f64) -> Result<(), SetupError> {
    let ok = value.is_finite() && value >= 0.0;
    if ok { Ok(()) } else { Err(out_of_range(what, value, "finite and at least 0")) }
}

fn finite(what: &str, value: Vec2) -> Result<(), SetupError> {
    match [value.x, value.y].into_iter().find(|v| !v.is_finite()) {
        Some(value) => Err(out_of_range(what, value, "finite")),
        None => Ok(()),
    }
}
