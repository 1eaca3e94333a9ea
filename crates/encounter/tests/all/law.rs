//! The law of every variable, by the Kolmogorov-Smirnov test at a fixed seed.
//!
//! The limits are those of a significance of one in a thousand; the seed is fixed, so each test
//! either always passes or always fails.

use crate::common::{campaign, generator, model};
use encounter::Model;
use geom::units::{deg, to_deg};
use geom::{EncounterClass, HeadOnSector, Relative, Vec2, classify, unit, wrap};
use record::{Encounter, EncounterId, Purpose, Seed, Stream, Streams};

const N: u64 = 4000;
const SEED: Seed = Seed(4711);
/// Kolmogorov's distribution is at 0.999 there.
const LIMIT: f64 = 1.95;

fn draws(name: &str, stratum: usize) -> Vec<Encounter> {
    let generator = generator(name);
    (0..N).map(|j| generator.draw(SEED, stratum, j).unwrap().encounter).collect()
}

/// Largest gap between the sample's distribution and the uniform one, times the root of its size.
fn gap_from_uniform(mut values: Vec<f64>, low: f64, high: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let gap = |(i, value): (usize, &f64)| {
        let at = (value - low) / (high - low);
        (at - i as f64 / n).abs().max((at - (i + 1) as f64 / n).abs())
    };
    values.iter().enumerate().map(gap).fold(0.0, f64::max) * n.sqrt()
}

/// Largest gap between two samples' distributions, scaled likewise.
fn gap_between(mut a: Vec<f64>, mut b: Vec<f64>) -> f64 {
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    let below = |list: &[f64], value: f64| list.partition_point(|x| *x <= value) as f64;
    let (n, m) = (a.len() as f64, b.len() as f64);
    let gap = a
        .iter()
        .chain(&b)
        .map(|&value| (below(&a, value) / n - below(&b, value) / m).abs())
        .fold(0.0, f64::max);
    gap * (n * m / (n + m)).sqrt()
}

/// Place of the time to CPA in what range and time limits allow, from the encounter alone.
fn share(encounter: &Encounter, model: &Model) -> f64 {
    let (own, target) = (&encounter.own.start, &encounter.targets[0].start);
    let relative_mps = unit(own.psi_rad) * own.speed_mps - unit(target.psi_rad) * target.speed_mps;
    let asked = encounter.asked.unwrap();
    let geometry = &model.geometry;
    let nearest_m =
        geometry.range_m_min_beyond_half_length + encounter.targets[0].hull.length_m / 2.0;
    let at_range_s = |range_m: f64| {
        (range_m * range_m - asked.miss_m * asked.miss_m).sqrt() / relative_mps.norm()
    };
    let from_s = at_range_s(nearest_m).max(geometry.tcpa_s[0]);
    let to_s = at_range_s(geometry.range_m_max).min(geometry.tcpa_s[1]);
    (asked.tcpa_s - from_s) / (to_s - from_s)
}

#[test]
fn given_variables_are_uniform_in_every_class() {
    let model = model(&campaign("laboratory"));
    for stratum in 0..5 {
        let drawn = draws("laboratory", stratum);
        let of = |f: &dyn Fn(&Encounter) -> f64| drawn.iter().map(f).collect::<Vec<f64>>();
        let name = &drawn[0].id.stratum;
        for (what, values, low, high) in [
            ("miss", of(&|e| e.asked.unwrap().miss_m), -150.0, 150.0),
            ("own speed", of(&|e| e.own.start.speed_mps), 5.0, 9.0),
            ("length", of(&|e| e.targets[0].hull.length_m), 8.0, 120.0),
            ("time", of(&|e| share(e, &model)), 0.0, 1.0),
        ] {
            let gap = gap_from_uniform(values, low, high);
            assert!(gap < LIMIT, "{name}: {what} {gap}");
        }
    }
}

/// What is given is what the streams give first, whatever the class makes of the rest: own speed
/// from the stream of ship 0; length and miss distance from that of ship 1 (the beam is constant).
#[test]
fn given_variables_are_the_first_draws_of_their_streams() {
    for stratum in 0..5 {
        for encounter in &draws("laboratory", stratum)[..500] {
            let streams = Streams::new(SEED, &encounter.id);
            let speed_mps = streams.stream(Purpose::Geometry, 0).uniform_in(5.0, 9.0);
            assert_eq!(encounter.own.start.speed_mps.to_bits(), speed_mps.to_bits());
            let mut stream = streams.stream(Purpose::Geometry, 1);
            let length_m = stream.uniform_in(8.0, 120.0);
            assert_eq!(encounter.targets[0].hull.length_m.to_bits(), length_m.to_bits());
            let miss_m = stream.uniform_in(-150.0, 150.0);
            assert_eq!(encounter.asked.unwrap().miss_m.to_bits(), miss_m.to_bits());
        }
    }
}

#[test]
fn the_papers_world_has_its_laws() {
    let model = model(&campaign("paper-random"));
    for stratum in 0..5 {
        let drawn = draws("paper-random", stratum);
        let of = |f: &dyn Fn(&Encounter) -> f64| drawn.iter().map(f).collect::<Vec<f64>>();
        let pi = std::f64::consts::PI;
        for (what, values, low, high) in [
            ("miss", of(&|e| e.asked.unwrap().miss_m), -135.0, 135.0),
            ("own heading", of(&|e| e.own.start.psi_rad), -pi, pi),
            ("time", of(&|e| share(e, &model)), 0.0, 1.0),
        ] {
            let gap = gap_from_uniform(values, low, high);
            assert!(gap < LIMIT, "{}: {what} {gap}", drawn[0].id.stratum);
        }
        let speeds = match stratum {
            3 => 1.5..6.5,
            4 => 9.0..14.0,
            _ => 2.0..10.0,
        };
        assert!(drawn.iter().all(|e| speeds.contains(&e.targets[0].start.speed_mps)));
        let widest_deg = [10.0, 180.0, 180.0, 67.5, 67.5][stratum];
        let centre_deg = if stratum == 0 { 180.0 } else { 0.0 };
        assert!(drawn.iter().all(|e| {
            let course_rad = e.targets[0].start.psi_rad - e.own.start.psi_rad;
            to_deg(wrap(course_rad - deg(centre_deg))).abs() <= widest_deg + 1e-9
        }));
    }
}

