//! Paired and one-arm e-processes: evidence that may be looked at after every encounter.
//!
//! Each is a finite mixture of bets, E = sum_j pi_j prod_i (1 + l_j (bet on encounter i)). Every
//! factor is at least 0 and has mean at most 1 under its null hypothesis, whatever the nuisance
//! rates and however the two planners are coupled, so E starts at 1 and P(E ever reaches 1/a) is
//! at most a (Ville). Only counts enter. All in logarithms; no beta function. The stakes l_j and
//! weights pi_j are fixed before the run. Source: statistics specification, section 4.5.

use serde::{Deserialize, Serialize};

use crate::PairedCounts;
use crate::error::{StatsError, check_open, check_unit};
use crate::math::{ln, log_sum_exp, log1p, real};

/// The declared mixture: stakes l_j and the logarithms of their weights.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stakes {
    /// l_j, each at least 0 and below the limit at which a factor could turn negative.
    pub(crate) stakes: Vec<f64>,
    /// ln pi_j; the weights add up to 1.
    pub(crate) ln_weights: Vec<f64>,
}

impl Stakes {
    /// The node design of section 4.5: half the weight on the designed stake, .15 each on its
    /// double and its half, the rest on lmax 3^-j, with lmax = .999 of the exclusive `limit`.
    pub(crate) fn declared(limit: f64, design: f64) -> Self {
        let largest = 0.999 * limit;
        let aimed = design.min(largest);
        let mut stakes = vec![aimed, (2.0 * aimed).min(largest), 0.5 * aimed];
        let mut weights = vec![0.5, 0.15, 0.15];
        let mut stake = largest;
        for _ in 0..7 {
            stakes.push(stake);
            weights.push(0.2 / 7.0);
            stake /= 3.0;
        }
        Self { stakes, ln_weights: weights.into_iter().map(ln).collect() }
    }

    /// ln sum_j pi_j e^(ln_wealth(l_j)).
    pub(crate) fn ln_mixture(&self, ln_wealth: impl Fn(f64) -> f64 + Clone) -> f64 {
        let nodes = self.stakes.iter().zip(&self.ln_weights);
        log_sum_exp(nodes.map(|(&stake, ln_weight)| ln_weight + ln_wealth(stake)))
    }
}

/// What an e-process still needs, at the rates seen so far. A forecast, not a claim.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Forecast {
    /// The level is reached.
    Reached,
    /// About this many more encounters.
    Encounters(u64),
    /// It cannot pass at the observed rates.
    CannotPass,
}

/// A test by betting: the logarithms of each bet's factors for the outcomes that it tells apart.
#[derive(Debug, Clone, PartialEq)]
struct Bets {
    ln_weights: Vec<f64>,
    /// By stake: ln factor for (both, break, fix, neither).
    ln_factors: Vec<[f64; 4]>,
}

impl Bets {
    fn new(stakes: &Stakes, factors: impl Fn(f64) -> [f64; 4]) -> Self {
        Self {
            ln_weights: stakes.ln_weights.clone(),
            ln_factors: stakes.stakes.iter().map(|&stake| factors(stake)).collect(),
        }
    }

    fn ln_e(&self, counts: [f64; 4]) -> f64 {
        let nodes = self.ln_factors.iter().zip(&self.ln_weights);
        log_sum_exp(nodes.map(|(factors, ln_weight)| ln_weight + dot(factors, &counts)))
    }

    /// Largest growth of ln E per encounter over the stakes, at outcome rates that add up to 1.
    fn growth(&self, rates: [f64; 4]) -> f64 {
        self.ln_factors.iter().map(|factors| dot(factors, &rates)).fold(f64::NEG_INFINITY, f64::max)
    }

    fn forecast(&self, counts: [f64; 4], rates: [f64; 4], ln_level: f64) -> Forecast {
        let missing = ln_level - self.ln_e(counts);
        if missing <= 0.0 {
            return Forecast::Reached;
        }
        let growth = self.growth(rates);
        if growth <= 0.0 {
            return Forecast::CannotPass;
        }
        Forecast::Encounters((missing / growth).ceil() as u64)
    }

