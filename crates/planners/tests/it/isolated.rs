//! F5, F12 and F19, each alone: a test that fails if, and only if, that property is repaired. Every
//! repair is applied to the paper's planner by itself, and must take away its own property and
//! leave the others.

use crate::random::encounter;
use crate::scene::{Scene, Vessel, course_speed};
use geom::{EncounterClass, math, units::deg, wrap};
use planner_api::{
    Command, Mission, OwnState, Planner, PlannerEvents, PlannerStream, Situation, TargetTrack,
};
use planners::zhuang::{Memory, Reference, Zhuang, ZhuangOptions};

/// What is repaired, all else being the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Repair {
    /// Nothing.
    Nothing,
    /// F1: class and side are kept.
    Memory,
    /// F5: the planned distance has a margin.
    Margin,
    /// F12: the most urgent obstacle comes first.
    Urgency,
    /// F19: the order is found where the ship will be when half of the turn is done.
    ShipModel,
}

const REPAIRS: [Repair; 5] =
    [Repair::Nothing, Repair::Memory, Repair::Margin, Repair::Urgency, Repair::ShipModel];
const MARGIN: f64 = 1.3;

/// The paper's planner with one repair; `passes` is the cap of its inner loop.
fn repaired(repair: Repair, passes: u32) -> Box<dyn Planner> {
    let paper = ZhuangOptions { inner_loop_cap: passes, ..ZhuangOptions::default() };
    let options = match repair {
        Repair::Nothing | Repair::ShipModel => paper,
        Repair::Memory => ZhuangOptions { memory: Memory::Latched, ..paper },
        Repair::Margin => ZhuangOptions { radius_factor: MARGIN, ..paper },
        Repair::Urgency => ZhuangOptions { reference: Reference::MostUrgent, ..paper },
    };
    let zhuang = Zhuang::new(options);
    if repair == Repair::ShipModel {
        return Box::new(Foresees { zhuang, yaw_rate_radps: 1.0 });
    }
    Box::new(zhuang)
}

/// The planner, shown the scene as it will be when half of its own turn is done: a turn at a
/// limited rate is very nearly one at once after half of its time.
struct Foresees {
    zhuang: Zhuang,
    yaw_rate_radps: f64,
}

impl Planner for Foresees {
    fn reset(&mut self, mission: &Mission) {
        self.zhuang.reset(mission);
        self.yaw_rate_radps = mission.own.yaw_rate_radps_max;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let own = situation.own;
        let mut half_s = 0.0;
        for _ in 0..20 {
            let tracks = sailed(situation.tracks, half_s);
            let later = Situation { own: own_later(own, half_s), tracks: &tracks, ..*situation };
            // a copy is asked, so that its memory sees one scene a beat
            let (course_rad, _) = course_speed(self.zhuang.clone().plan(&later), own.cog_rad);
            half_s = 0.5 * wrap(course_rad - own.cog_rad).abs() / self.yaw_rate_radps;
        }
        let tracks = sailed(situation.tracks, half_s);
        self.zhuang.plan(&Situation { own: own_later(own, half_s), tracks: &tracks, ..*situation })
    }

    fn events(&self) -> PlannerEvents {
        self.zhuang.events()
    }
}

fn own_later(own: OwnState, for_s: f64) -> OwnState {
    OwnState { position_m: own.position_m + own.velocity_mps * for_s, ..own }
}

fn sailed(tracks: &[TargetTrack], for_s: f64) -> Vec<TargetTrack> {
    let later = |track: &TargetTrack| {
        let position_m = track.position_m + track.velocity_mps * for_s;
        TargetTrack { position_m, ..*track }
    };
    tracks.iter().map(later).collect()
}

/// F5: where the planner does what it means to, it passes at R and no farther.
fn passes_at_r(repair: Repair) -> bool {
    let mut stream = PlannerStream::new(5);
    let (mut seen, mut at_r) = (0, 0);
    while seen < 40 {
        let (scene, class) = encounter(&mut stream);
        if !matches!(class, EncounterClass::CrossingStbd | EncounterClass::Overtaking) {
            continue;
        }
        seen += 1;
        let run = Scene { target_length_m: None, ..scene }.run(repaired(repair, 50).as_mut());
        at_r += u32::from((run.range_m_min() - 150.0).abs() < 2.0);
    }
    println!("{repair:?}: {at_r} of {seen} pass at R");
    at_r > 36
}

/// F12: of a target 33 s off that needs 6 degrees to starboard and one 52 s off that needs 39 to
/// port, the first pass serves the second alone.
fn serves_the_largest_turn(repair: Repair) -> bool {
    let at = |range_m: f64, bearing_deg: f64, speed_mps: f64, course_deg: f64| {
        let (y, x) = math::sin_cos(deg(bearing_deg));
        Vessel(range_m * x, range_m * y, speed_mps, course_deg)
    };
    let (urgent, later) = (at(300.0, 77.0, 6.0, 180.0), at(420.0, 116.0, 1.0, 0.0));
    let first_pass = |targets: &[Vessel]| {
        let scene = Scene { detection_m: f64::INFINITY, ..Scene::paper(6000.0, targets) };
        scene.first_order(repaired(repair, 1).as_mut()).0
    };
    let both = first_pass(&[urgent, later]);
    let of = |alone: Vessel| (both - first_pass(&[alone])).abs() < 1e-9;
    assert!(of(urgent) != of(later), "{repair:?}: one of the two is the reference");
    of(later)
}

/// F19: the order for a ship that turns by 2 degrees a second is that for one that turns at once.
/// What that costs is in `findings`.
fn orders_as_if_she_turned_at_once(repair: Repair) -> bool {
    let course_deg = |turn_rate_deg: f64| {
        let met = Vessel(0.0, 600.0, 6.0, -90.0);
        let scene = Scene { turn_rate_deg, ..Scene::paper(6000.0, &[met]) };
        scene.first_order(repaired(repair, 50).as_mut()).0.to_degrees()
    };
    let (at_once, slowly) = (course_deg(60.0), course_deg(2.0));
    assert!(at_once > 2.0 && slowly > at_once - 1e-9, "{repair:?}: {at_once} {slowly}");
    slowly - at_once < 1.0
}

#[test]
fn f5_is_repaired_by_a_margin_and_by_nothing_else() {
    for repair in REPAIRS {
        assert_eq!(passes_at_r(repair), repair != Repair::Margin, "{repair:?}");
    }
}

#[test]
fn f12_is_repaired_by_urgency_and_by_nothing_else() {
    for repair in REPAIRS {
        assert_eq!(serves_the_largest_turn(repair), repair != Repair::Urgency, "{repair:?}");
    }
}

#[test]
fn f19_is_repaired_by_a_model_of_the_ship_and_by_nothing_else() {
    for repair in REPAIRS {
        assert_eq!(
            orders_as_if_she_turned_at_once(repair),
            repair != Repair::ShipModel,
            "{repair:?}"
        );
    }
}
