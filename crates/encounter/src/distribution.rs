//! Laws that a campaign file can ask for, one number at a time.
//!
//! Written as a table with one key: `{ uniform = [5.0, 9.0] }`, `{ constant = 0.2 }`,
//! `{ triangular = { low = 2.0, mode = 5.0, high = 12.0 } }`,
//! `{ normal = { mean = 7.0, sd = 1.5, low = 3.0, high = 12.0 } }`,
//! `{ lognormal = { median = 30.0, sigma = 0.8, low = 8.0, high = 200.0 } }`,
//! `{ empirical = [8.0, 12.0, 30.0] }`. Every law has finite bounds, so that nothing impossible can
//! be drawn once in a billion runs.

use crate::Error;
use crate::error::require;
use record::Stream;
use serde::{Deserialize, Serialize};

/// The law of one number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Always this.
    Constant(f64),
    /// Even between two ends, the upper one excluded.
    Uniform([f64; 2]),
    /// Rises evenly to the mode and falls evenly after it.
    Triangular(Triangular),
    /// Normal, cut off at both ends.
    Normal(Normal),
    /// The logarithm is normal, cut off at both ends.
    Lognormal(Lognormal),
    /// One of these values, each as likely as any other.
    Empirical(Vec<f64>),
}

/// A triangular law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triangular {
    /// Least value.
    pub low: f64,
    /// Most likely value.
    pub mode: f64,
    /// Largest value.
    pub high: f64,
}

/// A normal law between two ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Mean before the cut.
    pub mean: f64,
    /// Standard deviation before the cut.
    pub sd: f64,
    /// Least value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

/// A lognormal law between two ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lognormal {
    /// Median before the cut.
    pub median: f64,
    /// Standard deviation of the natural logarithm.
    pub sigma: f64,
    /// Least value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

