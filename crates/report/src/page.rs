//! `report.html`: one file that needs no network, filled from numbers alone.

use crate::canvas::Ink;
use crate::figure::{DataTable, Figure};
use crate::findings::{self, FindingLine};
use crate::group::{Group, all, groups};
use crate::input::{Case, ReportInput};
use crate::number::{NONE, count, fixed, per_cent, per_cent_or_none};
use crate::page_tables::{avoiding, classes, outcomes};
use crate::weighted::{self, check_rate};
use crate::wording::{self, Verdict, encounters, verdict};
use crate::{ReportError, case_figure, figure_cpa, figure_map, figure_polar, figure_rates};
use crate::{figure_times, font, player};
use record::{Check, DistanceKind, Status};
use serde::Serialize;
use summary::{BoundedRate, StratumSummary, Tally};

/// All figures of a report, those of the cases last.
pub(crate) fn figures(input: &ReportInput) -> Vec<Figure> {
    let card = input.card;
    let (groups, whole) = (groups(input), all(input));
    let weighted = whole.summary.weighted.is_some();
    let strata = input.summary.strata.iter().filter(|stratum| stratum.n > 0).count();
    let runs = format!(
        "n = {} in {strata} strat{}",
        count(input.summary.encounters),
        if strata == 1 { "um" } else { "a" }
    );
    let mut figures = vec![
        figure_rates::figure(&rate_lines(input), &runs),
        figure_cpa::figure(&groups, card.safety_radius_m, card.distance),
        figure_times::figure(&groups),
        figure_polar::figure(&whole.tally, weighted),
        figure_map::figure(&whole.tally, weighted),
    ];
    figures.extend(input.cases.iter().map(case_figure::figure));
    figures
}

/// The page, with the figures of [`figures`].
pub(crate) fn page(input: &ReportInput, figures: &[Figure]) -> Result<String, ReportError> {
    let (general, cases) = figures.split_at(figures.len() - input.cases.len());
    let card = input.card;
    let whole = all(input);
    let weighted = whole.summary.weighted.is_some();
    let view = View {
        css: css(),
        player: player::data(input.cases)?,
        hull: card.distance == DistanceKind::Hull,
        cone: input.cases.iter().any(|case| case.obstacle_radius_m.is_some()),
        script: include_str!("../templates/player.js"),
        head: Head {
            title: &card.title,
            planner: &card.planner,
            campaign: &card.campaign,
            rules: &card.rules,
            tool: &card.tool,
            seed: input.summary.seed.to_string(),
            encounters: encounters(input.summary.encounters),
            root_digest: &input.summary.root_digest,
            ended_by_wall_clock: input.summary.ended_by_wall_clock,
            beside: if card.beside { wording::BESIDE } else { "" },
        },
        verdict: verdict(&whole.summary),
        cards: cards(&whole.summary),
        not_claimed: wording::not_claimed(input, &whole),
        strata: strata(input, &whole),
        strata_note: if weighted { weighted::NOTE } else { weighted::NOTE_PLAIN },
        weighted: weighted::table(&rate_lines(input)),
        figures: general.iter().map(inline).collect(),
        findings: findings::lines(input, &whole),
        rules: Check::ALL.into_iter().map(|check| rule_line(&whole, check)).collect(),
        onset: onset(&whole.tally),
        classes: classes(&whole.tally, whole.summary.weighted.is_some()),
        avoiding: avoiding(&whole.summary),
        outcomes: outcomes(input, &whole),
        unavoidable: wording::unavoidable(&whole),
        cases: input.cases.iter().zip(cases).map(|(c, f)| case_view(input, c, f)).collect(),
        resolved: &card.resolved,
    };
    fill("report.html", include_str!("../templates/report.html"), &view)
}

/// The first sentences of the page: what was found.
pub fn verdict_sentences(input: &ReportInput) -> Vec<String> {
    verdict(&all(input).summary).sentences
}

/// What the page does not claim, sentence by sentence.
pub fn not_claimed(input: &ReportInput) -> Vec<String> {
    wording::not_claimed(input, &all(input))
}

/// Fills a template whose name ends in `.html`, which switches the escaping on.
pub(crate) fn fill(
    name: &'static str,
    template: &'static str,
    view: &impl Serialize,
) -> Result<String, ReportError> {
    let fail = |source| ReportError::Template { page: name, source };
    let mut environment = minijinja::Environment::new();
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    environment.add_template(name, template).map_err(fail)?;
    let view = minijinja::Value::from(minijinja::value::Serde(view));
    environment.get_template(name).and_then(|page| page.render(view)).map_err(fail)
}

/// The style sheet of every page, fonts inside.
pub fn css() -> String {
    font::face_css() + include_str!("../templates/report.css")
}

