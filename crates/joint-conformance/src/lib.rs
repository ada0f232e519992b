#![doc = include_str!("../README.md")]
//!
//! # What is compared
//!
//! A definition is checked by its type alone. Parameters, poses, motions, multipliers and functions
//! of time are random numbers according to the specification, reproducible from a seed:
//! [`ORDINARY_CASES`] ordinary cases, and [`AWKWARD_CASES`] of each special [`Kind`]. The check
//! compares the largest difference of a block of kernel results, relative to its largest entry.
//!
//! | block | reference, by dual numbers (1e-12) and, in every fourth ordinary case, by differences (1e-9) |
//! | --- | --- |
//! | C, b | derivatives of Φ along each degree of freedom and in time |
//! | C·v − b | Φ̇ along the motion |
//! | Γ | −d²Φ/dτ² along (x + τv, t + τ), and −d(C·v − b)/dτ, which also holds for velocity rows |
//! | ∂(Cᵀλ)/∂x, ∂(C·a − Γ)/∂x, ∂Γ/∂v, ∂Q/∂x, ∂Q/∂v | derivatives of the kernels above, including entries outside the patterns |
//! | ∂(λᵀΦ)/∂p, ∂(λᵀ(C·a − Γ))/∂p | differences through `set_data`; the second by dual numbers from the first |
//! | wrench, reference point | −C of the first body, moved; a point fixed in the first body, or in the carrier of wheels |
//! | balance | forces and moments on all bodies add up to zero |
//! | norms | unchanged by a rigid motion of all bodies |
//! | start | rows that store an initial value are zero at the start |
//! | velocity terms of forces | never add energy |
//!
//! Balance and norms are checked for definitions that relate bodies to each other: definitions with
//! two or more slots and without a line of the ground. For constraints, the balance is checked at
//! position level, because velocities are relative to the ground. A joint to the ground has the
//! ground in a slot.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

mod block;
mod bodies;
mod case;
mod check;
mod constraint;
mod derivative;
mod failure;
mod force;
mod kernels;
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

/// Checks a constraint definition and the drives of its joint coordinates.
///
/// # Errors
/// The first property that is violated.
pub fn check_constraint<K: Constraint<S>, S: Bodies>(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks::default();
    Visitor::<S>::constraint::<K>(&mut checks);
    checks.run(seed)
}

/// Checks a force definition.
///
/// # Errors
/// The first property that is violated.
pub fn check_force<F: Force<S>, S: Bodies>(seed: u64) -> Result<(), Failure> {
    check(OfForce::<S>::new::<F>(), seed)
}

/// Checks all definitions of the library.
///
/// # Errors
/// The first violated property of the first definition that violates one.
pub fn check_all(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks::default();
    plane_constraints(&mut checks);
    plane_forces(&mut checks);
    space3::constraints(&mut checks);
    space3::forces(&mut checks);
    checks.run(seed)
}

/// The checks of the visited definitions, in their order.
#[derive(Default)]
struct Checks(Vec<Box<Check>>);

/// The check of one definition, with a seed.
type Check = dyn Fn(u64) -> Result<(), Failure> + Sync;

impl Checks {
    /// Makes all checks up to the first failure, as many at the same time as there are processors.
    fn run(&self, seed: u64) -> Result<(), Failure> {
        let next = AtomicUsize::new(0);
        let (failed, failures) = (AtomicBool::new(false), Mutex::new(BTreeMap::new()));
        let work = || {
            while !failed.load(Ordering::Relaxed) {
                let k = next.fetch_add(1, Ordering::Relaxed);
                let Some(check) = self.0.get(k) else { break };
                if let Err(failure) = check(seed) {
                    failed.store(true, Ordering::Relaxed);
                    let mut failures = failures.lock().unwrap_or_else(PoisonError::into_inner);
                    failures.insert(k, failure);
                }
            }
        };
        let processors = std::thread::available_parallelism().map_or(1, NonZero::get);
        std::thread::scope(|scope| {
            for _ in 1..processors.min(self.0.len()) {
                scope.spawn(work);
            }
            work();
        });
        // The checks before the first failure were started before it, and have succeeded.
        let failures = failures
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        failures.into_values().next().map_or(Ok(()), Err)
    }
}

impl<S: Bodies> Visitor<S> for Checks {
    fn constraint<K: Constraint<S>>(&mut self) {
        self.drive::<K>();
        K::visit_drives(self);
    }

    fn drive<K: Constraint<S>>(&mut self) {
        let of = OfConstraint::<S>::new::<K>();
        self.0.push(Box::new(move |seed| check(of, seed)));
    }

    fn force<F: Force<S>>(&mut self) {
        let of = OfForce::<S>::new::<F>();
        self.0.push(Box::new(move |seed| check(of, seed)));
    }
}
