//! The tallies of a campaign, one for each stratum.

use crate::Tally;
use record::RunRow;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One tally for each stratum, by name.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tallies(BTreeMap<String, Tally>);

impl Tallies {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one run to its stratum.
    pub fn add(&mut self, row: &RunRow) {
        self.stratum_mut(&row.id.stratum).add(row);
    }

    /// Adds the runs of another part.
    pub fn merge(&mut self, other: &Self) {
        for (name, tally) in &other.0 {
            self.stratum_mut(name).merge(tally);
        }
    }

    /// The tally of a stratum, made when it is not there.
    pub fn stratum_mut(&mut self, name: &str) -> &mut Tally {
        if !self.0.contains_key(name) {
            self.0.insert(name.to_owned(), Tally::new());
        }
        self.0.get_mut(name).expect("it was just put there")
    }

    /// The tally of a stratum.
    pub fn stratum(&self, name: &str) -> Option<&Tally> {
        self.0.get(name)
    }

    /// Strata in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Tally)> {
        self.0.iter().map(|(name, tally)| (name.as_str(), tally))
    }

    /// All strata together: the mix of the campaign, which is not the mix of any sea.
    pub fn total(&self) -> Tally {
        let mut total = Tally::new();
        self.0.values().for_each(|tally| total.merge(tally));
        total
    }
}
