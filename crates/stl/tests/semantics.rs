//! Robustness: values worked out by hand, numbers of another monitor, and laws.

use proptest::prelude::*;
use stl::{Comparison, Formula, Predicate, Signals, Window, bounds, robustness, truth};

/// Known answers computed with rtamt 0.4.10 (`StlDiscreteTimeSpecification`, offline) on
/// a = [3, -1, 2, 0.5, -2, 4, 1.5, -0.5], b = [-3, -2, 1, -4, 2.5, -1, 0.25, -6].
/// They settle two points that prose leaves open: `a until b` asks nothing of `a` at the very
/// sample where `b` holds, and windows are clipped at the end of the trace.
#[test]
fn agrees_with_rtamt() {
    let inf = f64::INFINITY;
    let a = || above("a", 0.0);
    let b = || above("b", 0.0);
    let steady = || above("a", 0.5);
    let window = Window::between;
    let cases: Vec<(&str, Formula, [f64; 8])> = vec![
        (
            "(a >= 0.5) until (b >= 0)",
            steady().until(b()),
            [-1.5, -1.5, 1.0, 0.0, 2.5, 0.25, 0.25, -6.0],
        ),
        (
            "(a >= 0.5) until[0,2] (b >= 0)",
            until(window(0, 2), steady(), b()),
            [-1.5, -1.5, 1.0, 0.0, 2.5, 0.25, 0.25, -6.0],
        ),
        (
            "(a >= 0.5) until[1,3] (b >= 0)",
            until(window(1, 3), steady(), b()),
            [-1.5, -1.5, 0.0, 0.0, -2.5, 0.25, -6.0, -inf],
        ),
        (
            "always[1,3] (a <= 1)",
            always(window(1, 3), below("a", 1.0)),
            [-1.0, -1.0, -3.0, -3.0, -3.0, -0.5, 1.5, inf],
        ),
        (
            "eventually[1,3] (a <= 1)",
            eventually(window(1, 3), below("a", 1.0)),
            [2.0, 3.0, 3.0, 3.0, 1.5, 1.5, 1.5, -inf],
        ),
        (
            "always (a >= 0)",
            always(Window::UNBOUNDED, a()),
            [-2.0, -2.0, -2.0, -2.0, -2.0, -0.5, -0.5, -0.5],
        ),
        (
            "eventually (b >= 0)",
            eventually(Window::UNBOUNDED, b()),
            [2.5, 2.5, 2.5, 2.5, 2.5, 0.25, 0.25, -6.0],
        ),
        (
            "once[1,2] (a >= 0)",
            Formula::Once(window(1, 2), Box::new(a())),
            [-inf, 3.0, 3.0, 2.0, 2.0, 0.5, 4.0, 4.0],
        ),
        (
            "historically[1,2] (a >= 0)",
            Formula::Historically(window(1, 2), Box::new(a())),
            [inf, 3.0, -1.0, -1.0, 0.5, -2.0, -2.0, 1.5],
        ),
        (
            "historically[0,3] (b <= 1)",
            Formula::Historically(window(0, 3), Box::new(below("b", 1.0))),
            [4.0, 3.0, 0.0, 0.0, -1.5, -1.5, -1.5, -1.5],
        ),
        (
            "once (a >= 3.5)",
            Formula::Once(Window::UNBOUNDED, Box::new(above("a", 3.5))),
            [-0.5, -0.5, -0.5, -0.5, -0.5, 0.5, 0.5, 0.5],
        ),
        (
            "historically (a >= 3.5)",
            Formula::Historically(Window::UNBOUNDED, Box::new(above("a", 3.5))),
            [-0.5, -4.5, -4.5, -4.5, -5.5, -5.5, -5.5, -5.5],
        ),
        (
            "(a >= 0) implies (eventually[0,2] (b >= 0))",
            a().implies(eventually(window(0, 2), b())),
            [1.0, 1.0, 2.5, 2.5, 2.5, 0.25, 0.25, 0.5],
        ),
        (
            "not((a >= 0) and (b >= 0)) or (a <= 1)",
            a().and(b()).negated().or(below("a", 1.0)),
            [3.0, 2.0, -1.0, 4.0, 3.0, 1.0, -0.25, 6.0],
        ),
        (
            "always[0,2] (eventually[0,1] (a >= 0 or b >= 0))",
            always(window(0, 2), eventually(window(0, 1), a().or(b()))),
            [2.0, 2.0, 2.0, 2.5, 1.5, -0.5, -0.5, -0.5],
        ),
    ];
    let signals = Signals::new(8)
        .with("a", vec![3.0, -1.0, 2.0, 0.5, -2.0, 4.0, 1.5, -0.5])
        .with("b", vec![-3.0, -2.0, 1.0, -4.0, 2.5, -1.0, 0.25, -6.0]);
    for (name, formula, expected) in cases {
        let rho = robustness(&formula, &signals).unwrap();
        assert!(same(&rho, &expected), "{name}: {rho:?}, expected {expected:?}");
    }
}

