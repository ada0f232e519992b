//! A matrix with its singular values. The values also apply to matrices that differ only by
//! rounding.

use linalg::{Matrix, singular_values};

/// A matrix in `f64` with all its `min(m, n)` singular values, largest first.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spectrum {
    matrix: Matrix,
    values: Vec<f64>,
}

impl Spectrum {
    /// Computes the singular values of a matrix with finite entries.
    #[must_use]
    pub fn of(matrix: Matrix) -> Self {
        Self {
            values: singular_values(&matrix),
            matrix,
        }
    }

    /// Returns the matrix.
    #[must_use]
    pub fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// Returns the singular values, largest first.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the singular values of another matrix if its difference from this matrix is at most
    /// the rounding of a singular value, `‖A − B‖ ≤ eps·√(m·n)·σ₁`. By Weyl's theorem, `|σ_k(A) −
    /// σ_k(B)| ≤ ‖A − B‖`.
    #[must_use]
    pub fn of_neighbour(&self, other: &Matrix) -> Option<&[f64]> {
        let (m, n) = (self.matrix.nrows(), self.matrix.ncols());
        if (m, n) != (other.nrows(), other.ncols()) {
            return None;
        }
        let mut apart = other.clone();
        for (x, own) in apart.as_mut_slice().iter_mut().zip(self.matrix.as_slice()) {
            *x -= own;
        }
        let largest = self.values.first().copied().unwrap_or(0.0);
        let rounding = f64::EPSILON * (m as f64 * n as f64).sqrt() * largest;
        let is_near = apart.first_non_finite().is_none() && apart.frobenius_norm() <= rounding;
        is_near.then_some(&self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// diag(2, 1) and diag(2, 1 + δ): the values are shared up to δ = 2·2·eps, and not beyond.
    #[test]
    fn only_a_matrix_within_rounding_has_the_same_values() {
        let at = |delta: f64| Matrix::from_rows(&[[2.0, 0.0], [0.0, 1.0 + delta]]);
        let spectrum = Spectrum::of(at(0.0));
        assert_eq!(
            spectrum.of_neighbour(&at(4.0 * f64::EPSILON)),
            Some(&[2.0, 1.0][..])
        );
        assert_eq!(spectrum.of_neighbour(&at(5.0 * f64::EPSILON)), None);
        assert_eq!(spectrum.of_neighbour(&at(f64::NAN)), None);
        assert_eq!(spectrum.of_neighbour(&Matrix::zeros(1, 2)), None);
    }
}
