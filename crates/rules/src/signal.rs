//! Own ship's signals: how heading and speed depart from the nominal track.
//!
//! The nominal track's heading and speed are subtracted, so that a waypoint turn is neither
//! credited nor blamed. Offsets and times come from the departures themselves; runs come from
//! their smoothed form, because smoothing spreads a turn to before it began. Reference: rules
//! specification, section 5.

use crate::ruleset::RuleSet;
use geom::{math, wrap};
use record::ShipTrack;

/// Samples of own ship, one array for each signal; kept between traces.
#[derive(Debug, Default)]
pub(crate) struct OwnSignals {
    /// Heading less that of the nominal track, unwrapped, radians.
    pub(crate) heading_rad: Vec<f64>,
    /// The same, smoothed.
    pub(crate) smooth_rad: Vec<f64>,
    /// Rate of the smoothed heading, rad/s.
    pub(crate) rate_radps: Vec<f64>,
    /// Speed over ground, m/s.
    pub(crate) speed_mps: Vec<f64>,
    /// Speed less that of the nominal track, m/s.
    pub(crate) departure_mps: Vec<f64>,
    kernel: Kernel,
}

impl OwnSignals {
    /// Computes all signals of a track.
    pub(crate) fn fill(
        &mut self,
        own: &ShipTrack,
        nominal: Option<&ShipTrack>,
        sample_s: f64,
        rules: &RuleSet,
    ) {
        self.fill_heading(own, nominal);
        self.fill_speed(own, nominal);
        self.kernel.prepare(rules.manoeuvre.heading_sigma_s, sample_s);
        self.kernel.smooth(&self.heading_rad, &mut self.smooth_rad);
        fill_rate(&self.smooth_rad, sample_s, &mut self.rate_radps);
    }

    fn fill_heading(&mut self, own: &ShipTrack, nominal: Option<&ShipTrack>) {
        self.heading_rad.clear();
        let mut last_rad = 0.0;
        for (k, &psi_rad) in own.psi_rad.iter().enumerate() {
            // a run that outlasts the nominal one is compared with its last heading
            let reference_rad = nominal.map_or(0.0, |n| n.psi_rad[k.min(n.len() - 1)]);
            let now_rad = psi_rad - reference_rad;
            last_rad = if k == 0 { wrap(now_rad) } else { last_rad + wrap(now_rad - last_rad) };
            self.heading_rad.push(last_rad);
        }
    }

    fn fill_speed(&mut self, own: &ShipTrack, nominal: Option<&ShipTrack>) {
        self.speed_mps.clear();
        self.speed_mps.extend(speeds_mps(own));
        self.departure_mps.clear();
        match nominal {
            None => self.departure_mps.extend_from_slice(&self.speed_mps),
            Some(nominal) => {
                let last_mps = nominal.sog_mps(nominal.len() - 1);
                let references = speeds_mps(nominal).chain(std::iter::repeat(last_mps));
                let departures = self.speed_mps.iter().zip(references).map(|(u, n)| u - n);
                self.departure_mps.extend(departures);
            }
        }
    }
}

fn speeds_mps(track: &ShipTrack) -> impl Iterator<Item = f64> + '_ {
    let velocities = track.vel_north_mps.iter().zip(&track.vel_east_mps);
    velocities.map(|(&north, &east)| math::length(north, east))
}

/// Central differences; one-sided at the ends.
pub(crate) fn fill_rate(values: &[f64], sample_s: f64, rate: &mut Vec<f64>) {
    rate.clear();
    let n = values.len();
    if n < 2 {
        rate.resize(n, 0.0);
        return;
    }
    rate.push((values[1] - values[0]) / sample_s);
    let per_two_samples = 0.5 / sample_s;
    rate.extend(values.windows(3).map(|w| (w[2] - w[0]) * per_two_samples));
    rate.push((values[n - 1] - values[n - 2]) / sample_s);
}

/// A Gaussian of given standard deviation, cut at four of them.
#[derive(Debug, Default)]
pub(crate) struct Kernel {
    /// Weights from the middle outwards.
    weights: Vec<f64>,
    sigma_samples: f64,
    padded: Vec<f64>,
}

impl Kernel {
    /// Makes the weights, unless they are there.
    pub(crate) fn prepare(&mut self, sigma_s: f64, sample_s: f64) {
        let sigma_samples = sigma_s / sample_s;
        if self.sigma_samples.to_bits() == sigma_samples.to_bits() && !self.weights.is_empty() {
            return;
        }
        self.sigma_samples = sigma_samples;
        let reach = (4.0 * sigma_samples).ceil() as usize;
        self.weights.clear();
        self.weights.extend((0..=reach).map(|i| {
            let z = i as f64 / sigma_samples;
            math::exp(-0.5 * z * z)
        }));
        let sum = self.weights[0] + 2.0 * self.weights[1..].iter().sum::<f64>();
        self.weights.iter_mut().for_each(|weight| *weight /= sum);
    }

    /// Smooths; beyond the ends the signal is reflected through its end point, which keeps a
    /// steady turn steady.
    pub(crate) fn smooth(&mut self, values: &[f64], smooth: &mut Vec<f64>) {
        smooth.clear();
        let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return };
        let (n, reach) = (values.len(), self.weights.len() - 1);
        self.padded.clear();
        self.padded.extend((1..=reach).rev().map(|i| 2.0 * first - values[i.min(n - 1)]));
        self.padded.extend_from_slice(values);
        self.padded.extend((1..=reach).map(|i| 2.0 * last - values[(n - 1).saturating_sub(i)]));
        smooth.extend(values.iter().map(|value| value * self.weights[0]));
        for (i, weight) in self.weights.iter().enumerate().skip(1) {
            let before = &self.padded[reach - i..reach - i + n];
            let after = &self.padded[reach + i..reach + i + n];
            for ((sum, b), a) in smooth.iter_mut().zip(before).zip(after) {
                *sum += weight * (b + a);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smoothing_keeps_a_ramp_and_spreads_a_step() {
        let mut kernel = Kernel::default();
        kernel.prepare(2.0, 1.0);
        let ramp: Vec<f64> = (0..60).map(|k| 0.1 * f64::from(k)).collect();
        let mut smooth = Vec::new();
        kernel.smooth(&ramp, &mut smooth);
        assert!(ramp.iter().zip(&smooth).all(|(a, b)| (a - b).abs() < 1e-12));
        let step: Vec<f64> = (0..60).map(|k| f64::from(u8::from(k >= 30))).collect();
        kernel.smooth(&step, &mut smooth);
        // the normal distribution at -1/2 sample: Phi(-0.25) = 0.4013
        assert!((smooth[29] - 0.4013).abs() < 2e-3, "{}", smooth[29]);
    }
}
