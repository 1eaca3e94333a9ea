//! Robustness of a formula at every sample, by minima and maxima (rules specification, section 12).
//!
//! Implemented from the definitions: `rho(x <= c) = c - x`, not negates, and is min, or is max,
//! `a -> b` is `max(-rho a, rho b)`, always is min and eventually max over the window, and
//! `a until b` is the largest over `t'` of `min(rho b(t'), min over [t, t') of rho a)`.
//! An empty window gives +inf (always, historically) or -inf (eventually, once, until). That is
//! what the definition says of a finite trace and what nobody may trust of a run that was cut
//! short; [`bounds`] says what the samples that were never recorded could still change.

use crate::formula::{Comparison, Formula, Predicate, Signals, Window};

/// A formula that cannot be evaluated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormulaError {
    /// A predicate names a signal that is not there.
    #[error("find signal `{name}`; there are {known:?}")]
    UnknownSignal {
        /// The name that was asked for.
        name: &'static str,
        /// The names that exist.
        known: Vec<&'static str>,
    },
}

/// Robustness of a formula at one sample under every continuation of the trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// No continuation gives less.
    pub lower: f64,
    /// No continuation gives more.
    pub upper: f64,
}

/// Robustness at every sample, the trace taken as all there is. Signals must be finite.
///
/// # Errors
/// If a predicate names a signal that is not there.
pub fn robustness(formula: &Formula, signals: &Signals) -> Result<Vec<f64>, FormulaError> {
    series(formula, signals, Beyond::Nothing)
}

/// Robustness at every sample, the trace taken as the beginning of a longer one. Where lower and
/// upper are equal, every window that matters lies inside the trace.
///
/// # Errors
/// If a predicate names a signal that is not there.
pub fn bounds(formula: &Formula, signals: &Signals) -> Result<Vec<Bounds>, FormulaError> {
    let lower = series(formula, signals, Beyond::Worst)?;
    let upper = series(formula, signals, Beyond::Best)?;
    let both = lower.into_iter().zip(upper);
    Ok(both.map(|(lower, upper)| Bounds { lower, upper }).collect())
}

/// What lies after the last sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Beyond {
    /// Nothing: windows end with the trace.
    Nothing,
    /// Whatever makes the formula least robust.
    Worst,
    /// Whatever makes the formula most robust.
    Best,
}

impl Beyond {
    const fn negated(self) -> Self {
        match self {
            Self::Nothing => Self::Nothing,
            Self::Worst => Self::Best,
            Self::Best => Self::Worst,
        }
    }

