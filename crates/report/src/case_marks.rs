//! The moments of an encounter that a reader must find in its pictures.

use crate::number::fixed;
use record::{ContactWith, Judgement, Status, Trace};
use std::collections::BTreeSet;

/// A moment with its letter and what happened.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    pub(crate) letter: char,
    pub(crate) time_s: f64,
    pub(crate) text: String,
    pub(crate) bad: bool,
}

/// Letters do not go on for ever, and neither does a reader.
const MARKS_MAX: usize = 12;

/// Onsets, reactions, failures and warnings, the closest point and the contact, in order of time.
pub(crate) fn marks(trace: &Trace, judgement: &Judgement) -> Vec<Mark> {
    let several = trace.targets.len() > 1;
    let with =
        |target: u8| if several { format!(" (target {})", target + 1) } else { String::new() };
    let mut found: Vec<(f64, String, bool)> = Vec::new();
    for facts in &judgement.pairs {
        if let Some(time_s) = facts.risk_s {
            let class = facts.class.map_or("no class", |class| class.name()).replace('_', " ");
            let text = format!("risk opens: {class}{}", with(facts.target));
            found.push((time_s, text, false));
            if let record::Reaction::After(delay_s) = facts.reaction {
                let text = format!("first detectable alteration{}", with(facts.target));
                found.push((time_s + delay_s, text, false));
            }
        }
    }
    for (target, pair) in trace.pairs.iter().enumerate() {
        let (distance_m, time_s) = pair.minimum.of(trace.distance);
        let text = format!("closest point: {} m{}", fixed(Some(distance_m), 1), with(target as u8));
        found.push((time_s, text, distance_m < trace.safety_radius_m));
    }
    for verdict in &judgement.verdicts {
        if !matches!(verdict.status, Status::Fail | Status::Warn) {
            continue;
        }
        let Some(time_s) = verdict.t_s else { continue };
        let text = verdict.sentence.clone().unwrap_or_else(|| {
            format!("{}: {} {}", verdict.check.title(), verdict.status.name(), verdict.detail)
        });
        let text = text + &verdict.target.map(with).unwrap_or_default();
        found.push((time_s, text, verdict.status == Status::Fail));
    }
    if let Some(contact) = &trace.contact {
        let what = match contact.with {
            ContactWith::Target(index) => format!("target {}", index + 1),
            ContactWith::Hazard(index) => format!("hazard {}", index + 1),
        };
        let text = format!("contact with {what} at {} m/s", fixed(Some(contact.impact_mps), 1));
        found.push((contact.t_s, text, true));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Two checks can say the same of one act, each at its own moment: the first of them stays.
    let bad: BTreeSet<String> =
        found.iter().filter(|mark| mark.2).map(|mark| mark.1.clone()).collect();
    let mut said = BTreeSet::new();
    found.retain(|mark| said.insert(mark.1.clone()));
    for mark in &mut found {
        mark.2 = bad.contains(&mark.1);
    }
    // Where there are too many, what went wrong stays.
    while found.len() > MARKS_MAX {
        let spare = found.iter().rposition(|mark| !mark.2).unwrap_or(found.len() - 1);
        found.remove(spare);
    }
    let letters = 'a'..='z';
    let mark = |(letter, (time_s, text, bad))| Mark { letter, time_s, text, bad };
    letters.zip(found).map(mark).collect()
}
