//! The order that a ship carries out: a heading and a speed through the water.

use geom::{Vec2, angle};

/// An order, made once a beat from a course and speed over ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Helm {
    /// Heading to steer, radians clockwise from north, wrapped.
    pub psi_rad: f64,
    /// Its unit vector.
    pub direction: Vec2,
    /// Speed through the water, m/s.
    pub speed_mps: f64,
}

/// Below this the velocity through the water gives no direction to steer, m/s.
const DIRECTION_MPS_MIN: f64 = 1e-6;

impl Helm {
    /// The heading and speed through the water that give a course and speed over ground in a
    /// constant current: the velocity triangle, current known from log and satellite navigation.
    /// A ship that is ordered to stop in a current stems it.
    pub fn over_ground(course_rad: f64, speed_mps: f64, current_mps: Vec2) -> Self {
        let direction = geom::unit(course_rad);
        if current_mps.norm_squared() <= 0.0 {
            return Self { psi_rad: course_rad, direction, speed_mps };
        }
        let water_mps = direction * speed_mps - current_mps;
        let speed_mps = water_mps.norm();
        if speed_mps < DIRECTION_MPS_MIN {
            return Self { psi_rad: course_rad, direction, speed_mps: 0.0 };
        }
        let psi_rad = geom::wrap(angle::direction(water_mps));
        Self { psi_rad, direction: water_mps / speed_mps, speed_mps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    #[test]
    fn calm_water_changes_nothing() {
        let helm = Helm::over_ground(0.7, 5.0, Vec2::zeros());
        assert_eq!(
            (helm.psi_rad.to_bits(), helm.speed_mps.to_bits()),
            (0.7f64.to_bits(), 5f64.to_bits())
        );
    }

    #[test]
    fn crab_angle_solves_the_velocity_triangle() {
        // 4 m/s north over ground against 3 m/s of current to the east: 5 m/s, 36.87 deg to port
        let helm = Helm::over_ground(0.0, 4.0, Vec2::new(0.0, 3.0));
        assert!((helm.speed_mps - 5.0).abs() < 1e-12);
        assert!((helm.psi_rad - deg(-36.869_897_645_844_02)).abs() < 1e-12);
    }

    #[test]
    fn ordered_to_stop_she_stems_the_current() {
        let helm = Helm::over_ground(0.0, 0.0, Vec2::new(0.0, 1.5));
        assert!((helm.psi_rad - deg(-90.0)).abs() < 1e-12);
        assert!((helm.speed_mps - 1.5).abs() < 1e-12);
    }
}