#[test]
fn a_scaled_predicate_is_clipped() {
    let predicate =
        Predicate { signal: "x_deg", op: Comparison::AtLeast, constant: 10.0, scale: Some(10.0) };
    let signals = Signals::new(4).with("x_deg", vec![10.0, 13.0, 45.0, -30.0]);
    let rho = robustness(&Formula::Predicate(predicate), &signals).unwrap();
    assert!(same(&rho, &[0.0, 0.3, 1.0, -1.0]), "{rho:?}");
}

#[test]
fn a_window_beyond_the_end_is_reported_and_not_trusted() {
    let signals = Signals::new(3).with("a", vec![1.0, 2.0, 3.0]);
    let safe = always(Window::UNBOUNDED, above("a", 0.0));
    // The finite trace satisfies it, and yet the next sample may break it.
    assert!(same(&robustness(&safe, &signals).unwrap(), &[1.0, 2.0, 3.0]));
    let open = bounds(&safe, &signals).unwrap()[0];
    assert!(open.lower.is_infinite() && open.lower < 0.0);
    assert!(same(&[open.upper], &[1.0]));
    // A violation that was recorded stays one.
    let low = bounds(&always(Window::UNBOUNDED, above("a", 2.5)), &signals).unwrap()[0];
    assert!(low.upper < 0.0);
    // A bounded window inside the trace is settled, the same one a sample later is not.
    let near = bounds(&eventually(Window::between(0, 2), above("a", 2.5)), &signals).unwrap();
    assert!(same(&[near[0].lower, near[0].upper], &[0.5, 0.5]));
    assert!(same(&[near[1].lower], &[0.5]) && near[1].upper.is_infinite());
}

#[test]
fn empty_windows_have_the_value_of_the_definition() {
    let signals = Signals::new(1).with("a", vec![1.0]);
    let a = || Box::new(above("a", 0.0));
    let late = Window::between(4, 6);
    for (formula, value) in [
        (Formula::Always(late, a()), f64::INFINITY),
        (Formula::Eventually(late, a()), f64::NEG_INFINITY),
        (Formula::Until(late, a(), a()), f64::NEG_INFINITY),
        (Formula::Once(late, a()), f64::NEG_INFINITY),
        (Formula::Historically(late, a()), f64::INFINITY),
        (Formula::And(vec![]), f64::INFINITY),
        (Formula::Or(vec![]), f64::NEG_INFINITY),
    ] {
        assert!(same(&robustness(&formula, &signals).unwrap(), &[value]), "{formula:?}");
    }
}

#[test]
fn a_window_without_end_may_begin_later() {
    let signals = Signals::new(4).with("a", vec![-5.0, 3.0, 1.0, 2.0]);
    let from_2 = Window { from: 2, to: None };
    let least = robustness(&always(from_2, above("a", 0.0)), &signals).unwrap();
    assert!(same(&least, &[1.0, 2.0, f64::INFINITY, f64::INFINITY]), "{least:?}");
    let most = robustness(&eventually(from_2, above("a", 0.0)), &signals).unwrap();
    assert!(same(&most, &[2.0, 2.0, f64::NEG_INFINITY, f64::NEG_INFINITY]), "{most:?}");
}

/// Below, at and above the constant.
#[test]
fn strict_and_non_strict_differ_at_equality_only() {
    let signals = Signals::new(3).with("a", vec![1.0, 2.0, 3.0]);
    for (op, expected) in [
        (Comparison::Above, [false, false, true]),
        (Comparison::AtLeast, [false, true, true]),
        (Comparison::Below, [true, false, false]),
        (Comparison::AtMost, [true, true, false]),
    ] {
        let predicate = Predicate { signal: "a", op, constant: 2.0, scale: None };
        let found = [0, 1, 2].map(|t| truth(&Formula::Predicate(predicate), &signals, t).unwrap());
        assert_eq!(found, expected, "{op:?}");
    }
    assert!(signals.is_finite() && !signals.with("b", vec![1.0, f64::NAN, 2.0]).is_finite());
}