impl Distribution {
    /// Draws one value.
    pub fn draw(&self, stream: &mut Stream) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Uniform([low, high]) => stream.uniform_in(*low, *high),
            Self::Triangular(law) => law.draw(stream),
            Self::Normal(law) => cut(law.low, law.high, || law.mean + law.sd * stream.normal()),
            Self::Lognormal(law) => {
                cut(law.low, law.high, || law.median * geom::math::exp(law.sigma * stream.normal()))
            }
            Self::Empirical(values) => values[stream.below(values.len())],
        }
    }

    /// Least and largest value that can be drawn.
    pub fn bounds(&self) -> (f64, f64) {
        match self {
            Self::Constant(value) => (*value, *value),
            Self::Uniform([low, high]) => (*low, *high),
            Self::Triangular(law) => (law.low, law.high),
            Self::Normal(law) => (law.low, law.high),
            Self::Lognormal(law) => (law.low, law.high),
            Self::Empirical(values) => (
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ),
        }
    }

    /// Points and weights of a quadrature over the law; the weights sum to 1. Exact for a law of
    /// single values, else the midpoint rule over equal parts of the range.
    pub(crate) fn nodes(&self) -> Vec<(f64, f64)> {
        const PARTS: u32 = 96;
        let (low, high) = self.bounds();
        let density: Box<dyn Fn(f64) -> f64> = match self {
            Self::Constant(value) => return vec![(*value, 1.0)],
            Self::Empirical(values) => {
                let share = 1.0 / values.len() as f64;
                return values.iter().map(|&value| (value, share)).collect();
            }
            Self::Uniform(_) => Box::new(|_| 1.0),
            Self::Triangular(law) => Box::new(|x| {
                if x < law.mode {
                    (x - law.low) / (law.mode - law.low) / (law.high - law.low)
                } else {
                    (law.high - x) / (law.high - law.mode) / (law.high - law.low)
                }
            }),
            Self::Normal(law) => Box::new(|x| {
                let off = (x - law.mean) / law.sd;
                geom::math::exp(-0.5 * off * off)
            }),
            Self::Lognormal(law) => Box::new(|x| {
                let off = geom::math::ln(x / law.median) / law.sigma;
                geom::math::exp(-0.5 * off * off) / x
            }),
        };
        let width = (high - low) / f64::from(PARTS);
        let points = (0..PARTS).map(|i| low + width * (f64::from(i) + 0.5));
        let mut nodes: Vec<(f64, f64)> = points.map(|x| (x, density(x))).collect();
        let sum: f64 = nodes.iter().map(|node| node.1).sum();
        nodes.iter_mut().for_each(|node| node.1 /= sum);
        nodes
    }

    /// Refuses a law that cannot be drawn from; `key` is where it stands in the file.
    pub fn validate(&self, key: &str) -> Result<(), Error> {
        match self {
            Self::Constant(value) => finite(key, *value),
            Self::Uniform([low, high]) => range(key, *low, *high),
            Self::Triangular(law) => {
                range(key, law.low, law.high)?;
                within(key, "mode", law.mode, law.low, law.high)
            }
            Self::Normal(law) => {
                range(key, law.low, law.high)?;
                within(key, "mean", law.mean, law.low, law.high)?;
                spread(key, "sd", law.sd, law.high - law.low)
            }
            Self::Lognormal(law) => {
                range(key, law.low, law.high)?;
                require(
                    law.low > 0.0,
                    || format!("{key}.low"),
                    || format!("= {} must be over 0 for a lognormal law", law.low),
                )?;
                within(key, "median", law.median, law.low, law.high)?;
                spread(key, "sigma", law.sigma, geom::math::ln(law.high / law.low))
            }
            Self::Empirical(values) => {
                require(
                    !values.is_empty(),
                    || key.to_owned(),
                    || "is empty; give at least one value".to_owned(),
                )?;
                values.iter().try_for_each(|&value| finite(key, value))
            }
        }
    }

    /// As [`Distribution::validate`], and every value lies from `least` to `most`.
    pub(crate) fn validate_within(&self, key: &str, least: f64, most: f64) -> Result<(), Error> {
        self.validate(key)?;
        let (low, high) = self.bounds();
        require(
            low >= least && high <= most,
            || key.to_owned(),
            || format!("reaches from {low} to {high}; it must lie within {least} to {most}"),
        )
    }
}

impl Triangular {
    fn draw(&self, stream: &mut Stream) -> f64 {
        let width = self.high - self.low;
        let rise = self.mode - self.low;
        let share = stream.uniform();
        if share * width < rise {
            self.low + (share * width * rise).sqrt()
        } else {
            self.high - ((1.0 - share) * width * (width - rise)).sqrt()
        }
    }
}

/// Draws until a value lies in the range. `validate` has made sure that about one draw in six at
/// the least does.
fn cut(low: f64, high: f64, mut draw: impl FnMut() -> f64) -> f64 {
    loop {
        let value = draw();
        if (low..=high).contains(&value) {
            return value;
        }
    }
}

fn finite(key: &str, value: f64) -> Result<(), Error> {
    require(value.is_finite(), || key.to_owned(), || format!("= {value} must be a finite number"))
}

/// Refuses a range that is not finite, is empty or runs backwards.
pub(crate) fn range(key: &str, low: f64, high: f64) -> Result<(), Error> {
    finite(key, low)?;
    finite(key, high)?;
    require(
        low <= high,
        || key.to_owned(),
        || format!("= [{low}, {high}] runs backwards; write [{high}, {low}]"),
    )?;
    require(
        low < high,
        || key.to_owned(),
        || format!("= [{low}, {high}] is empty; write {{ constant = {low} }} or widen it"),
    )
}

fn within(key: &str, name: &str, value: f64, low: f64, high: f64) -> Result<(), Error> {
    require(
        (low..=high).contains(&value),
        || format!("{key}.{name}"),
        || format!("= {value} must lie from low = {low} to high = {high}"),
    )
}

