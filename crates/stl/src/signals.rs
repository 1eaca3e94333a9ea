//! What a pair of tracks says at every sample: range, its rate, predicted closest point, angles.
//!
//! Frames and senses as in the rules specification, section 0: north and east, angles clockwise,
//! positive to starboard, wrapped to (-pi, pi]. Predictions use velocity over ground (section 1),
//! angles use the heading.

use crate::clearance::{Plane, Posed, predicted_clearance_m};
use record::{DistanceKind, ShipTrack};
use std::f64::consts::{PI, TAU};

/// "More than 22.5 degrees abaft her beam" (Rule 13(b)): 112.5 degrees, the one number of law.
pub const ABAFT_THE_BEAM_RAD: f64 = 0.625 * PI;

/// Below this relative speed a time to the closest point means nothing (section 1), m/s.
const RELATIVE_SPEED_MIN_MPS: f64 = 0.05;

/// An angle in (-pi, pi].
pub fn wrapped_rad(angle_rad: f64) -> f64 {
    if angle_rad.abs() < PI {
        return angle_rad;
    }
    let mut angle = angle_rad % TAU;
    if angle > PI {
        angle -= TAU;
    } else if angle <= -PI {
        angle += TAU;
    }
    angle
}

/// Own ship and one target, sample by sample.
#[derive(Clone, Debug)]
pub struct PairSignals<'a> {
    pub(crate) own: &'a ShipTrack,
    pub(crate) target: &'a ShipTrack,
    kind: DistanceKind,
    radii_m: f64,
    /// Target less own ship.
    pub position_m: Vec<Plane>,
    /// Target less own ship.
    pub velocity_mps: Vec<Plane>,
    /// Between the reference points.
    pub range_m: Vec<f64>,
    /// Rate of the range, negative while closing.
    pub range_rate_mps: Vec<f64>,
    /// Signed time to the closest point; NaN where the ships keep their distance, so that every
    /// comparison with it is false.
    pub tcpa_s: Vec<f64>,
    /// Predicted smallest distance of the reference points.
    pub dcpa_m: Vec<f64>,
}

impl<'a> PairSignals<'a> {
    /// From two tracks; as many samples as both have.
    pub fn new(own: &'a ShipTrack, target: &'a ShipTrack, kind: DistanceKind) -> Self {
        let samples = own.len().min(target.len());
        let radii_m = own.ship.hull.radius_m() + target.ship.hull.radius_m();
        let less = |a: &[f64], b: &[f64], c: &[f64], d: &[f64]| -> Vec<Plane> {
            let north = a[..samples].iter().zip(&b[..samples]);
            let east = c[..samples].iter().zip(&d[..samples]);
            north.zip(east).map(|((a, b), (c, d))| (a - b, c - d)).collect()
        };
        let position_m = less(&target.north_m, &own.north_m, &target.east_m, &own.east_m);
        let velocity_mps = less(
            &target.vel_north_mps,
            &own.vel_north_mps,
            &target.vel_east_mps,
            &own.vel_east_mps,
        );
        let both = || position_m.iter().zip(&velocity_mps);
        let range_m: Vec<f64> = position_m.iter().map(|r| length(*r)).collect();
        let range_rate = |((r, w), range): ((&Plane, &Plane), &f64)| {
            if *range > 0.0 { dot(*r, *w) / range } else { 0.0 }
        };
        let range_rate_mps = both().zip(&range_m).map(range_rate).collect();
        let tcpa = |(r, w): (&Plane, &Plane)| {
            let speed_squared = dot(*w, *w);
            let moving = speed_squared >= RELATIVE_SPEED_MIN_MPS * RELATIVE_SPEED_MIN_MPS;
            if moving { -dot(*r, *w) / speed_squared } else { f64::NAN }
        };
        let tcpa_s: Vec<f64> = both().map(tcpa).collect();
        let dcpa = |((r, w), tcpa): ((&Plane, &Plane), &f64)| {
            let ahead = if *tcpa > 0.0 { *tcpa } else { 0.0 };
            length((r.0 + ahead * w.0, r.1 + ahead * w.1))
        };
        let dcpa_m = both().zip(&tcpa_s).map(dcpa).collect();
        Self {
            own,
            target,
            kind,
            radii_m,
            position_m,
            velocity_mps,
            range_m,
            range_rate_mps,
            tcpa_s,
            dcpa_m,
        }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.range_m.len()
    }

    /// `beta`: the target from own ship's bow.
    pub fn beta_rad(&self, k: usize) -> f64 {
        let (north, east) = self.position_m[k];
        wrapped_rad(libm::atan2(east, north) - self.own.psi_rad[k])
    }

    /// `alpha`: own ship from the target's bow.
    pub fn alpha_rad(&self, k: usize) -> f64 {
        let (north, east) = self.position_m[k];
        wrapped_rad(libm::atan2(-east, -north) - self.target.psi_rad[k])
    }

    /// Whether one of the two would be overtaking the other, by direction alone.
    pub fn overtaking_geometry(&self, k: usize) -> bool {
        self.beta_rad(k).abs() > ABAFT_THE_BEAM_RAD || self.alpha_rad(k).abs() > ABAFT_THE_BEAM_RAD
    }

