//! What targets mean to do: one intent for all, or a mix with declared shares.
//!
//! A mix is drawn from the stream of target behaviour, one for each ship, so that geometry is the
//! same whatever the mix. Turns at random are drawn here, too, and written into the encounter: a
//! replay needs no stream for them, and the nominal track makes the same turns. So are routes.

use crate::Distribution;
use crate::Error;
use crate::error::require;
use crate::limits::positive;
use geom::units::deg;
use geom::wrap;
use record::{Conduct, Intent, Manner, Motion, Stream, Turn, Waypoint};
use serde::{Deserialize, Serialize};

/// Shares of intents; they sum to 1, and an absent one is 0.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IntentMix {
    /// Keeps course and speed, with no duty in mind.
    pub hold_course: Option<f64>,
    /// Gives way early, stands on where she must.
    pub comply: Option<f64>,
    /// The same, but late.
    pub late: Option<f64>,
    /// Does nothing though obliged; moves as `hold_course` does, and counts as a share of its own.
    pub neglect: Option<f64>,
    /// Turns to port, whatever her duty.
    pub wrong_way: Option<f64>,
    /// Turns at random times by random angles, whatever own ship does.
    pub random: Option<f64>,
    /// Follows a drawn route with a speed on each leg, whatever own ship does.
    pub track: Option<f64>,
    /// Runs the planner that `[model.target.conduct]` names.
    pub planner: Option<f64>,
}

/// Numbers of the intents of a mix.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConductSpec {
    /// Time to the closest point of her bow at which a complying target acts, seconds.
    pub early_tcpa_s: Distribution,
    /// The same of one that complies late.
    pub late_tcpa_s: Distribution,
    /// Size of the alteration, degrees; a complying target makes it larger where it is not enough.
    pub course_change_deg: Distribution,
    /// There is risk when the predicted distance between reference points is at most this, metres.
    pub risk_dcpa_m: f64,
    /// The time at which a complying target that stands on acts herself, seconds (Rule 17(b)) ...
    pub stand_on_tcpa_s: Distribution,
    /// ... if the predicted distance between reference points is still at most this, metres.
    pub stand_on_dcpa_m: f64,
    /// Mean time between turns at random, seconds; the times are those of a Poisson process.
    pub random_turn_every_s: f64,
    /// A turn at random, degrees off the course at the start, positive to starboard.
    pub random_turn_deg: Distribution,
    /// The routes of `track` targets.
    pub track: Option<TrackSpec>,
    /// The planner of `planner` targets: a name of the registry, the tested one's own included.
    pub planner: Option<String>,
}

/// Laws of a route. Its first leg is the course and speed at the start, so that the encounter is
/// the one that was asked for until she comes to her first waypoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackSpec {
    /// Number of legs.
    pub legs: u32,
    /// Time on a leg, seconds.
    pub leg_s: Distribution,
    /// Course of a later leg less the course at the start, degrees, positive to starboard.
    pub course_off_deg: Distribution,
    /// Speed on a later leg as a share of the speed at the start.
    pub speed_factor: Distribution,
}

/// A target before her intent is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Minded {
    /// Position, course and speed at the start.
    pub(crate) start: Motion,
    /// Longest simulated time, seconds.
    pub(crate) duration_s_max: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    HoldCourse,
    Comply,
    Late,
    Neglect,
    WrongWay,
    Random,
    Track,
    Planner,
}

