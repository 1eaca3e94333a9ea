//! A law for a sample: parameters with intervals, and how well it fits.
//!
//! Candidates are the uniform, the normal and the lognormal law between the least and the largest
//! value, fitted by moments (of the logarithm). The one with the smallest Kolmogorov distance is
//! taken. Its p-value comes from a parametric bootstrap, because the parameters come from the same
//! sample (Stute, Gonzalez Manteiga and Presedo Quindimil 1993, Metrika 40); the intervals from the
//! ordinary one. A p-value above 0.05 does not prove the law, it fails to refute it.

use encounter::Distribution;
use encounter::distribution::{Lognormal, Normal};
use geom::math;
use record::Stream;

/// A fitted law.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The form.
    pub form: Form,
    /// Size of the sample.
    pub n: usize,
    /// Kolmogorov's distance between law and sample.
    pub distance: f64,
    /// How often the law itself gives a larger one.
    pub p_value: f64,
    /// Parameters: name, value, and 95 % interval.
    pub parameters: Vec<Parameter>,
    /// Least and largest value of the sample.
    pub range: [f64; 2],
}

/// One parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in the campaign file.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Ends of the 95 % interval.
    pub interval: [f64; 2],
}

/// Which law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Even between two ends.
    Uniform,
    /// Normal.
    Normal,
    /// The logarithm is normal; for positive values alone.
    Lognormal,
}

/// Samples of the bootstraps.
const RESAMPLES: usize = 400;
/// A smaller sample is not fitted.
pub const SAMPLE_MIN: usize = 5;

/// A candidate with its parameters.
#[derive(Clone, Copy, Debug)]
struct Law {
    form: Form,
    /// Mean and standard deviation, of the logarithm for the lognormal; or both ends.
    a: f64,
    b: f64,
}

/// Fits a law; `None` for a sample that is too small or has no spread. Blocks of `together` values
/// belong together and are drawn together for the intervals.
pub fn fit(sample: &[f64], together: usize, stream: &mut Stream) -> Option<Fitted> {
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (&low, &high) = (sorted.first()?, sorted.last()?);
    if sorted.len() < SAMPLE_MIN || low >= high {
        return None;
    }
    let forms = [Form::Uniform, Form::Normal, Form::Lognormal];
    let candidates = forms.into_iter().filter_map(|form| Law::of(form, &sorted));
    let distances = candidates.map(|law| (law.distance(&sorted), law));
    let (distance, law) = distances.reduce(|x, y| if y.0 < x.0 { y } else { x })?;
    Some(Fitted {
        form: law.form,
        n: sorted.len(),
        distance,
        p_value: p_value(&law, sorted.len(), distance, stream),
        parameters: intervals(&law, sample, together, stream),
        range: [low, high],
    })
}

impl Fitted {
    /// The law as a campaign file has it, cut at the ends of the sample.
    pub fn distribution(&self) -> Distribution {
        let [low, high] = self.range;
        let value = |k: usize| self.parameters[k].value;
        match self.form {
            Form::Uniform => Distribution::Uniform([low, high]),
            Form::Normal => {
                Distribution::Normal(Normal { mean: value(0), sd: value(1), low, high })
            }
            Form::Lognormal => {
                Distribution::Lognormal(Lognormal { median: value(0), sigma: value(1), low, high })
            }
        }
    }
}

impl Fitted {
    /// Density of the law at a value, before the cut at the ends of the sample.
    pub fn density(&self, x: f64) -> f64 {
        let value = |k: usize| self.parameters[k].value;
        let bell =
            |z: f64, spread: f64| math::exp(-0.5 * z * z) / (spread * std::f64::consts::TAU.sqrt());
        match self.form {
            Form::Uniform if (self.range[0]..=self.range[1]).contains(&x) => {
                1.0 / (self.range[1] - self.range[0])
            }
            Form::Normal => bell((x - value(0)) / value(1), value(1)),
            Form::Lognormal if x > 0.0 => {
                bell((math::ln(x) - math::ln(value(0))) / value(1), value(1)) / x
            }
            Form::Uniform | Form::Lognormal => 0.0,
        }
    }
}

impl Law {
    fn of(form: Form, sorted: &[f64]) -> Option<Self> {
        let (low, high) = (sorted[0], sorted[sorted.len() - 1]);
        let moments = |values: &mut dyn Iterator<Item = f64>| {
            let values: Vec<f64> = values.collect();
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
            (mean, (squares / (n - 1.0)).sqrt())
        };
        let (a, b) = match form {
            Form::Uniform => (low, high),
            Form::Normal => moments(&mut sorted.iter().copied()),
            Form::Lognormal if low <= 0.0 => return None,
            Form::Lognormal => moments(&mut sorted.iter().map(|&v| math::ln(v))),
        };
        Some(Self { form, a, b })
    }

    fn cdf(&self, x: f64) -> f64 {
        match self.form {
            Form::Uniform => ((x - self.a) / (self.b - self.a)).clamp(0.0, 1.0),
            Form::Normal => normal_cdf((x - self.a) / self.b),
            Form::Lognormal => normal_cdf((math::ln(x) - self.a) / self.b),
        }
    }

