//! Iteration over definitions with their types: registries, test harnesses and benchmarks visit
//! every definition without naming one.

use crate::constraint::Constraint;
use crate::force::Force;
use crate::space::{Plane, Space};

/// Receives definitions of one space; [`crate::plane_constraints`], [`crate::plane_forces`],
/// [`crate::space3::constraints`] and [`crate::space3::forces`] call it with those of the library.
pub trait Visitor<S: Space = Plane> {
    /// A constraint definition. Its drives come separately, through [`Constraint::visit_drives`].
    fn constraint<K: Constraint<S>>(&mut self);

    /// The driven row of a measure.
    fn drive<K: Constraint<S>>(&mut self);

    /// A force definition.
    fn force<K: Force<S>>(&mut self);
}
