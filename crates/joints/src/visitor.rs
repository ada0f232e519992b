//! Iteration over definitions with their types: registries, test harnesses and benchmarks visit
//! every definition without naming one.

use crate::constraint::Constraint;
use crate::force::Force;

/// Receives definitions; [`crate::plane_constraints`] and [`crate::plane_forces`] call it with all
/// definitions of the library.
pub trait Visitor {
    /// A constraint definition. Its drives come separately, through [`Constraint::visit_drives`].
    fn constraint<K: Constraint>(&mut self);

    /// The driven row of a measure.
    fn drive<K: Constraint>(&mut self);

    /// A force definition.
    fn force<K: Force>(&mut self);
}
