//! One ship of a DNV traffic situation; see [`crate::dnv`] for how the schema is read.

use crate::RunSettings;
use crate::dnv::SituationSettings;
use crate::geographic::{Geographic, TangentPlane};
use crate::json::{Node, Wrong};
use crate::limits::ScaledLimits;
use geom::units::{deg, knots};
use geom::{HullOutline, Vec2, angle, wrap};
use record::{Intent, Motion, OwnShip, Target, Vessel, Waypoint};

/// A ship as her file has her, in metres and radians.
#[derive(Clone, Debug)]
pub(crate) struct Ship {
    hull: HullOutline,
    scaled_limits: ScaledLimits,
    /// Fastest that she plans to be over ground.
    planned_mps: f64,
    position_m: Vec2,
    speed_mps: f64,
    heading_rad: f64,
    course_rad: f64,
    route: Vec<Waypoint>,
}

/// No ship is faster; guards against a speed in the wrong unit.
const SPEED_KN_MAX: f64 = 100.0;
/// No ship is longer, metres.
const LENGTH_M_MAX: f64 = 500.0;
/// Lengths to bow and stern may differ from the stated sum by this, metres: they are AIS figures,
/// in whole metres.
const SUM_M_MAX: f64 = 1.0;

impl Ship {
    pub(crate) fn read(
        ship: &Node<'_>,
        plane: &TangentPlane,
        how: &SituationSettings,
    ) -> Result<Self, Wrong> {
        let waypoints = ship.need("waypoints")?;
        let waypoints_list = waypoints.list()?;
        let mut points = Vec::with_capacity(waypoints_list.len());
        for waypoint in &waypoints_list {
            let position_m = plane.position_m(geographic(&waypoint.need("position")?)?);
            points.push(Waypoint { position_m, speed_mps: leg_speed(waypoint)? });
        }
        let Some((first, route)) = points.split_first() else {
            return Err(waypoints.wrong("is empty; a ship needs at least one waypoint"));
        };
        let initial = ship.get("initial")?;
        let initial = Initial::read(initial.as_ref(), plane)?;
        let position_m = initial.position_m.unwrap_or(first.position_m);
        let speed_mps = initial
            .speed_mps
            .or_else(|| route.first().and_then(|next| next.speed_mps))
            .or(first.speed_mps)
            .ok_or_else(|| ship.wrong("has no speed: neither `initial.sog` nor a leg's `sog`"))?;
        let ahead = route
            .iter()
            .map(|waypoint| waypoint.position_m - position_m)
            .find(|way_m| way_m.norm() > 0.0)
            .map(angle::direction);
        let none = || {
            ship.wrong(
                "has no course: give `initial.heading` or `initial.cog`, or a second waypoint",
            )
        };
        let heading_rad = initial.heading_rad.or(initial.course_rad).or(ahead).ok_or_else(none)?;
        let course_rad = ahead.or(initial.course_rad).unwrap_or(heading_rad);
        let hull = hull(ship.get("static")?.as_ref(), how)?;
        let planned_mps =
            route.iter().filter_map(|waypoint| waypoint.speed_mps).fold(speed_mps, f64::max);
        let scaled_limits = how.scaled_limits;
        let route = if ahead.is_some() { route.to_vec() } else { Vec::new() };
        Ok(Self {
            hull,
            scaled_limits,
            planned_mps,
            position_m,
            speed_mps,
            heading_rad,
            course_rad,
            route,
        })
    }

    /// Motion through the water: what a ship must make good less the current. Where that changes
    /// nothing, the stated heading stays.
    fn start(&self, current_mps: Vec2) -> Motion {
        let position_m = self.position_m;
        let on_route = !self.route.is_empty();
        let kept_rad = if on_route { self.heading_rad } else { self.course_rad };
        if current_mps.norm() <= 0.0 {
            return Motion { position_m, psi_rad: kept_rad, speed_mps: self.speed_mps };
        }
        let water_mps = geom::unit(self.course_rad) * self.speed_mps - current_mps;
        let psi_rad = if on_route { self.heading_rad } else { angle::direction(water_mps) };
        Motion { position_m, psi_rad, speed_mps: water_mps.norm() }
    }

    /// A ship that goes against the current must make it good.
    fn vessel(&self, current_mps: Vec2) -> Vessel {
        self.scaled_limits.vessel(self.hull.length_m, self.planned_mps + current_mps.norm())
    }

    pub(crate) fn target(&self, current_mps: Vec2) -> Target {
        Target {
            hull: self.hull,
            vessel: self.vessel(current_mps),
            start: self.start(current_mps),
            intent: if self.route.is_empty() {
                Intent::HoldCourse
            } else {
                Intent::Track(self.route.clone())
            },
        }
    }

    /// Own ship; with one waypoint her goal lies ahead, as far as she comes in the whole run.
    pub(crate) fn own_ship(
        &self,
        current_mps: Vec2,
        run: &RunSettings,
    ) -> Result<OwnShip, &'static str> {
        let first_leg_mps = self.route.first().and_then(|waypoint| waypoint.speed_mps);
        let cruise_mps = first_leg_mps.unwrap_or(self.speed_mps);
        if cruise_mps <= 0.0 {
            return Err("does not move; own ship needs a planned speed");
        }
        let mut route = self.route.clone();
        if route.is_empty() {
            let way_m = cruise_mps * run.limits.duration_s_max;
            let position_m = self.position_m + geom::unit(self.course_rad) * way_m;
            route.push(Waypoint { position_m, speed_mps: None });
        }
        let vessel = self.vessel(current_mps);
        Ok(OwnShip { hull: self.hull, vessel, start: self.start(current_mps), route, cruise_mps })
    }
}

