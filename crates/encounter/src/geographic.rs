//! From geographic positions to the north-east plane.
//!
//! The plane touches the WGS-84 ellipsoid at its origin. A place is projected on it along the
//! vertical of the origin: geodetic to earth-centred, earth-fixed coordinates, and from there to
//! north and east (Fossen 2011, section 2.3). So the bearing from the origin is the true one. The
//! shorter way, differences of latitude and longitude times the radii of curvature, forgets that
//! meridians converge: ten nautical miles off at 60 degrees of latitude that is half a per cent of
//! the easting, which moved one of DNV's head-on encounters across the border of its class.

use geom::units::deg;
use geom::{Vec2, math};

/// Semi-major axis of WGS-84, metres.
const SEMI_MAJOR_M: f64 = 6_378_137.0;
/// Flattening of WGS-84.
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// A geographic position, degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geographic {
    /// Latitude, positive north.
    pub lat_deg: f64,
    /// Longitude, positive east.
    pub lon_deg: f64,
}

/// The plane at one point of the earth.
#[derive(Clone, Copy, Debug)]
pub struct TangentPlane {
    /// Earth-centred, earth-fixed, metres.
    origin_m: [f64; 3],
    north: [f64; 3],
    east: [f64; 3],
}

impl TangentPlane {
    /// The plane at `origin`.
    pub fn new(origin: Geographic) -> Self {
        let (sin_lat, cos_lat) = math::sin_cos(deg(origin.lat_deg));
        let (sin_lon, cos_lon) = math::sin_cos(deg(origin.lon_deg));
        Self {
            origin_m: origin.earth_centred_m(),
            north: [-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat],
            east: [-sin_lon, cos_lon, 0.0],
        }
    }

    /// Metres north and east of the origin.
    pub fn position_m(&self, place: Geographic) -> Vec2 {
        let there_m = place.earth_centred_m();
        let along =
            |axis: [f64; 3]| (0..3).map(|i| (there_m[i] - self.origin_m[i]) * axis[i]).sum::<f64>();
        Vec2::new(along(self.north), along(self.east))
    }
}

impl Geographic {
    /// Earth-centred, earth-fixed coordinates of a place at height 0.
    fn earth_centred_m(self) -> [f64; 3] {
        let (sin_lat, cos_lat) = math::sin_cos(deg(self.lat_deg));
        let (sin_lon, cos_lon) = math::sin_cos(deg(self.lon_deg));
        let eccentricity_squared = FLATTENING * (2.0 - FLATTENING);
        let prime_vertical_m =
            SEMI_MAJOR_M / (1.0 - eccentricity_squared * sin_lat * sin_lat).sqrt();
        [
            prime_vertical_m * cos_lat * cos_lon,
            prime_vertical_m * cos_lat * sin_lon,
            prime_vertical_m * (1.0 - eccentricity_squared) * sin_lat,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths of a degree on WGS-84 as tables give them (NGA, "Length of a Degree of Latitude and
    /// Longitude"): 111 412.2 m and 55 800.0 m at 60 degrees, 110 574.3 m and 111 319.5 m at the
    /// equator. A minute either way is short enough for the plane.
    #[test]
    fn a_minute_has_its_length() {
        for (lat_deg, north_m, east_m) in [(60.0, 111_412.2, 55_800.0), (0.0, 110_574.3, 111_319.5)]
        {
            let plane = TangentPlane::new(Geographic { lat_deg, lon_deg: 10.0 });
            let minute = 1.0 / 60.0;
            let north = plane.position_m(Geographic { lat_deg: lat_deg + minute, lon_deg: 10.0 });
            let east = plane.position_m(Geographic { lat_deg, lon_deg: 10.0 + minute });
            assert!((north.x * 60.0 - north_m).abs() < 1.0, "{} {north_m}", north.x * 60.0);
            assert!((east.y * 60.0 - east_m).abs() < 1.0, "{} {east_m}", east.y * 60.0);
            assert!(north.y.abs() < 1e-6, "{}", north.y);
        }
    }

    /// A place due east on the same parallel lies north of the plane's east axis, by half the
    /// square of the way times tan(latitude) over the radius, because meridians converge.
    #[test]
    fn a_parallel_bends_to_the_pole() {
        let plane = TangentPlane::new(Geographic { lat_deg: 60.0, lon_deg: 0.0 });
        let place = plane.position_m(Geographic { lat_deg: 60.0, lon_deg: 0.2 });
        let expected_m = place.y * place.y * 3f64.sqrt() / (2.0 * 6.394e6);
        assert!((place.x - expected_m).abs() < 0.01 * expected_m, "{} {expected_m}", place.x);
    }

    #[test]
    fn the_date_line_is_crossed_the_short_way() {
        let plane = TangentPlane::new(Geographic { lat_deg: 0.0, lon_deg: 179.9 });
        let place = plane.position_m(Geographic { lat_deg: 0.0, lon_deg: -179.9 });
        assert!((place.y - 0.2 * 111_319.5).abs() < 1.0, "{}", place.y);
    }
}