    fn draw(&self, stream: &mut Stream) -> f64 {
        match self.form {
            Form::Uniform => stream.uniform_in(self.a, self.b),
            Form::Normal => self.a + self.b * stream.normal(),
            Form::Lognormal => math::exp(self.a + self.b * stream.normal()),
        }
    }

    fn distance(&self, sorted: &[f64]) -> f64 {
        let n = sorted.len() as f64;
        let gaps = sorted.iter().enumerate().map(|(i, &x)| {
            let law = self.cdf(x);
            (law - i as f64 / n).max((i as f64 + 1.0) / n - law)
        });
        gaps.fold(0.0, f64::max)
    }

    fn parameters(&self) -> [(&'static str, f64); 2] {
        match self.form {
            Form::Uniform => [("low", self.a), ("high", self.b)],
            Form::Normal => [("mean", self.a), ("sd", self.b)],
            Form::Lognormal => [("median", math::exp(self.a)), ("sigma", self.b)],
        }
    }
}

/// Standard normal distribution function, by the series of Marsaglia (2004), Journal of Statistical
/// Software 11(4); exact to the last digits within six standard deviations.
fn normal_cdf(x: f64) -> f64 {
    if x.abs() > 6.0 {
        return if x > 0.0 { 1.0 } else { 0.0 };
    }
    let (mut term, mut sum, mut i) = (x, x, 1.0);
    while term.abs() > 1e-17 * (1.0 + sum.abs()) {
        i += 2.0;
        term *= x * x / i;
        sum += term;
    }
    0.5 + sum * math::exp(-0.5 * x * x - 0.918_938_533_204_672_8)
}

/// How often a sample of the law itself lies farther from its own fit.
fn p_value(law: &Law, n: usize, distance: f64, stream: &mut Stream) -> f64 {
    let farther = (0..RESAMPLES).filter(|_| {
        let mut sample: Vec<f64> = (0..n).map(|_| law.draw(stream)).collect();
        sample.sort_by(f64::total_cmp);
        Law::of(law.form, &sample).is_some_and(|again| again.distance(&sample) >= distance)
    });
    (farther.count() + 1) as f64 / (RESAMPLES + 1) as f64
}

fn intervals(law: &Law, values: &[f64], together: usize, stream: &mut Stream) -> Vec<Parameter> {
    let blocks: Vec<&[f64]> = values.chunks(together.max(1)).collect();
    let mut drawn: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    for _ in 0..RESAMPLES {
        let mut sample: Vec<f64> =
            (0..blocks.len()).flat_map(|_| blocks[stream.below(blocks.len())]).copied().collect();
        sample.sort_by(f64::total_cmp);
        if let Some(again) = Law::of(law.form, &sample) {
            for (values, (_, value)) in drawn.iter_mut().zip(again.parameters()) {
                values.push(value);
            }
        }
    }
    let parameters = law.parameters().into_iter().zip(&mut drawn);
    let interval = parameters.map(|((name, value), values)| {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
        Parameter { name, value, interval: [at(0.025), at(0.975)] }
    });
    interval.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{EncounterId, Purpose, Seed, Streams};

    fn stream(j: u64) -> Stream {
        Streams::new(Seed(3), &EncounterId::new("fit", j)).stream(Purpose::Geometry, 0)
    }

    /// Table values of the normal law.
    #[test]
    fn normal_law_has_its_table_values() {
        for (x, p) in [(0.0, 0.5), (1.0, 0.841_344_746_068_543), (-1.959_963_984_540_054, 0.025)] {
            assert!((normal_cdf(x) - p).abs() < 1e-12, "{x}: {}", normal_cdf(x));
        }
    }

    #[test]
    fn a_known_law_is_found_again_within_its_intervals() {
        let mut draw = stream(0);
        let lognormal: Vec<f64> = (0..600).map(|_| math::exp(2.0 + 0.5 * draw.normal())).collect();
        let fitted = fit(&lognormal, 1, &mut stream(1)).unwrap();
        assert_eq!(fitted.form, Form::Lognormal);
        assert!(fitted.p_value > 0.05, "{}", fitted.p_value);
        for (parameter, truth) in fitted.parameters.iter().zip([math::exp(2.0), 0.5]) {
            let [low, high] = parameter.interval;
            assert!(low < truth && truth < high, "{parameter:?}");
            assert!(high - low < 0.2 * truth, "{parameter:?}");
        }
        let uniform: Vec<f64> = (0..600).map(|_| draw.uniform_in(-3.0, 4.0)).collect();
        assert_eq!(fit(&uniform, 1, &mut stream(2)).unwrap().form, Form::Uniform);
    }

    /// Two heaps: none of the forms fits, and the p-value says so.
    #[test]
    fn a_law_that_does_not_fit_is_refuted() {
        let mut draw = stream(4);
        let sample: Vec<f64> =
            (0..300).map(|k| if k % 2 == 0 { 5.0 } else { 20.0 } + 0.5 * draw.normal()).collect();
        let fitted = fit(&sample, 1, &mut stream(5)).unwrap();
        assert!(fitted.p_value < 0.01, "{fitted:?}");
    }

    #[test]
    fn a_handful_is_not_fitted() {
        assert_eq!(fit(&[1.0, 2.0, 3.0], 1, &mut stream(6)), None);
        assert_eq!(fit(&[2.0; 30], 1, &mut stream(6)), None);
    }
}
