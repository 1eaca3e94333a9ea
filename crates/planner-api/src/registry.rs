//! The planners that a campaign can name: an explicit list, no magic.

use crate::Planner;
use std::fmt;

/// A planner's options, as they stand in its own table of a campaign file.
pub type Options = toml::Table;

/// What is wrong with a planner's options, or with its name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OptionsError {
    /// A key that this planner does not have.
    #[error("planner `{planner}` has no option `{key}`; it has {known}")]
    UnknownKey {
        /// The planner.
        planner: String,
        /// The key.
        key: String,
        /// Its options, for the message.
        known: String,
    },
    /// A value it cannot take.
    #[error("planner `{planner}`: {reason}")]
    BadValue {
        /// The planner.
        planner: String,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// No planner of that name.
    #[error("there is no planner `{name}`; there are {known}")]
    UnknownPlanner {
        /// What was asked for.
        name: String,
        /// The registry, for the message.
        known: String,
    },
}

/// Makes a planner from its whole options.
pub type Make = Box<dyn Fn(&Options) -> Result<Box<dyn Planner>, OptionsError> + Send + Sync>;

/// One line of the registry.
pub struct PlannerEntry {
    /// The name on the command line.
    pub name: String,
    /// One sentence.
    pub summary: String,
    /// For a negative control: which verdict must catch it.
    pub caught_by: Option<String>,
    /// Every option with its value, so that a resolved campaign shows them all.
    pub options: Options,
    /// Makes it; called once for each worker.
    pub make: Make,
}

impl fmt::Debug for PlannerEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PlannerEntry").field("name", &self.name).finish_non_exhaustive()
    }
}

impl PlannerEntry {
    /// This planner's options with `changes` laid over them.
    pub fn resolve(&self, changes: &Options) -> Result<Options, OptionsError> {
        let mut options = self.options.clone();
        for (key, value) in changes {
            if !options.contains_key(key) {
                let known: Vec<&str> = self.options.keys().map(String::as_str).collect();
                let known =
                    if known.is_empty() { "no options".to_owned() } else { known.join(", ") };
                return Err(OptionsError::UnknownKey {
                    planner: self.name.clone(),
                    key: key.clone(),
                    known,
                });
            }
            options.insert(key.clone(), value.clone());
        }
        Ok(options)
    }
}

/// The planners that a campaign can name.
#[derive(Debug, Default)]
pub struct Registry(Vec<PlannerEntry>);

impl Registry {
    /// None yet.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Adds one line; a name can be taken once.
    #[must_use]
    pub fn with(mut self, entry: PlannerEntry) -> Self {
        assert!(
            self.0.iter().all(|known| known.name != entry.name),
            "planner `{}` is registered twice",
            entry.name
        );
        self.0.push(entry);
        self
    }

    /// Every planner, in the order of registration.
    pub fn entries(&self) -> &[PlannerEntry] {
        &self.0
    }

    /// The planner of this name.
    pub fn get(&self, name: &str) -> Result<&PlannerEntry, OptionsError> {
        self.0.iter().find(|entry| entry.name == name).ok_or_else(|| {
            let known: Vec<&str> = self.0.iter().map(|entry| entry.name.as_str()).collect();
            OptionsError::UnknownPlanner { name: name.to_owned(), known: known.join(", ") }
        })
    }
}
