//! Iteration over definitions with their types: registries, test harnesses and benchmarks visit
//! every definition without its name.

use crate::constraint::Constraint;
use crate::force::Force;
use crate::space::{Plane, Space};

/// Receives definitions of one space; [`crate::plane_constraints`], [`crate::plane_forces`],
/// [`crate::space3::constraints`] and [`crate::space3::forces`] call it with the definitions of the
/// library.
pub trait Visitor<S: Space = Plane> {
    /// Receives a constraint definition. Its drives are passed separately, through
    /// [`Constraint::visit_drives`].
    fn constraint<K: Constraint<S>>(&mut self);

    /// Receives the driven rows of a joint coordinate.
    fn drive<K: Constraint<S>>(&mut self);

    /// Receives a force definition.
    fn force<K: Force<S>>(&mut self);
}