    /// The number of encounters at which ln E reaches `ln_level` when the outcomes come exactly
    /// at `rates`; none when it never does.
    fn encounters_at(&self, rates: [f64; 4], ln_level: f64) -> Option<u64> {
        if self.growth(rates) <= 0.0 {
            return None;
        }
        let reached = |n: u64| self.ln_e(rates.map(|rate| rate * real(n))) >= ln_level;
        let mut high = 1_u64;
        while !reached(high) {
            high = high.checked_mul(2).filter(|&n| n < 1 << 52)?;
        }
        let mut low = high / 2;
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if reached(middle) { high = middle } else { low = middle }
        }
        Some(high)
    }
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

fn outcomes(counts: &PairedCounts) -> [f64; 4] {
    [real(counts.n11), real(counts.n10), real(counts.n01), real(counts.n00)]
}

/// The observed rates, half an encounter added to either kind of difference.
fn smoothed_rates(counts: &PairedCounts) -> [f64; 4] {
    let n = real(counts.n()) + 1.0;
    let (broken, fixed) = ((real(counts.n10) + 0.5) / n, (real(counts.n01) + 0.5) / n);
    let both = real(counts.n11) / n;
    [both, broken, fixed, 1.0 - both - broken - fixed]
}

/// (a) Harm. H0: D <= 0. E = sum pi_j (1 + l_j)^n10 (1 - l_j)^n01. Large: the candidate breaks
/// more than it fixes.
#[derive(Debug, Clone, PartialEq)]
pub struct Harm(Bets);

impl Default for Harm {
    fn default() -> Self {
        let stakes = Stakes::declared(1.0, 0.5);
        Self(Bets::new(&stakes, |l| [0.0, log1p(l), log1p(-l), 0.0]))
    }
}

impl Harm {
    /// ln E.
    #[must_use]
    pub fn ln_e(&self, counts: &PairedCounts) -> f64 {
        self.0.ln_e(outcomes(counts))
    }
}

/// (b), (c) Non-inferiority of a candidate by a margin that was written down before the run.
/// Large: the candidate is less than the margin worse.
#[derive(Debug, Clone, PartialEq)]
pub struct NonInferiority {
    bets: Bets,
    rates_plan: [f64; 4],
    rates_undisturbed: [f64; 4],
}

impl NonInferiority {
    /// (b) H0: D >= `margin`.
    /// E = sum pi_j (1 + l d)^n0 (1 - l (1 - d))^n10 (1 + l (1 + d))^n01, l < 1 / (1 - d).
    /// `discordance_plan` is the planned p10 + p01: it shapes the stakes, not the guarantee.
    ///
    /// # Errors
    /// `margin` or `discordance_plan` outside (0, 1).
    pub fn absolute(margin: f64, discordance_plan: f64) -> Result<Self, StatsError> {
        check_unit("margin", margin)?;
        check_unit("discordance_plan", discordance_plan)?;
        let stakes = Stakes::declared(1.0 / (1.0 - margin), margin / discordance_plan);
        let half = 0.5 * discordance_plan;
        Ok(Self {
            bets: Bets::new(&stakes, |l| {
                let still = log1p(l * margin);
                [still, log1p(-l * (1.0 - margin)), log1p(l * (1.0 + margin)), still]
            }),
            rates_plan: [0.0, half, half, 1.0 - discordance_plan],
            rates_undisturbed: [0.0, 0.0, 0.0, 1.0],
        })
    }

    /// (c) H0: p_B >= (1 + `ratio`) p_A.
    /// E = sum pi_j (1 - l)^n10 (1 + l r)^n11 (1 + l (1 + r))^n01, l < 1.
    /// `rate_plan` is the planned p_A.
    ///
    /// # Errors
    /// `ratio` not positive, a plan outside (0, 1), or planned fixes above the planned rate.
    pub fn relative(ratio: f64, rate_plan: f64, discordance_plan: f64) -> Result<Self, StatsError> {
        check_open("ratio", ratio, 0.0, f64::INFINITY)?;
        check_unit("rate_plan", rate_plan)?;
        let half = 0.5 * discordance_plan;
        check_open("discordance_plan", discordance_plan, 0.0, 2.0 * rate_plan.min(0.5))?;
        let stakes = Stakes::declared(1.0, ratio * rate_plan / discordance_plan);
        Ok(Self {
            bets: Bets::new(&stakes, |l| {
                [log1p(l * ratio), log1p(-l), log1p(l * (1.0 + ratio)), 0.0]
            }),
            rates_plan: [rate_plan - half, half, half, 1.0 - rate_plan - half],
            rates_undisturbed: [rate_plan, 0.0, 0.0, 1.0 - rate_plan],
        })
    }

