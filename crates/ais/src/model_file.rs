//! A campaign with the fitted laws.
//!
//! It is a template with its laws replaced, so that it says everything a campaign must; what is not
//! in the file stays as the template has it and is marked. Its one stratum is the traffic: what the
//! laws give, with no class asked for, so that a rate over it is one over the encounters of the
//! file. Encounters that were met are as frequent as they are, closing speeds included; they need
//! no weight for that.

use crate::document::{ABSENT, Law, Model, PAIRS_MIN, TOO_FEW, thinned};
use crate::meetings::BEFORE_S;
use encounter::Distribution;
use std::fmt::Write as _;

/// Where the laws come from.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name of the file.
    pub name: String,
    /// BLAKE3 of its bytes, hexadecimal.
    pub blake3: String,
    /// The program and its version.
    pub tool: String,
    /// Seed of the bootstraps.
    pub seed: u64,
    /// Name of the template.
    pub template: String,
}

/// No law of own speed reaches beyond this, m/s: what the small craft of the template can do.
pub const OWN_MPS_MAX: f64 = 9.6;

/// The template with the laws of the file. Keys are replaced in their tables.
///
/// # Errors
/// The template has no such table or key.
pub fn campaign(template: &str, source: &Source, model: &Model) -> Result<String, String> {
    let mut text = provenance(source, model) + &without_strata(template);
    text.push_str("[[model.stratum]]\nname = \"traffic\"\n");
    let mut replace = |table: &str, key: &str, value: Option<String>| match value {
        None => Ok(()),
        Some(value) => replaced(&text, table, key, &value).map(|new| text = new),
    };
    let law = |law: &Law| law.distribution().map(|law| inline(&law));
    replace("", "name", Some("\"ais-traffic\"".to_owned()))?;
    replace("", "title", Some(format!("{:?}", format!("Traffic of {}", source.name))))?;
    let own = model.speed.distribution().map(|law| inline(&cut(law, OWN_MPS_MAX)));
    replace("model.own", "speed_mps", own)?;
    replace("model.target", "speed_mps", law(&model.speed))?;
    replace("model.target", "length_m", law(&model.length))?;
    replace("model.geometry", "miss_m", law(&model.miss))?;
    let courses = (!model.relative_course_deg.is_empty())
        .then(|| inline(&Distribution::Empirical(thinned(&model.relative_course_deg))));
    replace("model.geometry", "relative_course_deg", courses)?;
    if let Some([low_s, high_s]) = ends(&model.time.sample) {
        replace("model.geometry", "tcpa_s", Some(format!("[{low_s:.1}, {high_s:.1}]")))?;
        let far_m = model.start_range_m.iter().chain(&model.miss.sample);
        let far_m = far_m.fold(0.0, |far_m: f64, m| far_m.max(m.abs())).ceil();
        replace("model.geometry", "range_m_max", Some(format!("{far_m:.1}")))?;
    }
    Ok(text)
}

fn provenance(source: &Source, model: &Model) -> String {
    let mut text = String::new();
    let n = model.meetings.len();
    let say = |law: &Law| match &law.fitted {
        Some(_) if law.is_refuted() => "the sample itself, no form fits".to_owned(),
        Some(fitted) => {
            let numbers: Vec<String> = fitted
                .parameters
                .iter()
                .map(|p| {
                    let [low, high] = p.interval;
                    format!("{} {:.3} [{low:.3}, {high:.3}]", p.name, p.value)
                })
                .collect();
            let (form, p) = (fitted.form, fitted.p_value);
            format!("{form:?}, {}, 95 % intervals, p = {p:.3}", numbers.join(", "))
        }
        None if law.sample.is_empty() => format!("{ABSENT}, as the template has it"),
        None => "too few values, as the template has it".to_owned(),
    };
    let Source { name, blake3, tool, seed, template } = source;
    let mut line = |words: String| writeln!(text, "# {words}").expect(IN_MEMORY);
    line(format!("Encounter model of {name}: {n} encounters."));
    if n < PAIRS_MIN {
        line(format!("{TOO_FEW} ({PAIRS_MIN} at least)."));
    }
    line(format!("BLAKE3 of the file {blake3};"));
    line(format!("made by {tool}, seed of the bootstraps {seed}, from the template {template}."));
    line(format!("An encounter begins {BEFORE_S:.0} s before its closest point."));
    for law in [&model.speed, &model.miss, &model.length] {
        line(format!("{}: {}.", law.name, say(law)));
    }
    line("relative course: as it was, in both roles.".to_owned());
    line("time to the closest point: even over the middle 95 % of what was met.".to_owned());
    line(format!("Own speed is cut at {OWN_MPS_MAX} m/s. Everything else is the template's."));
    text.push('\n');
    text
}

