//! The polynomial that gives the second joint coordinate as a function of the first.

use joints::Scalar;

/// The polynomial h(x) = c₁·x + c₂·x² + …, without a constant term.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Creates the polynomial from c₁, c₂, …. Returns `None` if a coefficient is not finite or all
    /// coefficients are zero.
    pub(super) fn new(coefficients: &[f64]) -> Option<Self> {
        let are_finite = coefficients.iter().all(|c| c.is_finite());
        let moves = coefficients.iter().any(|c| *c != 0.0);
        (are_finite && moves).then(|| Self {
            coefficients: coefficients.to_vec(),
        })
    }

    /// Returns the degree.
    pub(super) fn degree(&self) -> usize {
        self.coefficients.len()
    }

    /// Returns the coefficients c₁, c₂, …
    pub(super) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Returns the coefficients as a mutable slice.
    pub(super) fn coefficients_mut(&mut self) -> &mut [f64] {
        &mut self.coefficients
    }

    /// Returns h and its first three derivatives at x, by Horner's scheme. If the coefficients are
    /// read from the stored values of an operation list, the first coefficient has the index
    /// `first`.
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
        // After the loop, `h` contains the quotient h(x)/x and its derivatives.
        for k in (1..4).rev() {
            h[k] = h[k] * x + factors[k] * h[k - 1];
        }
        h[0] = h[0] * x;
        h
    }
}
