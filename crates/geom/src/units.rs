//! Degrees, knots and nautical miles: for files and reports, never inside.

use std::f64::consts::PI;

/// Metres in an international nautical mile (exact).
pub const NAUTICAL_MILE_M: f64 = 1852.0;

/// Degrees to radians.
#[inline]
pub const fn deg(degrees: f64) -> f64 {
    degrees * (PI / 180.0)
}

/// Radians to degrees.
#[inline]
pub const fn to_deg(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

/// Knots to metres a second.
#[inline]
pub const fn knots(kn: f64) -> f64 {
    kn * (NAUTICAL_MILE_M / 3600.0)
}

/// Metres a second to knots.
#[inline]
pub const fn to_knots(mps: f64) -> f64 {
    mps * (3600.0 / NAUTICAL_MILE_M)
}
