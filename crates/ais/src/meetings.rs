//! Encounters in a set of tracks: two ships under way that come near each other.
//!
//! The closest point of a pair counts when both reports surround it, both move, and it lies within
//! a nautical mile. Ships that were together five minutes before are companions, tugs or pilots
//! and no encounter; nor is a pair that was not heard for that long.

use crate::neighbours::{Window, neighbours};
use crate::read::{Counted, Reasons};
use crate::tracks::Track;
use geom::units::{NAUTICAL_MILE_M, knots};
use geom::{Vec2, angle, wrap};

/// One encounter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The two ships, indices into the tracks.
    pub ships: [usize; 2],
    /// When they were closest, seconds since 1970.
    pub cpa_s: f64,
    /// How near, metres.
    pub cpa_m: f64,
    /// Both at [`BEFORE_S`] before that.
    pub start: [Start; 2],
}

/// A ship at the start of an encounter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Metres north and east.
    pub position_m: Vec2,
    /// Velocity over ground, m/s.
    pub velocity_mps: Vec2,
}

/// The encounters and what was left out.
#[derive(Clone, Debug)]
pub struct Found {
    /// Encounters in the order of the pairs.
    pub meetings: Vec<Meeting>,
    /// Pairs that came within [`NEAR_M`], both under way.
    pub near: u64,
    /// Why the others are no encounters.
    pub left_out: Reasons,
}

/// Nearer than this the ships meet, metres.
pub const NEAR_M: f64 = NAUTICAL_MILE_M;
/// Slower than this a ship is not under way, m/s.
pub const MOVING_MPS: f64 = knots(2.0);
/// An encounter begins so long before its closest point, seconds.
pub const BEFORE_S: f64 = 300.0;
/// Ships that were nearer than this then were together, metres.
pub const TOGETHER_M: f64 = 0.5 * NAUTICAL_MILE_M;

/// Between two looks at a pair, seconds.
pub(crate) const STEP_S: f64 = 5.0;
/// Over so long a course is measured, seconds.
const SPAN_S: f64 = 30.0;

impl Meeting {
    /// Course of the second ship less that of the first, radians.
    pub fn relative_course_rad(&self) -> f64 {
        let [own, target] = self.start.map(|start| angle::direction(start.velocity_mps));
        wrap(target - own)
    }

    /// Signed distance at the closest point if both had gone straight on from the start, metres:
    /// positive where the second ship would have passed to starboard of the motion of the first
    /// relative to it.
    pub fn miss_m(&self) -> f64 {
        let [own, target] = &self.start;
        let away_m = target.position_m - own.position_m;
        let closing_mps = own.velocity_mps - target.velocity_mps;
        let speed_mps = closing_mps.norm();
        if speed_mps <= 0.0 {
            return away_m.norm();
        }
        (closing_mps.x * away_m.y - closing_mps.y * away_m.x) / speed_mps
    }

    /// When that would have been, seconds from the start; not positive where they drew apart.
    pub fn tcpa_s(&self) -> f64 {
        let [own, target] = &self.start;
        let away_m = target.position_m - own.position_m;
        let closing_mps = own.velocity_mps - target.velocity_mps;
        let square = closing_mps.norm_squared();
        if square <= 0.0 { 0.0 } else { away_m.dot(&closing_mps) / square }
    }

    /// How far apart they were at the start, metres.
    pub fn start_range_m(&self) -> f64 {
        (self.start[1].position_m - self.start[0].position_m).norm()
    }
}

/// Finds the encounters.
pub fn meetings(tracks: &[Track]) -> Found {
    let mut found = Found { meetings: Vec::new(), near: 0, left_out: Reasons::new() };
    for ([first, second], windows) in neighbours(tracks) {
        let (a, b) = (&tracks[first], &tracks[second]);
        let Some(closest) = closest(a, b, &windows) else { continue };
        found.near += 1;
        match start(a, b, &closest) {
            Ok(start) => found.meetings.push(Meeting {
                ships: [first, second],
                cpa_s: closest.t_s,
                cpa_m: closest.apart_m,
                start,
            }),
            Err(reason) => {
                let entry = found.left_out.entry(reason);
                entry.or_insert(Counted { count: 0, first_line: 0 }).count += 1;
            }
        }
    }
    found
}

