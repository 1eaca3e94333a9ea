//! The findings as a reader sees them: what, in which class, how often, and the worst.

use crate::group::Group;
use crate::input::{Found, ReportInput};
use crate::number::{count, per_cent};
use crate::weighted::part_bounds;
use geom::EncounterClass;
use record::Status;
use serde::Serialize;
use summary::{BoundedRate, Event};

/// One line of the table of findings.
#[derive(Serialize)]
pub(crate) struct FindingLine {
    grave: bool,
    event: String,
    class: String,
    planner: String,
    count: String,
    of: String,
    bounds: String,
    worst: String,
    /// The id as a part of a link.
    worst_link: String,
    /// Whether the player has the worst encounter.
    shown: bool,
    /// Where the player starts: a little before the moment that decided, seconds.
    from_s: String,
    sentence: String,
    replay: String,
}

/// A reader wants to see how it came to that moment, seconds.
const LEAD_S: f64 = 20.0;

pub(crate) fn lines(input: &ReportInput, whole: &Group) -> Vec<FindingLine> {
    input.findings.iter().map(|found| line(input, whole, found)).collect()
}

fn line(input: &ReportInput, group: &Group, found: &Found) -> FindingLine {
    let whole = &group.tally;
    let finding = &found.finding;
    let n = match finding.event {
        // A check is counted where it applied, everything else in all runs of the class.
        Event::Failed(check) => [Status::Pass, Status::Warn, Status::Fail, Status::Inconclusive]
            .map(|status| whole.check_in_class(finding.class, check, status))
            .iter()
            .sum(),
        _ => whole.class(finding.class),
    };
    let rate = BoundedRate::new(finding.count.min(n), 0, n);
    let worst = finding.worst.to_string();
    FindingLine {
        grave: matches!(finding.event, Event::Contact(_) | Event::Unknown(_)),
        event: finding.event.title(),
        class: class_name(finding.class),
        planner: input.card.planner.clone(),
        count: count(finding.count),
        of: format!("of {} ({})", count(n), rate.rate.map_or_else(String::new, per_cent)),
        bounds: part_bounds(&rate, group.summary.weighted.is_some()),
        shown: input.cases.iter().any(|case| case.row.id == finding.worst),
        from_s: format!("{:.0}", (found.t_s.unwrap_or(0.0) - LEAD_S).max(0.0)),
        sentence: found.sentence.clone(),
        replay: input.card.replay_command.replace("{id}", &worst),
        worst_link: link(&worst),
        worst,
    }
}

/// Percent-encoded, so that a stratum's name may hold anything.
fn link(id: &str) -> String {
    let plain = |b: &u8| b.is_ascii_alphanumeric() || b"-_./".contains(b);
    id.bytes().map(|b| if plain(&b) { char::from(b).into() } else { format!("%{b:02X}") }).collect()
}

fn class_name(class: Option<EncounterClass>) -> String {
    class.map_or("risk never opened", EncounterClass::name).replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_survive_any_name_of_a_stratum() {
        assert_eq!(link("head_on/000012"), "head_on/000012");
        assert_eq!(link("HO & é/0"), "HO%20%26%20%C3%A9/0");
    }
}
