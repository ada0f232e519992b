//! Operations of laws.

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
    Apply(UnaryFunction),
    /// Replaces the last two numbers by a result.
    Join(Join),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryFunction {
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
