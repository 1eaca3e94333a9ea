//! Encounters at the rate at which a traffic makes them, and the weight that each then carries.
//!
//! Ships spread evenly over an area, each on her course, meet own ship within a distance `D` at a
//! rate proportional to the speed at which they close: an encounter with relative velocity `W`
//! is met `2 D |W|` times per unit of traffic density. So a relative course is accepted with
//! probability `|W| / (v1 + v2)`, and what the drawing of the speeds has left out, the mean
//! relative speed `vbar(v1, v2)`, goes into the weight:
//!
//! `w = vbar(v1, v2) / Z * [1 / (2 D)] / q(d) * [true share / drawn share of the intent]`
//!
//! `q` is the declared proposal of the signed miss distance, even within each of its bins, and `Z`
//! the mean of `vbar` over the speeds that are drawn, by quadrature, so that the weights have mean
//! 1 and a weighted share is a probability. Encounters that close more slowly than
//! `closing_mps_min` are not drawn: the population is that of the others.
//!
//! Source: statistics specification, section 1, after the encounter models of MIT Lincoln
//! Laboratory; `vbar = (2 / pi) (v1 + v2) E(m)`, `m = 4 v1 v2 / (v1 + v2)^2`, with `E` the complete
//! elliptic integral of the second kind as a function of the parameter `m`, not of its root.

use crate::Distribution;
use crate::intent::IntentMix;
use crate::placement::TRIES_MAX;
use crate::spec::{Model, StratumSpec};
use geom::math;
use record::Stream;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI, TAU};

/// The table `[model.encounter_rate]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RateSpec {
    /// Encounters that close more slowly are no part of the population, m/s.
    pub closing_mps_min: f64,
    /// Proposal of the miss distance: shares of bands of its size, from the closest pass outwards,
    /// even within each band and on both sides.
    pub miss_m_drawn: Vec<MissBand>,
    /// Shares with which intents are drawn, instead of those that `intent_mix` says they have; the
    /// weight takes the quotient. Absent: as `intent_mix` says.
    pub intent_mix_drawn: Option<IntentMix>,
}

/// One band of miss distances, from the end of the band before.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MissBand {
    /// Where it ends, metres.
    pub up_to_m: f64,
    /// Share of the draws.
    pub share: f64,
}

/// Mean speed of two ships relative to one another over all relative courses, m/s.
pub fn mean_relative_speed_mps(own_mps: f64, target_mps: f64) -> f64 {
    let sum_mps = own_mps + target_mps;
    if sum_mps <= 0.0 {
        return 0.0;
    }
    // sqrt(1 - m) without the cancellation near equal speeds
    let complement = (own_mps - target_mps).abs() / sum_mps;
    FRAC_2_PI * sum_mps * elliptic_e(complement)
}

/// Complete elliptic integral of the second kind, E(m), of the complementary modulus sqrt(1 - m),
/// by the arithmetic-geometric mean (Abramowitz and Stegun, 17.6).
fn elliptic_e(complement: f64) -> f64 {
    if complement <= 0.0 {
        return 1.0;
    }
    let (mut a, mut b) = (1.0, complement);
    let (mut power, mut sum) = (0.5, 0.5 * (1.0 - complement * complement));
    // the difference is squared in every round: eight are ample for the least complement there is
    for _ in 0..64 {
        let c = (a - b) / 2.0;
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
        if c <= 1e-16 * a {
            break;
        }
    }
    FRAC_PI_2 / a * (1.0 - sum)
}

/// Part of the mean relative speed that comes from encounters closing at `closing_mps_min` or
/// faster, m/s: `(1 / pi)` times the integral of |W| over those relative courses from 0 to pi.
fn fast_part_mps(own_mps: f64, target_mps: f64, closing_mps_min: f64) -> f64 {
    if (own_mps - target_mps).abs() >= closing_mps_min {
        return mean_relative_speed_mps(own_mps, target_mps);
    }
    if own_mps + target_mps <= closing_mps_min {
        return 0.0;
    }
    let product = 2.0 * own_mps * target_mps;
    let squares = own_mps * own_mps + target_mps * target_mps;
    let cosine = (squares - closing_mps_min * closing_mps_min) / product;
    let from_rad = math::acos(cosine.clamp(-1.0, 1.0));
    const INTERVALS: u32 = 64;
    let width_rad = (PI - from_rad) / f64::from(INTERVALS);
    let speed_mps = |i: u32| {
        let course_rad = from_rad + width_rad * f64::from(i);
        (squares - product * math::cos(course_rad)).max(0.0).sqrt()
    };
    let simpson = |i: u32| match i {
        0 | INTERVALS => 1.0,
        _ if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = (0..=INTERVALS).map(|i| simpson(i) * speed_mps(i)).sum();
    sum * width_rad / 3.0 / PI
}

/// The drawing and weighting of one stratum.
#[derive(Clone, Debug)]
pub(crate) struct Rate {
    closing_mps_min: f64,
    /// Z, m/s.
    mean_mps: f64,
    /// Ends of the bands, metres, 0 first; with the share and the density quotient of each.
    bands: Vec<Band>,
    /// Largest weight that can be drawn.
    pub(crate) weight_max: f64,
}

#[derive(Clone, Copy, Debug)]
struct Band {
    from_m: f64,
    to_m: f64,
    share: f64,
    /// True density over drawn density.
    quotient: f64,
}

/// Speeds and relative course of an encounter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    pub(crate) own_mps: f64,
    pub(crate) target_mps: f64,
    pub(crate) course_rad: f64,
    /// Draws that were refused before.
    pub(crate) rejected: u64,
}

