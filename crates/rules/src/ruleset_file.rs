//! Reading a rule-set file: syntax, then contradictions, each refused with its reason.
//!
//! The file's text is what a hash is taken of; a sweep makes a new text. Reference: rules
//! specification, section 3.

use crate::ruleset::RuleSet;
use geom::HeadOnSector;
use geom::units::deg;

/// The version of the file format.
const SCHEMA: u32 = 1;

/// Why a rule set was refused.
#[derive(Debug, thiserror::Error)]
pub enum RuleSetError {
    /// Not TOML, a wrong type, a missing or an unknown key; names the line and the allowed keys.
    #[error("read the rule set: {0}")]
    Syntax(String),
    /// The file has a format that this program does not know.
    #[error("read the rule set {name}: schema = {found}, and this program reads schema = {SCHEMA}")]
    Schema {
        /// Name of the rule set.
        name: String,
        /// What the file says.
        found: u32,
    },
    /// Two of its numbers exclude one another.
    #[error("accept the rule set {name}: {reason}")]
    Contradiction {
        /// Name of the rule set.
        name: String,
        /// Which numbers, and what would be right.
        reason: String,
    },
    /// A key to be changed does not exist.
    #[error("set {key} in the rule set {name}: no such key; the keys are {allowed}")]
    UnknownKey {
        /// Name of the rule set.
        name: String,
        /// What was asked for.
        key: String,
        /// What exists, comma separated.
        allowed: String,
    },
}

impl RuleSet {
    /// Reads and checks a rule set from the text of its file.
    pub fn parse(text: &str) -> Result<Self, RuleSetError> {
        let mut set: Self =
            toml::from_str(text).map_err(|error| RuleSetError::Syntax(error.to_string()))?;
        set.text = text.to_owned();
        if set.schema != SCHEMA {
            return Err(RuleSetError::Schema { name: set.name, found: set.schema });
        }
        match set.contradiction(text) {
            None => Ok(set),
            Some(reason) => Err(RuleSetError::Contradiction { name: set.name, reason }),
        }
    }

    /// The text that defines this rule set: what a hash is taken of.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The same rule set with one number changed, for a sweep. The key is that of the file, such
    /// as `head_on_half_angle_deg`; the name gains `+key=value`.
    pub fn with(&self, key: &str, value: f64) -> Result<Self, RuleSetError> {
        let syntax = |error: String| RuleSetError::Syntax(error);
        let mut table: toml::Table =
            toml::from_str(&self.text).map_err(|e| syntax(e.to_string()))?;
        let mut allowed = Vec::new();
        let mut found = false;
        for (_, section) in table.iter_mut() {
            let Some(section) = section.as_table_mut() else { continue };
            for (name, old) in section.iter_mut() {
                let new = match old {
                    toml::Value::Float(_) => toml::Value::Float(value),
                    toml::Value::Integer(_) if value.fract().abs() > 0.0 => {
                        toml::Value::Float(value)
                    }
                    toml::Value::Integer(_) => toml::Value::Integer(value as i64),
                    _ => continue,
                };
                if name == key {
                    *old = new;
                    found = true;
                }
                allowed.push(name.clone());
            }
        }
        if !found && key == "react_fail_s" {
            let timing = table.get_mut("timing").and_then(toml::Value::as_table_mut);
            let timing = timing.expect("a parsed rule set has its section timing");
            timing.insert(key.to_owned(), toml::Value::Float(value));
            found = true;
        }
        if !found {
            // it may be absent from the table, having no default
            if !allowed.iter().any(|name| name == "react_fail_s") {
                allowed.push("react_fail_s".to_owned());
            }
            let (name, key) = (self.name.clone(), key.to_owned());
            return Err(RuleSetError::UnknownKey { name, key, allowed: allowed.join(", ") });
        }
        let name = format!("{}+{key}={value}", self.name);
        table.insert("name".to_owned(), toml::Value::String(name));
        Self::parse(&toml::to_string(&table).map_err(|e| syntax(e.to_string()))?)
    }

