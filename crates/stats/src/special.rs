//! Normal, gamma, chi-squared, beta and Student distributions: tails and quantiles.
//!
//! Every tail is (density) x (series or continued fraction); the density goes through Loader's
//! saddle point, so that nothing cancels at large arguments, and every quantile is a bisection of
//! the tail that is wanted. References: C. Loader, "Fast and accurate computation of binomial
//! probabilities" (2000); NIST Digital Library of Mathematical Functions 8.11.4, 8.9.2, 8.17.22.

use crate::error::{StatsError, check_open, check_unit};
use crate::math::{LN_SQRT_2PI, bisect, erfc, exp, expm1, lgamma, ln, log1p};

/// Standard normal distribution function at `z`.
#[must_use]
pub fn normal_cdf(z: f64) -> f64 {
    0.5 * erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// Standard normal quantile at lower-tail probability `p`.
///
/// # Errors
/// `p` outside (0, 1).
pub fn normal_quantile(p: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    if p > 0.5 {
        // 1 - p is exact here, and the lower tail keeps its relative precision.
        return normal_quantile(1.0 - p).map(|z| -z);
    }
    Ok(bisect(-39.0, 0.0, |z| normal_cdf(z) >= p).1)
}

/// Lower tail P(a, x) of the gamma distribution with shape `a` > 0 at `x` >= 0.
#[must_use]
pub fn regularized_gamma_lower(a: f64, x: f64) -> f64 {
    gamma_tails(a, x).0
}

/// Upper tail Q(a, x) of the gamma distribution with shape `a` > 0 at `x` >= 0.
#[must_use]
pub fn regularized_gamma_upper(a: f64, x: f64) -> f64 {
    gamma_tails(a, x).1
}

/// Chi-squared quantile with `freedom` > 0 (any real number) degrees of freedom at lower-tail
/// probability `p`.
///
/// # Errors
/// `p` outside (0, 1) or `freedom` not positive and finite.
pub fn chi_squared_quantile(p: f64, freedom: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_open("degrees of freedom", freedom, 0.0, f64::INFINITY)?;
    let shape = 0.5 * freedom;
    let reached = |ln_x: f64| {
        let (lower, upper) = gamma_tails(shape, exp(ln_x));
        if p < 0.5 { lower >= p } else { upper <= 1.0 - p }
    };
    let mut high = ln(shape) + 1.0;
    while !reached(high) {
        high += 1.0;
    }
    let mut step = 1.0;
    let mut low = high - step;
    while reached(low) {
        if low < -700.0 {
            return Ok(0.0);
        }
        step *= 2.0;
        low -= step;
    }
    Ok(2.0 * exp(bisect(low, high, reached).1))
}

/// I_x(a, b), the distribution function of Beta(a, b) at `x` in [0, 1].
#[must_use]
pub fn regularized_beta(a: f64, b: f64, x: f64) -> f64 {
    beta_tails(a, b, x, 1.0 - x).0
}

/// Quantile of Beta(a, b) at lower-tail probability `p`.
///
/// # Errors
/// `p` outside (0, 1), or a shape that is not positive and finite.
pub fn beta_quantile(p: f64, a: f64, b: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_open("shape a", a, 0.0, f64::INFINITY)?;
    check_open("shape b", b, 0.0, f64::INFINITY)?;
    if a > b {
        // The quantile near 1 is the mirror of one near 0, where the logarithm resolves it.
        return Ok(-expm1(ln_beta_quantile(b, a, |lower, upper| at_least(upper, lower, p))));
    }
    Ok(exp(ln_beta_quantile(a, b, |lower, upper| at_least(lower, upper, p))))
}

/// Quantile of Student's t with `freedom` > 0 degrees of freedom at lower-tail probability `p`.
///
/// # Errors
/// `p` outside (0, 1) or `freedom` not positive and finite.
pub fn student_t_quantile(p: f64, freedom: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_open("degrees of freedom", freedom, 0.0, f64::INFINITY)?;
    if p > 0.5 {
        return student_t_quantile(1.0 - p, freedom).map(|t| -t);
    }
    // P(T < -t) = I_x(f/2, 1/2) / 2 at x = f / (f + t^2).
    let tail = |t: f64| {
        let total = freedom + t * t;
        0.5 * beta_tails(0.5 * freedom, 0.5, freedom / total, t * t / total).0
    };
    let mut high = 1.0;
    while tail(high) > p && high < 1e150 {
        high *= 2.0;
    }
    Ok(-bisect(0.0, high, |t| tail(t) <= p).1)
}

/// `lower` >= p, decided in the smaller tail.
fn at_least(lower: f64, upper: f64, p: f64) -> bool {
    if p < 0.5 { lower >= p } else { upper <= 1.0 - p }
}

/// ln of the point at which `reached(I_x, 1 - I_x)` changes its answer.
fn ln_beta_quantile(a: f64, b: f64, reached: impl Fn(f64, f64) -> bool) -> f64 {
    let at = |ln_x: f64| {
        let (lower, upper) = beta_tails(a, b, exp(ln_x), -expm1(ln_x));
        reached(lower, upper)
    };
    // Growing x raises the lower tail; in the mirrored call the answer runs the other way.
    let rising = !at(-700.0);
    bisect(-700.0, 0.0, |ln_x| at(ln_x) == rising).1
}

/// Both tails (P, Q) of the gamma distribution with shape `a` at `x`.
fn gamma_tails(a: f64, x: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (0.0, 1.0);
    }
    // x^a e^-x / Gamma(a + 1)
    let density = exp(-stirling_error(a) - deviance(a, x, a - x) - LN_SQRT_2PI - 0.5 * ln(a));
    if x < a + 1.0 {
        let mut term = 1.0;
        let mut sum = 1.0;
        let mut shape = a;
        while term > 1e-18 * sum {
            shape += 1.0;
            term *= x / shape;
            sum += term;
        }
        let lower = density * sum;
        (lower, 1.0 - lower)
    } else {
        let upper = density * a * gamma_fraction(a, x);
        (1.0 - upper, upper)
    }
}

