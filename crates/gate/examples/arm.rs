//! The smallest program that a gate can start as an arm; the tests of this crate start it.

use campaign::plan::Build;

fn main() -> Result<(), campaign::Error> {
    campaign::engine::quiet_planner_panics();
    let unknown = || "unknown".to_owned();
    let build = Build {
        tool_version: unknown(),
        git_commit: unknown(),
        git_clean: false,
        engine: unknown(),
        planners: unknown(),
        cargo_lock_sha256: unknown(),
        rustc: unknown(),
    };
    let threads = std::env::args().next_back().and_then(|n| n.parse().ok()).unwrap_or(1);
    gate::serve::serve(threads, &build, |name| {
        gate::mutants::with_mutant(planners::registry(), name).map_err(campaign::Error::Input)
    })
}
