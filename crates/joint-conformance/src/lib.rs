#![doc = include_str!("../README.md")]
//!
//! # What is compared
//!
//! A definition is tested by its type alone. Parameters, poses, motions, multipliers and functions
//! of time are random numbers. These numbers agree with the specification and can be reproduced
//! from a seed. There are [`ORDINARY_CASES`] ordinary cases, and [`AWKWARD_CASES`] cases of each
//! special [`Kind`]. The largest difference in a block of kernel results must be small relative to
//! the largest entry of the block.
//!
//! | block | reference, by dual numbers (1e-12) and, in every fourth ordinary case, by differences (1e-9) |
//! | --- | --- |
//! | C, b | derivatives of Φ along each velocity component and with respect to time |
//! | C·v − b | Φ̇ along the motion |
//! | Γ | −d²Φ/dτ² along (x + τv, t + τ), and −d(C·v − b)/dτ, which is valid for velocity rows, too |
//! | ∂(Cᵀλ)/∂x, ∂(C·a − Γ)/∂x, ∂Γ/∂v, ∂Q/∂x, ∂Q/∂v | derivatives of the kernels above, including entries outside the patterns |
//! | ∂(λᵀΦ)/∂p, ∂(λᵀ(C·a − Γ))/∂p | differences through `set_data`; the second by dual numbers from the first |
//! | wrench, reference point | −C of the first body, transferred to the reference point; a point fixed in the first body, or in the carrier of wheels |
//! | balance | the resultant force and torque on all bodies are zero |
//! | norms | do not change if all bodies move as one rigid body |
//! | start | rows that store an initial value are zero at the initial configuration |
//! | velocity terms of forces | never add energy |
//!
//! Balance and norms are tested for definitions that relate bodies to each other. Such definitions
//! are definitions with two or more bodies and without a line of the ground. For constraints, the
//! balance is tested at position level, because velocities are relative to the ground. For a joint
//! to the ground, the ground is one of these bodies.

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

/// Tests a constraint definition and the drives of its joint coordinates.
///
/// # Errors
/// Returns the first property that is violated.
pub fn check_constraint<K: Constraint<S>, S: Bodies>(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks::default();
    Visitor::<S>::constraint::<K>(&mut checks);
    checks.run(seed)
}

/// Tests a force definition.
///
/// # Errors
/// Returns the first property that is violated.
pub fn check_force<F: Force<S>, S: Bodies>(seed: u64) -> Result<(), Failure> {
    check(OfForce::<S>::new::<F>(), seed)
}

/// Tests all definitions of the library.
///
/// # Errors
/// Returns the first violated property of the first definition that violates one.
pub fn check_all(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks::default();
    plane_constraints(&mut checks);
    plane_forces(&mut checks);
    space3::constraints(&mut checks);
    space3::forces(&mut checks);
    checks.run(seed)
}

/// The checks of the visited definitions, in the order of the visits.
#[derive(Default)]
struct Checks(Vec<Box<Check>>);

/// The check of one definition, with a seed.
type Check = dyn Fn(u64) -> Result<(), Failure> + Sync;

impl Checks {
    /// Runs all checks up to the first failure. The number of checks that run at the same time is
    /// the number of processors.
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
        // All checks before the first failure were started earlier and have succeeded.
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
