//! The functions of a definition that the harness needs, for constraints and forces.

use joints::spec::{Row, Spec};
use joints::{Argument, ArgumentError, Definition, Ring};

use crate::block::Block;
use crate::bodies::Bodies;
use crate::check::Check;
use crate::failure::{Failure, Property};
use crate::kernels::KernelNumber;
use crate::pattern::Pattern;
use crate::state::State;

/// A definition as used by the harness: its specification and its constructor. It is a value, not a
/// type, so that the harness is compiled once for all definitions of a space.
pub(crate) trait Subject: Copy {
    /// The space of its bodies.
    type Space: Bodies;
    /// The definition with values for its parameters.
    type Made;
    /// Names of the kernels, and of quantities computed from them.
    type Kernel: Copy + 'static;
    /// Observations that are required in at least one case.
    type Seen: Default;

    /// The kernel that determines the effect of an error of the coordinates.
    const SLOPE: Self::Kernel;
    /// Kernels whose norm does not change if all bodies move as one rigid body, with their names.
    const INVARIANTS: &'static [(Self::Kernel, &'static str)];

    /// The common part of the specifications of constraints and forces.
    fn common(self) -> &'static Spec;

    /// Rows, each with a multiplier; forces have no rows.
    fn rows(self) -> &'static [Row] {
        &[]
    }

    /// Whether the kernels use the cosine and sine of the last function of time.
    fn turning(self) -> bool {
        false
    }

    /// Number of angles that the definition receives with their revolutions.
    fn turns(self) -> usize {
        0
    }

    /// Number of columns of the blocks: the degrees of freedom of the slots.
    fn columns(self) -> usize {
        <Self::Space as joints::Space>::N_DOF * self.common().slots.len()
    }

    /// The definition with these values for its parameters.
    fn make(self, arguments: &[Argument]) -> Result<Self::Made, ArgumentError>;

    /// The constructed object as a definition.
    fn definition(made: &mut Self::Made) -> &mut dyn Definition<Self::Space>;

    /// A kernel as a dense block. Entries that the kernel does not write stay NaN, so that every
    /// comparison detects them.
    fn kernel<D: KernelNumber>(
        self,
        made: &Self::Made,
        kernel: Self::Kernel,
        at: &State<Self::Space, D>,
    ) -> Block<D>;

    /// A kernel for plain numbers, including kernels that are not differentiated: their code is
    /// then compiled for one number type.
    fn final_kernel(
        self,
        made: &Self::Made,
        kernel: Self::Kernel,
        at: &State<Self::Space, f64>,
    ) -> Block {
        self.kernel(made, kernel, at)
    }

    /// Kernels with a pattern.
    ///
    /// # Errors
    /// Returns an error if a pattern has entries outside of its block, or the same entry twice.
    fn patterns(self) -> Result<Vec<(Self::Kernel, Pattern)>, Failure>;

    /// Kernels that are derivatives of others.
    fn derivatives() -> impl Iterator<Item = &'static Derivative<Self::Kernel>>;

    /// Whether the kernels have values at all states of a case.
    fn is_defined(_check: &Check<'_, Self>) -> bool {
        true
    }

    /// Checks that must succeed before kernels are evaluated.
    fn before(_check: &Check<'_, Self>) -> Result<(), Failure> {
        Ok(())
    }

    /// Properties in addition to derivatives, patterns and norms.
    fn properties(check: &Check<'_, Self>) -> Result<(), Failure>;

    /// Records one case.
    fn see(_check: &Check<'_, Self>, _seen: &mut Self::Seen) {}

    /// Checks whether the specification agrees with the observations in all cases.
    fn facts(self, seen: &Self::Seen) -> Result<(), Failure>;
}

/// A kernel that is a derivative of another one.
pub(crate) struct Derivative<K> {
    /// The violated property if kernel and derivative differ.
    pub(crate) property: Property,
    /// The kernel.
    pub(crate) kernel: K,
    /// Sign: the kernel is this number times the derivative.
    pub(crate) sign: f64,
    /// The differentiated kernel.
    pub(crate) of: K,
    /// The variable of the derivative.
    pub(crate) by: By,
}

impl<K> Derivative<K> {
    /// `kernel = sign · d of / d by` in the rows of `of`; otherwise the definition violates the
    /// property.
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
    /// Each degree of freedom of the poses, next to each other.
    Poses,
    /// Each degree of freedom of the twists, next to each other.
    Twists,
    /// Time, with constant poses.
    Time,
    /// τ of the motion `x + τv`, `t + τ`.
    Motion,
    /// The second derivative with respect to τ of the motion.
    MotionTwice,
}

/// The column that a kernel with `n` results writes.
pub(crate) fn dense<T: Ring>(n: usize, write: impl FnOnce(&mut [T])) -> Block<T> {
    let mut out = vec![T::from(f64::NAN); n];
    write(&mut out);
    Block::column(out)
}

/// The block that a kernel writes with its pattern; other entries are zero.
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
