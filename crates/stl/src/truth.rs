//! Boolean truth of a formula at one sample, straight from the definitions.
//!
//! The check on `semantics`: quantifiers over index ranges, no minima, no sliding windows, and no
//! code in common. Slow (a window costs its length), so the judge never calls it.

use crate::formula::{Comparison, Formula, Predicate, Signals, Window};
use crate::semantics::FormulaError;

/// Whether `formula` is true at sample `t`, the trace taken as all there is. Always and
/// historically are true over an empty window, eventually, once and until are false.
///
/// # Errors
/// If a predicate names a signal that is not there.
pub fn truth(formula: &Formula, signals: &Signals, t: usize) -> Result<bool, FormulaError> {
    let at = |formula: &Formula, k: usize| truth(formula, signals, k);
    Ok(match formula {
        Formula::Predicate(predicate) => compare(predicate, signals.column(predicate.signal)?[t]),
        Formula::Not(a) => !at(a, t)?,
        Formula::And(all) => {
            for part in all {
                if !at(part, t)? {
                    return Ok(false);
                }
            }
            true
        }
        Formula::Or(any) => {
            for part in any {
                if at(part, t)? {
                    return Ok(true);
                }
            }
            false
        }
        Formula::Implies(a, b) => !at(a, t)? || at(b, t)?,
        Formula::Always(window, a) => !exists(future(*window, t, signals), |k| Ok(!at(a, k)?))?,
        Formula::Eventually(window, a) => exists(future(*window, t, signals), |k| at(a, k))?,
        Formula::Historically(window, a) => !exists(past(*window, t), |k| Ok(!at(a, k)?))?,
        Formula::Once(window, a) => exists(past(*window, t), |k| at(a, k))?,
        Formula::Until(window, a, b) => exists(future(*window, t, signals), |end| {
            Ok(at(b, end)? && !exists(t..end, |k| Ok(!at(a, k)?))?)
        })?,
    })
}

fn compare(predicate: &Predicate, x: f64) -> bool {
    match predicate.op {
        Comparison::Above => x > predicate.constant,
        Comparison::AtLeast => x >= predicate.constant,
        Comparison::Below => x < predicate.constant,
        Comparison::AtMost => x <= predicate.constant,
    }
}

fn future(window: Window, t: usize, signals: &Signals) -> std::ops::Range<usize> {
    let samples = signals.samples();
    let end = window.to.map_or(samples, |to| t.saturating_add(to).saturating_add(1).min(samples));
    t.saturating_add(window.from).min(samples)..end
}

fn past(window: Window, t: usize) -> std::ops::Range<usize> {
    let begin = window.to.map_or(0, |to| t.saturating_sub(to));
    if window.from > t { 0..0 } else { begin..t - window.from + 1 }
}

fn exists(
    range: std::ops::Range<usize>,
    mut holds: impl FnMut(usize) -> Result<bool, FormulaError>,
) -> Result<bool, FormulaError> {
    for k in range {
        if holds(k)? {
            return Ok(true);
        }
    }
    Ok(false)
}