impl IntentMix {
    fn shares(&self) -> [(Kind, &'static str, f64); 8] {
        let share = |kind, name, share: Option<f64>| (kind, name, share.unwrap_or(0.0));
        [
            share(Kind::HoldCourse, "hold_course", self.hold_course),
            share(Kind::Comply, "comply", self.comply),
            share(Kind::Late, "late", self.late),
            share(Kind::Neglect, "neglect", self.neglect),
            share(Kind::WrongWay, "wrong_way", self.wrong_way),
            share(Kind::Random, "random", self.random),
            share(Kind::Track, "track", self.track),
            share(Kind::Planner, "planner", self.planner),
        ]
    }

    pub(crate) fn validate(&self, key: &str, conduct: Option<&ConductSpec>) -> Result<(), Error> {
        let mut sum = 0.0;
        for (_, name, share) in self.shares() {
            require(
                (0.0..=1.0).contains(&share),
                || format!("{key}.{name}"),
                || format!("= {share} must be a share, from 0 to 1"),
            )?;
            sum += share;
        }
        require(
            (sum - 1.0).abs() < 1e-9,
            || key.to_owned(),
            || format!("has shares that sum to {sum}; they must sum to 1"),
        )?;
        let Some(conduct) = conduct else {
            return Err(Error::spec(
                "model.target.conduct",
                format!("is missing; it says how the targets of `{key}` act"),
            ));
        };
        require(
            self.track.unwrap_or(0.0) <= 0.0 || conduct.track.is_some(),
            || "model.target.conduct.track".to_owned(),
            || format!("is missing; `{key}` has a share of targets on a track"),
        )?;
        require(
            self.planner.unwrap_or(0.0) <= 0.0 || conduct.planner.is_some(),
            || "model.target.conduct.planner".to_owned(),
            || format!("is missing; `{key}` has a share of targets under a planner"),
        )
    }

    /// Draws an intent. The choice is the first draw of the stream, so that a change of the
    /// conduct's numbers leaves it as it is.
    pub(crate) fn draw(
        &self,
        conduct: &ConductSpec,
        target: Minded,
        stream: &mut Stream,
    ) -> Intent {
        conduct.intent(self.choose(stream), target, stream)
    }

    /// Draws an intent with the shares of `drawn`, and the quotient of its share here and there.
    pub(crate) fn draw_instead(
        &self,
        drawn: &Self,
        conduct: &ConductSpec,
        target: Minded,
        stream: &mut Stream,
    ) -> (Intent, f64) {
        let kind = drawn.choose(stream);
        (conduct.intent(kind, target, stream), self.share(kind) / drawn.share(kind))
    }

    fn choose(&self, stream: &mut Stream) -> Kind {
        let mut left = stream.uniform();
        let shares = self.shares();
        let chosen = shares.iter().find(|(_, _, share)| {
            left -= share;
            left < 0.0
        });
        // rounding can leave a remainder: the last kind with a share takes it
        let last = shares.iter().rev().find(|(_, _, share)| *share > 0.0);
        chosen.or(last).map_or(Kind::HoldCourse, |(kind, _, _)| *kind)
    }

    fn share(&self, kind: Kind) -> f64 {
        let shares = self.shares();
        shares.iter().find(|share| share.0 == kind).map_or(0.0, |share| share.2)
    }

    /// Largest quotient of a share here and there.
    pub(crate) fn largest_quotient(&self, drawn: &Self) -> f64 {
        let quotients = self.shares().into_iter().zip(drawn.shares());
        let drawn_ones = quotients.filter(|(_, (_, _, drawn))| *drawn > 0.0);
        drawn_ones.map(|((_, _, share), (_, _, drawn))| share / drawn).fold(0.0, f64::max)
    }

    /// Refuses a `drawn` mix that leaves out an intent, or has one that there is not.
    pub(crate) fn validate_drawn(&self, key: &str, drawn: &Self) -> Result<(), Error> {
        self.shares().into_iter().zip(drawn.shares()).try_for_each(|((_, name, share), there)| {
            require(
                (share > 0.0) == (there.2 > 0.0),
                || format!("{key}.{name}"),
                || {
                    format!(
                        "= {} with a true share of {share}: an intent is drawn where it has a \
                         true share, and nowhere else",
                        there.2
                    )
                },
            )
        })
    }
}

impl ConductSpec {
    fn intent(&self, kind: Kind, target: Minded, stream: &mut Stream) -> Intent {
        match kind {
            Kind::HoldCourse => Intent::HoldCourse,
            Kind::Comply => self.duty(Manner::Complies, &self.early_tcpa_s, stream),
            Kind::Late => self.duty(Manner::Complies, &self.late_tcpa_s, stream),
            Kind::Neglect => self.duty(Manner::Neglects, &self.early_tcpa_s, stream),
            Kind::WrongWay => self.duty(Manner::WrongWay, &self.early_tcpa_s, stream),
            Kind::Random => self.turns(target, stream),
            Kind::Track => match &self.track {
                Some(track) => track.draw(target.start, stream),
                None => Intent::HoldCourse,
            },
            Kind::Planner => Intent::Planner(self.planner.clone().unwrap_or_default()),
        }
    }

