//! Eigenvalues and eigenvectors of square matrices without symmetry, by faer.
//!
//! Rows and columns are balanced by powers of two first, so that the units of states do not matter:
//! B. N. Parlett, C. Reinsch, Balancing a matrix for calculation of eigenvalues and eigenvectors,
//! Numer. Math. 13 (1969) 293–304.

use faer::MatRef;
use faer::linalg::solvers::Eigen;

use crate::limits::{BALANCED, BALANCINGS};
use crate::{Matrix, PivotedQr, powers};

/// An eigenvalue and its eigenvector; complex numbers as real and imaginary parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpair {
    /// The eigenvalue.
    pub value: [f64; 2],
    /// The eigenvector, of length one.
    pub vector: Vec<[f64; 2]>,
}

/// All eigenvalues of a square matrix with finite entries, with their multiplicity: by their real
/// parts, the largest first, then by their imaginary parts. `None` if the iteration does not
/// converge, or an entry is not finite.
///
/// ```
/// use linalg::{Matrix, eigenpairs};
/// // ÿ + 0.2·ẏ + y = 0
/// let pairs = eigenpairs(&Matrix::from_rows(&[[0.0, 1.0], [-1.0, -0.2]])).unwrap();
/// let [re, im] = pairs[0].value;
/// assert!((re + 0.1).abs() < 1e-15 && (im - 0.99f64.sqrt()).abs() < 1e-15);
/// assert_eq!(pairs[1].value, [re, -im]);
/// ```
///
/// # Panics
/// If the matrix is not square.
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
    let (balanced, exponents) = balanced(a);
    let view = MatRef::from_row_major_slice(balanced.as_slice(), n, n);
    let found = Eigen::new_from_real(view).ok()?;
    let (values, vectors) = (found.S(), found.U());
    let pair = |k: usize| {
        let entry = |i: usize| {
            let z = vectors[(i, k)];
            [z.re, z.im].map(|x| powers::scale(x, exponents[i]))
        };
        let vector: Vec<[f64; 2]> = (0..n).map(entry).collect();
        let size = vector.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        Eigenpair {
            value: [values[k].re, values[k].im],
            vector: vector.into_iter().map(|z| z.map(|x| x / size)).collect(),
        }
    };
    let mut pairs: Vec<Eigenpair> = (0..n).map(pair).collect();
    pairs.sort_by(|a, b| {
        let [x, y] = [a.value, b.value];
        y[0].total_cmp(&x[0]).then(y[1].total_cmp(&x[1]))
    });
    Some(pairs)
}

/// The eigenvalue zero of a matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ZeroEigenvalue {
    /// How many eigenvalues are zero.
    pub multiplicity: usize,
    /// Size of the largest Jordan block that belongs to it: a change of the matrix by ε times its
    /// norm changes its eigenvalues by up to about `ε^(1/index)` times the norm.
    pub index: usize,
}

/// The eigenvalue zero of a square matrix whose entries are known to `tolerance`, without the
/// eigenvalues, which rounding spreads in a circle around it: null spaces are split off one after
/// the other until none is left (V. N. Kublanovskaya, On a method of solving the complete
/// eigenvalue problem for a degenerate matrix, USSR Comput. Math. Math. Phys. 6 (1966) 1–14).
///
/// ```
/// use linalg::{Matrix, zero_eigenvalue};
/// // A free body: ẋ = v, v̇ = 0; and a decay.
/// let a = Matrix::from_rows(&[[0.0, 1.0, 0.0], [1e-17, 0.0, 0.0], [0.0, 0.0, -3.0]]);
/// let zero = zero_eigenvalue(&a, 1e-14);
/// assert_eq!((zero.multiplicity, zero.index), (2, 2));
/// ```
///
/// # Panics
/// If the matrix is not square.
#[must_use]
pub fn zero_eigenvalue(a: &Matrix, tolerance: f64) -> ZeroEigenvalue {
    assert_eq!(a.nrows(), a.ncols(), "a square matrix");
    let mut zero = ZeroEigenvalue::default();
    let mut rest = a.clone();
    while rest.nrows() > 0 {
        let n = rest.nrows();
        let rows = PivotedQr::of_rows(rest.clone());
        // NaN is no rank.
        let rank = rows
            .r_diagonal()
            .take_while(|r| r.abs() > tolerance)
            .count();
        if rank == n {
            break;
        }
        zero.multiplicity += n - rank;
        zero.index += 1;
        // Rows span what the null space leaves: Qᵀ·A·Q has the other eigenvalues.
        let q = rows.q_columns(0..rank);
        rest = q.transpose().product(&rest.product(&q));
    }
    zero
}

