//! A number type that records its operations. A kernel runs once with this type and writes its
//! operations and the values of its parameters to an operation list (`tape`). Programs for one
//! mechanism are generated from this list. This module neither differentiates nor simplifies the
//! operations.
//!
//! The operation list is thread-local, because kernels can only copy numbers.

use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::ring::{Real, Scalar};

/// Index of an operation in the operation list of the current recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordedNumber(usize);

/// One operation of an operation list. Operands come before the operations that use them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// A constant.
    Number(f64),
    /// The input with this index.
    Input(usize),
    /// `a + b`
    Add(RecordedNumber, RecordedNumber),
    /// `a − b`
    Sub(RecordedNumber, RecordedNumber),
    /// `a · b`
    Mul(RecordedNumber, RecordedNumber),
    /// `a / b`
    Div(RecordedNumber, RecordedNumber),
    /// `−a`
    Neg(RecordedNumber),
    /// `√a`
    Sqrt(RecordedNumber),
    /// `1/a`, or 0 if a is 0.
    RecipOrZero(RecordedNumber),
    /// [`rotation::angle_over_sine`] of a given order.
    AngleOverSine(RecordedNumber, u8),
}

thread_local! {
    static TAPE: RefCell<Vec<Operation>> = const { RefCell::new(Vec::new()) };
}

/// Runs `f` and returns the operations on all [`RecordedNumber`]s in `f`, in the order of
/// execution. Numbers of one recording are not valid in another recording.
///
/// ```
/// use pfaff_joints::recorded::{Operation, RecordedNumber, record};
/// let (tape, y) = record(|| {
///     let x = RecordedNumber::input(0);
///     x * x - RecordedNumber::from(2.0)
/// });
/// assert_eq!(tape.len(), 4);
/// assert_eq!(tape[y.place()], Operation::Sub(tape_place(1), tape_place(2)));
/// # fn tape_place(k: usize) -> RecordedNumber { record(|| (0..=k).map(RecordedNumber::input).last().unwrap()).1 }
/// ```
pub fn record<R>(f: impl FnOnce() -> R) -> (Vec<Operation>, R) {
    let outer = TAPE.take();
    let result = f();
    (TAPE.replace(outer), result)
}

impl RecordedNumber {
    /// Returns the input with index `k`.
    #[must_use]
    pub fn input(k: usize) -> Self {
        Self::push(Operation::Input(k))
    }

    /// Returns the index in the operation list.
    #[must_use]
    pub fn place(self) -> usize {
        self.0
    }

    fn push(operation: Operation) -> Self {
        TAPE.with_borrow_mut(|tape| {
            tape.push(operation);
            Self(tape.len() - 1)
        })
    }
}

impl From<f64> for RecordedNumber {
    fn from(x: f64) -> Self {
        Self::push(Operation::Number(x))
    }
}

/// The values stored by a constraint are inputs, because the rows are recorded once for all
/// constraints of a kind.
impl Scalar for RecordedNumber {
    fn stored(_: f64, place: usize) -> Self {
        Self::input(place)
    }
}

impl Add for RecordedNumber {
    type Output = Self;

    fn add(self, y: Self) -> Self {
        Self::push(Operation::Add(self, y))
    }
}

impl Sub for RecordedNumber {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        Self::push(Operation::Sub(self, y))
    }
}

impl Mul for RecordedNumber {
    type Output = Self;

    fn mul(self, y: Self) -> Self {
        Self::push(Operation::Mul(self, y))
    }
}

impl Div for RecordedNumber {
    type Output = Self;

    fn div(self, y: Self) -> Self {
        Self::push(Operation::Div(self, y))
    }
}

impl Neg for RecordedNumber {
    type Output = Self;

    fn neg(self) -> Self {
        Self::push(Operation::Neg(self))
    }
}

impl Real for RecordedNumber {
    fn sqrt(self) -> Self {
        Self::push(Operation::Sqrt(self))
    }

    fn recip_or_zero(self) -> Self {
        Self::push(Operation::RecipOrZero(self))
    }

    fn angle_over_sine(self, order: u8) -> Self {
        Self::push(Operation::AngleOverSine(self, order))
    }
}
