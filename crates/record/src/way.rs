//! The way that a ship sailed to a row of places.

use crate::ShipTrack;
use geom::Vec2;

impl ShipTrack {
    /// Distance sailed up to the passage of the last place, and from there to it, metres. A place
    /// is passed where the ship comes nearest to it after the passage of the one before; one to
    /// which she is nearest at the end of her track is still ahead, and the rest of the way counts
    /// as straight. What she sails beyond the last place is no part of it.
    pub fn way_m(&self, places: &[Vec2]) -> f64 {
        let last = self.len() - 1;
        let mut at = Passage { k: 0, position_m: self.position_m(0), sailed_m: 0.0 };
        for (number, place) in places.iter().enumerate() {
            let nearest = nearest_passage(self, &at, *place);
            at = nearest;
            if at.k == last {
                let ahead = std::iter::once(&at.position_m).chain(&places[number..]);
                let ahead: Vec<Vec2> = ahead.copied().collect();
                let to_go_m: f64 = ahead.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
                return at.sailed_m + to_go_m;
            }
        }
        places.last().map_or(at.sailed_m, |goal| at.sailed_m + (goal - at.position_m).norm())
    }
}

/// A point of a track: at sample `k`, or between it and the next.
#[derive(Clone, Copy)]
struct Passage {
    k: usize,
    position_m: Vec2,
    sailed_m: f64,
}

/// The point of a track, from a passage on, that is nearest to a place.
fn nearest_passage(own: &ShipTrack, from: &Passage, place: Vec2) -> Passage {
    let (mut nearest, mut here) = (*from, *from);
    let mut least_m2 = (place - from.position_m).norm_squared();
    for next in from.k + 1..own.len() {
        let position_m = own.position_m(next);
        let step = position_m - here.position_m;
        let (length_m2, along_m2) = (step.norm_squared(), (place - here.position_m).dot(&step));
        let length_m = length_m2.sqrt();
        // the foot lies within the step
        if along_m2 > 0.0 && along_m2 < length_m2 {
            let share = along_m2 / length_m2;
            let foot_m = here.position_m + step * share;
            let distance_m2 = (place - foot_m).norm_squared();
            if distance_m2 < least_m2 {
                least_m2 = distance_m2;
                let sailed_m = here.sailed_m + share * length_m;
                nearest = Passage { k: next - 1, position_m: foot_m, sailed_m };
            }
        }
        here = Passage { k: next, position_m, sailed_m: here.sailed_m + length_m };
        let distance_m2 = (place - position_m).norm_squared();
        if distance_m2 < least_m2 {
            (least_m2, nearest) = (distance_m2, here);
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ship;
    use geom::HullOutline;

    /// A track through these places, a sample at each.
    fn track(places: &[(f64, f64)]) -> ShipTrack {
        let hull = HullOutline::centred(8.45, 2.71);
        let ship = Ship {
            hull,
            yaw_rate_radps_max: 0.3,
            speed_mps_max: 12.0,
            steerage_mps: None,
            stopping: None,
        };
        let mut track = ShipTrack::with_capacity(ship, places.len());
        track.north_m = places.iter().map(|place| place.0).collect();
        track.east_m = places.iter().map(|place| place.1).collect();
        track
    }

    fn extra_m(sailed: &[(f64, f64)], route: &[(f64, f64)]) -> f64 {
        let places: Vec<Vec2> = route.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
        let planned_m: f64 = places.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        track(sailed).way_m(&places[1..]) - planned_m
    }

    /// It was twice the way that a run goes on beyond the goal.
    #[test]
    fn keeping_straight_on_costs_no_distance_wherever_the_run_ends() {
        for end in [3, 40, 70, 142, 143, 144, 200] {
            let sailed: Vec<_> = (0..=end).map(|k| (7.0 * f64::from(k), 0.0)).collect();
            let extra_m = extra_m(&sailed, &[(0.0, 0.0), (1000.0, 0.0)]);
            assert!(extra_m.abs() < 1e-9, "{extra_m} m at {end}");
        }
    }

    #[test]
    fn way_around_is_counted_to_the_passage_of_the_goal() {
        // 3-4-5 triangles out and back, and 500 m beyond
        let sailed = [(0.0, 0.0), (400.0, 300.0), (800.0, 0.0), (1300.0, 0.0)];
        assert!((extra_m(&sailed, &[(0.0, 0.0), (800.0, 0.0)]) - 200.0).abs() < 1e-9);
        // passed 300 m abeam: what is still to sail is counted too
        let abeam = [(0.0, 0.0), (400.0, 300.0), (1200.0, 300.0)];
        assert!((extra_m(&abeam, &[(0.0, 0.0), (800.0, 0.0)]) - 400.0).abs() < 1e-9);
    }

    #[test]
    fn waypoints_are_passed_in_their_order() {
        let out_and_back = [(0.0, 0.0), (1000.0, 0.0), (1000.0, 500.0)];
        assert!(extra_m(&out_and_back, &out_and_back).abs() < 1e-9);
        // the run ends before the first waypoint: the rest of the route is still ahead
        let early = [(0.0, 0.0), (600.0, 0.0)];
        assert!(extra_m(&early, &out_and_back).abs() < 1e-9);
        // back at the start, which is the goal
        let round = [(0.0, 0.0), (900.0, 0.0), (0.0, 0.0)];
        assert!(extra_m(&round, &round).abs() < 1e-9);
    }
}
