//! The files of `campaigns/`, inside the binary.

use campaign::Error;
use std::fs;
use std::path::Path;

mod generated {
    include!(concat!(env!("OUT_DIR"), "/campaigns.rs"));
}

/// The text of a campaign: a path to a file, or the name of one that is built in.
pub(crate) fn campaign_text(name: &str) -> Result<String, Error> {
    text(name, "", "campaign", |file| !file.contains('/'))
}

/// The text of a rule set: a path to a file, or the name of one that is built in.
pub(crate) fn rules_text(name: &str) -> Result<String, Error> {
    text(name, "rulesets/", "rule set", |file| file.starts_with("rulesets/"))
}

fn text(
    name: &str,
    folder: &str,
    what: &str,
    is_one: impl Fn(&str) -> bool,
) -> Result<String, Error> {
    let path = Path::new(name);
    if name.ends_with(".toml") || name.contains('/') {
        return fs::read_to_string(path).map_err(|e| {
            Error::input(format!("cannot read the {what} file {}: {e}", path.display()))
        });
    }
    let wanted = format!("{folder}{name}.toml");
    let found = generated::FILES.iter().find(|(file, _)| *file == wanted);
    found.map(|(_, text)| (*text).to_owned()).ok_or_else(|| {
        let known: Vec<&str> = generated::FILES
            .iter()
            .map(|(file, _)| *file)
            .filter(|file| is_one(file))
            .map(|file| file.trim_start_matches(folder).trim_end_matches(".toml"))
            .collect();
        Error::input(format!(
            "there is no {what} `{name}`; built in are {}; or name a file that ends in .toml",
            known.join(", ")
        ))
    })
}