/// With the centre inside the range and the spread at most twice its width, a draw meets the
/// range with a probability of at least `Phi(0.5) - 0.5 = 0.19`.
fn spread(key: &str, name: &str, value: f64, width: f64) -> Result<(), Error> {
    require(
        value > 0.0 && value <= 2.0 * width,
        || format!("{key}.{name}"),
        || format!("= {value} must be over 0 and at most twice the width of the range, {width}"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{EncounterId, Purpose, Seed, Streams};

    const N: usize = 20_000;

    fn sorted(law: &Distribution) -> Vec<f64> {
        law.validate("law").unwrap();
        let mut stream =
            Streams::new(Seed(8), &EncounterId::new("law", 0)).stream(Purpose::Geometry, 0);
        let mut values: Vec<f64> = (0..N).map(|_| law.draw(&mut stream)).collect();
        values.sort_by(f64::total_cmp);
        let (low, high) = law.bounds();
        assert!(values[0] >= low && values[N - 1] <= high, "{law:?}");
        values
    }

    /// Share of the values up to `at`; five standard deviations are 0.018 at the most.
    fn share_up_to(values: &[f64], at: f64, expected: f64) {
        let share = values.partition_point(|v| *v <= at) as f64 / N as f64;
        assert!((share - expected).abs() < 0.018, "{share} up to {at}, expected {expected}");
    }

    #[test]
    fn laws_have_their_distribution_functions() {
        let uniform = sorted(&Distribution::Uniform([2.0, 6.0]));
        share_up_to(&uniform, 3.0, 0.25);
        let triangular =
            sorted(&Distribution::Triangular(Triangular { low: 0.0, mode: 1.0, high: 4.0 }));
        // (1 - 0)^2 / (4 * 1) and 1 - (4 - 2)^2 / (4 * 3)
        share_up_to(&triangular, 1.0, 0.25);
        share_up_to(&triangular, 2.0, 2.0 / 3.0);
        // Phi(1) = 0.841345, Phi(2) = 0.977250, Phi(-1) = 0.158655
        let law = Normal { mean: 10.0, sd: 2.0, low: 8.0, high: 14.0 };
        let normal = sorted(&Distribution::Normal(law));
        share_up_to(&normal, 12.0, (0.841_345 - 0.158_655) / (0.977_250 - 0.158_655));
        let law = Lognormal { median: 30.0, sigma: 0.5, low: 0.1, high: 3000.0 };
        let lognormal = sorted(&Distribution::Lognormal(law));
        share_up_to(&lognormal, 30.0, 0.5);
        share_up_to(&lognormal, 30.0 * geom::math::exp(0.5), 0.841_345);
        let empirical = sorted(&Distribution::Empirical(vec![3.0, 1.0, 3.0, 8.0]));
        share_up_to(&empirical, 1.0, 0.25);
        share_up_to(&empirical, 3.0, 0.75);
        share_up_to(&sorted(&Distribution::Constant(5.0)), 5.0, 1.0);
    }

    #[test]
    fn laws_that_cannot_be_drawn_are_refused() {
        for law in [
            Distribution::Constant(f64::NAN),
            Distribution::Uniform([1.0, f64::INFINITY]),
            Distribution::Triangular(Triangular { low: 0.0, mode: 5.0, high: 4.0 }),
            Distribution::Normal(Normal { mean: 20.0, sd: 1.0, low: 8.0, high: 14.0 }),
            Distribution::Normal(Normal { mean: 10.0, sd: 100.0, low: 8.0, high: 14.0 }),
            Distribution::Lognormal(Lognormal { median: 1.0, sigma: 0.5, low: 0.0, high: 3.0 }),
            Distribution::Lognormal(Lognormal { median: 1.0, sigma: -0.5, low: 0.1, high: 3.0 }),
            Distribution::Empirical(Vec::new()),
            Distribution::Empirical(vec![1.0, f64::NAN]),
        ] {
            assert!(law.validate("law").unwrap_err().to_string().starts_with("`law"), "{law:?}");
        }
    }
}
