//! The Kalman filter of one track: constant velocity under white acceleration (Bar-Shalom, Li and
//! Kirubarajan 2001, Estimation with Applications to Tracking and Navigation, section 6.2.2).
//!
//! The state is position and velocity; its covariance is kept as three blocks of 2 by 2, because
//! every measurement is of one half of the state and every model matrix is a multiple of a unit.

use geom::Vec2;
use nalgebra::Matrix2;

/// A covariance of two components, north and east.
pub type Cov = Matrix2<f64>;

/// Estimated position and velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kalman {
    /// Position, metres north and east.
    pub position_m: Vec2,
    /// Velocity, m/s.
    pub velocity_mps: Vec2,
    /// Covariance of the position.
    pub position_m2: Cov,
    /// Covariance of position (rows) and velocity (columns).
    pub cross: Cov,
    /// Covariance of the velocity.
    pub velocity_mps2: Cov,
}

impl Kalman {
    /// A track from one position, with the velocity and its covariance as known so far.
    pub fn new(position_m: Vec2, position_m2: Cov, velocity_mps: Vec2, velocity_mps2: Cov) -> Self {
        Self { position_m, velocity_mps, position_m2, cross: Cov::zeros(), velocity_mps2 }
    }

    /// The state `dt_s` seconds on; `density` is that of the white acceleration, m^2/s^3.
    pub fn predict(&mut self, dt_s: f64, density: f64) {
        let unit = Cov::identity();
        self.position_m += self.velocity_mps * dt_s;
        self.position_m2 += (self.cross + self.cross.transpose()) * dt_s
            + self.velocity_mps2 * (dt_s * dt_s)
            + unit * (density * dt_s * dt_s * dt_s / 3.0);
        self.cross += self.velocity_mps2 * dt_s + unit * (density * dt_s * dt_s / 2.0);
        self.velocity_mps2 += unit * (density * dt_s);
    }

    /// Squared Mahalanobis distance of a measured position: chi-squared with two degrees of
    /// freedom for one that belongs to this track.
    pub fn distance2(&self, position_m: Vec2, noise_m2: &Cov) -> f64 {
        let off = position_m - self.position_m;
        off.dot(&(inverse(&(self.position_m2 + noise_m2)) * off))
    }

    /// Takes in a measured position; the squared Mahalanobis distance of its innovation.
    pub fn update_position(&mut self, position_m: Vec2, noise_m2: &Cov) -> f64 {
        let off = position_m - self.position_m;
        let weight = inverse(&(self.position_m2 + noise_m2));
        let gain = self.position_m2 * weight;
        let velocity_gain = self.cross.transpose() * weight;
        self.position_m += gain * off;
        self.velocity_mps += velocity_gain * off;
        self.velocity_mps2 = symmetric(self.velocity_mps2 - velocity_gain * self.cross);
        self.cross -= gain * self.cross;
        self.position_m2 = symmetric(self.position_m2 - gain * self.position_m2);
        off.dot(&(weight * off))
    }

    /// Takes in a measured velocity; the squared Mahalanobis distance of its innovation.
    pub fn update_velocity(&mut self, velocity_mps: Vec2, noise_mps2: &Cov) -> f64 {
        let off = velocity_mps - self.velocity_mps;
        let weight = inverse(&(self.velocity_mps2 + noise_mps2));
        let gain = self.velocity_mps2 * weight;
        let position_gain = self.cross * weight;
        self.velocity_mps += gain * off;
        self.position_m += position_gain * off;
        self.position_m2 = symmetric(self.position_m2 - position_gain * self.cross.transpose());
        self.cross -= position_gain * self.velocity_mps2;
        self.velocity_mps2 = symmetric(self.velocity_mps2 - gain * self.velocity_mps2);
        off.dot(&(weight * off))
    }

    /// The whole covariance of (north, east, north velocity, east velocity), row by row.
    pub fn covariance(&self) -> [[f64; 4]; 4] {
        let (a, b, c) = (&self.position_m2, &self.cross, &self.velocity_mps2);
        [
            [a.m11, a.m12, b.m11, b.m12],
            [a.m21, a.m22, b.m21, b.m22],
            [b.m11, b.m21, c.m11, c.m12],
            [b.m12, b.m22, c.m21, c.m22],
        ]
    }
}

