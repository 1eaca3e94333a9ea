//! Land, piers and shoals that the chart shows: obstacles at rest, of which every path has to keep
//! clear.

use super::path::Path;
use geom::{Vec2, polygon, segment_min_distance};
use planner_api::Mission;

/// A path is looked at for this long once own ship is steady on it, seconds: manoeuvres near land
/// are short, and every beat looks again.
const AHEAD_S: f64 = 90.0;
/// A metre that lacks to the distance from land counts for as many metres that lack to a ship: land
/// gives no way.
const METRES_PER_METRE: f64 = 3.0;

/// The land about own ship.
#[derive(Clone, Debug, Default)]
pub struct Land {
    outlines: Vec<[Vec2; 2]>,
    route_m: Vec<Vec2>,
    /// What the route leaves of the distance to keep, metres; known from the first beat on.
    keep_m: Option<f64>,
    /// Edges that own ship can reach in time, relative to her, metres.
    near: Vec<[Vec2; 2]>,
    now_m: f64,
}

impl Land {
    /// Takes in the chart.
    pub fn reset(&mut self, mission: &Mission) {
        self.outlines.clear();
        self.outlines.extend(mission.hazards.iter().flat_map(|corners| polygon::edges(corners)));
        self.route_m.clear();
        self.route_m.extend(mission.route.iter().map(|waypoint| waypoint.position_m));
        self.keep_m = None;
        self.near.clear();
    }

    /// Looks around from here. `keep_m` is the distance to keep between land and the reference
    /// point, metres; where the route itself comes nearer, that will do.
    pub fn look(&mut self, own_m: Vec2, speed_mps_max: f64, keep_m: f64) {
        if self.outlines.is_empty() {
            return;
        }
        let keep_m = *self.keep_m.get_or_insert_with(|| {
            let mut from_m = own_m;
            self.route_m.iter().fold(keep_m, |least_m, &to_m| {
                let leg = [std::mem::replace(&mut from_m, to_m), to_m];
                self.outlines.iter().fold(least_m, |least_m, edge| least_m.min(apart_m(leg, *edge)))
            })
        });
        let reach_m = keep_m + speed_mps_max * 2.0 * AHEAD_S;
        self.now_m = f64::INFINITY;
        self.near.clear();
        for edge in &self.outlines {
            let relative = edge.map(|corner_m| corner_m - own_m);
            let (distance_m, _) = segment_min_distance(relative[0], relative[1]);
            self.now_m = self.now_m.min(distance_m);
            if distance_m < reach_m {
                self.near.push(relative);
            }
        }
    }

    /// Some land is near enough to be looked at.
    pub fn is_near(&self) -> bool {
        !self.near.is_empty()
    }

    /// What the path lacks to the distance from land, in metres as they count for a ship; 0 where
    /// it keeps it, or only leads away from land that is too near already.
    pub fn lack_m(&self, path: &Path) -> f64 {
        if self.near.is_empty() {
            return 0.0;
        }
        let keep_m = self.keep_m.unwrap_or(0.0).min(self.now_m);
        let nearest_m = path.legs(AHEAD_S).fold(f64::INFINITY, |least_m, leg| {
            self.near.iter().fold(least_m, |least_m, edge| least_m.min(apart_m(leg, *edge)))
        });
        (keep_m - nearest_m).max(0.0) * METRES_PER_METRE
    }
}

/// Distance between two segments, metres; 0 where they cross.
fn apart_m(a: [Vec2; 2], b: [Vec2; 2]) -> f64 {
    let side = |[from, to]: [Vec2; 2], at: Vec2| (to - from).perp(&(at - from));
    let parted = |line, ends: [Vec2; 2]| side(line, ends[0]) * side(line, ends[1]) < 0.0;
    if parted(a, b) && parted(b, a) {
        return 0.0;
    }
    let from = |at: Vec2, [from, to]: [Vec2; 2]| segment_min_distance(from - at, to - at).0;
    from(a[0], b).min(from(a[1], b)).min(from(b[0], a)).min(from(b[1], a))
}

#[cfg(test)]
mod tests {
    use super::super::path::{Agility, Trial};
    use super::*;
    use geom::units::deg;
    use planner_api::{OwnShip, OwnState, Waypoint};

    /// A quay 100 m to starboard of the route to the north, from 200 to 600 m ahead.
    fn land(from_own_m: f64) -> Land {
        let mut land = Land::default();
        land.reset(&Mission {
            own: OwnShip {
                length_m: 8.0,
                beam_m: 3.0,
                speed_mps_max: 12.0,
                yaw_rate_radps_max: 0.1,
                acceleration_mps2_max: 0.5,
            },
            route: vec![Waypoint { position_m: Vec2::new(2000.0, 0.0), speed_mps: None }],
            cruise_mps: 8.0,
            safety_radius_m: 50.0,
            between_centres: false,
            beat_s: 1.0,
            hazards: vec![vec![
                Vec2::new(200.0, from_own_m),
                Vec2::new(600.0, from_own_m),
                Vec2::new(600.0, from_own_m + 30.0),
                Vec2::new(200.0, from_own_m + 30.0),
            ]],
            stream_seed: 1,
        });
        land.look(Vec2::zeros(), 12.0, 40.0);
        land
    }

    fn path(course_deg: f64) -> Path {
        let agility = Agility { yaw_rate_radps: deg(3.0), acceleration_mps2: 0.3, lag_s: 0.0 };
        let own = OwnState::steady(Vec2::zeros(), deg(course_deg), 8.0);
        let mut path = Path::default();
        path.predict(&own, Trial { course_rad: deg(course_deg), speed_mps: 8.0 }, agility);
        path
    }

    #[test]
    fn a_path_lacks_what_it_takes_of_the_distance() {
        let land = land(100.0);
        assert!(land.lack_m(&path(0.0)) <= 0.0);
        // ends 720 sin(a) abeam after 720 m, beyond the quay's near end: 70 m, 30 m off
        let a_deg = geom::math::atan2(70.0, 600.0).to_degrees();
        let off_m = (100.0 - 70.0) * geom::math::cos(deg(a_deg));
        let lack_m = land.lack_m(&path(a_deg));
        assert!((lack_m - (40.0 - off_m) * METRES_PER_METRE).abs() < 1e-6, "{lack_m}");
        // onto it, and away from it
        assert!((land.lack_m(&path(30.0)) - 40.0 * METRES_PER_METRE).abs() < 1e-9);
        assert!(land.lack_m(&path(-90.0)) <= 0.0);
    }

    #[test]
    fn a_route_that_leaves_less_room_is_followed_all_the_same() {
        let land = land(15.0);
        assert!(land.lack_m(&path(0.0)) < 1e-9);
        assert!((land.lack_m(&path(2.0)) - 15.0 * METRES_PER_METRE).abs() < 1e-9);
    }
}
