//! Arguments of kernels in double-double.

use linalg::Dd;

use super::bodies::Bodies;
use super::constraint::PlacedConstraint;
use super::kernels::{AnyConstraint, stored, with};

/// Poses of all bodies, and the other arguments of kernels, in double-double.
pub(crate) struct ExtendedSlots {
    pub(crate) bodies: Bodies<Dd>,
    pub(crate) jets: Vec<[Dd; 3]>,
}

impl ExtendedSlots {
    /// Computes Φ of the holonomic rows of a constraint.
    pub(crate) fn phi(&self, constraint: &PlacedConstraint, out: &mut [Dd]) {
        with!(AnyConstraint, constraint.kernels(), element, S => {
            let x = constraint.site.poses::<S, Dd>(&self.bodies);
            let stored = stored(element.as_ref());
            let f = &self.jets[constraint.site.functions.clone()];
            element.programs().of(&stored).phi::<S>(&x, f, out);
        });
    }

    /// Computes C of a constraint.
    pub(crate) fn c(&self, constraint: &PlacedConstraint, out: &mut [Dd]) {
        with!(AnyConstraint, constraint.kernels(), element, S => {
            let x = constraint.site.poses::<S, Dd>(&self.bodies);
            let stored = stored(element.as_ref());
            let f = &self.jets[constraint.site.functions.clone()];
            element.programs().of(&stored).c::<S>(&x, f, out);
        });
    }
}
