//! Reports become tracks: one for each identity, in the order of time, without wild positions.

use crate::read::{Counted, Reasons, Report};
use encounter::geographic::{Geographic, TangentPlane};
use geom::Vec2;
use std::collections::BTreeMap;

/// The reports of one ship, in the plane.
#[derive(Clone, Debug)]
pub struct Track {
    /// Who.
    pub mmsi: u64,
    /// Length, metres, where one of her reports says it: the largest.
    pub length_m: Option<f64>,
    /// Beam likewise.
    pub width_m: Option<f64>,
    /// Her reports, at least one, earliest first; no two at one time.
    pub points: Vec<Point>,
}

/// Where she was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// When, seconds since 1970.
    pub t_s: f64,
    /// Metres north and east of the middle of all reports.
    pub position_m: Vec2,
    /// Speed over ground, m/s.
    pub sog_mps: f64,
    /// Course over ground, radians.
    pub cog_rad: Option<f64>,
}

/// No ship goes faster between two reports, m/s (97 knots; fast ferries make 45).
const SPEED_MPS_MAX: f64 = 50.0;
/// Errors of two positions together, metres: at short intervals they look like speed.
const POSITION_ERROR_M: f64 = 200.0;

/// Makes tracks; `reasons` counts what is left out, by report.
pub fn tracks(reports: &[Report], reasons: &mut Reasons) -> Vec<Track> {
    let Some(middle) = middle(reports) else { return Vec::new() };
    let plane = TangentPlane::new(middle);
    let mut by_ship: BTreeMap<u64, Vec<&Report>> = BTreeMap::new();
    for report in reports {
        by_ship.entry(report.mmsi).or_default().push(report);
    }
    let tracks = by_ship.into_iter().map(|(mmsi, mut reports)| {
        for pair in reports.windows(2).filter(|pair| pair[1].t_s < pair[0].t_s) {
            note(reasons, "times out of order, put right", pair[1].line);
        }
        reports.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        reports.dedup_by(|later, first| {
            let same = later.t_s <= first.t_s;
            if same {
                note(reasons, "a second report at the same time", later.line);
            }
            same
        });
        let largest = |of: fn(&Report) -> Option<f64>| {
            reports.iter().filter_map(|report| of(report)).reduce(f64::max)
        };
        let (length_m, width_m) = (largest(|r| r.length_m), largest(|r| r.width_m));
        let points: Vec<Point> = reports
            .iter()
            .map(|r| Point {
                t_s: r.t_s,
                position_m: plane.position_m(Geographic { lat_deg: r.lat_deg, lon_deg: r.lon_deg }),
                sog_mps: r.sog_mps,
                cog_rad: r.cog_rad,
            })
            .collect();
        let tame = tame(&points);
        for (report, _) in reports.iter().zip(&tame).filter(|(_, tame)| !**tame) {
            note(reasons, "a wild position", report.line);
        }
        let points = points.iter().zip(&tame).filter(|(_, tame)| **tame);
        Track { mmsi, length_m, width_m, points: points.map(|(point, _)| *point).collect() }
    });
    tracks.filter(|track| !track.points.is_empty()).collect()
}

/// Counts a reason; ships come one after another, so its first line in the file is the least.
fn note(reasons: &mut Reasons, reason: &'static str, line: u64) {
    let entry = reasons.entry(reason).or_insert(Counted { count: 0, first_line: line });
    entry.count += 1;
    entry.first_line = entry.first_line.min(line);
}

/// Medians of latitude and longitude: one wild position does not move them.
fn middle(reports: &[Report]) -> Option<Geographic> {
    let median = |value: fn(&Report) -> f64| {
        let mut values: Vec<f64> = reports.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    Some(Geographic { lat_deg: median(|r| r.lat_deg)?, lon_deg: median(|r| r.lon_deg)? })
}

/// A report is looked at together with so many before it and after it: as many wild ones less one
/// may stand in a row.
const NEIGHBOURS: usize = 4;

/// Which points are not wild. Points between which a ship could have gone belong together, directly
/// or over others; a point by itself is wild, and so are two that a longer voyage leaves aside.
/// More are another ship under the same identity, and stay.
fn tame(points: &[Point]) -> Vec<bool> {
    let can = |a: &Point, b: &Point| {
        let most_m = SPEED_MPS_MAX * (b.t_s - a.t_s) + POSITION_ERROR_M;
        (b.position_m - a.position_m).norm() <= most_m
    };
    // the voyage of each point: the first of it, found through the earlier neighbours
    let mut voyage: Vec<usize> = Vec::with_capacity(points.len());
    for (k, point) in points.iter().enumerate() {
        let near = |j: &usize| can(&points[*j], point);
        let joined: Vec<usize> =
            (k.saturating_sub(NEIGHBOURS)..k).filter(near).map(|j| voyage[j]).collect();
        let first = joined.iter().copied().min().unwrap_or(k);
        voyage.push(first);
        if joined.iter().any(|&other| other != first) {
            voyage.iter_mut().filter(|other| joined.contains(other)).for_each(|v| *v = first);
        }
    }
    let mut sizes = vec![0_usize; points.len()];
    voyage.iter().for_each(|&first| sizes[first] += 1);
    let largest = sizes.iter().copied().max().unwrap_or(0);
    let stays = |size: usize| points.len() == 1 || size > 2 || (size == 2 && largest == 2);
    voyage.into_iter().map(|first| stays(sizes[first])).collect()
}

/// Where a ship was between two reports, and how she moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fix {
    /// Metres north and east.
    pub position_m: Vec2,
    /// Velocity between the reports around it, m/s.
    pub velocity_mps: Vec2,
    /// Reported speed, m/s.
    pub sog_mps: f64,
}

