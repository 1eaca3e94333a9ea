//! The crate's only door to transcendental functions: libm, whose bits are the same on every
//! machine and in every profile (the platform's are not).

/// ln(sqrt(2 pi)).
pub(crate) const LN_SQRT_2PI: f64 = 0.918_938_533_204_672_8;

/// Natural logarithm.
pub(crate) fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// e to the power x.
pub(crate) fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// ln(1 + x), exact near zero.
pub(crate) fn log1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// e^x - 1, exact near zero.
pub(crate) fn expm1(x: f64) -> f64 {
    libm::expm1(x)
}

/// ln of the gamma function of a positive number.
pub(crate) fn lgamma(x: f64) -> f64 {
    libm::lgamma(x)
}

/// x to the power y.
pub(crate) fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// The complementary error function.
pub(crate) fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// ln(sum of e^x), without overflow; minus infinity for an empty or all-minus-infinite input.
pub(crate) fn log_sum_exp(terms: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = terms.clone().fold(f64::NEG_INFINITY, f64::max);
    if largest.is_infinite() {
        return largest;
    }
    largest + ln(terms.map(|term| exp(term - largest)).sum::<f64>())
}

/// A count as a float. Exact below 2^53, far above any campaign.
#[expect(clippy::cast_precision_loss, reason = "counts stay below 2^53")]
pub(crate) fn real(count: u64) -> f64 {
    count as f64
}

/// Where an increasing predicate turns true between `low` (false) and `high` (true), to the last
/// bit of the argument: the pair of neighbours around the switch.
pub(crate) fn bisect(
    mut low: f64,
    mut high: f64,
    mut reached: impl FnMut(f64) -> bool,
) -> (f64, f64) {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return (low, high);
        }
        if reached(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log_sum_exp_survives_huge_terms() {
        let sum = log_sum_exp([2000.0, 2000.0].into_iter());
        assert!((sum - (2000.0 + std::f64::consts::LN_2)).abs() < 1e-12);
        assert!(log_sum_exp(std::iter::empty::<f64>()) < f64::MIN);
    }

    #[test]
    fn bisect_ends_on_neighbouring_floats() {
        let (low, high) = bisect(1.0, 2.0, |x| x * x >= 2.0);
        assert!(low * low < 2.0 && high * high >= 2.0);
        assert_eq!(low.to_bits() + 1, high.to_bits());
    }
}