    /// The value that stands for all samples after the last one in a fold over a window.
    const fn padding(self, fold: Fold) -> f64 {
        match (self, fold) {
            (Self::Worst, _) | (Self::Nothing, Fold::Max) => f64::NEG_INFINITY,
            (Self::Best, _) | (Self::Nothing, Fold::Min) => f64::INFINITY,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fold {
    Min,
    Max,
}

impl Fold {
    #[inline(always)]
    fn of(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Min => {
                if b < a {
                    b
                } else {
                    a
                }
            }
            Self::Max => {
                if b > a {
                    b
                } else {
                    a
                }
            }
        }
    }
}

fn series(formula: &Formula, signals: &Signals, beyond: Beyond) -> Result<Vec<f64>, FormulaError> {
    let child = |formula: &Formula| series(formula, signals, beyond);
    Ok(match formula {
        Formula::Predicate(predicate) => predicate_series(predicate, signals)?,
        Formula::Not(a) => negative(series(a, signals, beyond.negated())?),
        Formula::And(all) => combined(all, signals, beyond, Fold::Min)?,
        Formula::Or(any) => combined(any, signals, beyond, Fold::Max)?,
        Formula::Implies(a, b) => {
            let premise = negative(series(a, signals, beyond.negated())?);
            pointwise(premise, &child(b)?, Fold::Max)
        }
        Formula::Always(window, a) => ahead(child(a)?, *window, Fold::Min, beyond),
        Formula::Eventually(window, a) => ahead(child(a)?, *window, Fold::Max, beyond),
        Formula::Until(window, a, b) => until(&child(a)?, &child(b)?, *window, beyond),
        Formula::Once(window, a) => behind(child(a)?, *window, Fold::Max),
        Formula::Historically(window, a) => behind(child(a)?, *window, Fold::Min),
    })
}

fn predicate_series(predicate: &Predicate, signals: &Signals) -> Result<Vec<f64>, FormulaError> {
    let (sign, constant) = match predicate.op {
        Comparison::Above | Comparison::AtLeast => (1.0, predicate.constant),
        Comparison::Below | Comparison::AtMost => (-1.0, predicate.constant),
    };
    let values = signals.column(predicate.signal)?.iter();
    Ok(match predicate.scale {
        None => values.map(|x| sign * (x - constant)).collect(),
        Some(scale) => values.map(|x| (sign * (x - constant) / scale).clamp(-1.0, 1.0)).collect(),
    })
}

fn negative(mut values: Vec<f64>) -> Vec<f64> {
    for value in &mut values {
        *value = -*value;
    }
    values
}

fn pointwise(mut values: Vec<f64>, others: &[f64], fold: Fold) -> Vec<f64> {
    // The choice stands outside the loops, so that each is a plain minimum or maximum.
    match fold {
        Fold::Min => values.iter_mut().zip(others).for_each(|(a, b)| *a = Fold::Min.of(*a, *b)),
        Fold::Max => values.iter_mut().zip(others).for_each(|(a, b)| *a = Fold::Max.of(*a, *b)),
    }
    values
}

fn combined(
    parts: &[Formula],
    signals: &Signals,
    beyond: Beyond,
    fold: Fold,
) -> Result<Vec<f64>, FormulaError> {
    let Some((first, rest)) = parts.split_first() else {
        return Ok(vec![Beyond::Nothing.padding(fold); signals.samples()]);
    };
    let mut values = series(first, signals, beyond)?;
    for part in rest {
        values = pointwise(values, &series(part, signals, beyond)?, fold);
    }
    Ok(values)
}

/// Fold over a window ahead of every sample.
fn ahead(mut values: Vec<f64>, window: Window, fold: Fold, beyond: Beyond) -> Vec<f64> {
    let samples = values.len();
    let padding = beyond.padding(fold);
    values.push(padding);
    let at = |index: usize| index.min(samples);
    let Some(to) = window.to else {
        for k in (0..samples).rev() {
            values[k] = fold.of(values[k], values[k + 1]);
        }
        if window.from > 0 {
            return (0..samples).map(|t| values[at(t.saturating_add(window.from))]).collect();
        }
        values.truncate(samples);
        return values;
    };
    if to < window.from {
        return vec![Beyond::Nothing.padding(fold); samples];
    }
    // A window is covered by two overlapping blocks whose length is a power of two: min and max
    // do not mind that the overlap counts twice.
    let length = to - window.from + 1;
    let mut block = 1;
    while block * 2 <= length && block <= samples {
        let inside = samples - block;
        for k in 0..inside {
            values[k] = fold.of(values[k], values[k + block]);
        }
        for value in &mut values[inside..samples] {
            *value = fold.of(*value, padding);
        }
        block *= 2;
    }
    let second = (window.from.saturating_add(length)).saturating_sub(block);
    (0..samples)
        .map(|t| {
            let near = values[at(t.saturating_add(window.from))];
            fold.of(near, values[at(t.saturating_add(second))])
        })
        .collect()
}

/// Fold over a window behind every sample: nothing there is unseen.
fn behind(mut values: Vec<f64>, window: Window, fold: Fold) -> Vec<f64> {
    values.reverse();
    let mut folded = ahead(values, window, fold, Beyond::Nothing);
    folded.reverse();
    folded
}

fn until(a: &[f64], b: &[f64], window: Window, beyond: Beyond) -> Vec<f64> {
    let samples = a.len();
    let unseen = beyond.padding(Fold::Max);
    if window == Window::UNBOUNDED {
        let mut values = vec![unseen; samples];
        let mut later = unseen;
        for k in (0..samples).rev() {
            later = Fold::Max.of(b[k], Fold::Min.of(a[k], later));
            values[k] = later;
        }
        return values;
    }
    (0..samples)
        .map(|t| {
            let mut best = f64::NEG_INFINITY;
            let mut so_far = f64::INFINITY;
            // One step past the last sample stands for every later one.
            let last = window.to.map_or(samples, |to| t.saturating_add(to).min(samples));
            for k in t..=last {
                let (holds, ends) =
                    if k < samples { (a[k], b[k]) } else { (f64::INFINITY, unseen) };
                if k >= t.saturating_add(window.from) || k == samples {
                    best = best.max(so_far.min(ends));
                }
                so_far = so_far.min(holds);
            }
            best
        })
        .collect()
}
