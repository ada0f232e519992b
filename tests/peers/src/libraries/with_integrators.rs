//! Our integrators on the plain right-hand side: without projection and monitors, as for a user of
//! `integrators` alone.

use std::error::Error;
use std::ops::ControlFlow;

use integrators::{
    DenseImplicit, Differences, Dop853, Dopri5, Function, InitialStep, Interval, Method, Ode,
    Options, Radau5, Tsit5, integrate,
};

use crate::problem::{Asked, Counted, Differentiated, End, Problem, Solved, array};

/// Dormand–Prince 5(4).
pub fn dopri5<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(&Dopri5, function(ode), ode, asked)
}

/// Tsitouras 5(4).
pub fn tsit5<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(&Tsit5, function(ode), ode, asked)
}

/// Dormand–Prince 8(5,3).
pub fn dop853<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    solve(&Dop853, function(ode), ode, asked)
}

/// Radau IIA of order 5, with the Jacobian by differences.
pub fn radau5<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    let problem = DenseImplicit::new(function(ode), Differences::default());
    solve(&Radau5, problem, ode, asked)
}

/// Radau IIA of order 5 with the problem's Jacobian.
pub fn radau5_with_jacobian<const N: usize>(
    ode: &Counted<'_, impl Differentiated<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    let jacobian = |t: f64, y: &[f64], j: &mut [f64]| {
        let mut rows = [[0.0; N]; N];
        ode.jacobian(t, array(y), &mut rows);
        j.copy_from_slice(rows.as_flattened());
    };
    solve(
        &Radau5,
        DenseImplicit::new(function(ode), jacobian),
        ode,
        asked,
    )
}

fn function<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
) -> Function<impl FnMut(f64, &[f64], &mut [f64])> {
    Function::new(N, |t, y: &[f64], dy: &mut [f64]| {
        ode.rhs_of_slices(t, y, dy)
    })
}

fn solve<O: Ode, P, const N: usize>(
    method: &impl Method<O>,
    mut ode: O,
    counted: &Counted<'_, P>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    let interval = Interval {
        t0: 0.0,
        t_end: asked.t_end,
        break_times: asked.break_times,
    };
    let options = Options {
        initial_step: asked
            .first_step
            .map_or(InitialStep::Automatic, InitialStep::Given),
        ..Options::with_tolerance(asked.rtol, asked.atol)
    };
    let end = integrate(method, &mut ode, &interval, &asked.y0, &options, |_| {
        ControlFlow::Continue(())
    })
    .map_err(|failure| in_words(&failure.error))?;
    Ok(End {
        y: *array(&end.y),
        evaluations: counted.evaluations(),
        steps: end.statistics.accepted,
    })
}

fn in_words(error: &dyn Error) -> String {
    error.to_string()
}
