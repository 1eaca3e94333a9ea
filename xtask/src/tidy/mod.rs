//! `cargo xtask tidy`: what rustfmt, clippy and the compiler do not check.
//!
//! Three groups of rules: dependency edges that must never exist, manifests, and sources. Each
//! finding names its rule; an exception is a line of `xtask/tidy-allow.txt` with its reason, and a
//! line there that excuses nothing is itself a finding.

mod allow;
mod edges;
mod manifests;
mod metadata;
mod sources;

use crate::run::root;
use allow::AllowList;
use anyhow::{Context as _, Result, bail};
use metadata::Workspace;
use std::ffi::OsString;
use std::fmt;
use std::process::ExitCode;

/// A rule that something breaks.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Finding {
    /// The rule's name, as the allow-list spells it.
    pub(crate) rule: &'static str,
    /// A path relative to the workspace, or a crate.
    pub(crate) place: String,
    /// The line, if it is one.
    pub(crate) line: Option<usize>,
    /// What is wrong.
    pub(crate) what: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.line.map(|line| format!(":{line}")).unwrap_or_default();
        write!(f, "{}{line}: {} [{}]", self.place, self.what, self.rule)
    }
}

/// Runs every rule; exit 1 with findings.
pub(crate) fn run(args: &[OsString]) -> Result<ExitCode> {
    if !args.is_empty() {
        bail!("tidy takes no arguments");
    }
    let root = root();
    let workspace = Workspace::read(&root)?;
    let mut findings = edges::check(&workspace);
    for member in &workspace.members {
        let text = std::fs::read_to_string(&member.manifest)
            .with_context(|| format!("failed to read {}", member.manifest.display()))?;
        findings.extend(manifests::check(&member.place, &text));
        for (place, path) in &member.roots {
            let text = std::fs::read_to_string(path)
                .with_context(|| format!("failed to read {}", path.display()))?;
            findings.extend(sources::check_unsafe(&member.name, place, &text));
        }
    }
    let files = sources::tracked(&root)?;
    for (place, text) in &files {
        findings.extend(sources::check(place, text));
    }
    let allow = std::fs::read_to_string(root.join(AllowList::PLACE))
        .with_context(|| format!("failed to read {}", AllowList::PLACE))?;
    let findings = AllowList::parse(&allow).apply(findings);
    for finding in &findings {
        println!("{finding}");
    }
    let (crates, files, found) = (workspace.members.len(), files.len(), findings.len());
    println!("tidy: {crates} crates, {files} files, {found} findings");
    Ok(ExitCode::from(u8::from(found > 0)))
}
