//! Weighted campaigns: what a page shows instead of shares of the draws and their exact bounds.

use crate::figure::DataTable;
use crate::number::{NONE, count, per_cent, per_cent_or_none, significant};
use record::{Check, Status};
use summary::{BoundedRate, PairedRates, StratumSummary, WeightedRate, WeightedRatio};

/// Under the table of strata.
pub(crate) const NOTE: &str = concat!(
    "Small: two-sided 95 % betting bounds of the weighted rate, for each line by itself; counts ",
    "are of the draws. Runs of unknown outcome stay in n and count as failures in the upper ",
    "bound. –: the quantile falls among runs that never acted, or whose distance is unknown; ",
    "reaction times and distances are of the draws."
);
/// The same without weights.
pub(crate) const NOTE_PLAIN: &str = concat!(
    "Small: exact two-sided 95 % bounds (Clopper-Pearson) of each line by itself. Runs of unknown ",
    "outcome stay in n and count as failures in the upper bound. –: the quantile falls among ",
    "runs that never acted, or whose distance is unknown."
);

/// The same summary, its headline rates, ratios and bounds those of the population that the weights
/// stand for; unchanged where there are none. Counts stay those of the draws.
pub(crate) fn shown(mut summary: StratumSummary) -> StratumSummary {
    let Some(weighted) = &summary.weighted else { return summary };
    let rate = |of: &mut BoundedRate, weighted: &WeightedRate| {
        of.rate = weighted.rate;
        (of.lower_95, of.upper_95) = (weighted.lower_95, weighted.upper_95);
    };
    rate(&mut summary.collision, &weighted.collision);
    rate(&mut summary.safety_radius, &weighted.safety_radius);
    let ratio = |of: &mut PairedRates, weighted: &WeightedRatio| {
        of.risk_ratio = weighted.ratio;
        (of.lower_95, of.upper_95) = (Some(weighted.lower_95), weighted.upper_95);
    };
    ratio(&mut summary.collision_pairs, &weighted.collision_ratio);
    ratio(&mut summary.safety_radius_pairs, &weighted.safety_radius_ratio);
    summary
}

/// The rate of failures of a check where it applied, of the population where there are weights.
pub(crate) fn check_rate(summary: &StratumSummary, check: Check) -> BoundedRate {
    let counts = summary.checks.get(&check);
    let of = |status: Status| counts.and_then(|all| all.get(&status)).copied().unwrap_or(0);
    let mut rate = summary::check_rate(of);
    if let Some(share) = summary.weighted.as_ref().and_then(|w| w.checks.get(&check)) {
        take(&mut rate, share);
    }
    rate
}

/// Takes over the rate and the bounds of the population.
pub(crate) fn take(rate: &mut BoundedRate, share: &WeightedRatio) {
    rate.rate = share.ratio;
    (rate.lower_95, rate.upper_95) = (share.lower_95, share.upper_95.unwrap_or(1.0));
}

/// What a figure of counts says besides where runs are weighted.
pub(crate) const fn of_draws(weighted: bool) -> &'static str {
    if weighted {
        " Counts and shares are of the draws, not of the weighted population."
    } else {
        ""
    }
}

/// What the bounds of a part of the runs are where nothing bounds its weighted share.
pub(crate) fn part_bounds(rate: &BoundedRate, weighted: bool) -> String {
    if weighted { NONE.to_owned() } else { crate::page::bounds(rate) }
}

/// The weighted rates of each stratum with what they rest on; `None` without weights.
pub(crate) fn table(strata: &[StratumSummary]) -> Option<DataTable> {
    let mut table = DataTable::new(&[
        "stratum",
        "draws",
        "worth, unweighted",
        "largest weight",
        "event",
        "draws with it",
        "rate",
        "95 % bounds",
        "95 % approximate",
        "effective events",
        "largest share",
    ]);
    for s in strata {
        let Some(weighted) = &s.weighted else { continue };
        for (event, k, rate) in [
            ("collision", s.collision.k, &weighted.collision),
            ("safety radius broken", s.safety_radius.k, &weighted.safety_radius),
        ] {
            table.push(vec![
                s.name.clone(),
                count(s.n),
                s.n_effective.map_or_else(|| count(s.n), |n| significant(n, 4)),
                significant(weighted.weight_max, 3),
                event.to_owned(),
                count(k),
                per_cent_or_none(rate.rate),
                format!("{} to {}", per_cent(rate.lower_95), per_cent(rate.upper_95)),
                rate.approximate_95.map_or_else(
                    || NONE.to_owned(),
                    |[low, high]| format!("{} to {}", per_cent(low), per_cent(high)),
                ),
                significant(rate.events_effective, 3),
                per_cent(rate.share_max),
            ]);
        }
    }
    (!table.rows.is_empty()).then_some(table)
}
