//! Eigenvalues and eigenvectors of square matrices without symmetry, from the real Schur form.
//!
//! Rows and columns are first balanced by powers of two, so that the units of states have no
//! influence: B. N. Parlett, C. Reinsch, Balancing a matrix for calculation of eigenvalues and
//! eigenvectors, Numer. Math. 13 (1969) 293–304. The size of a row is its length, including the
//! diagonal. Sums of sizes without the diagonal would be unsuitable for matrices of Hessenberg form
//! (R. James, J. Langou, B. R. Lowery, On matrix balancing and eigenvector computation,
//! arXiv:1401.5766, 2014).

mod francis;
mod vectors;

use francis::RealSchur;
use vectors::Complex;

use crate::limits::{BALANCED, BALANCINGS};
use crate::{Matrix, PivotedQr, powers};

/// An eigenvalue and its eigenvector. Complex values are stored as real and imaginary parts.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Eigenpair {
    /// The eigenvalue.
    pub value: [f64; 2],
    /// The eigenvector, of length one.
    pub vector: Vec<[f64; 2]>,
}

/// Returns all eigenvalues of a square matrix with finite entries. Each eigenvalue is repeated by
/// its multiplicity. The eigenvalues are sorted by real parts, the largest first, then by imaginary
/// parts. Returns `None` if the iteration does not converge, or if an entry is not finite.
///
/// ```
/// use pfaff_linalg::{Matrix, eigenpairs};
/// // ÿ + 0.2·ẏ + y = 0
/// let pairs = eigenpairs(&Matrix::from_rows(&[[0.0, 1.0], [-1.0, -0.2]])).unwrap();
/// let [re, im] = pairs[0].value;
/// assert!((re + 0.1).abs() < 1e-15 && (im - 0.99f64.sqrt()).abs() < 1e-15);
/// assert_eq!(pairs[1].value, [re, -im]);
/// ```
///
/// # Panics
/// Panics if the matrix is not square.
#[must_use]
pub fn eigenpairs(a: &Matrix) -> Option<Vec<Eigenpair>> {
    let n = a.nrows();
    assert_eq!(n, a.ncols(), "a square matrix");
    if a.first_non_finite().is_some() {
        return None;
    }
    if n == 0 {
        return Some(Vec::new());
    }
    let (mut balanced, exponents) = balanced(a);
    // The entries are scaled to about one, so that their squares and products neither overflow nor
    // vanish.
    let unit = powers::unit_exponent(balanced.as_slice());
    let entries = balanced.as_mut_slice().iter_mut();
    entries.for_each(|x| *x = powers::scale(*x, unit));
    let form = RealSchur::of(balanced)?;
    let pair = |(value, vector): (Complex, Vec<Complex>)| {
        // The largest entry determines the unit, so that the length of the vector is finite.
        let scaled = vector.iter().zip(&exponents);
        let exponent = |(z, e): (&Complex, &i32)| {
            let size = powers::exponent(z[0].abs().max(z[1].abs()))?;
            Some(size + e)
        };
        let largest = scaled.filter_map(exponent).max().unwrap_or(0);
        let vector = vector.into_iter().zip(&exponents);
        let vector: Vec<Complex> = vector
            .map(|(z, e)| z.map(|x| powers::scale(x, e - largest)))
            .collect();
        let size = vector.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        Eigenpair {
            value: value.map(|x| powers::scale(x, -unit)),
            vector: vector.into_iter().map(|z| z.map(|x| x / size)).collect(),
        }
    };
    let mut pairs: Vec<Eigenpair> = form.pairs().into_iter().map(pair).collect();
    pairs.sort_by(|a, b| {
        let [x, y] = [a.value, b.value];
        y[0].total_cmp(&x[0]).then(y[1].total_cmp(&x[1]))
    });
    Some(pairs)
}

/// The eigenvalue zero of a matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ZeroEigenvalue {
    /// Number of eigenvalues that are zero.
    pub multiplicity: usize,
    /// Size of the largest Jordan block of the eigenvalue zero. If the matrix changes by ε times
    /// its norm, its eigenvalues change by up to about `ε^(1/index)` times the norm.
    pub index: usize,
}

/// Analyses the eigenvalue zero of a square matrix whose entries have the accuracy `tolerance`. The
/// computed eigenvalues are not used, because rounding spreads them in a circle around zero. The
/// method splits off null spaces one after the other until no null space remains (V. N.
/// Kublanovskaya, On a method of solving the complete eigenvalue problem for a degenerate matrix,
/// USSR Comput. Math. Math. Phys. 6 (1966) 1–14).
///
/// ```
/// use pfaff_linalg::{Matrix, zero_eigenvalue};
/// // A free body: ẋ = v, v̇ = 0; and a decay.
/// let a = Matrix::from_rows(&[[0.0, 1.0, 0.0], [1e-17, 0.0, 0.0], [0.0, 0.0, -3.0]]);
/// let zero = zero_eigenvalue(&a, 1e-14);
/// assert_eq!((zero.multiplicity, zero.index), (2, 2));
/// ```
///
/// # Panics
/// Panics if the matrix is not square.
#[must_use]
pub fn zero_eigenvalue(a: &Matrix, tolerance: f64) -> ZeroEigenvalue {
    assert_eq!(a.nrows(), a.ncols(), "a square matrix");
    let mut zero = ZeroEigenvalue::default();
    let mut rest = a.clone();
    while rest.nrows() > 0 {
        let n = rest.nrows();
        let rows = PivotedQr::of_rows(rest.clone());
        // A pivot that is NaN does not count towards the rank.
        let rank = rows
            .r_diagonal()
            .take_while(|r| r.abs() > tolerance)
            .count();
        if rank == n {
            break;
        }
        zero.multiplicity += n - rank;
        zero.index += 1;
        // The rows span the complement of the null space, so Qᵀ·A·Q has the remaining eigenvalues.
        let q = rows.q_columns(0..rank);
        rest = q.transpose().product(&rest.product(&q));
    }
    zero
}

/// Returns `D⁻¹·A·D` with rows and columns of similar size, and the exponents of D.
fn balanced(a: &Matrix) -> (Matrix, Vec<i32>) {
    let n = a.nrows();
    let mut a = a.clone();
    let mut exponents = vec![0; n];
    for _ in 0..BALANCINGS {
        let mut has_changed = false;
        for i in 0..n {
            let column = (0..n).fold(0.0_f64, |c, k| c.hypot(a[(k, i)]));
            let row = a.row(i).iter().fold(0.0_f64, |r, x| r.hypot(*x));
            if column == 0.0 || row == 0.0 {
                continue;
            }
            let e = (0.5 * (row / column).log2()).round() as i32;
            let (c, r) = (powers::scale(column, e), powers::scale(row, -e));
            if e == 0 || c + r > BALANCED * (column + row) {
                continue;
            }
            has_changed = true;
            exponents[i] += e;
            for k in 0..n {
                a[(k, i)] = powers::scale(a[(k, i)], e);
            }
            for x in a.row_mut(i) {
                *x = powers::scale(*x, -e);
            }
        }
        if !has_changed {
            break;
        }
    }
    (a, exponents)
}

#[cfg(test)]
mod tests;
