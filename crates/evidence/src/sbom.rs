//! The software bill of materials: CycloneDX 1.5, from `Cargo.lock`.
//!
//! It has no serial number and no time, which the format allows, so the same lock file gives the
//! same bytes. <https://cyclonedx.org/docs/1.5/json/>

use crate::EvidenceError;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
struct Lock {
    package: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    source: Option<String>,
    checksum: Option<String>,
    #[serde(default)]
    dependencies: Vec<String>,
}

/// `sbom.cdx.json`.
pub(crate) fn cyclone_dx(lock: &str, tool_version: &str) -> Result<Value, EvidenceError> {
    let lock: Lock = toml::from_str(lock).map_err(|e| EvidenceError::Form {
        path: "Cargo.lock".to_owned(),
        problem: e.to_string(),
    })?;
    let purl = |name: &str, version: &str| format!("pkg:cargo/{name}@{version}");
    // a dependency is `name`, or `name version` where there are several
    let resolve = |dependency: &String| {
        let mut words = dependency.split(' ');
        let name = words.next().unwrap_or_default();
        let version = words
            .next()
            .or_else(|| lock.package.iter().find(|p| p.name == name).map(|p| p.version.as_str()));
        purl(name, version.unwrap_or_default())
    };
    let components: Vec<Value> = (lock.package.iter())
        .map(|package| {
            let reference = purl(&package.name, &package.version);
            let mut component = json!({
                "type": if package.source.is_some() { "library" } else { "application" },
                "bom-ref": reference,
                "name": package.name,
                "version": package.version,
                "purl": reference,
            });
            if let Some(checksum) = &package.checksum {
                component["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
            }
            component
        })
        .collect();
    let dependencies: Vec<Value> = (lock.package.iter())
        .map(|package| {
            json!({
                "ref": purl(&package.name, &package.version),
                "dependsOn": package.dependencies.iter().map(resolve).collect::<Vec<_>>(),
            })
        })
        .collect();
    Ok(json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": {
            "type": "application",
            "bom-ref": "tool",
            "name": "seatrial",
            "version": tool_version,
        }},
        "components": components,
        "dependencies": dependencies,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_become_components_with_hashes_and_edges() {
        let lock = "version = 4\n\
            [[package]]\nname = \"a\"\nversion = \"1.0.0\"\ndependencies = [\"b 2.0.0\", \"c\"]\n\
            [[package]]\nname = \"b\"\nversion = \"2.0.0\"\nsource = \"registry\"\n\
            checksum = \"ab\"\n\
            [[package]]\nname = \"c\"\nversion = \"0.1.0\"\nsource = \"registry\"\n";
        let sbom = cyclone_dx(lock, "0.1.0").unwrap();
        assert_eq!(sbom["components"].as_array().unwrap().len(), 3);
        assert_eq!(sbom["components"][1]["hashes"][0]["content"], "ab");
        assert_eq!(sbom["dependencies"][0]["dependsOn"][0], "pkg:cargo/b@2.0.0");
        assert_eq!(sbom["dependencies"][0]["dependsOn"][1], "pkg:cargo/c@0.1.0");
        assert!(cyclone_dx("not a lock", "0").is_err());
    }
}
