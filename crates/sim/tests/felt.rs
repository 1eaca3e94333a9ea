//! Current, gusts and waves as a ship feels them, against what the campaign declares: each process
//! has the spread and the memory of its own parameters, and waves move a long ship less.

mod scenes;

use geom::{Vec2, math, units::deg};
use record::{Fluctuation, Waves, Weather, Wind};
use scenes::{Meeting, kinematic};
use sim::weather::Environment;

const WORLDS: u64 = 3000;

/// North and east, m/s, and yaw, rad/s, of own ship and of the target, both lying still with their
/// bows to the north.
type Felt = [[f64; 3]; 2];

/// What the weather does to both at time 0 and `later_s` after, in one world after another. The
/// target is 40 m long.
fn felt(weather: Weather, later_s: u32) -> Vec<[Felt; 2]> {
    let mut encounter = Meeting::default().encounter(kinematic(), kinematic());
    encounter.weather = weather;
    encounter.own.start.speed_mps = 0.0;
    encounter.targets[0].start.speed_mps = 0.0;
    encounter.targets[0].start.psi_rad = 0.0;
    let worlds = (0..WORLDS).map(|j| {
        encounter.id.j = j;
        let mut environment = Environment::new(&encounter);
        let (mut own, mut targets) = environment.ships(&encounter).expect("known models");
        let mut after = |beats: u32| {
            (0..beats).for_each(|_| environment.advance());
            environment.apply(0, &mut own);
            environment.apply(1, &mut targets[0]);
            [&own, &targets[0]].map(|ship| {
                let over_ground_mps = ship.pose.velocity_mps;
                [over_ground_mps.x, over_ground_mps.y, ship.pose.yaw_rate_radps]
            })
        };
        [after(1), after(later_s)]
    });
    worlds.collect()
}

/// Mean, spread and correlation with what came later lie within 4.5 standard errors of `mean`, `sd`
/// and 1 / e.
fn assert_process(what: &str, pairs: &[(f64, f64)], mean: f64, sd: f64) {
    let n = pairs.len() as f64;
    let off = |v: f64| (v - mean) / sd;
    let average = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / n;
    let (kept, bound) = (math::exp(-1.0), 4.5 / n.sqrt());
    let found = average(&|p| off(p.0));
    assert!(found.abs() < bound, "{what}: mean off by {found} sd");
    for (when, square) in [
        ("at first", average(&|p| off(p.0) * off(p.0))),
        ("later", average(&|p| off(p.1) * off(p.1))),
    ] {
        assert!((square - 1.0).abs() < bound * 2f64.sqrt(), "{what}, {when}: {square} sd^2");
    }
    let found = average(&|p| off(p.0) * off(p.1));
    assert!((found - kept).abs() < bound * (1.0 + kept * kept).sqrt(), "{what}: {found} kept");
}

fn pairs(worlds: &[[Felt; 2]], ship: usize, axis: usize) -> Vec<(f64, f64)> {
    worlds.iter().map(|[first, later]| (first[ship][axis], later[ship][axis])).collect()
}

#[test]
fn a_current_has_its_spread_and_is_one_for_all_ships() {
    let noise = Fluctuation { sd_mps: 0.1, time_constant_s: 40.0 };
    let current_mps = Vec2::new(0.3, 0.5);
    let worlds =
        felt(Weather { current_mps, current_noise: Some(noise), ..Weather::default() }, 40);
    assert_process("north", &pairs(&worlds, 0, 0), 0.3, 0.1);
    assert_process("east", &pairs(&worlds, 0, 1), 0.5, 0.1);
    for [own, target] in worlds.iter().flatten() {
        for (own, target) in own.iter().zip(target) {
            assert!((own - target).abs() < 1e-12, "{own} {target}");
        }
    }
}

/// A gust goes along the wind; a ship without areas slides by the share of it across her heading.
#[test]
fn gusts_have_the_spread_of_their_share_across_the_heading() {
    let gusts = Fluctuation { sd_mps: 2.0, time_constant_s: 15.0 };
    let wind = Wind { velocity_mps: Vec2::new(-6.0, 8.0), gusts, leeway: 0.03 };
    let worlds = felt(Weather { wind: Some(wind), ..Weather::default() }, 15);
    for ship in [0, 1] {
        assert_process("abeam", &pairs(&worlds, ship, 1), 0.03 * 8.0, 0.03 * 2.0 * 0.8);
        assert!(pairs(&worlds, ship, 0).iter().all(|(a, b)| a.abs().max(b.abs()) < 1e-12));
    }
}

#[test]
fn waves_have_their_spread_by_length_and_each_ship_has_her_own() {
    let waves = Waves {
        drift_mps: Vec2::new(-0.05, 0.04),
        drift_sd_mps: 0.1,
        yaw_rate_sd_radps: deg(0.5),
        time_constant_s: 6.0,
        length_m_ref: 10.0,
    };
    let worlds = felt(Weather { waves: Some(waves), ..Weather::default() }, 6);
    // shorter than the reference feels all, 40 m a quarter
    for (ship, share) in [(0, 1.0), (1, 0.25)] {
        assert_process("north", &pairs(&worlds, ship, 0), -0.05 * share, 0.1 * share);
        assert_process("east", &pairs(&worlds, ship, 1), 0.04 * share, 0.1 * share);
        assert_process("yaw", &pairs(&worlds, ship, 2), 0.0, deg(0.5) * share);
    }
    for axis in 0..3 {
        let of = |ship| pairs(&worlds, ship, axis).into_iter().map(|(first, _)| first);
        let mean = |ship| of(ship).sum::<f64>() / WORLDS as f64;
        let (own, target) = (mean(0), mean(1));
        let together: f64 = of(0).zip(of(1)).map(|(a, b)| (a - own) * (b - target)).sum();
        let sd = |ship, mean: f64| of(ship).map(|v| (v - mean) * (v - mean)).sum::<f64>().sqrt();
        let correlation = together / (sd(0, own) * sd(1, target));
        assert!(correlation.abs() < 4.5 / (WORLDS as f64).sqrt(), "{axis}: {correlation}");
    }
}
