//! Dual numbers with error bounds: `num-dual` computes value and derivative, and a first-order
//! running error analysis (Wilkinson; Higham 2002, section 3.3) computes a bound for the rounding
//! error of each. Two evaluations of the same mathematics differ by at most the sum of their
//! bounds.

use std::ops::{Add, Div, Mul, Neg};

use num_dual::{Dual64, DualNum};
use pfaff_symbolic::{Function, Number};

/// Factor for terms of second order, and for constants that the graph folds in another order.
const SAFETY: f64 = 4.0;

/// Above this relative error of an argument the first-order analysis is not valid for `1/u`, `√u`,
/// `sin u`.
const FIRST_ORDER: f64 = 1e-6;

/// A value and a derivative with bounds of their errors, in units of the machine epsilon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Running {
    dual: Dual64,
    value_error: f64,
    slope_error: f64,
}

/// A number with a bound of its rounding error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounded {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Bounded {
    /// Returns the largest difference that rounding can cause.
    pub(crate) fn tolerance(self, other: Self) -> f64 {
        self.error + other.error
    }

    /// Whether the two agree within their bounds; false if one of them is NaN.
    pub(crate) fn agrees(self, other: Self) -> bool {
        (self.value - other.value).abs() <= self.tolerance(other)
    }
}

impl Running {
    /// Creates an input; `slope` is 1 for the variable of differentiation and 0 for the others.
    pub(crate) fn input(value: f64, slope: f64) -> Self {
        Self {
            dual: Dual64::new(value, slope),
            value_error: 0.0,
            slope_error: 0.0,
        }
    }

    pub(crate) fn value(self) -> Bounded {
        Bounded {
            value: self.dual.re,
            error: SAFETY * f64::EPSILON * self.value_error,
        }
    }

    pub(crate) fn slope(self) -> Bounded {
        Bounded {
            value: self.dual.eps,
            error: SAFETY * f64::EPSILON * self.slope_error,
        }
    }

    fn recip(self) -> Self {
        let u = self.dual.re;
        let (f1, f2) = (1.0 / (u * u), 2.0 / (u * u * u));
        self.chain(self.dual.recip(), f1, f2, u.abs())
    }

    /// Computes `f(self)`; `dual` is the result, and `f1`, `f2` are the first and second derivative
    /// at the argument.
    fn chain(self, dual: Dual64, f1: f64, f2: f64, scale: f64) -> Self {
        let slope = self.dual.eps;
        let trusted = self.value_error * f64::EPSILON <= FIRST_ORDER * scale;
        let bound = |e: f64| if trusted { e } else { f64::INFINITY };
        Self {
            dual,
            value_error: bound(f1.abs() * self.value_error + dual.re.abs()),
            slope_error: bound(
                f1.abs() * self.slope_error
                    + (f2 * slope).abs() * self.value_error
                    + 3.0 * (f1 * slope).abs(),
            ),
        }
    }
}

impl From<f64> for Running {
    fn from(x: f64) -> Self {
        Self {
            dual: x.into(),
            value_error: x.abs(),
            slope_error: 0.0,
        }
    }
}

impl Add for Running {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let dual = self.dual + b.dual;
        Self {
            dual,
            value_error: self.value_error + b.value_error + dual.re.abs(),
            slope_error: self.slope_error + b.slope_error + dual.eps.abs(),
        }
    }
}

impl Mul for Running {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let (x, dx) = (self.dual.re.abs(), self.dual.eps.abs());
        let (y, dy) = (b.dual.re.abs(), b.dual.eps.abs());
        Self {
            dual: self.dual * b.dual,
            value_error: x * b.value_error + y * self.value_error + x * y,
            slope_error: dx * b.value_error
                + y * self.slope_error
                + x * b.slope_error
                + dy * self.value_error
                + 2.0 * (dx * y + x * dy),
        }
    }
}

impl Div for Running {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let inverse = b.recip();
        Self {
            dual: self.dual / b.dual,
            ..self * inverse
        }
    }
}

impl Neg for Running {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            dual: -self.dual,
            ..self
        }
    }
}

impl Number for Running {
    fn call(self, f: Function) -> Self {
        let u = self.dual.re;
        match f {
            Function::Sqrt => {
                let root = u.sqrt();
                self.chain(self.dual.sqrt(), 0.5 / root, 0.25 / (u * root), u)
            }
            Function::RecipOrZero if u == 0.0 => self.chain(Dual64::from(0.0), 0.0, 0.0, 0.0),
            Function::RecipOrZero => self.recip(),
            Function::Sin => self.chain(self.dual.sin(), u.cos(), u.sin(), 1.0),
            Function::Cos => self.chain(self.dual.cos(), u.sin(), u.cos(), 1.0),
            Function::AngleOverSine(order) => {
                let [value, slope, curve] =
                    [0, 1, 2].map(|more| rotation::angle_over_sine(u, order + more));
                self.chain(Dual64::new(value, slope * self.dual.eps), slope, curve, 1.0)
            }
        }
    }
}
