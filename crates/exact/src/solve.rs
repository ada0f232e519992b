//! Solves exactly the equations of motion with independent rows only:
//!
//! ```text
//! | M  Cᵀ | | a |   | Q |
//! | C  0  | | λ | = | Γ |     M = diag(m) ≥ 0 (n), C the kept rows (r×n)
//! ```
//!
//! All given values count as exact fractions, and the result is rounded once, at the end. The
//! result is therefore correct for the C, M, Q and Γ that a program in `f64` uses, but the rounding
//! errors in C, M, Q and Γ are not corrected. If rows are redundant, only independent rows may be
//! given: Γ of the redundant rows contains separate rounding errors, so that the equations of all
//! rows have no common solution.

use num_bigint::{BigInt, BigUint};
use num_traits::{One, ToPrimitive, Zero};

use crate::dyadic::Dyadic;
use crate::elimination::eliminate;
use crate::rank::Exact;

/// The solution; each value is rounded to the nearest `f64`.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Accelerations, n values.
    pub a: Vec<f64>,
    /// Multipliers of the given rows, r values.
    pub lambda: Vec<f64>,
}

/// The reason why the equations do not have exactly one solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singular {
    /// The rows are dependent.
    Rows,
    /// The rows are independent, but M is not positive definite on ker C: the rows allow a motion
    /// that moves no mass.
    Massless,
}

/// Solves for a and λ.
///
/// | argument | shape | meaning |
/// | --- | --- | --- |
/// | `mass` | n | diagonal of M |
/// | `rows` | r×n | kept rows of C |
/// | `force`, `gamma` | n, r | Q, Γ |
///
/// ```
/// use pfaff_exact::solve;
/// // Two rigidly connected carts, 1 kg and 2⁻⁷⁰ kg, and 3 N on the light one: in f64 the sum of the masses is 1 kg.
/// let tiny = 2_f64.powi(-70);
/// let found = solve(&[1.0, tiny], &[[1.0, -1.0]], &[0.0, 3.0], &[0.0]).unwrap();
/// assert_eq!((found.a, found.lambda), (vec![3.0, 3.0], vec![-3.0]));
/// ```
///
/// # Errors
/// Returns [`Singular`] if there is no unique solution.
///
/// # Panics
/// Panics if a value is not finite, or the shapes do not match.
pub fn solve<R: AsRef<[f64]>>(
    mass: &[f64],
    rows: &[R],
    force: &[f64],
    gamma: &[f64],
) -> Result<Solution, Singular> {
    let (n, r) = (mass.len(), rows.len());
    assert_eq!((force.len(), gamma.len()), (n, r), "n forces, r rows");
    let mut equations = vec![vec![0.0; n + r + 1]; n + r];
    for (i, (m, f)) in mass.iter().zip(force).enumerate() {
        equations[i][i] = *m;
        equations[i][n + r] = *f;
    }
    for (k, (row, right)) in rows.iter().zip(gamma).enumerate() {
        assert_eq!(row.as_ref().len(), n, "entries of row {k}");
        equations[n + k][n + r] = *right;
        for (i, c) in row.as_ref().iter().enumerate() {
            equations[n + k][i] = *c;
            equations[i][n + k] = *c;
        }
    }
    let whole = equations.iter().map(|row| whole(row)).collect();
    let (rank, reduced) = eliminate(whole, n + r);
    if rank < n + r {
        return Err(if Exact::of(rows).rank() < r {
            Singular::Rows
        } else {
            Singular::Massless
        });
    }
    let mut a = back_substituted(&reduced);
    let lambda = a.split_off(n);
    Ok(Solution { a, lambda })
}

/// Returns the entries of a row as integers, all multiplied by the same power of two.
fn whole(row: &[f64]) -> Vec<BigInt> {
    let row: Vec<Dyadic> = row.iter().map(|&x| Dyadic::from(x)).collect();
    let least = row.iter().filter_map(Dyadic::exponent).min().unwrap_or(0);
    row.iter().map(|x| x.over_power(least)).collect()
}

