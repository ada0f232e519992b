//! What constraints and forces have in common as objects: the numbers that they store.

use crate::plane::Pose;

/// A definition with values for its parameters, and with what it keeps from the start.
pub trait Definition: Send + Sync {
    /// Takes the values that the definition keeps from the assembled start.
    fn initialise(&mut self, x: &[Pose]);

    /// Whether requirement `k` of the definition holds at the assembled start.
    fn requirement(&self, k: usize, x: &[Pose]) -> bool;

    /// Points that the definition takes hold of, each in the frame of its body: values of the
    /// parameters of this shape, in their order. None if a definition does not say.
    fn points(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The numbers that a constraint stores, in the order of [`crate::ConstraintSpec::data`]; none
    /// for forces.
    fn data(&self, _out: &mut [f64]) {}

    /// Puts numbers in the place of those that [`Definition::data`] returns, as they are:
    /// directions are not normalised. What [`Definition::initialise`] computed from other numbers
    /// alone is computed again.
    fn set_data(&mut self, _numbers: &[f64]) {}
}
