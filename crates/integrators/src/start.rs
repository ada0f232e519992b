//! The automatic first step.
//!
//! Source: Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.4,
//! "Starting step size". As in the authors' program DOPRI5, the norms are sums over the components
//! (not means), and the constants are those of this program.

use crate::control::weighted_square_sum;
use crate::interval::Leg;
use crate::ode::{Ode, evaluate};
use crate::statistics::Statistics;

/// Size of the exploratory step, and estimate of the first step, if y or f is too small to
/// determine a scale; in units of t.
const SMALL_STEP: f64 = 1e-6;
/// If a sum of squares is at most this value, it determines no scale.
const NO_SCALE: f64 = 1e-10;
const NO_DERIVATIVE: f64 = 1e-15;

/// Buffers of length n for the exploration.
pub(crate) struct StartScratch<'a> {
    pub(crate) y: &'a mut [f64],
    pub(crate) f: &'a mut [f64],
}

/// Returns the signed first step for a method of order `order` from (`leg.start`, `y0`). f0 must be
/// the value of f at this point. |h| is at most `h_max`.
///
/// An explicit Euler step of 1 % of |y|/|f| is used to estimate the second derivative. Then h is
/// chosen so that `h^order · max(|f|, |f'|) = 0.01` in the norm with weights `scale`. If f cannot
/// be evaluated after the Euler step, 1 % of the Euler step is used, and error control adapts this
/// size.
pub(crate) fn initial_step<O: Ode>(
    ode: &mut O,
    leg: &Leg,
    order: i32,
    (y0, f0, scale): (&[f64], &[f64], &[f64]),
    h_max: f64,
    scratch: StartScratch<'_>,
    statistics: &mut Statistics,
) -> f64 {
    let StartScratch { y, f } = scratch;
    let sign = (leg.end - leg.start).signum();
    let (y_size, f_size) = (
        weighted_square_sum(y0, scale),
        weighted_square_sum(f0, scale),
    );
    let h0 = if f_size <= NO_SCALE || y_size <= NO_SCALE {
        SMALL_STEP
    } else {
        0.01 * (y_size / f_size).sqrt()
    };
    let h0 = if h0.is_finite() && h0 > 0.0 {
        h0
    } else {
        SMALL_STEP
    }
    .min(h_max);
    for i in 0..y.len() {
        y[i] = y0[i] + sign * h0 * f0[i];
    }
    let t = leg.evaluation_time(leg.start + sign * h0);
    if evaluate(ode, t, y, f, &mut statistics.evaluations).is_err() {
        return sign * 0.01 * h0;
    }
    for i in 0..y.len() {
        f[i] -= f0[i];
    }
    let second = weighted_square_sum(f, scale).sqrt() / h0;
    let derivative = second.max(f_size.sqrt());
    let h1 = if derivative <= NO_DERIVATIVE {
        SMALL_STEP.max(1e-3 * h0)
    } else {
        (0.01 / derivative).powf(1.0 / f64::from(order))
    };
    let h = h1.min(100.0 * h0).min(h_max);
    // An infinite derivative (overflow, zero weights) gives h1 = 0.
    sign * if h > 0.0 { h } else { 0.01 * h0 }
}
