//! Land in the way: distance, grounding, and what is refused.

mod scenes;

use geom::{HullOutline, Vec2, segment_min_distance};
use planner_api::{Command, Mission, Planner, Situation};
use record::{ContactWith, Encounter, Outcome};
use scenes::{Meeting, Orders, hold, kinematic, run, viknes};

/// Own ship alone, from the origin to the north at 7 m/s, past `hazards`.
fn coast(hazards: &[&[(f64, f64)]]) -> Encounter {
    let mut encounter = Meeting::default().encounter(kinematic(), kinematic());
    encounter.targets.clear();
    encounter.own.route[0].position_m = Vec2::new(1400.0, 0.0);
    let polygon = |corners: &&[(f64, f64)]| corners.iter().map(|&(n, e)| Vec2::new(n, e)).collect();
    encounter.hazards = hazards.iter().map(polygon).collect();
    encounter
}

const PIER: &[(f64, f64)] = &[(700.0, -300.0), (700.0, 300.0), (720.0, 300.0), (720.0, -300.0)];

#[test]
fn running_ashore_is_a_grounding_when_the_bow_touches() {
    let trace = run(&coast(&[PIER]), &mut hold());
    assert_eq!(trace.outcome, Outcome::Grounding);
    let contact = trace.contact.unwrap();
    assert_eq!(contact.with, ContactWith::Hazard(0));
    // the bow is half a length ahead; the sweep stops a millimetre short
    assert!((contact.t_s - (700.0 - 4.225) / 7.0).abs() < 3e-4, "{}", contact.t_s);
    assert!((contact.impact_mps - 7.0).abs() < 1e-6);
    assert!(trace.hazard_m_min.unwrap() <= 0.0);
    // a stop on a wall that does not move: nearly all of m v and m v^2 / 2
    let mass_kg = sim::contact::Inertia::of_outline(&HullOutline::centred(8.45, 2.71)).mass_kg;
    assert!((contact.impulse_ns / (7.0 * mass_kg) - 1.0).abs() < 0.15, "{contact:?}");
    assert!((contact.energy_lost_j / (24.5 * mass_kg) - 1.0).abs() < 0.05, "{contact:?}");
}

#[test]
fn passing_a_headland_keeps_its_distance() {
    let headland: &[(f64, f64)] = &[(700.3, 41.0), (900.0, 500.0), (500.0, 500.0)];
    let trace = run(&coast(&[headland]), &mut hold());
    assert_eq!(trace.outcome, Outcome::Completed);
    let (goal_m, last_m) = (1400.0, *trace.own.north_m.last().unwrap());
    assert!((goal_m - last_m).abs() < 120.0, "{last_m}");
    assert!((trace.hazard_m_min.unwrap() - (41.0 - 1.355)).abs() < 1e-6);
}

/// Weaving past an island with a bay: as near as a search in steps of 20 ms over corners and edges
/// says, whichever model moves her.
#[test]
fn distance_is_that_of_brute_force() {
    let island: &[(f64, f64)] = &[
        (400.0, 60.0),
        (650.0, 45.0),
        (560.0, 120.0),
        (900.0, 70.0),
        (900.0, 400.0),
        (400.0, 400.0),
    ];
    for vessel in [kinematic(), viknes()] {
        let mut encounter = coast(&[island]);
        encounter.own.vessel = vessel;
        let weave = || {
            let order =
                |k: u32| (f64::from(k) * 20.0, if k.is_multiple_of(2) { 0.25 } else { -0.2 }, 6.0);
            Orders((0..12).map(order).collect())
        };
        let least_m = run(&encounter, &mut weave()).hazard_m_min.unwrap();
        encounter.run.step_s = 0.02;
        encounter.run.beat_s = 0.02;
        let fine = run(&encounter, &mut Every(weave(), None));
        let corners = &encounter.hazards[0];
        let mut brute_m = f64::INFINITY;
        for k in 0..fine.samples() {
            let hull = encounter.own.hull.corners_m(fine.own.position_m(k), fine.own.psi_rad[k]);
            brute_m = brute_m.min(gap_m(&hull, corners)).min(gap_m(corners, &hull));
        }
        assert!((least_m - brute_m).abs() < 0.02 && least_m > 1.0, "{least_m} {brute_m}");
    }
}

