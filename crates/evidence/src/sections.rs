//! What the sections of `evidence.html` rest on beside the claims: the tool's own documents, the
//! gate's self-test, sweeps of thresholds, the pack before.

use crate::EvidenceError;
use crate::change::{Change, change, parse};
use crate::limits::{Assumption, assumptions};
use crate::pack::{PackInput, rule_sets};
use crate::planner_files::{PlannerFiles, planner_of};
use crate::thresholds::{Threshold, thresholds};
use gate::self_test::Report as SelfTestReport;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use summary::{BEARING_SECTORS, CellKey, RATIO_BANDS};

/// Folder of the tool's own documents inside a pack.
pub const BENCH: &str = "bench";
/// How the tool was built: target, profile, flags.
pub const BUILD: &str = "bench/build.json";
/// How each check reads its rule.
pub const READINGS: &str = "bench/readings.json";
/// The gate's self-test.
pub const SELF_TEST: &str = "gate/self-test.json";
/// Folder of the sweeps inside a pack.
pub const SENSITIVITY: &str = "sensitivity";

/// Everything that is read from given files and from the plan.
#[derive(Debug)]
pub(crate) struct Sections {
    pub(crate) built: BTreeMap<String, String>,
    pub(crate) readings: Vec<Reading>,
    pub(crate) thresholds: Vec<Threshold>,
    pub(crate) assumptions: Vec<Assumption>,
    pub(crate) documents: Vec<Document>,
    pub(crate) self_test: Option<SelfTest>,
    pub(crate) coverage: Coverage,
    pub(crate) sweeps: Vec<SweepView>,
    pub(crate) change: Option<Change>,
    pub(crate) planner_files: Option<PlannerFiles>,
}

impl Sections {
    pub(crate) fn new(input: &PackInput<'_>) -> Result<Self, EvidenceError> {
        let given = input.given;
        let optional = |path: &str| given.contains_key(path);
        let sets = rule_sets(input.plan);
        Ok(Self {
            built: if optional(BUILD) { parse(given, BUILD)? } else { BTreeMap::new() },
            readings: if optional(READINGS) { parse(given, READINGS)? } else { Vec::new() },
            thresholds: sets.into_iter().flat_map(|(name, text)| thresholds(name, text)).collect(),
            assumptions: assumptions(input.plan)?,
            documents: documents(input),
            self_test: if optional(SELF_TEST) { Some(self_test(input)?) } else { None },
            coverage: Coverage::new(input),
            sweeps: sweeps(input)?,
            change: change(input)?,
            planner_files: planner_of(given, &input.plan.planner.name)?,
        })
    }
}

/// How a check reads its rule, from the head of its source file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// The source file, such as `rule_14_head_on.rs`.
    pub file: String,
    /// The rule and its short title.
    pub rule: String,
    /// The treaty's words, where the head quotes them.
    pub text: String,
    /// Our reading: the predicate.
    pub reading: String,
    /// Where the reading is taken from.
    pub source: String,
}

/// A document of the tool that is part of the pack.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Document {
    pub(crate) path: String,
    pub(crate) title: String,
}

fn documents(input: &PackInput<'_>) -> Vec<Document> {
    let pages = input
        .given
        .iter()
        .filter(|(path, _)| path.strip_prefix(BENCH).is_some_and(|_| path.ends_with(".md")));
    pages
        .map(|(path, bytes)| {
            let text = String::from_utf8_lossy(bytes);
            let title = text.lines().find_map(|line| line.strip_prefix("# "));
            let title = title.unwrap_or("without a title").to_owned();
            Document { path: path.clone(), title }
        })
        .collect()
}

/// The gate's self-test in words.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SelfTest {
    pub(crate) sentences: Vec<String>,
    /// Planner, verdict, pairs, worse in.
    pub(crate) killings: Vec<(String, &'static str, u64, String)>,
    pub(crate) killed: usize,
    pub(crate) baseline: String,
    /// Whether it was made by the engine of this pack.
    pub(crate) same_engine: bool,
    pub(crate) engine: String,
    pub(crate) small: bool,
}

fn self_test(input: &PackInput<'_>) -> Result<SelfTest, EvidenceError> {
    let report: SelfTestReport = parse(input.given, SELF_TEST)?;
    let killing = |k: &gate::self_test::Killing| {
        let verdict = if k.killed() { "caught" } else { "SURVIVED" };
        (k.candidate.clone(), verdict, k.pairs, k.worse.join(", "))
    };
    Ok(SelfTest {
        sentences: vec![
            report.same.sentence(&report.baseline),
            report.uniform.sentence(),
            report.sentence(),
        ],
        killings: report.killings.iter().map(killing).collect(),
        killed: report.killings.iter().filter(|k| k.killed()).count(),
        same_engine: report.engine == input.plan.build.engine,
        baseline: report.baseline,
        engine: report.engine,
        small: report.small,
    })
}

