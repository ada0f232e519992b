//! Orthonormal combinations of the forms, with bounds of the errors of their coefficients.

use crate::limits::{DEPENDENT_FORMS, FORMS_OF_ROUNDING};
use linalg::{Matrix, PivotedQr};

/// Orthonormal combinations of forms.
pub(super) struct Independent {
    /// Number of unknowns d.
    pub(super) unknowns: usize,
    /// Symmetric d × d matrices, orthonormal in the Frobenius product.
    pub(super) forms: Vec<Matrix>,
    /// Error bound of the coefficients of each form.
    pub(super) error: Vec<f64>,
    /// Whether the given forms are combinations of these forms, except for forms that are rounding.
    /// Otherwise a common zero of these forms need not be a zero of the given forms.
    pub(super) spans_all: bool,
}

impl Independent {
    /// Returns the combinations of the given forms. The coefficients of the given forms have errors
    /// up to `error`.
    pub(super) fn of(forms: &[Matrix], unknowns: usize, error: f64) -> Self {
        let pairs: Vec<(usize, usize)> = (0..unknowns)
            .flat_map(|i| (i..unknowns).map(move |j| (i, j)))
            .collect();
        let weight = |i: usize, j: usize| if i == j { 1.0 } else { 2.0_f64.sqrt() };
        let listed = Matrix::from_fn(forms.len(), pairs.len(), |s, k| {
            let (i, j) = pairs[k];
            weight(i, j) * forms[s][(i, j)]
        });
        let error = error + f64::EPSILON * listed.max_abs();
        let qr = PivotedQr::of_rows(listed);
        let diagonal: Vec<f64> = qr.r_diagonal().map(f64::abs).collect();
        let rank = diagonal
            .iter()
            .filter(|r| **r > DEPENDENT_FORMS * error)
            .count();
        let rounding = FORMS_OF_ROUNDING * unknowns as f64 * error;
        let spans_all = diagonal[rank..].iter().all(|r| *r <= rounding);
        let q = qr.q_columns(0..rank);
        let place = |i: usize, j: usize| pairs.partition_point(|&pair| pair < (i.min(j), i.max(j)));
        Self {
            unknowns,
            forms: (0..rank)
                .map(|s| {
                    let entry = |i, j| q[(place(i, j), s)] / weight(i, j);
                    Matrix::from_fn(unknowns, unknowns, entry)
                })
                .collect(),
            error: growth(&qr.r(), rank)
                .into_iter()
                .map(|growth| growth * error + f64::EPSILON * unknowns as f64)
                .collect(),
            spans_all,
        }
    }

    /// Returns the combination `Σ w_s·M_s` and the error bound of its coefficients.
    pub(super) fn combination(&self, w: &[f64]) -> (Matrix, f64) {
        let entry = |i, j| w.iter().zip(&self.forms).map(|(w, m)| w * m[(i, j)]).sum();
        let error = w.iter().zip(&self.error).map(|(w, e)| w.abs() * e).sum();
        (Matrix::from_fn(self.unknowns, self.unknowns, entry), error)
    }

    /// Returns the values of the forms at a.
    pub(super) fn values(&self, a: &[f64]) -> Vec<f64> {
        self.forms.iter().map(|m| value(m, a)).collect()
    }
}

/// Returns `aᵀ·M·a`.
pub(super) fn value(m: &Matrix, a: &[f64]) -> f64 {
    a.iter().zip(m.times(a)).map(|(a, m)| a * m).sum()
}

/// Returns the column sums of |R⁻¹|. The column sums are the growth of the errors of the forms in
/// each combination.
fn growth(r: &Matrix, rank: usize) -> Vec<f64> {
    let column = |j: usize| {
        let mut x = vec![0.0; j + 1];
        for i in (0..=j).rev() {
            let known: f64 = (i + 1..=j).map(|k| r[(i, k)] * x[k]).sum();
            x[i] = (f64::from(i == j) - known) / r[(i, i)];
        }
        x.iter().map(|x: &f64| x.abs()).sum()
    };
    (0..rank).map(column).collect()
}
