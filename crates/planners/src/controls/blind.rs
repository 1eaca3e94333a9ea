//! `blind-to-nearest`: the nearest target is not seen.

use crate::zhuang::{Zhuang, ZhuangOptions};
use planner_api::{Command, Mission, Planner, PlannerEvents, Situation, TargetTrack};

/// The control that overlooks the one target that matters.
#[derive(Clone, Debug)]
pub struct BlindToNearest {
    zhuang: Zhuang,
    seen: Vec<TargetTrack>,
}

impl Default for BlindToNearest {
    fn default() -> Self {
        Self { zhuang: Zhuang::new(ZhuangOptions::default()), seen: Vec::new() }
    }
}

impl Planner for BlindToNearest {
    fn reset(&mut self, mission: &Mission) {
        self.zhuang.reset(mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let own_m = situation.own.position_m;
        let range_m = |track: &TargetTrack| (track.position_m - own_m).norm();
        let nearest = situation
            .tracks
            .iter()
            .min_by(|a, b| range_m(a).total_cmp(&range_m(b)).then(a.id.cmp(&b.id)))
            .map(|track| track.id);
        self.seen.clear();
        self.seen.extend(situation.tracks.iter().filter(|track| Some(track.id) != nearest));
        self.zhuang.plan(&Situation { tracks: &self.seen, ..*situation })
    }

    fn events(&self) -> PlannerEvents {
        self.zhuang.events()
    }
}
