//! `campaigns/rivals.toml` writes out every parameter of the rivals: as they are without it, and
//! each of them reaches the resolved plan.

use campaign::plan::{Build, Plan};
use campaign::{CampaignFile, Overrides};
use toml::{Table, Value};

const RIVALS: [&str; 3] = ["kuwata-vo", "sb-mpc", "plain-vo"];

fn text(file: &str) -> String {
    let path = format!("{}/../../campaigns/{file}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn plans(file: &Table) -> Vec<Plan> {
    let build = Build {
        tool_version: String::new(),
        git_commit: String::new(),
        git_clean: true,
        engine: String::new(),
        planners: String::new(),
        cargo_lock_sha256: String::new(),
        rustc: String::new(),
    };
    let rules = |name: &str| Ok(text(&format!("rulesets/{name}")));
    let file = CampaignFile::parse(&file.to_string(), "rivals").expect("valid");
    let registry = planners::registry();
    file.resolve(&Overrides::default(), None, &registry, &rules, &build).expect("valid")
}

/// Another value that the planner can take.
fn another(value: &Value) -> Value {
    match value {
        Value::Float(number) => Value::Float(number * 1.04),
        Value::Integer(number) => Value::Integer(number + 1),
        Value::String(word) if word == "mission" => Value::String("centre".to_owned()),
        _ => panic!("{value} is new here"),
    }
}

#[test]
fn every_parameter_of_the_rivals_is_written_out_and_reaches_the_plan() {
    let file: Table = text("rivals").parse().unwrap();
    let written = plans(&file);
    assert_eq!(written.iter().map(|p| &*p.planner.name).collect::<Vec<_>>(), RIVALS);
    let registry = planners::registry();
    for plan in &written {
        let name = &*plan.planner.name;
        let own = file["planner"][name].as_table().unwrap();
        assert_eq!(own, &registry.get(name).unwrap().options, "{name}");
        for (key, value) in own {
            let mut changed = file.clone();
            changed["planner"][name][key] = another(value);
            let of_it = plans(&changed).into_iter().find(|p| p.planner.name == name).unwrap();
            assert_eq!(of_it.planner.options[key], another(value), "{name}.{key}");
            assert_ne!(of_it.hash().unwrap(), plan.hash().unwrap(), "{name}.{key}");
        }
    }
}

#[test]
fn the_rivals_meet_the_encounters_of_quick() {
    let (mut rivals, mut quick): (Table, Table) =
        (text("rivals").parse().unwrap(), text("quick").parse().unwrap());
    rivals.remove("planner");
    for own in ["name", "title", "encounters_per_stratum", "planners"] {
        assert_ne!(rivals.remove(own), quick.remove(own), "{own}");
    }
    assert_eq!(rivals, quick);
}
