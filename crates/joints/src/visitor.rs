//! Iteration over all definitions as types. Registries, test harnesses and benchmarks visit the
//! definitions without using their names.

use crate::constraint::Constraint;
use crate::force::Force;
use crate::space::{Plane, Space};

/// Receives the definitions of one space. [`crate::plane_constraints`], [`crate::plane_forces`],
/// [`crate::space3::constraints`] and [`crate::space3::forces`] call the visitor for the
/// definitions of the library.
pub trait Visitor<S: Space = Plane> {
    /// Receives a constraint definition. The drives of the constraint are passed separately, by
    /// [`Constraint::visit_drives`].
    fn constraint<K: Constraint<S>>(&mut self);

    /// Receives the definition of the drive of a joint coordinate.
    fn drive<K: Constraint<S>>(&mut self);

    /// Receives a force definition.
    fn force<K: Force<S>>(&mut self);
}
