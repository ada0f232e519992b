//! Tests Radau IIA on stiff problems with published or closed-form solutions.

use crate::problems::distance;
use pfaff_integrators::{
    Cause, DenseError, DenseImplicit, Differences, Function, InitialStep, IntegrationError,
    Interval, Jacobian, Ode, Options, Outcome, Radau5, StepEnd, StepInfo, integrate,
};
use std::convert::Infallible;
use std::ops::ControlFlow;

fn run<F, J>(f: F, jacobian: J, y0: &[f64], t_end: f64, options: &Options) -> Outcome
where
    F: FnMut(f64, &[f64], &mut [f64]),
    J: Jacobian<Function<F>>,
{
    let mut ode = DenseImplicit::new(Function::new(y0.len(), f), jacobian);
    let interval = Interval::new(0.0, t_end);
    integrate(&Radau5, &mut ode, &interval, y0, options, |_| {
        ControlFlow::Continue(())
    })
    .expect("the integration reaches its end")
}

fn relative_error(y: &[f64], exact: &[f64]) -> f64 {
    let errors = y.iter().zip(exact).map(|(y, e)| ((y - e) / e).abs());
    errors.fold(0.0, f64::max)
}

/// Integrates Robertson's reaction to t = 10¹¹; the reference is that of the Test Set for IVP
/// Solvers. The program RADAU5 in another translation needs 1095 and 2159 evaluations for the
/// errors 4.8e-6 and 2.5e-8 at the first two tolerances.
#[test]
fn robertson_over_seventeen_decades() {
    let f = |_t: f64, y: &[f64], dy: &mut [f64]| {
        dy[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
        dy[2] = 3e7 * y[1] * y[1];
        dy[1] = -dy[0] - dy[2];
    };
    let jacobian = |_t: f64, y: &[f64], j: &mut [f64]| {
        j[..3].copy_from_slice(&[-0.04, 1e4 * y[2], 1e4 * y[1]]);
        j[6..].copy_from_slice(&[0.0, 6e7 * y[1], 0.0]);
        (0..3).for_each(|k| j[3 + k] = -j[k] - j[6 + k]);
    };
    let exact = [
        0.208_334_014_970_125_5e-7,
        0.833_336_077_033_471_3e-13,
        0.999_999_979_166_505,
    ];
    for (rtol, atol, error, evaluations) in [
        (1e-4, 1e-12, 5e-6, 1100),
        (1e-6, 1e-14, 5e-8, 2200),
        (1e-8, 1e-16, 5e-10, 4600),
    ] {
        let mut options = Options::with_tolerance(rtol, atol);
        options.initial_step = InitialStep::Given(1e-6);
        let end = run(f, jacobian, &[1.0, 0.0, 0.0], 1e11, &options);
        assert!(
            relative_error(&end.y, &exact) < error,
            "{rtol}: {:?}",
            end.y
        );
        assert!(
            end.statistics.evaluations < evaluations,
            "{:?}",
            end.statistics
        );
    }
}

/// Integrates Van der Pol's oscillator with ε = 10⁻⁶ through two fast transitions; the reference is
/// that of the Test Set for IVP Solvers.
#[test]
fn van_der_pol_keeps_its_jacobian_while_it_is_slow() {
    let f = |_t: f64, y: &[f64], dy: &mut [f64]| {
        dy.copy_from_slice(&[y[1], 1e6 * ((1.0 - y[0] * y[0]) * y[1] - y[0])]);
    };
    let jacobian = |_t: f64, y: &[f64], j: &mut [f64]| {
        j[..2].copy_from_slice(&[0.0, 1.0]);
        j[2] = -1e6 * (2.0 * y[0] * y[1] + 1.0);
        j[3] = 1e6 * (1.0 - y[0] * y[0]);
    };
    let exact = [1.706_167_732_170_483, -0.892_809_701_024_797_5];
    for (tolerance, evaluations) in [(1e-4, 2100), (1e-7, 6000), (1e-10, 18500)] {
        let options = Options::with_tolerance(tolerance, tolerance);
        let s = run(f, jacobian, &[2.0, 0.0], 2.0, &options);
        let error = relative_error(&s.y, &exact);
        assert!(error < 2.0 * tolerance, "{tolerance}: {error:.2e}");
        let s = s.statistics;
        assert!(s.evaluations < evaluations, "{s:?}");
        // One Jacobian and one factorisation are used for several steps, and each factorisation for
        // several solves.
        assert!(3 * s.jacobians < 2 * s.accepted, "{s:?}");
        assert!(s.factorisations < s.accepted + s.rejected(), "{s:?}");
        assert!(s.newton_iterations < 3 * s.accepted, "{s:?}");
    }
    // Differences change only the cost, not the result.
    let options = Options::with_tolerance(1e-6, 1e-6);
    let end = run(f, Differences::default(), &[2.0, 0.0], 2.0, &options);
    assert!(relative_error(&end.y, &exact) < 2e-6, "{:?}", end.y);
}

/// A pendulum of length 1 consists of a mass on a damped spring of stiffness k. Its polar
/// coordinates are y = (φ, r, φ', r'), with φ measured from the horizontal. With k = 10¹² the
/// extension of the spring is 10⁻¹¹. The motion is therefore that of the rigid pendulum of the
/// SUNDIALS examples (period 2). The rounding noise of the spring force is k·eps = 2·10⁻⁴. At any
/// tolerance, neither the number of steps nor the error may depend on this noise.
#[test]
fn noise_of_a_stiff_spring_neither_stalls_nor_shows() {
    const G: f64 = 13.750_371_636_040_746;
    for (k, c) in [(1e9_f64, 0.0), (1e12, 1e6), (1e12, 0.0)] {
        let f = move |_t: f64, s: &[f64], ds: &mut [f64]| {
            let (phi, r, phi_d, r_d) = (s[0], s[1], s[2], s[3]);
            ds[..2].copy_from_slice(&[phi_d, r_d]);
            ds[2] = (G * phi.cos() - 2.0 * r_d * phi_d) / r;
            ds[3] = r * phi_d * phi_d + G * phi.sin() - k * (r - 1.0) - c * r_d;
        };
        for (tolerance, steps) in [
            (1e-3, 8),
            (1e-6, 25),
            (1e-9, 70),
            (1e-12, 210),
            (1e-14, 450),
        ] {
            let options = Options::with_tolerance(tolerance, tolerance);
            let y0 = [0.0, 1.0, 0.0, 0.0];
            let end = run(f, Differences::default(), &y0, 1.0, &options);
            let error = distance(&end.y[..2], &[std::f64::consts::PI, 1.0]);
            let s = end.statistics;
            let case = format!("k = {k:e}, c = {c:e}, tolerance {tolerance:e}: {error:.2e}, {s:?}");
            assert!(error < (5.0 * tolerance).max(1e-13), "{case}");
            assert!(s.accepted <= steps && s.rejected() <= 3, "{case}");
        }
    }
}

/// The equation y' = λ·(y − cos t) − sin t from y(0) = 1 has the solution y = cos t. The step size
/// is limited only by the error 1/|λ| of a stiff component (its order is that of the stages). The
/// estimate measures this error, so it is below the enlarged tolerance.
#[test]
fn a_slow_solution_of_a_stiff_problem_takes_few_steps() {
    for lambda in [-1e6, -1e9, -1e12] {
        let f = |t: f64, y: &[f64], dy: &mut [f64]| dy[0] = lambda * (y[0] - t.cos()) - t.sin();
        let jacobian = |_: f64, _: &[f64], j: &mut [f64]| j[0] = lambda;
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let options = Options::with_tolerance(tolerance, tolerance);
            let end = run(f, jacobian, &[1.0], 10.0, &options);
            let (error, s) = ((end.y[0] - 10_f64.cos()).abs(), end.statistics);
            let case = format!("λ = {lambda:e}, tolerance {tolerance:e}: {error:.2e}, {s:?}");
            assert!(error < f64::max(1e-15, 1.0 / -lambda), "{case}");
            assert!(
                s.accepted < 20 && s.rejected() == 0 && s.jacobians == 1,
                "{case}"
            );
        }
    }
}

