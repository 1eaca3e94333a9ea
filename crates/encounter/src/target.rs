//! One target of a stratum: its draws in their order, and the words when it cannot be placed.

use crate::encounter_rate::Rate;
use crate::intent::{IntentMix, Minded};
use crate::limits::either;
use crate::placement::{Given, Laws, Passing, Placed, Refusals, TRIES_MAX, When, place, place_at};
use crate::spec::{IntentSpec, Model, StratumSpec};
use crate::wanted::{Side, Wanted};
use crate::{Distribution, Error};
use geom::units::deg;
use geom::{EncounterClass, HullOutline, wrap};
use record::{EncounterId, Intent, Motion, Purpose, Seed, Stream, Streams, Target};
use std::f64::consts::PI;

/// Own ship, as far as she is known before the targets are placed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Own {
    /// Speed, m/s.
    pub(crate) speed_mps: f64,
    /// Heading, radians.
    pub(crate) psi_rad: f64,
}

/// What one target of a stratum must be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request<'a> {
    model: &'a Model,
    stratum: &'a StratumSpec,
    /// From 1; also the ship's number in the random streams.
    number: u8,
    /// The class; absent for the first target beside a border, or of any class.
    class: Option<EncounterClass>,
    /// Her time to CPA less the first target's, seconds; absent: independent of it.
    tcpa_after_first_s: Option<&'a Distribution>,
    laws: Laws<'a>,
}

/// A target and how it was placed.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    pub(crate) target: Target,
    pub(crate) placed: Placed,
}

/// An encounter of two ships at the rate of a traffic.
#[derive(Clone, Debug)]
pub(crate) struct Rated {
    pub(crate) own: Own,
    pub(crate) weight: f64,
    pub(crate) made: Made,
}

/// Own course: uniform over the circle, or north.
pub(crate) fn own_course_rad(model: &Model, stream: &mut Stream) -> f64 {
    if model.geometry.random_rotation {
        // the upper end is the one that belongs to the circle (-pi, pi]
        -stream.uniform_in(-PI, PI)
    } else {
        0.0
    }
}

impl<'a> Request<'a> {
    /// The first target of a stratum.
    pub(crate) fn first(model: &'a Model, stratum: &'a StratumSpec) -> Self {
        let (speed, course) = (&stratum.target_speed_mps, &stratum.relative_course_deg);
        Self::new(model, stratum, (1, stratum.class), speed, course)
    }

    /// The targets of a stratum, in order.
    pub(crate) fn all(model: &'a Model, stratum: &'a StratumSpec) -> impl Iterator<Item = Self> {
        let further = stratum.also.iter().flatten().zip(2..).map(move |(also, number)| {
            let (speed, course) = (&also.target_speed_mps, &also.relative_course_deg);
            Self {
                tcpa_after_first_s: also.tcpa_after_first_s.as_ref(),
                ..Self::new(model, stratum, (number, Some(also.class)), speed, course)
            }
        });
        std::iter::once(Self::first(model, stratum)).chain(further)
    }

    fn new(
        model: &'a Model,
        stratum: &'a StratumSpec,
        (number, class): (u8, Option<EncounterClass>),
        speed: &'a Option<Distribution>,
        course: &'a Option<Distribution>,
    ) -> Self {
        let laws = Laws {
            geometry: &model.geometry,
            head_on: model.geometry.head_on(),
            speed_mps: speed.as_ref().unwrap_or(&model.target.speed_mps),
            course_deg: course.as_ref().unwrap_or(&model.geometry.relative_course_deg),
        };
        Self { model, stratum, number, class, tcpa_after_first_s: None, laws }
    }

    /// Draws the target of one encounter; `first_tcpa_s` is the time to CPA of the first one.
    pub(crate) fn make(
        self,
        own: Own,
        first_tcpa_s: Option<f64>,
        streams: &Streams,
        id: &EncounterId,
        duration_s_max: f64,
    ) -> Result<Made, Error> {
        let model = self.model;
        let mut stream = streams.stream(Purpose::Geometry, self.number);
        let length_m = model.target.length_m.draw(&mut stream);
        let beam_m = length_m * model.target.beam_per_length.draw(&mut stream);
        let given = Given {
            own_speed_mps: own.speed_mps,
            own_psi_rad: own.psi_rad,
            length_m,
            wanted: self.wanted(|| stream.uniform() < 0.5),
            passing: self.passing(first_tcpa_s, &mut stream),
        };
        let placed = place(&given, &self.laws, &mut stream)
            .map_err(|refusals| self.unplaced(id.j, &given, refusals))?;
        let intent = self.intent(&placed, streams, duration_s_max);
        Ok(self.made(length_m, beam_m, placed, intent))
    }

