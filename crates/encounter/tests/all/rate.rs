//! Encounters at the rate of a traffic: their weights against quadrature and against a traffic that
//! is sailed without any.

use crate::common::{campaign, run_settings};
use encounter::encounter_rate::mean_relative_speed_mps;
use encounter::{Drawn, Generator, Model};
use geom::Vec2;
use record::{EncounterId, Intent, Purpose, Seed, Stream, Streams};
use std::f64::consts::{PI, TAU};

const EXTENT_M: f64 = 1500.0;
const CLOSING_MPS_MIN: f64 = 1.5;

/// The open sea with one stratum of any class, at the rate of a traffic.
fn table() -> toml::Table {
    let mut table = campaign("laboratory")["model"].clone().as_table().unwrap().clone();
    let mut set = |key: &str, text: &str| {
        let value = text.parse::<toml::Table>().unwrap()["is"].clone();
        let (parent, last) = key.rsplit_once('.').unwrap_or(("", key));
        let parents = parent.split('.').filter(|part| !part.is_empty());
        let place = parents.fold(&mut table, |t, part| t[part].as_table_mut().unwrap());
        place.insert(last.to_owned(), value);
    };
    set("stratum", "is = [{ name = 'traffic' }]");
    set("geometry.miss_m", "is = { uniform = [-1500.0, 1500.0] }");
    set("geometry.tcpa_s", "is = [60.0, 300.0]");
    set("geometry.range_m_max", "is = 6000.0");
    set("own.speed_mps", "is = { uniform = [5.0, 9.0] }");
    set("target.speed_mps", "is = { triangular = { low = 1.0, mode = 3.0, high = 12.0 } }");
    set(
        "encounter_rate",
        "is = { closing_mps_min = 1.5, miss_m_drawn = [\
         { up_to_m = 150.0, share = 0.5 }, { up_to_m = 500.0, share = 0.3 }, \
         { up_to_m = 1500.0, share = 0.2 }] }",
    );
    table
}

fn generator(table: toml::Table) -> Result<Generator, String> {
    let model: Model = toml::Value::from(table).try_into().map_err(|e| format!("{e}"))?;
    Generator::new(&model, &run_settings(&campaign("laboratory"))).map_err(|e| e.to_string())
}

fn draws(generator: &Generator, n: u64) -> Vec<Drawn> {
    (0..n).map(|j| generator.draw(Seed(31), 0, j).unwrap()).collect()
}

/// `(1 / 2 pi)` times the integral of `|W|` over the circle, by the midpoint rule.
fn by_quadrature(own_mps: f64, target_mps: f64) -> f64 {
    const N: u32 = 200_000;
    let sum: f64 = (0..N)
        .map(|i| {
            let course_rad = TAU * (f64::from(i) + 0.5) / f64::from(N);
            let product = 2.0 * own_mps * target_mps * geom::math::cos(course_rad);
            (own_mps * own_mps + target_mps * target_mps - product).max(0.0).sqrt()
        })
        .sum();
    sum / f64::from(N)
}

#[test]
fn the_mean_relative_speed_is_that_of_quadrature() {
    for (own_mps, target_mps) in [(7.0, 7.0), (8.0, 4.0), (2.0, 8.0), (10.0, 1.0), (5.0, 5.001)] {
        let (analytic, sum) =
            (mean_relative_speed_mps(own_mps, target_mps), by_quadrature(own_mps, target_mps));
        assert!((analytic / sum - 1.0).abs() < 1e-9, "{own_mps}:{target_mps} {analytic} {sum}");
    }
    assert!((mean_relative_speed_mps(6.0, 6.0) - 4.0 * 6.0 / PI).abs() < 1e-12);
    assert!((mean_relative_speed_mps(6.0, 0.0) - 6.0).abs() < 1e-12);
    assert!(mean_relative_speed_mps(0.0, 0.0).abs() < 1e-300);
}

/// The weights have mean 1 and are never above the largest that the generator states.
#[test]
fn weights_have_mean_one() {
    let generator = generator(table()).unwrap();
    let weights: Vec<f64> =
        draws(&generator, 40_000).iter().map(|drawn| drawn.encounter.weight).collect();
    let n = weights.len() as f64;
    let mean = weights.iter().sum::<f64>() / n;
    let variance = weights.iter().map(|w| (w - mean) * (w - mean)).sum::<f64>() / (n - 1.0);
    let error = (variance / n).sqrt();
    assert!((mean - 1.0).abs() < 4.0 * error, "{mean} +- {error}");
    // a wrong normalization must show: without it the mean would be some metres a second
    assert!(error < 0.01, "{error}");
    let largest = weights.iter().copied().fold(0.0, f64::max);
    let stated = generator.weight_max(0);
    assert!(largest <= stated && largest > 0.8 * stated, "{largest} {stated}");
}

