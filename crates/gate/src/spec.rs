//! The table `[gate]` of a campaign file: everything that is declared before the run.
//!
//! Nothing here has a default. Levels, margins, looks and the cap are written down first; the rule
//! that uses them is [`stats::Gate`].

use crate::Event;
use campaign::{CampaignFile, Error, Overrides, Plan};
use planner_api::Registry;
use serde::{Deserialize, Serialize};
use stats::{AbsolutePlan, AbsoluteTest, GatePlan, Margin, MetricPlan, RatchetPlan};

/// The table as it is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateTable {
    /// a_F: false FAIL by the comparison, all looks together.
    pub alpha_fail: f64,
    /// a_P: false PASS of a first attempt, all looks together.
    pub alpha_pass: f64,
    /// a_abs: false "violated", all strata and looks together; added to a_F in the budget.
    pub alpha_absolute: f64,
    /// The largest number of pairs.
    pub cap_pairs: u64,
    /// Pairs between looks, rounded up to whole cycles through the strata.
    pub look_every_pairs: u64,
    /// `near` is closer than this many safety radii.
    pub near_factor: f64,
    /// The last release may be worse by this many margins.
    pub release_margin_factor: f64,
    /// The anchor may be worse by this many margins.
    pub anchor_margin_factor: f64,
    /// What is compared.
    pub metric: Vec<MetricTable>,
    /// What the candidate must show by itself.
    #[serde(default)]
    pub absolute: Vec<AbsoluteTable>,
}

/// One metric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MetricTable {
    /// What is counted.
    pub event: Event,
    /// How much worse the candidate may be.
    pub margin: Margin,
    /// Planned share of encounters in which the planners differ.
    pub discordance_plan: f64,
}

/// One absolute requirement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsoluteTable {
    /// What is counted; one of the metrics.
    pub event: Event,
    /// Where.
    pub stratum: String,
    /// The rate that must not be reached.
    pub rate_max: f64,
    /// How it is demonstrated.
    pub test: AbsoluteTest,
}

/// A campaign file that has a gate.
#[derive(Clone, Debug)]
pub struct GateSpec {
    /// The campaign.
    pub file: CampaignFile,
    /// The gate.
    pub table: GateTable,
}

/// A planner and changes of its options.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlannerSpec {
    /// Name in the registry.
    pub name: String,
    /// Laid over the campaign file's own table of this planner.
    pub options: toml::Table,
}

impl GateSpec {
    /// Reads a campaign with a gate from TOML; `origin` names it in messages.
    pub fn parse(text: &str, origin: &str) -> Result<Self, Error> {
        let file = CampaignFile::parse(text, origin)?;
        let Some(table) = file.gate.clone() else {
            return Err(Error::input(format!(
                "campaign {origin} has no table [gate]; levels, margins and the cap are declared \
                 there, see campaigns/gate.toml"
            )));
        };
        let table: GateTable = table.try_into().map_err(|e: toml::de::Error| {
            let words: Vec<String> = e.to_string().lines().map(str::to_owned).collect();
            Error::input(format!("campaign {origin}, [gate]: {}", words.join(" ").trim()))
        })?;
        let spec = Self { file, table };
        spec.check().map_err(|what| Error::input(format!("campaign {origin}, [gate]: {what}")))?;
        Ok(spec)
    }

    fn check(&self) -> Result<(), String> {
        for (key, factor) in [
            ("near_factor", self.table.near_factor),
            ("release_margin_factor", self.table.release_margin_factor),
            ("anchor_margin_factor", self.table.anchor_margin_factor),
        ] {
            if !(factor >= 1.0 && factor.is_finite()) {
                return Err(format!("{key} = {factor} must be 1 or more"));
            }
        }
        for (i, metric) in self.table.metric.iter().enumerate() {
            if self.table.metric[..i].iter().any(|other| other.event == metric.event) {
                return Err(format!("metric `{}` stands twice", metric.event.name()));
            }
        }
        Ok(())
    }

