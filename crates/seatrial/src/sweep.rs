//! How every rate moves with one threshold of a rule set.
//!
//! Rates are shares of the runs to which a check applied; runs that it could not decide count as
//! failures in the upper bound. The values of a sweep see the same runs, so their differences are
//! far better known than the bounds of each rate suggest.

use crate::commands::JudgedAgain;
use campaign::Plan;
use campaign::plan::RulesChoice;
use record::{Check, EncounterClass, Seed, Status};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use summary::{BoundedRate, Tally};

/// A threshold and the values that it is to take.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    /// Key of the rule-set file.
    pub(crate) key: String,
    /// In the unit of the key.
    pub(crate) values: Vec<f64>,
}

impl std::str::FromStr for Values {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!("`{text}` is no sweep; one looks like head_on_half_angle_deg=5,10,13,15,22.5")
        };
        let (key, list) = text.split_once('=').ok_or_else(wrong)?;
        let number = |word: &str| word.trim().parse().ok().filter(|v: &f64| v.is_finite());
        let values: Option<Vec<f64>> = list.split(',').map(number).collect();
        let values = values.filter(|_| !key.is_empty()).ok_or_else(wrong)?;
        Ok(Self { key: key.to_owned(), values })
    }
}

/// `sweep-<key>.json`.
#[derive(Debug, Serialize)]
pub(crate) struct Sweep {
    schema: u32,
    campaign: String,
    planner: String,
    seed: Seed,
    root_digest: String,
    rules: String,
    rules_hash: String,
    key: String,
    /// The rule set as it stands, first; then one entry for each value.
    points: Vec<Point>,
}

#[derive(Debug, Serialize)]
struct Point {
    /// Absent: the rule set as it stands.
    value: Option<f64>,
    rules: String,
    rules_hash: String,
    /// Runs whose class differs from that under the rule set as it stands.
    class_changed: u64,
    all: Rates,
    strata: Vec<Rates>,
}

#[derive(Debug, Serialize)]
struct Rates {
    name: String,
    n: u64,
    unknown: u64,
    classes: BTreeMap<EncounterClass, u64>,
    checks: BTreeMap<Check, CheckRates>,
}

#[derive(Debug, Serialize)]
struct CheckRates {
    /// Runs to which the check applied: how often it was put to the test.
    applied: u64,
    fail: BoundedRate,
    warn: BoundedRate,
}

impl Sweep {
    /// From what each rule set said, the one as it stands first.
    pub(crate) fn new(
        plan: &Plan,
        rules: &RulesChoice,
        values: &Values,
        judged: &[JudgedAgain],
        class_changed: &[u64],
    ) -> Self {
        let none = Tally::new();
        let points = judged.iter().zip(class_changed).enumerate().map(|(i, (one, &changed))| {
            let stratum =
                |name: &String| Rates::new(name, one.tallies.stratum(name).unwrap_or(&none));
            Point {
                value: i.checked_sub(1).map(|i| values.values[i]),
                rules: one.rules.name.clone(),
                rules_hash: RulesChoice::hash_of(one.rules.text()),
                class_changed: changed,
                all: Rates::new("all", &one.tallies.total()),
                strata: plan.strata.iter().map(stratum).collect(),
            }
        });
        Self {
            schema: 1,
            campaign: plan.campaign.clone(),
            planner: plan.planner.name.clone(),
            seed: plan.seed,
            root_digest: judged.first().map_or("", |one| &one.summary.root_digest).to_owned(),
            rules: rules.name.clone(),
            rules_hash: rules.hash.clone(),
            key: values.key.clone(),
            points: points.collect(),
        }
    }

    /// The text of the file.
    pub(crate) fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("a sweep has string-like keys");
        text.push('\n');
        text
    }

    /// Shares of all strata together, a column for each value, each under the number of runs that
    /// it is a share of; rules never put to the test last.
    pub(crate) fn table(&self) -> String {
        const NAME: usize = 38;
        let mut text = format!("{:NAME$}", self.key);
        for point in &self.points {
            let head = point.value.map_or("as it stands".to_owned(), |value| value.to_string());
            write!(text, " {head:>12}").expect("writing to a string");
        }
        text.push('\n');
        let mut line = |name: &str, cell: &dyn Fn(&Point) -> String| {
            write!(text, "{name:NAME$}").expect("writing to a string");
            for point in &self.points {
                write!(text, " {:>12}", cell(point)).expect("writing to a string");
            }
            text.push('\n');
        };
        let percent =
            |rate: Option<f64>| rate.map_or("-".to_owned(), |v| format!("{:.2} %", 100.0 * v));
        let share = |k: u64, n: u64| percent((n > 0).then(|| k as f64 / n as f64));
        line("runs", &|p| p.all.n.to_string());
        line("class differs", &|p| share(p.class_changed, p.all.n));
        for class in EncounterClass::ALL {
            let name = format!("class {}", class.name());
            line(&name, &|p| share(p.all.classes[&class], p.all.n));
        }
        let tested = |check: &Check| self.points.iter().any(|p| p.all.checks[check].applied > 0);
        for check in Check::ALL.into_iter().filter(tested) {
            line(&format!("{} applied to", check.name()), &|p| {
                p.all.checks[&check].applied.to_string()
            });
            line("  fail", &|p| percent(p.all.checks[&check].fail.rate));
            if self.points.iter().any(|p| p.all.checks[&check].warn.k > 0) {
                line("  warn", &|p| percent(p.all.checks[&check].warn.rate));
            }
        }
        let untested: Vec<&str> =
            Check::ALL.into_iter().filter(|c| !tested(c)).map(Check::name).collect();
        if !untested.is_empty() {
            writeln!(text, "never put to the test: {}", untested.join(", "))
                .expect("writing to a string");
        }
        text
    }
}

impl Rates {
    fn new(name: &str, tally: &Tally) -> Self {
        let rates = |check: Check| {
            let of = |status| tally.check(check, status);
            let fail = summary::check_rate(of);
            let warn = BoundedRate::new(of(Status::Warn), of(Status::Inconclusive), fail.n);
            CheckRates { applied: fail.n, fail, warn }
        };
        let class = |class| (class, tally.class(Some(class)));
        Self {
            name: name.to_owned(),
            n: tally.n,
            unknown: tally.unknown,
            classes: EncounterClass::ALL.into_iter().map(class).collect(),
            checks: Check::ALL.into_iter().map(|check| (check, rates(check))).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_names_a_key_and_numbers() {
        let sweep: Values = "head_on_half_angle_deg=5,22.5".parse().unwrap();
        assert_eq!(sweep.key, "head_on_half_angle_deg");
        assert_eq!(sweep.values, [5.0, 22.5]);
        for text in ["head_on_half_angle_deg", "a=", "a=1,", "a=x", "=1", "a=nan", "a=1,inf"] {
            assert!(text.parse::<Values>().is_err(), "{text}");
        }
    }
}
