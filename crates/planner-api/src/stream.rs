//! The planner's own random stream.

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// The only random numbers a planner may use; made from [`crate::Mission::stream_seed`].
#[derive(Clone, Debug)]
pub struct PlannerStream(ChaCha8Rng);

impl PlannerStream {
    /// The stream of this seed.
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }
}

/// Seeds in messages: 16 hexadecimal digits, because JSON numbers lose bits beyond 2^53.
pub(crate) mod hex_seed {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<S: Serializer>(seed: &u64, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&format!("{seed:016x}"))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<u64, D::Error> {
        let text = String::deserialize(from)?;
        u64::from_str_radix(&text, 16).map_err(serde::de::Error::custom)
    }
}