#[test]
fn an_unknown_signal_is_named() {
    let signals = Signals::new(1).with("range_m", vec![1.0]);
    let error = robustness(&above("b", 0.0), &signals).unwrap_err();
    assert_eq!(error.to_string(), "find signal `b`; there are [\"range_m\"]");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn sign_agrees_with_truth(formula in formulas(), signals in signals()) {
        let rho = robustness(&formula, &signals).unwrap();
        for (t, rho) in rho.iter().enumerate() {
            let holds = truth(&formula, &signals, t).unwrap();
            prop_assert!(*rho <= 0.0 || holds, "rho {rho} at {t}, yet false");
            prop_assert!(*rho >= 0.0 || !holds, "rho {rho} at {t}, yet true");
        }
    }

    #[test]
    fn bounds_hold_whatever_follows(
        formula in formulas(), signals in signals(), seen in 1usize..12,
    ) {
        let seen = seen.min(signals.samples());
        let cut = |name| signals.column(name).unwrap()[..seen].to_vec();
        let head = Signals::new(seen).with("a", cut("a")).with("b", cut("b"));
        let whole = robustness(&formula, &signals).unwrap();
        for (bounds, rho) in bounds(&formula, &head).unwrap().iter().zip(whole) {
            prop_assert!(bounds.lower <= rho && rho <= bounds.upper, "{bounds:?} {rho}");
        }
    }

    /// A shift by some samples shifts the robustness of a formula without past operators.
    #[test]
    fn the_future_does_not_know_when_it_started(
        formula in future_formulas(), signals in signals(), by in 1usize..6,
    ) {
        let shifted = |name| {
            let column = signals.column(name).unwrap();
            let mut values = vec![column[0] + 1.0; by];
            values.extend_from_slice(column);
            values
        };
        let late = Signals::new(signals.samples() + by)
            .with("a", shifted("a"))
            .with("b", shifted("b"));
        let rho = robustness(&formula, &signals).unwrap();
        let rho_late = robustness(&formula, &late).unwrap();
        prop_assert!(same(&rho, &rho_late[by..]));
    }
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| a.total_cmp(b).is_eq() || (a - b).abs() < 1e-12)
}

fn above(signal: &'static str, constant: f64) -> Formula {
    let op = Comparison::AtLeast;
    Formula::Predicate(Predicate { signal, op, constant, scale: None })
}

fn below(signal: &'static str, constant: f64) -> Formula {
    let op = Comparison::AtMost;
    Formula::Predicate(Predicate { signal, op, constant, scale: None })
}

fn always(window: Window, formula: Formula) -> Formula {
    Formula::Always(window, Box::new(formula))
}

fn eventually(window: Window, formula: Formula) -> Formula {
    Formula::Eventually(window, Box::new(formula))
}

fn until(window: Window, a: Formula, b: Formula) -> Formula {
    Formula::Until(window, Box::new(a), Box::new(b))
}

/// Half-integers, so that equality happens and rho = 0 is met.
fn signals() -> impl Strategy<Value = Signals> {
    (1usize..14).prop_flat_map(|samples| {
        let column =
            || prop::collection::vec((-6i32..=6).prop_map(|x| f64::from(x) / 2.0), samples);
        (column(), column()).prop_map(move |(a, b)| Signals::new(samples).with("a", a).with("b", b))
    })
}

fn predicates() -> impl Strategy<Value = Formula> {
    use Comparison::{Above, AtLeast, AtMost, Below};
    let op = prop_oneof![Just(Above), Just(AtLeast), Just(Below), Just(AtMost)];
    let scale = prop_oneof![Just(None), Just(Some(2.0))];
    (prop_oneof![Just("a"), Just("b")], op, -4i32..=4, scale).prop_map(|(signal, op, c, scale)| {
        let constant = f64::from(c) / 2.0;
        Formula::Predicate(Predicate { signal, op, constant, scale })
    })
}

fn windows() -> impl Strategy<Value = Window> {
    let bounded = (0usize..5, 0usize..6).prop_map(|(a, l)| Window::between(a, a + l));
    let after = (0usize..4).prop_map(|from| Window { from, to: None });
    prop_oneof![3 => bounded, 1 => after, 2 => Just(Window::UNBOUNDED)]
}

fn future_formulas() -> impl Strategy<Value = Formula> {
    predicates().prop_recursive(4, 24, 3, |inner| {
        let boxed = || inner.clone().prop_map(Box::new);
        prop_oneof![
            boxed().prop_map(Formula::Not),
            prop::collection::vec(inner.clone(), 0..3).prop_map(Formula::And),
            prop::collection::vec(inner.clone(), 0..3).prop_map(Formula::Or),
            (boxed(), boxed()).prop_map(|(a, b)| Formula::Implies(a, b)),
            (windows(), boxed()).prop_map(|(w, a)| Formula::Always(w, a)),
            (windows(), boxed()).prop_map(|(w, a)| Formula::Eventually(w, a)),
            (windows(), boxed(), boxed()).prop_map(|(w, a, b)| Formula::Until(w, a, b)),
        ]
    })
}

fn formulas() -> impl Strategy<Value = Formula> {
    predicates().prop_recursive(4, 24, 3, |inner| {
        let boxed = || inner.clone().prop_map(Box::new);
        prop_oneof![
            boxed().prop_map(Formula::Not),
            prop::collection::vec(inner.clone(), 0..3).prop_map(Formula::And),
            prop::collection::vec(inner.clone(), 0..3).prop_map(Formula::Or),
            (boxed(), boxed()).prop_map(|(a, b)| Formula::Implies(a, b)),
            (windows(), boxed()).prop_map(|(w, a)| Formula::Always(w, a)),
            (windows(), boxed()).prop_map(|(w, a)| Formula::Eventually(w, a)),
            (windows(), boxed(), boxed()).prop_map(|(w, a, b)| Formula::Until(w, a, b)),
            (windows(), boxed()).prop_map(|(w, a)| Formula::Once(w, a)),
            (windows(), boxed()).prop_map(|(w, a)| Formula::Historically(w, a)),
        ]
    })
}