/// The inverse of a covariance, which is positive definite.
pub(crate) fn inverse(m: &Cov) -> Cov {
    let determinant = m.m11 * m.m22 - m.m12 * m.m21;
    Cov::new(m.m22, -m.m12, -m.m21, m.m11) / determinant
}

fn symmetric(m: Cov) -> Cov {
    let off = 0.5 * (m.m12 + m.m21);
    Cov::new(m.m11, off, off, m.m22)
}

/// The covariance with `along` (a variance) in the direction of a unit vector and `across` square
/// to it.
pub(crate) fn oriented(direction: Vec2, along: f64, across: f64) -> Cov {
    let (c, s) = (direction.x, direction.y);
    let off = (along - across) * c * s;
    Cov::new(along * c * c + across * s * s, off, off, along * s * s + across * c * c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{EncounterId, Purpose, Seed, Stream, Streams};

    fn stream(j: u64) -> Stream {
        Streams::new(Seed(11), &EncounterId::new("kalman", j)).stream(Purpose::Sensor, 0)
    }

    /// A target that moves as the model says, seen as the noise says: the normalised innovations
    /// and the normalised error of the state are chi-squared, and their means lie where 4.5
    /// standard errors allow (Bar-Shalom, section 5.4). Half the noise breaks it.
    #[test]
    fn innovations_and_errors_are_as_large_as_the_filter_says() {
        let (density, dt_s, steps, runs): (f64, f64, u32, u32) = (0.04, 2.5, 40, 200);
        let position_m2 = oriented(geom::unit(0.6), 100.0, 900.0);
        let velocity_mps2 = Cov::identity() * 0.25;
        let (mut nis, mut count, mut nees) = (0.0, 0.0, 0.0);
        for run in 0..runs {
            let mut s = stream(u64::from(run));
            let mut pair = |sd: f64| Vec2::new(sd * s.normal(), sd * s.normal());
            let (mut x, mut v) = (Vec2::new(500.0, -200.0), pair(5.0));
            let noise = |n: Vec2| geom::angle::rotate(Vec2::new(10.0 * n.x, 30.0 * n.y), 0.6);
            let first = x + noise(pair(1.0));
            let mut filter = Kalman::new(first, position_m2, Vec2::zeros(), Cov::identity() * 25.0);
            for k in 0..steps {
                // exact discretisation of white acceleration: two correlated normals an axis
                let (a, b) = (pair(1.0), pair(1.0));
                let dv = a * (density * dt_s).sqrt();
                let spread = (density * dt_s * dt_s * dt_s / 12.0).sqrt();
                x += v * dt_s + dv * (dt_s / 2.0) + b * spread;
                v += dv;
                filter.predict(dt_s, density);
                nis += filter.update_position(x + noise(pair(1.0)), &position_m2);
                count += 1.0;
                if k % 3 == 0 {
                    nis += filter.update_velocity(v + pair(0.5), &velocity_mps2);
                    count += 1.0;
                }
            }
            let off = x - filter.position_m;
            nees += off.dot(&(inverse(&filter.position_m2) * off));
        }
        // chi-squared of 2: mean 2, variance 4
        let (nis, nees) = (nis / count, nees / f64::from(runs));
        assert!((nis - 2.0).abs() < 4.5 * 2.0 / f64::sqrt(count), "{nis}");
        assert!((nees - 2.0).abs() < 4.5 * 2.0 / f64::from(runs).sqrt(), "{nees}");
    }

    /// Two positions without process noise: the velocity is their difference over the time, and
    /// its variance the sum of theirs over the time squared.
    #[test]
    fn two_positions_make_a_velocity() {
        let noise = Cov::identity() * 4.0;
        let mut filter = Kalman::new(Vec2::zeros(), noise, Vec2::zeros(), Cov::identity() * 1e8);
        filter.predict(10.0, 0.0);
        filter.update_position(Vec2::new(50.0, -20.0), &noise);
        assert!((filter.velocity_mps - Vec2::new(5.0, -2.0)).norm() < 1e-5);
        assert!((filter.velocity_mps2.m11 - 0.08).abs() < 1e-6);
        assert!((filter.cross.m11 - 0.4).abs() < 1e-6);
    }
}
