//! What a model must be for its weights to be right, and what is allowed but shows little.

use crate::Distribution;
use crate::encounter_rate::{RateSpec, target_speeds, true_mix};
use crate::error::require;
use crate::limits::positive;
use crate::spec::{Model, StratumSpec};
use crate::{Error, RunSettings};
use record::DistanceKind;

impl RateSpec {
    /// Refuses what the weights would not be right for; the rest of the model is valid already.
    pub(crate) fn validate(&self, model: &Model) -> Result<(), Error> {
        const TABLE: &str = "model.encounter_rate";
        let geometry = &model.geometry;
        positive(TABLE, "closing_mps_min", self.closing_mps_min)?;
        let extent_m = self.validate_bands(TABLE)?;
        require(
            geometry.miss_m == Distribution::Uniform([-extent_m, extent_m]),
            || "model.geometry.miss_m".to_owned(),
            || {
                format!(
                    "must be {{ uniform = [-{extent_m:?}, {extent_m:?}] }} with \
                     [model.encounter_rate]: a traffic spread evenly passes at every distance \
                     alike, and the last of miss_m_drawn ends there"
                )
            },
        )?;
        self.validate_ranges(model, extent_m)?;
        for stratum in &model.stratum {
            let key = format!("model.stratum.{}", stratum.name);
            let only_any = stratum.class.is_none() && stratum.boundary.is_none();
            require(
                only_any && stratum.also.is_none(),
                || key.clone(),
                || {
                    "has a class, a border or further targets, for which the encounter rate has no \
                     known weight; with [model.encounter_rate] a stratum is of any class and of \
                     one target"
                        .to_owned()
                },
            )?;
            let course = stratum.relative_course_deg.as_ref();
            let whole = |law: &Distribution| {
                matches!(law, Distribution::Uniform([low, high])
                    if (high - low - 360.0).abs() < 1e-9)
            };
            require(
                whole(course.unwrap_or(&geometry.relative_course_deg)),
                || format!("{key}.relative_course_deg"),
                || {
                    "must be uniform over the circle with [model.encounter_rate]; the rate decides \
                     which courses are met more often"
                        .to_owned()
                },
            )?;
            let speeds_mps =
                model.own.speed_mps.bounds().1 + target_speeds(model, stratum).bounds().1;
            require(
                speeds_mps > self.closing_mps_min,
                || format!("{TABLE}.closing_mps_min"),
                || {
                    format!(
                        "= {} is never reached: the ships of {key} close at {speeds_mps} m/s at \
                         most",
                        self.closing_mps_min
                    )
                },
            )?;
            self.validate_mix(model, stratum)?;
        }
        Ok(())
    }

    /// The bands rise and have shares over 0 that sum to 1; where the last ends.
    fn validate_bands(&self, table: &str) -> Result<f64, Error> {
        let (mut from_m, mut sum) = (0.0, 0.0);
        for (i, band) in self.miss_m_drawn.iter().enumerate() {
            let key = || format!("{table}.miss_m_drawn.{}", i + 1);
            require(
                band.up_to_m.is_finite() && band.up_to_m > from_m,
                || format!("{}.up_to_m", key()),
                || format!("= {} must be over {from_m}, where the band begins", band.up_to_m),
            )?;
            require(
                band.share > 0.0 && band.share <= 1.0,
                || format!("{}.share", key()),
                || {
                    format!(
                        "= {} must be over 0 and at most 1: what is never drawn has no weight",
                        band.share
                    )
                },
            )?;
            from_m = band.up_to_m;
            sum += band.share;
        }
        require(
            (sum - 1.0).abs() < 1e-9,
            || format!("{table}.miss_m_drawn"),
            || format!("has shares that sum to {sum}; they must sum to 1"),
        )?;
        Ok(from_m)
    }

    /// Time and start range may refuse no encounter, for that would bend the weights.
    fn validate_ranges(&self, model: &Model, extent_m: f64) -> Result<(), Error> {
        let geometry = &model.geometry;
        let nearest_m =
            geometry.range_m_min_beyond_half_length + model.target.length_m.bounds().1 / 2.0;
        let slowest_m = self.closing_mps_min * geometry.tcpa_s[1];
        require(
            slowest_m > nearest_m,
            || "model.encounter_rate.closing_mps_min".to_owned(),
            || {
                format!(
                    "= {} times the longest tcpa_s gives {slowest_m} m; it must be over the least \
                     start range, {nearest_m} m, or slow encounters have no start",
                    self.closing_mps_min
                )
            },
        )?;
        let own_mps = model.own.speed_mps.bounds().1;
        let fastest_mps = model
            .stratum
            .iter()
            .map(|stratum| own_mps + target_speeds(model, stratum).bounds().1)
            .fold(0.0, f64::max);
        let max_m = geometry.range_m_max;
        let way_m = (max_m * max_m - extent_m * extent_m).max(0.0).sqrt();
        let fastest_m = fastest_mps * geometry.tcpa_s[0];
        require(
            fastest_m < way_m,
            || "model.geometry.range_m_max".to_owned(),
            || {
                format!(
                    "= {max_m} leaves {way_m:.0} m along the relative motion at a miss distance of \
                     {extent_m} m; with [model.encounter_rate] it must leave over {fastest_m} m, \
                     the shortest tcpa_s at the fastest closing, or fast encounters have no start"
                )
            },
        )
    }

    fn validate_mix(&self, model: &Model, stratum: &StratumSpec) -> Result<(), Error> {
        const KEY: &str = "model.encounter_rate.intent_mix_drawn";
        let Some(drawn) = &self.intent_mix_drawn else { return Ok(()) };
        drawn.validate(KEY, model.target.conduct.as_ref())?;
        let Some(mix) = true_mix(model, stratum) else {
            return Err(Error::spec(KEY, "needs model.target.intent_mix, the true shares"));
        };
        mix.validate_drawn(KEY, drawn)
    }
}

impl Model {
    /// What is allowed but shows less than it seems to: whether every miss distance that can be
    /// drawn lies inside the event, so that no encounter passes clear by itself and nothing that
    /// the planner causes can be seen.
    pub fn warnings(&self, run: &RunSettings) -> Vec<String> {
        let (low_m, high_m) = self.geometry.miss_m.bounds();
        let widest_m = low_m.abs().max(high_m.abs());
        // a hull reaches at least half a beam towards the other ship, however she lies
        let beams_m = (self.own.beam_m
            + self.target.length_m.bounds().0 * self.target.beam_per_length.bounds().0)
            / 2.0;
        let radius_m = match run.distance {
            DistanceKind::Hull => run.safety_radius_m + beams_m,
            DistanceKind::Centre => run.safety_radius_m,
        };
        let events = [("collides", beams_m), ("breaks the safety radius", radius_m)];
        let inside = events.iter().filter(|(_, within_m)| widest_m <= *within_m);
        inside
            .map(|(event, within_m)| {
                format!(
                    "`model.geometry.miss_m` reaches {widest_m} m, and every pass within \
                     {within_m:.1} m {event}: no encounter passes clear by itself, so what a \
                     planner causes cannot be seen; widen it"
                )
            })
            .collect()
    }
}
