//! Evidence packs of campaigns in which something is out of the ordinary.

use crate::support::{json, rows, run, run_err, run_ok};
use record::Outcome;
use std::fs;
use std::path::Path;

fn laboratory() -> toml::Table {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../campaigns/laboratory.toml");
    fs::read_to_string(path).unwrap().parse().unwrap()
}

fn text(path: impl AsRef<Path>) -> String {
    fs::read_to_string(path).unwrap().replace("&#x2f;", "/")
}

/// A planner that ends its process, or never comes back, is asked again in a process of its own.
#[test]
fn verify_runs_again_what_took_its_process_with_it() {
    let folder = tempfile::tempdir().unwrap();
    for (planner, outcome) in [("aborts", Outcome::PlannerCrashed), ("spins", Outcome::PlannerHung)]
    {
        let mut table = laboratory();
        table.insert("planners".into(), toml::Value::Array(vec![planner.into()]));
        let run = table["run"].as_table_mut().unwrap();
        run.insert("planner_hang_limit_s".into(), 1.0.into());
        let options = toml::Table::from_iter([("share".to_owned(), 0.1.into())]);
        let planners = toml::Table::from_iter([(planner.to_owned(), options.into())]);
        table.insert("planner".into(), planners.into());
        fs::write(folder.path().join(format!("{planner}.toml")), table.to_string()).unwrap();
        let line = format!("campaign {planner}.toml --encounters 4 --out {planner} --quiet");
        run_ok(folder.path(), &line);
        let lost = rows(&folder.path().join(planner));
        let lost = lost.iter().filter(|row| row.outcome == outcome).count();
        assert!(lost > 0, "{planner} never misbehaved: the test shows nothing");
        run_ok(folder.path(), &format!("evidence {planner} --out {planner}-pack --no-pdf"));
        let said = run_ok(folder.path(), &format!("verify {planner}-pack --sample 36"));
        let wanted = format!(
            "in processes of their own: {lost} of {lost} in which the planner hangs or dies; 0 \
             end otherwise"
        );
        assert!(said.contains(&wanted), "{said}");
        assert!(said.contains("at most 0.000 % of all 36 encounters"), "{said}");
        let page = text(folder.path().join(format!("{planner}-pack/evidence.html")));
        let hung = format!("{lost} ended by a limit on the wall clock");
        assert_eq!(page.contains(&hung), outcome.is_wall_clock(), "{planner}");
    }
}

#[test]
fn a_pack_shows_its_sweeps_and_what_changed_since_the_pack_before() {
    let folder = tempfile::tempdir().unwrap();
    let campaign = "campaign laboratory --planner zhuang --quiet";
    run_ok(folder.path(), &format!("{campaign} --encounters 3 --out before"));
    run_ok(folder.path(), "evidence before --out before-pack --no-pdf");
    run_ok(folder.path(), &format!("{campaign} --encounters 4 --out now"));
    run_ok(folder.path(), "judge now --sweep head_on_half_angle_deg=5,22.5 --quiet");
    run_ok(folder.path(), "evidence now --out pack --previous before-pack --no-pdf");
    let said = run_ok(folder.path(), "verify pack --sample 10");
    assert!(said.contains("verify: ok"), "{said}");
    let pack = folder.path().join("pack");
    let page = text(pack.join("evidence.html"));

    let broken = |summary: &Path| -> u64 {
        let strata = json(summary)["strata"].as_array().unwrap().clone();
        strata.iter().map(|s| s["safety_radius"]["k"].as_u64().unwrap()).sum()
    };
    let before = broken(&pack.join("previous/summary.json"));
    let now = broken(&pack.join("result/summary.json"));
    let cells = format!(
        "<td>safety radius broken</td><td class=\"n\">{before} of 27</td>\
         <td class=\"n\">{now} of 36</td>"
    );
    assert!(page.contains(&cells), "no {cells}");
    let manifest = fs::read(folder.path().join("before-pack/manifest.json")).unwrap();
    assert!(manifest == fs::read(pack.join("previous/manifest.json")).unwrap());

    let sweep = "sensitivity/sweep-head_on_half_angle_deg.json";
    let points = json(pack.join(sweep))["points"].as_array().unwrap().clone();
    let changed: Vec<String> =
        points.iter().map(|p| format!("<td class=\"n\">{}</td>", p["class_changed"])).collect();
    assert_eq!(changed.len(), 3);
    let row = format!("<td>class differs</td>{}", changed.concat());
    assert!(page.contains(&row) && page.contains(sweep), "no {row}");

    // what a pack tells its reader to do leaves it whole
    let said = run_ok(folder.path(), "replay pack/result head_on/000001");
    assert!(said.contains("the same bits") && said.contains("pack-replay"), "{said}");
    assert!(folder.path().join("pack-replay/head_on-000001.svg").exists());
    let said = run_err(folder.path(), "judge pack/result --rules usv-ccta2023-v1", 2);
    assert!(said.contains("part of the pack"), "{said}");
    run_ok(folder.path(), "verify pack --sample 1");

    for file in ["previous/summary.json", sweep] {
        let path = pack.join(file);
        let good = fs::read(&path).unwrap();
        let mut bad = good.clone();
        bad[good.len() / 2] ^= 1;
        fs::write(&path, bad).unwrap();
        let output = run(folder.path(), "verify pack --sample 1");
        let said = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(&format!("  {file}: ")), "{said}");
        fs::write(&path, good).unwrap();
    }

    // a sweep of other runs has no place in a pack
    let judged = folder.path().join("before/judged-usv-oe2023-v1");
    fs::create_dir(&judged).unwrap();
    fs::copy(pack.join(sweep), judged.join("sweep-head_on_half_angle_deg.json")).unwrap();
    let said = run_err(folder.path(), "evidence before --out third --no-pdf", 2);
    assert!(said.contains("sweep of other runs"), "{said}");
    assert!(!folder.path().join("third").exists());
}
