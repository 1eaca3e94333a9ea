//! How a check says what it found: a verdict, its numbers, and a sentence for a mariner.
//! Reference: rules specification, section 13.

use crate::case::Case;
use geom::EncounterClass;
use geom::units::{deg, to_deg};
use record::{Check, Evidence, Status, Unit, Verdict};
use std::borrow::Cow;

/// Scales that bring margins to [-1, 1]: Torben et al., distance 100 m, time 10 s, angle 10 deg.
const SCALE_M: f64 = 100.0;
const SCALE_S: f64 = 10.0;
const SCALE_RAD: f64 = deg(10.0);

/// A verdict in the making.
#[derive(Debug)]
pub(crate) struct Ruling(Verdict);

impl Ruling {
    pub(crate) fn new(check: Check, target: usize, status: Status) -> Self {
        Self(Verdict {
            check,
            target: Some(target as u8),
            status,
            detail: Cow::Borrowed(""),
            margin: None,
            margin_unit: margin_unit(check),
            robustness: None,
            score: None,
            stages_by: None,
            t_s: None,
            evidence: Vec::new(),
            sentence: None,
        })
    }

    pub(crate) fn detail(mut self, detail: impl Into<Cow<'static, str>>) -> Self {
        self.0.detail = detail.into();
        self
    }

    /// The margin in the unit of the check, positive on the good side.
    pub(crate) fn margin(mut self, margin: f64) -> Self {
        let scale = match self.0.margin_unit {
            Unit::Metres => SCALE_M,
            Unit::Seconds => SCALE_S,
            Unit::Radians => SCALE_RAD,
            Unit::MetresPerSecond | Unit::One => 1.0,
        };
        self.0.margin = Some(margin);
        self.0.robustness = Some((margin / scale).clamp(-1.0, 1.0));
        self
    }

    pub(crate) fn margin_if(self, margin: Option<f64>) -> Self {
        match margin {
            Some(margin) => self.margin(margin),
            None => self,
        }
    }

    /// A score after Hagen 2023.
    pub(crate) fn score(mut self, score: f64) -> Self {
        self.0.score = Some(score);
        self
    }

    pub(crate) fn at(mut self, t_s: impl Into<Option<f64>>) -> Self {
        self.0.t_s = t_s.into();
        self
    }

    pub(crate) fn metres(self, name: &'static str, value: f64) -> Self {
        self.number(name, value, Unit::Metres)
    }

    pub(crate) fn seconds(self, name: &'static str, value: impl Into<Option<f64>>) -> Self {
        match value.into() {
            Some(value) => self.number(name, value, Unit::Seconds),
            None => self,
        }
    }

    pub(crate) fn radians(self, name: &'static str, value: f64) -> Self {
        self.number(name, value, Unit::Radians)
    }

    pub(crate) fn metres_a_second(self, name: &'static str, value: f64) -> Self {
        self.number(name, value, Unit::MetresPerSecond)
    }

    pub(crate) fn share(self, name: &'static str, value: f64) -> Self {
        self.number(name, value, Unit::One)
    }

    /// A sentence for a failure or a warning; not made for anything else.
    pub(crate) fn say(mut self, sentence: impl FnOnce() -> String) -> Self {
        if matches!(self.0.status, Status::Fail | Status::Warn) {
            self.0.sentence = Some(sentence());
        }
        self
    }

    pub(crate) fn done(self) -> Verdict {
        self.0
    }

    fn number(mut self, name: &'static str, value: f64, unit: Unit) -> Self {
        if self.0.evidence.capacity() == 0 {
            self.0.evidence.reserve_exact(8);
        }
        self.0.evidence.push(Evidence { name: Cow::Borrowed(name), value, unit });
        self
    }
}

/// A check that does not apply to this pair.
pub(crate) fn not_applicable(case: &Case<'_>, check: Check) -> Verdict {
    Ruling::new(check, case.life.target, Status::NotApplicable).done()
}

/// The unit in which a check measures by how much.
pub(crate) const fn margin_unit(check: Check) -> Unit {
    match check {
        Check::Safe | Check::R6 | Check::R8Third | Check::R13 | Check::R15 | Check::R19Speed => {
            Unit::Metres
        }
        Check::Turn
        | Check::R8Magnitude
        | Check::R14
        | Check::R17Hold
        | Check::R17Port
        | Check::R19 => Unit::Radians,
        Check::R5R7 | Check::R8Time | Check::R17May | Check::R17Shall | Check::LastMinute => {
            Unit::Seconds
        }
        Check::R8Dribble | Check::R16 => Unit::One,
    }
}

impl Case<'_> {
    /// "At 03:12, 640 m before a vessel crossing from starboard".
    pub(crate) fn when(&self, t_s: f64) -> String {
        let seconds = t_s.max(0.0) as u64;
        let vessel = match self.class {
            EncounterClass::HeadOn => "before a vessel meeting head-on",
            EncounterClass::CrossingStbd => "before a vessel crossing from starboard",
            EncounterClass::CrossingPort => "before a vessel crossing from port",
            EncounterClass::Overtaking => "from a vessel being overtaken",
            EncounterClass::Overtaken => "from an overtaking vessel",
            EncounterClass::Static => "before a stopped vessel",
        };
        let range_m = self.range_at_m(t_s);
        format!("At {:02}:{:02}, {range_m:.0} m {vessel}", seconds / 60, seconds % 60)
    }

    /// "altered 14 degrees to port", from a signed angle.
    pub(crate) fn altered(turn_rad: f64) -> String {
        let side = if turn_rad < 0.0 { "port" } else { "starboard" };
        format!("altered {:.0} degrees to {side}", to_deg(turn_rad.abs()))
    }
}
