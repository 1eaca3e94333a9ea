//! Another rule set over a finished campaign.

use crate::support::{json, rows, run_err, run_ok};
use std::fs;

const CAMPAIGN: &str = "campaign quick --planner zhuang --quiet";

/// The strongest thing to be said of judging again: it is as if the campaign had been judged so.
#[test]
fn another_rule_set_gives_what_a_campaign_under_it_would_have_given() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --encounters 40 --out first"));
    run_ok(
        folder.path(),
        &format!("{CAMPAIGN} --encounters 40 --rules usv-ccta2023-v1 --out second"),
    );
    run_ok(folder.path(), "judge first --rules usv-ccta2023-v1 --threads 3 --quiet");
    let again = folder.path().join("first/judged-usv-ccta2023-v1");
    for file in ["runs.parquet", "summary.json"] {
        let there = fs::read(folder.path().join("second").join(file)).unwrap();
        assert!(there == fs::read(again.join(file)).unwrap(), "{file} differs");
    }
    let first = fs::read(folder.path().join("first/runs.parquet")).unwrap();
    assert!(first != fs::read(again.join("runs.parquet")).unwrap(), "the rule set changed nothing");
}

#[test]
fn a_sweep_shows_how_the_classes_move() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --encounters 40 --out first"));
    let said = run_ok(folder.path(), "judge first --sweep head_on_half_angle_deg=5,13,22.5");
    assert!(said.contains("head_on") && said.contains("22.5"), "{said}");
    // every share stands under what it is a share of
    let line = |name: &str| said.lines().find(|line| line.starts_with(name)).unwrap();
    let numbers = |name: &str| -> Vec<u64> {
        let words = line(name)[name.len()..].split_whitespace();
        words.map(|word| word.parse().unwrap()).collect()
    };
    assert_eq!(numbers("runs"), [360; 4]);
    let applied = numbers("r14 applied to");
    assert!(applied[1] < applied[2] && applied[2] < applied[3], "{said}");
    let path = "first/judged-usv-oe2023-v1/sweep-head_on_half_angle_deg.json";
    let sweep = json(folder.path().join(path));
    let points = sweep["points"].as_array().unwrap();
    let head_on = |i: usize| points[i]["all"]["classes"]["head_on"].as_u64().unwrap();
    let changed = |i: usize| points[i]["class_changed"].as_u64().unwrap();
    // the first point is the rule set as it stands, at 13 degrees
    assert_eq!((changed(0), changed(2), head_on(0)), (0, 0, head_on(2)));
    assert_eq!(points[0]["all"], points[2]["all"]);
    assert!(head_on(1) < head_on(2) && head_on(2) < head_on(3));
    assert!(changed(1) > 0 && changed(3) > 0);
}

#[test]
fn a_run_that_does_not_give_its_stored_digest_is_a_harness_fault() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --encounters 2 --out first"));
    let result = folder.path().join("first");
    let mut stored = rows(&result);
    stored[3].digest = stored[4].digest;
    let id = stored[3].id.to_string();
    let mut table = table::ParquetSink::create(result.join("runs.parquet")).unwrap();
    stored.iter().for_each(|row| table.push(row).unwrap());
    table.finish().unwrap();
    let said = run_err(folder.path(), "judge first --rules usv-ccta2023-v1 --quiet", 4);
    assert!(said.contains(&id) && said.contains("stored"), "{said}");
    assert!(!result.join("judged-usv-ccta2023-v1/summary.json").exists());
}

#[test]
fn wrong_keys_and_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --encounters 1 --out first"));
    for (line, word) in [
        ("judge first", "--rules"),
        ("judge nowhere --rules usv-oe2023-v1", "nowhere"),
        ("judge first --rules mine", "mine"),
        ("judge first --sweep half_angle=5", "head_on_half_angle_deg"),
        ("judge first --sweep head_on_half_angle_deg=wide", "wide"),
        ("judge first --sweep r_min_m=1000", "r_min_m"),
    ] {
        let said = run_err(folder.path(), line, 2);
        assert!(said.contains(word), "`{line}`: the message does not say {word}: {said}");
    }
}
