//! `evidence`: a pack of a finished result, for an assessor.

use crate::exit::Ended;
use crate::rendering::Rendering;
use crate::say::say;
use crate::{build, files};
use campaign::{Error, Folder, Plan};
use evidence::{EvidenceError, Files, Gathered, PackInput, RESULT, STATEMENT};
use planner_api::Registry;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What was asked for.
#[derive(Debug)]
pub(super) struct Wanted<'a> {
    pub(super) dir: &'a Path,
    pub(super) out: &'a Path,
    /// Secret key of `minisign`.
    pub(super) key: Option<&'a Path>,
    /// The gate's self-test instead of the tool's own.
    pub(super) self_test: Option<&'a Path>,
    /// The pack before.
    pub(super) previous: Option<&'a Path>,
    pub(super) pdf: bool,
}

pub(super) fn run(wanted: &Wanted<'_>, registry: Registry) -> Result<Ended, Error> {
    let out = wanted.out;
    if out.exists() {
        return Err(Error::input(format!(
            "{} is there already; a pack is written to a folder of its own",
            out.display()
        )));
    }
    let (folder, plan) = Folder::finished(wanted.dir)?;
    let table = crate::stored::whole_table(folder.path())?;
    let registry = super::with_outside(registry, std::slice::from_ref(&plan.planner.name))?;
    plan.refuse_weights("the claims of an evidence pack")?;
    unchanged(folder.path())?;
    let given =
        super::evidence_given::gather(folder.path(), &plan, wanted.self_test, wanted.previous)?;
    let pack = make(&plan, &registry, &table, &given)?;
    same_report(folder.path(), &pack)?;
    for (path, bytes) in &pack {
        let path = out.join(path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(Error::io("make", parent))?;
        }
        files::write(&path, bytes)?;
    }
    if wanted.pdf {
        print_pdf(out)?;
    }
    state(out)?;
    if let Some(key) = wanted.key {
        evidence::sign(&out.join(STATEMENT), key).map_err(failed)?;
    }
    say!("pack: {} ({} files)", out.display(), files::below(out)?.len());
    Ok(Ended::Done)
}

/// Every file of a pack but the PDF, the statement and its signature, sealed by its manifest.
pub(super) fn make(
    plan: &Plan,
    registry: &Registry,
    table: &Path,
    given: &Files,
) -> Result<Files, Error> {
    let gathered = Gathered::read(table, plan).map_err(failed)?;
    let rendering = Rendering::new(
        plan,
        registry,
        gathered.tallies.clone(),
        gathered.root_digest.clone(),
        (&gathered.cases, &gathered.findings, &gathered.disagreements),
    )?;
    // what changes from run to run must not get into what does not
    let stable = super::evidence_given::stable(given);
    let input = PackInput {
        plan,
        gathered: &gathered,
        report: rendering.input(),
        given: &stable,
        lock: build::CARGO_LOCK,
    };
    let mut pack = evidence::derive(&input).map_err(failed)?;
    pack.extend(given.clone());
    evidence::seal(&mut pack, plan, &gathered, build::RENDERER).map_err(failed)?;
    evidence::ro_crate(&mut pack, plan).map_err(failed)?;
    Ok(pack)
}

pub(super) fn failed(error: EvidenceError) -> Error {
    Error::input(format!("failed to {error}"))
}

/// The files of a result against the hashes in its manifest.
fn unchanged(folder: &Path) -> Result<(), Error> {
    let path = folder.join("manifest.json");
    let text = fs::read(&path).map_err(Error::io("read", &path))?;
    let damaged = |what: String| Error::input(format!("{}: {what}", folder.display()));
    let manifest: serde_json::Value = serde_json::from_slice(&text)
        .map_err(|e| damaged(format!("manifest.json is damaged: {e}")))?;
    let hashes: BTreeMap<String, String> = serde_json::from_value(manifest["files_sha256"].clone())
        .map_err(|e| damaged(format!("manifest.json has no hashes: {e}")))?;
    for (name, hash) in hashes {
        let path = folder.join(&name);
        let bytes = fs::read(&path).map_err(Error::io("read", &path))?;
        if evidence::sha256_hex(&bytes) != hash {
            return Err(damaged(format!("{name} was changed after the campaign; run it again")));
        }
    }
    Ok(())
}

/// A result of another build may have been rendered otherwise: its own report is not in the pack.
fn same_report(folder: &Path, pack: &Files) -> Result<(), Error> {
    let path = folder.join("report.html");
    let there = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
    // a pack holds one planner: the page beside which others stood is alone in it
    let alone = there.replacen(report::BESIDE, "", 1);
    let packed = pack.get(&format!("{RESULT}/report.html"));
    if packed.map(Vec::as_slice) != Some(alone.as_bytes()) {
        say!(
            "note: this build renders the report otherwise than the one that made it; the pack \
             has the new one"
        );
    }
    Ok(())
}

/// `evidence.pdf`, by a browser, where there is one.
fn print_pdf(out: &Path) -> Result<(), Error> {
    const BROWSERS: [&str; 3] = ["chromium", "google-chrome", "chromium-browser"];
    let page = out.join("evidence.html");
    let page = page.canonicalize().map_err(Error::io("find", &page))?;
    let pdf = out.join("evidence.pdf");
    let printed = BROWSERS.iter().any(|browser| {
        let status = Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer"])
            .arg(format!("--print-to-pdf={}", pdf.display()))
            .arg(format!("file://{}", page.display()))
            .stderr(std::process::Stdio::null())
            .status();
        status.is_ok_and(|status| status.success()) && pdf.exists()
    });
    if !printed {
        say!(
            "note: no evidence.pdf: none of {} could print it; evidence.html has the same content",
            BROWSERS.join(", ")
        );
    }
    Ok(())
}

/// The statement over everything that is in the folder.
fn state(out: &Path) -> Result<(), Error> {
    let pack = evidence::read_all(out).map_err(failed)?;
    let (_, manifest) = evidence::inspect(&pack);
    let manifest =
        manifest.ok_or_else(|| Error::Fault("the manifest just written is damaged".to_owned()))?;
    let hashes: BTreeMap<String, String> =
        pack.iter().map(|(path, bytes)| (path.clone(), evidence::sha256_hex(bytes))).collect();
    files::write(&out.join(STATEMENT), &evidence::statement(&hashes, &manifest))
}
