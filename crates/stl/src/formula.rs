//! Formulas of discrete-time signal temporal logic (rules specification, section 12).
//!
//! Syntax only: `semantics` gives a formula its robustness and `truth` its boolean value, by two
//! recursions that share no code. Time is counted in samples; the caller converts seconds.

use crate::semantics::FormulaError;

/// A formula over the named columns of [`Signals`].
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A comparison of one signal with a constant.
    Predicate(Predicate),
    /// Negation.
    Not(Box<Formula>),
    /// All of them; true when there are none.
    And(Vec<Formula>),
    /// Any of them; false when there are none.
    Or(Vec<Formula>),
    /// The first only with the second.
    Implies(Box<Formula>, Box<Formula>),
    /// At every sample of a window ahead.
    Always(Window, Box<Formula>),
    /// At some sample of a window ahead.
    Eventually(Window, Box<Formula>),
    /// The second holds at some sample of the window ahead, and the first at every sample from now
    /// until just before that one.
    Until(Window, Box<Formula>, Box<Formula>),
    /// At some sample of a window behind.
    Once(Window, Box<Formula>),
    /// At every sample of a window behind.
    Historically(Window, Box<Formula>),
}

/// A comparison of one signal with a constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicate {
    /// Name of the signal.
    pub signal: &'static str,
    /// How it is compared.
    pub op: Comparison,
    /// With what, in the unit of the signal.
    pub constant: f64,
    /// The robustness is divided by this and clipped to [-1, 1], so that metres cannot drown
    /// degrees; absent: the plain difference.
    pub scale: Option<f64>,
}

/// How a signal is compared. Strict and non-strict differ in truth at equality only; their
/// robustness is the same, and 0 there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `>`
    Above,
    /// `>=`
    AtLeast,
    /// `<`
    Below,
    /// `<=`
    AtMost,
}

/// Samples `from..=to` away from the present one; without `to` up to the end of the trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Nearest sample.
    pub from: usize,
    /// Farthest sample.
    pub to: Option<usize>,
}

impl Window {
    /// From now on without an end.
    pub const UNBOUNDED: Self = Self { from: 0, to: None };

    /// From `from` to `to` samples away.
    pub const fn between(from: usize, to: usize) -> Self {
        Self { from, to: Some(to) }
    }
}

/// A flag: a signal of +1 and -1.
pub fn flag(signal: &'static str) -> Formula {
    let op = Comparison::Above;
    Formula::Predicate(Predicate { signal, op, constant: 0.0, scale: None })
}

/// `signal >= constant`, scaled.
pub fn at_least(signal: &'static str, constant: f64, scale: f64) -> Formula {
    let op = Comparison::AtLeast;
    Formula::Predicate(Predicate { signal, op, constant, scale: Some(scale) })
}

/// `signal <= constant`, scaled.
pub fn at_most(signal: &'static str, constant: f64, scale: f64) -> Formula {
    let op = Comparison::AtMost;
    Formula::Predicate(Predicate { signal, op, constant, scale: Some(scale) })
}

/// `formula` at every sample from now on.
pub fn always(formula: Formula) -> Formula {
    Formula::Always(Window::UNBOUNDED, Box::new(formula))
}

/// `formula` at some sample from now on.
pub fn eventually(formula: Formula) -> Formula {
    Formula::Eventually(Window::UNBOUNDED, Box::new(formula))
}

/// `formula` now and at each of the last `samples` samples.
pub fn held(formula: Formula, samples: usize) -> Formula {
    Formula::Historically(Window::between(0, samples), Box::new(formula))
}

impl Formula {
    /// Negation.
    #[must_use]
    pub fn negated(self) -> Self {
        Self::Not(Box::new(self))
    }

    /// Both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self::And(vec![self, other])
    }

    /// Either.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self::Or(vec![self, other])
    }

    /// `other` wherever `self`.
    #[must_use]
    pub fn implies(self, other: Self) -> Self {
        Self::Implies(Box::new(self), Box::new(other))
    }

    /// `self` until `other`, without a bound.
    #[must_use]
    pub fn until(self, other: Self) -> Self {
        Self::Until(Window::UNBOUNDED, Box::new(self), Box::new(other))
    }
}

/// Named columns of equal length, one value a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signals {
    samples: usize,
    columns: Vec<(&'static str, Vec<f64>)>,
}

impl Signals {
    /// No columns yet, `samples` rows.
    pub const fn new(samples: usize) -> Self {
        Self { samples, columns: Vec::new() }
    }

    /// Adds a column; what it has beyond the last sample is cut off.
    ///
    /// # Panics
    /// If it is too short: the caller builds all columns from one trace.
    #[must_use]
    pub fn with(mut self, name: &'static str, mut values: Vec<f64>) -> Self {
        assert!(values.len() >= self.samples, "column {name} is too short");
        values.truncate(self.samples);
        self.columns.push((name, values));
        self
    }

    /// Number of samples.
    pub const fn samples(&self) -> usize {
        self.samples
    }

    /// A column by its name.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn column(&self, name: &'static str) -> Result<&[f64], FormulaError> {
        let found = self.columns.iter().find(|(column, _)| *column == name);
        found.map(|(_, values)| values.as_slice()).ok_or_else(|| FormulaError::UnknownSignal {
            name,
            known: self.columns.iter().map(|(column, _)| *column).collect(),
        })
    }

    /// Whether every value is a number.
    pub fn is_finite(&self) -> bool {
        self.columns.iter().all(|(_, values)| values.iter().all(|v| v.is_finite()))
    }
}