    /// Options that are given for a planner, by the campaign file and then by `planner`; all others
    /// are its defaults, which belong to a build.
    pub fn changes(&self, planner: &PlannerSpec) -> toml::Table {
        let mut options = self.file.planner.get(&planner.name).cloned().unwrap_or_default();
        options.extend(planner.options.clone());
        options
    }

    /// The campaign resolved for one planner, with the seed of the fresh set.
    pub fn plan(
        &self,
        planner: &PlannerSpec,
        seed: u64,
        registry: &Registry,
        find_rules: campaign::spec::FindRules<'_>,
        build: &campaign::plan::Build,
    ) -> Result<Plan, Error> {
        let mut file = self.file.clone();
        file.planner.insert(planner.name.clone(), self.changes(planner));
        // an option table of a planner from outside that this gate does not run is no error
        file.planner.retain(|name, _| registry.get(name).is_ok() || *name == planner.name);
        let strata = file.model.as_ref().map_or(1, |model| model.stratum.len()).max(1) as u64;
        let overrides = Overrides {
            planners: vec![planner.name.clone()],
            rules: None,
            encounters: Some(self.table.cap_pairs.div_ceil(strata).max(1)),
            seed: Some(seed),
        };
        let plans = file.resolve(&overrides, None, registry, find_rules, build)?;
        let plan = plans.into_iter().next();
        let plan = plan.ok_or_else(|| Error::Fault("a planner without a plan".into()))?;
        plan.refuse_weights("the gate's rule")?;
        Ok(plan)
    }

    /// What the rule declares: `strata` in the order in which the ids cycle through them, the
    /// arms of the ratchet with the factor of their margins.
    pub fn gate_plan(
        &self,
        strata: &[String],
        attempt: u32,
        ratchets: &[(String, f64)],
    ) -> Result<GatePlan, Error> {
        let table = &self.table;
        let metrics: Vec<MetricPlan> = table
            .metric
            .iter()
            .map(|metric| MetricPlan {
                name: metric.event.name().to_owned(),
                margin: metric.margin,
                discordance_plan: metric.discordance_plan,
            })
            .collect();
        let absolutes = table.absolute.iter().map(|absolute| self.absolute(absolute, strata));
        Ok(GatePlan {
            alpha_fail: table.alpha_fail,
            alpha_pass: table.alpha_pass,
            alpha_absolute: table.alpha_absolute,
            attempt,
            pattern: (0..strata.len()).collect(),
            look_every: table.look_every_pairs,
            cap: table.cap_pairs,
            absolutes: absolutes.collect::<Result<_, _>>()?,
            ratchets: ratchets
                .iter()
                .map(|(name, factor)| RatchetPlan {
                    name: name.clone(),
                    margins: metrics.iter().map(|m| m.margin.scaled(*factor)).collect(),
                })
                .collect(),
            metrics,
        })
    }

    fn absolute(&self, table: &AbsoluteTable, strata: &[String]) -> Result<AbsolutePlan, Error> {
        let missing = |what: &str| {
            Error::input(format!(
                "[gate]: the absolute requirement on `{}` in `{}` names no {what} of this campaign",
                table.event.name(),
                table.stratum
            ))
        };
        let metric = self.table.metric.iter().position(|m| m.event == table.event);
        let stratum = strata.iter().position(|name| *name == table.stratum);
        Ok(AbsolutePlan {
            name: format!("{} in {}", table.event.name(), table.stratum),
            metric: metric.ok_or_else(|| missing("metric"))?,
            stratum: stratum.ok_or_else(|| missing("stratum"))?,
            rate_max: table.rate_max,
            test: table.test,
        })
    }

    /// What is counted, in the plan's order.
    pub fn events(&self) -> Vec<Event> {
        self.table.metric.iter().map(|metric| metric.event).collect()
    }

    /// The distance below which a run is near, metres.
    pub fn near_m(&self) -> f64 {
        self.table.near_factor * self.file.run.safety_radius_m
    }
}
