//! Proves that no other velocity exists. The proof is a combination of the forms that does not
//! contain the motion and is positive definite in the new motions, `Σ w_s·M_s = [0 0; 0 G]` with
//! `yᵀ·G·y > 0`. Every solution then has y = 0. If y has one component, such a combination always
//! exists if no other velocity exists.

use crate::limits::{BLOCKED_CORRECTIONS, FORM_NOISE, MARGIN};
use linalg::Matrix;

use super::forms::Forms;

/// Returns whether such a combination was found.
pub(super) fn is_blocked(forms: &Forms) -> bool {
    let (x, y) = (forms.x(), forms.y());
    let mixed = Matrix::from_fn(forms.matrices.len(), x * y, |s, e| {
        forms.matrices[s][(e / y, x + e % y)]
    });
    let Ok(decision) = rank::decide(&mixed, rank::Accuracy::Absolute(FORM_NOISE)) else {
        return false;
    };
    if !decision.is_decided() && mixed.max_abs() > FORM_NOISE {
        return false;
    }
    let definite = combinations(&decision)
        .iter()
        .map(|w| {
            let entry = |i, j| {
                let terms = w.iter().zip(&forms.matrices);
                terms.map(|(w, m)| w * m[(x + i, x + j)]).sum()
            };
            Matrix::from_fn(y, y, entry)
        })
        .collect::<Vec<_>>();
    has_definite_combination(&definite, y)
}

/// Returns orthonormal vectors w with `wᵀ·mixed = 0`.
fn combinations(decision: &rank::RankDecision) -> Vec<Vec<f64>> {
    let mut z = rank::orthonormal(decision);
    for i in 0..z.nrows() {
        let factor = decision.scaling.row_factor(i);
        z.row_mut(i).iter_mut().for_each(|z| *z *= factor);
    }
    let w = linalg::PivotedQr::of_columns(&z).q_columns(0..z.ncols());
    (0..w.ncols())
        .map(|j| (0..w.nrows()).map(|i| w[(i, j)]).collect())
        .collect()
}

/// Performs the perceptron iteration. As long as there is a y with too small `yᵀ·G·y`, G is moved
/// towards the matrices that are positive for this y.
pub(super) fn has_definite_combination(matrices: &[Matrix], n: usize) -> bool {
    let mut w: Vec<f64> = matrices
        .iter()
        .map(|m| (0..n).map(|i| m[(i, i)]).sum())
        .collect();
    for _ in 0..BLOCKED_CORRECTIONS {
        let size = w.iter().map(|w| w * w).sum::<f64>().sqrt();
        if size == 0.0 {
            return false;
        }
        let g = Matrix::from_fn(n, n, |i, j| {
            let sum: f64 = w.iter().zip(matrices).map(|(w, m)| w * m[(i, j)]).sum();
            sum / size - if i == j { MARGIN } else { 0.0 }
        });
        let Some(u) = not_positive(g) else {
            return true;
        };
        for (w, m) in w.iter_mut().zip(matrices) {
            let image = m.times(&u);
            *w += u.iter().zip(&image).map(|(u, m)| u * m).sum::<f64>();
        }
    }
    false
}

/// Returns a unit vector u with `uᵀ·G·u ≤ 0`, from `G = L·D·Lᵀ`. Returns `None` if G is positive
/// definite.
fn not_positive(mut g: Matrix) -> Option<Vec<f64>> {
    let n = g.nrows();
    for j in 0..n {
        let pivot = g[(j, j)];
        if pivot <= 0.0 || pivot.is_nan() {
            // The solution u of Lᵀ·u = e_j has uᵀ·G·u = d_j. The factors of L are stored below the
            // diagonal.
            let mut u = vec![0.0; n];
            u[j] = 1.0;
            for i in (0..j).rev() {
                u[i] = -(i + 1..=j).map(|l| g[(l, i)] * u[l]).sum::<f64>();
            }
            let size = u.iter().map(|u| u * u).sum::<f64>().sqrt();
            return Some(u.iter().map(|u| u / size).collect());
        }
        let column: Vec<f64> = (j + 1..n).map(|i| g[(i, j)]).collect();
        for i in j + 1..n {
            let factor = column[i - j - 1] / pivot;
            for l in j + 1..=i {
                g[(i, l)] -= factor * column[l - j - 1];
            }
            g[(i, j)] = factor;
        }
    }
    None
}
