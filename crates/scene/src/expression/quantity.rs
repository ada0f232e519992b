//! Numbers with dimensions, accurate to about 32 digits, and their sums, products and functions.
//!
//! Sums, products, quotients, roots and integer powers are practically exact. Therefore `0.1 + 0.2`
//! and `300 mm` give the doubles nearest to 0.3. Other functions are accurate to a double; their
//! errors are propagated to first order.

use std::f64::consts::PI;

use joints::is_usable;
use linalg::Dd;

use super::problem::Problem;
use crate::dimension::Dimension;

/// A number in an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantity {
    /// The value in kg, N, m, s and rad; for a bare number, the value as written.
    pub(crate) value: Dd,
    /// Upper bound on the error of the value.
    pub(crate) error: f64,
    /// The dimension. `None` for a bare number, which gets the dimension of its key.
    pub(crate) dimension: Option<Dimension>,
    /// Whether the value contains π. An angle that contains π is in radians.
    pub(super) has_pi: bool,
}

/// The factors that convert bare numbers to SI. They follow from the units that a scene chooses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bases {
    pub(crate) length: Dd,
    pub(crate) angle: Dd,
}

impl Bases {
    /// Metres and radians.
    pub(crate) const SI: Self = Self {
        length: Dd::ONE,
        angle: Dd::ONE,
    };

    /// Converts a bare number for a key of this dimension to SI; dimensionless numbers do not
    /// change.
    pub(super) fn scaled(self, bare: Quantity, dimension: Dimension) -> Result<Quantity, Problem> {
        let [length, angle] = dimension.chosen();
        if bare.has_pi && angle != 0 && self.angle != Dd::ONE {
            return Err(Problem::Pi);
        }
        let mut q = bare;
        for (base, power) in [(self.length, length), (self.angle, angle)] {
            if base != Dd::ONE {
                let factor = whole_power(Quantity::bare(base), i32::from(power));
                q = product(q, factor);
            }
        }
        Ok(Quantity {
            dimension: Some(dimension),
            ..q
        })
    }
}

/// π as the sum of two doubles; the second one is π − f64(π).
fn pi() -> Dd {
    Dd::from_sum(PI, 1.224_646_799_147_353_2e-16)
}

/// Largest integer power that is computed as a product. Other powers are computed in doubles.
const MOST_FACTORS: i32 = 64;

impl Quantity {
    pub(crate) fn bare(value: Dd) -> Self {
        Self {
            value,
            error: 0.0,
            dimension: None,
            has_pi: false,
        }
    }

    /// π, as a bare number.
    pub(crate) fn pi() -> Self {
        Self {
            has_pi: true,
            ..Self::bare(pi())
        }
    }

    /// Returns the unit of size `times/over` and of this dimension. Half a revolution is π as the
    /// sum of two doubles.
    pub(crate) fn unit(times: f64, over: f64, dimension: Dimension) -> Self {
        let times = if times == PI { pi() } else { times.into() };
        Self {
            dimension: Some(dimension),
            ..Self::bare(times / Dd::from(over))
        }
    }

    /// Converts the value for a key that requires the dimension `expected`.
    pub(crate) fn at(self, expected: Dimension, bases: Bases) -> Result<Self, Problem> {
        match self.dimension {
            None => bases.scaled(self, expected)?.checked(),
            Some(found) if found.fits(expected) => Ok(self),
            Some(found) => Err(Problem::Dimension { found, expected }),
        }
    }

    /// Converts the value to a double. A value that is not larger than its error bound becomes
    /// zero.
    pub(crate) fn to_f64(self) -> f64 {
        if self.value.hi().abs() <= self.error {
            0.0
        } else {
            self.value.to_f64()
        }
    }

    /// Interprets this number as an angle in radians.
    pub(crate) fn in_radians(self) -> Self {
        Self {
            dimension: Some(Dimension::ANGLE),
            ..self
        }
    }

    /// Returns this value as the result of an operation with another number. The result contains π
    /// if this value or the other number contains π.
    fn with(self, other: Self) -> Self {
        Self {
            has_pi: self.has_pi || other.has_pi,
            ..self
        }
    }

