//! Manifests: lints and versions are chosen in the workspace and nowhere else.

use super::Finding;

/// The findings of one member's `Cargo.toml`.
pub(crate) fn check(place: &str, text: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut section = String::new();
    let mut lints = false;
    let mut add = |rule, line, what: String| {
        findings.push(Finding { rule, place: place.to_owned(), line, what });
    };
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            section = name.trim().to_owned();
            continue;
        }
        if line.is_empty() {
            continue;
        }
        let inherited = line.replace(' ', "").contains("workspace=true");
        lints |= section == "lints" && inherited;
        let foreign = is_dependencies(&section) && !inherited && !is_only_features(line);
        if foreign || section == "features" {
            add("manifest-version", Some(index + 1), format!("`{line}` {WORKSPACE_ONLY}"));
        }
    }
    if !lints {
        add("manifest-lints", None, "`[lints]` with `workspace = true` is missing".to_owned());
    }
    findings
}

const WORKSPACE_ONLY: &str = "belongs in the workspace's table; here `name.workspace = true`";

/// `dependencies`, `dev-dependencies`, `target.'cfg(unix)'.dependencies`, `dependencies.name`.
fn is_dependencies(section: &str) -> bool {
    section.split('.').any(|part| part.ends_with("dependencies"))
}

/// `optional` and `features` of a `[dependencies.name]` table are choices of the member.
fn is_only_features(line: &str) -> bool {
    line.starts_with("optional") || line.starts_with("features")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(text: &str) -> Vec<&'static str> {
        check("x/Cargo.toml", text).iter().map(|finding| finding.rule).collect()
    }

    #[test]
    fn versions_and_lints_come_from_the_workspace() {
        let good = "[lints]\nworkspace = true\n[dependencies]\nserde.workspace = true\n\
                    geom = { workspace = true, features = [\"x\"] }\n";
        assert_eq!(rules(good), Vec::<&str>::new());
        assert_eq!(rules("[dependencies]\n"), ["manifest-lints"]);
        let own = |line: &str| rules(&format!("{good}{line}\n"));
        assert_eq!(own("libm = \"0.2\""), ["manifest-version"]);
        assert_eq!(own("libm = { path = \"../libm\" }"), ["manifest-version"]);
        assert_eq!(own("[dev-dependencies]\ntempfile = \"3\""), ["manifest-version"]);
        assert_eq!(own("[dependencies.libm]\nversion = \"0.2\""), ["manifest-version"]);
        assert_eq!(own("[target.'cfg(unix)'.dependencies]\nlibc = \"1\""), ["manifest-version"]);
    }
}
