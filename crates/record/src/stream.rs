//! Random streams: what an encounter draws is a function of (seed, stratum, j, purpose, ship).
//!
//! ChaCha8 with key = BLAKE3(seed, stratum name) and stream = j << 16 | purpose << 8 | ship. The
//! stream number is packed and not hashed: hashed 64-bit streams would collide in 1e9 runs. There
//! is one stream for each consumer, so that one extra draw moves nothing else. Neither planner nor
//! rule set nor campaign enters the key, so every planner meets the same encounters.

use crate::EncounterId;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The seed of a campaign. There is no constructor from entropy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Seed(pub u64);

impl fmt::Display for Seed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Who draws. The numbers are part of every digest: never renumber, only add.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Purpose {
    /// Positions, courses, speeds and sizes.
    Geometry = 0,
    /// Wind, waves and current.
    Environment = 1,
    /// AIS: errors and losses of a target's reports.
    Sensor = 2,
    /// The tracker's own draws: frames that are dropped.
    Tracker = 3,
    /// What a target decides to do.
    TargetBehaviour = 4,
    /// The planner's own stream.
    Planner = 5,
    /// Radar: errors and misses of a target's plots; of ship 0, the phase of the antenna and
    /// clutter.
    Radar = 6,
    /// The state of the weather at the start; its fluctuations are `Environment`.
    Weather = 7,
}

/// The streams of one encounter.
#[derive(Clone, Debug)]
pub struct Streams {
    key: [u8; 32],
    j: u64,
}

impl Streams {
    /// The streams of the encounter `id` under `seed`.
    pub fn new(seed: Seed, id: &EncounterId) -> Self {
        assert!(id.j <= EncounterId::J_MAX, "encounter number {} does not fit 48 bits", id.j);
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"seatrial stream v1");
        hasher.update(&seed.0.to_le_bytes());
        hasher.update(id.stratum.as_bytes());
        Self { key: *hasher.finalize().as_bytes(), j: id.j }
    }

    /// The stream of one consumer; `ship` is 0 for own ship and 1 + i for target i.
    pub fn stream(&self, purpose: Purpose, ship: u8) -> Stream {
        let mut rng = ChaCha8Rng::from_seed(self.key);
        rng.set_stream(self.j << 16 | (purpose as u64) << 8 | u64::from(ship));
        Stream(rng)
    }
}

/// One stream of draws.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [low, high).
    pub fn uniform_in(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Standard normal, by the polar method's closed form (Box and Muller), two draws each.
    pub fn normal(&mut self) -> f64 {
        // 1 - u lies in (0, 1], so the logarithm is finite
        let radius = (-2.0 * geom::math::ln(1.0 - self.uniform())).sqrt();
        radius * geom::math::cos(std::f64::consts::TAU * self.uniform())
    }

    /// Exponential with mean 1.
    pub fn exponential(&mut self) -> f64 {
        -geom::math::ln(1.0 - self.uniform())
    }

    /// Uniform in 0..n, without bias that matters (n is far below 2^53).
    pub fn below(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(seed: u64, stratum: &str, j: u64, purpose: Purpose, ship: u8) -> u64 {
        Streams::new(Seed(seed), &EncounterId::new(stratum, j)).stream(purpose, ship).next_u64()
    }

    /// Pins the packing: a change here changes every encounter of every campaign.
    #[test]
    fn streams_are_pinned_and_differ_by_each_part() {
        let base = first(1, "head_on", 7, Purpose::Geometry, 0);
        assert_eq!(base, first(1, "head_on", 7, Purpose::Geometry, 0));
        for other in [
            first(2, "head_on", 7, Purpose::Geometry, 0),
            first(1, "crossing_stbd", 7, Purpose::Geometry, 0),
            first(1, "head_on", 8, Purpose::Geometry, 0),
            first(1, "head_on", 7, Purpose::Sensor, 0),
            first(1, "head_on", 7, Purpose::Geometry, 1),
        ] {
            assert_ne!(base, other);
        }
        assert_eq!(format!("{base:016x}"), PINNED);
    }

    const PINNED: &str = "40b58b822560d6ba";

    #[test]
    fn draws_have_their_moments() {
        let mut s = Streams::new(Seed(1), &EncounterId::new("x", 0)).stream(Purpose::Sensor, 0);
        let n = 100_000;
        let (mut sum, mut squares, mut uniform, mut exponential) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..n {
            let z = s.normal();
            sum += z;
            squares += z * z;
            uniform += s.uniform();
            exponential += s.exponential();
        }
        let n = f64::from(n);
        // five standard errors of each mean
        assert!((sum / n).abs() < 5.0 / n.sqrt());
        assert!((squares / n - 1.0).abs() < 5.0 * 2f64.sqrt() / n.sqrt());
        assert!((uniform / n - 0.5).abs() < 5.0 * 0.289 / n.sqrt());
        assert!((exponential / n - 1.0).abs() < 5.0 / n.sqrt());
    }
}