    fn of(self, value: Dd, error: f64) -> Self {
        Self {
            value,
            error,
            ..self
        }
    }

    /// Returns an error for values that are not permitted in any description.
    fn checked(self) -> Result<Self, Problem> {
        if is_usable(self.value.hi()) && self.error.is_finite() {
            Ok(self)
        } else {
            Err(Problem::Overflow)
        }
    }

    pub(crate) fn negated(self) -> Self {
        self.of(-self.value, self.error)
    }

    /// Converts both numbers to one dimension; a bare number gets the dimension of the other
    /// number.
    fn matched(self, other: Self, bases: Bases) -> Result<[Self; 2], Problem> {
        match (self.dimension, other.dimension) {
            (None, None) => Ok([self, other]),
            (Some(a), None) => Ok([self, bases.scaled(other, a)?]),
            (None, Some(b)) => Ok([bases.scaled(self, b)?, other]),
            (Some(a), Some(b)) if b.fits(a) => Ok([self, other]),
            (Some(a), Some(b)) if a.fits(b) => Ok([
                Self {
                    dimension: Some(b),
                    ..self
                },
                other,
            ]),
            (Some(a), Some(b)) => Err(Problem::Mixed { a, b }),
        }
    }

    pub(crate) fn plus(self, other: Self, bases: Bases) -> Result<Self, Problem> {
        let [a, b] = self.matched(other, bases)?;
        let sum = or_plain(a.value + b.value, a.value.hi() + b.value.hi());
        let terms = a.value.hi().abs() + b.value.hi().abs();
        let error = a.error + b.error + Dd::EPSILON * terms;
        a.with(b).of(sum, error).checked()
    }

    pub(crate) fn times(self, other: Self) -> Result<Self, Problem> {
        product(self, other).checked()
    }

    pub(crate) fn over(self, other: Self) -> Result<Self, Problem> {
        if other.to_f64() == 0.0 {
            return Err(Problem::DivisionByZero);
        }
        let (a, b) = (self.value.hi(), other.value.hi());
        let quotient = or_plain(self.value / other.value, a / b);
        let error = (self.error + other.error * (a / b).abs()) / b.abs();
        let error = error + Dd::EPSILON * (a / b).abs();
        let dimension = dimension_of(self.dimension, other.dimension, -1);
        Self {
            dimension,
            ..self.with(other).of(quotient, error)
        }
        .checked()
    }

    pub(crate) fn power(self, exponent: Self) -> Result<Self, Problem> {
        match exponent.dimension {
            None | Some(Dimension::NONE) => {}
            Some(found) => return Err(Problem::Exponent { found }),
        }
        let (x, y) = (self.value.hi(), exponent.value.hi());
        let is_whole = exponent.value.lo() == 0.0 && y.fract() == 0.0;
        if y < 0.0 && self.to_f64() == 0.0 {
            return Err(Problem::DivisionByZero);
        }
        #[expect(clippy::cast_possible_truncation, reason = "whole and small")]
        if is_whole && y.abs() <= f64::from(MOST_FACTORS) {
            return whole_power(self, y as i32).checked();
        }
        if let Some(of) = self.dimension.filter(|d| *d != Dimension::NONE) {
            return Err(Problem::PowerOfUnit { of });
        }
        let value = x.powf(y);
        if value.is_nan() {
            return Err(Problem::Undefined {
                name: "a power",
                value: x,
            });
        }
        let relative = (y / x).abs() * (self.error + self.value.lo().abs())
            + x.abs().ln().abs() * (exponent.error + exponent.value.lo().abs());
        let relative = if x == 0.0 { 0.0 } else { relative };
        let error = value.abs() * (relative + f64::EPSILON);
        self.of(Dd::from(value), error).checked()
    }

    pub(crate) fn abs(self) -> Self {
        self.of(self.value.abs(), self.error)
    }

    /// The smaller number if `sign` is 1, the larger number if it is −1.
    pub(crate) fn least(self, other: Self, sign: f64, bases: Bases) -> Result<Self, Problem> {
        let [a, b] = self.matched(other, bases)?;
        let is_less = ((a.value - b.value).hi() * sign) < 0.0;
        Ok(if is_less { a } else { b })
    }