/// `D⁻¹·A·D` with rows and columns of similar size, and the exponents of D.
fn balanced(a: &Matrix) -> (Matrix, Vec<i32>) {
    let n = a.nrows();
    let mut a = a.clone();
    let mut exponents = vec![0; n];
    for _ in 0..BALANCINGS {
        let mut has_changed = false;
        for i in 0..n {
            let others = || (0..n).filter(|&k| k != i);
            let column: f64 = others().map(|k| a[(k, i)].abs()).sum();
            let row: f64 = others().map(|k| a[(i, k)].abs()).sum();
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
mod tests {
    use super::*;

    /// Jordan blocks beside other eigenvalues, in general axes and with entries changed by 1e-15.
    #[test]
    fn zeros_are_counted_though_rounding_spreads_them() {
        let sizes = [3, 2, 1];
        let n = 9;
        let mut jordan = Matrix::zeros(n, n);
        let mut first = 0;
        for size in sizes {
            for k in first..first + size - 1 {
                jordan[(k, k + 1)] = 2.0;
            }
            first += size;
        }
        // 1e-3 beside 4 ± 3i
        jordan[(6, 6)] = 1e-3;
        (jordan[(7, 7)], jordan[(8, 8)]) = (4.0, 4.0);
        (jordan[(7, 8)], jordan[(8, 7)]) = (3.0, -3.0);
        // A reflection, and changes without a pattern.
        let w = Matrix::from_fn(n, 1, |i, _| 1.0 / (1.0 + i as f64).sqrt());
        let square = w.transpose().product(&w)[(0, 0)];
        let turn = Matrix::from_fn(n, n, |i, k| {
            f64::from(u8::from(i == k)) - 2.0 * w[(i, 0)] * w[(k, 0)] / square
        });
        let turned = turn.product(&jordan.product(&turn));
        let a = Matrix::from_fn(n, n, |i, k| {
            turned[(i, k)] + 1e-15 * (7.0 * i as f64 + 3.0 * k as f64).sin()
        });
        let expected = ZeroEigenvalue {
            multiplicity: 6,
            index: 3,
        };
        assert_eq!(zero_eigenvalue(&a, 1e-12), expected);
        assert_eq!(zero_eigenvalue(&turned, 1e-12), expected);
        let whole = Matrix::from_rows(&[[1.0, 5.0], [0.0, 2.0]]);
        assert_eq!(zero_eigenvalue(&whole, 1e-12), ZeroEigenvalue::default());
        // The computed eigenvalues are far from zero.
        let pairs = eigenpairs(&a).expect("converges");
        let sizes = pairs.iter().map(|p| p.value[0].hypot(p.value[1]));
        let mut sizes: Vec<f64> = sizes.collect();
        sizes.sort_by(f64::total_cmp);
        assert!(sizes[5] > 1e-6 && sizes[6] > 9e-4, "{sizes:?}");
    }

    /// The companion matrix of (λ − 1)(λ + 2)(λ² + 9), in units that differ by 1e±8.
    #[test]
    fn units_do_not_matter() {
        let companion = Matrix::from_rows(&[
            [-1.0, -7.0, -9.0, 18.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ]);
        let unit = [1.0, 1e8, 1e-8, 1e3];
        let a = Matrix::from_fn(4, 4, |i, k| companion[(i, k)] * unit[k] / unit[i]);
        let found = eigenpairs(&a).expect("converges");
        let expected = [[1.0, 0.0], [0.0, 3.0], [0.0, -3.0], [-2.0, 0.0]];
        for (pair, value) in found.iter().zip(expected) {
            for (x, y) in pair.value.iter().zip(value) {
                assert!((x - y).abs() < 1e-14, "{:?}", pair.value);
            }
            // A·w = λ·w
            let [re, im] = [0, 1].map(|part| {
                let part: Vec<f64> = pair.vector.iter().map(|z| z[part]).collect();
                a.times(&part)
            });
            for i in 0..4 {
                let [x, y] = pair.vector[i];
                let [l, m] = pair.value;
                let scale = 1e-13
                    * (0..4)
                        .map(|k| a[(i, k)].abs() * pair.vector[k][0].hypot(pair.vector[k][1]))
                        .sum::<f64>();
                assert!((re[i] - l * x + m * y).abs() <= scale, "row {i}");
                assert!((im[i] - l * y - m * x).abs() <= scale, "row {i}");
            }
        }
        assert_eq!(eigenpairs(&Matrix::from_rows(&[[f64::NAN]])), None);
    }
}