/// An encounter by what the laws are about.
#[derive(Clone, Copy)]
struct Met {
    own_mps: f64,
    target_mps: f64,
    closing_mps: f64,
    miss_m: f64,
}

type Event = (&'static str, fn(&Met) -> bool);

const EVENTS: [Event; 6] = [
    ("near", |met| met.miss_m.abs() < 100.0),
    ("far", |met| met.miss_m > 700.0),
    ("slow", |met| met.closing_mps < 4.0),
    ("fast and near", |met| met.closing_mps > 10.0 && met.miss_m.abs() < 300.0),
    ("fast own ship", |met| met.own_mps > 8.0),
    ("slow target", |met| met.target_mps < 2.5),
];

/// Ratio of two sums over independent groups, with its standard error.
fn ratio(groups: &[(f64, f64)]) -> (f64, f64) {
    let (top, bottom) = groups.iter().fold((0.0, 0.0), |sum, g| (sum.0 + g.0, sum.1 + g.1));
    let value = top / bottom;
    let squares: f64 = groups.iter().map(|g| (g.0 - value * g.1) * (g.0 - value * g.1)).sum();
    (value, squares.sqrt() / bottom)
}

/// A traffic that nobody has weighted: ships anywhere in a square around own ship, each on her
/// course, and those that come closest to her within the next minute and within the extent.
fn sailed(replica: u64) -> Vec<Met> {
    const SHIPS: u64 = 40;
    const HALF_SIDE_M: f64 = 2100.0;
    const WATCH_S: f64 = 60.0;
    let id = EncounterId::new("a traffic", replica);
    let mut stream = Streams::new(Seed(5), &id).stream(Purpose::Geometry, 0);
    let own_mps = stream.uniform_in(5.0, 9.0);
    let mut met = Vec::new();
    for _ in 0..SHIPS {
        let mut place_m = || stream.uniform_in(-HALF_SIDE_M, HALF_SIDE_M);
        let position_m = Vec2::new(place_m(), place_m());
        let target_mps = triangular(&mut stream);
        let course_rad = TAU * stream.uniform();
        let velocity_mps = geom::unit(course_rad) * target_mps - Vec2::new(own_mps, 0.0);
        let closing_mps = velocity_mps.norm();
        let cpa_s = -position_m.dot(&velocity_mps) / (closing_mps * closing_mps);
        let miss_m = (position_m.x * velocity_mps.y - position_m.y * velocity_mps.x) / closing_mps;
        let counts = (0.0..WATCH_S).contains(&cpa_s) && miss_m.abs() < EXTENT_M;
        if counts && closing_mps >= CLOSING_MPS_MIN {
            met.push(Met { own_mps, target_mps, closing_mps, miss_m });
        }
    }
    met
}

/// The triangular law of the target's speed, by rejection: not as the generator draws it.
fn triangular(stream: &mut Stream) -> f64 {
    let (low, mode, high) = (1.0, 3.0, 12.0);
    loop {
        let (x, height) = (stream.uniform_in(low, high), stream.uniform());
        let density = if x < mode { (x - low) / (mode - low) } else { (high - x) / (high - mode) };
        if height < density {
            return x;
        }
    }
}

#[test]
fn weighted_frequencies_are_those_of_a_traffic_that_is_sailed() {
    let drawn = draws(&generator(table()).unwrap(), 40_000);
    let weighted: Vec<(f64, Met)> = drawn
        .iter()
        .map(|Drawn { encounter, .. }| {
            let (own, target) = (&encounter.own.start, &encounter.targets[0].start);
            let velocity_mps = geom::unit(target.psi_rad) * target.speed_mps
                - geom::unit(own.psi_rad) * own.speed_mps;
            let met = Met {
                own_mps: own.speed_mps,
                target_mps: target.speed_mps,
                closing_mps: velocity_mps.norm(),
                miss_m: encounter.asked.unwrap().miss_m,
            };
            (encounter.weight, met)
        })
        .collect();
    let traffic: Vec<Vec<Met>> = (0..12_000).map(sailed).collect();
    let encounters: usize = traffic.iter().map(Vec::len).sum();
    assert!(encounters > 30_000, "{encounters}");
    for (name, event) in EVENTS {
        let y = |met: &Met| f64::from(u8::from(event(met)));
        let ours: Vec<(f64, f64)> = weighted.iter().map(|(w, met)| (w * y(met), *w)).collect();
        let theirs: Vec<(f64, f64)> = traffic
            .iter()
            .map(|replica| (replica.iter().map(y).sum(), replica.len() as f64))
            .collect();
        let ((ours, e1), (theirs, e2)) = (ratio(&ours), ratio(&theirs));
        let error = (e1 * e1 + e2 * e2).sqrt();
        assert!((ours - theirs).abs() < 4.0 * error, "{name}: {ours} {theirs} +- {error}");
        assert!(error < 0.05 * theirs, "{name}: the test is too weak, {error} of {theirs}");
    }
}

/// Intents that are drawn more often than they are weigh less, and the weighted share is the true.
#[test]
fn intents_that_are_drawn_more_often_weigh_less() {
    let open_sea = campaign("open-sea");
    let mut table = table();
    let target = table["target"].as_table_mut().unwrap();
    for key in ["intent_mix", "conduct"] {
        target.insert(key.to_owned(), open_sea["model"]["target"][key].clone());
    }
    let drawn = "is = { hold_course = 0.2, comply = 0.2, late = 0.2, wrong_way = 0.2, \
                 random = 0.2 }";
    let drawn = drawn.parse::<toml::Table>().unwrap()["is"].clone();
    let rate = table["encounter_rate"].as_table_mut().unwrap();
    rate.insert("intent_mix_drawn".to_owned(), drawn);
    let generator = generator(table).unwrap();
    let groups: Vec<(f64, f64, bool)> = draws(&generator, 20_000)
        .iter()
        .map(|drawn| {
            let random = matches!(drawn.encounter.targets[0].intent, Intent::Turns(_));
            let weight = drawn.encounter.weight;
            (weight * f64::from(u8::from(random)), weight, random)
        })
        .collect();
    let drawn = groups.iter().filter(|g| g.2).count() as f64 / groups.len() as f64;
    assert!((drawn - 0.2).abs() < 0.015, "{drawn}");
    let (share, error) = ratio(&groups.iter().map(|g| (g.0, g.1)).collect::<Vec<_>>());
    assert!((share - 0.05).abs() < 4.0 * error && error < 0.003, "{share} +- {error}");
}

#[test]
fn what_the_weights_would_not_be_right_for_is_refused() {
    let with = |key: &str, text: &str| {
        let mut table = table();
        let value = text.parse::<toml::Table>().unwrap()["is"].clone();
        let (parent, last) = key.split_once('.').unwrap();
        if parent == "stratum" {
            let stratum = table["stratum"].as_array_mut().unwrap();
            stratum[0].as_table_mut().unwrap().insert(last.to_owned(), value);
        } else {
            table[parent].as_table_mut().unwrap().insert(last.to_owned(), value);
        }
        generator(table).unwrap_err()
    };
    let bands = "is = [{ up_to_m = 150.0, share = 0.5 }, { up_to_m = 1500.0, share = 0.4 }]";
    let none = "is = [{ up_to_m = 150.0, share = 1.0 }, { up_to_m = 1500.0, share = 0.0 }]";
    for (key, text, expected) in [
        ("stratum.class", "is = 'head_on'", "`model.stratum.traffic` has a class"),
        (
            "stratum.also",
            "is = [{ class = 'head_on' }]",
            "`model.stratum.traffic` has a class, a border or further targets",
        ),
        (
            "geometry.miss_m",
            "is = { uniform = [-150.0, 150.0] }",
            "`model.geometry.miss_m` must be { uniform = [-1500.0, 1500.0] }",
        ),
        (
            "stratum.relative_course_deg",
            "is = { uniform = [0.0, 90.0] }",
            "must be uniform over the circle",
        ),
        ("encounter_rate.miss_m_drawn", bands, "has shares that sum to 0.9"),
        ("encounter_rate.miss_m_drawn", none, "miss_m_drawn.2.share` = 0 must be over 0"),
        ("encounter_rate.closing_mps_min", "is = 0.5", "= 0.5 times the longest tcpa_s gives 150"),
        ("encounter_rate.closing_mps_min", "is = 25.0", "is never reached"),
        ("geometry.range_m_max", "is = 1800.0", "fast encounters have no start"),
        (
            "encounter_rate.intent_mix_drawn",
            "is = { hold_course = 1.0 }",
            "`model.target.conduct` is missing",
        ),
        ("encounter_rate.weight", "is = 1.0", "unknown field `weight`"),
    ] {
        let said = with(key, text);
        assert!(said.contains(expected), "{key} {text}\n{said}");
    }
}

#[test]
fn a_proposal_inside_the_event_is_warned_of() {
    let run = run_settings(&campaign("laboratory"));
    let warnings = |table: toml::Table| {
        let model: Model = toml::Value::from(table).try_into().unwrap();
        model.warnings(&run)
    };
    assert_eq!(warnings(table()), Vec::<String>::new());
    let narrow = campaign("laboratory")["model"].as_table().unwrap().clone();
    let said = warnings(narrow);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("breaks the safety radius"), "{said:?}");
}
