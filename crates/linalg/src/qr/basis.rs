//! Independent rows of a matrix, factored once. The other rows of the matrix are expressed by the
//! independent rows.

use super::PivotedQr;
use super::factor::factor_leading;
use crate::Matrix;

/// A factorisation of r independent rows K of an m×n matrix C, and the relation of the other rows D
/// to the rows K: `C_D = T·C_K + S`, where the rows of S are orthogonal to the rows of `C_K`.
///
/// ```
/// use pfaff_linalg::{Matrix, RowBasis};
/// let c = Matrix::from_rows(&[[1.0, 0.0], [3.0, 0.0], [4.0, 5.0]]);
/// let basis = RowBasis::most_independent(c, 2);
/// assert_eq!((basis.kept(), basis.dropped()), (&[1, 2][..], &[0][..]));
/// let mut t = [0.0; 2];
/// basis.coefficients(0, &mut t);
/// assert!((t[0] - 1.0 / 3.0).abs() < 1e-15 && t[1].abs() < 1e-15);
/// ```
#[derive(Debug, Clone)]
pub struct RowBasis {
    kept: Vec<usize>,
    dropped: Vec<usize>,
    /// Factors of `C_K`, rows ascending.
    factored: PivotedQr,
    /// The product `C_D·Q`, p×n.
    rotated: Matrix,
}

impl RowBasis {
    /// Creates the basis from the r rows of C that a pivoted factorisation selects first.
    ///
    /// # Panics
    /// Panics if r exceeds the number of rows or of columns.
    #[must_use]
    pub fn most_independent(c: Matrix, r: usize) -> Self {
        let (m, n) = (c.nrows(), c.ncols());
        assert!(r <= m.min(n), "{r} independent rows of an {m}×{n} matrix");
        let PivotedQr {
            factors,
            tau,
            permutation,
        } = factor_leading(c, r);
        let (first, last) = permutation.split_at(r);
        let mut kept = first.to_vec();
        kept.sort_unstable();
        let place = |row: &usize| kept.binary_search(row).unwrap_or_else(|place| place);
        let permutation = first.iter().map(place).collect();
        let mut order: Vec<usize> = (0..m - r).collect();
        order.sort_unstable_by_key(|&j| last[j]);
        let leading: Vec<usize> = (0..r).collect();
        let beyond: Vec<usize> = order.iter().map(|j| r + j).collect();
        Self {
            dropped: order.iter().map(|&j| last[j]).collect(),
            kept,
            rotated: factors.select_rows(&beyond),
            factored: PivotedQr {
                factors: factors.select_rows(&leading),
                tau,
                permutation,
            },
        }
    }

    /// Creates the basis from these rows of C, which must be independent.
    ///
    /// # Panics
    /// Panics if there are more rows than columns.
    #[must_use]
    pub fn of_rows(c: &Matrix, mut kept: Vec<usize>) -> Self {
        assert!(
            kept.len() <= c.ncols(),
            "more independent rows than columns"
        );
        kept.sort_unstable();
        let is_dropped = |i: &usize| kept.binary_search(i).is_err();
        let dropped: Vec<usize> = (0..c.nrows()).filter(is_dropped).collect();
        let factored = PivotedQr::of_rows(c.select_rows(&kept));
        let mut rotated = c.select_rows(&dropped);
        for j in 0..dropped.len() {
            factored.q_transpose_mul(rotated.row_mut(j));
        }
        Self {
            kept,
            dropped,
            factored,
            rotated,
        }
    }

    /// Returns the rows K, ascending.
    #[must_use]
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Returns the rows D, ascending.
    #[must_use]
    pub fn dropped(&self) -> &[usize] {
        &self.dropped
    }

    /// Returns the factors of `C_K`, rows ascending.
    #[must_use]
    pub fn factored(&self) -> &PivotedQr {
        &self.factored
    }

    /// Returns only the factors of `C_K`.
    #[must_use]
    pub fn into_factored(self) -> PivotedQr {
        self.factored
    }

    /// Writes row j of T, which expresses row `dropped[j]` by the kept rows. The r values have the
    /// order of [`RowBasis::kept`].
    ///
    /// # Panics
    /// Panics if j or the length of `t` is wrong.
    pub fn coefficients(&self, j: usize, t: &mut [f64]) {
        let r = self.kept.len();
        assert_eq!(t.len(), r, "one coefficient for each kept row");
        let mut x = self.rotated.row(j)[..r].to_vec();
        self.factored.solve_r(&mut x);
        for (x, &k) in x.iter().zip(self.factored.permutation()) {
            t[k] = *x;
        }
    }

    /// Returns row j of S as n − r values in the basis of the last columns of Q.
    ///
    /// # Panics
    /// Panics if j is not below the number of dropped rows.
    #[must_use]
    pub fn outside(&self, j: usize) -> &[f64] {
        &self.rotated.row(j)[self.kept.len()..]
    }
}
