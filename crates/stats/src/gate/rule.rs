//! The rule: evidence at a look in, an answer out.
//!
//! FAIL when the mean of E_harm over the metrics reaches 1/a_F, or an absolute requirement is
//! violated, or the corpus broke. PASS when every metric and every arm of the ratchet has reached
//! 1/a_P at this or an earlier look (all must, so nothing is corrected for their number) and every
//! absolute requirement is demonstrated. Source: statistics specification, section 5, items 3 to 5.

use super::plan::{AbsolutePlan, AbsoluteTest, GatePlan};
use super::result::{
    AbsoluteResult, GateResult, GateVerdict, Harmed, LayerVerdict, MetricResult, RatchetResult,
};
use super::run::Evidence;
use super::tally::Absolute;
use crate::math::{ln, log_sum_exp, real};
use crate::{Claim, Harm};

/// The answer at this look. A requirement that is tested at a declared N stays inconclusive
/// before the cap, so a plan with one cannot pass early.
pub(super) fn judge(plan: &GatePlan, seen: &Evidence) -> GateResult {
    let harm = Harm::default();
    let harms: Vec<f64> = seen.metrics.iter().map(|m| harm.ln_e(&m.for_fail)).collect();
    let ln_count = ln(real(harms.len() as u64));
    let ln_harm_mean = log_sum_exp(harms.iter().copied()) - ln_count;
    let harm_shown = ln_harm_mean >= -ln(plan.alpha_fail);
    let mut metrics = metric_results(plan, seen, &harms);
    if harm_shown {
        name_harmed(&mut metrics, ln_count - ln(plan.alpha_fail));
    }
    let absolutes = absolute_results(plan, seen);
    let ratchets = ratchet_results(plan, seen);
    let comparison = if harm_shown {
        LayerVerdict::Fail
    } else {
        all_of(metrics.iter().map(|metric| passed(metric.passed_at)))
    };
    let corpus = seen.corpus.verdict();
    let absolute = all_of(absolutes.iter().map(|absolute| absolute.verdict));
    let ratchet = all_of(ratchets.iter().map(|arm| passed(arm.passed_at)));
    GateResult {
        verdict: combine(&[corpus, comparison, absolute, ratchet]),
        pairs: seen.pairs,
        looks: seen.looks,
        cap: plan.cap_pairs(),
        attempt: plan.attempt,
        alpha_pass: plan.alpha_pass_used(),
        corpus,
        comparison,
        absolute,
        ratchet,
        ln_harm_mean,
        metrics,
        absolutes,
        ratchets,
    }
}

/// FAIL if any layer fails, else INCONCLUSIVE if any is, else PASS. A gate that asks nothing at
/// all shows nothing: INCONCLUSIVE.
#[must_use]
pub fn combine(layers: &[LayerVerdict]) -> GateVerdict {
    if layers.contains(&LayerVerdict::Fail) {
        GateVerdict::Fail
    } else if layers.contains(&LayerVerdict::Inconclusive) || !layers.contains(&LayerVerdict::Pass)
    {
        GateVerdict::Inconclusive
    } else {
        GateVerdict::Pass
    }
}

/// The verdict of several requirements of one layer, all of which must hold.
fn all_of(verdicts: impl Iterator<Item = LayerVerdict>) -> LayerVerdict {
    verdicts.fold(LayerVerdict::NotAsked, |so_far, next| match (so_far, next) {
        (LayerVerdict::Fail, _) | (_, LayerVerdict::Fail) => LayerVerdict::Fail,
        (LayerVerdict::Inconclusive, _) | (_, LayerVerdict::Inconclusive) => {
            LayerVerdict::Inconclusive
        }
        (LayerVerdict::Pass, _) | (_, LayerVerdict::Pass) => LayerVerdict::Pass,
        (LayerVerdict::NotAsked, LayerVerdict::NotAsked) => LayerVerdict::NotAsked,
    })
}

fn passed(passed_at: Option<u64>) -> LayerVerdict {
    if passed_at.is_some() { LayerVerdict::Pass } else { LayerVerdict::Inconclusive }
}

/// Names every metric that is worse by itself; if none, the largest, as joint.
fn name_harmed(metrics: &mut [MetricResult], ln_alone: f64) {
    let mut alone = false;
    for metric in metrics.iter_mut().filter(|metric| metric.ln_harm >= ln_alone) {
        metric.harmed = Some(Harmed::Alone);
        alone = true;
    }
    if !alone
        && let Some(largest) = metrics.iter_mut().max_by(|a, b| a.ln_harm.total_cmp(&b.ln_harm))
    {
        largest.harmed = Some(Harmed::Joint);
    }
}

