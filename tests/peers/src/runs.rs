//! The combinations of libraries, methods, problems and tolerances. The first series of each
//! problem is ours, with the default of our runs if there is one.

use dynamics::Method;

use crate::libraries::{
    with_differential_equations as de, with_diffsol as ds, with_dynamics, with_integrators as ours,
};
use crate::measure::{Breaks, Outcome, Run, Series};
use crate::problem::{Asked, Counted, Problem, Solved};
use crate::problems::arenstorf::{self, Arenstorf};
use crate::problems::mechanism::{CaseError, MovingCase, OnKeptRows};
use crate::problems::robertson::{self, Robertson};

/// Relative tolerances 10⁻⁴ … 10⁻¹².
const EXPONENTS: std::ops::RangeInclusive<i32> = 4..=12;

/// The exponents for Robertson's reaction, for which the absolute tolerance must not become
/// effectively zero.
const EXPONENTS_OF_ROBERTSON: std::ops::RangeInclusive<i32> = 4..=10;

/// A method of a library on a problem P.
type Solve<P, const N: usize> = fn(&Counted<'_, P>, &Asked<'_, N>) -> Solved<N>;

/// States of mechanisms of seven planar bodies, [q; v].
const N: usize = 42;

/// Absolute tolerance divided by the relative one, as in the defaults of `dynamics`.
const ATOL: f64 = 1e-2;

/// A mechanism simulated by our runs, and its right-hand side integrated by all libraries.
///
/// # Errors
/// Returns an error if the mechanism does not move.
pub fn of_mechanism<'c>(
    problem: &'static str,
    case: &'c MovingCase,
) -> Result<Vec<Run<'c>>, CaseError> {
    let y0: [f64; N] = case.start()?;
    let asked = |rtol: f64, break_times| Asked {
        y0,
        t_end: case.t_end,
        break_times,
        rtol,
        atol: ATOL * rtol,
        first_step: None,
    };
    let times = case.break_times();
    let kinds: &[(Breaks, &[f64])] = match times {
        [] => &[(Breaks::None, &[])],
        _ => &[(Breaks::Honoured, times), (Breaks::Ignored, &[])],
    };
    let (as_they_are, _) = kinds[0];
    let mut runs = Vec::new();
    let methods = [Method::Dop853, Method::Tsit5, Method::Radau5];
    for method in methods {
        let series = Series {
            problem,
            library: "dynamics",
            method: method.name(),
            breaks: as_they_are,
        };
        for rtol in tolerances(EXPONENTS) {
            let asked = asked(rtol, times);
            let go = move || {
                done(with_dynamics::run(method, &case.prepared, &asked)?, |y| {
                    case.error(y)
                })
            };
            runs.push(run(&series, rtol, asked.atol, go));
        }
    }
    let plain: [(&str, &str, Solve<OnKeptRows<'c>, N>); 7] = [
        ("integrators", "dop853", ours::dop853),
        ("integrators", "tsit5", ours::tsit5),
        ("integrators", "radau5", ours::radau5),
        ("differential-equations", "dop853", de::dop853),
        ("differential-equations", "radau5", de::radau5),
        ("diffsol", "tsit45", ds::tsit45),
        ("diffsol", "bdf", ds::bdf),
    ];
    for (library, method, solve) in plain {
        for &(breaks, times) in kinds {
            let series = Series {
                problem,
                library,
                method,
                breaks,
            };
            for rtol in tolerances(EXPONENTS) {
                let asked = asked(rtol, times);
                let right_hand_side = OnKeptRows::new(&case.prepared)?;
                let go = move || {
                    done(solve(&Counted::new(&right_hand_side), &asked)?, |y| {
                        case.error(y)
                    })
                };
                runs.push(run(&series, rtol, asked.atol, go));
            }
        }
    }
    Ok(runs)
}

/// The orbit, with equal relative and absolute tolerances.
pub fn of_arenstorf() -> Vec<Run<'static>> {
    let methods: [(&str, &str, Solve<Arenstorf, 4>); 6] = [
        ("integrators", "dop853", ours::dop853),
        ("integrators", "dopri5", ours::dopri5),
        ("integrators", "tsit5", ours::tsit5),
        ("differential-equations", "dop853", de::dop853),
        ("differential-equations", "dopri5", de::dopri5),
        ("diffsol", "tsit45", ds::tsit45),
    ];
    let asked = |rtol| Asked {
        y0: arenstorf::START,
        t_end: arenstorf::PERIOD,
        break_times: &[],
        rtol,
        atol: rtol,
        first_step: None,
    };
    of_formula(
        "arenstorf",
        &Arenstorf,
        &methods,
        EXPONENTS,
        asked,
        arenstorf::error,
    )
}

/// The reaction with its Jacobian. At the end y₂ is 10⁻¹³. Therefore atol = 10⁻⁸·rtol for all
/// components, because the libraries accept only a single value.
pub fn of_robertson() -> Vec<Run<'static>> {
    let methods: [(&str, &str, Solve<Robertson, 3>); 3] = [
        ("integrators", "radau5", ours::radau5_with_jacobian),
        ("differential-equations", "radau5", de::radau5_with_jacobian),
        ("diffsol", "bdf", ds::bdf_with_jacobian),
    ];
    let asked = |rtol| Asked {
        y0: robertson::START,
        t_end: robertson::T_END,
        break_times: &[],
        rtol,
        atol: 1e-8 * rtol,
        first_step: Some(robertson::FIRST_STEP),
    };
    of_formula(
        "robertson",
        &Robertson,
        &methods,
        EXPONENTS_OF_ROBERTSON,
        asked,
        robertson::error,
    )
}

fn of_formula<P: Problem<N>, const N: usize>(
    problem: &'static str,
    right_hand_side: &'static P,
    methods: &[(&'static str, &'static str, Solve<P, N>)],
    exponents: std::ops::RangeInclusive<i32>,
    asked: impl Fn(f64) -> Asked<'static, N>,
    error: fn(&[f64; N]) -> f64,
) -> Vec<Run<'static>> {
    let mut runs = Vec::new();
    for &(library, method, solve) in methods {
        let series = Series {
            problem,
            library,
            method,
            breaks: Breaks::None,
        };
        for rtol in tolerances(exponents.clone()) {
            let asked = asked(rtol);
            let go = move || done(solve(&Counted::new(right_hand_side), &asked)?, error);
            runs.push(run(&series, rtol, asked.atol, go));
        }
    }
    runs
}

fn tolerances(exponents: std::ops::RangeInclusive<i32>) -> impl Iterator<Item = f64> {
    exponents.map(|e| 10f64.powi(-e))
}

fn run<'p>(
    series: &Series,
    rtol: f64,
    atol: f64,
    go: impl Fn() -> Result<Outcome, String> + 'p,
) -> Run<'p> {
    Run {
        series: series.clone(),
        rtol,
        atol,
        go: Box::new(go),
    }
}

/// The result of a run; an end that is not finite is a failure.
fn done<const N: usize>(
    end: crate::problem::End<N>,
    error: impl Fn(&[f64; N]) -> f64,
) -> Result<Outcome, String> {
    let error = error(&end.y);
    if error.is_finite() {
        Ok(Outcome {
            error,
            evaluations: end.evaluations,
            steps: end.steps,
        })
    } else {
        Err("the end is no number, and no error was reported".to_owned())
    }
}
