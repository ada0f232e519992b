//! Values of expressions of the language.

use symbolic::Expr;

use crate::vector::Vector;

/// The value of an expression, with its shape.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Scalar(Expr),
    Vector(Vector),
    /// Two components in the frame of a body.
    Pair {
        slot: usize,
        pair: [Expr; 2],
    },
    /// A point parameter.
    Point {
        slot: usize,
        pair: [Expr; 2],
    },
    /// A direction parameter.
    Direction {
        slot: usize,
        pair: [Expr; 2],
    },
    /// A line of the ground.
    Line {
        start: [Expr; 2],
        along: [Expr; 2],
    },
    List(Vec<Value>),
}

impl Value {
    pub(crate) fn shape(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a scalar",
            Self::Vector(_) => "a vector",
            Self::Pair { .. } => "a pair of components in a frame",
            Self::Point { .. } => "a point parameter",
            Self::Direction { .. } => "a direction parameter",
            Self::Line { .. } => "a line",
            Self::List(_) => "a list",
        }
    }
}

impl Value {
    /// All scalars in it.
    pub(super) fn scalars(&self) -> Vec<Expr> {
        match self {
            Self::Scalar(e) => vec![*e],
            Self::Vector(v) => v.components().collect(),
            Self::Pair { pair, .. } | Self::Point { pair, .. } | Self::Direction { pair, .. } => {
                pair.to_vec()
            }
            Self::Line { start, along } => start.iter().chain(along).copied().collect(),
            Self::List(values) => values.iter().flat_map(Self::scalars).collect(),
        }
    }
}
