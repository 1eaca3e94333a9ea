//! Weather: processes against their own parameters, the same for every planner, and what a ship
//! makes of it.

mod scenes;

use geom::{Vec2, math, units::deg, wrap};
use record::{Encounter, EncounterId, Fluctuation, Purpose, Seed, Streams, Weather, Wind};
use scenes::{Meeting, Orders, hold, kinematic, rough, run, viknes};
use sim::weather::Process;

fn meeting(weather: Weather) -> Encounter {
    let meeting = Meeting { miss_m: 200.0, ..Meeting::default() };
    let mut encounter = meeting.encounter(viknes(), kinematic());
    encounter.weather = weather;
    encounter
}

/// Mean 0, the standard deviation asked for, and the correlation exp(-dt / time constant), within
/// 4.5 standard errors (for an AR(1) process the variance of the mean is that of n independent
/// draws times (1 + r) / (1 - r), that of the variance likewise with r^2).
#[test]
fn processes_have_their_spread_and_their_memory() {
    let mut stream =
        Streams::new(Seed(2), &EncounterId::new("w", 0)).stream(Purpose::Environment, 0);
    let (sd, r) = (0.7, geom::math::exp(-1.0 / 8.0));
    let mut process = Process::new(sd, 8.0, 1.0);
    let values: Vec<f64> = (0..40_000).map(|_| process.next(&mut stream)).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| v * v).sum::<f64>() / n;
    let lag = values.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n;
    assert!(mean.abs() < 4.5 * sd * ((1.0 + r) / (1.0 - r) / n).sqrt(), "{mean}");
    let error = 4.5 * (2.0 / n * (1.0 + r * r) / (1.0 - r * r)).sqrt();
    assert!((variance / (sd * sd) - 1.0).abs() < error, "{variance}");
    assert!((lag / variance - r).abs() < 4.5 * ((1.0 - r * r) / n).sqrt(), "{}", lag / variance);
    // it starts from its stationary law
    let first: f64 = (0..2000u64)
        .map(|j| {
            let id = EncounterId::new("w", j);
            let mut stream = Streams::new(Seed(2), &id).stream(Purpose::Environment, 0);
            let value = Process::new(sd, 8.0, 1.0).next(&mut stream);
            value * value
        })
        .sum();
    assert!((first / 2000.0 / (sd * sd) - 1.0).abs() < 4.5 * (2.0f64 / 2000.0).sqrt(), "{first}");
}

/// Whatever own ship does, a target that does not mind her goes the same way, to the last bit; and
/// one more target changes nobody's weather.
#[test]
fn weather_is_the_same_for_every_planner_and_every_crowd() {
    let encounter = meeting(rough());
    let one = run(&encounter, &mut hold());
    let other = run(&encounter, &mut Orders(vec![(0.0, deg(-60.0), 5.0)]));
    let least = one.samples().min(other.samples());
    assert!(least > 100);
    assert_eq!(one.targets[0].north_m[..least], other.targets[0].north_m[..least]);
    assert_eq!(one.targets[0].psi_rad[..least], other.targets[0].psi_rad[..least]);
    let nominal = sim::nominal(&encounter).unwrap();
    let least = one.samples().min(nominal.own.len());
    assert_eq!(one.targets[0].east_m[..least], nominal.targets[0].east_m[..least]);

    let mut crowded = encounter.clone();
    crowded.targets.insert(1, crowded.targets[0].clone());
    crowded.targets[1].start.position_m += Vec2::new(900.0, 900.0);
    let crowd = run(&crowded, &mut hold());
    let least = one.samples().min(crowd.samples());
    assert_eq!(one.targets[0].north_m[..least], crowd.targets[0].north_m[..least]);
    assert_eq!(one.own.north_m[..least], crowd.own.north_m[..least]);
}

/// Wind on the beam and known current: she crabs, makes good the ordered course in the mean, and
/// heading and course part.
#[test]
fn heading_and_course_part() {
    let steady = Weather { current_mps: Vec2::new(0.0, 1.0), ..Weather::default() };
    for weather in [steady, Weather { waves: None, current_noise: None, ..rough() }] {
        let mut encounter = meeting(weather);
        encounter.targets[0].start.position_m = Vec2::new(0.0, 3000.0);
        encounter.targets[0].start.psi_rad = 0.0;
        encounter.run.duration_s_max = 400.0;
        encounter.run.until = record::RunUntil::TimeIsUp;
        let trace = run(&encounter, &mut hold());
        let (from_m, to_m) = (trace.own.position_m(60), trace.own.position_m(400));
        let made_good_rad = geom::angle::direction(to_m - from_m);
        assert!(made_good_rad.abs() < deg(1.0), "{}", made_good_rad.to_degrees());
        let crab_rad = wrap(trace.own.psi_rad[400] - trace.own.cog_rad(400));
        assert!(crab_rad.abs() > deg(2.0), "{}", crab_rad.to_degrees());
    }
}

/// In steady wind she slides to leeward at the speed at which her damping in sway takes the force
/// of the wind on her side: Blendermann's formula by angles, with the areas and the damping of her
/// source. The share of the wind that the campaign declares for ships without areas is not asked.
#[test]
fn leeway_comes_from_the_areas_of_a_ship() {
    let wind_mps = Vec2::new(-5.0, 8.0);
    let gusts = Fluctuation { sd_mps: 0.0, time_constant_s: 15.0 };
    let wind = Some(Wind { velocity_mps: wind_mps, gusts, leeway: 0.5 });
    let mut encounter = meeting(Weather { wind, ..Weather::default() });
    encounter.targets[0].start.position_m = Vec2::new(0.0, 3000.0);
    encounter.targets[0].start.psi_rad = 0.0;
    encounter.run.duration_s_max = 300.0;
    encounter.run.until = record::RunUntil::TimeIsUp;
    let trace = run(&encounter, &mut hold());
    let over_ground_mps = trace.own.velocity_mps(300);
    let seen = |v: Vec2| geom::angle::rotate(v, -trace.own.psi_rad[300]);
    let leeway_mps = seen(over_ground_mps).y;
    let air_mps = seen(wind_mps - over_ground_mps);
    let gamma_rad = geom::angle::direction(air_mps);
    let (frontal_m2, lateral_m2) = (9.485, 13.308_75);
    let along = 0.55 * frontal_m2 / lateral_m2;
    let sin_double = math::sin(2.0 * gamma_rad);
    let oblique = 0.3 * (1.0 - along / 0.85) * (sin_double * sin_double);
    let coefficient = 0.85 * math::sin(gamma_rad) / (1.0 - oblique);
    let wind_n = 0.5 * 1.225 * air_mps.norm_squared() * coefficient * lateral_m2;
    let damping_n = 200.0 * leeway_mps + 2000.0 * leeway_mps * leeway_mps;
    assert!(leeway_mps > 0.2 && (damping_n / wind_n - 1.0).abs() < 0.02, "{damping_n} {wind_n}");
}

#[test]
fn weather_that_cannot_be_is_refused() {
    let mut weather = rough();
    weather.wind.as_mut().unwrap().gusts.time_constant_s = 0.0;
    let refused = sim::check(&meeting(weather)).unwrap_err().to_string();
    assert_eq!(refused, "the time constant of gusts is 0; it must be finite and above 0");
}
