//! Several planners on the same encounters, side by side.

use crate::figure::Figure;
use crate::input::{Compared, Cost, Extra};
use crate::number::{NONE, count, fixed, per_cent_or_none, significant};
use crate::page::{bounds, css, fill, inline};
use crate::weighted::{self, check_rate};
use crate::write::Rendered;
use crate::{ReportError, figure_rates};
use geom::EncounterClass;
use record::{Check, Status};
use serde::Serialize;
use std::path::Path;
use summary::{BoundedRate, PairedRates, StratumSummary, Tally};

/// `comparison.html` and its figures.
pub(crate) fn render(columns: &[Compared]) -> Result<Vec<Rendered>, ReportError> {
    let wholes: Vec<StratumSummary> = columns
        .iter()
        .map(|column| summary_of(column, &column.tallies.total(), |_| true))
        .collect();
    let mut figures = vec![Figure {
        stem: "comparison".to_owned(),
        title: "Rates and their bounds, all strata".to_owned(),
        ..figure_rates::figure(&wholes, &runs(&wholes))
    }];
    let mut strata_tables = Vec::new();
    for name in stratum_names(columns) {
        let strata: Vec<StratumSummary> = columns
            .iter()
            .filter_map(|column| {
                let tally = column.tallies.stratum(&name)?;
                Some(summary_of(column, tally, |stratum| stratum == name))
            })
            .collect();
        let extra = |cost: &Cost| cost.strata.iter().find(|(n, _)| *n == name).map(|(_, e)| *e);
        let lines = lines(&strata).into_iter().chain(extras(columns, extra)).collect();
        strata_tables.push(StratumTable { name: name.clone(), lines });
        figures.push(Figure {
            stem: format!("comparison-{}", name.replace(|c: char| !c.is_alphanumeric(), "-")),
            title: name,
            ..figure_rates::figure(&strata, &runs(&strata))
        });
    }
    let first = columns.first();
    let view = View {
        css: css(),
        title: first.map_or("", |column| &column.card.title),
        campaign: first.map_or("", |column| &column.card.campaign),
        seed: first.map_or_else(String::new, |column| column.summary.seed.to_string()),
        tool: first.map_or("", |column| &column.card.tool),
        problems: problems(columns),
        planners: columns
            .iter()
            .map(|column| Planner { name: &column.summary.planner, link: column.link })
            .collect(),
        lines: lines(&wholes).into_iter().chain(costs(columns)).collect(),
        strata: strata_tables,
        figures: figures.iter().map(inline).collect(),
    };
    let text = fill("comparison.html", include_str!("../templates/comparison.html"), &view)?;
    let mut files = vec![Rendered { path: "comparison.html".into(), text }];
    files.extend(figures.into_iter().filter_map(|figure| {
        let path = Path::new("figures").join(format!("{}.svg", figure.stem));
        figure.svg.map(|text| Rendered { path, text })
    }));
    Ok(files)
}

/// A column's runs, those of the strata that `of` takes, with the rates that a page shows.
fn summary_of(column: &Compared, tally: &Tally, of: impl Fn(&str) -> bool) -> StratumSummary {
    let summary = StratumSummary::new(&column.summary.planner, tally);
    let strata = column.summary.strata.iter().filter(|stratum| of(&stratum.name));
    let largest = strata.filter_map(|s| Some(s.weighted.as_ref()?.weight_max)).reduce(f64::max);
    match largest {
        Some(weight_max) => weighted::shown(summary.with_weights(tally, weight_max)),
        None => summary,
    }
}

#[derive(Serialize)]
struct View<'a> {
    css: String,
    title: &'a str,
    campaign: &'a str,
    seed: String,
    tool: &'a str,
    problems: Vec<String>,
    planners: Vec<Planner<'a>>,
    lines: Vec<Line>,
    strata: Vec<StratumTable>,
    figures: Vec<Figure>,
}

/// The same lines for one stratum.
#[derive(Serialize)]
struct StratumTable {
    name: String,
    lines: Vec<Line>,
}

#[derive(Serialize)]
struct Planner<'a> {
    name: &'a str,
    link: &'a str,
}

#[derive(Serialize)]
struct Line {
    label: String,
    cells: Vec<Cell>,
}

#[derive(Serialize)]
struct Cell {
    value: String,
    small: String,
}

/// More strata than this have their tables and figures in the single reports only.
const STRATA_MAX: usize = 12;

fn stratum_names(columns: &[Compared]) -> Vec<String> {
    let strata = columns.first().map_or(&[][..], |column| &column.summary.strata);
    if strata.len() > STRATA_MAX || strata.len() < 2 {
        return Vec::new();
    }
    strata.iter().map(|stratum| stratum.name.clone()).collect()
}

fn runs(lines: &[StratumSummary]) -> String {
    let each: Vec<String> = lines.iter().map(|line| count(line.n)).collect();
    format!("a line for each planner, n = {}", each.join(", "))
}