/// The figure as part of a page: colours from its style sheet, fonts from the page.
pub(crate) fn inline(figure: &Figure) -> Figure {
    let themed = figure.svg.as_ref().map(|svg| {
        let (before, rest) = svg.split_once("<style>").unwrap_or((svg, ""));
        let after = rest.split_once("</style>").map_or(rest, |(_, after)| after);
        let mut svg = format!("{before}{after}");
        for (ink, variable) in Ink::THEMED {
            svg = svg.replace(&format!("\"{}\"", ink.hex()), &format!("\"var({variable})\""));
        }
        svg.replace(&format!(" font-family=\"{}\"", font::STACK), "")
    });
    Figure { svg: themed, ..figure.clone() }
}

#[derive(Serialize)]
struct View<'a> {
    css: String,
    player: String,
    /// Distances are from hull to hull.
    hull: bool,
    /// Some shown encounter has a velocity obstacle.
    cone: bool,
    script: &'static str,
    head: Head<'a>,
    verdict: Verdict,
    cards: Vec<Headline>,
    not_claimed: Vec<String>,
    strata: Vec<StratumLine>,
    strata_note: &'static str,
    weighted: Option<DataTable>,
    figures: Vec<Figure>,
    findings: Vec<FindingLine>,
    rules: Vec<RuleLine>,
    onset: String,
    classes: DataTable,
    avoiding: DataTable,
    outcomes: DataTable,
    unavoidable: Option<String>,
    cases: Vec<CaseView>,
    resolved: &'a [(String, String)],
}

#[derive(Serialize)]
struct Head<'a> {
    title: &'a str,
    planner: &'a str,
    campaign: &'a str,
    rules: &'a str,
    tool: &'a str,
    seed: String,
    encounters: String,
    root_digest: &'a str,
    ended_by_wall_clock: u64,
    beside: &'static str,
}

#[derive(Serialize)]
struct Headline {
    label: &'static str,
    value: String,
    lines: Vec<String>,
}

#[derive(Serialize)]
struct StratumLine {
    name: String,
    all: bool,
    n: String,
    collision: RateCell,
    collided: bool,
    safety_radius: RateCell,
    broken: bool,
    unknown: String,
    turn: String,
    reaction: String,
    cpa: String,
}

#[derive(Serialize)]
struct RateCell {
    k: String,
    bounds: String,
}

#[derive(Serialize)]
struct RuleLine {
    title: &'static str,
    applied: String,
    coverage: String,
    pass: String,
    warn: String,
    fail: String,
    failed: bool,
    inconclusive: String,
    not_applicable: String,
    not_evaluated: String,
    rate: String,
    bounds: String,
    /// The check ran and never applied: nothing is known of it.
    untested: bool,
    /// The check did not run at all.
    silent: bool,
    /// What it cannot do without.
    needs: Option<&'static str>,
}

#[derive(Serialize)]
struct CaseView {
    figure: Figure,
    outcome: String,
    facts: String,
    sentences: Vec<String>,
    replay: String,
}

/// `0.1 % to 0.3 %`, or the sign for none.
pub(crate) fn bounds(rate: &BoundedRate) -> String {
    if rate.n == 0 {
        return NONE.to_owned();
    }
    format!("{} to {}", per_cent(rate.lower_95), per_cent(rate.upper_95))
}

fn turn_rate(summary: &StratumSummary) -> BoundedRate {
    check_rate(summary, Check::Turn)
}

/// The strata of the campaign, with the rates that a page shows of them.
fn shown_strata(input: &ReportInput) -> Vec<StratumSummary> {
    input.summary.strata.iter().cloned().map(weighted::shown).collect()
}

/// The strata, and all together when there are several.
fn rate_lines(input: &ReportInput) -> Vec<StratumSummary> {
    let mut lines: Vec<StratumSummary> =
        shown_strata(input).into_iter().filter(|stratum| stratum.n > 0).collect();
    if lines.len() > 1 {
        lines.push(all(input).summary);
    }
    lines
}

fn cards(whole: &StratumSummary) -> Vec<Headline> {
    let rate = |label, rate: &BoundedRate, of: &str| Headline {
        label,
        value: per_cent_or_none(rate.rate),
        lines: vec![
            format!("{} of {} {of}", count(rate.k), count(rate.n)),
            format!("95 % bounds {}", bounds(rate)),
        ],
    };
    let reaction = &whole.reaction_time_s;
    let of = if whole.weighted.is_some() { "draws" } else { "encounters" };
    vec![
        rate("Collisions", &whole.collision, of),
        rate("Safety radius broken", &whole.safety_radius, of),
        rate("Turn direction failed", &turn_rate(whole), "to which it applied"),
        Headline {
            label: "Reaction time, half by",
            value: reaction.median.map_or(NONE.to_owned(), |s| format!("{} s", fixed(Some(s), 1))),
            lines: vec![
                format!("95 % by {} s, n = {}", fixed(reaction.p95, 1), count(reaction.n)),
                format!(
                    "{} never or cut short, {} early",
                    count(reaction.censored),
                    count(reaction.early)
                ),
            ],
        },
    ]
}