    pub(crate) fn root(self) -> Result<Self, Problem> {
        let root = self
            .dimension
            .map(|d| d.root().ok_or(Problem::Root { of: d }));
        let dimension = root.transpose()?;
        if self.to_f64() < 0.0 {
            return Err(Problem::Undefined {
                name: "`sqrt`",
                value: self.to_f64(),
            });
        }
        let value = self.value.abs().sqrt();
        // Near zero, the error of the root is the square root of the error.
        let error = (self.error / value.hi().max(f64::MIN_POSITIVE)).min(self.error.sqrt());
        Ok(Self {
            dimension,
            ..self.of(value, error + Dd::EPSILON * value.hi())
        })
    }

    /// Returns `f(x)` as a bare number; its error is computed with the derivative of f.
    pub(crate) fn smooth(
        self,
        name: &'static str,
        f: fn(f64) -> f64,
        derivative: impl Fn(f64) -> f64,
    ) -> Result<Self, Problem> {
        let x = self.value.hi();
        let (y, slope) = (f(x), derivative(x));
        if y.is_nan() {
            return Err(Problem::Undefined { name, value: x });
        }
        let along = |change: f64| if change == 0.0 { 0.0 } else { slope * change };
        let error = along(self.error).abs() + f64::EPSILON * y.abs();
        let value = or_plain(Dd::from_sum(y, along(self.value.lo())), y);
        Self {
            error,
            ..Self::bare(value)
        }
        .checked()
    }

    /// Returns the angle of the point (x, y).
    pub(crate) fn angle(self, x: Self, bases: Bases) -> Result<Self, Problem> {
        let [y, x] = self.matched(x, bases)?;
        let (a, b) = (y.value.hi(), x.value.hi());
        let radius = a.hypot(b);
        if radius == 0.0 {
            return Err(Problem::Undefined {
                name: "`atan2`",
                value: 0.0,
            });
        }
        let (cos, sin) = (b / radius, a / radius);
        let turn = (cos * y.value.lo() - sin * x.value.lo()) / radius;
        let angle = a.atan2(b);
        Self {
            dimension: Some(Dimension::ANGLE),
            error: (y.error + x.error) / radius + f64::EPSILON * angle.abs(),
            value: or_plain(Dd::from_sum(angle, turn), angle),
            has_pi: false,
        }
        .checked()
    }
}

/// Returns the dimension of the product of a quantity of dimension `a` and the power ±1 of a
/// quantity of dimension `b`. Bare factors count as dimensionless.
fn dimension_of(a: Option<Dimension>, b: Option<Dimension>, power: i8) -> Option<Dimension> {
    let has_one = a.is_some() || b.is_some();
    let [a, b] = [a, b].map(|d| d.unwrap_or(Dimension::NONE));
    has_one.then(|| a.times(b, power))
}

fn product(a: Quantity, b: Quantity) -> Quantity {
    let value = or_plain(a.value * b.value, a.value.hi() * b.value.hi());
    let error = a.error * b.value.hi().abs() + b.error * a.value.hi().abs();
    Quantity {
        value,
        error: error + Dd::EPSILON * value.hi().abs(),
        dimension: dimension_of(a.dimension, b.dimension, 1),
        ..a.with(b)
    }
}

/// Returns `q^n` without a check of the result.
fn whole_power(q: Quantity, n: i32) -> Quantity {
    let one = Quantity {
        dimension: q.dimension.map(|_| Dimension::NONE),
        ..Quantity::bare(Dd::ONE)
    };
    let power = (0..n.unsigned_abs()).fold(one, |power, _| product(power, q));
    if n < 0 {
        one.over(power)
            .unwrap_or(one.of(Dd::from(f64::INFINITY), 0.0))
    } else {
        power
    }
}

/// Returns the value as a sum of two doubles. Near the ends of the range of doubles, the second
/// double does not exist, and the result is the plain double.
fn or_plain(value: Dd, plain: f64) -> Dd {
    if value.hi().is_finite() && value.lo().is_finite() {
        value
    } else {
        Dd::from(plain)
    }
}