/// The law without what is over `most`.
fn cut(law: Distribution, most: f64) -> Distribution {
    match law {
        Distribution::Uniform([low, high]) => Distribution::Uniform([low, high.min(most)]),
        Distribution::Normal(mut law) => {
            law.high = law.high.min(most);
            Distribution::Normal(law)
        }
        Distribution::Lognormal(mut law) => {
            law.high = law.high.min(most);
            Distribution::Lognormal(law)
        }
        Distribution::Empirical(mut values) => {
            values.retain(|value| *value <= most);
            Distribution::Empirical(values)
        }
        other => other,
    }
}

/// The middle 95 % of the positive values.
fn ends(sample: &[f64]) -> Option<[f64; 2]> {
    let mut sorted: Vec<f64> = sample.iter().copied().filter(|value| *value > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)? as f64;
    let at = |share: f64| sorted[(share * last).round() as usize];
    let [low, high] = [at(0.025), at(0.975)];
    (low < high).then_some([low, high])
}

/// The text without its tables `[[model.stratum]]` and the comments before them.
fn without_strata(template: &str) -> String {
    let (mut kept, mut comments, mut inside) = (String::new(), String::new(), false);
    for line in template.lines() {
        if line.starts_with('#') {
            comments += line;
            comments.push('\n');
            continue;
        }
        if line.starts_with('[') {
            inside = line.starts_with("[[model.stratum");
        }
        if !inside {
            kept += &comments;
            kept += line;
            kept.push('\n');
        }
        comments.clear();
    }
    kept.truncate(kept.trim_end().len());
    kept + "\n\n"
}

pub(crate) const IN_MEMORY: &str = "a String takes every write";

/// The text with another value for a key of a table; the table `""` is the head of the file.
fn replaced(text: &str, table: &str, key: &str, value: &str) -> Result<String, String> {
    let mut inside = table.is_empty();
    let mut done = false;
    let lines: Vec<String> = text
        .lines()
        .map(|line| {
            if line.starts_with('[') {
                inside = line.trim() == format!("[{table}]");
            }
            let here = inside && !done && line.split('=').next().is_some_and(|k| k.trim() == key);
            done |= here;
            if here { format!("{key} = {value}") } else { line.to_owned() }
        })
        .collect();
    if done { Ok(lines.join("\n") + "\n") } else { Err(format!("`{table}.{key}` is not in it")) }
}

fn inline(law: &Distribution) -> String {
    match law {
        Distribution::Uniform([low, high]) => format!("{{ uniform = [{low:.4}, {high:.4}] }}"),
        Distribution::Normal(law) => format!(
            "{{ normal = {{ mean = {:.4}, sd = {:.4}, low = {:.4}, high = {:.4} }} }}",
            law.mean, law.sd, law.low, law.high
        ),
        Distribution::Lognormal(law) => format!(
            "{{ lognormal = {{ median = {:.4}, sigma = {:.4}, low = {:.4}, high = {:.4} }} }}",
            law.median, law.sigma, law.low, law.high
        ),
        Distribution::Empirical(values) => {
            let values: Vec<String> = values.iter().map(|value| format!("{value:.4}")).collect();
            format!("{{ empirical = [{}] }}", values.join(", "))
        }
        Distribution::Constant(value) => format!("{{ constant = {value:.4} }}"),
        Distribution::Triangular(law) => format!(
            "{{ triangular = {{ low = {:.4}, mode = {:.4}, high = {:.4} }} }}",
            law.low, law.mode, law.high
        ),
    }
}
