//! Do tracks stay with their targets? Sails a campaign's encounters straight on and compares every
//! track that a planner is shown with the truth:
//! `cargo run --config .cargo/optimised.toml -p campaign --example tracking -- 10000 open-sea`.
//!
//! A track belongs to the target that it was near for five beats on end (within three standard
//! deviations). It has diverged when it is shown for twenty beats on end farther from her than
//! 100 m and than five standard deviations of its own covariance.
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
    println!("tracks that diverged: {}", all.iter().map(|f| f.diverged.len()).sum::<usize>());
    for line in all.iter().flat_map(|f| &f.diverged).take(60) {
        println!("  {line}");
    }
    let (shown, held) = all.iter().fold((0, 0), |sum, f| (sum.0 + f.beats, sum.1 + f.held));
    println!("beats since the first track: {shown}, with a track: {}", share(held, shown));
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
    /// Beats since then, and those of them with a track of hers.
    beats: u64,
    held: u64,
    /// Of each such track and beat: distance from the truth, and that by the covariance.
    off_m: Vec<f64>,
    error: Vec<f64>,
    /// Tracks that left her.
    diverged: Vec<String>,
}

/// A track as it was followed so far.
#[derive(Default)]
struct Track {
    near: u32,
    astray: u32,
    hers: bool,
    said: bool,
}

/// Squared distance of a track from a place, by the covariance of the track.
fn normalised(track: &TargetTrack, place_m: Vec2) -> f64 {
    let off_m = track.position_m - place_m;
    let [[a, b, ..], [_, c, ..], ..] = track.covariance;
    let (x, y) = (off_m.x, off_m.y);
    (c * x * x - 2.0 * b * x * y + a * y * y) / (a * c - b * b)
}

fn follow(encounter: &Encounter, trace: &Trace, seen: &[Vec<TargetTrack>]) -> Vec<Followed> {
    let mut all = Vec::new();
    for target in &trace.targets {
        let mut followed = Followed::default();
        let mut tracks: BTreeMap<u32, Track> = BTreeMap::new();
        for (beat, shown) in seen.iter().enumerate().take(target.north_m.len()) {
            let t_s = encounter.run.beat_s * beat as f64;
            let mut any = false;
            for track in shown {
                let off_m = track.position_m - target.position_m(beat);
                let error = normalised(track, target.position_m(beat));
                let known = tracks.entry(track.id).or_default();
                known.near = if error <= NEAR_SD * NEAR_SD { known.near + 1 } else { 0 };
                known.hers |= known.near >= NEAR_BEATS;
                if !known.hers {
                    continue;
                }
                any = true;
                followed.off_m.push(off_m.norm());
                followed.error.push(error);
                let astray = error > ASTRAY_SD * ASTRAY_SD && off_m.norm() > ASTRAY_M;
                known.astray = if astray { known.astray + 1 } else { 0 };
                if known.astray == ASTRAY_BEATS && !known.said {
                    known.said = true;
                    let (id, intent) = (&encounter.id, encounter.targets[all.len()].intent.name());
                    // another track that is with her, to within three standard deviations
                    let twin = shown.iter().any(|other| {
                        other.id != track.id && normalised(other, target.position_m(beat)) < 9.0
                    });
                    let what = format!(
                        "{id} at {t_s} s: {:.0} m, {intent}, not fed for {:.0} s{}",
                        off_m.norm(),
                        track.since_update_s,
                        if twin { ", beside a track of hers" } else { "" }
                    );
                    followed.diverged.push(what);
                }
            }
            if any && followed.first_s.is_none() {
                followed.first_s = Some(t_s);
            }
            followed.beats += u64::from(followed.first_s.is_some());
            followed.held += u64::from(any);
        }
        all.push(followed);
    }
    all
}
