//! Both judges on one trace, and where they disagree.
//!
//! The first judge (`rules`) makes the verdicts. The second (`stl`) is asked where the campaign
//! file says `second_judge = true`; its thresholds are those of the same rule set. It shares no
//! code with the first, so a difference shows a slip of one of them. Reference: rules
//! specification, section 12.

use crate::spec::RunTable;
use crate::{Error, last_minute, row};
use record::verdict::Judgement;
use record::{Check, Digest, Encounter, Outcome, RunRow, Status, Trace, Verdict};
use rules::{PortInExtremis, RuleSet, StageMode};
use stl::{Finding, Robustness};

/// The judges of one rule set.
#[derive(Debug)]
pub struct Judges {
    first: rules::Judge,
    second: Option<stl::Params>,
    last_minute: bool,
}

/// What the judges said of one run.
#[derive(Debug)]
pub struct Judged {
    /// The verdicts of the first judge.
    pub judgement: Judgement,
    /// Where the second one disagrees; absent where it was not asked.
    pub disagreements: Option<Vec<Disagreement>>,
}

/// One check of one pair on which the judges disagree.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// Which check.
    pub check: Check,
    /// Index of the target.
    pub target: u8,
    /// Status of the first judge.
    pub first: Status,
    /// Its detail code.
    pub detail: String,
    /// Finding of the second judge.
    pub second: Finding,
    /// Its robustness.
    pub rho: Option<f64>,
}

impl Judges {
    /// The judges of a rule set, as a campaign asks for them: with the second one, and with the
    /// last safe instants.
    ///
    /// # Errors
    /// The second judge is wanted and cannot express the rule set.
    pub fn new(rules: RuleSet, run: &RunTable) -> Result<Self, Error> {
        let second = run.second_judge.then(|| params(&rules)).transpose()?;
        Ok(Self { first: rules::Judge::new(rules), second, last_minute: run.last_minute })
    }

    /// Judges one run. Where the last safe instants are wanted they are put into the trace: which
    /// pairs need them, and which turns are left to own ship, is known from a first look.
    pub fn judge(&mut self, encounter: &Encounter, trace: &mut Trace) -> Judged {
        trace.last_minute = None;
        if self.last_minute && trace.nominal.is_some() {
            let pairs = self.first.pairs(trace);
            let near_miss_m = self.first.rules().distance.r_nm_m;
            let nominal = trace.nominal.as_ref();
            trace.last_minute =
                nominal.and_then(|n| last_minute::find(encounter, n, &pairs, near_miss_m));
        }
        let judgement = self.first.judge(trace);
        let disagreements = self
            .second
            .as_ref()
            .map(|params| disagreements(&judgement, &stl::judge(trace, params)));
        Judged { judgement, disagreements }
    }
}

impl Judged {
    /// The row of the run that was judged.
    pub fn row(&self, encounter: &Encounter, trace: &Trace) -> RunRow {
        match trace.outcome {
            // what a panic leaves behind depends on how far it came: id and outcome alone count
            Outcome::PlannerPanicked
            | Outcome::PlannerCrashed
            | Outcome::PlannerHung
            | Outcome::PlannerProtocol => {
                row::of_lost_run(encounter, trace.outcome, trace.planner_detail.clone())
            }
            _ => {
                let digest = Digest::of_trace(trace);
                let mut row = row::of_run(encounter, trace, digest, &self.judgement);
                row.judges_disagree = self.disagreements.as_ref().map(|list| !list.is_empty());
                row
            }
        }
    }
}

