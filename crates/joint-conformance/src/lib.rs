#![doc = include_str!("../README.md")]
//!
//! # What is compared
//!
//! A definition is checked by its type alone; parameters, poses, motions, multipliers and functions
//! of time are drawn from what its spec says, reproducibly from a seed: [`ORDINARY_CASES`] ordinary
//! cases, and [`AWKWARD_CASES`] of each awkward [`Kind`]. What is compared is the largest
//! difference of a block of kernel results, relative to its largest entry.
//!
//! | block | reference, by dual numbers (1e-12) and, in every fourth ordinary case, by differences (1e-9) |
//! | --- | --- |
//! | C, b | derivatives of Φ along each degree of freedom and in time |
//! | C·v − b | Φ̇ along the motion |
//! | Γ | −d²Φ/dτ² along (x + τv, t + τ), and −d(C·v − b)/dτ, which also holds for velocity rows |
//! | ∂(Cᵀλ)/∂x, ∂(C·a − Γ)/∂x, ∂Γ/∂v, ∂Q/∂x, ∂Q/∂v | derivatives of the kernels above, including entries outside the patterns |
//! | ∂(λᵀΦ)/∂p, ∂(λᵀ(C·a − Γ))/∂p | differences through `set_data`; the second by dual numbers from the first |
//! | wrench, place | −C of the first body, moved; a point fixed in the first body, or in the carrier of wheels |
//! | balance | forces and moments on all bodies add up to zero |
//! | norms | unchanged when all bodies move as one |
//! | start | rows that store an initial value are zero at the start |
//! | velocity terms of forces | never add energy |
//!
//! Balance and norms are expected of definitions that relate bodies to each other: those with two
//! or more slots and without a line of the ground (balance of constraints: on position level, since
//! velocities are against the ground). A joint against the ground takes the ground as a slot.

mod block;
mod bodies;
mod case;
mod check;
mod constraint;
mod derivative;
mod failure;
mod force;
mod number;
mod pattern;
mod state;
mod subject;

pub use bodies::Bodies;
pub use case::{AWKWARD_CASES, Kind, ORDINARY_CASES};
pub use failure::{DIFFERENCE_TOLERANCE, DUAL_TOLERANCE, Failure, Property, Reference};

use check::check;
use constraint::OfConstraint;
use force::OfForce;
use joints::{Constraint, Force, Visitor, plane_constraints, plane_forces, space3};

/// Checks a constraint definition and the drives of its measures.
///
/// # Errors
/// The first property that is violated.
pub fn check_constraint<K: Constraint<S>, S: Bodies>(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks::new(seed);
    Visitor::<S>::constraint::<K>(&mut checks);
    checks.result
}

/// Checks a force definition.
///
/// # Errors
/// The first property that is violated.
pub fn check_force<F: Force<S>, S: Bodies>(seed: u64) -> Result<(), Failure> {
    check::<OfForce<F, S>>(seed)
}

/// Checks all definitions of the library.
///
/// # Errors
/// The first violated property of the first definition with one.
pub fn check_all(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks::new(seed);
    plane_constraints(&mut checks);
    plane_forces(&mut checks);
    space3::constraints(&mut checks);
    space3::forces(&mut checks);
    checks.result
}

/// Checks the visited definitions up to the first failure.
struct Checks {
    seed: u64,
    result: Result<(), Failure>,
}

impl Checks {
    fn new(seed: u64) -> Self {
        Self {
            seed,
            result: Ok(()),
        }
    }
}

impl<S: Bodies> Visitor<S> for Checks {
    fn constraint<K: Constraint<S>>(&mut self) {
        self.drive::<K>();
        K::visit_drives(self);
    }

    fn drive<K: Constraint<S>>(&mut self) {
        if self.result.is_ok() {
            self.result = check::<OfConstraint<K, S>>(self.seed);
        }
    }

    fn force<F: Force<S>>(&mut self) {
        if self.result.is_ok() {
            self.result = check::<OfForce<F, S>>(self.seed);
        }
    }
}
