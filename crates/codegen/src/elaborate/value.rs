//! Values of expressions of the language.

use symbolic::Expr;

use crate::vector::{Components, Vector};

/// The value of an expression, with its shape.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Scalar(Expr),
    Vector(Vector),
    /// Components of a vector in the frame of a body.
    Local {
        slot: usize,
        local: Components,
    },
    /// A point parameter.
    Point {
        slot: usize,
        local: Components,
    },
    /// A direction parameter, or one of three axes.
    Direction {
        slot: usize,
        local: Components,
    },
    /// A parameter of three axes u, v, w.
    Axes {
        slot: usize,
        axes: [Components; 3],
    },
    /// An angle in space, given by its sine and cosine.
    Angle {
        sin: Expr,
        cos: Expr,
    },
    /// A line of the ground.
    Line {
        start: Components,
        along: Components,
    },
    /// A plane of the ground.
    Plane {
        start: Components,
        normal: Components,
        along: Components,
    },
    List(Vec<Value>),
}

impl Value {
    pub(crate) fn shape(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a scalar",
            Self::Vector(_) => "a vector",
            Self::Local { .. } => "components in a frame",
            Self::Point { .. } => "a point parameter",
            Self::Direction { .. } => "a direction parameter",
            Self::Axes { .. } => "a parameter of axes",
            Self::Angle { .. } => "an angle in space, which only a measure can be",
            Self::Line { .. } => "a line",
            Self::Plane { .. } => "a plane",
            Self::List(_) => "a list",
        }
    }

    /// Returns the description of how a vector is obtained from the value. The result is `None` for
    /// a scalar, a vector and a list.
    pub(super) fn as_vector(&self) -> Option<&'static str> {
        Some(match self {
            Self::Point { .. } => "the point of body i that a parameter `s` gives is `point(i, s)`",
            Self::Direction { .. } => "the vector that a parameter `n` gives is `direction(i, n)`",
            Self::Local { .. } => {
                "the vector with components `c` in the frame of body i is `vector(i, c)`"
            }
            Self::Axes { .. } => {
                "of axes `a`, `direction(i, a[0])` and `direction(i, a[1])` lie across, `direction(i, a[2])` along"
            }
            Self::Plane { .. } => "a plane has a point `start(plane)` and a vector `normal(plane)`",
            Self::Line { .. } => "a line has a point `start(line)` and a direction `along(line)`",
            Self::Scalar(_) | Self::Vector(_) | Self::Angle { .. } | Self::List(_) => return None,
        })
    }
}

impl Value {
    /// Returns all scalars of the value.
    pub(super) fn scalars(&self) -> Vec<Expr> {
        match self {
            Self::Scalar(e) => vec![*e],
            Self::Vector(v) => v.components().collect(),
            Self::Local { local, .. }
            | Self::Point { local, .. }
            | Self::Direction { local, .. } => local.clone(),
            Self::Axes { axes, .. } => axes.concat(),
            Self::Angle { sin, cos } => vec![*sin, *cos],
            Self::Line { start, along } => start.iter().chain(along).copied().collect(),
            Self::Plane {
                start,
                normal,
                along,
            } => [&start[..], normal, along].concat(),
            Self::List(values) => values.iter().flat_map(Self::scalars).collect(),
        }
    }
}