/// A hook that moves the state back to the unit circle at each step.
struct OnCircle<F>(Function<F>);

impl<F: FnMut(f64, &[f64], &mut [f64])> Ode for OnCircle<F> {
    type Error = Infallible;

    fn dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Infallible> {
        self.0.rhs(t, y, dy)
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Infallible> {
        let size = y[0].hypot(y[1]);
        y.iter_mut().for_each(|y| *y /= size);
        self.rhs(step.t_rhs, y, dy)?;
        Ok(StepEnd::Projected {
            correction: (size - 1.0).abs(),
            evaluations: 1,
        })
    }
}

/// Both outputs have the projected ends, even if the projection is much larger than the error of a
/// step (the test integrates a wrong rate).
#[test]
fn outputs_end_in_projected_states_and_restart_behind_a_break() {
    // Without the hook the exact solution is (cos t², sin t²)·√(1 + t/10⁴).
    let f = |t: f64, y: &[f64], dy: &mut [f64]| {
        let (turn, growth) = (2.0 * t, 5e-5 / (1.0 + t / 1e4));
        dy.copy_from_slice(&[growth * y[0] - turn * y[1], growth * y[1] + turn * y[0]]);
    };
    let mut ode = DenseImplicit::new(OnCircle(Function::new(2, f)), Differences::default());
    let interval = Interval {
        t0: 0.0,
        t_end: 2.0,
        break_times: &[0.7],
    };
    let options = Options::with_tolerance(1e-8, 1e-8);
    let (mut jump, mut worst) = ([0.0_f64; 2], 0.0_f64);
    let end = integrate(
        &Radau5,
        &mut ode,
        &interval,
        &[1.0, 0.0],
        &options,
        |step| {
            let (t0, t1) = (step.t0(), step.t1());
            for (t, expected) in [(t0.next_up(), step.y0()), (t1.next_down(), step.y1())] {
                let mut y = [[0.0; 2]; 2];
                step.interpolate(t, &mut y[0]).expect("inside");
                step.interpolate_accurately(t, &mut y[1]).expect("inside");
                for (jump, y) in jump.iter_mut().zip(y) {
                    *jump = jump.max(distance(&y, expected));
                }
            }
            let (t, mut y) = (0.5 * (t0 + t1), [0.0; 2]);
            step.interpolate_accurately(t, &mut y).expect("inside");
            let angle = t * t;
            worst = worst.max((y[1] * angle.cos() - y[0] * angle.sin()).abs());
            ControlFlow::Continue(())
        },
    )
    .expect("smooth");
    assert_eq!(end.statistics.projections, end.statistics.accepted);
    assert!(
        end.statistics.largest_correction > 1e-6,
        "{:?}",
        end.statistics
    );
    assert!(jump[0] < 1e-14 && jump[1] < 1e-14, "{jump:?}");
    assert!(
        distance(&end.y, &[4_f64.cos(), 4_f64.sin()]) < 1e-7,
        "{:?}",
        end.y
    );
    assert!(worst < 1e-7, "{worst:.2e}");
}

#[test]
fn failures_say_what_newton_and_the_factorisation_met() {
    let f = Function::new(1, |_t: f64, y: &[f64], dy: &mut [f64]| dy[0] = y[0]);
    let mut ode = DenseImplicit::new(f, |_t: f64, _y: &[f64], j: &mut [f64]| j[0] = f64::NAN);
    let interval = Interval::new(0.0, 2.0);
    let failure = integrate(
        &Radau5,
        &mut ode,
        &interval,
        &[1.0],
        &Options::default(),
        |_| ControlFlow::Continue(()),
    )
    .expect_err("there is no matrix");
    let IntegrationError::StepSizeCollapsed {
        cause: Cause::Problem(cause),
        ..
    } = failure.error
    else {
        panic!("{failure}");
    };
    assert!(
        matches!(cause, DenseError::SingularIterationMatrix { column: 0, .. }),
        "{cause}"
    );

    // The force changes its sign with the state: no step is short enough for the Jacobian 0.
    let f = |_t: f64, y: &[f64], dy: &mut [f64]| dy[0] = if y[0] > 0.0 { -1e20 } else { 1e20 };
    let mut ode = DenseImplicit::new(Function::new(1, f), |_t: f64, _y: &[f64], j: &mut [f64]| {
        j[0] = 0.0;
    });
    let failure = integrate(
        &Radau5,
        &mut ode,
        &interval,
        &[0.0],
        &Options::default(),
        |_| ControlFlow::Continue(()),
    )
    .expect_err("a sliding mode");
    let IntegrationError::StepSizeCollapsed {
        cause: Cause::NewtonDiverges { rate, .. },
        ..
    } = failure.error
    else {
        panic!("{failure}");
    };
    assert!(rate > 0.5, "{rate}");
}
