//! Property tests for every definition in one place, for those that are shipped and for a joint of
//! one's own.
//!
//! A definition is checked by its type alone; parameters, poses, motions, multipliers and functions
//! of time are drawn from what its spec says, reproducibly from a seed: [`ORDINARY_CASES`] ordinary
//! cases, and [`AWKWARD_CASES`] of each awkward [`Kind`]. What is compared is the largest
//! difference of a [`Block`], relative to its largest entry.
//!
//! | block | reference, by dual numbers (1e-12) and, in every fourth ordinary case, by differences (1e-9) |
//! | --- | --- |
//! | C, b | derivatives of Φ along each degree of freedom and in time |
//! | C·v − b | Φ̇ along the motion |
//! | Γ | −d²Φ/dτ² along (x + τv, t + τ), and −d(C·v − b)/dτ, which also holds for velocity rows |
//! | ∂(Cᵀλ)/∂x, ∂(C·a − Γ)/∂x, ∂Γ/∂v, ∂Q/∂x, ∂Q/∂v | derivatives of the kernels above, entries outside the patterns included |
//! | ∂(λᵀΦ)/∂p, ∂(λᵀ(C·a − Γ))/∂p | differences through `set_data`; the second by dual numbers from the first |
//! | wrench, place | −C of the first body, moved; a point fixed in the first body |
//! | balance | forces and moments on all bodies add up to zero |
//! | norms | unchanged when all bodies move as one |
//! | start | rows that keep the start are zero there |
//! | velocity terms of forces | never add energy |
//!
//! Balance and norms are expected of definitions that relate bodies to each other: those with two
//! or more slots and without a line of the ground (balance of constraints: on position level, since
//! velocities are against the ground). A joint against the ground takes the ground as a slot.
//!
//! No derivative can see a wrong Φ, velocity row or law: a sign, an axis, a row that is missing.
//! For that a definition needs a table of poses worked out by hand; this crate has one for each in
//! `tests/golden`.
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
mod pattern;
mod state;

pub use block::Block;
pub use case::{AWKWARD_CASES, Case, Kind, ORDINARY_CASES};
pub use failure::{Failure, Property, Reference};

use crate::constraint::Constraint;
use crate::force::Force;
use crate::generated::{plane_constraints, plane_forces};
use crate::plane::{N_DOF, Pose};
use crate::spec::{Shape, Spec};
use crate::visitor::Visitor;
use failure::fact;

/// Against dual numbers and identities: both sides carry the round-off of some ten operations,
/// about 1e-15, times up to 1e3 where coordinates or angles are that large.
pub const DUAL_TOLERANCE: f64 = 1e-12;

/// Against differences: the best step loses about a third of the digits of a first derivative, and
/// extrapolation gives most of them back; second derivatives are the measure.
pub const DIFFERENCE_TOLERANCE: f64 = 1e-9;

/// A way to a reference, and how far it is trusted.
#[derive(Clone, Copy)]
struct Oracle {
    reference: Reference,
    tolerance: f64,
    /// Magnitude of the numbers that go in, which round-off refers to where the result vanishes.
    floor: f64,
}

/// A block that vanishes does so in every dual part, too.
const DUAL_NUMBERS: Oracle = Oracle {
    reference: Reference::DualNumbers,
    tolerance: DUAL_TOLERANCE,
    floor: 0.0,
};

/// Ordinary cases have coordinates, speeds and parameters of about 1.
const DIFFERENCES: Oracle = Oracle {
    reference: Reference::Differences,
    tolerance: DIFFERENCE_TOLERANCE,
    floor: 1.0,
};

/// Checks a constraint definition and the drives of its measures.
///
/// # Errors
/// The first property that does not hold.
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
/// The first property that does not hold.
pub fn check_force<F: Force>(seed: u64) -> Result<(), Failure> {
    force::check::<F>(seed)
}

/// Checks all definitions that are shipped.
///
/// # Errors
/// The first property of the first definition that does not hold.
pub fn check_all(seed: u64) -> Result<(), Failure> {
    let mut checks = Checks {
        seed,
        result: Ok(()),
    };
    plane_constraints(&mut checks);
    plane_forces(&mut checks);
    checks.result
}

/// Checks what it is shown, up to the first failure.
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

/// Whether a definition relates bodies to each other, by what its spec says.
fn is_internal(spec: &Spec) -> bool {
    spec.slots.len() > 1 && !spec.parameters.iter().any(|p| p.shape == Shape::GroundLine)
}

/// `x`, `y` and rotation of a slot, by its name.
fn column_name(slots: &[&str], column: usize) -> String {
    format!(
        "{}.{}",
        slots[column / N_DOF],
        ["x", "y", "rotation"][column % N_DOF]
    )
}

/// Force and moment about the global origin of a generalised force on all slots.
fn resultant(x: &[Pose], q: &[f64]) -> Block {
    let mut sum = [0.0; N_DOF];
    for (x, q) in x.iter().zip(q.chunks(N_DOF)) {
        sum[0] += q[0];
        sum[1] += q[1];
        sum[2] += q[2] + x.x * q[1] - x.y * q[0];
    }
    Block::column(sum.to_vec())
}

/// Starts tried for one case before its requirements count as never met.
const STARTS: u64 = 20;

/// The constraint of a case, with a start where its requirements hold.
fn assembled<K: Constraint>(case: &Case) -> Result<(K, Case), Failure> {
    assemble(case, &K::SPEC.common, K::from_arguments, |k, count, x| {
        Constraint::initialise(k, x);
        (0..count).all(|r| Constraint::requirement(k, r, x))
    })
}

/// The force of a case, with a start where its requirements hold.
fn assembled_force<F: Force>(case: &Case) -> Result<(F, Case), Failure> {
    assemble(case, &F::SPEC.common, F::from_arguments, |k, count, x| {
        Force::initialise(k, x);
        (0..count).all(|r| Force::requirement(k, r, x))
    })
}

fn assemble<K>(
    case: &Case,
    spec: &Spec,
    from_arguments: impl Fn(&[crate::Argument]) -> Result<K, crate::ArgumentError>,
    initialise: impl Fn(&mut K, usize, &[Pose]) -> bool,
) -> Result<(K, Case), Failure> {
    let mut element = from_arguments(&case.arguments).map_err(|e| {
        fact(
            spec.name,
            Property::Arguments,
            e.to_string(),
            [0.0, 1.0],
            Some(case),
        )
    })?;
    // One number beyond the requirements: it must hold too.
    let count = spec.requirements.len() + 1;
    let mut case = case.clone();
    for attempt in 0..STARTS {
        if initialise(&mut element, count, &case.start) {
            return Ok((element, case));
        }
        case = case.with_another_start(attempt);
    }
    let entry = format!("none of {STARTS} starts meets {:?}", spec.requirements);
    Err(fact(
        spec.name,
        Property::Requirements,
        entry,
        [0.0, 1.0],
        Some(&case),
    ))
}
