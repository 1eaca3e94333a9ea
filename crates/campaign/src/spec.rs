//! The campaign file: one claim, in TOML, with units in the keys and no default for anything that
//! changes a result.

use crate::{Error, Plan, Source};
use planner_api::{OptionsError, Registry};
use record::{DistanceKind, RunLimits, RunUntil};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// A campaign file as it is written.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CampaignFile {
    /// 1.
    pub schema: u32,
    /// Short name; part of the default output folder.
    pub name: String,
    /// One line for reports.
    pub title: String,
    /// Seed of every random stream.
    pub seed: u64,
    /// Planners of the registry, one result for each.
    pub planners: Vec<String>,
    /// Name of a rule set in `campaigns/rulesets/`.
    pub rules: String,
    /// Encounters of each stratum.
    pub encounters_per_stratum: u64,
    /// Clock, ends and limits.
    pub run: RunTable,
    /// Random encounters.
    pub model: Option<encounter::Model>,
    /// What the ships of all named encounters share.
    pub set: Option<encounter::SetSettings>,
    /// Named encounters.
    #[serde(default)]
    pub situation: Vec<encounter::Situation>,
    /// How situations of other tools are taken over (`--situations`).
    pub situations: Option<encounter::SituationSettings>,
    /// Options of planners, by name.
    #[serde(default)]
    pub planner: BTreeMap<String, toml::Table>,
    /// What the gate declares before it runs; the gate reads it, a campaign does not.
    pub gate: Option<toml::Table>,
    /// What messages call the file, and where the options of its planners stand.
    #[serde(skip)]
    pub(crate) origin: Origin,
}

/// Where a campaign was read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Origin {
    /// Path of the file, or the name of one that is built in.
    pub(crate) name: String,
    /// Lines of the options of planners, by planner and key.
    option_lines: BTreeMap<(String, String), usize>,
}

impl Origin {
    fn new(name: &str, text: &str) -> Self {
        let mut option_lines = BTreeMap::new();
        // what can be read as a campaign can be read as a table
        let file = toml::de::DeTable::parse(text).ok();
        let planners = file.as_ref().and_then(|file| file.get_ref().get("planner"));
        for (planner, options) in
            planners.and_then(|p| p.get_ref().as_table()).into_iter().flatten()
        {
            for (key, _) in options.get_ref().as_table().into_iter().flatten() {
                let line = 1 + text[..key.span().start].matches('\n').count();
                option_lines
                    .insert((planner.get_ref().to_string(), key.get_ref().to_string()), line);
            }
        }
        Self { name: name.to_owned(), option_lines }
    }

    /// Says of an error in a planner's options where it stands, so far as is known.
    fn of_options(&self, error: &OptionsError) -> Error {
        let line = match error {
            OptionsError::UnknownKey { planner, key, .. } => {
                self.option_lines.get(&(planner.clone(), key.clone()))
            }
            _ => None,
        };
        let line = line.map_or(String::new(), |line| format!(", line {line}"));
        Error::input(format!("campaign {}{line}: {error}", self.name))
    }
}

/// Clock, ends and limits of every run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunTable {
    /// Step of the integration; divides the beat.
    pub step_s: f64,
    /// The planner is asked once a beat.
    pub beat_s: f64,
    /// Longest simulated time.
    pub duration_s_max: f64,
    /// When a run is over before that.
    pub until: RunUntil,
    /// The one kind of distance of this campaign.
    pub distance: DistanceKind,
    /// Distance that own ship shall keep.
    pub safety_radius_m: f64,
    /// A planner call longer than this, on the wall clock, has hung.
    pub planner_hang_limit_s: f64,
    /// Share of the runs that is run twice and compared bit for bit.
    pub twice_run_share: f64,
    /// Whether the second judge is asked about every run too.
    pub second_judge: bool,
    /// Whether the last safe instants are looked for, and the runs in which nothing could help.
    pub last_minute: bool,
}

impl RunTable {
    /// The clock of every run.
    pub const fn limits(&self) -> RunLimits {
        RunLimits {
            step_s: self.step_s,
            beat_s: self.beat_s,
            duration_s_max: self.duration_s_max,
            until: self.until,
        }
    }

