//! Computes the smallest change of the data that satisfies linear equations. The size of a change
//! is the change of one point, direction or number, relative to its uncertainty. The point,
//! direction or number that changes most counts.
//!
//! Lawson's iteration solves `s* = min max_P |x_P|` under `target + Σ_P a_P·x_P = 0`. The iteration
//! uses least squares with weights that grow for the largest changes. Each iteration gives a lower
//! bound and an upper bound. The lower bound is the weighted mean of the relative changes, and the
//! upper bound is the largest relative change.
//!
//! Source: C. L. Lawson, Contributions to the theory of linear least maximum approximation, thesis,
//! UCLA (1961). Here all components of a vector have the same weight.

use crate::limits::{CONE_CLOSE, CONE_ITERATIONS, CONE_RESOLVED, LEAST_WEIGHT};
use linalg::Lu;

/// One equation. Changes are relative to the uncertainty of the data.
#[derive(Clone, Debug)]
pub(super) struct Equation {
    /// The value that must be zero.
    pub(super) target: f64,
    /// Rounding error of the target and of the coefficients. The rounding error is an additional
    /// unknown of this equation, whose relative size is at most one.
    pub(super) rounding: f64,
    /// Coefficients of each point, direction or number.
    pub(super) parts: Vec<[f64; 3]>,
}

impl Equation {
    fn slack(&self) -> f64 {
        let squares = self.parts.iter().map(|[x, y, z]| x * x + y * y + z * z);
        self.rounding
            .max(CONE_RESOLVED * squares.sum::<f64>().sqrt())
    }
}

/// Bounds on the smallest possible largest change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Bounds {
    /// Returns a value between the bounds.
    pub(super) fn middle(self) -> f64 {
        (self.low * self.high).sqrt()
    }
}

/// Returns bounds of `s*`. The two bounds are close to each other unless the iteration stalls. The
/// bounds are large if no change of data satisfies the equations.
pub(super) fn least_change(equations: &[Equation]) -> Bounds {
    let e = equations.len();
    let blocks = equations.first().map_or(0, |first| first.parts.len());
    let slack: Vec<f64> = equations.iter().map(Equation::slack).collect();
    let mut weights = vec![1.0 / (blocks + e) as f64; blocks + e];
    let mut bounds = Bounds {
        low: 0.0,
        high: f64::INFINITY,
    };
    let mut lu = Lu::new(e);
    let mut matrix = vec![0.0; e * e];
    for _ in 0..CONE_ITERATIONS {
        for (i, left) in equations.iter().enumerate() {
            for (j, right) in equations.iter().enumerate().take(i + 1) {
                let mut sum = 0.0;
                for ((a, b), w) in left.parts.iter().zip(&right.parts).zip(&weights) {
                    sum += (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / w;
                }
                matrix[i * e + j] = sum;
                matrix[j * e + i] = sum;
            }
            matrix[i * e + i] += slack[i] * slack[i] / weights[blocks + i];
        }
        if lu.factor(|i, j| matrix[i * e + j]).is_err() {
            break;
        }
        let mut y: Vec<f64> = equations.iter().map(|eq| eq.target).collect();
        lu.solve(&mut y);
        let share_of = |p: usize| match p.checked_sub(blocks) {
            Some(i) => (slack[i] * y[i] / weights[p]).abs(),
            None => {
                let mut x = [0.0; 3];
                for (equation, y) in equations.iter().zip(&y) {
                    x[0] += equation.parts[p][0] * y;
                    x[1] += equation.parts[p][1] * y;
                    x[2] += equation.parts[p][2] * y;
                }
                x[0].hypot(x[1]).hypot(x[2]) / weights[p]
            }
        };
        let shares: Vec<f64> = (0..blocks + e).map(share_of).collect();
        let mean_square: f64 = shares.iter().zip(&weights).map(|(s, w)| w * s * s).sum();
        let largest = shares.iter().copied().fold(0.0, f64::max);
        if !(largest.is_finite() && mean_square.is_finite()) {
            break;
        }
        bounds.low = bounds.low.max(mean_square.sqrt());
        bounds.high = bounds.high.min(largest);
        if bounds.high <= CONE_CLOSE * bounds.low {
            break;
        }
        let total: f64 = shares.iter().zip(&weights).map(|(s, w)| s * w).sum();
        if total == 0.0 {
            break;
        }
        for (w, s) in weights.iter_mut().zip(&shares) {
            *w *= s / total;
        }
        let least = LEAST_WEIGHT * weights.iter().copied().fold(0.0, f64::max);
        let sum: f64 = weights
            .iter_mut()
            .map(|w| {
                *w = w.max(least);
                *w
            })
            .sum();
        weights.iter_mut().for_each(|w| *w /= sum);
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equation(target: f64, parts: &[[f64; 3]]) -> Equation {
        Equation {
            target,
            rounding: 1e-12,
            parts: parts.to_vec(),
        }
    }

    fn is_near(bounds: Bounds, s: f64) {
        assert!(
            bounds.low <= s * (1.0 + 1e-4) && bounds.high >= s * (1.0 - 1e-4),
            "{bounds:?} {s}"
        );
        assert!(bounds.high <= 1.05 * bounds.low, "{bounds:?}");
    }

    #[test]
    fn one_equation_is_shared_by_all() {
        // For 6 = 1·x₁ + 2·x₂ + |(0, 3)·x₃|, all data change by 1.
        is_near(
            least_change(&[equation(
                6.0,
                &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]],
            )]),
            1.0,
        );
    }

    /// The equations of the previous test with two hundred additional numbers that need no change.
    /// These numbers do not lower the bounds.
    #[test]
    fn numbers_that_need_no_change_stay_out_of_the_bounds() {
        let mut parts = vec![[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
        parts.resize(203, [0.0; 3]);
        let found = least_change(&[equation(6.0, &parts)]);
        is_near(found, 1.0);
        assert!(found.low > 1.0 - 1e-4, "{found:?}");
    }

    #[test]
    fn a_point_has_one_change_in_both_directions() {
        // For x = 3 and y = 4, the change is 5 if x and y belong to one point, and 4 if they are
        // two numbers.
        let (x, y) = ([[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]);
        is_near(least_change(&[equation(3.0, &x), equation(4.0, &y)]), 5.0);
        let (x, y) = ([[1.0, 0.0, 0.0], [0.0; 3]], [[0.0; 3], [1.0, 0.0, 0.0]]);
        is_near(least_change(&[equation(3.0, &x), equation(4.0, &y)]), 4.0);
    }

    #[test]
    fn what_no_change_satisfies_is_far_away() {
        let contradicting = [
            equation(1.0, &[[1.0, 0.0, 0.0]]),
            equation(-1.0, &[[1.0, 0.0, 0.0]]),
        ];
        assert!(least_change(&contradicting).low > 1e4);
        assert!(least_change(&[equation(1.0, &[[0.0; 3]])]).low > 1e6);
        assert_eq!(least_change(&[equation(0.0, &[[1.0, 0.0, 0.0]])]).high, 0.0);
    }
}
