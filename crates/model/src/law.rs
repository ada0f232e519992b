//! Laws of drives: a force or torque as a function of a measure, its rate and time. A law is a
//! small program that is evaluated without allocation, with its derivatives, or a function of the
//! caller, of which values alone are known.
//!
//! Not here: how a law is written in a scene, and what its units are.

mod drive;
mod error;
mod number;
mod operation;
mod program;
#[cfg(test)]
mod tests;
mod undefined;

pub(crate) use drive::{full, law_drive};
pub use error::LawError;
pub use operation::{Join, Operation, UnaryFunction};
pub use undefined::UndefinedValue;

use crate::called::{CallError, CalledFunction, DriveState};
use number::{Slope, Smooth};
use program::Program;

/// A force or torque as a function of a measure, its rate and time.
///
/// A law of [operations](Law::new) has derivatives; of a [called](Law::called) function values
/// alone are known, so that nothing that needs derivatives works with it: implicit methods,
/// linearisation, a search for rest. Each of them refuses it by name.
///
/// ```
/// use pfaff_model::law::{Join, Law, Operation};
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
    Called(CalledFunction<DriveState, f64>),
}

/// The force of a drive by a law, and what it depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveForce {
    /// The measure (m or rad).
    pub measure: f64,
    /// Its rate (m/s or rad/s).
    pub rate: f64,
    /// Force (N) or torque (N·m) along the measure: on the second body, opposite on the first.
    pub force: Result<f64, UndefinedValue>,
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
    /// use pfaff_model::Law;
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
            form: Form::Called(CalledFunction::new(function)),
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
    pub fn value(&self, measure: f64, rate: f64, t: f64) -> Result<f64, UndefinedValue> {
        self.force([measure, rate, t])
    }

    /// The force or torque with its derivatives by the measure and by its rate; does not allocate.
    /// A derivative that has no finite value is 0: it only guides implicit methods.
    ///
    /// # Errors
    /// If the force has no finite value, and [`UndefinedValue::ValueAlone`]: it calls a function.
    pub fn slopes(&self, measure: f64, rate: f64, t: f64) -> Result<[f64; 3], UndefinedValue> {
        let Slope { value, by } = self.slope([measure, rate, t])?;
        Ok([value, by[0], by[1]])
    }

    /// The value for measure, rate and time.
    fn force<T: Smooth>(&self, inputs: [T; 3]) -> Result<T, UndefinedValue> {
        match &self.form {
            Form::Program(program) => program.evaluate(inputs),
            Form::Called(function) => T::called(function, inputs),
        }
    }

    fn slope<T: Smooth>(&self, inputs: [T; 3]) -> Result<Slope<T>, UndefinedValue> {
        match &self.form {
            Form::Program(program) => program.slope(inputs),
            Form::Called(_) => Err(UndefinedValue::ValueAlone),
        }
    }
}
