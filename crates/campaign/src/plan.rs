//! The plan: a campaign resolved for one planner, with nothing left open. Its hash is the identity
//! of a result, and its JSON stands in the manifest.

use crate::Error;
use crate::spec::{CampaignFile, Overrides, RunTable};
use encounter::{Drawn, Generator, Model};
use record::{Encounter, EncounterId, Seed};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// What a binary knows of its own making.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Build {
    /// Version of the tool.
    pub tool_version: String,
    /// Commit of the sources, `unknown` outside a repository.
    pub git_commit: String,
    /// Whether the sources were as committed.
    pub git_clean: bool,
    /// Hash of the sources that decide a number: geom, record, planner-api, encounter, sim,
    /// rules, stats, Cargo.lock and rustc.
    pub engine: String,
    /// Hash of the sources of the planners in the registry.
    pub planners: String,
    /// SHA-256 of Cargo.lock.
    pub cargo_lock_sha256: String,
    /// `rustc --version`.
    pub rustc: String,
}

/// The planner under test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannerChoice {
    /// Name in the registry.
    pub name: String,
    /// Every option with its value.
    pub options: toml::Table,
    /// SHA-256 of each file of a planner from outside, by the path that its name gives. A change of
    /// one is another planner.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files_sha256: BTreeMap<String, String>,
}

/// The rule set that judges.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RulesChoice {
    /// Its name.
    pub name: String,
    /// BLAKE3 of its text.
    pub hash: String,
    /// Its text; empty where each encounter has the profile of its own ship's length.
    pub text: String,
    /// The profiles by own ship's length, by name, where that was asked for.
    pub by_own_length: BTreeMap<String, String>,
}

/// The name that asks for the profile of each own ship's length.
const BY_OWN_LENGTH: &str = "by-own-length";

impl RulesChoice {
    /// The rule set of this name, or the profiles that the own ships of a source need.
    pub(crate) fn find(
        name: &str,
        source: &Source,
        find_rules: crate::spec::FindRules<'_>,
    ) -> Result<Self, Error> {
        if name != BY_OWN_LENGTH {
            return Self::new(name, find_rules(name)?);
        }
        let Source::Fixed(encounters) = source else {
            return Err(Error::input(format!(
                "rules = \"{BY_OWN_LENGTH}\" is for situations; name a rule set for a model"
            )));
        };
        let mut by_own_length = BTreeMap::new();
        let mut hasher = blake3::Hasher::new();
        for encounter in encounters {
            let profile = rules::RuleSet::name_by_length(encounter.own.hull.length_m);
            if !by_own_length.contains_key(profile) {
                by_own_length.insert(profile.to_owned(), find_rules(profile)?);
            }
        }
        by_own_length.values().for_each(|text| {
            hasher.update(text.as_bytes());
        });
        let hash = hasher.finalize().to_hex().to_string();
        Ok(Self { name: name.to_owned(), hash, text: String::new(), by_own_length })
    }

    /// A rule set from its text; refuses one that contradicts itself.
    pub fn new(name: &str, text: String) -> Result<Self, Error> {
        rules::RuleSet::parse(&text).map_err(|e| Error::input(format!("rule set {name}: {e}")))?;
        let hash = Self::hash_of(&text);
        Ok(Self { name: name.to_owned(), hash, text, by_own_length: BTreeMap::new() })
    }

    /// BLAKE3 of a rule set's text, hexadecimal.
    pub fn hash_of(text: &str) -> String {
        blake3::hash(text.as_bytes()).to_hex().to_string()
    }

    /// The parsed rule sets: by name, or one under the empty name for every encounter.
    pub fn rule_sets(&self) -> Result<BTreeMap<String, rules::RuleSet>, Error> {
        let parse = |name: &str, text: &str| {
            rules::RuleSet::parse(text).map_err(|e| Error::input(format!("rule set {name}: {e}")))
        };
        if self.by_own_length.is_empty() {
            return Ok(BTreeMap::from([(String::new(), parse(&self.name, &self.text)?)]));
        }
        let sets = self.by_own_length.iter();
        sets.map(|(name, text)| Ok((name.clone(), parse(name, text)?))).collect()
    }

    /// The one rule set.
    ///
    /// # Errors
    /// There are several, by own ship's length.
    pub fn rule_set(&self) -> Result<rules::RuleSet, Error> {
        self.rule_sets()?.remove("").ok_or_else(|| {
            Error::input(format!("{} is several rule sets; name one with --rules", self.name))
        })
    }

    /// The key into [`Self::rule_sets`] for an own ship of this length, metres.
    pub fn key(&self, own_length_m: f64) -> &str {
        if self.by_own_length.is_empty() {
            ""
        } else {
            rules::RuleSet::name_by_length(own_length_m)
        }
    }
}

