//! Dependency edges that must never exist (docs/ARCHITECTURE.md, invariants).
//!
//! They buy that a planner cannot see the truth, that the judge cannot see the simulator, and that
//! the core builds without the heavy libraries. An edge counts however long its way is; tests of a
//! crate count as that crate, because a test that needs the simulator judges the simulator.

use super::Finding;
use super::metadata::Workspace;
use std::collections::{BTreeMap, BTreeSet};

/// A crate and all of ours that it may reach.
const MAY_REACH: &[(&str, &[&str])] = &[
    ("geom", &[]),
    ("stats", &[]),
    ("record", &["geom"]),
    ("planner-api", &["geom"]),
    ("planners", &["planner-api", "geom"]),
    ("planner-host", &["planner-api", "geom"]),
    ("encounter", &["record", "geom"]),
    ("rules", &["record", "geom"]),
    ("stl", &["record", "geom"]),
    ("sim", &["record", "planner-api", "geom"]),
    ("xtask", &[]),
];

/// Crates that build and test without the heavy libraries.
const LIGHT: &[&str] = &[
    "geom",
    "record",
    "planner-api",
    "planners",
    "planner-host",
    "encounter",
    "ais",
    "sim",
    "rules",
    "stats",
    "stl",
    "summary",
    "campaign",
];

/// The heavy libraries; their parts are called `polars-core` and so on.
const HEAVY: &[&str] = &["polars", "plotters", "arrow", "parquet"];

/// Crates that nothing depends on, and the one that may all the same.
const TOP: &[(&str, &[&str])] = &[("seatrial", &["seatrial-tests"]), ("xtask", &[])];

/// Every forbidden edge, with the way that makes it.
pub(crate) fn check(workspace: &Workspace) -> Vec<Finding> {
    let ours: BTreeSet<&str> =
        workspace.members.iter().map(|member| member.name.as_str()).collect();
    let mut findings = Vec::new();
    for from in &ours {
        let ways = reach(workspace, from);
        for (to, way) in &ways {
            if let Some(why) = forbidden(from, to, ours.contains(to.as_str())) {
                findings.push(Finding {
                    rule: "edge",
                    place: (*from).to_owned(),
                    line: None,
                    what: format!("{why} ({})", way.join(" -> ")),
                });
            }
        }
    }
    findings
}

fn forbidden(from: &str, to: &str, to_is_ours: bool) -> Option<String> {
    let only = MAY_REACH.iter().find(|(name, _)| *name == from).map(|(_, reach)| *reach);
    if let Some(only) = only.filter(|only| to_is_ours && !only.contains(&to)) {
        let allowed = if only.is_empty() { "none of ours".to_owned() } else { only.join(", ") };
        return Some(format!("must not depend on `{to}`, but only on {allowed}"));
    }
    let part_of = |heavy: &&str| to.strip_prefix(*heavy).is_some_and(is_end_of_name);
    if LIGHT.contains(&from) && HEAVY.iter().any(part_of) {
        return Some(format!("must build without `{to}`"));
    }
    let top = TOP.iter().find(|(name, _)| *name == to);
    top.filter(|(_, except)| !except.contains(&from)).map(|_| format!("nothing depends on `{to}`"))
}

fn is_end_of_name(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with(['-', '_', '2'])
}

/// Everything that `from` and its tests reach, each with one way to it.
fn reach(workspace: &Workspace, from: &str) -> BTreeMap<String, Vec<String>> {
    let mut ways: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut open = vec![vec![from.to_owned()]];
    while let Some(way) = open.pop() {
        let last = way.last().expect("a way has a first crate");
        let built = workspace.edges.get(last).into_iter().flatten();
        let tested = workspace.test_edges.get(last).into_iter().flatten();
        let next = built.chain(tested.filter(|_| way.len() == 1));
        for name in next {
            if name != from && !ways.contains_key(name) {
                let longer: Vec<String> = way.iter().chain([name]).cloned().collect();
                ways.insert(name.clone(), longer.clone());
                open.push(longer);
            }
        }
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::super::metadata::Member;
    use super::*;
    use std::path::PathBuf;

    fn workspace(edges: &[(&str, &str)], tests: &[(&str, &str)]) -> Workspace {
        let graph = |edges: &[(&str, &str)]| {
            let mut graph: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
            for (from, to) in edges {
                graph.entry((*from).to_owned()).or_default().insert((*to).to_owned());
            }
            graph
        };
        let ours = MAY_REACH.iter().map(|(name, _)| *name);
        let members = ours.chain(["campaign", "table", "report", "seatrial", "seatrial-tests"]);
        Workspace {
            members: members
                .map(|name| Member {
                    name: name.to_owned(),
                    manifest: PathBuf::new(),
                    place: String::new(),
                    roots: Vec::new(),
                })
                .collect(),
            edges: graph(edges),
            test_edges: graph(tests),
        }
    }

    fn found(edges: &[(&str, &str)], tests: &[(&str, &str)]) -> Vec<String> {
        check(&workspace(edges, tests)).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn the_intended_graph_is_clean() {
        let edges = [
            ("record", "geom"),
            ("rules", "record"),
            ("sim", "planner-api"),
            ("campaign", "sim"),
            ("table", "polars"),
            ("report", "plotters"),
            ("seatrial", "report"),
            ("planners", "planner-api"),
        ];
        let tests = [("seatrial-tests", "seatrial"), ("rules", "proptest")];
        assert_eq!(found(&edges, &tests), Vec::<String>::new());
    }

    #[test]
    fn every_edge_that_must_never_exist_is_found() {
        for (from, to) in [
            ("rules", "sim"),
            ("rules", "planner-api"),
            ("stl", "rules"),
            ("planner-host", "sim"),
            ("planner-host", "rules"),
            ("planner-host", "planners"),
            ("planners", "record"),
            ("campaign", "polars"),
            ("geom", "plotters"),
            ("stats", "arrow"),
            ("sim", "parquet"),
            ("stl", "polars-core"),
            ("report", "seatrial"),
            ("table", "xtask"),
            ("xtask", "geom"),
        ] {
            assert_eq!(found(&[(from, to)], &[]).len(), 1, "{from} -> {to}");
        }
    }

    #[test]
    fn a_long_way_and_a_test_count_and_the_way_is_shown() {
        let long = found(&[("encounter", "rayon"), ("rayon", "polars-core")], &[]);
        assert_eq!(long.len(), 1);
        assert!(long[0].contains("(encounter -> rayon -> polars-core)"), "{long:?}");
        assert_eq!(found(&[], &[("rules", "sim")]).len(), 1);
        let only_its_own_tests = found(&[("campaign", "sim")], &[("sim", "record")]);
        assert_eq!(only_its_own_tests, Vec::<String>::new());
    }
}