/// Target speed and relative course by plain rejection over the whole circle, from the words of the
/// module documentation and without its geometry of arcs.
fn by_plain_rejection(class: EncounterClass, stream: &mut Stream) -> (f64, f64) {
    let own_mps = stream.uniform_in(5.0, 9.0);
    let length_m = stream.uniform_in(8.0, 120.0);
    let miss_m = stream.uniform_in(-150.0, 150.0);
    let share = stream.uniform();
    let nearest_m = 375.0 + length_m / 2.0;
    loop {
        let speed_mps = stream.uniform_in(1.0, 12.0);
        let course_rad = stream.uniform_in(-std::f64::consts::PI, std::f64::consts::PI);
        let u = Vec2::new(own_mps, 0.0) - unit(course_rad) * speed_mps;
        let way_m = |range_m: f64| (range_m * range_m - miss_m * miss_m).sqrt();
        let from_s = (way_m(nearest_m) / u.norm()).max(90.0);
        let to_s = (way_m(3000.0) / u.norm()).min(300.0);
        if from_s >= to_s {
            continue;
        }
        let place_m =
            u * (from_s + share * (to_s - from_s)) + Vec2::new(-u.y, u.x) * (miss_m / u.norm());
        let lie = Relative::new(Vec2::zeros(), 0.0, place_m, course_rad);
        if classify(lie.beta_rad, lie.alpha_rad, HeadOnSector::wide(deg(13.0))) == class {
            return (speed_mps, course_rad);
        }
    }
}

/// To draw courses from an arc must leave the law as it is.
#[test]
fn target_speed_and_course_are_those_of_plain_rejection() {
    use EncounterClass::{CrossingPort, CrossingStbd, HeadOn, Overtaken, Overtaking};
    let classes = [HeadOn, CrossingStbd, CrossingPort, Overtaking, Overtaken];
    for (stratum, class) in classes.into_iter().enumerate() {
        let id = EncounterId::new("plain", stratum as u64);
        let mut stream = Streams::new(Seed(5), &id).stream(Purpose::Geometry, 0);
        let plain: Vec<(f64, f64)> =
            (0..N).map(|_| by_plain_rejection(class, &mut stream)).collect();
        let drawn = draws("laboratory", stratum);
        // head-on courses lie around 180 degrees, so courses are counted from there
        let turned = |course_rad: f64| wrap(course_rad - std::f64::consts::PI);
        let speeds = gap_between(
            drawn.iter().map(|e| e.targets[0].start.speed_mps).collect(),
            plain.iter().map(|p| p.0).collect(),
        );
        let courses = gap_between(
            drawn.iter().map(|e| turned(e.targets[0].start.psi_rad)).collect(),
            plain.iter().map(|p| turned(p.1)).collect(),
        );
        assert!(speeds < LIMIT && courses < LIMIT, "{class:?}: {speeds} {courses}");
    }
}

#[test]
fn both_sides_of_a_border_are_equally_likely() {
    for stratum in 5..9 {
        let drawn = draws("laboratory", stratum);
        let name = drawn[0].id.stratum.to_string();
        let first = match name.as_str() {
            "boundary_head_on" => EncounterClass::HeadOn,
            "boundary_bow" => EncounterClass::CrossingStbd,
            "boundary_overtaking" => EncounterClass::Overtaking,
            _ => EncounterClass::Overtaken,
        };
        let k = drawn.iter().filter(|e| e.asked.unwrap().class == first).count() as f64;
        let n = N as f64;
        // 3.3 standard deviations of a fair coin, one in a thousand
        assert!((k - n / 2.0).abs() < 3.3 * (n / 4.0).sqrt(), "{name}: {k} of {n}");
        for (what, values, low, high) in [
            ("own speed", drawn.iter().map(|e| e.own.start.speed_mps).collect(), 5.0, 9.0),
            ("length", drawn.iter().map(|e| e.targets[0].hull.length_m).collect(), 8.0, 120.0),
        ] {
            let gap = gap_from_uniform(values, low, high);
            assert!(gap < LIMIT, "{name}: {what} {gap}");
        }
    }
}

/// The world has no preferred hand: what crosses from starboard is the mirror image of what crosses
/// from port, and the other classes are their own.
#[test]
fn port_and_starboard_are_mirror_images() {
    let side = |e: &Encounter, sign: f64| sign * e.targets[0].start.position_m.y;
    let gap = gap_between(
        draws("laboratory", 1).iter().map(|e| side(e, 1.0)).collect(),
        draws("laboratory", 2).iter().map(|e| side(e, -1.0)).collect(),
    );
    assert!(gap < LIMIT, "crossing {gap}");
    for stratum in [0, 3, 4, 5, 7, 8] {
        let drawn = draws("laboratory", stratum);
        let k = drawn.iter().filter(|e| side(e, 1.0) > 0.0).count() as f64;
        let n = N as f64;
        assert!((k - n / 2.0).abs() < 3.3 * (n / 4.0).sqrt(), "{}: {k}", drawn[0].id.stratum);
    }
}
