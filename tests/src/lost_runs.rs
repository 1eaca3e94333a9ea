//! A planner that panics, hangs, aborts or overflows its stack costs its own encounters, and no
//! other row.

use crate::support::{root_digest, rows, run_ok};
use record::Outcome;
use std::fs;
use std::path::Path;

/// One thousand encounters of one stratum; the control misbehaves in a share of them.
fn campaign(folder: &Path, planner: &str, share: f64) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../campaigns/laboratory.toml");
    let mut table: toml::Table = fs::read_to_string(path).unwrap().parse().unwrap();
    table.insert("planners".into(), toml::Value::Array(vec![planner.into()]));
    let run = table["run"].as_table_mut().unwrap();
    run.insert("planner_hang_limit_s".into(), 1.0.into());
    run.insert("twice_run_share".into(), 0.0.into());
    let model = table["model"].as_table_mut().unwrap();
    let strata = model["stratum"].as_array().unwrap()[1..2].to_vec();
    model.insert("stratum".into(), toml::Value::Array(strata));
    let mut options = toml::Table::new();
    options.insert("share".into(), share.into());
    let mut planners = toml::Table::new();
    if planner != "zhuang" {
        planners.insert(planner.into(), toml::Value::Table(options));
    }
    table.insert("planner".into(), toml::Value::Table(planners));
    fs::write(folder.join(format!("{planner}.toml")), table.to_string()).unwrap();
    run_ok(
        folder,
        &format!("campaign {planner}.toml --encounters 1000 --threads 2 --out {planner} --quiet"),
    );
}

#[test]
fn each_way_to_fail_costs_its_own_encounters_only() {
    let folder = tempfile::tempdir().unwrap();
    campaign(folder.path(), "zhuang", 0.0);
    let good = rows(&folder.path().join("zhuang"));
    let share = 0.004;
    for (planner, outcome) in [
        ("panics", Outcome::PlannerPanicked),
        ("nan", Outcome::PlannerNonFinite),
        ("aborts", Outcome::PlannerCrashed),
        ("overflows", Outcome::PlannerCrashed),
        ("spins", Outcome::PlannerHung),
    ] {
        campaign(folder.path(), planner, share);
        let result = folder.path().join(planner);
        let bad = rows(&result);
        assert_eq!(bad.len(), 1000, "{planner}");
        let lost = bad.iter().filter(|row| row.outcome == outcome).count();
        // caught a supervisor that closed a suspect's standard input while it waited for it: the
        // suspect thought itself alone and left, and every hang was called a crash
        assert!(lost > 0, "{planner} never misbehaved: the test shows nothing");
        assert!(lost < 20, "{planner} misbehaved {lost} times, far more than its share");
        for (row, was) in bad.iter().zip(&good) {
            if row.outcome == outcome {
                assert!(row.unknown, "{planner}: {} must count against the planner", row.id);
            } else {
                assert_eq!(row, was, "{planner} changed {}", row.id);
            }
        }
        let summary = crate::support::json(result.join("summary.json"));
        assert_eq!(summary["strata"][0]["unknown"], lost as u64, "{planner}");
        assert_ne!(root_digest(&result), root_digest(&folder.path().join("zhuang")));
    }
}
