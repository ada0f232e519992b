//! Linear programs, polyhedra, and complementarity. The module is the numerical part of questions
//! about supports that only push and contacts with friction.
//!
//! All reactions that satisfy the equations of motion are λ₀ + Z·y. Each support that only pushes
//! restricts the free numbers y to a half space.
//!
//! | module | content |
//! | --- | --- |
//! | `simplex` | linear programs with dense data |
//! | `polyhedron` | the admissible y, and the range of a number over the admissible y |
//! | `complementarity` | accelerations of supports that lift |

pub(crate) mod complementarity;
pub(crate) mod polyhedron;
pub(crate) mod simplex;

#[cfg(test)]
pub(crate) mod tests;

use linalg::{Dd, Lu, kernels};

/// Reason why a question does not have a certain answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Unclear {
    /// The length of a row is neither zero nor clearly not zero.
    Row(f64),
    /// A component of one row along another row is neither zero nor clearly not zero, relative to
    /// both rows.
    Component(f64),
    /// A row is neither a combination of the other rows with weights ≥ 0 nor clearly different from
    /// every such combination. The number is the distance, as a share of the row.
    Distance(f64),
    /// The depth of the polyhedron is neither zero nor clearly negative.
    Depth(f64),
    /// The width of a range is neither zero nor clearly positive.
    Width(f64),
    /// The acceleration of a support is neither zero nor clearly not zero.
    Acceleration(f64),
    /// The search takes more than the maximum number of steps.
    Steps,
    /// The result does not satisfy the conditions that prove it.
    Unproved,
}

/// Returns the scalar product in double-double arithmetic.
fn exact_dot(x: &[f64], y: &[f64]) -> Dd {
    let products = x.iter().zip(y).map(|(a, b)| Dd::from_product(*a, *b));
    products.fold(Dd::ZERO, |sum, product| sum + product)
}

/// Returns a bound on the rounding errors of a scalar product.
fn rounding_of_dot(x: &[f64], y: &[f64]) -> f64 {
    x.len() as f64 * f64::EPSILON * kernels::norm(x) * kernels::norm(y)
}

/// Solves equations with the factored matrix, with one step of refinement.
fn refined(factors: &mut Lu, entry: impl Fn(usize, usize) -> f64, right: &[f64]) -> Vec<f64> {
    let mut x = right.to_vec();
    factors.solve(&mut x);
    let left = |(i, b): (usize, &f64)| {
        let products = x.iter().enumerate();
        let products = products.map(|(j, x)| Dd::from_product(entry(i, j), *x));
        let left = products.fold(Dd::from(*b), |left, product| left - product);
        left.to_f64()
    };
    let mut correction: Vec<f64> = right.iter().enumerate().map(left).collect();
    factors.solve(&mut correction);
    kernels::axpy(1.0, &correction, &mut x);
    x
}
