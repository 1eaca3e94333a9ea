//! From a trace to a robustness for each check and pair.
//!
//! Contract (rules specification, section 12): the robustness is negative where the prose status
//! of the first judge is FAIL, positive where it is PASS or WARN; 0 is undecided and counted
//! apart. What has no formula is said to be not evaluated.

use crate::action::Deviation;
use crate::checks::{Case, Claim};
use crate::life::lives;
use crate::params::Params;
use crate::semantics::{bounds, robustness};
use record::{Check, ShipTrack, Trace};

/// What the formula of a check says of one pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Robustness {
    /// Which check.
    pub check: Check,
    /// Index of the target.
    pub target: u8,
    /// Robustness, scaled and clipped to [-1, 1]; absent where nothing was decided.
    pub rho: Option<f64>,
    /// The finding.
    pub status: Finding,
    /// Whether the antecedent was ever true: the rule was put to the test.
    pub antecedent: bool,
}

/// Six findings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// Positive robustness: the first judge says PASS or WARN.
    Holds,
    /// Negative robustness: the first judge says FAIL.
    Violated,
    /// Robustness 0: on the boundary, where strict and non-strict differ.
    Undecided,
    /// The antecedent was never true.
    NotApplicable,
    /// The run ended before the window of the formula, or a sample is not a number.
    Inconclusive,
    /// There is no formula, or an input is missing.
    NotEvaluated,
}

/// The checks that have a formula, in the order in which they are decided.
pub const WITH_FORMULA: [Check; 8] = [
    Check::R17Hold,
    Check::R17Port,
    Check::R8Magnitude,
    Check::Safe,
    Check::R13,
    Check::R14,
    Check::R15,
    Check::R19,
];

/// Every check of every pair: target by target, in the order of [`Check::ALL`].
pub fn judge(trace: &Trace, params: &Params) -> Vec<Robustness> {
    let whole = sound(&trace.own, trace.samples())
        && trace.samples() > 0
        && trace.pairs.len() == trace.targets.len()
        && trace.targets.iter().all(|t| has_samples(t, trace.samples()))
        && trace.nominal.as_ref().is_none_or(|n| {
            sound(&n.own, n.own.len()) && n.targets.iter().all(|t| sound(t, t.len()))
        });
    if !whole {
        let targets = 0..trace.targets.len();
        return targets.flat_map(|target| row(target, |_| Decision::INCONCLUSIVE)).collect();
    }
    let lives = lives(trace, params);
    let deviation = Deviation::of(trace, params);
    (0..trace.targets.len())
        .flat_map(|target| {
            if !pair_is_sound(trace, target) {
                return row(target, |_| Decision::INCONCLUSIVE);
            }
            let mut case = Case::new(trace, params, &lives, &deviation, target);
            let mut decided = [Decision::NOT_EVALUATED; Check::COUNT];
            for check in WITH_FORMULA {
                let decision = decide(case.claim(check));
                case.remember(check, decision.status);
                decided[check as usize] = decision;
            }
            row(target, |check| decided[check as usize])
        })
        .collect()
}

#[derive(Clone, Copy, Debug)]
struct Decision {
    rho: Option<f64>,
    status: Finding,
    antecedent: bool,
}

impl Decision {
    const NOT_EVALUATED: Self =
        Self { rho: None, status: Finding::NotEvaluated, antecedent: false };
    const NOT_APPLICABLE: Self =
        Self { rho: None, status: Finding::NotApplicable, antecedent: false };
    const INCONCLUSIVE: Self = Self { rho: None, status: Finding::Inconclusive, antecedent: false };
}

fn row(target: usize, decision: impl Fn(Check) -> Decision) -> Vec<Robustness> {
    let target = u8::try_from(target).unwrap_or(u8::MAX);
    let one = |check: Check| {
        let Decision { rho, status, antecedent } = match decision(check) {
            d if d.status == Finding::Inconclusive && !WITH_FORMULA.contains(&check) => {
                Decision::NOT_EVALUATED
            }
            d => d,
        };
        Robustness { check, target, rho, status, antecedent }
    };
    Check::ALL.into_iter().map(one).collect()
}

fn decide(claim: Claim) -> Decision {
    let (formula, signals, complete) = match claim {
        Claim::NotApplicable => return Decision::NOT_APPLICABLE,
        Claim::NotEvaluated => return Decision::NOT_EVALUATED,
        Claim::Formula { formula, signals, complete } => (formula, signals, complete),
    };
    // The formulas are ours and their columns are built beside them.
    let rho = if complete {
        robustness(&formula, &signals).expect("every column of a formula is built with it")[0]
    } else {
        bounds(&formula, &signals).expect("every column of a formula is built with it")[0].upper
    };
    let status = match rho.total_cmp(&0.0) {
        _ if rho.abs() <= 0.0 => Finding::Undecided,
        std::cmp::Ordering::Less => Finding::Violated,
        _ => Finding::Holds,
    };
    match status {
        // No continuation of the run mends what was broken, and none is trusted to keep the rest.
        Finding::Holds | Finding::Undecided if !complete => {
            Decision { antecedent: true, ..Decision::INCONCLUSIVE }
        }
        status => Decision { rho: Some(rho.clamp(-1.0, 1.0)), status, antecedent: true },
    }
}

fn pair_is_sound(trace: &Trace, target: usize) -> bool {
    let pair = &trace.pairs[target];
    let minimum = &pair.minimum;
    sound(&trace.targets[target], trace.samples())
        && pair.hull_m.len() == trace.samples()
        && all_finite(&pair.hull_m)
        && [minimum.hull_m, minimum.hull_s, minimum.centre_m, minimum.centre_s]
            .iter()
            .all(|value| value.is_finite())
}

fn has_samples(track: &ShipTrack, samples: usize) -> bool {
    columns(track).iter().all(|column| column.len() == samples)
}

fn sound(track: &ShipTrack, samples: usize) -> bool {
    has_samples(track, samples) && columns(track).iter().all(|column| all_finite(column))
}

/// Without an early exit, so that the compiler can take several values at once.
fn all_finite(values: &[f64]) -> bool {
    values.iter().fold(true, |finite, value| finite & value.is_finite())
}

fn columns(track: &ShipTrack) -> [&[f64]; 6] {
    [
        &track.north_m,
        &track.east_m,
        &track.psi_rad,
        &track.vel_north_mps,
        &track.vel_east_mps,
        &track.yaw_rate_radps,
    ]
}
