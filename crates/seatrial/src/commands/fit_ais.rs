//! `fit-ais`: an encounter model from a file of AIS reports.

use crate::embedded;
use crate::exit::Ended;
use crate::say::say_text;
use ::campaign::Error;
use ais::document;
use record::Seed;
use std::fs;
use std::path::Path;

/// The campaign whose laws are replaced.
const TEMPLATE: &str = "open-sea";

pub(super) fn run(file: &Path, out: &Path, seed: u64) -> Result<Ended, Error> {
    let cannot = |what: &str, path: &Path, e: &dyn std::fmt::Display| {
        Error::input(format!("cannot {what} {}: {e}", path.display()))
    };
    let text = fs::read_to_string(file).map_err(|e| cannot("read", file, &e))?;
    let mut rows = ais::read(&text).map_err(|e| cannot("use", file, &e))?;
    let tracks = ais::tracks(&rows.reports, &mut rows.rejected);
    let found = ais::meetings(&tracks);
    let model = document::model(&tracks, &found, Seed(seed));
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let report = document::report(&name, &rows, &tracks, &found, &model);
    say_text!("{report}");
    let template = embedded::campaign_text(TEMPLATE)?;
    let campaign = document::campaign(&template, &name, &model)
        .map_err(|e| Error::Fault(format!("the template {TEMPLATE}: {e}")))?;
    let replay = document::situations(&tracks, &found.meetings);
    fs::create_dir_all(out).map_err(|e| cannot("make", out, &e))?;
    for (name, text) in [("fit.md", report), ("model.toml", campaign), ("situations.toml", replay)]
    {
        let path = out.join(name);
        fs::write(&path, text).map_err(|e| cannot("write", &path, &e))?;
    }
    Ok(Ended::Done)
}