fn strata(input: &ReportInput, whole: &Group) -> Vec<StratumLine> {
    let line = |s: &StratumSummary, all: bool| {
        let turn = turn_rate(s);
        StratumLine {
            name: s.name.clone(),
            all,
            n: count(s.n),
            collision: RateCell { k: count(s.collision.k), bounds: bounds(&s.collision) },
            collided: s.collision.k > 0,
            safety_radius: RateCell {
                k: count(s.safety_radius.k),
                bounds: bounds(&s.safety_radius),
            },
            broken: s.safety_radius.k > 0,
            unknown: count(s.unknown),
            turn: format!("{} of {}", count(turn.k), count(turn.n)),
            reaction: format!(
                "{} · {}",
                fixed(s.reaction_time_s.median, 1),
                fixed(s.reaction_time_s.p95, 1)
            ),
            cpa: format!("{} · {}", fixed(s.min_cpa_m.p01, 1), fixed(s.min_cpa_m.median, 1)),
        }
    };
    let mut lines: Vec<StratumLine> =
        shown_strata(input).iter().map(|stratum| line(stratum, false)).collect();
    if lines.len() > 1 {
        lines.push(line(&whole.summary, true));
    }
    lines
}

fn rule_line(whole: &Group, check: Check) -> RuleLine {
    let tally = &whole.tally;
    let of = |status| tally.check(check, status);
    let rate = check_rate(&whole.summary, check);
    let share =
        |n: u64| if tally.n == 0 { NONE.into() } else { per_cent(n as f64 / tally.n as f64) };
    RuleLine {
        title: check.title(),
        applied: count(rate.n),
        coverage: share(rate.n),
        pass: count(of(Status::Pass)),
        warn: count(of(Status::Warn)),
        fail: count(of(Status::Fail)),
        failed: of(Status::Fail) > 0,
        inconclusive: count(of(Status::Inconclusive)),
        not_applicable: count(of(Status::NotApplicable)),
        not_evaluated: count(of(Status::NotEvaluated)),
        rate: per_cent_or_none(rate.rate),
        bounds: bounds(&rate),
        untested: tally.n > 0 && rate.n == 0 && of(Status::NotEvaluated) < tally.n,
        silent: tally.n > 0 && of(Status::NotEvaluated) == tally.n,
        needs: check.needs(),
    }
}

/// Where the judge took the onset of risk from.
fn onset(tally: &Tally) -> String {
    let actual = tally.collision_pairs.without_nominal;
    let nominal = tally.n - actual;
    format!(
        "Onset of risk, class and role are those of the nominal track (own ship on its route, not \
         avoiding) in {} runs, the same for every planner. {} runs have no nominal track: theirs \
         are those of the voyage itself, which a planner can change by acting early.",
        count(nominal),
        count(actual)
    )
}

fn case_view(input: &ReportInput, case: &Case, figure: &Figure) -> CaseView {
    let row = &case.row;
    let mut facts = vec![
        format!("smallest distance between hulls {} m", fixed(row.cpa_hull_m, 1)),
        format!("without avoiding {} m", fixed(row.nominal_cpa_hull_m, 1)),
        match row.targets {
            1 => "one target".to_owned(),
            several => format!("{several} targets"),
        },
        format!("own speed {} m/s", fixed(Some(row.own_speed_mps), 1)),
        format!("target speed {} m/s", fixed(row.target_speed_mps, 1)),
    ];
    if let Some(class) = row.class {
        facts.push(format!("class {}", class.name().replace('_', " ")));
    }
    if let Some(words) = &row.planner_detail {
        facts.push(format!("the planner's last words: {words}"));
    }
    facts.push(format!("digest {}", row.digest));
    let sentences = case
        .judgement
        .verdicts
        .iter()
        .filter(|v| matches!(v.status, Status::Fail | Status::Warn))
        .map(|v| {
            let plain = || format!("{} {}", v.status.name(), v.detail);
            format!("{}: {}", v.check.title(), v.sentence.clone().unwrap_or_else(plain))
        })
        .collect();
    CaseView {
        figure: inline(figure),
        outcome: row.outcome.name().replace('_', " "),
        facts: facts.join(", "),
        sentences,
        replay: input.card.replay_command.replace("{id}", &row.id.to_string()),
    }
}
