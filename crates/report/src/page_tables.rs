//! Tables of the page that have no picture.

use crate::figure::DataTable;
use crate::group::Group;
use crate::input::ReportInput;
use crate::number::{NONE, count, per_cent_or_none, significant};
use crate::weighted::part_bounds;
use geom::EncounterClass;
use record::{Check, Outcome, Status};
use summary::{PairedRates, StratumSummary, Tally, check_rate};

/// Of weighted runs there are no bounds by class: the counts are of the draws.
pub(crate) fn classes(tally: &Tally, weighted: bool) -> DataTable {
    let mut table = DataTable::new(&[
        "class",
        "n",
        "check",
        "pass",
        "warn",
        "fail",
        "inconclusive",
        "failed of applied",
        "95 % bounds",
    ]);
    for class in EncounterClass::ALL.into_iter().map(Some).chain([None]) {
        for check in Check::ALL {
            let of = |status| tally.check_in_class(class, check, status);
            let rate = check_rate(of);
            if rate.n == 0 {
                continue;
            }
            table.push(vec![
                class.map_or("risk never opened", EncounterClass::name).replace('_', " "),
                count(tally.class(class)),
                check.title().to_owned(),
                count(of(Status::Pass)),
                count(of(Status::Warn)),
                count(of(Status::Fail)),
                count(of(Status::Inconclusive)),
                per_cent_or_none(rate.rate),
                part_bounds(&rate, weighted),
            ]);
        }
    }
    table
}

pub(crate) fn avoiding(whole: &StratumSummary) -> DataTable {
    let mut table = DataTable::new(&[
        "event",
        "without avoiding",
        "removed",
        "left",
        "caused",
        "unknown",
        "ratio",
        "95 % bounds",
        "runs without a nominal track",
    ]);
    let ratio = |value: Option<f64>| value.map_or(NONE.into(), |r| significant(r, 3));
    let mut push = |name: &str, pairs: &PairedRates| {
        table.push(vec![
            name.to_owned(),
            count(pairs.nominal),
            count(pairs.removed),
            count(pairs.left),
            count(pairs.caused),
            count(pairs.unknown),
            ratio(pairs.risk_ratio),
            match pairs.lower_95 {
                Some(_) => format!("{} to {}", ratio(pairs.lower_95), ratio(pairs.upper_95)),
                None => NONE.to_owned(),
            },
            count(pairs.without_nominal),
        ]);
    };
    push("collision", &whole.collision_pairs);
    push("safety radius broken", &whole.safety_radius_pairs);
    table
}

pub(crate) fn outcomes(input: &ReportInput, whole: &Group) -> DataTable {
    let ended: Vec<Outcome> =
        Outcome::ALL.into_iter().filter(|&outcome| whole.tally.outcome(outcome) > 0).collect();
    let mut table = DataTable::new(&["stratum", "n", "drawn", "rejected"]);
    table.head.extend(ended.iter().map(|outcome| outcome.name().replace('_', " ")));
    let several = input.summary.strata.len() > 1;
    for s in input.summary.strata.iter().chain(several.then_some(&whole.summary)) {
        let mut row = vec![s.name.clone(), count(s.n), count(s.generated), count(s.rejected)];
        row.extend(ended.iter().map(|o| count(s.outcomes.get(o).copied().unwrap_or(0))));
        table.push(row);
    }
    table
}
