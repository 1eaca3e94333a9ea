//! The thresholds of a rule set as a table: key, value, and the source that stands above it.
//!
//! A comment of a rule-set file speaks for every key below it up to the next comment, which is how
//! the files of `campaigns/rulesets/` are written.

use serde::Serialize;

/// One line of a rule set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Threshold {
    /// The rule set, where there are several.
    pub(crate) rule_set: String,
    /// `table.key`.
    pub(crate) key: String,
    pub(crate) value: String,
    /// Grade and source, as the file says them.
    pub(crate) source: String,
}

/// The keys of a rule set's text, those that only name it left out.
pub(crate) fn thresholds(rule_set: &str, text: &str) -> Vec<Threshold> {
    let mut found = Vec::new();
    let mut table = String::new();
    let mut source = String::new();
    let mut in_comment = false;
    for line in text.lines().map(str::trim) {
        if let Some(comment) = line.strip_prefix('#') {
            if !in_comment {
                source.clear();
            }
            in_comment = true;
            source = format!("{source} {}", comment.trim()).trim().to_owned();
            continue;
        }
        in_comment = false;
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            table = name.to_owned();
            source.clear();
        } else if let (Some((key, value)), false) = (line.split_once('='), table.is_empty()) {
            let value = value.split('#').next().unwrap_or_default();
            found.push(Threshold {
                rule_set: rule_set.to_owned(),
                key: format!("{table}.{}", key.trim()),
                value: value.trim().trim_matches('"').to_owned(),
                source: source.clone(),
            });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_speaks_for_the_keys_below_it() {
        let text = "# about the file\nschema = 1\n[stages]\n# [P] of the papers\n# and more\n\
                    mode = \"range\"\n# [S] Table 6\nr2_m = 1900.0\nr3_m = 700.0\n\n[timing]\n\
                    a_s = 3\n";
        let found = thresholds("x", text);
        let line = |i: usize| {
            let t: &Threshold = &found[i];
            (t.key.as_str(), t.value.as_str(), t.source.as_str())
        };
        assert_eq!(found.len(), 4);
        assert_eq!(line(0), ("stages.mode", "range", "[P] of the papers and more"));
        assert_eq!(line(2), ("stages.r3_m", "700.0", "[S] Table 6"));
        assert_eq!(line(3), ("timing.a_s", "3", ""));
    }

    /// Every number that the judge reads is in the table, with a source.
    #[test]
    fn the_default_rule_set_is_listed_whole() {
        let text = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");
        let found = thresholds("usv-oe2023-v1", text);
        let keys: usize = text
            .parse::<toml::Table>()
            .unwrap()
            .values()
            .filter_map(|value| value.as_table().map(toml::Table::len))
            .sum();
        assert_eq!(found.len(), keys);
        let unsourced: Vec<&Threshold> = found.iter().filter(|t| t.source.is_empty()).collect();
        assert!(unsourced.is_empty(), "{unsourced:?}");
    }
}
