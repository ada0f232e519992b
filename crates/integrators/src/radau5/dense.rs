//! The solution within an accepted step.
//!
//! **Order 4** (local error O(h⁵)). The collocation polynomial p of degree 3 through y0, Y₁, Y₂, Y₃
//! has the correct derivative at the nodes, but not at the start. The quartic
//!
//! ```text
//! u(θ) = p(θ) + D·φ(θ) + θ²(3 − 2θ)·c,   φ(θ) = ∫₀^θ (s − c₁)(s − c₂)(s − 1)/(−c₁c₂) ds
//! ```
//!
//! corrects the start by the defect D = h·f0 − p'(0) and leaves the other values unchanged. The
//! reason is that φ(1) = 0, because the Radau quadrature is exact for cubics, and that φ' = 0 at
//! the nodes. Here c is the change of y1 by a projection. In a stiff problem, rounding of y0 leads
//! to a large D. Therefore D is filtered by (I − h/u₁·J)⁻¹. If the problem is smooth, the filter
//! changes D by O(h⁵). The filtered D is the error estimate (times u₁), which has already been
//! computed.
//!
//! **Order 5** (local error O(h⁶)). This output is the sum of u and a quintic that vanishes at both
//! ends. The derivatives of the quintic at θ = 0, ¼, ¾ and 1 are the defects of u, `h·f(t, u) −
//! u'`, filtered in the same way. The output needs two extra evaluations (as in `dopri5`).

use super::Radau5Stages;
use super::newton::dot;
use super::tableau::{C, REAL, lagrange, lagrange_derivative};
use crate::error::Cause;
use crate::implicit::Implicit;
use crate::method::{Dense, Ends};
use crate::ode::{evaluate, finite};

/// Relative positions of the defects.
const PLACES: [f64; 4] = [0.0, 0.25, 0.75, 1.0];

impl<O: Implicit> Dense<O> for Radau5Stages {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        self.quartic(ends).value(theta, out);
    }

    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        let quartic = Quartic {
            ends,
            z: &self.z,
            defect: &self.defect,
        };
        for (theta, defect) in PLACES.into_iter().zip(&mut self.defects) {
            if theta == 0.0 {
                defect.copy_from_slice(ends.f0);
            } else if theta == 1.0 {
                defect.copy_from_slice(ends.f1);
            } else {
                quartic.value(theta, &mut self.y);
                let t = ends.trial.stage_time(theta);
                evaluate(ode, t, &self.y, defect, evaluations)?;
            }
            for (i, defect) in defect.iter_mut().enumerate() {
                *defect = REAL * (*defect - quartic.derivative(theta, i) / ends.trial.h);
            }
            ode.solve(defect);
            finite(defect).map_err(|component| Cause::NonFinite { component })?;
        }
        Ok(())
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        self.quartic(ends).value(theta, out);
        let weights = defect_weights(theta);
        for (i, out) in out.iter_mut().enumerate() {
            for (weight, defect) in weights.iter().zip(&self.defects) {
                *out += weight * defect[i];
            }
        }
    }
}

impl Radau5Stages {
    fn quartic<'a>(&'a self, ends: &'a Ends<'a>) -> Quartic<'a> {
        Quartic {
            ends,
            z: &self.z,
            defect: &self.defect,
        }
    }
}

/// The output of order 4.
struct Quartic<'a> {
    ends: &'a Ends<'a>,
    z: &'a [Vec<f64>; 3],
    /// The filtered defect at the start, divided by u₁.
    defect: &'a [f64],
}

impl Quartic<'_> {
    fn value(&self, theta: f64, out: &mut [f64]) {
        let (l, phi) = (lagrange(theta), REAL * start_weight(theta));
        let end = theta * theta * (3.0 - 2.0 * theta);
        for (i, out) in out.iter_mut().enumerate() {
            let inside = dot(&l, &self.increments(i)) + phi * self.defect[i];
            *out = self.ends.y0[i] + (inside + end * self.projection(i));
        }
    }

    /// Returns component `i` of u'(θ).
    fn derivative(&self, theta: f64, i: usize) -> f64 {
        dot(&lagrange_derivative(theta), &self.increments(i))
            + REAL * start_weight_derivative(theta) * self.defect[i]
            + 6.0 * theta * (1.0 - theta) * self.projection(i)
    }

    fn increments(&self, i: usize) -> [f64; 3] {
        [self.z[0][i], self.z[1][i], self.z[2][i]]
    }

    /// Returns the change of y1 by the hook.
    fn projection(&self, i: usize) -> f64 {
        (self.ends.y1[i] - self.ends.y0[i]) - self.z[2][i]
    }
}

/// Returns φ(θ), with φ(0) = φ(1) = 0, φ'(0) = 1, and φ' = 0 at the nodes.
pub(super) fn start_weight(theta: f64) -> f64 {
    let [a, b, _] = C;
    let x = theta;
    // The integral is ∫ (s³ − (a+b+1)·s² + (ab+a+b)·s − ab) ds.
    let integral =
        x * (-a * b + x * ((a * b + a + b) / 2.0 + x * (-(a + b + 1.0) / 3.0 + x / 4.0)));
    integral / (-a * b)
}

pub(super) fn start_weight_derivative(theta: f64) -> f64 {
    let [a, b, _] = C;
    (theta - a) * (theta - b) * (theta - 1.0) / (-a * b)
}

/// Returns the polynomials of degree 5 that vanish at θ = 0 and 1. The polynomials are dual to the
/// derivatives at the four positions.
pub(super) fn defect_weights(theta: f64) -> [f64; 4] {
    let x = theta;
    let rest = 1.0 - x;
    [
        x * rest * rest * (3.0 + x * (4.0 - 16.0 * x)) / 3.0,
        8.0 / 3.0 * x * x * rest * rest * (9.0 - 16.0 * x),
        8.0 / 3.0 * x * x * rest * rest * (7.0 - 16.0 * x),
        x * x * rest * (9.0 + x * (16.0 * x - 28.0)) / 3.0,
    ]
}
