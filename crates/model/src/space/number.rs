//! Number types in which angles can be computed.

use joints::Ring;
use linalg::Dd;

/// A number type in which angles can be computed.
pub trait Number: Ring + std::ops::Div<Output = Self> {
    /// Returns √self.
    #[must_use]
    fn root(self) -> Self;

    /// Returns the nearest `f64`.
    #[must_use]
    fn nearest(self) -> f64;

    /// Returns the sine and cosine.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// Returns the angle of the direction (x, y), from −π to π.
    #[must_use]
    fn atan2(y: Self, x: Self) -> Self;

    /// Returns the vector (x, y) scaled to length one; the vector must not be zero.
    #[must_use]
    fn normalised(x: Self, y: Self) -> (Self, Self);
}

impl Number for f64 {
    fn root(self) -> Self {
        self.sqrt()
    }

    fn nearest(self) -> f64 {
        self
    }

    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }

    fn atan2(y: Self, x: Self) -> Self {
        y.atan2(x)
    }

    fn normalised(x: Self, y: Self) -> (Self, Self) {
        let length = x.hypot(y);
        (x / length, y / length)
    }
}

impl Number for Dd {
    fn root(self) -> Self {
        self.sqrt()
    }

    fn nearest(self) -> f64 {
        self.to_f64()
    }

    fn sin_cos(self) -> (Self, Self) {
        Dd::sin_cos(self)
    }

    /// Computes the angle in `f64` and adds the remaining angle. The square of the remaining angle
    /// is smaller than the last digit.
    fn atan2(y: Self, x: Self) -> Self {
        let (x, y) = Self::normalised(x, y);
        let near = Self::from(y.to_f64().atan2(x.to_f64()));
        let (sin, cos) = near.sin_cos();
        near + (y * cos - x * sin)
    }

    fn normalised(x: Self, y: Self) -> (Self, Self) {
        let length = (x * x + y * y).sqrt();
        (x / length, y / length)
    }
}
