//! A law as operations on a stack. The values are doubles, dual numbers, or numbers that record
//! their operations.

use super::error::{DEEPEST, LawError};
use super::number::{LawNumber, Slope, Smooth};
use super::{Join, LawState, Operation, UndefinedValue};

/// A sequence of operations with one result.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Program(Box<[Operation]>);

impl Program {
    /// Checks that the operations have one result.
    pub(crate) fn new(operations: &[Operation]) -> Result<Self, LawError> {
        let mut left: usize = 0;
        for operation in operations {
            let rest = left.checked_sub(operation.takes());
            left = rest.ok_or(LawError::Incomplete { left })? + 1;
            if left > DEEPEST {
                return Err(LawError::Deep);
            }
        }
        match left {
            1 => Ok(Self(operations.into())),
            left => Err(LawError::Incomplete { left }),
        }
    }

    /// The program that returns the time.
    pub(crate) fn time() -> Self {
        Self([Operation::Time].into())
    }

    /// The program that returns one.
    pub(crate) fn one() -> Self {
        Self([Operation::Number(1.0)].into())
    }

    pub(crate) fn operations(&self) -> &[Operation] {
        &self.0
    }

    /// Returns the number of states.
    pub(crate) fn n_states(&self) -> usize {
        let states = self.0.iter().filter(|o| matches!(o, Operation::Keep(_)));
        states.count()
    }

    /// Returns the value with its derivatives. A derivative that is not finite is replaced by 0.
    pub(super) fn slope<T: Smooth>(
        &self,
        [measure, rate, t]: [T; 3],
        states: &[T],
    ) -> Result<Slope<T>, UndefinedValue> {
        let [zero, one] = [T::from(0.0), T::from(1.0)];
        let with = |value, by| Slope { value, by };
        let inputs = [
            with(measure, [one, zero]),
            with(rate, [zero, one]),
            with(t, [zero, zero]),
        ];
        let states = states.iter().map(|&x| with(x, [zero, zero]));
        let Slope { value, by } = self.evaluate(inputs, kept(states))?;
        let finite = |x: T| match x.number() {
            Some(x) if !x.is_finite() => zero,
            _ => x,
        };
        Ok(with(value, by.map(finite)))
    }

    /// Returns the value of the program for a joint coordinate, its rate and the time. `keep`
    /// returns the value of the next state, and its argument are the values that drive the state.
    /// Every intermediate result must be finite.
    pub(crate) fn evaluate<T: LawNumber>(
        &self,
        inputs: [T; 3],
        mut keep: impl FnMut(LawState, [T; 2]) -> T,
    ) -> Result<T, UndefinedValue> {
        let mut stack = [inputs[0]; DEEPEST];
        let mut top = 0;
        let is_finite = |x: T| x.number().is_none_or(f64::is_finite);
        if !inputs.into_iter().all(is_finite) {
            return Err(UndefinedValue::Input);
        }
        for &operation in &self.0 {
            // The stack is large enough: its depth was checked when the law was created.
            top -= operation.takes();
            let (a, b) = (stack[top], stack[(top + 1).min(DEEPEST - 1)]);
            let result = match operation {
                Operation::Number(x) => T::from(x),
                Operation::Measure => inputs[0],
                Operation::Rate => inputs[1],
                Operation::Time => inputs[2],
                Operation::Apply(f) => a.apply(f),
                Operation::Join(j) => a.join(j, b),
                Operation::Keep(state) => keep(state, [a, b]),
            };
            if !is_finite(result) {
                let number = |x: T| x.number().unwrap_or_default();
                return Err(match operation {
                    Operation::Apply(f) => UndefinedValue::Apply(f, number(a)),
                    Operation::Join(j) => UndefinedValue::Join(j, number(a), number(b)),
                    Operation::Keep(LawState::Lag) => {
                        UndefinedValue::Join(Join::Divide, number(a), number(b))
                    }
                    _ => UndefinedValue::Input,
                });
            }
            stack[top] = result;
            top += 1;
        }
        Ok(stack[0])
    }
}

impl LawState {
    /// Returns the rate of the state x for the values that drive it.
    pub(super) fn rate<T: LawNumber>(self, [a, b]: [T; 2], x: T) -> T {
        match self {
            Self::Integral => a,
            Self::Lag => a.join(Join::Subtract, x).join(Join::Divide, b),
        }
    }

    /// Returns the state at the start.
    pub(super) fn start<T: LawNumber>(self, [a, _]: [T; 2]) -> T {
        match self {
            Self::Integral => T::from(0.0),
            Self::Lag => a,
        }
    }
}

/// Returns the states one after the other. A state without a finite rate has no value.
pub(super) fn kept<T: LawNumber>(
    states: impl IntoIterator<Item = T>,
) -> impl FnMut(LawState, [T; 2]) -> T {
    let mut states = states.into_iter();
    move |state, inputs| {
        let x = states.next().unwrap_or(T::from(f64::NAN));
        match state.rate(inputs, x).number() {
            Some(rate) if !rate.is_finite() => T::from(f64::NAN),
            _ => x,
        }
    }
}
