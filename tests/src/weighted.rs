//! A campaign whose encounters carry weights: its rates are those of the population that it says.

use crate::support::{json, rows, run_err, run_ok};
use std::fs;
use std::path::Path;

const TRAFFIC: &str = include_str!("../../campaigns/traffic.toml");

/// The campaign with one piece of its text changed.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replace(from, to)
}

/// Runs `text` and gives its one stratum's entry of `summary.json`.
fn stratum(folder: &Path, name: &str, text: &str, encounters: u32) -> serde_json::Value {
    fs::write(folder.join(format!("{name}.toml")), text).unwrap();
    let line = format!(
        "campaign {name}.toml --planner hold-course --encounters {encounters} --out {name} --quiet"
    );
    run_ok(folder, &line);
    json(folder.join(name).join("summary.json"))["strata"][0].clone()
}

/// With the same speeds everywhere the weights come from miss distance and intent alone, and a
/// population that draws both as they are has none: there, rates are plain counts.
#[test]
fn weighted_rates_agree_with_those_of_an_unweighted_simulation() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (TRAFFIC.find("[model.sensing.ais]"), TRAFFIC.find("[model.encounter_rate]"));
    let calm = TRAFFIC.replace(&TRAFFIC[from.unwrap()..to.unwrap()], "");
    let calm = changed(&calm, "kind = \"ais_radar\"", "kind = \"perfect\"");
    let calm = changed(&calm, "last_minute = true", "last_minute = false");
    let calm = changed(&calm, "second_judge = true", "second_judge = false");
    let calm = changed(&calm, "{ uniform = [5.0, 9.0] }", "{ constant = 7.0 }");
    let calm =
        changed(&calm, "speed_mps = { uniform = [1.0, 12.0] }", "speed_mps = { constant = 5.0 }");
    let weighted = stratum(folder.path(), "weighted", &calm, 1500);
    let bands = calm.find("miss_m_drawn").unwrap()..calm.find("[[model.stratum]]").unwrap();
    let crude =
        calm.replace(&calm[bands], "miss_m_drawn = [{ up_to_m = 1000.0, share = 1.0 }]\n\n");
    let crude = stratum(folder.path(), "crude", &crude, 1500);
    let all_one =
        rows(&folder.path().join("crude")).iter().all(|row| (row.weight - 1.0).abs() < 1e-9);
    assert!(all_one, "the crude campaign has weights");

    let n = 1500.0;
    for (what, event) in [
        ("breaches", (|row| row.safety_radius_broken) as fn(&record::RunRow) -> bool),
        ("near passes", |row| row.cpa_hull_m.is_some_and(|m| m < 60.0)),
        ("random targets", |row| row.intents == "random" || row.intents == "turns"),
    ] {
        let sums = |name: &str| {
            let values = rows(&folder.path().join(name)).into_iter();
            let values: Vec<f64> =
                values.map(|row| if event(&row) { row.weight } else { 0.0 }).collect();
            let mean = values.iter().sum::<f64>() / n;
            let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
            (mean, square / (n - 1.0) / n)
        };
        let ((ours, v1), (theirs, v2)) = (sums("weighted"), sums("crude"));
        let error = (v1 + v2).sqrt();
        assert!((ours - theirs).abs() < 4.0 * error, "{what}: {ours} {theirs} +- {error}");
        assert!(
            ours > 0.01 && v1 < v2,
            "{what}: {ours}, and the proposal gains nothing: {v1} {v2}"
        );
    }
    // what the summary says is what the rows say, to the width of a bin
    let of = |value: &serde_json::Value| value.as_f64().unwrap();
    let rate = of(&weighted["weighted"]["safety_radius"]["rate"]);
    let crude_k = of(&crude["safety_radius"]["k"]) / n;
    let drawn_k = of(&weighted["safety_radius"]["k"]) / n;
    assert!((rate / crude_k - 1.0).abs() < 0.3 && drawn_k > 1.3 * crude_k, "{rate} {crude_k}");
    let shown = &weighted["weighted"]["safety_radius"];
    assert!(of(&shown["lower_95"]) < crude_k && crude_k < of(&shown["upper_95"]), "{shown}");
    let plain: f64 = rows(&folder.path().join("weighted"))
        .iter()
        .map(|row| if row.safety_radius_broken { row.weight } else { 0.0 })
        .sum();
    assert!((rate / (plain / n) - 1.0).abs() < 1.0 / 512.0, "{rate} {plain}");
}

/// The built-in campaign, on one machine and on three; and what it may not be used for.
#[test]
fn the_traffic_campaign_runs_and_its_shards_merge() {
    const LINE: &str = "campaign traffic --planner hold-course --encounters 510 --quiet";
    let (one, many) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run_ok(one.path(), &format!("{LINE} --out result"));
    for i in 1..=3 {
        run_ok(many.path(), &format!("{LINE} --shard {i}/3 --out result/shard-{i:04}"));
    }
    run_ok(many.path(), "merge result --quiet");
    for file in ["runs.parquet", "summary.json", "report.html", "manifest.json"] {
        let read = |folder: &Path| fs::read(folder.join("result").join(file)).unwrap();
        assert!(read(one.path()) == read(many.path()), "{file} differs");
    }
    let weighted = &json(one.path().join("result/summary.json"))["strata"][0]["weighted"];
    assert!(weighted["weight_max"].as_f64().unwrap() > 1.0, "{weighted}");
    let page = fs::read_to_string(one.path().join("result/report.html")).unwrap();
    assert!(
        page.contains("Rates of the traffic") && !page.contains("Clopper"),
        "of a weighted one"
    );

    let said = run_err(one.path(), "evidence result --out pack", 2);
    assert!(said.contains("model.encounter_rate") && said.contains("evidence pack"), "{said}");
    assert!(!one.path().join("pack").exists());
    let sweep = "judge result --sweep head_on_half_angle_deg=10,13";
    let said = run_err(one.path(), sweep, 2);
    assert!(said.contains("a sweep would count each of them once"), "{said}");
    run_ok(one.path(), "judge result --rules usv-ccta2023-v1 --quiet");
    let again = one.path().join("result/judged-usv-ccta2023-v1/summary.json");
    assert!(json(again)["strata"][0]["weighted"].is_object());
}

/// The gate's rule counts each encounter once.
#[test]
fn the_gate_refuses_weights() {
    let folder = tempfile::tempdir().unwrap();
    let gate = include_str!("../../campaigns/gate.toml");
    let rule = &gate[..gate.find("[[gate.absolute]]").unwrap()];
    let model = &TRAFFIC[TRAFFIC.find("[model.own]").unwrap()..];
    fs::write(folder.path().join("gate.toml"), format!("{rule}{model}")).unwrap();
    let line = "gate --campaign gate.toml --baseline zhuang --candidate zhuang --series x --quiet";
    let said = run_err(folder.path(), line, 2);
    assert!(said.contains("model.encounter_rate") && said.contains("the gate's rule"), "{said}");
}
