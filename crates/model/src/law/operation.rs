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
