//! Every planner that a campaign can name: one line each.

use crate::controls::{
    AlwaysPort, BlindToNearest, Destructive, DestructiveOptions, Dribble, DribbleOptions, Fault,
    Late, LateOptions,
};
use crate::corrected::{CorrectedOptions, ZhuangCorrected};
use crate::hold_course::{HoldCourse, NoOptions};
use crate::sb_mpc::{SbMpc, SbMpcOptions};
use crate::vo::{KuwataOptions, KuwataVo, PlainVo, PlainVoOptions};
use crate::zhuang::{Zhuang, ZhuangOptions};
use planner_api::{Options, OptionsError, Planner, PlannerEntry, Registry};
use serde::{Serialize, de::DeserializeOwned};

/// The planners of this crate, in the order of reports.
pub fn registry() -> Registry {
    let zhuang = |options: ZhuangOptions| {
        options.check()?;
        Ok(Zhuang::new(options))
    };
    let entry_zhuang = |name, summary, options| entry(name, summary, options, zhuang);
    Registry::new()
        .with(entry_zhuang(
            "zhuang-as-printed",
            "the paper's planner letter by letter, misprints included",
            ZhuangOptions::as_printed(),
        ))
        .with(entry_zhuang(
            "zhuang",
            "the paper's planner with consistent equations and no memory",
            ZhuangOptions::default(),
        ))
        .with(entry_zhuang(
            "zhuang-goal-first",
            "reading: every beat starts from the goal velocity",
            ZhuangOptions::goal_first(),
        ))
        .with(entry_zhuang(
            "zhuang-when-safe",
            "reading: the goal velocity is ordered unchecked once the present one is safe",
            ZhuangOptions::when_safe(),
        ))
        .with(entry_zhuang(
            "zhuang-class-in-beat",
            "reading: the class of a target holds for the passes of one beat",
            ZhuangOptions::class_in_beat(),
        ))
        .with(entry_zhuang(
            "zhuang-latched",
            "its smallest repair: class and side are kept until past and clear",
            ZhuangOptions::latched(),
        ))
        .with(entry(
            "zhuang-corrected",
            "the repairs that COLREGS ask for",
            CorrectedOptions::default(),
            |options: CorrectedOptions| options.check().map(|()| ZhuangCorrected::new(options)),
        ))
        .with(entry(
            "kuwata-vo",
            "velocity obstacles with the regions that the rules forbid (Kuwata et al. 2014)",
            KuwataOptions::default(),
            |options: KuwataOptions| options.check().map(|()| KuwataVo::new(options)),
        ))
        .with(entry(
            "sb-mpc",
            "simulation-based model-predictive control (Johansen et al. 2016)",
            SbMpcOptions::default(),
            |options: SbMpcOptions| options.check().map(|()| SbMpc::new(options)),
        ))
        .with(entry(
            "plain-vo",
            "velocity obstacles, blind to the rules (Fiorini & Shiller 1998)",
            PlainVoOptions::default(),
            |options: PlainVoOptions| options.check().map(|()| PlainVo::new(options)),
        ))
        .with(caught_by(
            entry("hold-course", "follows its route and never acts", NoOptions {}, |_| {
                Ok(HoldCourse::default())
            }),
            "SAFE: it keeps the miss distance that the encounter was made with",
        ))
        .with(caught_by(
            entry("always-port", "alters to port for every danger", NoOptions {}, |_| {
                Ok(AlwaysPort::default())
            }),
            "TURN: port in head-on and crossing encounters; R14 (FAIL-14-PORT), R17 (17(c))",
        ))
        .with(caught_by(
            entry(
                "sign-flip",
                "port and starboard exchanged in every choice",
                NoOptions {},
                |_| Ok(Zhuang::new(ZhuangOptions::default()).with_sides_exchanged()),
            ),
            "TURN: port in head-on encounters; R15 (FAIL-15-AHEAD) in crossing from starboard",
        ))
        .with(caught_by(
            entry("late", "acts 60 seconds late", LateOptions::default(), |o: LateOptions| {
                o.check().map(|()| Late::new(o))
            }),
            "R8-TIME/R16: reaction later than the rule set's `react_fail_s`",
        ))
        .with(caught_by(
            entry("blind-to-nearest", "does not see the nearest target", NoOptions {}, |_| {
                Ok(BlindToNearest::default())
            }),
            "SAFE: with a single target it keeps the miss distance of the encounter",
        ))
        .with(caught_by(
            entry(
                "dribble",
                "many small alterations",
                DribbleOptions::default(),
                |o: DribbleOptions| o.check().map(|()| Dribble::new(o)),
            ),
            "R8-MAG: three or more small alterations to the same side",
        ))
        .with(destructive("nan", Fault::Nan, "outcome planner_non_finite"))
        .with(destructive("panics", Fault::Panics, "outcome planner_panicked"))
        .with(destructive("spins", Fault::Spins, "outcome planner_hung"))
        .with(destructive("aborts", Fault::Aborts, "outcome planner_crashed"))
        .with(destructive("overflows", Fault::Overflows, "outcome planner_crashed"))
}

