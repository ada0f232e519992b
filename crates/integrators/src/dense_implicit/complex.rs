//! Complex numbers, with the operations needed by a factorisation.

use std::ops::{Add, Div, Mul, Sub};

/// The complex number `re + i·im`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

impl Add for Complex {
    type Output = Self;

    fn add(self, b: Self) -> Self {
        Self {
            re: self.re + b.re,
            im: self.im + b.im,
        }
    }
}

impl Sub for Complex {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        Self {
            re: self.re - b.re,
            im: self.im - b.im,
        }
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, b: Self) -> Self {
        Self {
            re: self.re * b.re - self.im * b.im,
            im: self.re * b.im + self.im * b.re,
        }
    }
}

impl Div for Complex {
    type Output = Self;

    /// Smith's formula computes neither |b|² nor its inverse. Therefore no intermediate result
    /// overflows before the quotient.
    fn div(self, b: Self) -> Self {
        if b.re.abs() >= b.im.abs() {
            let ratio = b.im / b.re;
            let d = b.re + b.im * ratio;
            Self {
                re: (self.re + self.im * ratio) / d,
                im: (self.im - self.re * ratio) / d,
            }
        } else {
            let ratio = b.re / b.im;
            let d = b.re * ratio + b.im;
            Self {
                re: (self.re * ratio + self.im) / d,
                im: (self.im * ratio - self.re) / d,
            }
        }
    }
}
