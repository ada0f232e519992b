//! Constraints and forces of any definition as trait objects, with their kernels in each number
//! type of the harness.

use joints::{
    Constraint, ConstraintKernels, Definition, Element, Force, ForceElement, Reaction, Scalar,
};

use crate::bodies::Bodies;
use crate::number::{Dual, Number, Traced};

/// A constraint of any definition, as a trait object.
pub(crate) trait AnyConstraint<S: Bodies> {
    /// Returns the kernels for `f64`.
    fn plain(&self) -> &dyn ConstraintKernels<S>;

    /// Returns the rows for dual numbers.
    fn dual(&self) -> &dyn Element<Dual, S>;

    /// Returns the reaction for dual numbers.
    fn dual_reaction(&self) -> &dyn Reaction<Dual, S>;

    /// Returns the same constraint with these stored values; see [`Definition::set_data`].
    fn with_data(&self, numbers: &[f64]) -> Box<dyn AnyConstraint<S>>;

    /// Returns the constraint as a definition.
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

/// A force of any definition, as a trait object.
pub(crate) trait AnyForce<S: Bodies> {
    /// Returns the kernels for `f64`.
    fn plain(&self) -> &dyn ForceElement<f64, S>;

    /// Returns the kernels for dual numbers.
    fn dual(&self) -> &dyn ForceElement<Dual, S>;

    /// Returns the kernels for numbers that record whether the value of the force is undefined.
    fn traced(&self) -> &dyn ForceElement<Traced, S>;

    /// Returns the force as a definition.
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
    /// Returns the rows of a constraint in this number type.
    fn of_constraint<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Element<Self, S>;

    /// Returns the reaction of a constraint in this number type.
    fn reaction_of<S: Bodies>(constraint: &dyn AnyConstraint<S>) -> &dyn Reaction<Self, S>;

    /// Returns the kernels of a force in this number type.
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
