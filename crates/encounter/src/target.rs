//! One target of a stratum: its draws in their order, and the words when it cannot be placed.

use crate::intent::Minded;
use crate::limits::either;
use crate::placement::{Given, Laws, Passing, Placed, Refusals, TRIES_MAX, place};
use crate::spec::{IntentSpec, Model, StratumSpec};
use crate::wanted::{Side, Wanted};
use crate::{Distribution, Error};
use geom::units::deg;
use geom::{EncounterClass, HullOutline, wrap};
use record::{EncounterId, Intent, Motion, Purpose, Seed, Streams, Target};

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
    laws: Laws<'a>,
}

/// A target and how it was placed.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    pub(crate) target: Target,
    pub(crate) placed: Placed,
}

impl<'a> Request<'a> {
    /// The targets of a stratum, in order.
    pub(crate) fn all(model: &'a Model, stratum: &'a StratumSpec) -> impl Iterator<Item = Self> {
        let request = move |number, class, speed: &'a Option<_>, course: &'a Option<_>| Self {
            model,
            stratum,
            number,
            class,
            laws: Laws {
                geometry: &model.geometry,
                head_on: model.geometry.head_on(),
                speed_mps: speed.as_ref().unwrap_or(&model.target.speed_mps),
                course_deg: course.as_ref().unwrap_or(&model.geometry.relative_course_deg),
            },
        };
        let first =
            request(1, stratum.class, &stratum.target_speed_mps, &stratum.relative_course_deg);
        let further = stratum.also.iter().flatten().zip(2..).map(move |(also, number)| {
            request(number, Some(also.class), &also.target_speed_mps, &also.relative_course_deg)
        });
        std::iter::once(first).chain(further)
    }

    /// Draws the target of one encounter.
    pub(crate) fn make(
        self,
        own: Own,
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
            passing: Passing::draw(&model.geometry, &mut stream),
        };
        let placed = place(&given, &self.laws, &mut stream)
            .map_err(|refusals| self.unplaced(id.j, &given, refusals))?;
        let spec = &model.target;
        let limits = (spec.limits.as_ref(), spec.scaled_limits.as_ref());
        let target = Target {
            hull: HullOutline::centred(length_m, beam_m),
            vessel: either(limits.0, limits.1, length_m, placed.speed_mps)
                .expect("a validated target has limits"),
            start: Motion {
                position_m: placed.position_m,
                psi_rad: placed.psi_rad,
                speed_mps: placed.speed_mps,
            },
            intent: self.intent(&placed, streams, duration_s_max),
        };
        Ok(Made { target, placed })
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
                    share: [0.0, 1.0][pick(3)],
                },
            };
            place(&given, &self.laws, &mut stream)
                .map_err(|refusals| self.unplaced(0, &given, refusals))?;
        }
        Ok(())
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
        let mix = self.stratum.intent_mix.as_ref().or(spec.intent_mix.as_ref());
        if let (Some(mix), Some(conduct)) = (mix, &spec.conduct) {
            let mut stream = streams.stream(Purpose::TargetBehaviour, self.number);
            let target = Minded { psi_rad: placed.psi_rad, duration_s_max };
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
        let problem = if refusals.range >= refusals.class {
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
