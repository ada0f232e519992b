//! `differential-equations`: states are arrays, and an observer that stores nothing replaces the
//! one that stores all steps.

use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{ExplicitRungeKutta, ImplicitRungeKutta};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod, solve_ode};
use differential_equations::prelude::{Matrix, Solout, Solution};

use crate::problem::{Asked, Counted, Differentiated, End, Problem, Solved};

// Radau IIA needs a tolerance for each component. The library would replace a single value by
// 0.1·rtol^⅔ once for each component; for 42 components, the result is 10⁻³ for any tolerance.

/// The limit of steps is 10 000 by default. This is the limit of our own methods.
const MAX_STEPS: usize = 1_000_000;

/// Dormand–Prince 5(4).
pub fn dopri5<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(ode, &Plain(ode), asked, || {
        let method = ExplicitRungeKutta::dopri5()
            .rtol(asked.rtol)
            .atol(asked.atol);
        method
            .max_steps(MAX_STEPS)
            .h0(asked.first_step.unwrap_or(0.0))
    })
}

/// Dormand–Prince 8(5,3).
pub fn dop853<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(ode, &Plain(ode), asked, || {
        let method = ExplicitRungeKutta::dop853()
            .rtol(asked.rtol)
            .atol(asked.atol);
        method
            .max_steps(MAX_STEPS)
            .h0(asked.first_step.unwrap_or(0.0))
    })
}

/// Radau IIA of order 5, with the Jacobian by the library's own differences.
pub fn radau5<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(ode, &Plain(ode), asked, || {
        let method = ImplicitRungeKutta::radau5()
            .rtol([asked.rtol; N])
            .atol([asked.atol; N]);
        method
            .max_steps(MAX_STEPS)
            .h0(asked.first_step.unwrap_or(0.0))
    })
}

/// Radau IIA of order 5 with the problem's Jacobian.
pub fn radau5_with_jacobian<const N: usize>(
    ode: &Counted<'_, impl Differentiated<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(ode, &WithJacobian(ode), asked, || {
        let method = ImplicitRungeKutta::radau5()
            .rtol([asked.rtol; N])
            .atol([asked.atol; N]);
        method
            .max_steps(MAX_STEPS)
            .h0(asked.first_step.unwrap_or(0.0))
    })
}

/// The problem with the interface of the library.
struct Plain<'c, 'p, P>(&'c Counted<'p, P>);

impl<P: Problem<N>, const N: usize> ODE<f64, [f64; N]> for Plain<'_, '_, P> {
    fn diff(&self, t: f64, y: &[f64; N], dydt: &mut [f64; N]) {
        self.0.rhs(t, y, dydt);
    }
}

/// The same with its Jacobian.
struct WithJacobian<'c, 'p, P>(&'c Counted<'p, P>);

impl<P: Differentiated<N>, const N: usize> ODE<f64, [f64; N]> for WithJacobian<'_, '_, P> {
    fn diff(&self, t: f64, y: &[f64; N], dydt: &mut [f64; N]) {
        self.0.rhs(t, y, dydt);
    }

    fn jacobian(&self, t: f64, y: &[f64; N], j: &mut Matrix<f64>) {
        let mut rows = [[0.0; N]; N];
        self.0.jacobian(t, y, &mut rows);
        for (i, row) in rows.iter().enumerate() {
            for (k, entry) in row.iter().enumerate() {
                j[(i, k)] = *entry;
            }
        }
    }
}

/// An observer that stores nothing.
struct Nothing;

impl<const N: usize> Solout<f64, [f64; N]> for Nothing {
    fn solout<I: Interpolation<f64, [f64; N]> + ?Sized>(
        &mut self,
        _t: f64,
        _t_before: f64,
        _y: &[f64; N],
        _y_before: &[f64; N],
        _interpolator: &mut I,
        _solution: &mut Solution<f64, [f64; N]>,
    ) -> ControlFlag<f64, [f64; N]> {
        ControlFlag::Continue
    }
}

fn solve<P, F, S, const N: usize>(
    counted: &Counted<'_, P>,
    ode: &F,
    asked: &Asked<'_, N>,
    method: impl Fn() -> S,
) -> Solved<N>
where
    F: ODE<f64, [f64; N]>,
    S: OrdinaryNumericalMethod<f64, [f64; N]> + Interpolation<f64, [f64; N]>,
{
    let (y, steps) = asked.by_legs(|t0, t1, y| {
        let mut method = method();
        let solution = solve_ode(&mut method, ode, t0, t1, y, &mut Nothing).map_err(in_words)?;
        *y = *method.y();
        Ok(solution.steps.accepted as u64)
    })?;
    Ok(End {
        y,
        evaluations: counted.evaluations(),
        steps,
    })
}

/// The kind of an error; its own text repeats the whole state.
fn in_words<const N: usize>(error: differential_equations::error::Error<f64, [f64; N]>) -> String {
    use differential_equations::error::Error;
    match error {
        Error::MaxSteps { t, .. } => format!("too many steps at t = {t:.3e}"),
        Error::StepSize { t, .. } => format!("step size too small at t = {t:.3e}"),
        Error::Stiffness { t, .. } => format!("stiffness detected at t = {t:.3e}"),
        Error::LinearAlgebra { t, msg, .. } => format!("{msg} at t = {t:.3e}"),
        Error::BadInput { msg } => msg,
        _ => "failed".to_owned(),
    }
}
