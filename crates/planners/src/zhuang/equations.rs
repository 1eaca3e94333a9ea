//! Equations (1) to (18) of the paper, and the exact solutions that its first-order step aims at.
//!
//! The paper's symbols: own ship A with speed `v_a` and course `alpha`, obstacle B with `v_b` and
//! `beta`, line of sight `theta` from A to B, range `d`, safety radius `r`. Metres, seconds and
//! radians; angles counter-clockwise, so positive is to port. `gamma` and `varphi` are signed.

use geom::{math, wrap};
use std::f64::consts::{FRAC_PI_2, PI};

/// Below this relative speed, in m/s, the direction of dV means nothing: (4) is 0/0.
pub const DV_MIN_MPS: f64 = 1e-6;

/// (1): the components of dV = V_A - V_B along and across the line of sight; V_s > 0 closes.
pub fn los_rates(v_a: f64, alpha: f64, v_b: f64, beta: f64, theta: f64) -> (f64, f64) {
    let (sin_a, cos_a) = math::sin_cos(alpha - theta);
    let (sin_b, cos_b) = math::sin_cos(beta - theta);
    (v_a * cos_a - v_b * cos_b, v_a * sin_a - v_b * sin_b)
}

/// (2) as printed: NaN inside the safety circle, where the root is of a negative number.
pub fn mu_as_printed(r: f64, d: f64) -> f64 {
    math::atan(r / (d * d - r * r).sqrt())
}

/// (2) in its other form, asin(R/D), with the limit pi/2 on and inside the safety circle.
pub fn mu(r: f64, d: f64) -> f64 {
    if d > r { math::asin(r / d) } else { FRAC_PI_2 }
}

/// (4) as printed: folds `gamma` and `gamma + pi`, so that a receding target looks like one ahead.
pub fn gamma_as_printed(v_s: f64, v_theta: f64) -> f64 {
    math::atan(v_theta / v_s)
}

/// (4) with its quadrant: the signed angle from the line of sight to dV.
pub fn gamma(v_s: f64, v_theta: f64) -> f64 {
    math::atan2(v_theta, v_s)
}

/// (3) with the sense that makes it true: closing, and dV inside the cone.
pub fn collision(v_s: f64, gamma: f64, mu: f64) -> bool {
    v_s > 0.0 && gamma.abs() <= mu
}

/// (13): the modulus of dV.
pub fn dv(v_a: f64, alpha: f64, v_b: f64, beta: f64) -> f64 {
    (v_a * v_a + v_b * v_b - 2.0 * v_a * v_b * math::cos(alpha - beta)).max(0.0).sqrt()
}

/// Heading of dV, the upright phi of the paper.
pub fn phi(v_a: f64, alpha: f64, v_b: f64, beta: f64) -> f64 {
    let (sin_a, cos_a) = math::sin_cos(alpha);
    let (sin_b, cos_b) = math::sin_cos(beta);
    math::atan2(v_a * sin_a - v_b * sin_b, v_a * cos_a - v_b * cos_b)
}

/// The slanted phi: the angle from dV to V_A, the only orientation in which (11) holds.
pub fn varphi(alpha: f64, phi: f64) -> f64 {
    wrap(alpha - phi)
}

/// (17) with signed gamma: to the edge on side `s`, -1 for the right edge and +1 for the left.
pub fn dgamma(s: f64, mu: f64, gamma: f64) -> f64 {
    s * mu - gamma
}

/// A change of own velocity in polar form: (d_alpha in radians, d_va in m/s).
pub type PolarChange = (f64, f64);

/// (18): V_A d_alpha = dV dgamma cos(varphi), d_va = dV dgamma sin(varphi). `v_a` = 0 divides by
/// zero, as the paper does.
pub fn step(v_a: f64, dv: f64, dgamma: f64, varphi: f64) -> PolarChange {
    let (sin, cos) = math::sin_cos(varphi);
    (dv * dgamma * cos / v_a, dv * dgamma * sin)
}

/// The smallest (V_A d_alpha, d_va) that satisfies (10): what (16) chooses and (18) states, found
/// here from the coefficients of (10) alone, without varphi.
pub fn step_by_least_norm(v_a: f64, alpha: f64, v_b: f64, beta: f64, dgamma: f64) -> PolarChange {
    let (sin, cos) = math::sin_cos(alpha - beta);
    let dv_squared = v_a * v_a + v_b * v_b - 2.0 * v_a * v_b * cos;
    let (by_va, by_arc) = (-v_b * sin / dv_squared, (v_a - v_b * cos) / dv_squared);
    let scale = dgamma / (by_va * by_va + by_arc * by_arc);
    (by_arc * scale / v_a, by_va * scale)
}

/// The exact least change of own velocity that puts dV on the edge `lambda` = theta + s mu of the
/// cone: the projection of dV on that edge, or its apex. Gives (speed, course).
pub fn exact_least_norm(v_a: f64, alpha: f64, v_b: f64, beta: f64, lambda: f64) -> (f64, f64) {
    let (sin_a, cos_a) = math::sin_cos(alpha);
    let (sin_b, cos_b) = math::sin_cos(beta);
    let (sin_l, cos_l) = math::sin_cos(lambda);
    let (dv_x, dv_y) = (v_a * cos_a - v_b * cos_b, v_a * sin_a - v_b * sin_b);
    let along = (dv_x * cos_l + dv_y * sin_l).max(0.0);
    let (x, y) = (along * cos_l + v_b * cos_b, along * sin_l + v_b * sin_b);
    (math::length(x, y), math::atan2(y, x))
}

/// The course that puts dV on the edge `lambda` at the present speed; of two the nearer one, none
/// where no course does.
pub fn exact_heading_only(v_a: f64, alpha: f64, v_b: f64, beta: f64, lambda: f64) -> Option<f64> {
    let k = v_b * math::sin(beta - lambda) / v_a;
    if k.abs() > 1.0 || k.is_nan() {
        return None;
    }
    let along_b = v_b * math::cos(beta - lambda);
    let asin_k = math::asin(k);
    [lambda + asin_k, lambda + PI - asin_k]
        .into_iter()
        .filter(|course| v_a * math::cos(course - lambda) - along_b > 0.0)
        .map(wrap)
        .min_by(|a, b| wrap(a - alpha).abs().total_cmp(&wrap(b - alpha).abs()))
}

/// Signed distance at the closest point: positive when B passes on the right hand of dV's reverse,
/// that is, when gamma is negative.
pub fn dcpa_signed(d: f64, gamma: f64) -> f64 {
    -d * math::sin(gamma)
}

/// Time to the closest point, seconds; negative once it has passed.
pub fn tcpa(d: f64, v_s: f64, dv: f64) -> f64 {
    d * v_s / (dv * dv)
}
