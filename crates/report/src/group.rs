//! Which groups of runs the figures show.

use crate::input::ReportInput;
use crate::weighted;
use summary::{StratumSummary, Tally};

/// More groups than this do not fit a figure; the tables have them all.
const GROUPS_MAX: usize = 12;

/// Runs that are drawn together.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub(crate) name: String,
    pub(crate) tally: Tally,
    pub(crate) summary: StratumSummary,
}

impl Group {
    pub(crate) fn new(name: &str, tally: Tally) -> Self {
        Self { name: name.to_owned(), summary: StratumSummary::new(name, &tally), tally }
    }
}

/// The strata in the order of the campaign, or all runs together if there are too many of them.
pub(crate) fn groups(input: &ReportInput) -> Vec<Group> {
    let strata: Vec<&str> = input
        .summary
        .strata
        .iter()
        .filter(|stratum| stratum.n > 0)
        .map(|stratum| stratum.name.as_str())
        .collect();
    if strata.len() > GROUPS_MAX {
        return vec![all(input)];
    }
    strata
        .into_iter()
        .filter_map(|name| Some(Group::new(name, input.tallies.stratum(name)?.clone())))
        .collect()
}

/// All runs together, in the mix of the campaign.
pub(crate) fn all(input: &ReportInput) -> Group {
    let mut group = Group::new("all strata", input.tallies.total());
    let weighted = input.summary.strata.iter().filter_map(|stratum| stratum.weighted.as_ref());
    if let Some(weight_max) = weighted.map(|one| one.weight_max).reduce(f64::max) {
        group.summary = match &input.summary.strata[..] {
            [one] => StratumSummary { name: group.name.clone(), ..one.clone() },
            _ => group.summary.with_weights(&group.tally, weight_max),
        };
        group.summary = weighted::shown(group.summary);
    }
    group
}
