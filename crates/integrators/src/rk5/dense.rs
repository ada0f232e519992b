//! The solution within an accepted step. The dense output has order 4 (local error O(h⁵)) without
//! extra evaluations, and order 5 (O(h⁶), like the step) with two extra evaluations.
//!
//! **Order 4.** The output is the cubic Hermite interpolation of (y0, f0), (y1, f1) plus a quartic
//! term. The quartic term and its derivative vanish at both ends:
//!
//! ```text
//! u(θ) = y0 + θ²(3 − 2θ)·Δ + h·θ(1 − θ)²·f0 − h·θ²(1 − θ)·f1 + h·θ²(1 − θ)²·Σ d_i k_i,   Δ = y1 − y0
//! ```
//!
//! Without projection the output is given by Shampine's formula, Hairer, Nørsett, Wanner I, 2nd
//! ed., II.6. A projection that moves y1 by c and f1 by g adds θ²(3 − 2θ)·c − h·θ²(1 − θ)·g. At the
//! end, the output then has the value and the derivative of the projected state. The start is
//! unchanged.
//!
//! **Order 5.** The output is the quintic with u(0) = y0, u(1) = y1, u'(0) = h·f0, u'(1) = h·f1 and
//! u'(θ) = h·f(t0 + θh, u₄(θ)) at θ = a, b. Here u₄ is the output of order 4, whose error O(h⁵)
//! enters multiplied by h (bootstrapping; W. H. Enright, K. R. Jackson, S. P. Nørsett, P. G.
//! Thomsen, ACM Trans. Math. Softw. 12 (1986) 193–218, DOI 10.1145/7921.7923). The positions a =
//! 1/5, b = 1/2 were chosen for this crate. For Dormand–Prince, the norm of the 20 error
//! coefficients of order 6 within the step then does not exceed its value at the end, the value of
//! the method itself. For Tsitouras, whose steps are more accurate, the norm is at most 1.73 times
//! this value, within 1 % of the minimum over all positions. The module `order_conditions` asserts
//! both bounds.

use super::{Rk5Stages, Tableau};
use crate::error::Cause;
use crate::method::{Dense, Ends};
use crate::ode::{Ode, evaluate};

/// First relative position of the extra evaluations for the dense output of order 5.
pub(super) const NODE_A: f64 = 1.0 / 5.0;
/// Second relative position of the extra evaluations.
pub(super) const NODE_B: f64 = 1.0 / 2.0;

impl<O: Ode, T: Tableau> Dense<O> for Rk5Stages<T> {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        quartic(&T::D, &self.k, ends, theta, out);
    }

    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        for (theta, f) in [(NODE_A, &mut self.f_a), (NODE_B, &mut self.f_b)] {
            quartic(&T::D, &self.k, ends, theta, &mut self.y);
            evaluate(ode, ends.trial.stage_time(theta), &self.y, f, evaluations)?;
        }
        Ok(())
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        let h = ends.trial.h;
        let w = quintic_weights(theta);
        for i in 0..out.len() {
            let slopes =
                w.f0 * ends.f0[i] + w.f1 * ends.f1[i] + w.f_a * self.f_a[i] + w.f_b * self.f_b[i];
            out[i] = ends.y0[i] + (w.delta * (ends.y1[i] - ends.y0[i]) + h * slopes);
        }
    }
}

/// Weights of u(θ) − y0 in terms of the difference of the states and of the derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuarticWeights {
    pub(super) delta: f64,
    pub(super) f0: f64,
    pub(super) f1: f64,
    /// Weight of Σ d_i k_i.
    pub(super) d: f64,
}

pub(super) fn quartic_weights(theta: f64) -> QuarticWeights {
    let rest = 1.0 - theta;
    QuarticWeights {
        delta: theta * theta * (3.0 - 2.0 * theta),
        f0: theta * rest * rest,
        f1: -theta * theta * rest,
        d: theta * theta * rest * rest,
    }
}

/// Weights for the output of order 5, see [`QuarticWeights`].
#[derive(Debug, Clone, Copy)]
pub(super) struct QuinticWeights {
    pub(super) delta: f64,
    pub(super) f0: f64,
    pub(super) f1: f64,
    pub(super) f_a: f64,
    pub(super) f_b: f64,
}

/// Returns the five polynomials of degree ≤ 5 that vanish at θ = 0. The polynomials are dual to
/// u(1), u'(0), u'(1), u'(1/5), u'(1/2).
pub(super) fn quintic_weights(theta: f64) -> QuinticWeights {
    let (x, x2) = (theta, theta * theta);
    let rest = 1.0 - theta;
    QuinticWeights {
        delta: x2 * (6.0 + x * (-32.0 + x * (51.0 - 24.0 * x))),
        f0: x * (1.0 + x * (-5.0 + x * (11.0 + x * (-11.0 + 4.0 * x)))),
        f1: x2 * (-7.0 / 8.0 + x * (19.0 / 4.0 + x * (-63.0 / 8.0 + 4.0 * x))),
        f_a: 125.0 / 24.0 * x2 * rest * rest,
        f_b: x2 * (-16.0 / 3.0 + x * (80.0 / 3.0 + x * (-112.0 / 3.0 + 16.0 * x))),
    }
}

fn quartic(d: &[f64; 7], k: &[Vec<f64>; 6], ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
    let h = ends.trial.h;
    let w = quartic_weights(theta);
    let [k2, k3, k4, k5, k6, k7] = k;
    for i in 0..out.len() {
        let sum = d[0] * ends.f0[i]
            + d[1] * k2[i]
            + d[2] * k3[i]
            + d[3] * k4[i]
            + d[4] * k5[i]
            + d[5] * k6[i]
            + d[6] * k7[i];
        let slopes = w.f0 * ends.f0[i] + w.f1 * ends.f1[i] + w.d * sum;
        out[i] = ends.y0[i] + (w.delta * (ends.y1[i] - ends.y0[i]) + h * slopes);
    }
}
