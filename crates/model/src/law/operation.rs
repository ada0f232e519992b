//! Operations of force laws.

/// One operation on a stack of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// Pushes a number.
    Number(f64),
    /// Pushes the joint coordinate (m or rad).
    Measure,
    /// Pushes the rate of the joint coordinate (m/s or rad/s).
    Rate,
    /// Pushes the time (s).
    Time,
    /// Replaces the last number by a function of it.
    Apply(UnaryFunction),
    /// Replaces the last two numbers by a result.
    Join(Join),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryFunction {
    /// The negative number, `−a`.
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

/// A function of two numbers.
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
    /// The smaller number.
    Least,
    /// The larger number.
    Largest,
}
