//! AIS: what targets say of themselves, when they say it.
//!
//! Every target has a transponder with a stream of its own and draws the same numbers for every
//! report, lost or not, so that her errors do not depend on what own ship does.

use super::kalman::{Cov, oriented};
use super::{Measurement, Report};
use crate::ship::Ship;
use geom::units::{deg, knots};
use geom::{Vec2, angle, wrap};
use record::{Ais, Purpose, Stream, Streams};

/// The transponder of one target.
#[derive(Clone, Debug)]
pub struct Transponder {
    stream: Stream,
    index: u8,
    class_a: bool,
    size_m: Option<(f64, f64)>,
    /// When the next report is due; never, where there is none on board.
    next_s: f64,
}

/// A course alteration in the sense of ITU-R M.1371-5, annex 2, table 1: the heading differs by
/// more than 5 degrees from its mean over the last 30 s, that is, from the one 15 s ago in a steady
/// turn.
const TURNING_RADPS: f64 = deg(5.0) / 15.0;
/// Slowest speed at which a report says something of the course, m/s.
const COURSE_MPS_MIN: f64 = 0.1;

/// Reporting interval of a class A station, seconds (ITU-R M.1371-5, annex 2, table 1). The numbers
/// were compared with a transponder's manual (Weatherdock easyTRX2S, page 75: 180, 10, 3.3, 6, 2, 2
/// and 2 s); the recommendation itself was not at hand.
pub fn class_a_interval_s(sog_mps: f64, yaw_rate_radps: f64) -> f64 {
    let turning = yaw_rate_radps.abs() > TURNING_RADPS;
    if sog_mps > knots(23.0) {
        2.0
    } else if sog_mps > knots(14.0) {
        if turning { 2.0 } else { 6.0 }
    } else if sog_mps > MOORED_MPS_MAX {
        if turning { 10.0 / 3.0 } else { 10.0 }
    } else {
        180.0
    }
}

/// A station that moves no faster than this reports as one at anchor. The table asks for the
/// navigational status as well, which nobody sets here.
const MOORED_MPS_MAX: f64 = 0.25;

/// Reporting interval of a class B (CS) station, seconds (ITU-R M.1371-5, annex 2, table 2; not
/// compared with any source beyond the 30 s under way).
pub fn class_b_interval_s(sog_mps: f64) -> f64 {
    if sog_mps > knots(2.0) { 30.0 } else { 180.0 }
}

impl Transponder {
    /// The transponder of target `index`.
    pub fn new(ais: &Ais, streams: &Streams, index: u8, ship: &Ship) -> Self {
        let mut stream = streams.stream(Purpose::Sensor, index + 1);
        let carried = stream.uniform() < ais.carried;
        let static_data = stream.uniform();
        let wrong_by = stream.uniform_in(0.5, 1.5);
        let phase = stream.uniform();
        let late_s = ais.first_delay_s_mean * stream.exponential();
        let (length_m, beam_m) = (ship.outline.length_m, ship.outline.beam_m);
        let class_a = length_m >= ais.class_a_length_m_min;
        let size_m = if static_data < ais.static_missing {
            None
        } else if static_data < ais.static_missing + ais.static_wrong {
            Some((length_m * wrong_by, beam_m * wrong_by))
        } else {
            Some((length_m, beam_m))
        };
        let mut transponder = Self { stream, index, class_a, size_m, next_s: f64::INFINITY };
        if carried {
            transponder.next_s = phase * transponder.interval_s(ship) + late_s;
        }
        transponder
    }

    fn interval_s(&self, ship: &Ship) -> f64 {
        let sog_mps = ship.pose.velocity_mps.norm();
        if self.class_a {
            class_a_interval_s(sog_mps, ship.pose.yaw_rate_radps)
        } else {
            class_b_interval_s(sog_mps)
        }
    }

    /// The report that has fallen due by `t_s`, if one has and it is heard. Its numbers are those
    /// of the beat.
    pub fn hear(&mut self, ais: &Ais, t_s: f64, ship: &Ship) -> Option<Measurement> {
        if t_s < self.next_s {
            return None;
        }
        // the phase is kept, but no two reports are made of one beat
        self.next_s += self.interval_s(ship);
        let stream = &mut self.stream;
        let lost = stream.uniform() < ais.dropout;
        let off_m = Vec2::new(stream.normal(), stream.normal()) * ais.position_sd_m;
        let sog_error_mps = ais.sog_sd_mps * stream.normal();
        let cog_error_rad = ais.cog_sd_rad * stream.normal();
        let psi_error_rad = ais.heading_sd_rad * stream.normal();
        if lost {
            return None;
        }
        let velocity_mps = ship.pose.velocity_mps;
        let sog_mps = velocity_mps.norm();
        let course =
            if sog_mps > COURSE_MPS_MIN { velocity_mps / sog_mps } else { ship.pose.heading };
        let said = angle::rotate(course, cog_error_rad);
        let said_mps = (sog_mps + sog_error_mps).max(0.0);
        let across_mps = said_mps * ais.cog_sd_rad;
        let floor = VARIANCE_MIN;
        let report = Report {
            mmsi: u32::from(self.index),
            velocity_mps: said * said_mps,
            velocity_mps2: oriented(
                said,
                (ais.sog_sd_mps * ais.sog_sd_mps).max(floor),
                (across_mps * across_mps).max(floor),
            ),
            psi_rad: self.class_a.then(|| wrap(ship.state.psi_rad + psi_error_rad)),
            size_m: self.size_m,
        };
        Some(Measurement {
            t_s,
            ready_s: t_s + ais.latency_s,
            origin: Some(self.index),
            position_m: ship.pose.position_m + off_m,
            position_m2: Cov::identity() * (ais.position_sd_m * ais.position_sd_m).max(floor),
            report: Some(report),
        })
    }
}

/// No measurement is taken for exact: the tracker's matrices must stay invertible.
pub(crate) const VARIANCE_MIN: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    /// ITU-R M.1371-5, annex 2, tables 1 and 2.
    #[test]
    fn intervals_are_those_of_the_recommendation() {
        for (kn, turning, interval_s) in [
            (0.0, false, 180.0),
            (10.0, false, 10.0),
            (10.0, true, 10.0 / 3.0),
            (18.0, false, 6.0),
            (18.0, true, 2.0),
            (25.0, false, 2.0),
            (25.0, true, 2.0),
        ] {
            let yaw_rate_radps = if turning { deg(1.0) } else { 0.0 };
            let found = class_a_interval_s(knots(kn), yaw_rate_radps);
            assert!((found - interval_s).abs() < 1e-12, "{kn} kn: {found}");
        }
        assert!((class_b_interval_s(knots(1.5)) - 180.0).abs() < 1e-12);
        assert!((class_b_interval_s(knots(8.0)) - 30.0).abs() < 1e-12);
    }
}
