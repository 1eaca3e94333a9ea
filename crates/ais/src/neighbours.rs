//! Which ships can be near one another, and when: so that a day of a whole country is not a day of
//! all its pairs.
//!
//! Time is cut into windows. In each, a ship lies in a box around all places where she can be
//! between her reports; boxes that come within [`NEAR_M`] share a cell of a grid.

use crate::meetings::{MOVING_MPS, NEAR_M, STEP_S};
use crate::tracks::{GAP_S_MAX, Track};
use geom::Vec2;
use std::collections::BTreeMap;

/// A window of time, by its number since 1970.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Window(pub(crate) i64);

/// Length of a window, seconds. A fast ferry makes three miles in it.
const WINDOW_S: f64 = 240.0;
const _: () = assert!(WINDOW_S >= GAP_S_MAX, "a leg would skip a window");

impl Window {
    fn of(t_s: f64) -> Self {
        Self((t_s / WINDOW_S).floor() as i64)
    }

    /// Its first instant, seconds since 1970.
    pub(crate) fn start_s(self) -> f64 {
        WINDOW_S * self.0 as f64
    }

    /// Its end, the first instant of the next.
    pub(crate) fn end_s(self) -> f64 {
        Self(self.0 + 1).start_s()
    }
}

/// Pairs of ships, the first before the second, with the windows in which they can be near, ordered
/// by the second, then the first. Ships that are never under way meet nobody and are left out.
pub(crate) fn neighbours(tracks: &[Track]) -> Vec<([usize; 2], Vec<Window>)> {
    let moving = |track: &Track| track.points.iter().any(|point| point.sog_mps > MOVING_MPS);
    let mut heard: Vec<(Window, usize)> = Vec::new();
    for (ship, track) in tracks.iter().enumerate().filter(|(_, track)| moving(track)) {
        heard.extend(windows(track).into_iter().map(|window| (window, ship)));
    }
    heard.sort_unstable();
    let mut pairs: BTreeMap<[usize; 2], Vec<Window>> = BTreeMap::new();
    for here in heard.chunk_by(|a, b| a.0 == b.0) {
        let window = here[0].0;
        let mut cells: Vec<([i64; 2], usize)> = Vec::new();
        for &(_, ship) in here {
            let extent = extent(&tracks[ship], window);
            cells.extend(extent.iter().flat_map(|extent| extent.cells().map(|cell| (cell, ship))));
        }
        cells.sort_unstable();
        let mut near: Vec<[usize; 2]> = Vec::new();
        for cell in cells.chunk_by(|a, b| a.0 == b.0) {
            for (k, &(_, second)) in cell.iter().enumerate() {
                near.extend(cell[..k].iter().map(|&(_, first)| [second, first]));
            }
        }
        near.sort_unstable();
        near.dedup();
        near.into_iter().for_each(|pair| pairs.entry(pair).or_default().push(window));
    }
    pairs.into_iter().map(|([second, first], windows)| ([first, second], windows)).collect()
}

/// The windows in which a ship is heard: a leg is shorter than one and lies in two at most.
fn windows(track: &Track) -> Vec<Window> {
    let told =
        track.points.windows(2).filter(|leg| Track::leg_velocity_mps(&leg[0], &leg[1]).is_some());
    let mut windows: Vec<Window> =
        told.flat_map(|leg| [Window::of(leg[0].t_s), Window::of(leg[1].t_s)]).collect();
    windows.dedup();
    windows
}

/// Where a ship can be in a window.
#[derive(Clone, Copy, Debug)]
struct Extent {
    low_m: Vec2,
    high_m: Vec2,
}

/// The box around the legs of a track that touch a window, each longer by what a look adds at its
/// ends; `None` where she is not heard.
fn extent(track: &Track, window: Window) -> Option<Extent> {
    let points = &track.points;
    let before = points.partition_point(|point| point.t_s < window.start_s()).saturating_sub(1);
    let mut extent: Option<Extent> = None;
    for leg in points[before..].windows(2).take_while(|leg| leg[0].t_s < window.end_s()) {
        // where the track says nothing nobody looks
        let Some(velocity_mps) = Track::leg_velocity_mps(&leg[0], &leg[1]) else { continue };
        let more_m = velocity_mps * STEP_S;
        for place_m in [leg[0].position_m - more_m, leg[1].position_m + more_m] {
            let known = extent.unwrap_or(Extent { low_m: place_m, high_m: place_m });
            extent = Some(Extent {
                low_m: known.low_m.inf(&place_m),
                high_m: known.high_m.sup(&place_m),
            });
        }
    }
    extent
}

impl Extent {
    /// The cells that the box touches once it is wider by half of what is near.
    fn cells(self) -> impl Iterator<Item = [i64; 2]> {
        let cell = |m: f64| (m / NEAR_M).floor() as i64;
        let half_m = 0.5 * NEAR_M;
        let (low, high) =
            (self.low_m.map(|m| cell(m - half_m)), self.high_m.map(|m| cell(m + half_m)));
        (low.x..=high.x).flat_map(move |x| (low.y..=high.y).map(move |y| [x, y]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracks::Point;

    /// A day of ships all along a coast: those that are far apart are never looked at together.
    #[test]
    fn a_day_of_a_country_is_not_all_its_pairs() {
        let ship = |mmsi: u64| {
            let from_m = Vec2::new(6000.0 * mmsi as f64, 0.0);
            let points = (0..=288).map(|k| {
                let t_s = 100.0 * f64::from(k);
                // up and down a fairway of her own
                let leg_m = (t_s % 1200.0 - 600.0).abs() * 5.0;
                let position_m = from_m + Vec2::new(0.0, leg_m);
                Point { t_s, position_m, sog_mps: 5.0, cog_rad: None }
            });
            Track { mmsi, length_m: None, width_m: None, points: points.collect() }
        };
        let mut ships: Vec<Track> = (0..200).map(ship).collect();
        assert_eq!(neighbours(&ships), []);
        // one who comes along the coast meets each of them for a while
        let points = (0..=288).map(|k| {
            let t_s = 100.0 * f64::from(k);
            let position_m = Vec2::new(6000.0 * f64::from(k) / 10.0, 1500.0);
            Point { t_s, position_m, sog_mps: 6.0, cog_rad: None }
        });
        ships.push(Track { mmsi: 200, length_m: None, width_m: None, points: points.collect() });
        let pairs = neighbours(&ships);
        assert!((25..=32).contains(&pairs.len()), "{}", pairs.len());
        assert!(pairs.iter().all(|([_, second], windows)| *second == 200 && windows.len() < 10));
    }

    /// One report of 1970 and one of 2100 make no windows in between.
    #[test]
    fn a_wild_time_costs_nothing() {
        let points = [0.0, 10.0, 4.1e9, 4.1e9 + 10.0].map(|t_s| {
            let position_m = Vec2::new(5.0, 0.0);
            Point { t_s, position_m, sog_mps: 5.0, cog_rad: None }
        });
        let ship = Track { mmsi: 1, length_m: None, width_m: None, points: points.into() };
        assert_eq!(windows(&ship).len(), 2);
        assert_eq!(neighbours(&[ship.clone(), ship])[0].1.len(), 2);
    }
}