/// Gamma(a, x) e^x x^-a as a continued fraction (DLMF 8.9.2), by the modified Lentz method.
fn gamma_fraction(a: f64, x: f64) -> f64 {
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut value = d;
    let mut i = 0.0;
    loop {
        i += 1.0;
        let numerator = -i * (i - a);
        b += 2.0;
        d = 1.0 / away_from_zero(numerator * d + b);
        c = away_from_zero(b + numerator / c);
        let factor = d * c;
        value *= factor;
        if (factor - 1.0).abs() < 3e-16 || i > 1e7 {
            return value;
        }
    }
}

/// Both tails (I_x, 1 - I_x) of Beta(a, b), given `x` and `y` = 1 - x.
fn beta_tails(a: f64, b: f64, x: f64, y: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (0.0, 1.0);
    }
    if y <= 0.0 {
        return (1.0, 0.0);
    }
    // x^a y^b / B(a, b), as a saddle point about a / (a + b).
    let n = a + b;
    let offset = a * y - b * x;
    let ln_density = stirling_error(n)
        - stirling_error(a)
        - stirling_error(b)
        - deviance(a, n * x, offset)
        - deviance(b, n * y, -offset)
        + 0.5 * (ln(a) + ln(b) - ln(n))
        - LN_SQRT_2PI;
    let density = exp(ln_density);
    if x < (a + 1.0) / (n + 2.0) {
        let lower = density * beta_fraction(a, b, x) / a;
        (lower, 1.0 - lower)
    } else {
        let upper = density * beta_fraction(b, a, y) / b;
        (1.0 - upper, upper)
    }
}

/// The continued fraction of I_x(a, b) (DLMF 8.17.22), by the modified Lentz method.
fn beta_fraction(a: f64, b: f64, x: f64) -> f64 {
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut value = d;
    let mut m = 0.0;
    loop {
        m += 1.0;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / away_from_zero(1.0 + even * d);
        c = away_from_zero(1.0 + even / c);
        value *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / away_from_zero(1.0 + odd * d);
        c = away_from_zero(1.0 + odd / c);
        let factor = d * c;
        value *= factor;
        if (factor - 1.0).abs() < 3e-16 || m > 1e7 {
            return value;
        }
    }
}

/// Lentz's guard against a zero denominator.
const TINY: f64 = 1e-300;

fn away_from_zero(x: f64) -> f64 {
    if x.abs() < TINY { TINY } else { x }
}

/// ln Gamma(x + 1) - [(x + 1/2) ln x - x + ln sqrt(2 pi)]: what Stirling's formula leaves out,
/// for x > 0.
pub(crate) fn stirling_error(x: f64) -> f64 {
    if x < 16.0 {
        if let Some(&known) = STIRLING_ERRORS.get(x as usize)
            && x.fract().abs() < f64::MIN_POSITIVE
        {
            return known;
        }
        return lgamma(x + 1.0) - (x + 0.5) * ln(x) + x - LN_SQRT_2PI;
    }
    // The asymptotic series; the term after these is below 1e-16 from 16 on.
    let r = 1.0 / x;
    let r2 = r * r;
    let tail = 1.0 / 1188.0 - r2 * 691.0 / 360_360.0;
    let tail = 1.0 / 1680.0 - r2 * tail;
    let tail = 1.0 / 1260.0 - r2 * tail;
    let tail = 1.0 / 360.0 - r2 * tail;
    r * (1.0 / 12.0 - r2 * tail)
}

/// Stirling errors of 0..=15, to 17 digits; that of 0 is never used.
const STIRLING_ERRORS: [f64; 16] = [
    f64::INFINITY,
    0.081_061_466_795_327_26,
    0.041_340_695_955_409_3,
    0.027_677_925_684_998_34,
    0.020_790_672_103_765_093,
    0.016_644_691_189_821_193,
    0.013_876_128_823_070_748,
    0.011_896_709_945_891_77,
    0.010_411_265_261_972_096,
    0.009_255_462_182_712_733,
    0.008_330_563_433_362_87,
    0.007_573_675_487_951_841,
    0.006_942_840_107_209_53,
    0.006_408_994_188_004_207,
    0.005_951_370_112_758_847_5,
    0.005_554_733_551_962_801,
];