/// A planner that answers once a second, whatever the beat.
struct Every(Orders, Option<Command>);

impl Planner for Every {
    fn reset(&mut self, mission: &Mission) {
        self.0.reset(mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let off_s = (situation.t_s - situation.t_s.round()).abs();
        if off_s < 1e-9 || self.1.is_none() {
            self.1 = Some(self.0.plan(situation));
        }
        self.1.clone().expect("it was asked at the first beat")
    }
}

fn gap_m(points: &[Vec2], outline: &[Vec2]) -> f64 {
    let mut least_m = f64::INFINITY;
    for point in points {
        for [from, to] in geom::polygon::edges(outline) {
            least_m = least_m.min(segment_min_distance(from - point, to - point).0);
        }
    }
    least_m
}

#[test]
fn what_is_no_polygon_is_refused_with_place_and_reason() {
    let refused = |hazards: &[&[(f64, f64)]]| sim::check(&coast(hazards)).unwrap_err().to_string();
    let bow_tie: &[(f64, f64)] = &[(700.0, 0.0), (720.0, 20.0), (720.0, 0.0), (700.0, 20.0)];
    assert!(refused(&[PIER, bow_tie]).starts_with("hazard 1: edge 1 meets edge 3"));
    assert!(refused(&[&PIER[..2]]).starts_with("hazard 0: has 2 corners"));
    let here: &[(f64, f64)] = &[(-50.0, -50.0), (50.0, -50.0), (0.0, 50.0)];
    assert_eq!(refused(&[PIER, here]), "own ship touches hazard 1 at the start");
    let at_bow: &[(f64, f64)] = &[(4.0, -5.0), (4.0, 5.0), (30.0, 0.0)];
    assert_eq!(refused(&[at_bow]), "own ship touches hazard 0 at the start");
    assert_eq!(refused(&[]), "there is no target and no hazard");
}

/// Hazards draw nothing and change nothing for those who do not touch them.
#[test]
fn far_land_changes_no_ship() {
    let mut encounter =
        Meeting { miss_m: 90.0, ..Meeting::default() }.encounter(viknes(), kinematic());
    let open = run(&encounter, &mut hold());
    encounter.hazards =
        vec![vec![Vec2::new(9000.0, 0.0), Vec2::new(9000.0, 900.0), Vec2::new(9900.0, 0.0)]];
    let coastal = run(&encounter, &mut hold());
    assert_eq!((&open.own, &open.targets), (&coastal.own, &coastal.targets));
    assert!(open.hazard_m_min.is_none() && coastal.hazard_m_min.unwrap() > 1000.0);
}

/// Steers for a point off the easternmost corner of what it was told of, and then on to the north.
#[derive(Default)]
struct RoundsTheHead {
    told: Vec<Vec<Vec2>>,
}

impl Planner for RoundsTheHead {
    fn reset(&mut self, mission: &Mission) {
        self.told.clone_from(&mission.hazards);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let head = self.told.iter().flatten().max_by(|a, b| a.y.total_cmp(&b.y));
        let own_m = situation.own.position_m;
        let course_rad = match head {
            Some(head) if own_m.x < head.x => {
                geom::angle::direction(head + Vec2::new(0.0, 50.0) - own_m)
            }
            _ => 0.0,
        };
        Command::course_speed(course_rad, 7.0)
    }
}

/// A planner is told of land before the first beat, and one that reads it passes clear of a pier on
/// which one that does not runs aground.
#[test]
fn a_planner_that_reads_the_hazards_passes_clear_of_them() {
    let mut encounter = coast(&[PIER]);
    encounter.own.route[0].position_m = Vec2::new(1400.0, 330.0);
    let mut planner = RoundsTheHead::default();
    let trace = run(&encounter, &mut planner);
    assert_eq!(planner.told, encounter.hazards);
    assert_eq!(trace.outcome, Outcome::Completed);
    assert!(trace.hazard_m_min.unwrap() > 25.0, "{:?}", trace.hazard_m_min);
    assert_eq!(run(&encounter, &mut hold()).outcome, Outcome::Grounding);
}
