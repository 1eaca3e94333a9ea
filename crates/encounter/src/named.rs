//! From a situation as a file has it to the encounter that it is: units, limits and what a missing
//! key means.

use crate::checks::{validate_hull, validate_vessel};
use crate::error::require;
use crate::hazard::{corners, validate_hazards};
use crate::limits::{Limits, either, positive, validate_either};
use crate::sample::own_vessel;
use crate::sensing::SensingSpec;
use crate::situation::{OwnAt, PlaceAt, SetIntent, SetSettings, SetTarget, Situation, TargetAt};
use crate::{Error, RunSettings};
use geom::units::{NAUTICAL_MILE_M, deg, knots};
use geom::{HullOutline, Vec2, wrap};
use record::{
    Encounter, EncounterId, Intent, Motion, OwnShip, Seed, Target, Visibility, Waypoint, Weather,
};

/// The encounters of a file, in its order. They carry seed 0; the campaign sets its own.
pub fn situations(
    set: &SetSettings,
    list: &[Situation],
    run: &RunSettings,
) -> Result<Vec<Encounter>, Error> {
    run.validate()?;
    let own = &set.own;
    validate_hull("set.own", own.length_m, own.beam_m)?;
    let limits = (own.limits.as_ref(), own.scaled_limits.as_ref());
    validate_vessel("set.own", &own.vessel, limits.0, limits.1)?;
    let target = &set.target;
    validate_either("set.target", target.limits.as_ref(), target.scaled_limits.as_ref())?;
    set.sensing.validate("set.sensing")?;
    let Some(first) = list.first() else {
        return Err(Error::spec("situation", "is missing; spell out at least one [[situation]]"));
    };
    let units = Units::of(first);
    let mut names: Vec<&str> = Vec::with_capacity(list.len());
    let mut encounters = Vec::with_capacity(list.len());
    for situation in list {
        let name = situation.name.as_str();
        require(
            !name.is_empty() && !names.contains(&name),
            || format!("situation.{name}"),
            || "needs a name of its own; names are strata and unique".to_owned(),
        )?;
        names.push(name);
        encounters.push(situation.encounter(set, units, run)?);
    }
    Ok(encounters)
}

/// The units of a whole file, as its first situation has them.
#[derive(Clone, Copy)]
struct Units {
    miles: bool,
    knots: bool,
}

impl Units {
    const fn of(first: &Situation) -> Self {
        Self { miles: first.own.north_nm.is_some(), knots: first.own.speed_kn.is_some() }
    }

    fn place(self, key: &str, m: [Option<f64>; 2], nm: [Option<f64>; 2]) -> Result<Vec2, Error> {
        let (given, unwanted, names, factor) = if self.miles {
            (nm, m, "north_nm and east_nm", NAUTICAL_MILE_M)
        } else {
            (m, nm, "north_m and east_m", 1.0)
        };
        match (given, unwanted) {
            ([Some(north), Some(east)], [None, None]) => {
                let place_m = Vec2::new(north, east) * factor;
                require(
                    north.is_finite() && east.is_finite(),
                    || key.to_owned(),
                    || format!("at ({north}, {east}) must have finite coordinates"),
                )?;
                Ok(place_m)
            }
            _ => Err(Error::spec(
                key,
                format!("must have {names} and no other unit, as the first own ship of the file"),
            )),
        }
    }

    fn speed(self, key: &str, mps: Option<f64>, kn: Option<f64>) -> Result<f64, Error> {
        let (given, unwanted, name) =
            if self.knots { (kn, mps, "speed_kn") } else { (mps, kn, "speed_mps") };
        match (given, unwanted) {
            (Some(speed), None) if speed.is_finite() && speed >= 0.0 => {
                Ok(if self.knots { knots(speed) } else { speed })
            }
            (Some(speed), None) => {
                Err(Error::spec(key, format!("has {name} = {speed}; it must be at least 0")))
            }
            _ => Err(Error::spec(
                key,
                format!("must have {name} and no other unit, as the first own ship of the file"),
            )),
        }
    }
}

impl Situation {
    fn encounter(
        &self,
        set: &SetSettings,
        units: Units,
        run: &RunSettings,
    ) -> Result<Encounter, Error> {
        let key = |what: &str| format!("situation.{}.{what}", self.name);
        let own = &self.own;
        let start = motion(units, &key("own"), own.place(), own.course_deg, own.speed())?;
        let limits = (set.own.limits.as_ref(), set.own.scaled_limits.as_ref());
        fast_enough(limits.0, start.speed_mps, &key("own"))?;
        let goal = &self.goal;
        let goal_m = units.place(
            &key("goal"),
            [goal.north_m, goal.east_m],
            [goal.north_nm, goal.east_nm],
        )?;
        let table = format!("situation.{}", self.name);
        let safety_radius_m = self.safety_radius_m.unwrap_or(run.safety_radius_m);
        positive(&table, "safety_radius_m", safety_radius_m)?;
        let run = RunSettings { safety_radius_m, ..*run };
        let detection_range_m = self.detection_range_m.or(set.sensing.detection_range_m);
        let sensing = SensingSpec { detection_range_m, ..set.sensing };
        sensing.validate(&table)?;
        validate_hazards(&format!("{table}.hazard"), self.hazard.as_ref())?;
        Ok(Encounter {
            id: EncounterId::new(self.name.as_str(), 0),
            seed: Seed(0),
            weight: 1.0,
            own: OwnShip {
                hull: HullOutline::centred(set.own.length_m, set.own.beam_m),
                vessel: own_vessel(&set.own.vessel, || {
                    either(limits.0, limits.1, set.own.length_m, start.speed_mps)
                }),
                start,
                route: vec![Waypoint { position_m: goal_m, speed_mps: None }],
                cruise_mps: start.speed_mps,
            },
            targets: self.targets(set, units, &run)?,
            hazards: self.hazard.iter().flatten().map(|p| corners(p, 0.0)).collect(),
            weather: Weather::default(),
            sensing: sensing.sensing(),
            visibility: Visibility::InSight,
            asked: None,
            safety_radius_m,
            distance: run.distance,
            run: run.limits,
        })
    }

