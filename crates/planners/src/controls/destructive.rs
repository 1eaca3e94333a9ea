//! Planners that take the program with them: NaN, a panic, an endless loop, an abort, a stack
//! overflow. In the other encounters they are the seed planner, so that a campaign can show that
//! one bad encounter costs one row.

use crate::zhuang::{Zhuang, ZhuangOptions};
use geom::HeadOnSector;
use planner_api::{Command, Mission, Planner, PlannerEvents, PlannerStream, Situation};
use serde::{Deserialize, Serialize};
use std::hint::black_box;

/// Options of all of them.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DestructiveOptions {
    /// Share of the encounters in which it misbehaves, drawn from the planner's own stream.
    pub share: f64,
    /// If not empty: misbehaves in the encounter with this stream seed alone (16 hexadecimal
    /// digits), whatever `share` says.
    pub only_stream_seed: String,
    /// It behaves until this time, seconds.
    pub after_s: f64,
}

impl Default for DestructiveOptions {
    fn default() -> Self {
        Self { share: 0.01, only_stream_seed: String::new(), after_s: 0.0 }
    }
}

/// What it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Orders a course that is not a number.
    Nan,
    /// Panics.
    Panics,
    /// Never returns.
    Spins,
    /// Aborts the process.
    Aborts,
    /// Overflows its stack.
    Overflows,
}

/// The seed planner with a fault.
#[derive(Clone, Debug)]
pub struct Destructive {
    fault: Fault,
    share: f64,
    only: Option<u64>,
    after_s: f64,
    zhuang: Zhuang,
    armed: bool,
}

impl Destructive {
    /// With this fault; an error says which option is wrong.
    pub fn new(fault: Fault, options: &DestructiveOptions) -> Result<Self, String> {
        let DestructiveOptions { share, ref only_stream_seed, after_s } = *options;
        if !(0.0..=1.0).contains(&share) {
            return Err(format!("`share` is {share}; it must be from 0 to 1"));
        }
        let only = if only_stream_seed.is_empty() {
            None
        } else {
            let seed = u64::from_str_radix(only_stream_seed, 16).map_err(|_| {
                format!("`only_stream_seed` is `{only_stream_seed}`; it must be hexadecimal")
            })?;
            Some(seed)
        };
        let zhuang = Zhuang::new(ZhuangOptions::default());
        Ok(Self { fault, share, only, after_s, zhuang, armed: false })
    }
}

impl Planner for Destructive {
    fn reset(&mut self, mission: &Mission) {
        self.zhuang.reset(mission);
        let seed = mission.stream_seed;
        self.armed = match self.only {
            Some(only) => seed == only,
            None => PlannerStream::new(seed).uniform() < self.share,
        };
    }

    fn head_on_sector(&self) -> Option<HeadOnSector> {
        self.zhuang.head_on_sector()
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        if !self.armed || situation.t_s < self.after_s {
            return self.zhuang.plan(situation);
        }
        match self.fault {
            Fault::Nan => Command::course_speed(f64::NAN, situation.own.sog_mps),
            Fault::Panics => panic!("this negative control panics on purpose"),
            Fault::Spins => loop {
                std::hint::spin_loop();
            },
            Fault::Aborts => std::process::abort(),
            Fault::Overflows => Command::course_speed(descend(situation.t_s), 0.0),
        }
    }

    fn events(&self) -> PlannerEvents {
        self.zhuang.events()
    }
}

/// Calls itself until the stack ends. The block is read after the call, so that no frame can be
/// given up early.
#[inline(never)]
fn descend(depth: f64) -> f64 {
    if black_box(depth) < 0.0 {
        return depth;
    }
    let block = black_box([depth; 32]);
    let below = descend(block[0].abs() + 1.0);
    black_box(&block)[31] + below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_options_are_refused() {
        let with = |share, seed: &str| {
            let only_stream_seed = seed.to_owned();
            let options = DestructiveOptions { share, only_stream_seed, after_s: 0.0 };
            Destructive::new(Fault::Nan, &options).map(|_| ()).unwrap_err()
        };
        assert!(with(1.5, "").contains("from 0 to 1"));
        assert!(with(f64::NAN, "").contains("from 0 to 1"));
        assert!(with(0.5, "xyz").contains("hexadecimal"));
    }
}