fn metric_results(plan: &GatePlan, seen: &Evidence, harms: &[f64]) -> Vec<MetricResult> {
    let alpha = plan.alpha_pass_used();
    let each = seen.metrics.iter().zip(&plan.metrics).zip(harms);
    each.map(|((comparison, metric), &ln_harm)| {
        let difference = comparison.difference(alpha);
        MetricResult {
            name: metric.name.clone(),
            counts_pass: comparison.for_pass,
            counts_fail: comparison.for_fail,
            undetermined: comparison.undetermined,
            ln_harm,
            harmed: None,
            ln_pass: comparison.test.ln_e(&comparison.for_pass),
            ln_pass_max: comparison.ln_pass_max,
            passed_at: comparison.passed_at,
            difference,
            worse_within_margin: comparison.passed_at.is_some() && difference.lower > 0.0,
            forecast: comparison.forecast(alpha),
        }
    })
    .collect()
}

fn ratchet_results(plan: &GatePlan, seen: &Evidence) -> Vec<RatchetResult> {
    let alpha = plan.alpha_pass_used();
    let mut results = Vec::new();
    for (arm, comparisons) in plan.ratchets.iter().zip(&seen.ratchets) {
        for (metric, comparison) in plan.metrics.iter().zip(comparisons) {
            results.push(RatchetResult {
                arm: arm.name.clone(),
                metric: metric.name.clone(),
                counts: comparison.for_pass,
                ln_pass_max: comparison.ln_pass_max,
                passed_at: comparison.passed_at,
                forecast: comparison.forecast(alpha),
            });
        }
    }
    results
}

fn absolute_results(plan: &GatePlan, seen: &Evidence) -> Vec<AbsoluteResult> {
    let alpha = plan.alpha_absolute_demonstrated();
    let each = seen.absolutes.iter().zip(&plan.absolutes);
    each.map(|(absolute, entry)| AbsoluteResult {
        name: entry.name.clone(),
        events_demonstrated: absolute.events_demonstrated,
        events_violated: absolute.events_violated,
        n: absolute.n,
        ln_demonstrated_max: absolute.ln_demonstrated_max,
        ln_violated_max: absolute.ln_violated_max,
        verdict: absolute_verdict(plan, seen, absolute, entry),
        forecast: absolute.forecast(alpha),
    })
    .collect()
}

fn absolute_verdict(
    plan: &GatePlan,
    seen: &Evidence,
    absolute: &Absolute,
    entry: &AbsolutePlan,
) -> LayerVerdict {
    let alpha = plan.alpha_absolute_demonstrated();
    let requirements = real(plan.absolutes.len() as u64);
    if absolute.ln_violated_max >= ln(requirements) - ln(plan.alpha_absolute) {
        return LayerVerdict::Fail;
    }
    let demonstrated = match entry.test {
        AbsoluteTest::Sequential => absolute.ln_demonstrated_max >= -ln(alpha),
        AbsoluteTest::DeclaredN => {
            // The violated side has its own e-process above; only "demonstrated" is read here.
            seen.pairs == plan.cap_pairs()
                && absolute
                    .claim(alpha)
                    .is_some_and(|c| judge_absolute(&c, entry.rate_max) == LayerVerdict::Pass)
        }
    };
    if demonstrated { LayerVerdict::Pass } else { LayerVerdict::Inconclusive }
}

/// Judges an absolute requirement by an interval made elsewhere, which must be claim-bearing: an
/// approximate one has no [`Claim`]. At or below `rate_max` is demonstrated, above is violated.
#[must_use]
pub fn judge_absolute(claim: &Claim, rate_max: f64) -> LayerVerdict {
    let bounds = claim.estimate();
    if bounds.upper <= rate_max {
        LayerVerdict::Pass
    } else if bounds.lower > rate_max {
        LayerVerdict::Fail
    } else {
        LayerVerdict::Inconclusive
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clopper_pearson;

    #[test]
    fn one_failing_layer_decides_and_one_open_layer_withholds() {
        use LayerVerdict::{Fail, Inconclusive, NotAsked, Pass};
        assert_eq!(combine(&[Pass, Inconclusive, Fail]), GateVerdict::Fail);
        assert_eq!(combine(&[Pass, Inconclusive, NotAsked]), GateVerdict::Inconclusive);
        assert_eq!(combine(&[Pass, Pass, NotAsked]), GateVerdict::Pass);
        assert_eq!(combine(&[NotAsked]), GateVerdict::Inconclusive);
        assert_eq!(all_of([Pass, NotAsked].into_iter()), Pass);
        assert_eq!(all_of([Pass, Inconclusive, Fail].into_iter()), Fail);
        assert_eq!(all_of(std::iter::empty()), NotAsked);
    }

    #[test]
    fn a_claim_judges_a_rate_three_ways() {
        let claim = |k| Claim::try_from(clopper_pearson(k, 1000, 0.05).unwrap()).unwrap();
        assert_eq!(judge_absolute(&claim(0), 0.01), LayerVerdict::Pass);
        assert_eq!(judge_absolute(&claim(10), 0.01), LayerVerdict::Inconclusive);
        assert_eq!(judge_absolute(&claim(50), 0.01), LayerVerdict::Fail);
    }
}