/// Loader's bd0: x ln(x / mean) + mean - x, given x - mean as exactly as the caller can.
pub(crate) fn deviance(x: f64, mean: f64, x_minus_mean: f64) -> f64 {
    if x_minus_mean.abs() < 0.1 * (x + mean) {
        let v = x_minus_mean / (x + mean);
        let v2 = v * v;
        let mut sum = x_minus_mean * v;
        let mut power = 2.0 * x * v;
        let mut odd = 1.0;
        loop {
            power *= v2;
            odd += 2.0;
            let next = sum + power / odd;
            if (next - sum).abs() <= 0.0 {
                return next;
            }
            sum = next;
        }
    }
    x * ln(x / mean) - x_minus_mean
}

/// ln B(a, b) for a, b > 0, by Stirling's formula with its errors put back, so that the large
/// parts cancel on paper and not in floating point.
pub(crate) fn ln_beta(a: f64, b: f64) -> f64 {
    if a < 1e-8 || b < 1e-8 {
        return lgamma(a) + lgamma(b) - lgamma(a + b);
    }
    let n = a + b;
    let (small, large) = if a < b { (a, b) } else { (b, a) };
    LN_SQRT_2PI
        + 0.5 * (ln(n) - ln(a) - ln(b))
        + small * ln(small / n)
        + large * log1p(-small / n)
        + stirling_error(a)
        + stirling_error(b)
        - stirling_error(n)
}

/// Expected values: mpmath, 30 digits, by bisection of its tails.
#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, want: f64) {
        assert!((got - want).abs() <= 1e-13 * want.abs(), "got {got:e}, want {want:e}");
    }

    #[test]
    fn normal_quantiles() {
        for (p, z) in [
            (1e-300, -37.047_096_299_361_2),
            (1e-6, -4.753_424_308_822_899),
            (0.025, -1.959_963_984_540_054),
            (0.2, -0.841_621_233_572_914_2),
            (0.975, 1.959_963_984_540_054),
        ] {
            close(normal_quantile(p).unwrap(), z);
        }
        assert!(normal_quantile(0.5).unwrap().abs() < 1e-15);
        assert!(normal_quantile(0.0).is_err() && normal_quantile(f64::NAN).is_err());
    }

    #[test]
    fn chi_squared_quantiles() {
        for (p, freedom, x) in [
            (0.025, 0.5, 5.273_202_591_259_992e-7),
            (0.975, 2.0, 7.377_758_908_227_873),
            (0.95, 42.0, 58.124_037_680_868_03),
            (0.999, 7.3, 24.868_517_818_537_08),
            (0.025, 2000.5, 1_878.430_541_583_551),
            (1e-6, 13.0, 0.802_642_826_464_245),
        ] {
            close(chi_squared_quantile(p, freedom).unwrap(), x);
        }
        assert!(chi_squared_quantile(0.5, 0.0).is_err());
    }

    #[test]
    fn beta_quantiles() {
        for (p, a, b, x) in [
            (0.025, 0.5, 10.5, 4.789_043_315_758_182e-5),
            (0.975, 3.5, 2.25, 0.923_494_566_858_640_3),
            (0.3, 40.0, 0.7, 0.979_877_787_656_204_9),
            (1e-6, 100.5, 900.5, 0.061_053_439_171_197_19),
        ] {
            close(beta_quantile(p, a, b).unwrap(), x);
        }
        assert!(beta_quantile(0.5, -1.0, 2.0).is_err());
    }

    /// Where the inverse of the binomial bound and of the beta meet: a check of both.
    #[test]
    fn beta_quantile_is_the_binomial_bound() {
        for (k, n) in [(1_u32, 20_u32), (100, 2_000), (7, 8), (1000, 1_000_000)] {
            let upper = beta_quantile(0.975, f64::from(k) + 1.0, f64::from(n - k)).unwrap();
            let exact = crate::clopper_pearson_upper(k.into(), n.into(), 0.025).unwrap();
            assert!((upper / exact - 1.0).abs() < 1e-12, "{k} {n}: {upper:e} {exact:e}");
        }
    }

    #[test]
    fn logarithm_of_beta() {
        close(ln_beta(0.5, 1_000_000.5), -6.335_390_461_057_437);
        close(ln_beta(100_000.5, 1e9), -1_021_048.479_725_761_8);
    }

    #[test]
    fn tails_are_complementary() {
        for (a, x) in [(0.3, 0.1), (5.0, 9.0), (1e6, 1.001e6)] {
            let sum = regularized_gamma_lower(a, x) + regularized_gamma_upper(a, x);
            assert!((sum - 1.0).abs() < 1e-15);
        }
        let sum = regularized_beta(2.5, 7.0, 0.3) + regularized_beta(7.0, 2.5, 0.7);
        assert!((sum - 1.0).abs() < 1e-14);
    }
}
