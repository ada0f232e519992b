//! Number types for the evaluation of laws: doubles, dual numbers, and numbers that record their
//! operations.

use joints::{Real, RecordedNumber};

use crate::called::{CalledFunction, DriveState};

use super::{Join, UnaryFunction, UndefinedValue};

/// A number type for the evaluation of laws.
pub(crate) trait LawNumber: Copy + From<f64> {
    /// Returns the value, or `None` if the type records only operations.
    fn number(self) -> Option<f64>;

    /// Applies a function of one variable.
    fn apply(self, f: UnaryFunction) -> Self;

    /// Applies a function of two variables. The second variable is `b`.
    fn join(self, j: Join, b: Self) -> Self;
}

/// A number type for which these functions have derivatives.
pub(crate) trait Smooth: LawNumber + Real {
    /// Returns the derivative of a function at this value.
    fn slope(self, f: UnaryFunction) -> Self;

    /// Returns the derivatives of a function of two variables with respect to both variables.
    fn slopes(self, j: Join, b: Self) -> [Self; 2];

    /// Returns the value of a callback, which accepts only doubles.
    fn called(
        function: &CalledFunction<DriveState, f64>,
        inputs: [Self; 3],
    ) -> Result<Self, UndefinedValue>;
}

/// Returns the functions and derivatives that need only ring operations and roots.
fn arithmetic<T: Real>(a: T, f: UnaryFunction) -> Option<T> {
    Some(match f {
        UnaryFunction::Negate => -a,
        UnaryFunction::Whole(n) => whole_power(a, n),
        UnaryFunction::Root => a.sqrt(),
        _ => return None,
    })
}

fn arithmetic_slope<T: Real>(a: T, f: UnaryFunction) -> Option<T> {
    Some(match f {
        UnaryFunction::Negate => T::from(-1.0),
        UnaryFunction::Whole(0) => T::from(0.0),
        UnaryFunction::Whole(n) => T::from(f64::from(n)) * whole_power(a, n - 1),
        UnaryFunction::Root => T::from(0.5) / a.sqrt(),
        _ => return None,
    })
}

fn arithmetic_join<T: Real>(a: T, j: Join, b: T) -> Option<T> {
    Some(match j {
        Join::Add => a + b,
        Join::Subtract => a - b,
        Join::Multiply => a * b,
        Join::Divide => a / b,
        _ => return None,
    })
}

fn arithmetic_slopes<T: Real>(a: T, j: Join, b: T) -> Option<[T; 2]> {
    let one = T::from(1.0);
    Some(match j {
        Join::Add => [one, one],
        Join::Subtract => [one, -one],
        Join::Multiply => [b, a],
        Join::Divide => [one / b, -(a / (b * b))],
        _ => return None,
    })
}

/// Returns `aⁿ` as a product.
fn whole_power<T: Real>(a: T, n: i32) -> T {
    let one = T::from(1.0);
    let power = (1..n.unsigned_abs()).fold(a, |power, _| power * a);
    match n {
        0 => one,
        1.. => power,
        _ => one / power,
    }
}

impl LawNumber for f64 {
    fn number(self) -> Option<f64> {
        Some(self)
    }

    fn apply(self, f: UnaryFunction) -> Self {
        match f {
            UnaryFunction::Abs => self.abs(),
            UnaryFunction::Sin => self.sin(),
            UnaryFunction::Cos => self.cos(),
            UnaryFunction::Tan => self.tan(),
            UnaryFunction::Asin => self.asin(),
            UnaryFunction::Acos => self.acos(),
            UnaryFunction::Atan => self.atan(),
            UnaryFunction::Exp => self.exp(),
            UnaryFunction::Log => self.ln(),
            f => arithmetic(self, f).unwrap_or(f64::NAN),
        }
    }

