//! The seed planner's known faults beside the clusters of the reports that show them.
//!
//! A report knows no F-number: its clusters are made of rule or event, class and planner. Which
//! cluster shows which fault is said here, once; how often it came up, in which encounter it is
//! worst and what becomes of it in a planner without the fault is read from the results.

use crate::{each_row, line, planner, rate};
use record::{Check, EncounterClass, Outcome, Status};
use std::collections::BTreeMap;
use std::path::Path;
use summary::{Event, Findings, PlannerEvent, Tally};

use EncounterClass::{CrossingPort, CrossingStbd, HeadOn, Overtaken, Overtaking};

/// A cluster of a report.
struct Shown {
    /// The result.
    dir: &'static str,
    event: Event,
    /// The check's warnings count too: what the rules leave open.
    warnings: bool,
    /// The class of encounter; absent: the one with the most runs in it.
    class: Option<EncounterClass>,
    /// The same encounters without the fault.
    without: &'static str,
}

/// A fault with what shows it.
struct Fault {
    name: &'static str,
    what: &'static str,
    tests: &'static str,
    shown: Vec<Shown>,
}

const fn cluster(
    dir: &'static str,
    event: Event,
    class: Option<EncounterClass>,
    without: &'static str,
) -> Shown {
    Shown { dir, event, warnings: false, class, without }
}

const fn warned(
    dir: &'static str,
    check: Check,
    class: EncounterClass,
    without: &'static str,
) -> Shown {
    Shown { dir, event: Event::Failed(check), warnings: true, class: Some(class), without }
}

const R: Event = Event::SafetyRadius;
const HIT: Event = Event::Contact(Outcome::Collision);
const CAP: Event = Event::Planner(PlannerEvent::InnerLoopCap);
const CLASS: Event = Event::Planner(PlannerEvent::ClassChanged);

