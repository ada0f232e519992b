//! Right-hand sides and small helpers that the tests share.

use pfaff_integrators::{
    Dopri5, Function, InitialStep, Interval, Ode, Options, Outcome, Tolerance, integrate,
};
use std::ops::ControlFlow;

/// Restricted three-body problem, with mass ratio and period of Hairer, Nørsett, Wanner I, 2nd ed.,
/// II.0 (0.1).
pub(crate) mod arenstorf {
    pub(crate) const MU: f64 = 0.012277471;
    pub(crate) const Y0: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
    pub(crate) const PERIOD: f64 = 17.065_216_560_157_964;

    pub(crate) fn rhs(_t: f64, y: &[f64], dy: &mut [f64]) {
        let (mu, mu1) = (MU, 1.0 - MU);
        let d1 = ((y[0] + mu).powi(2) + y[1] * y[1]).powf(1.5);
        let d2 = ((y[0] - mu1).powi(2) + y[1] * y[1]).powf(1.5);
        dy[0] = y[2];
        dy[1] = y[3];
        dy[2] = y[0] + 2.0 * y[3] - mu1 * (y[0] + mu) / d1 - mu * (y[0] - mu1) / d2;
        dy[3] = y[1] - 2.0 * y[2] - mu1 * y[1] / d1 - mu * y[1] / d2;
    }
}

/// The equation q'' = −q/|q|³ in the plane, with y = (q, q').
pub(crate) fn kepler(_t: f64, y: &[f64], dy: &mut [f64]) {
    let d = y[0].hypot(y[1]).powi(3);
    dy.copy_from_slice(&[y[2], y[3], -y[0] / d, -y[1] / d]);
}

/// The equation q'' = −q with y = (q, q') has the solution (cos t, −sin t) from (1, 0).
pub(crate) fn oscillator(_t: f64, y: &[f64], dy: &mut [f64]) {
    dy.copy_from_slice(&[y[1], -y[0]]);
}

/// The equation y' = y·cos t has the solution exp(sin t) from 1. Its right-hand side depends on t
/// and on y.
pub(crate) fn modulated(t: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = y[0] * t.cos();
}

/// A problem with a named type, for functions over several methods.
pub(crate) type Plain = Function<fn(f64, &[f64], &mut [f64])>;

pub(crate) fn plain(dim: usize, f: fn(f64, &[f64], &mut [f64])) -> Plain {
    Function::new(dim, f)
}

/// Absolute tolerance that no error of the tests exceeds.
pub(crate) const WEIGHT: f64 = 1e100;

/// Options for a constant step size: a tolerance that is always satisfied, and `h` as first and
/// largest step.
pub(crate) fn fixed_step(h: f64) -> Options {
    Options {
        tolerance: Tolerance::Uniform {
            rtol: 0.0,
            atol: WEIGHT,
        },
        initial_step: InitialStep::Given(h),
        max_step: h,
        ..Options::default()
    }
}

/// Integrates to the end without observer; an error ends the test.
pub(crate) fn run<O: Ode>(
    ode: &mut O,
    interval: &Interval<'_>,
    y0: &[f64],
    options: &Options,
) -> Outcome {
    integrate(&Dopri5, ode, interval, y0, options, |_| {
        ControlFlow::Continue(())
    })
    .expect("the integration reaches its end")
}

/// See [`run`], for a closure.
pub(crate) fn run_function(
    f: fn(f64, &[f64], &mut [f64]),
    t: (f64, f64),
    y0: &[f64],
    options: &Options,
) -> Outcome {
    run(
        &mut Function::new(y0.len(), f),
        &Interval::new(t.0, t.1),
        y0,
        options,
    )
}

/// Returns the largest absolute difference.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// Returns log₂ of the quotients of successive errors.
pub(crate) fn observed_orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}
