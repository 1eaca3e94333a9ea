//! Every derived file of a pack, from the rows, the plan and the encounters run again.

use crate::EvidenceError;
use crate::dnv_output::Systems;
use crate::gathered::Gathered;
use crate::{argument, dnv, dnv_output, foxglove, geojson, page, sbom, sections, sha256_hex};
use campaign::Plan;
use report::{Case, ReportInput};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use summary::Summary;

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
    /// Files that are taken as they are: path inside the pack, content.
    pub given: &'a Files,
    /// The text of the tool's `Cargo.lock`.
    pub lock: &'a str,
}

/// Makes every file but the given ones, the RO-Crate metadata, the manifest and the statement.
///
/// # Errors
/// The lock file or a given file is damaged, or a template does not fit its data.
pub fn derive(input: &PackInput<'_>) -> Result<Files, EvidenceError> {
    let mut files = from_rows(input.plan, input.gathered, input.report.summary, input.lock)?;
    for file in report::render(&input.report)? {
        let path = format!("{RESULT}/{}", file.path.to_string_lossy());
        files.insert(path, file.text.into_bytes());
    }
    for case in input.report.cases.iter().take(EXPORTED) {
        files.extend(exports(input.plan, case)?);
    }
    let mut hashes: BTreeMap<String, String> = hashes(&files);
    hashes.extend(self::hashes(input.given));
    let sections = sections::Sections::new(input)?;
    let nodes = argument::nodes(input, &sections, &hashes);
    let svg = argument::svg(&nodes);
    let page = page::page(input, &sections, &svg, &hashes)?;
    let mut put = |path: &str, text: String| files.insert(path.to_owned(), text.into_bytes());
    put("argument.json", pretty(&nodes));
    put("argument.svg", svg);
    put("evidence.html", page);
    Ok(files)
}

/// The files that follow from the rows and the plan alone, without running an encounter again.
///
/// # Errors
/// The lock file is damaged.
pub fn from_rows(
    plan: &Plan,
    gathered: &Gathered,
    summary: &Summary,
    lock: &str,
) -> Result<Files, EvidenceError> {
    let mut files = Files::new();
    let mut put = |path: &str, text: String| files.insert(path.to_owned(), text.into_bytes());
    put(&format!("{RESULT}/summary.json"), summary.to_json());
    put("plan/plan.json", pretty(&plan.json()?));
    put("plan/plan.blake3", plan.hash()? + "\n");
    for (name, text) in rule_sets(plan) {
        put(&format!("plan/{name}.toml"), text.to_owned());
    }
    put("trace-table.csv", gathered.claims.csv());
    for claim in gathered.claims.list() {
        let mut text = String::new();
        for id in &claim.ids {
            writeln!(text, "{id}").expect("a String takes every write");
        }
        put(&claim.file(), text);
    }
    put("sbom.cdx.json", pretty(&sbom::cyclone_dx(lock, &plan.build.tool_version)?));
    if let Some(csv) = &gathered.csv {
        put("exports/runs.csv", csv.clone());
    }
    Ok(files)
}

/// The rule sets of a plan with their texts: one, or one for each length of own ship.
pub(crate) fn rule_sets(plan: &Plan) -> Vec<(&str, &str)> {
    if plan.rules.by_own_length.is_empty() {
        return vec![(&plan.rules.name, &plan.rules.text)];
    }
    plan.rules.by_own_length.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect()
}

/// An encounter for other tools.
fn exports(plan: &Plan, case: &Case) -> Result<Files, EvidenceError> {
    let stem = case.row.id.file_stem();
    let planner = &plan.planner.name;
    let systems = Systems {
        planner,
        options: &plan.planner.options,
        planners_hash: &plan.build.planners,
        tool_version: &plan.build.tool_version,
        engine_hash: &plan.build.engine,
    };
    let recording = foxglove::recording(case, &plan.campaign, planner)
        .map_err(|source| EvidenceError::Recording { id: case.row.id.to_string(), source })?;
    let output = pretty(&dnv_output::situation_output(case, &systems));
    let put = |ending: &str, bytes| (format!("exports/{stem}.{ending}"), bytes);
    Ok(Files::from([
        put("geojson", line(&geojson::tracks(case)).into_bytes()),
        put("dnv.json", pretty(&dnv::traffic_situation(case)).into_bytes()),
        put("dnv-output.json", output.into_bytes()),
        put("mcap", recording),
    ]))
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
