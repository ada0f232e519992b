//! What the harness needs of a definition, be it a constraint or a force.

use joints::spec::{Row, Spec};
use joints::{Argument, ArgumentError, Definition, Ring};

use crate::block::Block;
use crate::bodies::Bodies;
use crate::check::Check;
use crate::failure::{Failure, Property};
use crate::kernels::KernelNumber;
use crate::pattern::Pattern;
use crate::state::State;

/// A definition as the harness sees it: what its spec says, and how it is made. It is a value, not
/// a type, so that the harness is compiled once for all definitions of a space.
pub(crate) trait Subject: Copy {
    /// The space of its bodies.
    type Space: Bodies;
    /// The definition with values for its parameters.
    type Made;
    /// The names of its kernels, and of what is made of them.
    type Kernel: Copy + 'static;
    /// What has to be seen in some case, whichever.
    type Seen: Default;

    /// The kernel that says what an error of the coordinates does.
    const SLOPE: Self::Kernel;
    /// Kernels whose norm stays if all bodies are moved as one, with their names.
    const INVARIANTS: &'static [(Self::Kernel, &'static str)];

    /// What the specs of constraints and forces share.
    fn common(self) -> &'static Spec;

    /// Its rows, each with a multiplier; forces have none.
    fn rows(self) -> &'static [Row] {
        &[]
    }

    /// Whether its last function of time enters by its cosine and sine.
    fn turning(self) -> bool {
        false
    }

    /// Number of angles that it is given with their turns.
    fn turns(self) -> usize {
        0
    }

    /// Columns of its blocks: the degrees of freedom of its slots.
    fn columns(self) -> usize {
        <Self::Space as joints::Space>::N_DOF * self.common().slots.len()
    }

    /// It with these values for its parameters.
    fn make(self, arguments: &[Argument]) -> Result<Self::Made, ArgumentError>;

    /// What is made, as any definition.
    fn definition(made: &mut Self::Made) -> &mut dyn Definition<Self::Space>;

    /// A kernel as a dense block. What the kernel leaves alone stays NaN, so that no comparison
    /// passes over it.
    fn kernel<D: KernelNumber>(
        self,
        made: &Self::Made,
        kernel: Self::Kernel,
        at: &State<Self::Space, D>,
    ) -> Block<D>;

    /// The same for plain numbers, also of kernels that are not differentiated themselves: their
    /// code is then compiled for one number type.
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
    /// If a pattern has entries outside of its block, or an entry twice.
    fn patterns(self) -> Result<Vec<(Self::Kernel, Pattern)>, Failure>;

    /// Kernels that are derivatives of others.
    fn derivatives() -> impl Iterator<Item = &'static Derivative<Self::Kernel>>;

    /// Whether the kernels have values at all states of a case.
    fn is_defined(_check: &Check<'_, Self>) -> bool {
        true
    }

    /// What must hold before kernels mean anything.
    fn before(_check: &Check<'_, Self>) -> Result<(), Failure> {
        Ok(())
    }

    /// What must hold besides derivatives, patterns and norms.
    fn properties(check: &Check<'_, Self>) -> Result<(), Failure>;

    /// Takes note of one case.
    fn see(_check: &Check<'_, Self>, _seen: &mut Self::Seen) {}

    /// Whether the spec agrees with what was seen in all cases.
    fn facts(self, seen: &Self::Seen) -> Result<(), Failure>;
}

/// A kernel that is a derivative of another one.
pub(crate) struct Derivative<K> {
    /// What the definition lacks if the two differ.
    pub(crate) property: Property,
    /// The kernel.
    pub(crate) kernel: K,
    /// Its sign: the kernel is this number times the derivative.
    pub(crate) sign: f64,
    /// What is differentiated.
    pub(crate) of: K,
    /// By what.
    pub(crate) by: By,
}

impl<K> Derivative<K> {
    /// `kernel = sign · d of / d by` in the rows of `of`, else the definition lacks the property.
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

/// What a derivative is taken by.
#[derive(Clone, Copy)]
pub(crate) enum By {
    /// Each degree of freedom of the poses, side by side.
    Poses,
    /// Each degree of freedom of the twists, side by side.
    Twists,
    /// Time, bodies fixed.
    Time,
    /// τ of the motion `x + τv`, `t + τ`.
    Motion,
    /// The same, the second derivative.
    MotionTwice,
}

/// The column that a kernel of `n` numbers writes.
pub(crate) fn dense<T: Ring>(n: usize, write: impl FnOnce(&mut [T])) -> Block<T> {
    let mut out = vec![T::from(f64::NAN); n];
    write(&mut out);
    Block::column(out)
}

/// The block that a kernel writes by its pattern, zero elsewhere.
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