#[derive(Clone, Copy)]
struct Closest {
    t_s: f64,
    apart_m: f64,
    /// Whether they were heard before and after.
    inside: bool,
    /// Whether both were under way.
    moving: bool,
}

/// The closest point of two ships that both move at it, if it is near, within the windows of time
/// in which they can be near at all.
fn closest(a: &Track, b: &Track, windows: &[Window]) -> Option<Closest> {
    let span = |track: &Track| Some((track.points.first()?.t_s, track.points.last()?.t_s));
    let ((a0, a1), (b0, b1)) = (span(a)?, span(b)?);
    let (from_s, to_s) = (a0.max(b0), a1.min(b1));
    let mut best: Option<Closest> = None;
    let steps = ((to_s - from_s) / STEP_S).floor().max(-1.0) as i64;
    for window in windows {
        // every look of the whole span that falls into the window, and no other
        let look = |t_s: f64| ((t_s - from_s) / STEP_S).ceil() as i64;
        for k in look(window.start_s()).max(0)..look(window.end_s()).min(steps + 1) {
            let t_s = from_s + STEP_S * k as f64;
            let (Some(p), Some(q)) = (a.at(t_s), b.at(t_s)) else { continue };
            // between two looks they go straight on
            let away_m = q.position_m - p.position_m;
            let way_m = (q.velocity_mps - p.velocity_mps) * STEP_S;
            let (apart_m, _) = geom::segment_min_distance(away_m - way_m, away_m + way_m);
            if apart_m <= NEAR_M && best.is_none_or(|best| apart_m < best.apart_m) {
                let around = |t_s: f64| a.at(t_s).is_some() && b.at(t_s).is_some();
                let inside = around(t_s - STEP_S) && around(t_s + STEP_S);
                let moving = p.sog_mps > MOVING_MPS && q.sog_mps > MOVING_MPS;
                best = Some(Closest { t_s, apart_m, inside, moving });
            }
        }
    }
    // ships that only pass a berth or an anchorage have their closest point with one at rest
    best.filter(|best| best.moving)
}

