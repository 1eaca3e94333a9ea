//! Do tracks stay with their ships? Sails a campaign's encounters straight on and compares every
//! track that a planner is shown with the truth:
//! `cargo run --config .cargo/optimised.toml -p campaign --example tracking -- 10000 open-sea`.
//!
//! A track belongs to the ship that it was nearest to for five beats on end, within three standard
//! deviations; one that comes to belong to another has changed ships. A track has diverged when it
//! is shown for twenty beats on end farther from its ship than 100 m and than five standard
//! deviations of its own covariance.
#![forbid(unsafe_code)]

mod common;

use campaign::{Error, Overrides, Plan};
use geom::Vec2;
use planner_api::{Command, Mission, Planner, Situation, TargetTrack};
use rayon::prelude::*;
use record::{Encounter, Trace};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;

const NEAR_SD: f64 = 3.0;
const NEAR_BEATS: u32 = 5;
const ASTRAY_SD: f64 = 5.0;
const ASTRAY_M: f64 = 100.0;
const ASTRAY_BEATS: u32 = 20;

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let encounters: u64 = arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(10_000);
    let campaign = arguments.get(2).map_or("open-sea", String::as_str);
    let file = format!("{}/../../campaigns/{campaign}.toml", env!("CARGO_MANIFEST_DIR"));
    let overrides = Overrides { planners: vec!["hold-course".to_owned()], ..Overrides::default() };
    let plans = common::plans(&file, &overrides, &planners::registry(), |_| {})?;
    let plan = plans.first().ok_or_else(|| Error::Fault("no plan".to_owned()))?;
    let strata = plan.strata.len() as u64;
    let seen = sail(plan, encounters.div_ceil(strata))?;
    println!("{campaign}: {} encounters of {strata} strata", seen.len());
    let all: Vec<&Followed> = seen.iter().flatten().collect();
    let of = |count: &dyn Fn(&Followed) -> bool| all.iter().filter(|f| count(f)).count();
    println!("targets: {}, never tracked: {}", all.len(), of(&|f| f.first_s.is_none()));
    let changed: usize = all.iter().map(|f| f.changed).sum();
    println!("tracks that changed ships: {changed}");
    println!("tracks that diverged: {}", all.iter().map(|f| f.diverged.len()).sum::<usize>());
    for line in all.iter().flat_map(|f| &f.diverged).take(60) {
        println!("  {line}");
    }
    let sum = |part: fn(&Followed) -> u64| all.iter().map(|f| part(f)).sum::<u64>();
    let (shown, held, double) = (sum(|f| f.beats), sum(|f| f.held), sum(|f| f.double));
    println!(
        "beats since the first track: {shown}, with a track: {}, with more than one: {}",
        share(held, shown),
        share(double, shown)
    );
    let mut off_m: Vec<f64> = all.iter().flat_map(|f| f.off_m.iter().copied()).collect();
    let mut error: Vec<f64> = all.iter().flat_map(|f| f.error.iter().copied()).collect();
    println!(
        "mean normalised error of position (2 where the filter is right): {:.2}",
        mean(&error)
    );
    for (what, values) in [("position error, m", &mut off_m), ("normalised error", &mut error)] {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values[((values.len() - 1) as f64 * share) as usize];
        println!(
            "{what}: median {:.1}, 95 % {:.1}, 99 % {:.1}, 99.9 % {:.1}, largest {:.1}",
            at(0.5),
            at(0.95),
            at(0.99),
            at(0.999),
            at(1.0)
        );
    }
    Ok(())
}

