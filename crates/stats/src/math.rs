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

/// The ends of a bracket, at most 1e-12 of `high` apart, in which `f` rises from below zero to zero
/// or above, found by the Illinois rule: a fraction of the evaluations of [`bisect`], for an `f`
/// that costs something. `f(low) < 0 <= f(high)`.
pub(crate) fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut at_low, mut at_high) = (f(low), f(high));
    let mut rose_last = None;
    let mut before = high - low;
    for step in 1.. {
        let width = high - low;
        if width <= 1e-12 * high {
            break;
        }
        let aimed = high - width * at_high / (at_high - at_low);
        // a little inside, so that both ends move
        let mut middle = aimed.clamp(low + 1e-3 * width, high - 1e-3 * width);
        if step % 4 == 0 {
            // where aiming gains less than halving would, halve
            middle = if width > 0.25 * before { low + 0.5 * width } else { middle };
            before = width;
        }
        if middle <= low || middle >= high {
            break;
        }
        let value = f(middle);
        let rose = value >= 0.0;
        if rose {
            (high, at_high) = (middle, value);
            at_low *= if rose_last == Some(true) { 0.5 } else { 1.0 };
        } else {
            (low, at_low) = (middle, value);
            at_high *= if rose_last == Some(false) { 0.5 } else { 1.0 };
        }
        rose_last = Some(rose);
    }
    (low, high)
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
    fn root_encloses_what_bisect_finds_in_fewer_steps() {
        // the last one is a jump, for which halving is the best there is
        type Case = (f64, fn(f64) -> f64, i32);
        let functions: [Case; 4] = [
            (2.0, |x| x * x - 2.0, 15),
            (64.0, |x| x - 1e-6, 15),
            (1.0, |x| ln(x.max(1e-300)) + 11.0, 30),
            (4.0, |x| if x < 3.0 { -1e-9 } else { x }, 180),
        ];
        for (high, f, most) in functions {
            let steps = std::cell::Cell::new(0);
            let counted = |x: f64| {
                steps.set(steps.get() + 1);
                f(x)
            };
            let (root, exact) = (root(0.0, high, counted), bisect(0.0, high, |x| f(x) >= 0.0));
            assert!(root.0 <= exact.1 && exact.0 <= root.1, "{root:?} {exact:?}");
            assert!(f(root.0) < 0.0 && f(root.1) >= 0.0);
            assert!(root.1 - root.0 <= 1e-12 * root.1 && steps.get() < most, "{}", steps.get());
        }
    }

    #[test]
    fn bisect_ends_on_neighbouring_floats() {
        let (low, high) = bisect(1.0, 2.0, |x| x * x >= 2.0);
        assert!(low * low < 2.0 && high * high >= 2.0);
        assert_eq!(low.to_bits() + 1, high.to_bits());
    }
}