fn start(a: &Track, b: &Track, closest: &Closest) -> Result<[Start; 2], &'static str> {
    if !closest.inside {
        return Err("closest at the edge of what was heard");
    }
    let t_s = closest.t_s - BEFORE_S;
    let of = |track: &Track| {
        let velocity_mps = track.velocity_mps(t_s, SPAN_S)?;
        Some(Start { position_m: track.at(t_s)?.position_m, velocity_mps })
    };
    let (Some(own), Some(target)) = (of(a), of(b)) else {
        return Err("not heard five minutes before");
    };
    if (own.position_m - target.position_m).norm() < TOGETHER_M {
        return Err("together five minutes before");
    }
    if own.velocity_mps.norm() < MOVING_MPS || target.velocity_mps.norm() < MOVING_MPS {
        return Err("not under way five minutes before");
    }
    Ok([own, target])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracks::Point;
    use record::{EncounterId, Purpose, Seed, Streams};

    /// Windows and cells leave nothing out: the same as looking at every pair all the time.
    #[test]
    fn the_search_finds_what_looking_at_every_pair_finds() {
        let mut stream =
            Streams::new(Seed(8), &EncounterId::new("ships", 0)).stream(Purpose::Geometry, 0);
        let mut ships = Vec::new();
        for mmsi in 0..60 {
            let mut within = |low, high| stream.uniform_in(low, high);
            let from_m = Vec2::new(within(-9000.0, 9000.0), within(-9000.0, 9000.0));
            let speed_mps = if mmsi % 7 == 0 { 0.3 } else { within(1.5, 15.0) };
            let mut ship = ship(mmsi, from_m, angle::unit(within(-3.0, 3.0)) * speed_mps);
            let late_s = within(0.0, 700.0);
            ship.points.iter_mut().for_each(|point| point.t_s += late_s);
            // some are heard badly, and one identity is two ships
            let every = 1 + (mmsi % 4) as usize * 5;
            ship.points = ship.points.into_iter().step_by(every).collect();
            if mmsi == 11 {
                let jump_m = Vec2::new(5000.0, 0.0);
                ship.points.iter_mut().skip(30).for_each(|point| point.position_m += jump_m);
            }
            ships.push(ship);
        }
        let always: Vec<Window> = (-2..40).map(Window).collect();
        let (mut near, mut seen) = (0, Vec::new());
        for second in 0..ships.len() {
            for first in 0..second {
                if let Some(closest) = closest(&ships[first], &ships[second], &always) {
                    near += 1;
                    if start(&ships[first], &ships[second], &closest).is_ok() {
                        seen.push(([first, second], closest.t_s, closest.apart_m));
                    }
                }
            }
        }
        let found = meetings(&ships);
        assert!(near > 40 && seen.len() > 10, "{near} {}", seen.len());
        assert_eq!(found.near, near);
        let found: Vec<_> = found.meetings.iter().map(|m| (m.ships, m.cpa_s, m.cpa_m)).collect();
        assert_eq!(found, seen);
    }

    /// A ship on a straight line, with a report every ten seconds for twenty minutes.
    fn ship(mmsi: u64, from_m: Vec2, velocity_mps: Vec2) -> Track {
        let points = (0..=120).map(|k| {
            let t_s = 10.0 * f64::from(k);
            Point {
                t_s,
                position_m: from_m + velocity_mps * t_s,
                sog_mps: velocity_mps.norm(),
                cog_rad: None,
            }
        });
        Track { mmsi, length_m: None, width_m: None, points: points.collect() }
    }

    #[test]
    fn a_crossing_is_found_with_its_numbers() {
        // own north at 5 m/s through (3000, 0) at 600 s; the target west at 6 m/s through the same
        // place 20 s later, so that she passes astern
        let own = ship(1, Vec2::new(0.0, 0.0), Vec2::new(5.0, 0.0));
        let target = ship(2, Vec2::new(3000.0, 3720.0), Vec2::new(0.0, -6.0));
        let found = meetings(&[own, target]);
        assert_eq!((found.near, found.meetings.len()), (1, 1));
        let meeting = &found.meetings[0];
        assert!((meeting.relative_course_rad() + std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        // relative motion of own (5, 6), the target starts at (3000, 3720): cross over its length
        let miss_m = (5.0 * 3720.0 - 6.0 * 3000.0) / 61f64.sqrt();
        assert!((meeting.miss_m() - miss_m).abs() < 1e-6, "{}", meeting.miss_m());
        assert!((meeting.cpa_m - miss_m.abs()).abs() < 1.0, "{}", meeting.cpa_m);
    }

    #[test]
    fn companions_and_ships_at_the_edge_are_left_out() {
        let own = ship(1, Vec2::new(0.0, 0.0), Vec2::new(5.0, 0.0));
        let tug = ship(2, Vec2::new(0.0, 100.0), Vec2::new(5.0, -0.05));
        let opening = ship(3, Vec2::new(-50.0, -1500.0), Vec2::new(-5.0, 0.0));
        let moored = ship(4, Vec2::new(3000.0, 30.0), Vec2::new(0.0, 0.0));
        let found = meetings(&[own, tug, opening, moored]);
        assert_eq!(found.meetings.len(), 0);
        let reasons: Vec<_> = found.left_out.iter().map(|(r, c)| (*r, c.count)).collect();
        assert_eq!(
            reasons,
            [("closest at the edge of what was heard", 3)],
            "the tug closes to the end, the others open from the start"
        );
        let close_tug = ship(5, Vec2::new(300.0, 90.0), Vec2::new(4.5, 0.0));
        let own = ship(1, Vec2::new(0.0, 0.0), Vec2::new(5.0, 0.0));
        let found = meetings(&[own, close_tug]);
        assert_eq!(found.left_out["together five minutes before"].count, 1);
    }
}