/// In the order of the specification.
fn faults() -> Vec<Fault> {
    let fault = |name, what, tests, shown| Fault { name, what, tests, shown };
    let (lab, quick) = ("laboratory/zhuang", "quick/zhuang");
    let (lab_latched, quick_latched) = ("laboratory/zhuang-latched", "quick/zhuang-latched");
    let (lab_corrected, quick_corrected) =
        ("laboratory/zhuang-corrected", "quick/zhuang-corrected");
    let printed = "laboratory/zhuang-as-printed";
    vec![
        fault(
            "F1",
            "no memory: head-on becomes crossing, starboard becomes port",
            "f1_head_on_turns_into_crossing_and_the_turn_is_taken_back",
            vec![
                cluster(lab, CLASS, Some(HeadOn), lab_latched),
                cluster(lab, R, Some(HeadOn), lab_latched),
                cluster(quick, CLASS, Some(HeadOn), quick_latched),
            ],
        ),
        fault(
            "F2",
            "stand-on duty ignored",
            "f2_f3_a_stand_on_ship_turns_to_port_at_once",
            vec![
                cluster(lab, Event::Failed(Check::R17Hold), Some(CrossingPort), lab_corrected),
                cluster(quick, Event::Failed(Check::R17Hold), Some(CrossingPort), quick_corrected),
            ],
        ),
        fault(
            "F3",
            "port turn for a ship to port",
            "the same",
            vec![
                cluster(lab, Event::Failed(Check::R17Port), Some(CrossingPort), lab_corrected),
                cluster(quick, Event::Failed(Check::R17Port), Some(CrossingPort), quick_corrected),
            ],
        ),
        fault(
            "F4",
            "not readily apparent",
            "f4_f5_alterations_are_small_and_pass_at_r",
            vec![
                cluster(lab, Event::Failed(Check::R8Magnitude), None, lab_corrected),
                warned(quick, Check::R8Magnitude, CrossingStbd, quick_corrected),
            ],
        ),
        fault(
            "F5",
            "passes at R without a margin",
            "f5_is_repaired_by_a_margin_and_by_nothing_else",
            vec![
                cluster(quick_latched, R, Some(CrossingStbd), "margin/zhuang-latched"),
                cluster(quick_latched, R, Some(Overtaking), "margin/zhuang-latched"),
            ],
        ),
        fault(
            "F6",
            "reversed turn with a faster target",
            "f6_a_faster_target_from_starboard_is_answered_to_port",
            vec![
                warned(lab, Check::Turn, CrossingStbd, lab_corrected),
                warned(quick, Check::Turn, CrossingStbd, quick_corrected),
            ],
        ),
        fault(
            "F7",
            "the side depends on the compass",
            "f7_the_side_depends_on_the_compass, the_paper_as_printed_depends_on_the_compass",
            vec![],
        ),
        fault(
            "F8",
            "receding target taken for a danger",
            "f8_a_receding_target_is_a_danger_as_printed",
            vec![cluster(printed, Event::Planner(PlannerEvent::RecedingFlagged), None, lab)],
        ),
        fault(
            "F9",
            "inside the circle called safe",
            "f9_inside_the_circle_is_safe_as_printed",
            vec![cluster(printed, Event::Planner(PlannerEvent::InsideCalledSafe), None, lab)],
        ),
        fault(
            "F10",
            "the inner loop need not end",
            "f10_the_inner_loop_need_not_end",
            vec![
                cluster(printed, CAP, None, lab_latched),
                cluster(lab, CAP, None, lab_latched),
                cluster(quick, CAP, None, quick_latched),
            ],
        ),
        fault(
            "F11",
            "two targets, opposite sides: no end",
            "f11_two_targets_of_opposite_sides_never_end",
            vec![cluster("several/zhuang-latched", CAP, None, "several/zhuang-corrected")],
        ),
        fault(
            "F12",
            "reference is the largest turn, not the most urgent",
            "f12_is_repaired_by_urgency_and_by_nothing_else",
            vec![
                cluster("several/zhuang-latched", R, None, "urgent/zhuang-latched"),
                cluster(
                    "several/zhuang-latched",
                    Event::Failed(Check::R8Third),
                    None,
                    "urgent/zhuang-latched",
                ),
            ],
        ),
        fault(
            "F13",
            "targets assumed on straight lines",
            "f13_a_target_that_gives_way_is_not_foreseen",
            vec![
                cluster("altering", R, Some(CrossingPort), lab),
                cluster("altering", HIT, Some(CrossingPort), lab),
            ],
        ),
        fault(
            "F14",
            "two readings of the resume are unsafe",
            "f14_two_readings_of_the_resume_are_unsafe",
            vec![
                cluster("laboratory/zhuang-goal-first", HIT, Some(Overtaking), lab),
                cluster("laboratory/zhuang-when-safe", R, Some(Overtaking), lab),
                cluster("quick/zhuang-goal-first", R, Some(Overtaking), quick),
                cluster("quick/zhuang-when-safe", R, Some(Overtaking), quick),
            ],
        ),
        fault(
            "F15",
            "class oscillates beside a border",
            "f15_the_side_changes_with_every_degree_of_noise",
            vec![
                cluster("boundary/zhuang", CLASS, Some(Overtaking), "boundary/zhuang-latched"),
                cluster(
                    "boundary/zhuang",
                    Event::Failed(Check::R8Dribble),
                    None,
                    "boundary/zhuang-latched",
                ),
            ],
        ),
        fault(
            "F16",
            "no rule for being overtaken",
            "f16_being_overtaken_is_answered_with_the_reversed_turn",
            vec![
                cluster(lab, Event::Failed(Check::R17Hold), Some(Overtaken), lab_corrected),
                cluster(lab, HIT, Some(Overtaken), lab_corrected),
                cluster(quick, Event::Failed(Check::R17Hold), Some(Overtaken), quick_corrected),
            ],
        ),
        fault(
            "F17",
            "slows, stops, goes astern",
            "f17_the_equations_slow_down_and_go_astern",
            vec![
                cluster(
                    "close/zhuang-as-printed",
                    Event::Unknown(Outcome::PlannerOutOfRange),
                    None,
                    "close/zhuang",
                ),
                cluster("close/zhuang", Event::Planner(PlannerEvent::Limited), None, lab),
                cluster("close/zhuang", HIT, None, "close/zhuang-corrected"),
            ],
        ),
        fault(
            "F18",
            "step of course unbounded at low speed",
            "f18_the_step_of_course_is_unbounded_at_low_speed, vectors",
            vec![],
        ),
        fault(
            "F19",
            "no model of the ship",
            "f19_is_repaired_by_a_model_of_the_ship_and_by_nothing_else",
            vec![
                cluster("late/zhuang-latched", R, Some(HeadOn), "nimble/zhuang-latched"),
                cluster("late/zhuang-latched", R, Some(CrossingStbd), "nimble/zhuang-latched"),
            ],
        ),
        fault("F20", "rules that are not there", "a table below", vec![]),
        fault(
            "F21",
            "passes ahead under 17(b)",
            "f21_acting_leads_across_the_bow_where_holding_on_would_not",
            vec![],
        ),
        fault(
            "F22",
            "static target: side from an undefined course",
            "f22_a_target_at_rest_has_a_side_only_by_its_undefined_course, vectors",
            vec![],
        ),
    ]
}

