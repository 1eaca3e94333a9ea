//! What the examples of this folder share: from a campaign file to plans, without a result's
//! folder.

use campaign::plan::Build;
use campaign::{CampaignFile, Error, Overrides, Plan};
use planner_api::Registry;

/// The plans of a campaign file; `change` may alter the file first. Rule sets are those of the
/// repository, wherever the command is run.
pub(crate) fn plans(
    file: &str,
    overrides: &Overrides,
    registry: &Registry,
    change: impl FnOnce(&mut CampaignFile),
) -> Result<Vec<Plan>, Error> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../campaigns/rulesets");
    let rules = |name: &str| read(&format!("{folder}/{name}.toml"));
    let mut campaign = CampaignFile::parse(&read(file)?, file)?;
    change(&mut campaign);
    campaign.resolve(overrides, None, registry, &rules, &build())
}

fn read(path: &str) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|e| Error::input(format!("cannot read {path}: {e}")))
}

/// No result is written, so nobody asks what built it.
fn build() -> Build {
    let none = || String::from("example");
    Build {
        tool_version: none(),
        git_commit: none(),
        git_clean: false,
        engine: none(),
        planners: none(),
        cargo_lock_sha256: none(),
        rustc: none(),
    }
}
