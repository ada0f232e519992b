//! The elements of a mechanism: the lists of constraints and forces, with the arguments of their
//! kernels.

use super::time_function::TimeFunction;
use crate::called::Controller;
use crate::element::{PlacedArmature, PlacedConstraint, PlacedForce, Site};

/// The elements of a mechanism with their indices, and the arguments of their kernels.
#[derive(Clone, Default)]
pub(crate) struct Elements {
    pub(crate) constraints: Vec<PlacedConstraint>,
    pub(crate) forces: Vec<PlacedForce>,
    pub(crate) armatures: Vec<PlacedArmature>,
    /// Arguments of kernels in addition to poses and velocities, in the order of the elements.
    pub(crate) given: Vec<KernelInput>,
    pub(crate) controllers: Vec<Controller>,
    /// Index of each value of the controllers among the arguments of kernels.
    pub(crate) signals: Vec<usize>,
    /// The unwrapped angles. The angles of constraints come first, followed by the angles of
    /// forces.
    pub(crate) counted: Vec<CountedAngle>,
    /// The states of force laws, in the order of the forces.
    pub(crate) states: Vec<LawStates>,
    /// The constant entries of C; the other entries are zero.
    pub(crate) entries: Vec<f64>,
    pub(crate) n_slots: usize,
    /// Largest number of values that the kernel of a force computes.
    pub(crate) block: usize,
}

impl Elements {
    /// Returns the indices of all constraints, forces and armatures.
    pub(crate) fn sites(&self) -> impl Iterator<Item = &Site> {
        let constraints = self.constraints.iter().map(|c| &c.site);
        let forces = self.forces.iter().map(|f| &f.site);
        let armatures = self.armatures.iter().map(|a| &a.site);
        constraints.chain(forces).chain(armatures)
    }

    /// Returns the functions of time as passed to the elements.
    pub(crate) fn functions(&self) -> impl Iterator<Item = &TimeFunction> {
        self.given.iter().filter_map(KernelInput::function)
    }
}

/// An argument of the kernels of an element in addition to poses and velocities.
#[derive(Clone)]
pub(crate) enum KernelInput {
    /// A function of time.
    Function(TimeFunction),
    /// One of the three values of an unwrapped angle; [`System::pose`] sets these values.
    ///
    /// [`System::pose`]: crate::System::pose
    Counted,
    /// A state of a force law; [`System::pose`] sets this value.
    ///
    /// [`System::pose`]: crate::System::pose
    State,
    /// A value of a controller; [`Mechanism::command`] sets this value.
    ///
    /// [`Mechanism::command`]: super::Mechanism::command
    Signal,
}

impl KernelInput {
    pub(crate) fn function(&self) -> Option<&TimeFunction> {
        match self {
            Self::Function(function) => Some(function),
            Self::Counted | Self::State | Self::Signal => None,
        }
    }
}

/// An unwrapped angle.
#[derive(Clone)]
pub(crate) struct CountedAngle {
    pub(super) owner: Owner,
    /// Index of this angle among the unwrapped angles of its element.
    pub(super) number: usize,
    /// The index of the first of the three values of the angle among the arguments of kernels.
    pub(crate) first: usize,
}

/// The element to which an unwrapped angle belongs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    Constraint(usize),
    Force(usize),
}

/// The states of one force law.
#[derive(Clone)]
pub(crate) struct LawStates {
    /// Index of the force.
    pub(super) force: usize,
    /// Index of the first state among the arguments of kernels.
    pub(super) first: usize,
    /// Number of the states.
    pub(super) n: usize,
}