    /// Draws the only target of an encounter that is met at the rate of a traffic; own speed comes
    /// from own ship's stream, and her course is north until the encounter is turned. The weight
    /// stands beside the target.
    pub(crate) fn make_at_rate(
        self,
        rate: &Rate,
        own_stream: &mut Stream,
        streams: &Streams,
        id: &EncounterId,
        duration_s_max: f64,
    ) -> Result<Rated, Error> {
        let model = self.model;
        let mut stream = streams.stream(Purpose::Geometry, self.number);
        let length_m = model.target.length_m.draw(&mut stream);
        let beam_m = length_m * model.target.beam_per_length.draw(&mut stream);
        let (miss_m, miss_weight) = rate.miss(&mut stream);
        let passing = Passing { miss_m, when: When::Share(stream.uniform()) };
        let laws = (&model.own.speed_mps, self.laws.speed_mps);
        let meeting = rate.meet((laws.0, own_stream), (laws.1, &mut stream));
        let own_speed_mps = meeting.as_ref().map_or(f64::NAN, |meeting| meeting.own_mps);
        let own_psi_rad = own_course_rad(model, own_stream);
        let given = Given { own_speed_mps, own_psi_rad, length_m, wanted: Wanted::Any, passing };
        let unplaced = |refusals| self.unplaced(id.j, &given, refusals);
        let meeting = meeting.ok_or_else(|| unplaced(Refusals { range: TRIES_MAX, class: 0 }))?;
        let psi_rad = wrap(own_psi_rad + meeting.course_rad);
        let placed = place_at(&given, &self.laws, meeting.target_mps, psi_rad, meeting.rejected)
            .map_err(unplaced)?;
        let (intent, intent_weight) = self.intent_at_rate(&placed, streams, duration_s_max);
        let speed_weight = rate.speed_weight(own_speed_mps, meeting.target_mps);
        let weight = speed_weight * miss_weight * intent_weight;
        let own = Own { speed_mps: own_speed_mps, psi_rad: own_psi_rad };
        Ok(Rated { own, weight, made: self.made(length_m, beam_m, placed, intent) })
    }

    /// The intent, and the quotient of its true and its drawn share.
    fn intent_at_rate(
        &self,
        placed: &Placed,
        streams: &Streams,
        duration_s_max: f64,
    ) -> (Intent, f64) {
        let drawn = self.model.encounter_rate.as_ref().and_then(|r| r.intent_mix_drawn.as_ref());
        match (drawn, self.mix(), &self.model.target.conduct) {
            (Some(drawn), Some(mix), Some(conduct)) => {
                let mut stream = streams.stream(Purpose::TargetBehaviour, self.number);
                let target = Minded { start: start_of(placed), duration_s_max };
                mix.draw_instead(drawn, conduct, target, &mut stream)
            }
            _ => (self.intent(placed, streams, duration_s_max), 1.0),
        }
    }