/// Returns the unknowns of an upper triangular system whose last column is its right-hand side. The
/// products of the unknowns and the determinant are integers (Cramer's rule), so that all divisions
/// except the last are exact.
fn back_substituted(rows: &[Vec<BigInt>]) -> Vec<f64> {
    let n = rows.len();
    let determinant = rows
        .last()
        .map_or_else(BigInt::one, |row| row[n - 1].clone());
    let mut x = vec![BigInt::zero(); n];
    for (i, row) in rows.iter().enumerate().rev() {
        let known = (i + 1..n).filter(|&j| !row[j].is_zero());
        let left = &determinant * &row[n] - known.map(|j| &row[j] * &x[j]).sum::<BigInt>();
        x[i] = left / &row[i];
    }
    x.iter().map(|x| quotient(x, &determinant)).collect()
}

/// Returns the `f64` nearest to x/y, ties to even, if it is a normal number.
fn quotient(x: &BigInt, y: &BigInt) -> f64 {
    let is_negative = (x < &BigInt::zero()) != (y < &BigInt::zero());
    let (x, y) = (x.magnitude(), y.magnitude());
    // The computation uses the first 64 or 65 bits of the quotient. The last bit is set if further
    // digits follow, which is sufficient to round once.
    let shift = 64 + y.bits() as i64 - x.bits() as i64;
    let scaled = |x: &BigUint, by: i64| if by > 0 { x << by } else { x.clone() };
    let (x, y) = (scaled(x, shift), scaled(y, -shift));
    let mut digits = &x / &y;
    if &digits * &y != x {
        digits |= BigUint::one();
    }
    let size = digits.to_f64().unwrap_or(f64::INFINITY) * (-shift as f64).exp2();
    if is_negative { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_the_nearest_numbers() {
        let big = |x: f64| BigInt::from(x as i128);
        for (x, y) in [
            (1.0, 3.0),
            (-2.0, 7.0),
            (0.0, 5.0),
            (1e17, 9.0),
            (3.0, -1e18),
            (6.0, 3.0),
        ] {
            assert_eq!(quotient(&big(x), &big(y)), x / y, "{x}/{y}");
        }
        // The values are half a unit in the last place, slightly more and slightly less. The
        // difference is only in much later digits, and it determines the rounding.
        let half = (BigInt::one() << 200) + (BigInt::one() << 147);
        let one = BigInt::one() << 200;
        assert_eq!(quotient(&half, &one), 1.0);
        assert_eq!(quotient(&(&half + 1), &one), 1.0 + f64::EPSILON);
        assert_eq!(quotient(&(&half - 1), &one), 1.0);
    }

    #[test]
    fn a_pendulum_released_level() {
        // A mass on a massless rod, at a distance of 2 from the pivot, with the coordinates (x, y,
        // φ). The pivot is at −2 along the rod. Then φ̈ = −g/2 and ÿ = −g, and the force in the
        // pivot is zero.
        let rows = [[1.0, 0.0, 0.0], [0.0, 1.0, -2.0]];
        let found = solve(&[3.0, 3.0, 0.0], &rows, &[0.0, -30.0, 0.0], &[0.0, 0.0]).unwrap();
        assert_eq!(found.a, [0.0, -10.0, -5.0]);
        assert_eq!(found.lambda, [0.0, 0.0]);
        // With a moment of inertia of 12 = m·l², the acceleration is half as large, and the
        // reaction in the pivot is half of the weight.
        let found = solve(&[3.0, 3.0, 12.0], &rows, &[0.0, -30.0, 0.0], &[0.0, 0.0]).unwrap();
        assert_eq!(found.a, [0.0, -5.0, -2.5]);
        assert_eq!(found.lambda, [0.0, -15.0]);
    }

    #[test]
    fn what_has_no_solution_is_named() {
        let massless = solve(&[1.0, 0.0, 0.0], &[[1.0, 1.0, 1.0]], &[0.0; 3], &[0.0]);
        assert_eq!(massless, Err(Singular::Massless));
        let rows = [[1.0, 2.0], [0.1, 0.2]];
        assert_eq!(
            solve(&[1.0; 2], &rows, &[0.0; 2], &[0.0; 2]),
            Err(Singular::Rows)
        );
        // In f64, 0.3 is not 3·0.1, so these rows are exactly independent.
        let rows = [[0.1, 1.0], [0.3, 3.0]];
        assert!(solve(&[1.0; 2], &rows, &[0.0; 2], &[0.0; 2]).is_ok());
    }
}
