//! The verdict as JUnit XML, the one form of test results that every CI reads.
//!
//! A FAIL is a failure; INCONCLUSIVE and "not demonstrated" are errors: not shown is not passed.

use crate::GateReport;
use crate::text::{Certain, metric_word, replay_command};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use stats::LayerVerdict;

/// The XML.
pub fn xml(report: &GateReport, folder: &str) -> Result<String, String> {
    let result = &report.result;
    let mut junit = Report::new("seatrial gate");
    let mut corpus = TestSuite::new("corpus");
    corpus.add_test_case(layer_case("corpus", result.corpus));
    for broken in &report.corpus.broken {
        let mut case = TestCase::new(&*broken.name, status(LayerVerdict::Fail, "newly broken"));
        if let Some(reason) = broken.waived.as_ref().filter(|reason| !reason.trim().is_empty()) {
            case = TestCase::new(&*broken.name, TestCaseStatus::success());
            case.set_system_out(format!("waived: {reason}"));
        }
        corpus.add_test_case(case);
    }
    let mut comparison = TestSuite::new("comparison");
    for metric in &result.metrics {
        let verdict = match (metric.harmed, metric.passed_at) {
            (Some(_), _) => LayerVerdict::Fail,
            (None, Some(_)) => LayerVerdict::Pass,
            (None, None) => LayerVerdict::Inconclusive,
        };
        let Certain { breaks, fixes, .. } = Certain::of(metric);
        let words = format!(
            "{}: {breaks} breaks, {fixes} fixes, {} undetermined in {} pairs",
            metric_word(metric),
            metric.undetermined,
            result.pairs
        );
        comparison.add_test_case(TestCase::new(&*metric.name, status(verdict, &words)));
    }
    let mut absolute = TestSuite::new("absolute");
    for entry in &result.absolutes {
        let words = format!("{} events in {}", entry.events_demonstrated, entry.n);
        absolute.add_test_case(TestCase::new(&*entry.name, status(entry.verdict, &words)));
    }
    let mut ratchet = TestSuite::new("ratchet");
    for arm in &result.ratchets {
        let passed = arm.passed_at.is_some();
        let verdict = if passed { LayerVerdict::Pass } else { LayerVerdict::Inconclusive };
        let name = format!("{} / {}", arm.arm, arm.metric);
        ratchet.add_test_case(TestCase::new(name, status(verdict, "not shown")));
    }
    let mut failures = TestSuite::new("new failures");
    for failure in report.new_failures.iter().take(crate::text::SHOWN) {
        // shown, not counted: what they mean for the verdict stands in the comparison
        let mut case = TestCase::new(failure.encounter.to_string(), TestCaseStatus::success());
        let command = replay_command(folder, &failure.encounter);
        case.set_system_out(format!("{}\n{command}", failure.sentence()));
        failures.add_test_case(case);
    }
    junit.add_test_suites([corpus, comparison, absolute, ratchet, failures]);
    junit.to_string().map_err(|e| e.to_string())
}

fn layer_case(name: &str, verdict: LayerVerdict) -> TestCase {
    TestCase::new(name, status(verdict, crate::text::layer_word(verdict)))
}

fn status(verdict: LayerVerdict, words: &str) -> TestCaseStatus {
    let mut status = match verdict {
        LayerVerdict::Pass => TestCaseStatus::success(),
        LayerVerdict::NotAsked => TestCaseStatus::skipped(),
        LayerVerdict::Fail => TestCaseStatus::non_success(NonSuccessKind::Failure),
        LayerVerdict::Inconclusive => TestCaseStatus::non_success(NonSuccessKind::Error),
    };
    status.set_message(words.to_owned());
    status
}
