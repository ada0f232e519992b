//! Constraints and forces of any definition, with their kernels in each number type of the harness.

use joints::{
    Constraint, ConstraintKernels, Definition, Element, Force, ForceElement, Reaction, Scalar,
};

use crate::bodies::Bodies;
use crate::number::{Dual, Number, Traced};

/// A constraint of any definition.
pub(crate) trait AnyConstraint<S: Bodies> {
    /// Kernels for plain numbers.
    fn plain(&self) -> &dyn ConstraintKernels<S>;

    /// Rows for dual numbers.
    fn dual(&self) -> &dyn Element<Dual, S>;

    /// Reaction for dual numbers.
    fn dual_reaction(&self) -> &dyn Reaction<Dual, S>;

    /// The same constraint with these numbers instead of its own; see [`Definition::set_data`].
    fn with_data(&self, numbers: &[f64]) -> Box<dyn AnyConstraint<S>>;

    /// The constraint as a definition.
    fn definition(&mut self) -> &mut dyn Definition<S>;
}

impl<K: Constraint<S>, S: Bodies> AnyConstraint<S> for K {
    fn plain(&self) -> &dyn ConstraintKernels<S> {
        self
    }

    fn dual(&self) -> &dyn Element<Dual, S> {
        self.element()
    }

    fn dual_reaction(&self) -> &dyn Reaction<Dual, S> {
        self.reaction()
    }

    fn with_data(&self, numbers: &[f64]) -> Box<dyn AnyConstraint<S>> {
        let mut other = self.clone();
        other.set_data(numbers);
        Box::new(other)
    }

    fn definition(&mut self) -> &mut dyn Definition<S> {
        self
    }
}

/// A force of any definition.
pub(crate) trait AnyForce<S: Bodies> {
    /// Kernels for plain numbers.
    fn plain(&self) -> &dyn ForceElement<f64, S>;

    /// Kernels for dual numbers.
    fn dual(&self) -> &dyn ForceElement<Dual, S>;

    /// Kernels for numbers that record whether the force has no value.
    fn traced(&self) -> &dyn ForceElement<Traced, S>;

    /// The force as a definition.
    fn definition(&mut self) -> &mut dyn Definition<S>;
}

impl<K: Force<S>, S: Bodies> AnyForce<S> for K {
    fn plain(&self) -> &dyn ForceElement<f64, S> {
        self
    }

    fn dual(&self) -> &dyn ForceElement<Dual, S> {
        self.element()
    }

    fn traced(&self) -> &dyn ForceElement<Traced, S> {
        self.element()
    }

    fn definition(&mut self) -> &mut dyn Definition<S> {
        self
    }
}

/// A number type in which all kernels are compiled.
pub(crate) trait KernelNumber: Number + Scalar {
    /// The rows of a constraint in this number type.
    fn of_constraint<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Element<Self, S>;

    /// The reaction of a constraint in this number type.
    fn reaction_of<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Reaction<Self, S>;

    /// The kernels of a force in this number type.
    fn of_force<S: Bodies>(force: &dyn AnyForce<S>) -> &dyn ForceElement<Self, S>;
}

impl KernelNumber for f64 {
    fn of_constraint<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Element<Self, S> {
        constraint.plain()
    }

    fn reaction_of<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Reaction<Self, S> {
        constraint.plain()
    }

    fn of_force<S: Bodies>(force: &dyn AnyForce<S>) -> &dyn ForceElement<Self, S> {
        force.plain()
    }
}

impl KernelNumber for Dual {
    fn of_constraint<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Element<Self, S> {
        constraint.dual()
    }

    fn reaction_of<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Reaction<Self, S> {
        constraint.dual_reaction()
    }

    fn of_force<S: Bodies>(force: &dyn AnyForce<S>) -> &dyn ForceElement<Self, S> {
        force.dual()
    }
}
