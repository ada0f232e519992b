//! Laws of drives: a force or torque as a function of a measure, its rate and time, as a small
//! program that is evaluated without allocation, with its derivatives.
//!
//! Not here: how a law is written in a scene, and what its units are.

mod drive;
mod number;
#[cfg(test)]
mod tests;

pub(crate) use drive::build_law;
use number::{Number, Slope, Smooth};

/// One operation on a stack of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// Pushes a number.
    Number(f64),
    /// Pushes the measure (m or rad).
    Measure,
    /// Pushes its rate (m/s or rad/s).
    Rate,
    /// Pushes the time (s).
    Time,
    /// Replaces the last number by a function of it.
    Apply(Function),
    /// Replaces the last two numbers by a result.
    Join(Join),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// `−a`
    Negate,
    /// `aⁿ`, a product.
    Whole(i32),
    /// `√a`
    Root,
    /// `|a|`
    Abs,
    /// `sin a`
    Sin,
    /// `cos a`
    Cos,
    /// `tan a`
    Tan,
    /// `arcsin a`
    Asin,
    /// `arccos a`
    Acos,
    /// `arctan a`
    Atan,
    /// `eᵃ`
    Exp,
    /// `ln a`
    Log,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// `a + b`
    Add,
    /// `a − b`
    Subtract,
    /// `a·b`
    Multiply,
    /// `a/b`
    Divide,
    /// `aᵇ`
    Power,
    /// The angle of the point (b, a).
    Angle,
    /// The smaller one.
    Least,
    /// The larger one.
    Largest,
}

/// Largest number of values on the stack of a law: expressions are not nested as deeply.
const DEEPEST: usize = 64;

/// A force or torque as a function of a measure, its rate and time.
///
/// ```
/// use model::law::{Join, Law, Operation};
/// // The torque of a motor, 20 N·m at rest and 0.5 N·m·s/rad less for each rad/s.
/// let law = Law::new(&[
///     Operation::Number(20.0),
///     Operation::Number(0.5),
///     Operation::Rate,
///     Operation::Join(Join::Multiply),
///     Operation::Join(Join::Subtract),
/// ])?;
/// assert_eq!(law.value(0.0, 10.0, 0.0), Ok(15.0));
/// assert_eq!(law.slopes(0.0, 10.0, 0.0)?, [15.0, 0.0, -0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    operations: Box<[Operation]>,
    /// Whether the measure is counted from the start.
    pub(crate) since_start: bool,
}

/// The force of a drive by a law, and what it depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveForce {
    /// The measure (m or rad).
    pub measure: f64,
    /// Its rate (m/s or rad/s).
    pub rate: f64,
    /// Force (N) or torque (N·m) along the measure: on the second body, opposite on the first.
    pub force: Result<f64, Undefined>,
}

/// Error in the operations of a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// An operation finds too few numbers, or several are left at the end.
    #[error("the operations of a law leave {left} numbers, need 1")]
    Incomplete {
        /// How many are left.
        left: usize,
    },
    /// Too many numbers on the stack.
    #[error("a law is nested deeper than {DEEPEST}")]
    Deep,
    /// A law acts on one row with few bodies.
    #[error(
        "`{definition}` has {rows} rows and {slots} bodies; a law needs 1 row and at most {most} bodies"
    )]
    Rows {
        /// The definition of the drive.
        definition: &'static str,
        /// Number of its rows.
        rows: usize,
        /// Number of its bodies.
        slots: usize,
        /// Largest number of bodies.
        most: usize,
    },
    /// The arguments of the joint do not fit.
    #[error(transparent)]
    Argument(#[from] joints::ArgumentError),
}

/// The part of a law that has no finite value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Undefined {
    /// A function of one number.
    Apply(Function, f64),
    /// A function of two numbers.
    Join(Join, f64, f64),
    /// The measure has no direction, or a number is not finite.
    Input,
}

impl std::error::Error for Undefined {}