    pub(crate) fn validate(&self) -> Result<(), Error> {
        const TABLE: &str = "model.target.conduct";
        let key = |name: &str| format!("{TABLE}.{name}");
        let time_s = |name: &str, law: &Distribution| law.validate_within(&key(name), 1.0, 3600.0);
        time_s("early_tcpa_s", &self.early_tcpa_s)?;
        time_s("late_tcpa_s", &self.late_tcpa_s)?;
        self.course_change_deg.validate_within(&key("course_change_deg"), 1.0, 180.0)?;
        positive(TABLE, "risk_dcpa_m", self.risk_dcpa_m)?;
        time_s("stand_on_tcpa_s", &self.stand_on_tcpa_s)?;
        positive(TABLE, "stand_on_dcpa_m", self.stand_on_dcpa_m)?;
        positive(TABLE, "random_turn_every_s", self.random_turn_every_s)?;
        self.random_turn_deg.validate_within(&key("random_turn_deg"), -180.0, 180.0)?;
        self.track.as_ref().map_or(Ok(()), |track| track.validate(&key("track")))
    }

    fn duty(&self, manner: Manner, tcpa_s: &Distribution, stream: &mut Stream) -> Intent {
        Intent::Duty(Conduct {
            manner,
            act_tcpa_s: tcpa_s.draw(stream),
            risk_dcpa_m: self.risk_dcpa_m,
            course_change_rad: deg(self.course_change_deg.draw(stream)),
            stand_on_tcpa_s: self.stand_on_tcpa_s.draw(stream),
            stand_on_dcpa_m: self.stand_on_dcpa_m,
        })
    }

    fn turns(&self, target: Minded, stream: &mut Stream) -> Intent {
        let mut turns = Vec::new();
        let mut at_s = 0.0;
        loop {
            at_s += self.random_turn_every_s * stream.exponential();
            if at_s >= target.duration_s_max {
                return Intent::Turns(turns);
            }
            let off_rad = deg(self.random_turn_deg.draw(stream));
            turns.push(Turn { at_s, course_rad: wrap(target.start.psi_rad + off_rad) });
        }
    }
}

impl TrackSpec {
    /// Most legs of a route.
    const LEGS_MAX: u32 = 100;

    fn validate(&self, table: &str) -> Result<(), Error> {
        let key = |name: &str| format!("{table}.{name}");
        require(
            (2..=Self::LEGS_MAX).contains(&self.legs),
            || key("legs"),
            || {
                let (legs, most) = (self.legs, Self::LEGS_MAX);
                format!("= {legs} must be from 2 to {most}; one leg is `hold_course`")
            },
        )?;
        self.leg_s.validate_within(&key("leg_s"), 1.0, 86_400.0)?;
        self.course_off_deg.validate_within(&key("course_off_deg"), -180.0, 180.0)?;
        self.speed_factor.validate_within(&key("speed_factor"), 0.01, 10.0)
    }

    fn draw(&self, start: Motion, stream: &mut Stream) -> Intent {
        let mut position_m = start.position_m;
        let (mut course_rad, mut speed_mps) = (start.psi_rad, start.speed_mps);
        let mut waypoints = Vec::new();
        for leg in 0..self.legs {
            if leg > 0 {
                course_rad = start.psi_rad + deg(self.course_off_deg.draw(stream));
                speed_mps = start.speed_mps * self.speed_factor.draw(stream);
            }
            position_m += geom::unit(course_rad) * (speed_mps * self.leg_s.draw(stream));
            waypoints.push(Waypoint { position_m, speed_mps: Some(speed_mps) });
        }
        Intent::Track(waypoints)
    }
}