/// Where encounters come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Random strata.
    Model(Box<Model>),
    /// Named encounters, one stratum each.
    Fixed(Vec<Encounter>),
}

impl Source {
    pub(crate) fn of(file: &CampaignFile, situations: Option<&Path>) -> Result<Self, Error> {
        let settings = encounter::RunSettings {
            limits: file.run.limits(),
            safety_radius_m: file.run.safety_radius_m,
            distance: file.run.distance,
        };
        let origin = &file.origin.name;
        let wrong = |e: encounter::Error| Error::input(format!("campaign {origin}: {e}"));
        if let Some(path) = situations {
            let Some(how) = &file.situations else {
                return Err(Error::input(format!(
                    "campaign {origin} has no [situations] table, which says how --situations are \
                     taken over; use the campaign `situations`"
                )));
            };
            let fixed = encounter::read_situations(path, how, &settings).map_err(wrong)?;
            return Ok(Self::Fixed(fixed));
        }
        if file.situations.is_some() {
            return Err(Error::input(format!(
                "campaign {origin} runs situations of other tools: name them with --situations PATH"
            )));
        }
        match (&file.model, &file.set) {
            (Some(model), _) => {
                Generator::new(model, &settings).map_err(wrong)?;
                Ok(Self::Model(Box::new(model.clone())))
            }
            (None, Some(set)) => Ok(Self::Fixed(
                encounter::situations(set, &file.situation, &settings).map_err(wrong)?,
            )),
            (None, None) => Err(Error::input(format!("campaign {origin} has no source"))),
        }
    }
}

/// Most encounters of a campaign: a run keeps a list of its parts in memory, which is some 300 MB
/// for so many.
const ENCOUNTERS_MAX: u64 = 10_000_000_000;

/// A campaign resolved for one planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// 1.
    pub schema: u32,
    /// Name of the campaign.
    pub campaign: String,
    /// One line for reports.
    pub title: String,
    /// Seed of every random stream.
    pub seed: Seed,
    /// The planner under test.
    pub planner: PlannerChoice,
    /// The rule set that judges.
    pub rules: RulesChoice,
    /// Names of the strata, in order.
    pub strata: Vec<String>,
    /// Encounters of each.
    pub encounters_per_stratum: u64,
    /// Clock, ends and limits.
    pub run: RunTable,
    /// Where encounters come from.
    pub source: Source,
    /// What made the result.
    pub build: Build,
}

impl Plan {
    pub(crate) fn new(
        file: &CampaignFile,
        overrides: &Overrides,
        planner: &str,
        options: toml::Table,
        rules: &RulesChoice,
        source: &Source,
        build: &Build,
    ) -> Result<Self, Error> {
        let strata: Vec<String> = match source {
            Source::Model(model) => model.strata_names(),
            Source::Fixed(fixed) => fixed.iter().map(|e| e.id.stratum.to_string()).collect(),
        };
        let plan = Self {
            schema: 1,
            campaign: file.name.clone(),
            title: file.title.clone(),
            seed: Seed(overrides.seed.unwrap_or(file.seed)),
            planner: PlannerChoice {
                name: planner.to_owned(),
                options,
                files_sha256: BTreeMap::new(),
            },
            rules: rules.clone(),
            strata,
            encounters_per_stratum: overrides.encounters.unwrap_or(file.encounters_per_stratum),
            run: file.run,
            source: source.clone(),
            build: build.clone(),
        };
        let wrong = |what: String| Error::input(format!("campaign {}: {what}", file.origin.name));
        plan.check_size().map_err(wrong)?;
        plan.check_first_of_each().map_err(|e| wrong(e.to_string()))?;
        Ok(plan)
    }

    fn check_size(&self) -> Result<(), String> {
        let (strata, n) = (self.strata.len() as u64, self.encounters_per_stratum);
        let most = ENCOUNTERS_MAX / strata.max(1);
        if n <= most {
            return Ok(());
        }
        Err(format!(
            "{n} encounters of each of {strata} strata are more than the {ENCOUNTERS_MAX} that one \
             campaign can hold; ask for at most {most} of each"
        ))
    }

    /// What can be wrong with an encounter (an unknown vessel, hulls that overlap) is told before
    /// anything is written.
    fn check_first_of_each(&self) -> Result<(), Error> {
        let source = self.encounters_source()?;
        for stratum in 0..self.strata.len() as u32 {
            let encounter = source.draw(stratum, 0)?.encounter;
            sim::check(&encounter).map_err(|e| Error::input(format!("{}: {e}", encounter.id)))?;
        }
        Ok(())
    }