    /// Whether ships of these lengths (metres) can be judged by distances between reference
    /// points: not when the collision distance is inside the hulls (section 0).
    pub fn admits_centre_distance(
        &self,
        own_length_m: f64,
        target_length_m: f64,
    ) -> Result<(), RuleSetError> {
        let half_lengths_m = (own_length_m + target_length_m) / 2.0;
        if self.distance.r_col_m >= half_lengths_m {
            return Ok(());
        }
        let reason = format!(
            "r_col_m = {} lies inside the hulls of ships of {own_length_m} m and \
             {target_length_m} m; measured between reference points it must be at least \
             {half_lengths_m}, or the campaign measures from hull to hull",
            self.distance.r_col_m
        );
        Err(RuleSetError::Contradiction { name: self.name.clone(), reason })
    }

    /// The head-on sector of this rule set.
    pub fn head_on(&self) -> HeadOnSector {
        let half_angle_rad = self.classification.head_on_half_angle_rad;
        let reciprocal_rad = half_angle_rad * self.classification.head_on_reciprocal_factor;
        HeadOnSector { half_angle_rad, reciprocal_rad }
    }

    /// Name of the rule set that section 3 means for an own ship of this length in metres.
    pub const fn name_by_length(own_length_m: f64) -> &'static str {
        if own_length_m <= 3.0 {
            "micro-v1"
        } else if own_length_m <= 30.0 {
            "usv-oe2023-v1"
        } else {
            "merchant-ntnu-ais-v1"
        }
    }

    fn contradiction(&self, text: &str) -> Option<String> {
        if self.name.is_empty() {
            return Some("name is empty".to_owned());
        }
        let table: toml::Table = toml::from_str(text).ok()?;
        for (section, value) in &table {
            for (key, value) in value.as_table().into_iter().flatten() {
                let number = value.as_float().or(value.as_integer().map(|i| i as f64));
                if number.is_some_and(|x| !(x.is_finite() && x > 0.0)) {
                    return Some(format!("{section}.{key} = {value} must be finite and above 0"));
                }
            }
        }
        let (s, d, m, t) = (&self.stages, &self.distance, &self.manoeuvre, &self.timing);
        let react_fail_s = t.react_fail_s.unwrap_or(f64::INFINITY);
        let rising: [(&str, &[f64]); 8] = [
            (
                "r_col_m < r_nm_m < r_min_m < r_pref_m",
                &[d.r_col_m, d.r_nm_m, d.r_min_m, d.r_pref_m],
            ),
            ("r4_m < r3_m < r2_m", &[s.r4_m, s.r3_m, s.r2_m]),
            ("t4_s < t3_s < t2_s", &[s.t4_s, s.t3_s, s.t2_s]),
            (
                "detectable_turn_deg < substantial_turn_deg < apparent_turn_deg",
                &[m.detectable_turn_rad, m.substantial_turn_rad, m.apparent_turn_rad],
            ),
            (
                "detectable < substantial < apparent_speed_fraction < 1",
                &[
                    m.detectable_speed_fraction,
                    m.substantial_speed_fraction,
                    m.apparent_speed_fraction,
                    1.0,
                ],
            ),
            ("react_warn_s < react_fail_s", &[t.react_warn_s, react_fail_s]),
            ("late_onset_pass_s < late_onset_fail_s", &[t.late_onset_pass_s, t.late_onset_fail_s]),
            (
                "dribble_warn_runs < dribble_fail_runs",
                &[f64::from(m.dribble_warn_runs), f64::from(m.dribble_fail_runs)],
            ),
        ];
        for (order, values) in rising {
            if !values.windows(2).all(|pair| pair[0] < pair[1]) {
                return Some(format!("it must hold that {order}"));
            }
        }
        if self.risk.d_risk_m < d.r_min_m {
            return Some(format!(
                "d_risk_m = {} is below r_min_m = {}: a pass that fails would never be a risk",
                self.risk.d_risk_m, d.r_min_m
            ));
        }
        if self.risk.close_factor < 1.0 {
            return Some("close_factor must be at least 1, or risk closes as it opens".to_owned());
        }
        let sector = self.head_on();
        if sector.half_angle_rad >= deg(90.0) || sector.reciprocal_rad > 2.0 * sector.half_angle_rad
        {
            let limits = "head_on_half_angle_deg < 90 and head_on_reciprocal_factor <= 2";
            return Some(format!("it must hold that {limits}"));
        }
        None
    }
}
