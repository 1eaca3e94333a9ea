//! `compare`: several planners on the same encounters, side by side. It is a campaign with several
//! planners under a shorter name.

use crate::cli::{CampaignArgs, CompareArgs};
use crate::exit::Ended;
use campaign::Error;
use planner_api::Registry;

pub(super) fn run(
    planners: Vec<String>,
    common: CompareArgs,
    registry: Registry,
) -> Result<Ended, Error> {
    let args = CampaignArgs {
        campaign: Some(common.campaign),
        planners,
        encounters: common.encounters,
        seed: common.seed,
        threads: common.threads,
        out: common.out,
        resume: common.resume,
        force: common.force,
        ..CampaignArgs::default()
    };
    super::campaign::run(&args, registry)
}
