//! RO-Crate 1.1 metadata: what each file of the pack is. The day of the campaign, which the format
//! asks for, comes from `result/timing.json`, so this file is one of those declared to differ.
//! <https://www.researchobject.org/ro-crate/1.1/>

use crate::EvidenceError;
use crate::change::parse;
use crate::pack::{Files, pretty};
use crate::seal::{RO_CRATE, TIMING, VOLATILE};
use crate::sha256_hex;
use campaign::Plan;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::Path;

#[derive(Deserialize)]
struct Timing {
    finished_unix_s: u64,
}

/// Adds `ro-crate-metadata.json` over all files that are there, those that differ between two packs
/// (the wall clock apart) left out.
///
/// # Errors
/// `result/timing.json` is missing or damaged.
pub fn ro_crate(files: &mut Files, plan: &Plan) -> Result<(), EvidenceError> {
    let timing: Timing = parse(files, TIMING)?;
    let finished = day(timing.finished_unix_s);
    let described = |path: &&String| *path == TIMING || !VOLATILE.contains(&path.as_str());
    let paths: Vec<&String> = files.keys().filter(described).collect();
    let mut graph = vec![
        json!({
            "@id": RO_CRATE,
            "@type": "CreativeWork",
            "conformsTo": { "@id": "https://w3id.org/ro/crate/1.1" },
            "about": { "@id": "./" },
        }),
        json!({
            "@id": "./",
            "@type": "Dataset",
            "name": format!("Evidence pack: {}, planner {}", plan.campaign, plan.planner.name),
            "description": plan.title,
            "datePublished": finished,
            "license": { "@id": "#licence" },
            "hasPart": paths.iter().map(|path| json!({ "@id": path })).collect::<Vec<_>>(),
            "mentions": { "@id": "#run" },
        }),
        json!({
            "@id": "#licence",
            "@type": "CreativeWork",
            "name": "The licence of the planner's owner",
            "description": "What was found of a planner belongs to its owner; the tool that made \
                            the pack is MIT OR Apache-2.0.",
        }),
        json!({
            "@id": "#run",
            "@type": "CreateAction",
            "name": format!("campaign {}", plan.campaign),
            "endTime": finished,
            "instrument": { "@id": "#tool" },
            "object": { "@id": "plan/plan.json" },
            "result": { "@id": "result/runs.parquet" },
        }),
        json!({
            "@id": "#tool",
            "@type": "SoftwareApplication",
            "name": "seatrial",
            "softwareVersion": plan.build.tool_version,
            "identifier": plan.build.git_commit,
        }),
    ];
    graph.extend(paths.iter().map(|path| file(path, &files[*path])));
    let metadata = json!({ "@context": "https://w3id.org/ro/crate/1.1/context", "@graph": graph });
    files.insert(RO_CRATE.to_owned(), pretty(&metadata).into_bytes());
    Ok(())
}

fn file(path: &str, bytes: &[u8]) -> Value {
    json!({
        "@id": path,
        "@type": "File",
        "encodingFormat": format(path),
        "contentSize": bytes.len().to_string(),
        "sha256": sha256_hex(bytes),
    })
}

fn format(path: &str) -> &'static str {
    let ending = Path::new(path).extension().and_then(|e| e.to_str()).unwrap_or_default();
    match ending {
        "html" => "text/html",
        "svg" => "image/svg+xml",
        "json" | "geojson" => "application/json",
        "csv" => "text/csv",
        "md" => "text/markdown",
        "toml" => "application/toml",
        "parquet" => "application/vnd.apache.parquet",
        "pdf" => "application/pdf",
        "mcap" => "application/x-mcap",
        _ => "text/plain",
    }
}

/// The day of a moment (seconds since 1970 in UTC) as ISO 8601, by the civil calendar.
fn day(unix_s: u64) -> String {
    // days since 0000-03-01, so that a leap day ends its year; 400 years have 146,097 days
    let days = unix_s / 86_400 + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        for (unix_s, wanted) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (951_868_799, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_795_324_040, "2026-11-22"),
            (4_107_542_400, "2100-03-01"),
        ] {
            assert_eq!(day(unix_s), wanted);
        }
    }
}
