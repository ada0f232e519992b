//! `A = L·D·Lᵀ` of symmetric positive definite matrices on the caller's storage, without roots and without pivoting.
//!
//! For reduced masses and regularised ones: definite by physics or by construction, and a pivot that is lost names the motion that has no
//! mass. Not for indefinite matrices.

use crate::kernels::{axpy, dot};

/// A pivot that rounding cannot tell from zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lost {
    /// Its place.
    pub(crate) at: usize,
    /// What is left of the diagonal entry.
    pub(crate) left: f64,
    /// The diagonal entry.
    pub(crate) size: f64,
}

/// Factors the k×k matrix whose lower triangle stands in `a` (row-major): unit lower L below the diagonal, D on it. A pivot must exceed
/// `floor(i, a_ii)`.
pub(crate) fn factor(
    a: &mut [f64],
    k: usize,
    floor: impl Fn(usize, f64) -> f64,
) -> Result<(), Lost> {
    for i in 0..k {
        let (above, rest) = a.split_at_mut(i * k);
        let row = &mut rest[..k];
        let size = row[i];
        // First v_j = l_ij·d_j, then l_ij.
        for j in 0..i {
            row[j] -= dot(&row[..j], &above[j * k..j * k + j]);
        }
        let mut left = size;
        for j in 0..i {
            let v_j = row[j];
            row[j] /= above[j * k + j];
            left -= v_j * row[j];
        }
        if left.is_nan() || left <= floor(i, size) {
            return Err(Lost { at: i, left, size });
        }
        row[i] = left;
    }
    Ok(())
}

/// `x ← L⁻¹·x`.
pub(crate) fn forward(a: &[f64], x: &mut [f64]) {
    let k = x.len();
    for i in 0..k {
        x[i] -= dot(&a[i * k..i * k + i], &x[..i]);
    }
}

/// `x ← (L·D·Lᵀ)⁻¹·x`.
pub(crate) fn solve(a: &[f64], x: &mut [f64]) {
    let k = x.len();
    forward(a, x);
    for i in 0..k {
        x[i] /= a[i * k + i];
    }
    backward(a, x);
}

/// `x ← L⁻ᵀ·x`.
pub(crate) fn backward(a: &[f64], x: &mut [f64]) {
    let k = x.len();
    for i in (0..k).rev() {
        let x_i = x[i];
        axpy(-x_i, &a[i * k..i * k + i], &mut x[..i]);
    }
}

/// The vector z with `zᵀ·A·z` equal to the lost pivot: `[−L₁₁⁻ᵀ·l_i; 1; 0]`.
pub(crate) fn direction(a: &[f64], k: usize, lost: Lost) -> Vec<f64> {
    let i = lost.at;
    let mut z = vec![0.0; k];
    for j in 0..i {
        z[j] = -a[i * k + j];
    }
    for j in (0..i).rev() {
        let z_j = z[j];
        axpy(-z_j, &a[j * k..j * k + j], &mut z[..j]);
    }
    z[i] = 1.0;
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_and_solves_by_hand() {
        // L = [1 0; ½ 1], D = (4, 2).
        let mut a = [4.0, 0.0, 2.0, 3.0];
        factor(&mut a, 2, |_, _| 0.0).unwrap();
        assert_eq!([a[0], a[2], a[3]], [4.0, 0.5, 2.0]);
        let mut x = [8.0, 8.0];
        solve(&a, &mut x);
        assert_eq!(x, [1.0, 2.0]);
    }

    #[test]
    fn a_lost_pivot_has_its_direction() {
        // (1, −1, 0) is in the null space.
        let mut a = [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 5.0];
        let lost = factor(&mut a, 3, |_, size| f64::EPSILON * size).unwrap_err();
        assert_eq!((lost.at, lost.left, lost.size), (1, 0.0, 1.0));
        assert_eq!(direction(&a, 3, lost), [-1.0, 1.0, 0.0]);
    }
}
