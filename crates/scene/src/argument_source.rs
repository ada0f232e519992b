//! Sources of the points and directions of an element.

use std::ops::Range;

use joints::Argument;
use joints::spec::{Shape, Spec};

use crate::bearings::Bearings;
use crate::between::JointMarkers;
use crate::bodies::Bodies;
use crate::space::SceneSpace;

/// Source of the points and directions of an element.
pub(crate) enum ArgumentSource<'a> {
    /// The table of the element contains all points and directions.
    Text,
    /// Points and directions are taken from two markers.
    Markers(JointMarkers<'a>),
    /// Points and axes are taken from joints; only the pitch point and the line of action are
    /// in the table.
    Bearings(Bearings),
}

impl ArgumentSource<'_> {
    /// Returns whether the argument of a parameter is taken from markers or joints.
    pub(crate) fn gives(&self, spec: &Spec, parameter: usize) -> bool {
        match (self, spec.parameters[parameter].shape) {
            (Self::Text, _) => false,
            (Self::Markers(_), shape) => matches!(
                shape,
                Shape::Point { .. } | Shape::Direction { .. } | Shape::Axes { .. }
            ),
            // The last point is the pitch point, which the table contains.
            (Self::Bearings(_), Shape::Point { .. }) => {
                let later = &spec.parameters[parameter + 1..];
                later.iter().any(|p| matches!(p.shape, Shape::Point { .. }))
            }
            (Self::Bearings(_), shape) => matches!(shape, Shape::Axes { .. }),
        }
    }

    /// Returns the argument that markers or joints define, if it could be read, and the position of
    /// the markers or joints in the text. Returns `None` if the table contains the argument.
    pub(crate) fn argument<S: SceneSpace>(
        &self,
        spec: &Spec,
        parameter: usize,
        bodies: &Bodies<S>,
    ) -> Option<(Option<Argument>, Range<usize>)> {
        if !self.gives(spec, parameter) {
            return None;
        }
        match self {
            Self::Text => None,
            Self::Markers(own) => {
                let argument = own.argument(&spec.parameters[parameter], bodies);
                Some((argument, own.span.clone()))
            }
            Self::Bearings(own) => Some((own.argument(spec, parameter), own.span.clone())),
        }
    }
}