    fn check(&self) -> Result<(), String> {
        let positive = |key: &str, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(format!("run.{key} = {value} must be a positive number"))
            }
        };
        positive("step_s", self.step_s)?;
        positive("beat_s", self.beat_s)?;
        positive("duration_s_max", self.duration_s_max)?;
        positive("safety_radius_m", self.safety_radius_m)?;
        positive("planner_hang_limit_s", self.planner_hang_limit_s)?;
        let steps = self.beat_s / self.step_s;
        if (steps - steps.round()).abs() > 1e-9 || steps < 0.5 {
            return Err(format!(
                "run.step_s = {} must divide run.beat_s = {} into whole steps",
                self.step_s, self.beat_s
            ));
        }
        if self.beat_s > 1.0 {
            return Err(format!(
                "run.beat_s = {} must be at most 1: the judge needs a sample every second",
                self.beat_s
            ));
        }
        if !(0.0..=1.0).contains(&self.twice_run_share) {
            return Err(format!(
                "run.twice_run_share = {} must lie from 0 to 1",
                self.twice_run_share
            ));
        }
        Ok(())
    }
}

/// What the command line lays over the file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Planners instead of the file's.
    pub planners: Vec<String>,
    /// Rule set instead of the file's.
    pub rules: Option<String>,
    /// Encounters of each stratum.
    pub encounters: Option<u64>,
    /// Seed.
    pub seed: Option<u64>,
}

/// A rule set's text, found by name.
pub type FindRules<'a> = &'a dyn Fn(&str) -> Result<String, Error>;

impl CampaignFile {
    /// Reads a campaign from TOML; `origin` names it in messages.
    pub fn parse(text: &str, origin: &str) -> Result<Self, Error> {
        let mut file: Self = toml::from_str(text).map_err(|e| {
            Error::input(format!("campaign {origin}: {}", e.to_string().trim_end()))
        })?;
        if file.schema != 1 {
            return Err(Error::input(format!(
                "campaign {origin}: schema = {} is not known; this tool reads schema = 1",
                file.schema
            )));
        }
        file.check().map_err(|what| Error::input(format!("campaign {origin}: {what}")))?;
        file.origin = Origin::new(origin, text);
        Ok(file)
    }

    fn check(&self) -> Result<(), String> {
        if self.name.is_empty() || !self.name.chars().all(is_name_char) {
            return Err(format!(
                "name = {:?} must be made of letters, digits, `-` and `_`",
                self.name
            ));
        }
        if self.planners.is_empty() {
            return Err("planners = [] names nobody; name at least one planner".to_owned());
        }
        self.run.check()?;
        let sources = usize::from(self.model.is_some())
            + usize::from(!self.situation.is_empty())
            + usize::from(self.situations.is_some());
        if self.set.is_some() == self.situation.is_empty() {
            return Err("[set] and [[situation]] go together: [set] says what the ships are".into());
        }
        if sources != 1 {
            return Err("exactly one of [model], [[situation]] and [situations] says where \
                        encounters come from"
                .to_owned());
        }
        Ok(())
    }

    /// One plan for each planner, with nothing left open.
    pub fn resolve(
        &self,
        overrides: &Overrides,
        situations: Option<&Path>,
        registry: &Registry,
        find_rules: FindRules<'_>,
        build: &crate::plan::Build,
    ) -> Result<Vec<Plan>, Error> {
        let names =
            if overrides.planners.is_empty() { &self.planners } else { &overrides.planners };
        for (i, name) in names.iter().enumerate() {
            if names[..i].contains(name) {
                return Err(Error::input(format!("planner `{name}` is named twice")));
            }
        }
        for name in self.planner.keys() {
            let wrong = |e| format!("campaign {}: [planner.{name}]: {e}", self.origin.name);
            registry.get(name).map_err(|e| Error::input(wrong(e)))?;
        }
        let encounters_per_stratum = overrides.encounters.unwrap_or(self.encounters_per_stratum);
        if encounters_per_stratum == 0 {
            return Err(Error::input(
                "encounters_per_stratum = 0 runs nothing; ask for at least 1",
            ));
        }
        let source = Source::of(self, situations)?;
        let rules_name = overrides.rules.as_ref().unwrap_or(&self.rules);
        let rules = crate::plan::RulesChoice::find(rules_name, &source, find_rules)?;
        let none = toml::Table::new();
        names
            .iter()
            .map(|name| {
                let entry = registry.get(name).map_err(|e| Error::input(e.to_string()))?;
                let options = entry
                    .resolve(self.planner.get(name).unwrap_or(&none))
                    .map_err(|e| self.origin.of_options(&e))?;
                // a wrong value is told now, not by the first worker that makes the planner
                (entry.make)(&options).map_err(|e| self.origin.of_options(&e))?;
                Plan::new(self, overrides, name, options, &rules, &source, build)
            })
            .collect()
    }
}

const fn is_name_char(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '-' | '_')
}
