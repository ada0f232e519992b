//! Radau IIA of order 5 for stiff problems: an implicit method with three stages and collocation at
//! the Radau nodes.
//!
//! Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., IV.5 (method)
//! and IV.8 (implementation). The constants are those of the authors' program RADAU5. There are two
//! differences: the Jacobian is recomputed before a step is rejected, and the dense output has a
//! higher order (see `dense`).

mod dense;
mod newton;
mod scale;
mod step;
mod tableau;

#[cfg(test)]
mod tests;

use crate::control::{Control, ControlConstants};
use crate::convergence::Convergence;
use crate::implicit::Implicit;
use crate::method::Method;

/// Radau IIA of order 5 with simplified Newton iterations, for stiff problems.
///
/// The method is L-stable. The error estimate is of order 3. The estimate is compared with
/// `0.1·ρ^(−1/3)` times the tolerance, where ρ ≤ 10⁻³ is the relative tolerance. The error of the
/// step, which is of order 5, is therefore proportional to the tolerance. Tolerances below 100
/// units of rounding of the state are replaced by 100 units, because stiff forces amplify the
/// rounding error.
///
/// The dense output has order 4 (local error O(h⁵)) without extra evaluations, and order 5 (local
/// error O(h⁶), like the step) with two extra evaluations in the step. The dense output is
/// continuous. At the ends of steps, its derivative has jumps as large as its error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Radau5;

impl<O: Implicit> Method<O> for Radau5 {
    type Stepper = Radau5Stages;

    fn stepper(&self, ode: &O) -> Radau5Stages {
        Radau5Stages::new(ode.dim())
    }
}

/// The constants of the program RADAU5: the classical controller for an estimate of order 3.
const CONTROL: ControlConstants = ControlConstants {
    alpha: 0.25,
    beta: 0.0,
    safety: 0.9,
    min_factor: 0.125,
    max_factor: 5.0,
};

/// Stages, state of the matrices, and memory of the last steps.
#[derive(Debug)]
pub struct Radau5Stages {
    control: Control,
    /// Values z_i = Y_i − y0 in the last trial.
    z: [Vec<f64>; 3],
    /// The filtered `h·f0 − u'(0)` of the last trial, which is the estimated error times u₁.
    defect: Vec<f64>,
    /// Filtered defects of the dense output at the four positions that the module `dense` defines.
    defects: [Vec<f64>; 4],
    /// Buffer for the argument of a stage.
    y: Vec<f64>,
    /// Weights of the norms of this method.
    scale: Vec<f64>,
    matrices: Matrices,
    newton: Newton,
    before: Before,
    /// Whether the estimate is filtered twice, which is needed at the start, after a break time and
    /// after a rejection.
    filter_twice: bool,
}

/// Newton's method for the stages.
#[derive(Debug)]
struct Newton {
    /// Transformed values w = T⁻¹·z. In these values, the linear system separates into a real and a
    /// complex system.
    w: [Vec<f64>; 3],
    /// Derivatives at the stages; later the increments of w.
    k: [Vec<f64>; 3],
    convergence: Convergence,
    /// The step-size factor that is proposed after a failure of the iteration.
    factor_after_failure: Option<f64>,
}

/// The last accepted step since the start or the last break time.
#[derive(Debug)]
struct Before {
    /// The values z of this step, which are used for starting values.
    z: [Vec<f64>; 3],
    /// The size of this step.
    h: Option<f64>,
    /// Size and error of the step with which the predictive controller compares the present step.
    reference: Option<(f64, f64)>,
}

/// State of the matrices that have been linearised and factored by the problem.
#[derive(Debug, Clone, Copy, Default)]
struct Matrices {
    /// Time at which J was computed.
    linearised_at: Option<f64>,
    /// Step size for which the matrices were factored.
    factored_for: Option<f64>,
    /// Whether the last step converged so slowly that the next step needs a new J.
    is_worn: bool,
}

impl Radau5Stages {
    fn new(dim: usize) -> Self {
        let zeros = || vec![0.0; dim];
        let three = || std::array::from_fn(|_| zeros());
        Self {
            control: Control::new(CONTROL),
            z: three(),
            defect: zeros(),
            defects: std::array::from_fn(|_| zeros()),
            y: zeros(),
            scale: zeros(),
            matrices: Matrices::default(),
            newton: Newton {
                w: three(),
                k: three(),
                convergence: Convergence::default(),
                factor_after_failure: None,
            },
            before: Before {
                z: three(),
                h: None,
                reference: None,
            },
            filter_twice: true,
        }
    }
}
