//! `manoeuvres`: sea trials of every vessel, as a table and a picture.

use crate::exit::Ended;
use crate::say::say_text;
use campaign::Error;
use geom::units::deg;
use report::Trials;
use sim::vessel::trial::{Stop, Turn, ZigZag, crash_stop, turning_circle, zigzag};
use sim::vessel::{Kinematic, Model};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A vessel and what is known of her trials.
struct Vessel {
    name: &'static str,
    model: Model,
    length_m: f64,
    approach_mps: f64,
    /// Where published values were looked for.
    published: &'static str,
}

/// Her trials; `None` for what she could not do.
struct Tried {
    turn: Option<Turn>,
    zigzag: [Option<ZigZag>; 2],
    stop: Option<Stop>,
}

/// Approach speeds: the default campaign's middle, ten knots, the middle of the source, and what
/// the campaigns give a target of 60 m at 6 m/s.
fn vessels() -> Vec<Vessel> {
    let named = |name: &'static str, approach_mps, published| Vessel {
        name,
        model: Model::of(&record::Vessel::Model(name.to_owned())).expect("a name of the list"),
        length_m: sim::vessel::length_m(name).expect("a name of the list"),
        approach_mps,
        published,
    };
    let limits = Kinematic {
        yaw_rate_radps_max: 6.0 / (2.5 * 60.0),
        acceleration_mps2_max: 8.66 * 8.66 / (2.0 * 15.0 * 60.0),
        speed_mps_max: 1.25 * 6.0,
    };
    vec![
        named("viknes", 7.0, "none found"),
        // her damping does not grow with her speed: at ten knots ten degrees do not check a swing
        named("gunnerus", 5.144, "none found"),
        named("frigate", 9.0, "none found"),
        Vessel {
            name: "kinematic",
            model: Model::Kinematic(limits),
            length_m: 60.0,
            approach_mps: 6.0,
            published: "no real ship",
        },
    ]
}

pub(super) fn run(out: Option<&Path>) -> Result<Ended, Error> {
    let vessels = vessels();
    let tried: Vec<Tried> = vessels.iter().map(trials).collect();
    let table = table(&vessels, &tried);
    say_text!("{table}");
    if let Some(out) = out {
        let pictures: Vec<Trials> =
            vessels.iter().zip(&tried).map(|(vessel, tried)| picture(vessel, tried)).collect();
        let fail = |e: std::io::Error| Error::input(format!("cannot write {}: {e}", out.display()));
        fs::create_dir_all(out).map_err(fail)?;
        fs::write(out.join("manoeuvres.md"), table).map_err(fail)?;
        let picture = report::manoeuvres_picture(&pictures);
        fs::write(out.join("manoeuvres.svg"), picture).map_err(fail)?;
    }
    Ok(Ended::Done)
}

fn trials(vessel: &Vessel) -> Tried {
    let (model, speed_mps) = (&vessel.model, vessel.approach_mps);
    Tried {
        turn: turning_circle(model, speed_mps, deg(35.0)),
        zigzag: [10.0, 20.0].map(|angle| zigzag(model, speed_mps, deg(angle))),
        stop: crash_stop(model, speed_mps),
    }
}

const HEAD: &str = "\
| vessel | length m | approach m/s | advance L | transfer L | tactical diameter L | \
final diameter L | speed left % | 10/10 overshoot deg | 20/20 overshoot deg | stop s | \
track reach L | published |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// The standards of resolution MSC.137(76), section 5.3, for ships of 100 m and more.
const STANDARD: &str = "\
| IMO MSC.137(76) | 100 and more | | <= 4.5 | | <= 5 | | | <= 10 to 20, second <= 25 to 40 | \
<= 25 | | <= 15 | |
";

fn table(vessels: &[Vessel], tried: &[Tried]) -> String {
    let mut text = HEAD.to_owned();
    for (vessel, tried) in vessels.iter().zip(tried) {
        let lengths = |m: Option<f64>| number(m.map(|m| m / vessel.length_m), 2);
        let turn = |value: fn(&Turn) -> f64| lengths(tried.turn.as_ref().map(value));
        let overshoot = |zigzag: &Option<ZigZag>| {
            let Some(zigzag) = zigzag else { return "-".to_owned() };
            let [first, second] = zigzag.overshoot_rad.map(|rad| number(Some(rad / deg(1.0)), 1));
            format!("{first}, {second}")
        };
        let row = [
            vessel.name.to_owned(),
            number(Some(vessel.length_m), 2),
            number(Some(vessel.approach_mps), 2),
            turn(|turn| turn.advance_m),
            turn(|turn| turn.transfer_m),
            turn(|turn| turn.tactical_diameter_m),
            turn(|turn| turn.final_diameter_m),
            number(tried.turn.as_ref().map(|turn| 100.0 * turn.speed_share), 0),
            overshoot(&tried.zigzag[0]),
            overshoot(&tried.zigzag[1]),
            number(tried.stop.as_ref().map(|stop| stop.time_s), 1),
            lengths(tried.stop.as_ref().map(|stop| stop.track_reach_m)),
            vessel.published.to_owned(),
        ];
        writeln!(text, "| {} |", row.join(" | ")).expect("a String takes every write");
    }
    text + STANDARD
}

fn number(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"))
}

fn picture(vessel: &Vessel, tried: &Tried) -> Trials {
    let degrees = |zigzag: &Option<ZigZag>| {
        let history = zigzag.iter().flat_map(|zigzag| &zigzag.history);
        history.map(|&[t_s, psi, rudder]| [t_s, psi / deg(1.0), rudder / deg(1.0)]).collect()
    };
    Trials {
        name: vessel.name.to_owned(),
        length_m: vessel.length_m,
        approach_mps: vessel.approach_mps,
        turn_m: tried.turn.as_ref().map_or_else(Vec::new, |turn| turn.track_m.clone()),
        zigzag: [degrees(&tried.zigzag[0]), degrees(&tried.zigzag[1])],
        stop: tried.stop.as_ref().map_or_else(Vec::new, |stop| stop.history.clone()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A model that is added and not tried would be missing here.
    #[test]
    fn every_named_model_is_tried_and_comes_round() {
        let vessels = vessels();
        for name in sim::known_models() {
            assert!(vessels.iter().any(|vessel| vessel.name == name), "{name}");
        }
        for vessel in &vessels {
            let tried = trials(vessel);
            assert!(tried.turn.is_some() && tried.stop.is_some(), "{}", vessel.name);
        }
    }
}
