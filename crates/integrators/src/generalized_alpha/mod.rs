//! The generalized-α method on the positions (index 3): order 2, with damping of high frequencies as chosen by ρ∞.
//!
//! ```text
//! q1 = q0 + h·v0 + h²·((½ − β)·a0 + β·a1),   v1 = v0 + h·((1 − γ)·a0 + γ·a1)
//! (1 − α_m)·a1 + α_m·a0 = (1 − α_f)·v'1 + α_f·v'0
//! M·v'1 + Gᵀ·λ1 = f(t1, q1, v1),   Φ(t1, q1) = 0,   G·v1 = b for rows that are not holonomic
//! ```
//!
//! a is the acceleration at t + (α_m − α_f)·h: where the step size changes, it is moved along.
//!
//! Sources: J. Chung, G. M. Hulbert, A time integration algorithm for structural dynamics with improved numerical dissipation, J. Appl.
//! Mech. 60 (1993) 371–375, DOI 10.1115/1.2900803 (α_m, α_f, β, γ); M. Arnold, O. Brüls, Convergence of the generalized-α scheme for
//! constrained mechanical systems, Multibody Syst. Dyn. 18 (2007) 185–202, DOI 10.1007/s11044-007-9084-0 (v' besides a).

mod newton;
mod step;

#[cfg(test)]
mod tests;

use crate::constrained::{Constrained, Sizes};
use crate::control::{Control, ControlConstants};
use crate::convergence::Convergence;
use crate::method::Method;

/// Generalized-α on positions, order 2; for stiff problems at low accuracy.
///
/// The positions at the end obey the holonomic constraints, the velocities the others, to the accuracy of Newton's method; the
/// derivatives of the holonomic constraints are obeyed to the error of the method only and left to
/// [`Ode::end_of_step`](crate::Ode::end_of_step). The error is estimated from the third derivative. Dense output is the cubic of both ends,
/// more accurate than the steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneralizedAlpha {
    /// ρ∞, what remains of an oscillation of infinite frequency after a step, 0 to 1; values outside count as the nearest end. At 1
    /// nothing is damped, and multipliers may oscillate.
    pub rho_inf: f64,
}

impl Default for GeneralizedAlpha {
    /// ρ∞ = 0.8.
    fn default() -> Self {
        Self { rho_inf: 0.8 }
    }
}

impl<O: Constrained> Method<O> for GeneralizedAlpha {
    type Stepper = Stepping;

    fn stepper(&self, ode: &O) -> Stepping {
        Stepping::new(Coefficients::new(self.rho_inf), ode.dim(), ode.sizes())
    }
}

/// For an estimate of order 2 of a method of order 2.
const CONTROL: ControlConstants = ControlConstants {
    alpha: 1.0 / 3.0,
    beta: 0.0,
    safety: 0.9,
    min_factor: 0.2,
    max_factor: 3.0,
};

/// Those of Chung and Hulbert, for a given ρ∞.
#[derive(Debug, Clone, Copy)]
struct Coefficients {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Coefficients {
    fn new(rho_inf: f64) -> Self {
        let rho = if rho_inf.is_nan() {
            0.0
        } else {
            rho_inf.clamp(0.0, 1.0)
        };
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        let gamma = 0.5 + alpha_f - alpha_m;
        Self {
            alpha_m,
            alpha_f,
            beta: 0.25 * (gamma + 0.5) * (gamma + 0.5),
            gamma,
        }
    }

    /// Local errors of q, v and quadratures over h³·y''', by Taylor expansion with a = v'(t + (α_m − α_f)·h).
    fn error_constants(&self) -> [f64; 3] {
        let lag = self.alpha_f - self.alpha_m;
        [
            self.beta - 0.5 * lag - 1.0 / 6.0,
            1.0 / 12.0 - 0.5 * lag * lag,
            1.0 / 12.0,
        ]
    }
}

/// What the method remembers at the end of a step.
#[derive(Debug, Clone)]
struct Memory {
    /// a.
    a: Vec<f64>,
    /// v'.
    vd: Vec<f64>,
    lambda: Vec<f64>,
}

/// One step and memory.
#[derive(Debug)]
pub struct Stepping {
    control: Control,
    coefficients: Coefficients,
    sizes: Sizes,
    /// At the start and at the end of the last trial.
    from: Memory,
    to: Memory,
    /// Size of the last accepted step since the start of the leg, and the derivative of a over it.
    h_before: Option<f64>,
    jerk: Vec<f64>,
    /// y' at the start of the last accepted step, and of the last trial.
    f_before: Vec<f64>,
    f_start: Vec<f64>,
    /// y' at the end of the last trial.
    f1: Vec<f64>,
    /// a at the start, moved along with the step size.
    a0: Vec<f64>,
    /// Displacement over the step, then residual and increment.
    d: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    f: Vec<f64>,
    scale: Vec<f64>,
    convergence: Convergence,
}

impl Stepping {
    fn new(coefficients: Coefficients, dim: usize, sizes: Sizes) -> Self {
        let (zeros, velocities) = (|| vec![0.0; dim], || vec![0.0; sizes.velocities]);
        let memory = Memory {
            a: velocities(),
            vd: velocities(),
            lambda: vec![0.0; sizes.rows()],
        };
        Self {
            control: Control::new(CONTROL),
            coefficients,
            sizes,
            from: memory.clone(),
            to: memory,
            h_before: None,
            jerk: velocities(),
            f_before: zeros(),
            f_start: zeros(),
            f1: zeros(),
            a0: velocities(),
            d: velocities(),
            x: vec![0.0; sizes.velocities + sizes.rows()],
            y: zeros(),
            f: zeros(),
            scale: zeros(),
            convergence: Convergence::default(),
        }
    }
}