    /// The plan as JSON, the form that is hashed and stored.
    pub fn json(&self) -> Result<serde_json::Value, Error> {
        serde_json::to_value(self)
            .map_err(|e| Error::Fault(format!("failed to write the plan as JSON: {e}")))
    }

    /// BLAKE3 of the plan's JSON, less the commit: two commits with the same engine and planners
    /// give the same numbers.
    pub fn hash(&self) -> Result<String, Error> {
        let mut json = self.json()?;
        if let Some(build) = json.get_mut("build").and_then(|b| b.as_object_mut()) {
            build.remove("git_commit");
            build.remove("git_clean");
        }
        Ok(blake3::hash(json.to_string().as_bytes()).to_hex().to_string())
    }

    /// Number of encounters.
    pub fn encounters(&self) -> u64 {
        self.strata.len() as u64 * self.encounters_per_stratum
    }

    /// Whether encounters are drawn with weights: then counts of them are no rates.
    pub fn is_weighted(&self) -> bool {
        matches!(&self.source, Source::Model(model) if model.encounter_rate.is_some())
    }

    /// Refuses a use that counts every encounter once.
    ///
    /// # Errors
    /// Encounters are drawn with weights; `what` would count each of them once.
    pub fn refuse_weights(&self, what: &str) -> Result<(), Error> {
        if !self.is_weighted() {
            return Ok(());
        }
        Err(Error::input(format!(
            "campaign {}: model.encounter_rate draws encounters with weights, and {what} would \
             count each of them once; take the table out, or read the weighted rates in \
             summary.json",
            self.campaign
        )))
    }

    /// What the campaign allows but shows less than it seems to; sentences.
    pub fn warnings(&self) -> Vec<String> {
        match &self.source {
            Source::Model(model) => model.warnings(&self.settings()),
            Source::Fixed(_) => Vec::new(),
        }
    }

    fn settings(&self) -> encounter::RunSettings {
        encounter::RunSettings {
            limits: self.run.limits(),
            safety_radius_m: self.run.safety_radius_m,
            distance: self.run.distance,
        }
    }

    /// The largest weight that an encounter of each stratum can have, by its name; empty where
    /// every encounter counts once.
    ///
    /// # Errors
    /// The model is not one.
    pub fn weight_max(&self) -> Result<BTreeMap<String, f64>, Error> {
        let EncounterSource::Random(generator, _) = self.encounters_source()? else {
            return Ok(BTreeMap::new());
        };
        if !self.is_weighted() {
            return Ok(BTreeMap::new());
        }
        let largest = |(i, name): (usize, &String)| (name.clone(), generator.weight_max(i));
        Ok(self.strata.iter().enumerate().map(largest).collect())
    }

    /// The id of encounter `j` of a stratum.
    pub fn id(&self, stratum: u32, j: u64) -> EncounterId {
        EncounterId::new(self.strata[stratum as usize].as_str(), j)
    }

    /// The index of an id's stratum, if the id is one of this plan's.
    pub fn stratum_of(&self, id: &EncounterId) -> Option<u32> {
        let index = self.strata.iter().position(|name| **name == *id.stratum)?;
        (id.j < self.encounters_per_stratum).then_some(index as u32)
    }

    /// A way to draw this plan's encounters.
    pub fn encounters_source(&self) -> Result<EncounterSource, Error> {
        let settings = self.settings();
        Ok(match &self.source {
            Source::Model(model) => EncounterSource::Random(
                Box::new(
                    Generator::new(model, &settings).map_err(|e| Error::input(e.to_string()))?,
                ),
                self.seed,
            ),
            Source::Fixed(fixed) => EncounterSource::Fixed(fixed.clone(), self.seed),
        })
    }
}

/// Draws encounters.
#[derive(Debug)]
pub enum EncounterSource {
    /// From random strata.
    Random(Box<Generator>, Seed),
    /// From a list; encounter `j` of a stratum has the same geometry and its own noise.
    Fixed(Vec<Encounter>, Seed),
}

impl EncounterSource {
    /// Encounter `j` of a stratum, and how many draws were rejected on the way.
    pub fn draw(&self, stratum: u32, j: u64) -> Result<Drawn, Error> {
        match self {
            Self::Random(generator, seed) => {
                generator.draw(*seed, stratum as usize, j).map_err(|e| Error::input(e.to_string()))
            }
            Self::Fixed(list, seed) => {
                let mut encounter = list[stratum as usize].clone();
                encounter.seed = *seed;
                encounter.id.j = j;
                Ok(Drawn { encounter, rejected: 0 })
            }
        }
    }
}
