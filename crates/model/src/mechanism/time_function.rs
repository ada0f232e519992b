//! Functions of time in the form required by the kernels.

use joints::Ring;
use linalg::Dd;

use crate::function::Function;

/// A function of time as passed to an element.
#[derive(Clone, Debug)]
pub struct TimeFunction {
    pub(super) function: Function,
    /// The value f(0) for drives, whose motion is f(t) − f(0); otherwise zero.
    pub(super) offset: f64,
    pub(super) form: FunctionForm,
}

/// The form in which a function of time is passed to a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionForm {
    /// The function itself.
    Value,
    /// The cosine of the function; the next argument is the sine.
    Cosine,
    /// The sine of the function.
    Sine,
}

impl TimeFunction {
    /// Returns the function, and the value that is subtracted from the function. This value is f(0)
    /// for drives.
    #[must_use]
    pub fn parts(&self) -> (&Function, f64) {
        (&self.function, self.offset)
    }

    /// Returns the form in which the difference is passed to the kernel. Drives of angles in space
    /// receive the cosine and the sine of the difference.
    #[must_use]
    pub fn form(&self) -> FunctionForm {
        self.form
    }

    /// Returns the parameters of the function ([`crate::function::Parts::numbers`]), followed by
    /// the value that is subtracted from the function.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        let mut numbers = self.function.parts().numbers();
        numbers.push(self.offset);
        numbers
    }

    /// Returns the time function with these parameters, in the order of [`TimeFunction::numbers`].
    /// Returns `None` if the number of parameters is wrong, or if they are invalid for the
    /// function.
    #[must_use]
    pub fn with_numbers(&self, numbers: &[f64]) -> Option<Self> {
        let (&offset, numbers) = numbers.split_last()?;
        Some(Self {
            function: self.function.with_numbers(numbers)?,
            offset,
            form: self.form,
        })
    }

    /// Returns the value at t, in this form, with two derivatives.
    #[must_use]
    pub fn jet(&self, t: f64) -> [f64; 3] {
        let [f, d, dd] = self.function.jet(t);
        self.formed([f - self.offset, d, dd], f64::sin_cos)
    }

    /// Returns the value in double-double, computed from the value in `f64`.
    pub(crate) fn extended_jet(&self, t: f64) -> [Dd; 3] {
        let [f, d, dd] = self.function.jet(t);
        let jet = [f - self.offset, d, dd].map(Dd::from);
        self.formed(jet, Dd::sin_cos)
    }

    /// Converts a value with two derivatives to this form.
    fn formed<T: Ring>(&self, [f, d, dd]: [T; 3], sin_cos: impl Fn(T) -> (T, T)) -> [T; 3] {
        if self.form == FunctionForm::Value {
            return [f, d, dd];
        }
        let (sin, cos) = sin_cos(f);
        match self.form {
            FunctionForm::Cosine => [cos, -(sin * d), -(cos * d * d) - sin * dd],
            _ => [sin, cos * d, cos * dd - sin * d * d],
        }
    }
}
