//! What `cargo metadata` says of the workspace, reduced to what the rules need.

use crate::run::cargo;
use anyhow::{Context as _, Result, bail};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The workspace and the graph of its dependencies.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    /// Our own crates.
    pub(crate) members: Vec<Member>,
    /// Crate name to the names it depends on in a normal or a build edge, for every crate. Several
    /// versions of a crate are one here, which can only add edges.
    pub(crate) edges: BTreeMap<String, BTreeSet<String>>,
    /// Crate name to the names that only its own tests need.
    pub(crate) test_edges: BTreeMap<String, BTreeSet<String>>,
}

/// One of our own crates.
#[derive(Debug)]
pub(crate) struct Member {
    /// Its name.
    pub(crate) name: String,
    /// Its manifest.
    pub(crate) manifest: PathBuf,
    /// The manifest relative to the workspace.
    pub(crate) place: String,
    /// The root files of its library and binaries, relative and whole.
    pub(crate) roots: Vec<(String, PathBuf)>,
}

impl Workspace {
    /// Asks cargo.
    pub(crate) fn read(root: &Path) -> Result<Self> {
        let output = cargo()
            .args(["metadata", "--format-version", "1", "--locked", "--manifest-path"])
            .arg(root.join("Cargo.toml"))
            .output()
            .context("failed to start `cargo metadata`")?;
        if !output.status.success() {
            bail!("`cargo metadata` failed: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
        let metadata: Value = serde_json::from_slice(&output.stdout)
            .context("failed to read the answer of `cargo metadata`")?;
        Self::from_json(&metadata, root).context("`cargo metadata` answered in an unknown form")
    }

    fn from_json(metadata: &Value, root: &Path) -> Option<Self> {
        let ours: BTreeSet<&str> =
            metadata["workspace_members"].as_array()?.iter().filter_map(Value::as_str).collect();
        let mut workspace = Self::default();
        let mut names = BTreeMap::new();
        for package in metadata["packages"].as_array()? {
            let (id, name) = (package["id"].as_str()?, package["name"].as_str()?);
            names.insert(id, name);
            if ours.contains(id) {
                workspace.members.push(member(package, name, root)?);
            }
        }
        for node in metadata["resolve"]["nodes"].as_array()? {
            let from = *names.get(node["id"].as_str()?)?;
            for dependency in node["deps"].as_array()? {
                let to = *names.get(dependency["pkg"].as_str()?)?;
                let kinds = dependency["dep_kinds"].as_array()?;
                let built = kinds.iter().any(|kind| kind["kind"].as_str() != Some("dev"));
                let edges = if built { &mut workspace.edges } else { &mut workspace.test_edges };
                edges.entry(from.to_owned()).or_default().insert(to.to_owned());
            }
        }
        Some(workspace)
    }
}

fn member(package: &Value, name: &str, root: &Path) -> Option<Member> {
    let manifest = PathBuf::from(package["manifest_path"].as_str()?);
    let relative = |path: &Path| path.strip_prefix(root).unwrap_or(path).display().to_string();
    let mut roots = Vec::new();
    for target in package["targets"].as_array()? {
        let kinds = target["kind"].as_array()?;
        if kinds.iter().any(|kind| matches!(kind.as_str(), Some("lib" | "bin"))) {
            let path = PathBuf::from(target["src_path"].as_str()?);
            roots.push((relative(&path), path));
        }
    }
    Some(Member { name: name.to_owned(), place: relative(&manifest), manifest, roots })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_graph_is_read_and_test_edges_are_kept_apart() {
        let metadata = json!({
            "workspace_members": ["1"],
            "packages": [
                { "id": "1", "name": "rules", "manifest_path": "/x/rules/Cargo.toml",
                  "targets": [
                      { "kind": ["lib"], "src_path": "/x/rules/src/lib.rs" },
                      { "kind": ["test"], "src_path": "/x/rules/tests/all.rs" } ] },
                { "id": "2", "name": "record" },
                { "id": "3", "name": "proptest" } ],
            "resolve": { "nodes": [
                { "id": "1", "deps": [
                    { "pkg": "2", "dep_kinds": [{ "kind": null }, { "kind": "dev" }] },
                    { "pkg": "3", "dep_kinds": [{ "kind": "dev" }] } ] },
                { "id": "2", "deps": [] } ] }
        });
        let workspace = Workspace::from_json(&metadata, Path::new("/x")).unwrap();
        assert_eq!(workspace.members.len(), 1);
        assert_eq!(workspace.members[0].place, "rules/Cargo.toml");
        assert_eq!(workspace.members[0].roots[0].0, "rules/src/lib.rs");
        assert_eq!(workspace.members[0].roots.len(), 1);
        assert!(workspace.edges["rules"].contains("record"));
        assert!(!workspace.edges["rules"].contains("proptest"));
        assert!(workspace.test_edges["rules"].contains("proptest"));
    }
}
