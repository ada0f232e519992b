//! Property tests for every definition, both those of the library and user-defined joints.
//!
//! A definition is given by its type alone; parameters, poses, motions, multipliers and functions
//! of time are drawn according to its specification, reproducibly from a seed: [`ORDINARY_CASES`]
//! ordinary cases, and [`AWKWARD_CASES`] of each awkward [`Kind`]. The largest difference of a
//! [`Block`] is compared relative to its largest entry.
//!
//! | block | reference, by dual numbers (1e-12) and, in every fourth ordinary case, by differences (1e-9) |
//! | --- | --- |
//! | C, b | derivatives of Φ along each degree of freedom and in time |
//! | C·v − b | Φ̇ along the motion |
//! | Γ | −d²Φ/dτ² along (x + τv, t + τ), and −d(C·v − b)/dτ, which also holds for velocity rows |
//! | ∂(Cᵀλ)/∂x, ∂(C·a − Γ)/∂x, ∂Γ/∂v, ∂Q/∂x, ∂Q/∂v | derivatives of the kernels above, including entries outside the patterns |
//! | ∂(λᵀΦ)/∂p, ∂(λᵀ(C·a − Γ))/∂p | differences through `set_data`; the second by dual numbers from the first |
//! | wrench, place | −C of the first body, moved; a point fixed in the first body |
//! | balance | forces and moments on all bodies add up to zero |
//! | norms | unchanged when all bodies move as one |
//! | start | rows that store an initial value are zero at the start |
//! | velocity terms of forces | never add energy |
//!
//! Balance and norms are tested for definitions that relate bodies to each other: those with two or
//! more slots and without a line of the ground (for constraints only at position level, because
//! velocities are relative to the ground). A joint with the ground has the ground in a slot.
//!
//! No derivative detects a wrong Φ, velocity row or law: a wrong sign or axis, or a missing row.
//! For this a definition needs a table of poses computed by hand; this crate has one for each
//! definition in `tests/golden`.
//!
//! ```
//! use joints::conformance::{check_constraint, check_force};
//! # fn main() -> Result<(), joints::conformance::Failure> {
//! check_constraint::<joints::generated::KnifeEdge>(1)?;
//! check_force::<joints::generated::Torque>(1)?;
//! # Ok(())
//! # }
//! ```

mod block;
mod case;
mod constraint;
mod derivative;
mod failure;
mod force;
mod kernels;
mod number;
mod oracle;
mod pattern;
mod state;

pub use block::Block;
pub use case::{AWKWARD_CASES, Case, Kind, ORDINARY_CASES};
pub use failure::{Failure, Property, Reference};
pub use oracle::{DIFFERENCE_TOLERANCE, DUAL_TOLERANCE};

use crate::constraint::Constraint;
use crate::force::Force;
use crate::generated::{plane_constraints, plane_forces};
use crate::visitor::Visitor;

/// Checks a constraint definition and the drives of its measures.
///
/// # Errors
/// The first property that is violated.
pub fn check_constraint<K: Constraint>(seed: u64) -> Result<(), Failure> {
    constraint::check::<K>(seed)?;
    let mut drives = Checks {
        seed,
        result: Ok(()),
    };
    K::visit_drives(&mut drives);
    drives.result
}

/// Checks a force definition.
///
/// # Errors
/// The first property that is violated.
pub fn check_force<F: Force>(seed: u64) -> Result<(), Failure> {
    force::check::<F>(seed)
}

/// Checks all definitions of the library.
///
/// # Errors
/// The first violated property of the first definition with one.
pub fn check_all(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks {
        seed,
        result: Ok(()),
    };
    plane_constraints(&mut checks);
    plane_forces(&mut checks);
    checks.result
}

/// Checks the visited definitions up to the first failure.
struct Checks {
    seed: u64,
    result: Result<(), Failure>,
}

impl Visitor for Checks {
    fn constraint<K: Constraint>(&mut self) {
        if self.result.is_ok() {
            self.result = check_constraint::<K>(self.seed);
        }
    }

    fn drive<K: Constraint>(&mut self) {
        if self.result.is_ok() {
            self.result = constraint::check::<K>(self.seed);
        }
    }

    fn force<F: Force>(&mut self) {
        if self.result.is_ok() {
            self.result = check_force::<F>(self.seed);
        }
    }
}
