//! Force laws of drives: a force or torque as a function of a joint coordinate, its rate and time.
//! A law is either a list of operations or a callback. The list is evaluated with its derivatives
//! and without allocation; a callback returns only values.
//!
//! The syntax and the units of laws in scenes are defined elsewhere.

mod drive;
mod error;
pub(crate) mod number;
mod operation;
pub(crate) mod program;
#[cfg(test)]
mod tests;
mod undefined;

pub(crate) use drive::{MEASURE_0, full, law_drive};
pub use error::LawError;
pub use operation::{Join, LawState, Operation, UnaryFunction};
pub use undefined::UndefinedValue;

use crate::called::{CallError, CalledFunction, DriveState};
use number::{Slope, Smooth};
use program::{Program, kept};

/// A force or torque as a function of a joint coordinate, its rate and time.
///
/// A law made of [operations](Law::new) has derivatives. A [called](Law::called) function returns
/// only values. Methods that need derivatives (implicit methods, linearisation, search for an
/// equilibrium) therefore reject a called law with an error that contains the name of the drive.
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
    /// Whether the law uses the change of the joint coordinate since the start.
    pub(crate) since_start: bool,
}

/// Form in which a law is evaluated.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    Program(Program),
    Called(CalledFunction<DriveState, f64>),
}

/// The force of a drive with a force law, and the arguments of the law.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveForce {
    /// The joint coordinate (m or rad).
    pub measure: f64,
    /// Rate of the joint coordinate (m/s or rad/s).
    pub rate: f64,
    /// Force (N) or torque (N·m) along the joint coordinate. The load acts on the second body, and
    /// the opposite load acts on the first body.
    pub force: Result<f64, UndefinedValue>,
}

impl Law {
    /// Creates a law from its operations in the order of evaluation. The operands of an operation
    /// precede the operation.
    ///
    /// # Errors
    /// Returns an error if the operations do not produce exactly one value, or need more than 64
    /// values at a time.
    pub fn new(operations: &[Operation]) -> Result<Self, LawError> {
        Ok(Self {
            form: Form::Program(Program::new(operations)?),
            since_start: false,
        })
    }

    /// Creates a law from a callback that returns the force (N) or torque (N·m), or an error.
    ///
    /// The callback is called at stages of an integrator, at output rows, and again if a step is
    /// repeated. The calls are not in chronological order, and there may be several calls for one
    /// instant. For the same arguments, the callback must return the same value. If the callback
    /// returns an error or a value that is not finite, the simulation ends with an error that
    /// contains the name of the force.
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

    /// Returns the law of a drive that a controller commands. The value of the controller takes the
    /// place of the time, which is the only argument of this law.
    pub(crate) fn commanded() -> Self {
        Self {
            form: Form::Program(Program::time()),
            since_start: false,
        }
    }

    /// Returns the law whose force or torque is one.
    pub(crate) fn unit() -> Self {
        Self {
            form: Form::Program(Program::one()),
            since_start: false,
        }
    }

    /// Returns whether the law calls a callback.
    #[must_use]
    pub fn is_called(&self) -> bool {
        matches!(self.form, Form::Called(_))
    }

    /// Returns the same law with another argument: the change of the joint coordinate since the
    /// assembled start.
    #[must_use]
    pub fn since_start(self) -> Self {
        Self {
            since_start: true,
            ..self
        }
    }

    /// Returns the number of states of the law.
    #[must_use]
    pub fn n_states(&self) -> usize {
        match &self.form {
            Form::Program(program) => program.n_states(),
            Form::Called(_) => 0,
        }
    }

    /// Returns the force (N) or torque (N·m). States of the law have their values at the start. The
    /// function does not allocate memory, unless a callback does.
    ///
    /// # Errors
    /// Returns an error if the force has no finite value.
    pub fn value(&self, measure: f64, rate: f64, t: f64) -> Result<f64, UndefinedValue> {
        self.follow([measure, rate, t], LawState::start)
    }

    /// Returns the force or torque with its derivatives with respect to the joint coordinate and
    /// its rate. The function does not allocate memory. If a derivative is not finite, the function
    /// returns 0 for it, because derivatives only speed up the iterations of implicit methods.
    ///
    /// # Errors
    /// Returns an error if the force is not finite, and [`UndefinedValue::ValueAlone`] if the law
    /// calls a callback.
    pub fn slopes(&self, measure: f64, rate: f64, t: f64) -> Result<[f64; 3], UndefinedValue> {
        let Slope { value, by } = self.slope([measure, rate, t], &[])?;
        Ok([value, by[0], by[1]])
    }

    /// Returns the value for a joint coordinate, its rate and the time.
    fn force<T: Smooth>(
        &self,
        inputs: [T; 3],
        states: impl Iterator<Item = T>,
    ) -> Result<T, UndefinedValue> {
        self.follow(inputs, kept(states))
    }

    /// Returns the value for a joint coordinate, its rate and the time. `keep` returns the value of
    /// the next state.
    fn follow<T: Smooth>(
        &self,
        inputs: [T; 3],
        keep: impl FnMut(LawState, [T; 2]) -> T,
    ) -> Result<T, UndefinedValue> {
        match &self.form {
            Form::Program(program) => program.evaluate(inputs, keep),
            Form::Called(function) => T::called(function, inputs),
        }
    }

    fn slope<T: Smooth>(&self, inputs: [T; 3], states: &[T]) -> Result<Slope<T>, UndefinedValue> {
        match &self.form {
            Form::Program(program) => program.slope(inputs, states),
            Form::Called(_) => Err(UndefinedValue::ValueAlone),
        }
    }
}