    /// ln E.
    #[must_use]
    pub fn ln_e(&self, counts: &PairedCounts) -> f64 {
        self.bets.ln_e(outcomes(counts))
    }

    /// How many more encounters until E reaches 1 / `alpha`, at the rates seen so far.
    #[must_use]
    pub fn forecast(&self, counts: &PairedCounts, alpha: f64) -> Forecast {
        self.bets.forecast(outcomes(counts), smoothed_rates(counts), -ln(alpha))
    }

    /// Encounters needed at level `alpha` when the candidate never differs from the baseline: a
    /// cap below it can never pass.
    #[must_use]
    pub fn encounters_undisturbed(&self, alpha: f64) -> Option<u64> {
        self.bets.encounters_at(self.rates_undisturbed, -ln(alpha))
    }

    /// Encounters expected at level `alpha` for a neutral change at the planned rates; none when
    /// it is not expected to pass at all.
    #[must_use]
    pub fn encounters_planned(&self, alpha: f64) -> Option<u64> {
        self.bets.encounters_at(self.rates_plan, -ln(alpha))
    }
}

/// (d) One arm against a declared rate p0.
#[derive(Debug, Clone, PartialEq)]
pub struct RateTest(Bets);

impl RateTest {
    /// H0: p >= `rate`; large: the rate is demonstrated to be lower.
    /// E = sum pi_j (1 + l p0)^(n - k) (1 - l (1 - p0))^k, l < 1 / (1 - p0).
    ///
    /// # Errors
    /// `rate` outside (0, 1).
    pub fn demonstrated(rate: f64) -> Result<Self, StatsError> {
        check_unit("rate", rate)?;
        let limit = 1.0 / (1.0 - rate);
        let stakes = Stakes::declared(limit, limit);
        Ok(Self(Bets::new(&stakes, |l| [log1p(-l * (1.0 - rate)), 0.0, 0.0, log1p(l * rate)])))
    }

    /// H0: p <= `rate`; large: the rate is violated.
    /// E = sum pi_j (1 - l p0)^(n - k) (1 + l (1 - p0))^k, l < 1 / p0.
    ///
    /// # Errors
    /// `rate` outside (0, 1).
    pub fn violated(rate: f64) -> Result<Self, StatsError> {
        check_unit("rate", rate)?;
        let stakes = Stakes::declared(1.0 / rate, 0.5 / rate);
        Ok(Self(Bets::new(&stakes, |l| [log1p(l * (1.0 - rate)), 0.0, 0.0, log1p(-l * rate)])))
    }

    /// ln E at `k` events in `n` encounters.
    ///
    /// # Errors
    /// More events than encounters.
    pub fn ln_e(&self, k: u64, n: u64) -> Result<f64, StatsError> {
        if k > n {
            return Err(StatsError::Counts { k, n });
        }
        Ok(self.ln_e_counts(k, n))
    }

    /// ln E where k is known to be a part of n.
    pub(crate) fn ln_e_counts(&self, k: u64, n: u64) -> f64 {
        self.0.ln_e([real(k), 0.0, 0.0, real(n - k)])
    }

    /// How many more encounters until E reaches 1 / `alpha`, at the rate seen so far.
    ///
    /// # Errors
    /// More events than encounters.
    pub fn forecast(&self, k: u64, n: u64, alpha: f64) -> Result<Forecast, StatsError> {
        if k > n {
            return Err(StatsError::Counts { k, n });
        }
        let rate = (real(k) + 0.5) / (real(n) + 1.0);
        let counts = [real(k), 0.0, 0.0, real(n - k)];
        Ok(self.0.forecast(counts, [rate, 0.0, 0.0, 1.0 - rate], -ln(alpha)))
    }

    /// Encounters needed at level `alpha` without a single event.
    #[must_use]
    pub fn encounters_undisturbed(&self, alpha: f64) -> Option<u64> {
        self.0.encounters_at([0.0, 0.0, 0.0, 1.0], -ln(alpha))
    }
}