    fn targets(
        &self,
        set: &SetSettings,
        units: Units,
        run: &RunSettings,
    ) -> Result<Vec<Target>, Error> {
        require(
            !self.targets.is_empty(),
            || format!("situation.{}.targets", self.name),
            || "is empty; an encounter needs at least one target".to_owned(),
        )?;
        let mut targets = Vec::with_capacity(self.targets.len());
        for (i, at) in self.targets.iter().enumerate() {
            let key = format!("situation.{}.targets.{}", self.name, i + 1);
            let target = at.target(&set.target, units, &key)?;
            fast_enough(set.target.limits.as_ref(), target.start.speed_mps, &key)?;
            run.validate_centre_radius(set.own.length_m, target.hull.length_m)?;
            targets.push(target);
        }
        Ok(targets)
    }
}

fn fast_enough(limits: Option<&Limits>, speed_mps: f64, key: &str) -> Result<(), Error> {
    let most_mps = limits.map_or(f64::INFINITY, |limits| limits.speed_mps_max);
    require(
        speed_mps <= most_mps,
        || key.to_owned(),
        || format!("makes {speed_mps} m/s, over her own limit of {most_mps}"),
    )
}

/// A place in both units; one of them is absent.
type PlaceKeys = [[Option<f64>; 2]; 2];

impl OwnAt {
    const fn place(&self) -> PlaceKeys {
        [[self.north_m, self.east_m], [self.north_nm, self.east_nm]]
    }

    const fn speed(&self) -> [Option<f64>; 2] {
        [self.speed_mps, self.speed_kn]
    }
}

impl TargetAt {
    fn target(&self, set: &SetTarget, units: Units, key: &str) -> Result<Target, Error> {
        let place = [[self.north_m, self.east_m], [self.north_nm, self.east_nm]];
        let speed = [self.speed_mps, self.speed_kn];
        let start = motion(units, key, place, self.course_deg, speed)?;
        let (Some(length_m), Some(beam_m)) =
            (self.length_m.or(set.length_m), self.beam_m.or(set.beam_m))
        else {
            return Err(Error::spec(
                key,
                "needs length_m and beam_m, here or for all targets in [set.target]",
            ));
        };
        validate_hull(key, length_m, beam_m)?;
        let limits = (set.limits.as_ref(), set.scaled_limits.as_ref());
        let intent = match self.intent.as_ref().unwrap_or(&set.intent) {
            SetIntent::HoldCourse => Intent::HoldCourse,
            SetIntent::Planner(name) => Intent::Planner(name.clone()),
            SetIntent::Track(places) => Intent::Track(track(units, key, places)?),
            SetIntent::Alter(alter) => Intent::Alter {
                at_s: alter.at_s,
                course_rad: wrap(deg(alter.course_deg)),
                speed_mps: alter.speed_mps.unwrap_or(start.speed_mps),
            },
        };
        Ok(Target {
            hull: HullOutline::centred(length_m, beam_m),
            vessel: either(limits.0, limits.1, length_m, start.speed_mps)
                .expect("a validated set has limits"),
            start,
            intent,
        })
    }
}

fn track(units: Units, key: &str, places: &[PlaceAt]) -> Result<Vec<Waypoint>, Error> {
    require(
        !places.is_empty(),
        || format!("{key}.intent.track"),
        || "is empty; it needs at least one place".to_owned(),
    )?;
    let waypoint = |(i, at): (usize, &PlaceAt)| {
        let key = format!("{key}.intent.track.{}", i + 1);
        let position_m = units.place(&key, [at.north_m, at.east_m], [at.north_nm, at.east_nm])?;
        let speed_mps = Some(units.speed(&key, at.speed_mps, at.speed_kn)?);
        Ok(Waypoint { position_m, speed_mps })
    };
    places.iter().enumerate().map(waypoint).collect()
}

fn motion(
    units: Units,
    key: &str,
    [m, nm]: PlaceKeys,
    course_deg: f64,
    [mps, kn]: [Option<f64>; 2],
) -> Result<Motion, Error> {
    require(
        (-360.0..=360.0).contains(&course_deg),
        || format!("{key}.course_deg"),
        || format!("= {course_deg} must be a course in degrees, from 0 to 360"),
    )?;
    Ok(Motion {
        position_m: units.place(key, m, nm)?,
        psi_rad: wrap(deg(course_deg)),
        speed_mps: units.speed(key, mps, kn)?,
    })
}