    fn join(self, j: Join, b: Self) -> Self {
        match j {
            Join::Power => self.powf(b),
            Join::Angle if self == 0.0 && b == 0.0 => f64::NAN,
            Join::Angle => self.atan2(b),
            Join::Least => self.min(b),
            Join::Largest => self.max(b),
            j => arithmetic_join(self, j, b).unwrap_or(f64::NAN),
        }
    }
}

impl Smooth for f64 {
    fn slope(self, f: UnaryFunction) -> Self {
        match f {
            UnaryFunction::Abs if self == 0.0 => 0.0,
            UnaryFunction::Abs => self.signum(),
            UnaryFunction::Sin => self.cos(),
            UnaryFunction::Cos => -self.sin(),
            UnaryFunction::Tan => 1.0 + self.tan().powi(2),
            UnaryFunction::Asin => 1.0 / (1.0 - self * self).sqrt(),
            UnaryFunction::Acos => -1.0 / (1.0 - self * self).sqrt(),
            UnaryFunction::Atan => 1.0 / (1.0 + self * self),
            UnaryFunction::Exp => self.exp(),
            UnaryFunction::Log => 1.0 / self,
            f => arithmetic_slope(self, f).unwrap_or(f64::NAN),
        }
    }

    fn slopes(self, j: Join, b: Self) -> [Self; 2] {
        let chosen = |is_first: bool| if is_first { [1.0, 0.0] } else { [0.0, 1.0] };
        match j {
            Join::Power => [b * self.powf(b - 1.0), self.powf(b) * self.ln()],
            Join::Angle => {
                let square = self * self + b * b;
                [b / square, -self / square]
            }
            Join::Least => chosen(self < b),
            Join::Largest => chosen(self > b),
            j => arithmetic_slopes(self, j, b).unwrap_or([f64::NAN; 2]),
        }
    }

    fn called(
        function: &CalledFunction<DriveState, f64>,
        inputs: [Self; 3],
    ) -> Result<Self, UndefinedValue> {
        function.value(inputs)
    }
}

/// Arithmetic and roots are recorded. All other functions give NaN. Code generators reject laws
/// with these functions.
impl LawNumber for RecordedNumber {
    fn number(self) -> Option<f64> {
        None
    }

    fn apply(self, f: UnaryFunction) -> Self {
        arithmetic(self, f).unwrap_or_else(|| Self::from(f64::NAN))
    }

    fn join(self, j: Join, b: Self) -> Self {
        arithmetic_join(self, j, b).unwrap_or_else(|| Self::from(f64::NAN))
    }
}

impl Smooth for RecordedNumber {
    fn slope(self, f: UnaryFunction) -> Self {
        arithmetic_slope(self, f).unwrap_or_else(|| Self::from(f64::NAN))
    }

    fn slopes(self, j: Join, b: Self) -> [Self; 2] {
        arithmetic_slopes(self, j, b).unwrap_or_else(|| [Self::from(f64::NAN); 2])
    }

    fn called(_: &CalledFunction<DriveState, f64>, _: [Self; 3]) -> Result<Self, UndefinedValue> {
        Err(UndefinedValue::ValueAlone)
    }
}

/// A value with its derivatives with respect to the joint coordinate and to the rate of the
/// coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slope<T> {
    pub(crate) value: T,
    pub(crate) by: [T; 2],
}

impl<T: Smooth> From<f64> for Slope<T> {
    fn from(x: f64) -> Self {
        let by = [T::from(0.0); 2];
        Self {
            value: x.into(),
            by,
        }
    }
}

impl<T: Smooth> LawNumber for Slope<T> {
    fn number(self) -> Option<f64> {
        self.value.number()
    }

    fn apply(self, f: UnaryFunction) -> Self {
        let slope = self.value.slope(f);
        Self {
            value: self.value.apply(f),
            by: self.by.map(|d| slope * d),
        }
    }

    fn join(self, j: Join, b: Self) -> Self {
        let [by_a, by_b] = self.value.slopes(j, b.value);
        Self {
            value: self.value.join(j, b.value),
            by: [0, 1].map(|k| by_a * self.by[k] + by_b * b.by[k]),
        }
    }
}
