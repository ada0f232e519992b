//! Operations of force laws.

/// One operation on a stack of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// Pushes a constant.
    Number(f64),
    /// Pushes the joint coordinate (m or rad).
    Measure,
    /// Pushes the rate of the joint coordinate (m/s or rad/s).
    Rate,
    /// Pushes the time (s).
    Time,
    /// Replaces the last value by a function of this value.
    Apply(UnaryFunction),
    /// Replaces the last two values by a function of both.
    Join(Join),
    /// Replaces the last values by a state of the law, which these values drive.
    Keep(LawState),
}

/// A state of a law, with its differential equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawState {
    /// The integral of the value a since the start: `ẋ = a`, zero at the start.
    Integral,
    /// The value a through a first-order lag with the time constant b (s): `ẋ = (a − x)/b`. At the
    /// start, x is a.
    Lag,
}

impl Operation {
    /// Returns the number of values that the operation replaces.
    pub(crate) fn takes(self) -> usize {
        match self {
            Self::Number(_) | Self::Measure | Self::Rate | Self::Time => 0,
            Self::Apply(_) | Self::Keep(LawState::Integral) => 1,
            Self::Join(_) | Self::Keep(LawState::Lag) => 2,
        }
    }
}

/// A function of one variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryFunction {
    /// The negative `−a`.
    Negate,
    /// An integer power `aⁿ`, computed as a product.
    Whole(i32),
    /// The square root `√a`.
    Root,
    /// The absolute value `|a|`.
    Abs,
    /// The sine `sin a`.
    Sin,
    /// The cosine `cos a`.
    Cos,
    /// The tangent `tan a`.
    Tan,
    /// The inverse sine `arcsin a`.
    Asin,
    /// The inverse cosine `arccos a`.
    Acos,
    /// The inverse tangent `arctan a`.
    Atan,
    /// The exponential `eᵃ`.
    Exp,
    /// The natural logarithm `ln a`.
    Log,
}

/// A function of two variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// The sum `a + b`.
    Add,
    /// The difference `a − b`.
    Subtract,
    /// The product `a·b`.
    Multiply,
    /// The quotient `a/b`.
    Divide,
    /// The power `aᵇ`.
    Power,
    /// The angle of the point (b, a).
    Angle,
    /// The smaller of two values.
    Least,
    /// The larger of two values.
    Largest,
}
