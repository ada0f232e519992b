//! The functions that the harness needs for a definition of a constraint or a force.

use joints::spec::{Row, Spec};
use joints::{Argument, ArgumentError, Definition, Ring};

use crate::block::Block;
use crate::bodies::Bodies;
use crate::check::Check;
use crate::failure::{Failure, Property};
use crate::kernels::KernelNumber;
use crate::pattern::Pattern;
use crate::state::State;

/// A definition in the form that the harness needs: its specification and its constructor. A
/// subject is a value and not a type, so that the harness is compiled only once for all definitions
/// of a space.
pub(crate) trait Subject: Copy {
    /// The space of its bodies.
    type Space: Bodies;
    /// The constructed element.
    type Made;
    /// A kernel, or a quantity that is computed from kernels.
    type Kernel: Copy + 'static;
    /// Properties that must be observed in at least one case.
    type Seen: Default;

    /// The kernel that determines the effect of errors in the coordinates.
    const SLOPE: Self::Kernel;
    /// Kernels whose norm does not change if all bodies move as one rigid body, with their names.
    const INVARIANTS: &'static [(Self::Kernel, &'static str)];

    /// Returns the part of the specification that constraints and forces have in common.
    fn common(self) -> &'static Spec;

    /// Returns the rows. Each row has a multiplier, and forces have no rows.
    fn rows(self) -> &'static [Row] {
        &[]
    }

    /// Returns whether the kernels use the cosine and sine of the last function of time.
    fn turning(self) -> bool {
        false
    }

    /// Returns the number of angles that the kernels receive including full revolutions.
    fn turns(self) -> usize {
        0
    }

    /// Returns the number of columns of the blocks: the number of velocity components of all
    /// bodies.
    fn columns(self) -> usize {
        <Self::Space as joints::Space>::N_DOF * self.common().slots.len()
    }

    /// Constructs the element with these values of its parameters.
    fn make(self, arguments: &[Argument]) -> Result<Self::Made, ArgumentError>;

    /// Returns the constructed element as a definition.
    fn definition(made: &mut Self::Made) -> &mut dyn Definition<Self::Space>;

    /// Returns a kernel as a dense block. Entries that the kernel does not write are NaN, so that
    /// every comparison detects these entries.
    fn kernel<D: KernelNumber>(
        self,
        made: &Self::Made,
        kernel: Self::Kernel,
        at: &State<Self::Space, D>,
    ) -> Block<D>;

    /// Returns a kernel for `f64`. This function also returns kernels that are not differentiated,
    /// so that these kernels need to be compiled only for this type.
    fn final_kernel(
        self,
        made: &Self::Made,
        kernel: Self::Kernel,
        at: &State<Self::Space, f64>,
    ) -> Block {
        self.kernel(made, kernel, at)
    }

    /// Returns the kernels with a sparsity pattern.
    ///
    /// # Errors
    /// Returns an error if a pattern has an entry outside its block, or the same entry twice.
    fn patterns(self) -> Result<Vec<(Self::Kernel, Pattern)>, Failure>;

    /// Returns the kernels that are derivatives of other kernels.
    fn derivatives() -> impl Iterator<Item = &'static Derivative<Self::Kernel>>;

    /// Returns whether the kernels have values at all states of a case.
    fn is_defined(_check: &Check<'_, Self>) -> bool {
        true
    }

    /// Performs the checks that must succeed before kernels are evaluated.
    fn before(_check: &Check<'_, Self>) -> Result<(), Failure> {
        Ok(())
    }

    /// Checks the properties other than derivatives, patterns and norms.
    fn properties(check: &Check<'_, Self>) -> Result<(), Failure>;

    /// Records the properties observed in one case.
    fn see(_check: &Check<'_, Self>, _seen: &mut Self::Seen) {}

    /// Checks that the specification agrees with the observations in all cases.
    fn facts(self, seen: &Self::Seen) -> Result<(), Failure>;
}

/// A kernel that must be a derivative of another kernel.
pub(crate) struct Derivative<K> {
    /// The property that is violated if the kernel differs from the derivative.
    pub(crate) property: Property,
    /// The kernel.
    pub(crate) kernel: K,
    /// The kernel is this factor times the derivative.
    pub(crate) sign: f64,
    /// The kernel that is differentiated.
    pub(crate) of: K,
    /// The variable of the derivative.
    pub(crate) by: By,
}

impl<K> Derivative<K> {
    /// States that `kernel = sign · d of / d by` in the rows of `of`. If the statement is false,
    /// the definition violates the property.
    pub(crate) const fn new(property: Property, kernel: K, sign: f64, of: K, by: By) -> Self {
        Self {
            property,
            kernel,
            sign,
            of,
            by,
        }
    }
}

/// Variable of a derivative.
#[derive(Clone, Copy)]
pub(crate) enum By {
    /// Velocity components of all poses, one column for each component.
    Poses,
    /// Velocity components of all twists, one column for each component.
    Twists,
    /// Time, with constant poses.
    Time,
    /// The parameter τ of the motion `x + τv`, `t + τ`.
    Motion,
    /// The parameter τ of the motion, for a second derivative.
    MotionTwice,
}

/// Returns the column that a kernel with `n` results writes.
pub(crate) fn dense<T: Ring>(n: usize, write: impl FnOnce(&mut [T])) -> Block<T> {
    let mut out = vec![T::from(f64::NAN); n];
    write(&mut out);
    Block::column(out)
}

/// Returns the block that a kernel writes in the order of its pattern. All other entries are zero.
pub(crate) fn sparse<T: Ring>(
    [rows, columns]: [usize; 2],
    pattern: &[[usize; 2]],
    write: impl FnOnce(&mut [T]),
) -> Block<T> {
    let mut block = Block::filled(rows, columns, T::from(0.0));
    let entries = dense(pattern.len(), write);
    for (&[row, column], &entry) in pattern.iter().zip(entries.entries()) {
        block.set(row, column, entry);
    }
    block
}
