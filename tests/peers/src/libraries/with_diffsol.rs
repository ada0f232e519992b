//! `diffsol`: closures, dense nalgebra matrices (its faster choice at these sizes), steps without
//! output.

use std::cell::RefCell;

use diffsol::{
    DiffsolError, NalgebraLU, NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod,
    OdeSolverStopReason, Vector,
};

use crate::problem::{Asked, Counted, Differentiated, End, Problem, Solved, array, array_mut};

type M = NalgebraMat<f64>;

/// Tsitouras 5(4).
pub fn tsit45<const N: usize>(
    ode: &Counted<'_, impl Problem<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    by_legs(ode, asked, |t0, t1, y| {
        let start = *y;
        let problem = builder(asked, t0)
            .rhs(|x, _p, t, dx| ode.rhs_of_slices(t, x, dx))
            .init(|_p, _t, x| x.copy_from_slice(&start), N)
            .build()?;
        run(problem.tsit45()?, t1, y)
    })
}

/// Backward differentiation formulas of variable order, products with the Jacobian by differences.
pub fn bdf<const N: usize>(ode: &Counted<'_, impl Problem<N>>, asked: &Asked<'_, N>) -> Solved<N> {
    let differences = Differences::new(ode);
    by_legs(ode, asked, |t0, t1, y| {
        let start = *y;
        let problem = builder(asked, t0)
            .rhs_implicit(
                |x, _p, t, dx| ode.rhs_of_slices(t, x, dx),
                |x, _p, t, v, jv| differences.product(t, array(x), array(v), array_mut(jv)),
            )
            .init(|_p, _t, x| x.copy_from_slice(&start), N)
            .build()?;
        run(problem.bdf::<NalgebraLU<f64>>()?, t1, y)
    })
}

/// Backward differentiation formulas with the problem's Jacobian.
pub fn bdf_with_jacobian<const N: usize>(
    ode: &Counted<'_, impl Differentiated<N>>,
    asked: &Asked<'_, N>,
) -> Solved<N> {
    by_legs(ode, asked, |t0, t1, y| {
        let start = *y;
        let problem = builder(asked, t0)
            .rhs_implicit(
                |x, _p, t, dx| ode.rhs_of_slices(t, x, dx),
                |x, _p, t, v, jv| {
                    let mut j = [[0.0; N]; N];
                    ode.jacobian(t, array(x), &mut j);
                    for (out, row) in jv.iter_mut().zip(&j) {
                        *out = row.iter().zip(v).map(|(a, b)| a * b).sum();
                    }
                },
            )
            .init(|_p, _t, x| x.copy_from_slice(&start), N)
            .build()?;
        run(problem.bdf::<NalgebraLU<f64>>()?, t1, y)
    })
}

fn builder<const N: usize>(asked: &Asked<'_, N>, t0: f64) -> OdeBuilder<M> {
    let builder = OdeBuilder::<M>::new()
        .t0(t0)
        .rtol(asked.rtol)
        .atol([asked.atol]);
    match asked.first_step {
        Some(h) => builder.h0(h),
        None => builder,
    }
}

fn by_legs<P, const N: usize>(
    ode: &Counted<'_, P>,
    asked: &Asked<'_, N>,
    mut leg: impl FnMut(f64, f64, &mut [f64; N]) -> Result<u64, DiffsolError>,
) -> Solved<N> {
    let (y, steps) = asked.by_legs(|t0, t1, y| leg(t0, t1, y).map_err(|e| e.to_string()))?;
    Ok(End {
        y,
        evaluations: ode.evaluations(),
        steps,
    })
}

/// Steps to t1 and copies the state.
fn run<'a, E, S>(mut solver: S, t1: f64, y: &mut [f64]) -> Result<u64, DiffsolError>
where
    E: OdeEquations<T = f64> + 'a,
    E::V: Vector<T = f64>,
    S: OdeSolverMethod<'a, E>,
{
    solver.set_stop_time(t1)?;
    while !matches!(solver.step()?, OdeSolverStopReason::TstopReached) {}
    y.copy_from_slice(&solver.state().y.clone_as_vec());
    Ok(solver.get_statistics().number_of_steps as u64)
}

/// Products J·v by forward differences. At each point, f is evaluated once for all products, so
/// that a dense Jacobian costs N + 1 evaluations, as in the other libraries.
struct Differences<'c, 'p, P, const N: usize> {
    ode: &'c Counted<'p, P>,
    point: RefCell<Point<N>>,
}

struct Point<const N: usize> {
    t: f64,
    x: [f64; N],
    f: [f64; N],
}

impl<'c, 'p, P: Problem<N>, const N: usize> Differences<'c, 'p, P, N> {
    fn new(ode: &'c Counted<'p, P>) -> Self {
        let nowhere = Point {
            t: f64::NAN,
            x: [0.0; N],
            f: [0.0; N],
        };
        Self {
            ode,
            point: RefCell::new(nowhere),
        }
    }

    fn product(&self, t: f64, x: &[f64; N], v: &[f64; N], jv: &mut [f64; N]) {
        let point = &mut *self.point.borrow_mut();
        if point.t != t || point.x != *x {
            (point.t, point.x) = (t, *x);
            self.ode.rhs(t, x, &mut point.f);
        }
        // The increment of the library `differential-equations`: √eps·max(|x_k|, 1) for a unit
        // vector.
        let largest = v.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let moved = x.iter().zip(v).filter(|(_, v)| **v != 0.0);
        let size = moved.fold(1.0, |m: f64, (x, _)| m.max(x.abs()));
        let h = f64::EPSILON.sqrt() * size / largest;
        if !h.is_finite() {
            jv.fill(0.0);
            return;
        }
        let mut shifted = *x;
        for (x, v) in shifted.iter_mut().zip(v) {
            *x += h * v;
        }
        self.ode.rhs(t, &shifted, jv);
        for (jv, f) in jv.iter_mut().zip(&point.f) {
            *jv = (*jv - f) / h;
        }
    }
}
