//! Every derived file of a pack, from the rows, the plan and the encounters run again.

use crate::EvidenceError;
use crate::gathered::Gathered;
use crate::{argument, dnv, geojson, metadata, page, sbom, sha256_hex};
use campaign::Plan;
use report::ReportInput;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Files of a pack: path with slashes, content.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Folder of the result inside a pack.
pub const RESULT: &str = "result";

/// Encounters exported for other tools.
const EXPORTED: usize = 20;

/// What a pack is made from.
#[derive(Clone, Copy, Debug)]
pub struct PackInput<'a> {
    /// The plan of the result.
    pub plan: &'a Plan,
    /// What the rows add up to.
    pub gathered: &'a Gathered,
    /// The report, with the encounters run again.
    pub report: ReportInput<'a>,
    /// Files of the result that are taken as they are: path inside the pack, content.
    pub given: &'a Files,
    /// The text of the tool's `Cargo.lock`.
    pub lock: &'a str,
}

/// Makes every file but the given ones, the manifest and the statement.
///
/// # Errors
/// The lock file is damaged, or a template does not fit its data.
pub fn derive(input: &PackInput<'_>) -> Result<Files, EvidenceError> {
    let mut files = Files::new();
    let mut put = |path: &str, text: String| files.insert(path.to_owned(), text.into_bytes());
    for file in report::render(&input.report)? {
        put(&format!("{RESULT}/{}", file.path.to_string_lossy()), file.text);
    }
    put(&format!("{RESULT}/summary.json"), input.report.summary.to_json());
    put("plan/plan.json", pretty(&input.plan.json()?));
    put("plan/plan.blake3", input.plan.hash()? + "\n");
    put(&format!("plan/{}.toml", input.plan.rules.name), input.plan.rules.text.clone());
    let claims = input.gathered.claims.list();
    put("trace-table.csv", input.gathered.claims.csv());
    for claim in claims {
        let mut text = String::new();
        for id in &claim.ids {
            writeln!(text, "{id}").expect("a String takes every write");
        }
        put(&claim.file(), text);
    }
    put("sbom.cdx.json", pretty(&sbom::cyclone_dx(input.lock, &input.plan.build.tool_version)?));
    if let Some(csv) = &input.gathered.csv {
        put("exports/runs.csv", csv.clone());
    }
    for case in input.report.cases.iter().take(EXPORTED) {
        let stem = case.row.id.file_stem();
        put(&format!("exports/{stem}.geojson"), line(&geojson::tracks(case)));
        put(&format!("exports/{stem}.dnv.json"), pretty(&dnv::traffic_situation(case)));
    }
    let mut hashes: BTreeMap<String, String> = hashes(&files);
    hashes.extend(self::hashes(input.given));
    let nodes = argument::nodes(input, claims, &hashes);
    let svg = argument::svg(&nodes);
    let page = page::page(input, claims, &svg, &hashes)?;
    let mut put = |path: &str, text: String| files.insert(path.to_owned(), text.into_bytes());
    put("argument.json", pretty(&nodes));
    put("argument.svg", svg);
    put("evidence.html", page);
    let mut all = files.clone();
    all.extend(input.given.iter().map(|(path, bytes)| (path.clone(), bytes.clone())));
    let crate_metadata = pretty(&metadata::ro_crate(input, &all));
    files.insert("ro-crate-metadata.json".to_owned(), crate_metadata.into_bytes());
    Ok(files)
}

fn hashes(files: &Files) -> BTreeMap<String, String> {
    files.iter().map(|(path, bytes)| (path.clone(), sha256_hex(bytes))).collect()
}

/// JSON with line breaks, ending in one.
pub(crate) fn pretty(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).expect("these values have string keys") + "\n"
}

fn line(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("these values have string keys") + "\n"
}