impl Rate {
    /// Of a validated stratum.
    pub(crate) fn new(spec: &RateSpec, model: &Model, stratum: &StratumSpec) -> Self {
        let (own, target) = (&model.own.speed_mps, target_speeds(model, stratum));
        let (mut fast_mps, mut drawn) = (0.0, 0.0);
        let target_nodes = target.nodes();
        for (own_mps, own_share) in own.nodes() {
            for &(target_mps, target_share) in &target_nodes {
                let part_mps = fast_part_mps(own_mps, target_mps, spec.closing_mps_min);
                if part_mps > 0.0 {
                    let share = own_share * target_share;
                    fast_mps += share * part_mps;
                    drawn += share * part_mps / mean_relative_speed_mps(own_mps, target_mps);
                }
            }
        }
        let mean_mps = fast_mps / drawn;
        let extent_m = spec.miss_m_drawn.last().map_or(0.0, |band| band.up_to_m);
        let mut from_m = 0.0;
        let bands: Vec<Band> = spec
            .miss_m_drawn
            .iter()
            .map(|band| {
                let (to_m, share) = (band.up_to_m, band.share);
                let quotient = (to_m - from_m) / extent_m / share;
                let band = Band { from_m, to_m, share, quotient };
                from_m = to_m;
                band
            })
            .collect();
        let fastest_mps = mean_relative_speed_mps(own.bounds().1, target.bounds().1);
        let widest = bands.iter().map(|band| band.quotient).fold(0.0, f64::max);
        let intents = match (&spec.intent_mix_drawn, true_mix(model, stratum)) {
            (Some(drawn), Some(mix)) => mix.largest_quotient(drawn),
            _ => 1.0,
        };
        let weight_max = fastest_mps / mean_mps * widest * intents;
        Self { closing_mps_min: spec.closing_mps_min, mean_mps, bands, weight_max }
    }

    /// Draws speeds and relative course; own speed comes from own ship's stream. `None` where
    /// hardly any encounter closes fast enough.
    pub(crate) fn meet(
        &self,
        (own, own_stream): (&Distribution, &mut Stream),
        (target, stream): (&Distribution, &mut Stream),
    ) -> Option<Meeting> {
        let mut rejected = 0;
        while rejected < TRIES_MAX {
            let (own_mps, target_mps) = (own.draw(own_stream), target.draw(stream));
            let squares = own_mps * own_mps + target_mps * target_mps;
            // the speeds are kept until a course is accepted, so that their law is the file's
            while rejected < TRIES_MAX {
                let course_rad = TAU * stream.uniform() - PI;
                let product = 2.0 * own_mps * target_mps * math::cos(course_rad);
                let closing_mps = (squares - product).max(0.0).sqrt();
                if stream.uniform() * (own_mps + target_mps) >= closing_mps {
                    rejected += 1;
                } else if closing_mps < self.closing_mps_min {
                    rejected += 1;
                    break;
                } else {
                    return Some(Meeting { own_mps, target_mps, course_rad, rejected });
                }
            }
        }
        None
    }

    /// Draws the signed miss distance, and its quotient of densities.
    pub(crate) fn miss(&self, stream: &mut Stream) -> (f64, f64) {
        let mut left = stream.uniform();
        let starboard = stream.uniform() < 0.5;
        let place = stream.uniform();
        let chosen = self.bands.iter().find(|band| {
            left -= band.share;
            left < 0.0
        });
        // rounding can leave a remainder: the last band takes it
        let band = chosen.unwrap_or(&self.bands[self.bands.len() - 1]);
        let size_m = band.from_m + place * (band.to_m - band.from_m);
        (if starboard { size_m } else { -size_m }, band.quotient)
    }

    /// The part of the weight that the speeds make.
    pub(crate) fn speed_weight(&self, own_mps: f64, target_mps: f64) -> f64 {
        mean_relative_speed_mps(own_mps, target_mps) / self.mean_mps
    }
}

pub(crate) fn target_speeds<'a>(model: &'a Model, stratum: &'a StratumSpec) -> &'a Distribution {
    stratum.target_speed_mps.as_ref().unwrap_or(&model.target.speed_mps)
}

pub(crate) fn true_mix<'a>(model: &'a Model, stratum: &'a StratumSpec) -> Option<&'a IntentMix> {
    stratum.intent_mix.as_ref().or(model.target.intent_mix.as_ref())
}

impl Model {
    /// The drawing of each stratum; empty where the laws are drawn as they stand.
    pub(crate) fn rates(&self) -> Vec<Rate> {
        let spec = self.encounter_rate.iter();
        spec.flat_map(|spec| self.stratum.iter().map(|one| Rate::new(spec, self, one))).collect()
    }
}
