//! The polynomial by which one measure follows another.

use joints::Scalar;

/// h(x) = c₁·x + c₂·x² + …, without a constant.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// From c₁, c₂, …; `None` if one is not finite or all are zero.
    pub(super) fn new(coefficients: &[f64]) -> Option<Self> {
        let are_finite = coefficients.iter().all(|c| c.is_finite());
        let moves = coefficients.iter().any(|c| *c != 0.0);
        (are_finite && moves).then(|| Self {
            coefficients: coefficients.to_vec(),
        })
    }

    /// Its degree.
    pub(super) fn degree(&self) -> usize {
        self.coefficients.len()
    }

    /// c₁, c₂, …
    pub(super) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The same to be changed.
    pub(super) fn coefficients_mut(&mut self) -> &mut [f64] {
        &mut self.coefficients
    }

    /// h and its first three derivatives at x, by Horner's scheme; what reads the coefficients as
    /// stored numbers finds them from this place on.
    pub(super) fn at<T: Scalar>(&self, x: T, first: usize) -> [T; 4] {
        let zero = T::from(0.0);
        let mut h = [zero; 4];
        let factors = [0.0, 1.0, 2.0, 3.0].map(T::from);
        for (k, &c) in self.coefficients.iter().enumerate().rev() {
            let c = T::stored(c, first + k);
            for k in (1..4).rev() {
                h[k] = h[k] * x + factors[k] * h[k - 1];
            }
            h[0] = h[0] * x + c;
        }
        // The loop has left the quotient h(x)/x with its derivatives.
        for k in (1..4).rev() {
            h[k] = h[k] * x + factors[k] * h[k - 1];
        }
        h[0] = h[0] * x;
        h
    }
}
