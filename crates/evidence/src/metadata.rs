//! RO-Crate 1.1 metadata: what each file of the pack is. No date: it would make two packs of one
//! result differ; `result/timing.json` says when the campaign ended.
//! <https://www.researchobject.org/ro-crate/1.1/>

use crate::pack::{Files, PackInput};
use crate::sha256_hex;
use serde_json::{Value, json};
use std::path::Path;

/// `ro-crate-metadata.json` for these files.
pub(crate) fn ro_crate(input: &PackInput<'_>, files: &Files) -> Value {
    let plan = input.plan;
    let mut graph = vec![
        json!({
            "@id": "ro-crate-metadata.json",
            "@type": "CreativeWork",
            "conformsTo": { "@id": "https://w3id.org/ro/crate/1.1" },
            "about": { "@id": "./" },
        }),
        json!({
            "@id": "./",
            "@type": "Dataset",
            "name": format!("Evidence pack: {}, planner {}", plan.campaign, plan.planner.name),
            "description": plan.title,
            "license": "The licence of the planner's owner; the tool is MIT OR Apache-2.0",
            "hasPart": files.keys().map(|path| json!({ "@id": path })).collect::<Vec<_>>(),
            "mentions": { "@id": "#run" },
        }),
        json!({
            "@id": "#run",
            "@type": "CreateAction",
            "name": format!("campaign {}", plan.campaign),
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
    graph.extend(files.iter().map(|(path, bytes)| {
        json!({
            "@id": path,
            "@type": "File",
            "encodingFormat": format(path),
            "contentSize": bytes.len().to_string(),
            "sha256": sha256_hex(bytes),
        })
    }));
    json!({ "@context": "https://w3id.org/ro/crate/1.1/context", "@graph": graph })
}

fn format(path: &str) -> &'static str {
    let ending = Path::new(path).extension().and_then(|e| e.to_str()).unwrap_or_default();
    match ending {
        "html" => "text/html",
        "svg" => "image/svg+xml",
        "json" | "geojson" => "application/json",
        "csv" => "text/csv",
        "toml" => "application/toml",
        "parquet" => "application/vnd.apache.parquet",
        "pdf" => "application/pdf",
        _ => "text/plain",
    }
}
