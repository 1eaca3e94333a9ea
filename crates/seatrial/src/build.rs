//! What this binary knows of its own making; the values come from the build script.

use campaign::plan::Build;

/// Version, commit and hashes.
pub(crate) fn build() -> Build {
    Build {
        tool_version: env!("CARGO_PKG_VERSION").to_owned(),
        git_commit: env!("SEATRIAL_GIT_COMMIT").to_owned(),
        git_clean: env!("SEATRIAL_GIT_CLEAN") == "true",
        engine: env!("SEATRIAL_ENGINE").to_owned(),
        planners: env!("SEATRIAL_PLANNERS").to_owned(),
        cargo_lock_sha256: env!("SEATRIAL_LOCK_SHA256").to_owned(),
        rustc: env!("SEATRIAL_RUSTC").to_owned(),
    }
}

/// Hash of the sources that render reports and packs.
pub(crate) const RENDERER: &str = env!("SEATRIAL_RENDERER");
/// The libraries that this binary was built from.
pub(crate) const CARGO_LOCK: &str = include_str!("../../../Cargo.lock");

/// How this binary was built, as the JSON of [`evidence::BUILD`].
pub(crate) const BUILT: &str = include_str!(concat!(env!("OUT_DIR"), "/built.json"));
/// How each check reads its rule, as the JSON of [`evidence::READINGS`].
pub(crate) const READINGS: &str = include_str!(concat!(env!("OUT_DIR"), "/readings.json"));

// `MEASURED`: the documents of `docs/measured`, by name.
include!(concat!(env!("OUT_DIR"), "/bench.rs"));