    /// Whether the predicted smallest distance, of the campaign's kind, is under `limit_m`.
    ///
    /// Hull to hull the prediction with outlines is made only where the distance of the reference
    /// points, less nothing or less both radii, does not settle it.
    pub fn predicted_within(&self, k: usize, limit_m: f64) -> bool {
        match self.kind {
            DistanceKind::Centre => self.dcpa_m[k] < limit_m,
            DistanceKind::Hull => self.predicted_hull_within(k, limit_m),
        }
    }

    /// Whether the predicted smallest hull-to-hull distance is under `limit_m`.
    pub fn predicted_hull_within(&self, k: usize, limit_m: f64) -> bool {
        if self.dcpa_m[k] - self.radii_m >= limit_m {
            return false;
        }
        if self.reference_points_inside() && self.dcpa_m[k] < limit_m {
            return true;
        }
        self.predicted_hull_m(k) < limit_m
    }

    /// The predicted smallest distance, metres, of the campaign's kind.
    pub fn predicted_m(&self, k: usize) -> f64 {
        match self.kind {
            DistanceKind::Centre => self.dcpa_m[k],
            DistanceKind::Hull => self.predicted_hull_m(k),
        }
    }

    fn predicted_hull_m(&self, k: usize) -> f64 {
        let own = Posed { ship: &self.own.ship, psi_rad: self.own.psi_rad[k] };
        let target = Posed { ship: &self.target.ship, psi_rad: self.target.psi_rad[k] };
        predicted_clearance_m(own, target, self.position_m[k], self.velocity_mps[k])
    }

    /// Where own ship lies to the target's projected track: metres ahead of her bow along
    /// `course`, and metres to starboard of it.
    pub fn ahead_and_abeam_m(&self, k: usize, course: Course) -> Plane {
        let (north, east) = self.line(k, course);
        let (dn, de) = (-self.position_m[k].0, -self.position_m[k].1);
        let hull = &self.target.ship.hull;
        let bow_m = hull.midships_forward_m + hull.length_m / 2.0;
        (dn * north + de * east - bow_m, de * north - dn * east)
    }

    /// How far own hull reaches from its reference point back towards the target along her line.
    fn own_reach_m(&self, k: usize, course: Course) -> f64 {
        let (north, east) = self.line(k, course);
        let (sin, cos) = libm::sincos(self.own.psi_rad[k]);
        let back = |x: f64, y: f64| -(north * (cos * x - sin * y) + east * (sin * x + cos * y));
        let corners = self.own.ship.hull.corners_body_m();
        corners.iter().map(|c| back(c.x, c.y)).fold(0.0, f64::max)
    }

    fn line(&self, k: usize, course: Course) -> Plane {
        match course {
            Course::MadeGood => self.target_course(k),
            Course::Heading => {
                let (sin, cos) = libm::sincos(self.target.psi_rad[k]);
                (cos, sin)
            }
        }
    }

    fn target_course(&self, k: usize) -> Plane {
        let v = (self.target.vel_north_mps[k], self.target.vel_east_mps[k]);
        let speed = length(v);
        if speed < 1e-6 {
            let (sin, cos) = libm::sincos(self.target.psi_rad[k]);
            return (cos, sin);
        }
        (v.0 / speed, v.1 / speed)
    }

    fn reference_points_inside(&self) -> bool {
        [self.own, self.target].iter().all(|track| {
            let hull = &track.ship.hull;
            hull.midships_forward_m.abs() < 0.3 * hull.length_m
                && hull.midships_starboard_m.abs() < 0.3 * hull.beam_m
        })
    }
}

/// Which line is the target's projected track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// Over ground, for Rule 15.
    MadeGood,
    /// The centre line of the ship, for Rule 13(d).
    Heading,
}

/// For every sample the margin, in metres, by which own ship crossed the target's projected track
/// between 0 and `reach_m` ahead of her bow since the sample before: positive where she did,
/// negative by the distance to having done so where she did not. Own reference point must have
/// crossed ahead of the bow; with `hulls` the distance ends at the nearest part of own hull.
pub fn crossing_ahead_m(
    pair: &PairSignals<'_>,
    course: Course,
    reach_m: f64,
    hulls: bool,
) -> Vec<f64> {
    let mut before: Option<Plane> = None;
    (0..pair.samples())
        .map(|k| {
            let (ahead, abeam) = pair.ahead_and_abeam_m(k, course);
            let limit_m = reach_m + if hulls { pair.own_reach_m(k, course) } else { 0.0 };
            let previous = before.replace((ahead, abeam));
            let crossed = previous.filter(|(_, abeam_0)| (*abeam_0 < 0.0) != (abeam < 0.0));
            if let Some((ahead_0, abeam_0)) = crossed {
                let share = abeam_0 / (abeam_0 - abeam);
                let at = ahead_0 + share * (ahead - ahead_0);
                at.min(limit_m - at)
            } else {
                -abeam.abs().max(-ahead).max(ahead - limit_m)
            }
        })
        .collect()
}

fn dot(a: Plane, b: Plane) -> f64 {
    a.0 * b.0 + a.1 * b.1
}

fn length(v: Plane) -> f64 {
    dot(v, v).sqrt()
}
