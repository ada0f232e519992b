//! Comparison of matrices up to rounding with `approx`, for tests: shapes must be equal, and
//! entries nearly equal.

use approx::{AbsDiffEq, RelativeEq};

use super::Matrix;

impl AbsDiffEq for Matrix {
    type Epsilon = f64;

    fn default_epsilon() -> f64 {
        f64::EPSILON
    }

    fn abs_diff_eq(&self, other: &Self, epsilon: f64) -> bool {
        (self.nrows, self.ncols) == (other.nrows, other.ncols)
            && self.data.abs_diff_eq(&other.data, epsilon)
    }
}

impl RelativeEq for Matrix {
    fn default_max_relative() -> f64 {
        f64::EPSILON
    }

    fn relative_eq(&self, other: &Self, epsilon: f64, max_relative: f64) -> bool {
        (self.nrows, self.ncols) == (other.nrows, other.ncols)
            && self.data.relative_eq(&other.data, epsilon, max_relative)
    }
}