impl std::fmt::Display for Undefined {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Join(Join::Divide, _, 0.0) => f.write_str("division by zero"),
            Self::Apply(Function::Log, a) => write!(f, "log({a})"),
            Self::Apply(Function::Root, a) => write!(f, "sqrt({a})"),
            Self::Apply(Function::Asin, a) => write!(f, "asin({a})"),
            Self::Apply(Function::Acos, a) => write!(f, "acos({a})"),
            Self::Apply(Function::Exp, a) => write!(f, "exp({a})"),
            Self::Apply(Function::Whole(n), a) => write!(f, "{a}^{n}"),
            Self::Join(Join::Power, a, b) => write!(f, "{a}^{b}"),
            Self::Join(Join::Angle, a, b) => write!(f, "atan2({a}, {b})"),
            Self::Apply(..) | Self::Join(..) => f.write_str("a result that is too large"),
            Self::Input => f.write_str("a measure without a value"),
        }
    }
}

impl Law {
    /// A law from its operations in the order of their work: operands come before their operation.
    ///
    /// # Errors
    /// If they do not leave one number, or need more than 64 at a time.
    pub fn new(operations: &[Operation]) -> Result<Self, LawError> {
        let mut left: usize = 0;
        for operation in operations {
            let takes = match operation {
                Operation::Apply(_) => 1,
                Operation::Join(_) => 2,
                _ => 0,
            };
            let rest = left.checked_sub(takes);
            left = rest.ok_or(LawError::Incomplete { left })? + 1;
            if left > DEEPEST {
                return Err(LawError::Deep);
            }
        }
        match left {
            1 => Ok(Self {
                operations: operations.into(),
                since_start: false,
            }),
            left => Err(LawError::Incomplete { left }),
        }
    }

    /// The same law of the change of the measure since the assembled start.
    #[must_use]
    pub fn since_start(self) -> Self {
        Self {
            since_start: true,
            ..self
        }
    }

    /// The force (N) or torque (N·m); does not allocate.
    ///
    /// # Errors
    /// If it has no finite value.
    pub fn value(&self, measure: f64, rate: f64, t: f64) -> Result<f64, Undefined> {
        self.evaluate([measure, rate, t])
    }

    /// The force or torque with its derivatives by the measure and by its rate; does not allocate.
    /// A derivative that has no finite value is 0: it only guides implicit methods.
    ///
    /// # Errors
    /// If the force has no finite value.
    pub fn slopes(&self, measure: f64, rate: f64, t: f64) -> Result<[f64; 3], Undefined> {
        let Slope { value, by } = self.slope([measure, rate, t])?;
        Ok([value, by[0], by[1]])
    }

    fn slope<T: Smooth>(&self, [measure, rate, t]: [T; 3]) -> Result<Slope<T>, Undefined> {
        let [zero, one] = [T::from(0.0), T::from(1.0)];
        let with = |value, by| Slope { value, by };
        let Slope { value, by } = self.evaluate([
            with(measure, [one, zero]),
            with(rate, [zero, one]),
            with(t, [zero, zero]),
        ])?;
        let finite = |x: T| match x.number() {
            Some(x) if !x.is_finite() => zero,
            _ => x,
        };
        Ok(with(value, by.map(finite)))
    }

    /// The value of the program for measure, rate and time. Every result on the way has to be
    /// finite.
    fn evaluate<T: Number>(&self, inputs: [T; 3]) -> Result<T, Undefined> {
        let mut stack = [inputs[0]; DEEPEST];
        let mut top = 0;
        let is_finite = |x: T| x.number().is_none_or(f64::is_finite);
        if !inputs.into_iter().all(is_finite) {
            return Err(Undefined::Input);
        }
        for &operation in &self.operations {
            let taken = match operation {
                Operation::Apply(_) => 1,
                Operation::Join(_) => 2,
                _ => 0,
            };
            // The number of values was checked when the law was made.
            top -= taken;
            let (a, b) = (stack[top], stack[(top + 1).min(DEEPEST - 1)]);
            let result = match operation {
                Operation::Number(x) => T::from(x),
                Operation::Measure => inputs[0],
                Operation::Rate => inputs[1],
                Operation::Time => inputs[2],
                Operation::Apply(f) => a.apply(f),
                Operation::Join(j) => a.join(j, b),
            };
            if !is_finite(result) {
                let number = |x: T| x.number().unwrap_or_default();
                return Err(match operation {
                    Operation::Apply(f) => Undefined::Apply(f, number(a)),
                    Operation::Join(j) => Undefined::Join(j, number(a), number(b)),
                    _ => Undefined::Input,
                });
            }
            stack[top] = result;
            top += 1;
        }
        Ok(stack[0])
    }
}
