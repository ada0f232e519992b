//! Walking over definitions with their types: registries, test harnesses and benchmarks see every
//! definition without naming one.

use crate::constraint::Constraint;
use crate::force::Force;

/// Is shown definitions; [`crate::plane_constraints`] and [`crate::plane_forces`] show all that are
/// shipped.
pub trait Visitor {
    /// A constraint definition. Its drives come separately, through [`Constraint::visit_drives`].
    fn constraint<K: Constraint>(&mut self);

    /// The driven row of a measure.
    fn drive<K: Constraint>(&mut self);

    /// A force definition.
    fn force<K: Force>(&mut self);
}