fn destructive(name: &'static str, fault: Fault, verdict: &str) -> PlannerEntry {
    let summary = match fault {
        Fault::Nan => "orders NaN",
        Fault::Panics => "panics",
        Fault::Spins => "never returns",
        Fault::Aborts => "aborts its process",
        Fault::Overflows => "overflows its stack",
    };
    let summary = format!("{summary} in a share of the encounters, else as `zhuang`");
    let make = move |options: DestructiveOptions| Destructive::new(fault, &options);
    caught_by(entry(name, &summary, DestructiveOptions::default(), make), verdict)
}

/// One line: its options are a struct, of which the default is shown in a resolved campaign.
fn entry<T, P>(
    name: &'static str,
    summary: &str,
    options: T,
    make: impl Fn(T) -> Result<P, String> + Send + Sync + 'static,
) -> PlannerEntry
where
    T: Serialize + DeserializeOwned,
    P: Planner + 'static,
{
    let bad = move |reason: String| OptionsError::BadValue { planner: name.to_owned(), reason };
    PlannerEntry {
        name: name.to_owned(),
        summary: summary.to_owned(),
        caught_by: None,
        options: Options::try_from(options).expect("options are a flat table of plain values"),
        make: Box::new(move |table| {
            let options: T = table.clone().try_into().map_err(|e| bad(one_line(&e)))?;
            let planner = make(options).map_err(bad)?;
            Ok(Box::new(planner))
        }),
    }
}

/// Marks a negative control with the verdict that must catch it.
fn caught_by(mut entry: PlannerEntry, verdict: &str) -> PlannerEntry {
    entry.caught_by = Some(verdict.to_owned());
    entry
}

/// The toml crate puts the key on a second line.
fn one_line(error: &toml::de::Error) -> String {
    error.to_string().lines().collect::<Vec<_>>().join(" ").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(name: &str, changes: &str) -> Result<(), OptionsError> {
        let registry = registry();
        let entry = registry.get(name)?;
        let changes: Options = changes.parse().unwrap();
        (entry.make)(&entry.resolve(&changes)?).map(|_| ())
    }

    #[test]
    fn every_line_makes_a_planner_from_its_own_options() {
        for entry in registry().entries() {
            assert!((entry.make)(&entry.options).is_ok(), "{}", entry.name);
        }
    }

    #[test]
    fn options_are_read_and_refused_with_their_name() {
        assert_eq!(made("zhuang", "resume = 'goal-first'\nmemory = 'class-in-beat'"), Ok(()));
        let text = |r: Result<(), OptionsError>| r.unwrap_err().to_string();
        let wrong = text(made("zhuang", "resume = 'never'"));
        assert!(wrong.contains("planner `zhuang`") && wrong.contains("goal-first"), "{wrong}");
        assert!(wrong.contains("resume"), "{wrong}");
        let range = text(made("zhuang", "head_on_half_angle_deg = 90.0"));
        assert!(range.contains("from 0 to 67.5"), "{range}");
        let nan = text(made("zhuang", "radius_factor = nan"));
        assert!(nan.contains("radius_factor"), "{nan}");
        let key = text(made("hold-course", "speed = 1"));
        assert!(key.contains("no options"), "{key}");
        assert!(text(made("zhang", "")).contains("zhuang-latched"));
    }
}