    fn mix(&self) -> Option<&'a IntentMix> {
        self.stratum.intent_mix.as_ref().or(self.model.target.intent_mix.as_ref())
    }

    /// Miss distance and time: like the first target's, or after hers as declared.
    fn passing(&self, first_tcpa_s: Option<f64>, stream: &mut Stream) -> Passing {
        let geometry = &self.model.geometry;
        match (self.tcpa_after_first_s, first_tcpa_s) {
            (Some(after_s), Some(first_s)) => Passing {
                miss_m: geometry.miss_m.draw(stream),
                when: When::At(first_s + after_s.draw(stream)),
            },
            _ => Passing::draw(geometry, stream),
        }
    }

    fn made(&self, length_m: f64, beam_m: f64, placed: Placed, intent: Intent) -> Made {
        let model = self.model;
        let spec = &model.target;
        let limits = (spec.limits.as_ref(), spec.scaled_limits.as_ref());
        let target = Target {
            hull: HullOutline::centred(length_m, beam_m),
            vessel: either(limits.0, limits.1, length_m, placed.speed_mps)
                .expect("a validated target has limits"),
            start: start_of(&placed),
            intent,
        };
        Made { target, placed }
    }

    /// Places the target at the ends of what is given, so that a campaign does not stop after an
    /// hour at the first encounter that its ships cannot make.
    pub(crate) fn try_extremes(self) -> Result<(), Error> {
        let model = self.model;
        let ends = |law: &Distribution| [law.bounds().0, law.bounds().1];
        let id = EncounterId::new(self.stratum.name.as_str(), 0);
        let mut stream = Streams::new(Seed(0), &id).stream(Purpose::Geometry, u8::MAX);
        for corner in 0..32 {
            let pick = |bit: u32| usize::from(corner >> bit & 1 == 1);
            let given = Given {
                own_speed_mps: ends(&model.own.speed_mps)[pick(0)],
                own_psi_rad: 0.0,
                length_m: ends(&model.target.length_m)[pick(1)],
                wanted: self.wanted(|| pick(4) == 1),
                passing: Passing {
                    miss_m: ends(&model.geometry.miss_m)[pick(2)],
                    when: self.extreme_time(pick(3)),
                },
            };
            place(&given, &self.laws, &mut stream)
                .map_err(|refusals| self.unplaced(0, &given, refusals))?;
        }
        Ok(())
    }

    /// The earliest or the latest time to CPA that can be asked for.
    fn extreme_time(&self, which: usize) -> When {
        match self.tcpa_after_first_s {
            None => When::Share([0.0, 1.0][which]),
            Some(after_s) => {
                let (low_s, high_s) = after_s.bounds();
                When::At(self.model.geometry.tcpa_s[which] + [low_s, high_s][which])
            }
        }
    }

    /// What is asked of one encounter; `coin` decides on the side of a border.
    fn wanted(&self, coin: impl FnOnce() -> bool) -> Wanted {
        match (self.class, self.stratum.boundary, self.stratum.within_deg) {
            (Some(class), _, _) => Wanted::Class(class),
            (None, Some(border), Some(within_deg)) => Wanted::Beside {
                border,
                within_rad: deg(within_deg),
                side: if coin() { Side::First } else { Side::Second },
            },
            (None, ..) => Wanted::Any,
        }
    }

    fn intent(&self, placed: &Placed, streams: &Streams, duration_s_max: f64) -> Intent {
        let spec = &self.model.target;
        if let (Some(mix), Some(conduct)) = (self.mix(), &spec.conduct) {
            let mut stream = streams.stream(Purpose::TargetBehaviour, self.number);
            let target = Minded { start: start_of(placed), duration_s_max };
            return mix.draw(conduct, target, &mut stream);
        }
        match &self.model.target.intent {
            IntentSpec::HoldCourse => Intent::HoldCourse,
            IntentSpec::Planner(name) => Intent::Planner(name.clone()),
            IntentSpec::Alter(alter) => {
                let mut stream = streams.stream(Purpose::TargetBehaviour, self.number);
                let before_s = alter.before_cpa_s.draw(&mut stream);
                let change_rad = deg(alter.course_change_deg.draw(&mut stream));
                Intent::Alter {
                    at_s: (placed.tcpa_s - before_s).max(0.0),
                    course_rad: wrap(placed.psi_rad + change_rad),
                    speed_mps: placed.speed_mps * alter.speed_factor.draw(&mut stream),
                }
            }
        }
    }

    fn unplaced(&self, j: u64, given: &Given, refusals: Refusals) -> Error {
        let geometry = &self.model.geometry;
        let nearest_m = geometry.range_m_min_beyond_half_length + given.length_m / 2.0;
        let ships = format!(
            "own speed {:.2} m/s, target length {:.1} m, miss distance {:.1} m",
            given.own_speed_mps, given.length_m, given.passing.miss_m
        );
        let problem = if let When::At(tcpa_s) = given.passing.when
            && refusals.range >= refusals.class
        {
            format!(
                "with {ships} she cannot arrive at {tcpa_s:.1} s from a start range of \
                 {nearest_m} to {} m in {} of them; narrow tcpa_after_first_s, or change the \
                 speeds or range_m_max",
                geometry.range_m_max, refusals.range
            )
        } else if refusals.range >= refusals.class {
            format!(
                "with {ships} the start range from {nearest_m} to {} m is not met within {} to {} \
                 s to CPA in {} of them; widen range_m_max or tcpa_s, or change the speeds",
                geometry.range_m_max, geometry.tcpa_s[0], geometry.tcpa_s[1], refusals.range
            )
        } else {
            let what = match given.wanted {
                Wanted::Any => "an encounter".to_owned(),
                Wanted::Class(class) => format!("the class {}", class.name()),
                Wanted::Beside { border, side, .. } => {
                    format!("the {side:?} side of the border {border:?}")
                }
            };
            format!(
                "with {ships} no target speed and relative course of the file give {what}; \
                 change target_speed_mps or relative_course_deg of the stratum"
            )
        };
        let stratum = self.stratum.name.clone();
        Error::Placement { stratum, j, target: self.number, tries: TRIES_MAX, problem }
    }
}

fn start_of(placed: &Placed) -> Motion {
    Motion { position_m: placed.position_m, psi_rad: placed.psi_rad, speed_mps: placed.speed_mps }
}