/// Where on the map of relative bearing and speed ratio there was an encounter.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Coverage {
    pub(crate) cells: usize,
    pub(crate) met: usize,
    /// Cells with fewer encounters than [`FEW`], those without any left out.
    pub(crate) few: usize,
    pub(crate) few_below: u64,
    /// A line for each band of speed ratio that has empty sectors.
    pub(crate) empty: Vec<(String, String)>,
    /// Class, encounters.
    pub(crate) classes: Vec<(String, u64)>,
}

/// A cell with fewer encounters says little: with none failed, its exact 95 % bound is above 10 %.
const FEW: u64 = 30;

impl Coverage {
    fn new(input: &PackInput<'_>) -> Self {
        let total = input.report.tallies.total();
        let cells = total.map.cells();
        let key = |sector, band| CellKey { sector, band };
        let empty = (0..RATIO_BANDS).filter_map(|band| {
            let sectors: Vec<String> = (0..BEARING_SECTORS)
                .map(|sector| key(sector, band))
                .filter(|cell| !cells.contains_key(cell))
                .map(|cell| format!("{:.0}", cell.bearing_deg()))
                .collect();
            let (low, high) = key(0, band).ratio();
            let ratio = match high {
                Some(high) => format!("{low:.2} to {high:.2}"),
                None => format!("{low:.2} and more"),
            };
            let all = sectors.len() == usize::from(BEARING_SECTORS);
            let text = if all { "every bearing".to_owned() } else { sectors.join(", ") };
            (!sectors.is_empty()).then_some((ratio, text))
        });
        let classes = geom::EncounterClass::ALL.map(Some).into_iter().chain([None]);
        Self {
            cells: usize::from(BEARING_SECTORS) * usize::from(RATIO_BANDS),
            met: cells.len(),
            few: cells.values().filter(|cell| cell.n < FEW).count(),
            few_below: FEW,
            empty: empty.collect(),
            classes: classes
                .map(|class| {
                    let name = class.map_or("risk never opened", geom::EncounterClass::name);
                    (name.replace('_', " "), total.class(class))
                })
                .collect(),
        }
    }
}

/// A sweep of one threshold, as `judge --sweep` writes it; only what the pack shows is read.
#[derive(Clone, Debug, Deserialize)]
struct Sweep {
    root_digest: String,
    key: String,
    points: Vec<Point>,
}

#[derive(Clone, Debug, Deserialize)]
struct Point {
    value: Option<f64>,
    class_changed: u64,
    all: Rates,
}

#[derive(Clone, Debug, Deserialize)]
struct Rates {
    checks: BTreeMap<record::Check, CheckRates>,
}

#[derive(Clone, Debug, Deserialize)]
struct CheckRates {
    fail: summary::BoundedRate,
}

/// A sweep as a table.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SweepView {
    pub(crate) path: String,
    pub(crate) key: String,
    pub(crate) head: Vec<String>,
    /// First the name of the check.
    pub(crate) rows: Vec<Vec<String>>,
}

fn sweeps(input: &PackInput<'_>) -> Result<Vec<SweepView>, EvidenceError> {
    let inside =
        |path: &&String| path.strip_prefix(SENSITIVITY).is_some_and(|p| p.starts_with('/'));
    let view = |path: &String| {
        let sweep: Sweep = parse(input.given, path)?;
        if sweep.root_digest != input.gathered.root_digest {
            return Err(EvidenceError::Form {
                path: path.clone(),
                problem: "it is a sweep of other runs".to_owned(),
            });
        }
        Ok(sweep_view(path, &sweep))
    };
    input.given.keys().filter(inside).map(view).collect()
}

fn sweep_view(path: &str, sweep: &Sweep) -> SweepView {
    let value = |point: &Point| point.value.map_or("as it stands".to_owned(), |v| v.to_string());
    let mut rows = vec![
        std::iter::once("class differs".to_owned())
            .chain(sweep.points.iter().map(|point| point.class_changed.to_string()))
            .collect(),
    ];
    for check in record::Check::ALL {
        let fails: Vec<u64> =
            sweep.points.iter().map(|p| p.all.checks.get(&check).map_or(0, |c| c.fail.k)).collect();
        if fails.iter().any(|k| *k != fails[0]) {
            let cells = fails.iter().map(u64::to_string);
            rows.push(std::iter::once(format!("failed: {}", check.title())).chain(cells).collect());
        }
    }
    SweepView {
        path: path.to_owned(),
        key: sweep.key.clone(),
        head: sweep.points.iter().map(value).collect(),
        rows,
    }
}
