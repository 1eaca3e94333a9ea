//! What the bench cannot show, what is known to be wrong with it, and what an argument built on it
//! takes for granted. A change of the bench that changes one of these changes this file.

use crate::EvidenceError;
use campaign::Plan;
use record::{Encounter, Sensing, Weather};
use serde::Serialize;

/// By design.
pub(crate) const LIMITS: [&str; 6] = [
    "Ships are rigid hulls in the plane: no heel, no squat, no shallow water or bank effects, no \
     interaction between hulls in close passing; waves push and yaw a ship by random processes of \
     first order and do not make her roll, pitch or heave.",
    "While two hulls are far apart the stored distance between them is a lower bound; the smallest \
     distance of a run is exact.",
    "Targets do what the plan means them to: some meet own ship as the rules ask or fail to, some \
     run a planner, the others do not look at her. Nobody signals or speaks.",
    "The treaty has few numbers. Where the judge needs one, the rule set names it; another rule \
     set may judge the same track otherwise.",
    "Rates are those of the declared encounters. They become rates at sea only with an encounter \
     model that was fitted to traffic, and no better than its fit.",
    "Not in this tool: validation of the ship models against sea trials of the ship in question, \
     which the owner of the models has to add.",
];

/// Something known to be wrong or unproved, and whom it touches.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Defect {
    pub(crate) id: &'static str,
    pub(crate) text: &'static str,
    pub(crate) effect: &'static str,
}

/// Known defects of the bench.
pub(crate) const DEFECTS: [Defect; 6] = [
    Defect {
        id: "D1",
        text: "Exports (GeoJSON, MCAP, DNV) lay an encounter at a place in the North Sea; a \
               traffic situation has no word for vessel models, sensing, intents of targets, \
               wind, waves, or hazards.",
        effect: "An exported situation run in another tool is the same geometry and not the same \
                 run.",
    },
    Defect {
        id: "D2",
        text: "The two judges of a run are written apart and still disagree on some; the report \
               counts the disagreements of this campaign and names them.",
        effect: "A verdict on which they disagree is no better known than the specification is \
                 clear there.",
    },
    Defect {
        id: "D3",
        text: "The signature covers what was written, not when: no time stamp of a third party is \
               in the pack.",
        effect: "That the plan was fixed before the run is shown by its hash in every part of the \
                 result, and rests on the word of who signed for the date.",
    },
    Defect {
        id: "D4",
        text: "What a planner from outside takes from its machine (interpreter, packages, data \
               files that its command does not name) is not in the pack.",
        effect: "Running it again can fail, or differ, on a machine that has other ones.",
    },
    Defect {
        id: "D5",
        text: "How an encounter ends can hang on the step of integration where a planner's orders \
               jump from beat to beat; bench/convergence.md has how often, for planners of the \
               registry.",
        effect: "One verdict of such a planner is one of several possible ones.",
    },
    Defect {
        id: "D6",
        text: "There are small wrong changes to the judges and the statistics that their tests do \
               not notice; bench/mutants.md has those that were found, and how much was looked \
               through.",
        effect: "A mistake of that size could be in them unseen; the second judge and the gate's \
                 self-test are the nets behind.",
    },
];

/// Something that the argument takes for granted, and what would show at sea that it is false.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Assumption {
    pub(crate) id: String,
    pub(crate) text: String,
    pub(crate) monitor: &'static str,
}

/// The assumptions of a plan; those that depend on it say what it says.
pub(crate) fn assumptions(plan: &Plan) -> Result<Vec<Assumption>, EvidenceError> {
    let first = first_of_each(plan)?;
    let list: Vec<(String, &'static str)> = vec![
        (
            "Own ship turns, accelerates and stops as her model does.".to_owned(),
            "Order and answer logged on board: turning rate and stopping distance outside the \
             spread that the model was accepted with.",
        ),
        (
            format!(
                "The planner on board is the planner {} with the options of the plan, asked every \
                 {} s.",
                plan.planner.name, plan.run.beat_s
            ),
            "Hash of program and options, and the time between orders, logged at every start and \
             in service.",
        ),
        (
            sensing(&first),
            "Track errors and detection ranges logged against AIS and radar recordings.",
        ),
        (
            format!("Own ship meets the encounters of campaign {}, in its shares.", plan.campaign),
            "Counts of encounters by class, speed ratio and number of ships over a season, against \
             the shares of the plan.",
        ),
        (
            format!("Rule set {} says what good seamanship is here.", plan.rules.name),
            "Every alteration that a master overrides, and every complaint of another ship, \
             judged again under the rule set.",
        ),
        (
            weather(&first),
            "Wind, sea state, current and visibility logged in every encounter, against those of \
             the plan.",
        ),
    ];
    let numbered = |(i, (text, monitor))| Assumption { id: format!("A{}", i + 1), text, monitor };
    Ok(list.into_iter().enumerate().map(numbered).collect())
}

fn sensing(first: &[Encounter]) -> String {
    if first.iter().all(|e| matches!(e.sensing, Sensing::Perfect { .. })) {
        "Own ship knows every other ship within her detection range at once and without error."
            .to_owned()
    } else {
        "Own ship's tracks are as late and as wrong as the sensors of the plan make them."
            .to_owned()
    }
}

fn weather(first: &[Encounter]) -> String {
    if first.iter().all(|e| e.weather == Weather::default()) {
        "The sea is calm: no wind, no waves, no current.".to_owned()
    } else {
        "Wind, waves and current lie within those of the plan.".to_owned()
    }
}

/// The first encounter of each stratum: what all of them have in common.
fn first_of_each(plan: &Plan) -> Result<Vec<Encounter>, EvidenceError> {
    let source = plan.encounters_source()?;
    let first = |stratum| Ok(source.draw(stratum, 0)?.encounter);
    (0..plan.strata.len() as u32).map(first).collect()
}
