//! A small deterministic generator for tests and the coverage study: SplitMix64 (Steele, Lea and
//! Flood, 2014), with the draws that simulated counts need.

/// The generator.
#[derive(Debug)]
pub(crate) struct Generator(u64);

impl Generator {
    /// A stream of its own for every seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in (0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// How many trials until the next event, itself included, at a rate of `p`.
    pub(crate) fn gap(&mut self, p: f64) -> u64 {
        let gap = (libm::log(self.uniform()) / libm::log1p(-p)).floor();
        if gap < 1e15 { gap as u64 + 1 } else { 1_000_000_000_000_000 }
    }

    /// Events in `n` trials at a rate of `p`.
    pub(crate) fn binomial(&mut self, n: u64, p: f64) -> u64 {
        if p <= 0.0 {
            return 0;
        }
        if p > 0.5 {
            return n - self.binomial(n, 1.0 - p);
        }
        let (mut events, mut at) = (0, self.gap(p));
        while at <= n {
            events += 1;
            at += self.gap(p);
        }
        events
    }
}
