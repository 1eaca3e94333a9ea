//! The binary on a small campaign, and what it wrote.

use crate::support::{json, rows, run_ok, seatrial};
use std::fs;
use std::process::Stdio;

/// One run of the built-in campaign in an empty folder, as after `cargo install`.
#[test]
fn a_small_campaign_writes_every_file_that_it_promises() {
    let folder = tempfile::tempdir().unwrap();
    let said = run_ok(folder.path(), "campaign quick --encounters 20 --threads 2");
    assert!(said.contains("seed 20261121"), "the seed is printed first: {said}");
    let result = folder.path().join("reports/quick-zhuang");
    for file in ["report.html", "runs.parquet", "summary.json", "manifest.json", "timing.json"] {
        assert!(result.join(file).is_file(), "{file} is missing");
    }
    assert!(!result.join("state").exists(), "a finished result keeps no state");
    assert!(fs::read_dir(result.join("figures")).unwrap().count() > 0);

    let summary = json(result.join("summary.json"));
    let strata = summary["strata"].as_array().unwrap();
    assert_eq!(strata.len(), 9);
    assert_eq!(summary["encounters"], 180);
    for stratum in strata {
        assert_eq!(stratum["n"], 20);
        let collision = &stratum["collision"];
        let (k, n) = (collision["k"].as_u64().unwrap(), collision["n"].as_u64().unwrap());
        assert!(k <= n && n == 20);
        let lower = collision["lower_95"].as_f64().unwrap();
        let upper = collision["upper_95"].as_f64().unwrap();
        assert!(lower <= k as f64 / 20.0 && k as f64 / 20.0 <= upper);
        let turns: u64 = stratum["turn_direction"]
            .as_object()
            .unwrap()
            .values()
            .map(|v| v.as_u64().unwrap())
            .sum();
        assert_eq!(turns, 20, "every run has one of the six words");
        let outcomes: u64 =
            stratum["outcomes"].as_object().unwrap().values().map(|v| v.as_u64().unwrap()).sum();
        assert_eq!(outcomes, 20, "every run is a row");
    }

    let rows = rows(&result);
    assert_eq!(rows.len(), 180);
    assert!(rows.windows(2).all(|w| w[0].id.stratum != w[1].id.stratum || w[0].id.j < w[1].id.j));
    let collisions = rows.iter().filter(|row| row.collided()).count() as u64;
    let counted: u64 =
        strata.iter().map(|stratum| stratum["collision"]["k"].as_u64().unwrap()).sum();
    assert_eq!(collisions, counted, "summary and table agree");
}

/// `seatrial campaign | head -0`: nobody reads what it prints, and its result is the files.
#[test]
fn a_reader_that_leaves_early_costs_nothing_but_the_text() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = seatrial(folder.path())
        .args(["campaign", "quick", "--encounters", "1"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(folder.path().join("reports/quick-zhuang/report.html").is_file());
}

/// Any encounter can be run again alone and gives the stored bits.
#[test]
fn replay_gives_the_same_bits_and_draws_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), "campaign quick --encounters 3 --out result --quiet");
    let said = run_ok(folder.path(), "replay result crossing_stbd/000002");
    assert!(said.contains("the same bits as stored"), "{said}");
    assert!(folder.path().join("result/replay/crossing_stbd-000002.svg").is_file());
}

/// A longer campaign extends a shorter one, and neither depends on the planner.
#[test]
fn encounters_depend_on_nothing_but_seed_stratum_and_number() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), "campaign quick --encounters 2 --out short --quiet");
    run_ok(folder.path(), "campaign quick --encounters 5 --out long --quiet");
    run_ok(
        folder.path(),
        "campaign quick --encounters 2 --planner hold-course --out other --quiet",
    );
    let short = rows(&folder.path().join("short"));
    let long = rows(&folder.path().join("long"));
    let other = rows(&folder.path().join("other"));
    for (row, same) in short.iter().zip(&other) {
        let extended = long.iter().find(|l| l.id == row.id).unwrap();
        assert_eq!(row, extended);
        assert_eq!(row.id, same.id);
        assert_eq!(row.beta_rad, same.beta_rad);
        assert_eq!(row.target_speed_mps, same.target_speed_mps);
        assert_eq!(row.nominal_cpa_hull_m, same.nominal_cpa_hull_m);
    }
}
