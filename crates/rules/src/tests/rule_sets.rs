//! Rule-set files: each is read, and what contradicts itself is refused with the reason.

use super::*;

const FILES: [(&str, &str); 7] = [
    ("usv-oe2023-v1", include_str!("../../../../campaigns/rulesets/usv-oe2023-v1.toml")),
    ("usv-ccta2023-v1", include_str!("../../../../campaigns/rulesets/usv-ccta2023-v1.toml")),
    (
        "merchant-ntnu-ais-v1",
        include_str!("../../../../campaigns/rulesets/merchant-ntnu-ais-v1.toml"),
    ),
    ("merchant-cl-v1", include_str!("../../../../campaigns/rulesets/merchant-cl-v1.toml")),
    ("micro-v1", include_str!("../../../../campaigns/rulesets/micro-v1.toml")),
    ("controls-v1", include_str!("../../../../campaigns/rulesets/controls-v1.toml")),
    ("torben-stl-v1", include_str!("../../../../campaigns/rulesets/torben-stl-v1.toml")),
];

#[test]
fn every_file_is_sound_and_bears_its_name() {
    for (name, text) in FILES {
        let rules = RuleSet::parse(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(rules.name, name);
        assert_eq!(rules.text(), text);
    }
}

/// "each threshold with its source in a comment beside it": a comment above, or above its group.
#[test]
fn every_threshold_has_a_source_above_it() {
    for (name, text) in FILES {
        let body = text.split_once("[risk]").unwrap().1;
        let mut sourced = false;
        for line in body.lines() {
            if line.is_empty() || line.starts_with('[') {
                sourced = false;
            } else if line.starts_with('#') {
                sourced |= ["[T]", "[P]", "[S]", "[D]"].iter().any(|grade| line.contains(grade));
            } else {
                assert!(sourced, "{name}: {line} has no source");
            }
        }
    }
}

/// Values of the table of section 3, typed from it.
#[test]
fn distances_are_those_of_the_table() {
    let expected = [
        ("usv-oe2023-v1", [1900.0, 700.0, 200.0], [200.0, 100.0, 50.0, 35.0], [200.0, 600.0]),
        ("usv-ccta2023-v1", [2500.0, 1100.0, 200.0], [190.0, 100.0, 50.0, 30.0], [190.0, 600.0]),
        (
            "merchant-ntnu-ais-v1",
            [5000.0, 3000.0, 400.0],
            [1500.0, 1000.0, 800.0, 200.0],
            [1500.0, 1800.0],
        ),
    ];
    for (name, stages_m, distances_m, risk) in expected {
        let text = FILES.iter().find(|file| file.0 == name).unwrap().1;
        let rules = RuleSet::parse(text).unwrap();
        let (s, d) = (&rules.stages, &rules.distance);
        assert_eq!([s.r2_m, s.r3_m, s.r4_m].map(f64::to_bits), stages_m.map(f64::to_bits));
        let found_m = [d.r_pref_m, d.r_min_m, d.r_nm_m, d.r_col_m];
        assert_eq!(found_m.map(f64::to_bits), distances_m.map(f64::to_bits));
        let found = [rules.risk.d_risk_m, rules.risk.t_risk_s];
        assert_eq!(found.map(f64::to_bits), risk.map(f64::to_bits));
    }
}

#[test]
fn controls_differ_in_the_limit_of_reaction_alone() {
    let controls = RuleSet::parse(FILES[5].1).unwrap();
    assert_eq!(controls.timing.react_fail_s, Some(45.0));
    let mut same = controls.clone();
    same.timing.react_fail_s = None;
    let default = rules();
    assert_eq!(
        (same.risk, same.stages, same.distance, same.manoeuvre, same.timing),
        (default.risk, default.stages, default.distance, default.manoeuvre, default.timing)
    );
}

#[track_caller]
fn refused(from: &str, to: &str) -> String {
    let text = rules().text().to_owned();
    assert!(text.contains(from), "{from}");
    RuleSet::parse(&text.replacen(from, to, 1)).unwrap_err().to_string()
}

#[test]
fn contradictions_are_refused_with_the_reason() {
    assert!(refused("r_col_m = 35.0", "r_col_m = 60.0").contains("r_col_m < r_nm_m"));
    assert!(refused("r3_m = 700.0", "r3_m = 2000.0").contains("r4_m < r3_m < r2_m"));
    assert!(refused("d_risk_m = 200.0", "d_risk_m = 90.0").contains("would never be a risk"));
    assert!(refused("t_risk_s = 600.0", "t_risk_s = nan").contains("risk.t_risk_s"));
    assert!(refused("t_risk_s = 600.0", "t_risk_s = -1").contains("above 0"));
    assert!(
        refused("apparent_turn_deg = 30.0", "apparent_turn_deg = 9.0")
            .contains("apparent_turn_deg")
    );
    assert!(refused("schema = 1", "schema = 2").contains("schema = 2"));
}

#[test]
fn a_missing_or_unknown_key_names_line_and_allowed_keys() {
    let missing = refused("d_risk_m = 200.0\n", "");
    assert!(missing.contains("missing field `d_risk_m`"), "{missing}");
    let unknown = refused("t_risk_s", "t_rsik_s");
    assert!(unknown.contains("line 16") && unknown.contains("expected one of"), "{unknown}");
    assert!(unknown.contains("`d_risk_m`"), "{unknown}");
    let wrong_type = refused("t_risk_s = 600.0", "t_risk_s = \"long\"");
    assert!(wrong_type.contains("t_risk_s"), "{wrong_type}");
}

#[test]
fn centre_distance_is_refused_inside_the_hulls() {
    assert!(rules().admits_centre_distance(30.0, 40.0).is_ok());
    let error = rules().admits_centre_distance(30.0, 40.1).unwrap_err().to_string();
    assert!(error.contains("lies inside the hulls"), "{error}");
    // and such a run is not judged at all
    let mut trace = Scene::new(own(6.0).hold(500.0), head_on()).centre().trace();
    trace.targets[0].ship.hull.length_m = 100.0;
    let judgement = judge_by(rules(), &trace);
    assert_eq!(verdict(&judgement, Check::R14).status, Status::NotEvaluated);
    assert_eq!(verdict(&judgement, Check::R14).detail, "R_COL-INSIDE-HULLS");
}

#[test]
fn a_sweep_changes_one_number_and_the_name() {
    let swept = rules().with("head_on_half_angle_deg", 22.5).unwrap();
    assert!((swept.head_on().half_angle_rad - deg(22.5)).abs() < 1e-12);
    assert!((swept.head_on().reciprocal_rad - deg(45.0)).abs() < 1e-12);
    assert_eq!(swept.name, "usv-oe2023-v1+head_on_half_angle_deg=22.5");
    assert_ne!(swept.text(), rules().text());
    assert_eq!(RuleSet::parse(swept.text()).unwrap(), swept);
    assert_eq!(rules().with("react_fail_s", 45.0).unwrap().timing.react_fail_s, Some(45.0));
    let error = rules().with("half_angle", 5.0).unwrap_err().to_string();
    assert!(error.contains("head_on_half_angle_deg"), "{error}");
    assert!(rules().with("r_col_m", 500.0).is_err());
}

#[test]
fn profile_by_length() {
    assert_eq!(RuleSet::name_by_length(2.5), "micro-v1");
    assert_eq!(RuleSet::name_by_length(30.0), "usv-oe2023-v1");
    assert_eq!(RuleSet::name_by_length(122.0), "merchant-ntnu-ais-v1");
}