/// Nothing is said between two reports that lie farther apart, seconds: the slowest station under
/// way reports every thirty (class B), and some messages are lost.
pub const GAP_S_MAX: f64 = 120.0;

impl Track {
    /// Where she was at a time; `None` outside her reports and in their gaps.
    pub fn at(&self, t_s: f64) -> Option<Fix> {
        let after = self.points.partition_point(|point| point.t_s <= t_s);
        let before = self.points.get(after.checked_sub(1)?)?;
        let after = self.points.get(after)?;
        let velocity_mps = Self::leg_velocity_mps(before, after)?;
        let share = (t_s - before.t_s) / (after.t_s - before.t_s);
        Some(Fix {
            position_m: before.position_m + (after.position_m - before.position_m) * share,
            velocity_mps,
            sog_mps: before.sog_mps + share * (after.sog_mps - before.sog_mps),
        })
    }

    /// Velocity between two reports that follow one another, no faster than a ship goes: at short
    /// intervals errors of position look like speed. `None` where nothing is said between them.
    pub(crate) fn leg_velocity_mps(before: &Point, after: &Point) -> Option<Vec2> {
        let apart_s = after.t_s - before.t_s;
        let way_m = after.position_m - before.position_m;
        // two ships under one identity are in two places: nothing is said between them
        let told =
            apart_s <= GAP_S_MAX && way_m.norm() <= SPEED_MPS_MAX * apart_s + POSITION_ERROR_M;
        told.then(|| way_m / apart_s.max(way_m.norm() / SPEED_MPS_MAX))
    }

    /// Velocity over ground over a span of time around `t_s`: smoother than between two reports.
    pub fn velocity_mps(&self, t_s: f64, span_s: f64) -> Option<Vec2> {
        let (from, to) = (self.at(t_s - 0.5 * span_s)?, self.at(t_s + 0.5 * span_s)?);
        Some((to.position_m - from.position_m) / span_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(t_s: f64, lon_deg: f64) -> Report {
        Report {
            mmsi: 7,
            t_s,
            lat_deg: 0.0,
            lon_deg,
            sog_mps: 5.0,
            cog_rad: None,
            length_m: None,
            width_m: None,
            line: 2 + t_s as u64,
        }
    }

    /// 0.0001 degrees of longitude are 11.13 m at the equator.
    #[test]
    fn wild_positions_go_and_the_order_is_put_right() {
        let reports = [
            report(20.0, 1.0002),
            report(0.0, 1.0),
            report(10.0, 1.0001),
            report(30.0, 55.0),
            report(40.0, 1.0004),
            report(40.0, 1.0004),
        ];
        let mut reasons = Reasons::new();
        let tracks = tracks(&reports, &mut reasons);
        let times: Vec<f64> = tracks[0].points.iter().map(|p| p.t_s).collect();
        assert_eq!(times, [0.0, 10.0, 20.0, 40.0]);
        assert_eq!(reasons["a wild position"].count, 1);
        assert_eq!(reasons["a second report at the same time"].count, 1);
        assert_eq!(reasons["times out of order, put right"].count, 1);
        let lines = ["a wild position", "times out of order, put right"];
        assert_eq!(lines.map(|reason| reasons[reason].first_line), [32, 2]);
        let fix = tracks[0].at(5.0).unwrap();
        assert!((fix.velocity_mps.y - 1.113_195).abs() < 1e-4, "{:?}", fix.velocity_mps);
        assert_eq!(tracks[0].at(41.0), None);
        assert_eq!(tracks[0].at(-1.0), None);
    }

    /// Two wild positions in a row, in one place or in two, leave the report before them alone, and
    /// go themselves; a second ship under the same identity stays.
    #[test]
    fn wild_positions_do_not_take_their_neighbours_along() {
        let kept = |lon_deg: &[f64]| -> Vec<f64> {
            let reports: Vec<Report> =
                lon_deg.iter().zip(0..).map(|(&l, k)| report(10.0 * f64::from(k), l)).collect();
            let tracks = tracks(&reports, &mut Reasons::new());
            tracks.iter().flat_map(|track| track.points.iter().map(|point| point.t_s)).collect()
        };
        let others = [20.0, 30.0, 40.0].map(|t_s| t_s + 10.0);
        for wild in [[55.0, 55.0], [55.0, -20.0]] {
            let first = kept(&[1.0, wild[0], wild[1], 1.0003, 1.0004, 1.0005]);
            assert_eq!(first, [&[0.0], &others[..]].concat(), "{wild:?}");
            let last = kept(&[1.0, 1.0001, 1.0002, wild[0], wild[1], 1.0005]);
            assert_eq!(last, [0.0, 10.0, 20.0, 50.0], "{wild:?}");
        }
        assert_eq!(kept(&[1.0, 55.0, 1.0, 55.0, 1.0, 55.0]).len(), 6, "two ships");
        assert_eq!(kept(&[1.0, 55.0]), Vec::<f64>::new(), "nobody knows which");
    }

    /// Two reports 10 ms and 11 m apart are errors of position, not 1100 m/s.
    #[test]
    fn errors_of_position_are_no_speed() {
        let tracks = tracks(&[report(0.0, 1.0), report(0.01, 1.0001)], &mut Reasons::new());
        let fix = tracks[0].at(0.005).unwrap();
        assert!((fix.velocity_mps.norm() - SPEED_MPS_MAX).abs() < 1e-9, "{:?}", fix.velocity_mps);
    }

    #[test]
    fn gaps_say_nothing() {
        let mut reasons = Reasons::new();
        let tracks = tracks(&[report(0.0, 1.0), report(300.0, 1.001)], &mut reasons);
        assert_eq!(tracks[0].at(150.0), None);
    }
}
