//! Laws of drives: a force or torque as a function of a measure, its rate and time. A law is a
//! small program that is evaluated without allocation, with its derivatives, or a function of the
//! caller, of which values alone are known.
//!
//! Not here: how a law is written in a scene, and what its units are.

mod drive;
mod number;
mod program;
#[cfg(test)]
mod tests;

pub(crate) use drive::{full, law_drive};

use crate::called::{CallError, Called, DriveState};
use number::{Slope, Smooth};
use program::Program;

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
/// A law of [operations](Law::new) has derivatives; of a [called](Law::called) function values
/// alone are known, so that nothing that needs derivatives works with it: implicit methods,
/// linearisation, a search for rest. Each of them refuses it by name.
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
    form: Form,
    /// Whether the measure is counted from the start.
    pub(crate) since_start: bool,
}

/// How a law is evaluated.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    Program(Program),
    Called(Called<DriveState, f64>),
}

/// The force of a drive by a law, and what it depends on.
#[derive(Clone, Debug, PartialEq)]
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

/// Why a law has no finite value, or no derivatives.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Undefined {
    /// A function of one number.
    Apply(Function, f64),
    /// A function of two numbers.
    Join(Join, f64, f64),
    /// The measure has no direction, or a number is not finite.
    Input,
    /// A called function returned this, which is not a finite number.
    Returned(String),
    /// A called function failed, with this message.
    Failed(String),
    /// More is asked of a called function than its value.
    ValueAlone,
}

impl Undefined {
    /// Whether a called function is the cause: another state does not mend it.
    #[must_use]
    pub fn is_of_function(&self) -> bool {
        matches!(self, Self::Returned(_) | Self::Failed(_))
    }
}

impl std::error::Error for Undefined {}

impl std::fmt::Display for Undefined {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
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
            Self::Returned(x) => write!(f, "its function returned {x}"),
            Self::Failed(why) => write!(f, "its function failed: {why}"),
            Self::ValueAlone => f.write_str("a function that is called has values alone"),
        }
    }
}

impl Law {
    /// A law from its operations in the order of their work: operands come before their operation.
    ///
    /// # Errors
    /// If they do not leave one number, or need more than 64 at a time.
    pub fn new(operations: &[Operation]) -> Result<Self, LawError> {
        Ok(Self {
            form: Form::Program(Program::new(operations)?),
            since_start: false,
        })
    }

    /// A law that calls a function, which returns the force (N) or torque (N·m), or an error.
    ///
    /// The function is called at stages of an integrator, at rows of output, and again where a step
    /// is made anew: not in the order of time, and several times for one instant. It has to return
    /// the same for the same state. What is not finite, and an error, ends a run by name.
    ///
    /// ```
    /// use model::Law;
    /// // A motor that is switched off at 10 rad/s.
    /// let law = Law::called(|at| Ok(if at.rate < 10.0 { 20.0 - 0.5 * at.rate } else { 0.0 }));
    /// assert_eq!(law.value(0.0, 4.0, 0.0), Ok(18.0));
    /// assert!(law.is_called() && law.slopes(0.0, 4.0, 0.0).is_err());
    /// ```
    #[must_use]
    pub fn called(
        function: impl Fn(&DriveState) -> Result<f64, CallError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            form: Form::Called(Called::new(function)),
            since_start: false,
        }
    }

    /// Whether it calls a function.
    #[must_use]
    pub fn is_called(&self) -> bool {
        matches!(self.form, Form::Called(_))
    }

    /// The same law of the change of the measure since the assembled start.
    #[must_use]
    pub fn since_start(self) -> Self {
        Self {
            since_start: true,
            ..self
        }
    }

    /// The force (N) or torque (N·m); does not allocate, unless a called function does.
    ///
    /// # Errors
    /// If it has no finite value.
    pub fn value(&self, measure: f64, rate: f64, t: f64) -> Result<f64, Undefined> {
        self.force([measure, rate, t])
    }

    /// The force or torque with its derivatives by the measure and by its rate; does not allocate.
    /// A derivative that has no finite value is 0: it only guides implicit methods.
    ///
    /// # Errors
    /// If the force has no finite value, and [`Undefined::ValueAlone`]: it calls a function.
    pub fn slopes(&self, measure: f64, rate: f64, t: f64) -> Result<[f64; 3], Undefined> {
        let Slope { value, by } = self.slope([measure, rate, t])?;
        Ok([value, by[0], by[1]])
    }

    /// The value for measure, rate and time.
    fn force<T: Smooth>(&self, inputs: [T; 3]) -> Result<T, Undefined> {
        match &self.form {
            Form::Program(program) => program.evaluate(inputs),
            Form::Called(function) => T::called(function, inputs),
        }
    }

    fn slope<T: Smooth>(&self, inputs: [T; 3]) -> Result<Slope<T>, Undefined> {
        match &self.form {
            Form::Program(program) => program.slope(inputs),
            Form::Called(_) => Err(Undefined::ValueAlone),
        }
    }
}