/// The thresholds of the second judge, from the rule set of the first.
///
/// # Errors
/// The rule set uses an option that no formula expresses.
pub fn params(rules: &RuleSet) -> Result<stl::Params, Error> {
    if rules.stand_on.may_act_early {
        return Err(Error::input(format!(
            "rule set {}: may_act_early = true has no formula; set run.second_judge = false",
            rules.name
        )));
    }
    let (stages, distance, m) = (&rules.stages, &rules.distance, &rules.manoeuvre);
    let class = &rules.classification;
    Ok(stl::Params {
        risk_distance_m: rules.risk.d_risk_m,
        close_quarters_m: rules.restricted_visibility.close_quarters_m,
        risk_tcpa_s: rules.risk.t_risk_s,
        risk_hold_s: rules.risk.persistence_s,
        risk_close_factor: rules.risk.close_factor,
        manoeuvring_yaw_rate_radps: rules.risk.held_above_yaw_rate_radps,
        head_on_half_angle_rad: class.head_on_half_angle_rad,
        head_on_reciprocal_rad: class.head_on_reciprocal_factor * class.head_on_half_angle_rad,
        doubt_rad: class.doubt_rad,
        stopped_mps: class.stopped_mps,
        stage_range_m: [stages.r2_m, stages.r3_m, stages.r4_m],
        stage_time_s: [stages.t2_s, stages.t3_s, stages.t4_s],
        stage_clock: match stages.mode {
            StageMode::Range => stl::StageClock::Range,
            StageMode::Time => stl::StageClock::Time,
        },
        preferred_m: distance.r_pref_m,
        minimum_m: distance.r_min_m,
        near_miss_m: distance.r_nm_m,
        turn_detectable_rad: m.detectable_turn_rad,
        turn_action_rad: m.substantial_turn_rad,
        turn_apparent_rad: m.apparent_turn_rad,
        speed_detectable: m.detectable_speed_fraction,
        speed_action: m.substantial_speed_fraction,
        offset_hold_s: m.offset_held_s,
        reference_s: m.baseline_s,
        stand_on_mean_s: rules.stand_on.heading_mean_s,
        may_act_hold_s: rules.stand_on.may_act_persistence_s,
        shall_act_grace_s: rules.stand_on.shall_act_grace_s,
        run: stl::RunParams {
            smoothing_s: m.heading_sigma_s,
            yaw_rate_on_radps: m.turn_rate_start_radps,
            quiet_s: m.turn_quiet_s,
            gap_s: m.turn_gap_s,
            slow_s: m.slow_turn_s,
            acceleration_mps2: m.speed_rate_mps2,
            moving_mps: m.moving_mps,
        },
        attribution_lead_s: m.attribution_lead_s,
        release_hold_s: rules.release.held_s,
        release_overtaking_rad: rules.release.overtaker_ahead_rad,
        release_abaft_rad: rules.release.abaft_rad,
        release_range_factor: rules.release.beyond_r2_factor,
        overtaken_bow_rad: OVERTAKEN_BOW_RAD,
        port_turn_fails_in_stage_4: rules.stand_on.port_in_stage_4 == PortInExtremis::Fail,
        scale: SCALES,
    })
}

/// Section 8: closer than `r_min` with the overtaken ship's contact angle within 45 degrees.
const OVERTAKEN_BOW_RAD: f64 = geom::units::deg(45.0);

/// Section 12, after Torben et al. 2022: 100 m, 10 degrees; a quarter of the speed is ours. They
/// scale the robustness and cannot change its sign.
const SCALES: stl::Scales =
    stl::Scales { distance_m: 100.0, angle_rad: geom::units::deg(10.0), speed: 0.25 };

/// Where the sign of the robustness contradicts the status of the first judge.
fn disagreements(first: &Judgement, second: &[Robustness]) -> Vec<Disagreement> {
    second
        .iter()
        .filter_map(|said| {
            let verdict = first
                .verdicts
                .iter()
                .find(|v| v.check == said.check && v.target == Some(said.target))?;
            let agreed =
                agree(verdict, said.status) || unwritten_breach(first, verdict, said.status);
            (!agreed).then(|| Disagreement {
                check: said.check,
                target: said.target,
                first: verdict.status,
                detail: verdict.detail.to_string(),
                second: said.status,
                rho: said.rho,
            })
        })
        .collect()
}

/// A stand-on ship that broke a rule herself is not excused for a close pass. Where every rule that
/// she broke has no formula, the second judge cannot know of it.
fn unwritten_breach(first: &Judgement, verdict: &Verdict, finding: Finding) -> bool {
    let known = |check| check == Check::R17Shall || stl::WITH_FORMULA.contains(&check);
    let broke = |v: &&Verdict| {
        v.target == verdict.target && v.status == Status::Fail && v.check != Check::Safe
    };
    let mut breaches = first.verdicts.iter().filter(broke).peekable();
    verdict.check == Check::Safe
        && verdict.detail == "FAIL-8D"
        && finding == Finding::Holds
        && breaches.peek().is_some()
        && breaches.all(|v| !known(v.check))
}

/// Section 12: negative where the first judge says FAIL, positive where it says PASS or WARN. A
/// robustness of 0 lies on the boundary and contradicts nothing; what has no formula is not asked.
/// Rule 19(e) has none either: a failure of it alone says nothing of 19(d)(i) and (ii). Where the
/// first judge found a failure and took it back because another class is within the doubt, what was
/// found first is compared: the second judge asks for the class that decides and for no other, and
/// must have found the same failure. What a duty to another target excused is a pass to the one and
/// untested to the other.
fn agree(verdict: &Verdict, finding: Finding) -> bool {
    use Status::{Fail, Inconclusive, NotApplicable, NotEvaluated, Pass, Warn};
    let only_19e = verdict.status == Fail && verdict.detail == "FAIL-19E";
    let status = if verdict.detail == "AMBIGUOUS" { Fail } else { verdict.status };
    match finding {
        Finding::NotEvaluated | Finding::Undecided => true,
        Finding::Violated => status == Fail && !only_19e,
        Finding::Holds => matches!(status, Pass | Warn) || only_19e,
        Finding::NotApplicable => {
            matches!(status, NotApplicable | NotEvaluated)
                || verdict.detail.starts_with("EXCUSED-BY")
        }
        Finding::Inconclusive => status == Inconclusive || only_19e,
    }
}