/// What a report makes of a result: its clusters and counts.
#[derive(Default)]
struct Reported {
    planner: String,
    findings: Findings,
    tally: Tally,
}

/// Every result is read once.
struct Results<'a> {
    root: &'a Path,
    read: BTreeMap<&'static str, Reported>,
}

impl Results<'_> {
    fn of(&mut self, dir: &'static str) -> anyhow::Result<&Reported> {
        if !self.read.contains_key(dir) {
            let path = self.root.join(dir);
            let mut reported = Reported { planner: planner(&path)?, ..Reported::default() };
            each_row(&path, |row| {
                reported.findings.offer(row);
                reported.tally.add(row);
            })?;
            self.read.insert(dir, reported);
        }
        Ok(&self.read[dir])
    }
}

impl Reported {
    /// Runs in a cluster, of how many, and the worst of them; zero where the report has none.
    fn cluster(&self, shown: &Shown, class: EncounterClass) -> (u64, u64, Option<String>) {
        let event = shown.event;
        let n = match event {
            Event::Failed(check) => {
                [Status::Pass, Status::Warn, Status::Fail, Status::Inconclusive]
                    .map(|status| self.tally.check_in_class(Some(class), check, status))
                    .iter()
                    .sum()
            }
            _ => self.tally.class(Some(class)),
        };
        let list = self.findings.list();
        let found = list.iter().find(|f| f.event == event && f.class == Some(class));
        let warnings = match event {
            Event::Failed(check) if shown.warnings => {
                self.tally.check_in_class(Some(class), check, Status::Warn)
            }
            _ => 0,
        };
        let worst = found.map(|f| f.worst.to_string());
        (found.map_or(0, |f| f.count) + warnings, n, worst)
    }
}

pub(crate) fn print(out: &mut String, root: &Path) -> anyhow::Result<()> {
    let mut results = Results { root, read: BTreeMap::new() };
    line!(
        out,
        "| | finding | shown by the test | cluster of the report of | rule or event | class | \
         runs | % [95 %] | without the fault | worst |"
    );
    line!(out, "|---|---|---|---|---|---|---|---|---|---|");
    for Fault { name, what, tests, shown } in faults() {
        let head = format!("| {name} | {what} | `{}` |", tests.replace(", ", "`, `"));
        if shown.is_empty() {
            line!(out, "{head} | | | | | | |");
        }
        for (number, shown) in shown.iter().enumerate() {
            let head = if number == 0 { head.as_str() } else { "| | | |" };
            let Shown { dir, event, warnings, class, without } = *shown;
            let reported = results.of(dir)?;
            let planner = reported.planner.clone();
            let largest = || {
                let classes = EncounterClass::ALL.into_iter();
                classes.max_by_key(|&class| reported.cluster(shown, class).0)
            };
            let Some(class) = class.or_else(largest) else { continue };
            let (k, n, worst) = reported.cluster(shown, class);
            let (k_without, n_without, _) = results.of(without)?.cluster(shown, class);
            let campaign = dir.split('/').next().unwrap_or(dir);
            let none = if k == 0 { "not reproduced" } else { "" };
            let worst = worst.map_or_else(|| none.to_owned(), |id| format!("`{id}`"));
            let title = event.title();
            let title = if warnings { title.replace("fail", "warn or fail") } else { title };
            line!(
                out,
                "{head} {campaign}, `{planner}` | {} | {} | {k} of {n} | {} | {} (`{without}`) | \
                 {worst} |",
                title,
                class.name(),
                rate(k, 0, n),
                rate(k_without, 0, n_without),
            );
        }
    }
    Ok(())
}