/// Numbers of different encounters must not stand beside each other without a word.
fn problems(columns: &[Compared]) -> Vec<String> {
    let Some((first, others)) = columns.split_first() else {
        return vec!["There is no planner to compare.".to_owned()];
    };
    let same = |other: &&Compared| {
        let names = |column: &Compared| -> Vec<(String, u64)> {
            column.summary.strata.iter().map(|s| (s.name.clone(), s.n)).collect()
        };
        other.summary.campaign == first.summary.campaign
            && other.summary.seed == first.summary.seed
            && names(other) == names(first)
    };
    others
        .iter()
        .filter(|other| !same(other))
        .map(|other| {
            format!(
                "{} did not meet the same encounters as {}: their numbers cannot be compared.",
                other.summary.planner, first.summary.planner
            )
        })
        .collect()
}

fn lines(wholes: &[StratumSummary]) -> Vec<Line> {
    let plain = |label: &str, of: &dyn Fn(&StratumSummary) -> String| Line {
        label: label.to_owned(),
        cells: wholes.iter().map(|s| Cell { value: of(s), small: String::new() }).collect(),
    };
    let rate = |label: &str, of: &dyn Fn(&StratumSummary) -> BoundedRate| Line {
        label: label.to_owned(),
        cells: wholes
            .iter()
            .map(|s| {
                let rate = of(s);
                let value = format!(
                    "{} ({} of {})",
                    per_cent_or_none(rate.rate),
                    count(rate.k),
                    count(rate.n)
                );
                Cell { value, small: bounds(&rate) }
            })
            .collect(),
    };
    let mut lines = vec![
        plain("encounters", &|s| count(s.n)),
        plain("outcome unknown", &|s| count(s.unknown)),
        rate("collisions", &|s| s.collision),
        rate("safety radius broken", &|s| s.safety_radius),
        Line {
            label: "collisions with over without avoiding".to_owned(),
            cells: wholes.iter().map(|s| ratio_cell(&s.collision_pairs)).collect(),
        },
        plain("collisions caused by avoiding", &|s| count(s.collision_pairs.caused)),
        plain("reaction, s: half · 95 %", &|s| {
            let times = &s.reaction_time_s;
            format!("{} · {}", fixed(times.median, 1), fixed(times.p95, 1))
        }),
        plain("smallest distance, m: 1 % · half below", &|s| {
            format!("{} · {}", fixed(s.min_cpa_m.p01, 1), fixed(s.min_cpa_m.median, 1))
        }),
    ];
    for check in Check::ALL {
        let of = |s: &StratumSummary| check_rate(s, check);
        if wholes.iter().any(|s| of(s).n > 0) {
            lines.push(rate(&format!("failed: {}", check.title()), &of));
        }
    }
    lines
}

/// Of every planner what only its tallies and its second runs know.
fn costs(columns: &[Compared]) -> Vec<Line> {
    let line = |label: &str, of: &dyn Fn(&Compared) -> String| Line {
        label: label.to_owned(),
        cells: columns.iter().map(|c| Cell { value: of(c), small: String::new() }).collect(),
    };
    let mut lines = vec![line("kinds of findings: checks failed, by class", &|column| {
        let whole = column.tallies.total();
        let classes = EncounterClass::ALL.into_iter().map(Some).chain([None]);
        let failed = |class, check| whole.check_in_class(class, check, Status::Fail) > 0;
        let of = |class| Check::ALL.into_iter().filter(|&check| failed(class, check)).count();
        count(classes.map(of).sum::<usize>() as u64)
    })];
    lines.extend(extras(columns, |cost| Some(cost.whole)));
    if columns.iter().any(|column| column.cost.is_some()) {
        lines.push(line("planning, us per call: mean (wall clock of this machine)", &|column| {
            fixed(column.cost.map(|cost| cost.planning_us_per_call), 2)
        }));
    }
    lines
}

/// Extra way and time, of the encounters that were run again.
fn extras(columns: &[Compared], of: impl Fn(&Cost) -> Option<Extra>) -> Vec<Line> {
    if columns.iter().all(|column| column.cost.is_none()) {
        return Vec::new();
    }
    let extra = |column: &Compared| column.cost.and_then(&of);
    let line = |label: &str, cell: &dyn Fn(Option<Extra>) -> String| Line {
        label: label.to_owned(),
        cells: columns
            .iter()
            .map(|column| Cell { value: cell(extra(column)), small: String::new() })
            .collect(),
    };
    vec![
        line("extra distance, m: mean", &|extra| fixed(extra.map(|e| e.distance_m), 0)),
        line("extra time, s: mean", &|extra| fixed(extra.map(|e| e.time_s), 1)),
        line("encounters behind these two", &|extra| {
            extra.map_or_else(|| NONE.to_owned(), |e| count(e.encounters))
        }),
    ]
}

fn ratio_cell(pairs: &PairedRates) -> Cell {
    let ratio = |value: Option<f64>| value.map_or(NONE.to_owned(), |r| significant(r, 3));
    let bounds = || format!("{} to {}", ratio(pairs.lower_95), ratio(pairs.upper_95));
    Cell {
        value: ratio(pairs.risk_ratio),
        small: pairs.lower_95.map_or_else(String::new, |_| bounds()),
    }
}
