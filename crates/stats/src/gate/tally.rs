//! What a gate counts: one metric against one other planner, and one rate in one stratum.

use super::plan::Margin;
use super::run::Observation;
use crate::math::real;
use crate::{
    Claim, DifferenceSequence, Estimate, Forecast, Method, NonInferiority, PairedCounts, RateTest,
    StatsError, clopper_pearson_upper,
};

/// One metric against one other planner.
#[derive(Debug, Clone)]
pub(super) struct Comparison {
    pub(super) test: NonInferiority,
    sequence: DifferenceSequence,
    pub(super) for_pass: PairedCounts,
    pub(super) for_fail: PairedCounts,
    pub(super) undetermined: u64,
    pub(super) ln_pass_max: f64,
    pub(super) passed_at: Option<u64>,
}

impl Comparison {
    pub(super) fn new(margin: Margin, discordance_plan: f64) -> Result<Self, StatsError> {
        Ok(Self {
            test: margin.test(discordance_plan)?,
            // The design margin only shapes the sequence; a relative one may exceed 1.
            sequence: DifferenceSequence::planned(
                margin.as_difference().min(0.5),
                discordance_plan,
            )?,
            for_pass: PairedCounts::default(),
            for_fail: PairedCounts::default(),
            undetermined: 0,
            ln_pass_max: 0.0,
            passed_at: None,
        })
    }

    /// Undetermined goes against the candidate in the PASS test and for it in the FAIL test.
    pub(super) fn count(&mut self, candidate: Observation, other: Observation) {
        let unless_none = |outcome| outcome != Observation::NoEvent;
        let certain = |outcome| outcome == Observation::Event;
        self.for_pass.add(unless_none(candidate), certain(other));
        self.for_fail.add(certain(candidate), unless_none(other));
        if candidate == Observation::Undetermined || other == Observation::Undetermined {
            self.undetermined += 1;
        }
    }

    pub(super) fn look(&mut self, pairs: u64, ln_level: f64) {
        self.ln_pass_max = self.ln_pass_max.max(self.test.ln_e(&self.for_pass));
        if self.passed_at.is_none() && self.ln_pass_max >= ln_level {
            self.passed_at = Some(pairs);
        }
    }

    /// The confidence sequence of D, undetermined outcomes against both of its ends; the value
    /// takes them for no difference.
    pub(super) fn difference(&self, alpha: f64) -> Estimate {
        let n = self.for_pass.n();
        let value = if n == 0 {
            0.0
        } else {
            (real(self.for_fail.n10) - real(self.for_pass.n01)) / real(n)
        };
        Estimate {
            value,
            lower: self.sequence.lower(&self.for_fail, alpha).unwrap_or(-1.0),
            upper: self.sequence.upper(&self.for_pass, alpha).unwrap_or(1.0),
            n,
            n_effective: real(n),
            method: Method::ConfidenceSequence,
        }
    }

    pub(super) fn forecast(&self, alpha: f64) -> Forecast {
        if self.passed_at.is_some() {
            return Forecast::Reached;
        }
        self.test.forecast(&self.for_pass, alpha)
    }
}

/// One absolute requirement.
#[derive(Debug, Clone)]
pub(super) struct Absolute {
    demonstrated: RateTest,
    violated: RateTest,
    pub(super) events_demonstrated: u64,
    pub(super) events_violated: u64,
    pub(super) n: u64,
    pub(super) ln_demonstrated_max: f64,
    pub(super) ln_violated_max: f64,
}

impl Absolute {
    pub(super) fn new(rate_max: f64) -> Result<Self, StatsError> {
        Ok(Self {
            demonstrated: RateTest::demonstrated(rate_max)?,
            violated: RateTest::violated(rate_max)?,
            events_demonstrated: 0,
            events_violated: 0,
            n: 0,
            ln_demonstrated_max: 0.0,
            ln_violated_max: 0.0,
        })
    }

    /// Undetermined is an event when the rate is to be demonstrated, and none for "violated".
    pub(super) fn count(&mut self, outcome: Observation) {
        self.n += 1;
        self.events_demonstrated += u64::from(outcome != Observation::NoEvent);
        self.events_violated += u64::from(outcome == Observation::Event);
    }

    pub(super) fn look(&mut self) {
        let demonstrated = self.demonstrated.ln_e_counts(self.events_demonstrated, self.n);
        let violated = self.violated.ln_e_counts(self.events_violated, self.n);
        self.ln_demonstrated_max = self.ln_demonstrated_max.max(demonstrated);
        self.ln_violated_max = self.ln_violated_max.max(violated);
    }

    /// The exact upper bound of the rate at the declared N.
    pub(super) fn claim(&self, alpha: f64) -> Option<Claim> {
        let upper = clopper_pearson_upper(self.events_demonstrated, self.n, alpha).ok()?;
        let n_effective = real(self.n);
        let value = real(self.events_demonstrated) / n_effective;
        let method = Method::ClopperPearson;
        Estimate { value, lower: 0.0, upper, n: self.n, n_effective, method }.try_into().ok()
    }

    pub(super) fn forecast(&self, alpha: f64) -> Forecast {
        self.demonstrated
            .forecast(self.events_demonstrated, self.n, alpha)
            .expect("events are counted among the encounters")
    }
}
