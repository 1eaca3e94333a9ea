//! What a gate leaves behind: `gate.json`, JUnit XML, a Markdown page.

use campaign::Error;
use gate::GateReport;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes all three; where CI names the page of its job, the Markdown goes there too.
pub(super) fn write(out: &Path, report: &GateReport) -> Result<(), Error> {
    fs::create_dir_all(out).map_err(Error::io("make", out))?;
    let folder = out.display().to_string();
    let mut json = serde_json::to_string_pretty(report)
        .map_err(|e| Error::Fault(format!("failed to encode the result: {e}")))?;
    json.push('\n');
    crate::files::write(&out.join("gate.json"), json.as_bytes())?;
    let xml = gate::junit::xml(report, &folder)
        .map_err(|e| Error::Fault(format!("failed to encode JUnit XML: {e}")))?;
    crate::files::write(&out.join("junit.xml"), xml.as_bytes())?;
    let page = gate::text::markdown(report, &folder);
    crate::files::write(&out.join("summary.md"), page.as_bytes())?;
    // the one variable that is read for a result: CI names the page of its job by it
    match std::env::var_os("GITHUB_STEP_SUMMARY").map(PathBuf::from) {
        Some(path) => append(&path, &page),
        None => Ok(()),
    }
}

fn append(path: &Path, text: &str) -> Result<(), Error> {
    use std::io::Write;
    let file = fs::OpenOptions::new().create(true).append(true).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(Error::io("append to", path))
}