fn share(k: u64, n: u64) -> String {
    format!("{:.3} %", 100.0 * k as f64 / n as f64)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Every encounter's targets, in order.
fn sail(plan: &Plan, each: u64) -> Result<Vec<Vec<Followed>>, Error> {
    let ids: Vec<(u32, u64)> =
        (0..plan.strata.len() as u32).flat_map(|s| (0..each).map(move |j| (s, j))).collect();
    let source = plan.encounters_source()?;
    ids.into_par_iter()
        .map_init(sim::Scratch::default, |scratch, (stratum, j)| {
            let encounter = source.draw(stratum, j)?.encounter;
            sim::check(&encounter).map_err(|e| Error::input(e.to_string()))?;
            let mut watch = Watch::default();
            let trace = sim::run(&encounter, &mut watch, scratch, &AtomicU64::new(0));
            Ok(follow(&encounter, &trace, &watch.seen))
        })
        .collect()
}

/// Sails straight on and keeps what it is shown.
#[derive(Default)]
struct Watch {
    order: Option<(f64, f64)>,
    seen: Vec<Vec<TargetTrack>>,
}

impl Planner for Watch {
    fn reset(&mut self, _: &Mission) {
        *self = Self::default();
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        self.seen.push(situation.tracks.to_vec());
        let own = situation.own;
        let (course_rad, speed_mps) = *self.order.get_or_insert((own.psi_rad, own.stw_mps));
        Command::course_speed(course_rad, speed_mps)
    }
}

/// What became of one target's tracks.
#[derive(Default)]
struct Followed {
    /// When a planner was first shown a track of hers.
    first_s: Option<f64>,
    /// Beats since then, those of them with a track of hers, and those with more than one.
    beats: u64,
    held: u64,
    double: u64,
    /// Of each such track and beat: distance from the truth, and that by the covariance.
    off_m: Vec<f64>,
    error: Vec<f64>,
    /// Tracks of hers that became another ship's.
    changed: usize,
    /// Tracks that left her and became nobody's.
    diverged: Vec<String>,
}

/// A track as it was followed so far.
#[derive(Default)]
struct Track {
    /// The ship that it is nearest to, and for how many beats.
    near: Option<usize>,
    near_beats: u32,
    ship: Option<usize>,
    astray_beats: u32,
}

impl Track {
    /// Whose it is after one more beat nearest to `near`, and whose it was if it changed ships.
    fn look(&mut self, near: Option<usize>) -> Option<usize> {
        self.near_beats = if near == self.near { self.near_beats + 1 } else { 1 };
        self.near = near;
        if near.is_none() || near == self.ship || self.near_beats < NEAR_BEATS {
            return None;
        }
        self.astray_beats = 0;
        std::mem::replace(&mut self.ship, near)
    }
}

/// Squared distance of a track from a place, by the covariance of the track.
fn normalised(track: &TargetTrack, place_m: Vec2) -> f64 {
    let off_m = track.position_m - place_m;
    let [[a, b, ..], [_, c, ..], ..] = track.covariance;
    let (x, y) = (off_m.x, off_m.y);
    (c * x * x - 2.0 * b * x * y + a * y * y) / (a * c - b * b)
}

/// The ship nearest to a track, if one is within `NEAR_SD`.
fn nearest(track: &TargetTrack, ships_m: &[Vec2]) -> Option<usize> {
    let errors = ships_m.iter().map(|ship_m| normalised(track, *ship_m)).enumerate();
    let near = errors.filter(|(_, error)| *error <= NEAR_SD * NEAR_SD);
    near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(ship, _)| ship)
}

fn follow(encounter: &Encounter, trace: &Trace, seen: &[Vec<TargetTrack>]) -> Vec<Followed> {
    let mut all: Vec<Followed> = trace.targets.iter().map(|_| Followed::default()).collect();
    let mut tracks: BTreeMap<u32, Track> = BTreeMap::new();
    let beats = trace.targets.iter().map(|t| t.north_m.len()).min().unwrap_or(0);
    for (beat, shown) in seen.iter().enumerate().take(beats) {
        let t_s = encounter.run.beat_s * beat as f64;
        let ships_m: Vec<Vec2> = trace.targets.iter().map(|t| t.position_m(beat)).collect();
        let mut of_ship = vec![0; ships_m.len()];
        for track in shown {
            let known = tracks.entry(track.id).or_default();
            if let Some(left) = known.look(nearest(track, &ships_m)) {
                all[left].changed += 1;
            }
            let Some(ship) = known.ship else { continue };
            let (followed, ship_m) = (&mut all[ship], ships_m[ship]);
            let (off_m, error) = ((track.position_m - ship_m).norm(), normalised(track, ship_m));
            of_ship[ship] += 1;
            followed.off_m.push(off_m);
            followed.error.push(error);
            let astray = error > ASTRAY_SD * ASTRAY_SD && off_m > ASTRAY_M;
            known.astray_beats = if astray { known.astray_beats + 1 } else { 0 };
            if known.astray_beats == ASTRAY_BEATS {
                let (id, intent) = (&encounter.id, encounter.targets[ship].intent.name());
                let not_fed_s = track.since_update_s;
                followed.diverged.push(format!(
                    "{id} at {t_s} s: {off_m:.0} m, {intent}, not fed for {not_fed_s:.0} s{}",
                    if twin(track, shown, ship_m) { ", beside a track of hers" } else { "" }
                ));
            }
        }
        for (followed, of_ship) in all.iter_mut().zip(of_ship) {
            if of_ship > 0 {
                followed.first_s.get_or_insert(t_s);
            }
            followed.beats += u64::from(followed.first_s.is_some());
            followed.held += u64::from(of_ship > 0);
            followed.double += u64::from(of_ship > 1);
        }
    }
    all
}

/// Whether another track is with the ship, to within `NEAR_SD`.
fn twin(track: &TargetTrack, shown: &[TargetTrack], ship_m: Vec2) -> bool {
    let others = shown.iter().filter(|other| other.id != track.id);
    others.into_iter().any(|other| normalised(other, ship_m) <= NEAR_SD * NEAR_SD)
}
