//! The elements of a mechanism: constraints and forces in lists, with what their kernels are given.

use super::time_function::TimeFunction;
use crate::element::{PlacedConstraint, PlacedForce, Site};

/// The elements of a mechanism with their indices, and the arguments of their kernels.
#[derive(Clone, Default)]
pub(crate) struct Elements {
    pub(crate) constraints: Vec<PlacedConstraint>,
    pub(crate) forces: Vec<PlacedForce>,
    /// What kernels are given besides poses and velocities, element by element.
    pub(crate) given: Vec<KernelInput>,
    /// The angles that count their turns: those of constraints, then those of forces.
    pub(crate) counted: Vec<CountedAngle>,
    /// Constant entries of C, zero elsewhere.
    pub(crate) entries: Vec<f64>,
    pub(crate) n_slots: usize,
    /// Largest number of values of the kernel of a force.
    pub(crate) block: usize,
}

impl Elements {
    /// The sites of all constraints and forces.
    pub(crate) fn sites(&self) -> impl Iterator<Item = &Site> {
        let constraints = self.constraints.iter().map(|c| &c.site);
        constraints.chain(self.forces.iter().map(|f| &f.site))
    }

    /// The functions of time as passed to the elements.
    pub(crate) fn functions(&self) -> impl Iterator<Item = &TimeFunction> {
        self.given.iter().filter_map(KernelInput::function)
    }
}

/// What the kernels of an element are given besides poses and velocities.
#[derive(Clone)]
pub(crate) enum KernelInput {
    /// A function of time.
    Function(TimeFunction),
    /// One of three values of a counted angle, which [`System::pose`] sets.
    ///
    /// [`System::pose`]: crate::System::pose
    Counted,
}

impl KernelInput {
    pub(crate) fn function(&self) -> Option<&TimeFunction> {
        match self {
            Self::Function(function) => Some(function),
            Self::Counted => None,
        }
    }
}

/// An angle that counts its turns.
#[derive(Clone)]
pub(crate) struct CountedAngle {
    pub(super) owner: Owner,
    /// Its number among the counted angles of its element.
    pub(super) number: usize,
    /// The first of its three values among those that are given to kernels.
    pub(crate) first: usize,
}

/// The element of a counted angle.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    Constraint(usize),
    Force(usize),
}