/// The state at the start, as far as it is stated.
#[derive(Default)]
struct Initial {
    position_m: Option<Vec2>,
    speed_mps: Option<f64>,
    course_rad: Option<f64>,
    heading_rad: Option<f64>,
}

impl Initial {
    fn read(initial: Option<&Node<'_>>, plane: &TangentPlane) -> Result<Self, Wrong> {
        let Some(initial) = initial else { return Ok(Self::default()) };
        let position = initial.get("position")?.map(|node| geographic(&node)).transpose()?;
        let direction = |key: &str| {
            let angle_deg = initial.number_at(key, 0.0, 360.0)?;
            Ok::<_, Wrong>(angle_deg.map(|angle_deg| wrap(deg(angle_deg))))
        };
        Ok(Self {
            position_m: position.map(|place| plane.position_m(place)),
            speed_mps: initial.number_at("sog", 0.0, SPEED_KN_MAX)?.map(knots),
            course_rad: direction("cog")?,
            heading_rad: direction("heading")?,
        })
    }
}

/// A position of the schema.
pub(crate) fn geographic(position: &Node<'_>) -> Result<Geographic, Wrong> {
    Ok(Geographic {
        // a plane at the poles has no east
        lat_deg: position.need("lat")?.number(-89.0, 89.0)?,
        lon_deg: position.need("lon")?.number(-180.0, 180.0)?,
    })
}

/// Planned speed on the leg that ends at `waypoint`, m/s.
fn leg_speed(waypoint: &Node<'_>) -> Result<Option<f64>, Wrong> {
    let Some(leg) = waypoint.get("leg")? else { return Ok(None) };
    if let Some(sog) = leg.get("data")?.map(|data| data.get("sog")).transpose()?.flatten() {
        return Ok(Some(knots(sog.need("value")?.number(0.0, SPEED_KN_MAX)?)));
    }
    Ok(leg.number_at("sog", 0.0, SPEED_KN_MAX)?.map(knots))
}

/// The outline, and what of the static data we cannot run.
fn hull(statics: Option<&Node<'_>>, how: &SituationSettings) -> Result<HullOutline, Wrong> {
    let mut hull = HullOutline::centred(0.0, 0.0);
    if let Some(statics) = statics {
        check_id(statics)?;
        if let Some(delay) = statics.get("initDelay")?
            && delay.number(0.0, f64::MAX)? > 0.0
        {
            return Err(delay.wrong("is a delayed start, which this reader does not know"));
        }
        if let Some(path) = statics.get("pathType")?
            && path.text()? == "bezier"
        {
            return Err(path.wrong("= \"bezier\" is not known; this reader follows straight legs"));
        }
        if let Some(dimensions) = statics.get("dimensions")? {
            (hull.length_m, hull.midships_forward_m) = extent(&dimensions, "length", "a", "b")?;
            (hull.beam_m, hull.midships_starboard_m) = extent(&dimensions, "width", "d", "c")?;
        }
    }
    if hull.length_m <= 0.0 {
        hull.length_m = how.length_m_if_unknown;
    }
    if hull.beam_m <= 0.0 {
        hull.beam_m = how.beam_per_length_if_unknown * hull.length_m;
    }
    Ok(hull)
}

/// A dimension and how far its middle lies from the reference point, towards `ahead`; zero where
/// nothing is stated.
fn extent(
    dimensions: &Node<'_>,
    whole: &str,
    ahead: &str,
    behind: &str,
) -> Result<(f64, f64), Wrong> {
    let stated_m = dimensions.number_at(whole, 0.0, LENGTH_M_MAX)?;
    let ahead_m = dimensions.number_at(ahead, 0.0, LENGTH_M_MAX)?;
    let behind_m = dimensions.number_at(behind, 0.0, LENGTH_M_MAX)?;
    let (Some(ahead_m), Some(behind_m)) = (ahead_m, behind_m) else {
        return Ok((stated_m.unwrap_or(0.0), 0.0));
    };
    let sum_m = ahead_m + behind_m;
    match stated_m {
        Some(stated_m) if (stated_m - sum_m).abs() > SUM_M_MAX => Err(dimensions.wrong(format!(
            "has {whole} = {stated_m}, but {ahead} + {behind} = {sum_m}; they must agree"
        ))),
        _ => Ok((stated_m.unwrap_or(sum_m), (ahead_m - behind_m) / 2.0)),
    }
}

/// An id is an integer or a UUID; a ship without one is as good as any.
fn check_id(statics: &Node<'_>) -> Result<(), Wrong> {
    let Some(id) = statics.get("id")? else { return Ok(()) };
    let is_uuid = |text: &str| {
        let groups: Vec<&str> = text.split('-').collect();
        groups.iter().map(|group| group.len()).eq([8, 4, 4, 4, 12])
            && groups.iter().all(|group| group.bytes().all(|b| b.is_ascii_hexdigit()))
    };
    if id.integer().is_some() || id.text().is_ok_and(is_uuid) {
        Ok(())
    } else {
        Err(id.wrong("must be an integer or a UUID"))
    }
}
