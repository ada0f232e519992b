//! Common parts of all properties: references and their accuracy, elements at a start.

use super::block::Block;
use super::case::Case;
use super::failure::{Failure, Property, Reference, fact};
use crate::constraint::Constraint;
use crate::definition::Definition;
use crate::force::Force;
use crate::plane::{N_DOF, Pose};
use crate::spec::{Shape, Spec};

/// For dual numbers and identities: both sides have the round-off of some ten operations, about
/// 1e-15, times up to 1e3 if coordinates or angles are that large.
pub const DUAL_TOLERANCE: f64 = 1e-12;

/// For differences: the best step loses about a third of the digits of a first derivative, and
/// extrapolation recovers most of them; the limit is that of second derivatives.
pub const DIFFERENCE_TOLERANCE: f64 = 1e-9;

/// A method for a reference, and its accuracy.
#[derive(Clone, Copy)]
pub(super) struct Oracle {
    pub(super) reference: Reference,
    pub(super) tolerance: f64,
    /// Size of the input numbers, relative to which round-off is measured if the result vanishes.
    pub(super) floor: f64,
}

/// If a block vanishes, so does every dual part.
pub(super) const DUAL_NUMBERS: Oracle = Oracle {
    reference: Reference::DualNumbers,
    tolerance: DUAL_TOLERANCE,
    floor: 0.0,
};

/// Ordinary cases have coordinates, speeds and parameters of about 1.
pub(super) const DIFFERENCES: Oracle = Oracle {
    reference: Reference::Differences,
    tolerance: DIFFERENCE_TOLERANCE,
    floor: 1.0,
};

/// Whether a definition relates bodies to each other according to its specification.
pub(super) fn is_internal(spec: &Spec) -> bool {
    spec.slots.len() > 1 && !spec.parameters.iter().any(|p| p.shape == Shape::GroundLine)
}

/// The name of a column: `x`, `y` or rotation of a slot.
pub(super) fn column_name(slots: &[&str], column: usize) -> String {
    format!(
        "{}.{}",
        slots[column / N_DOF],
        ["x", "y", "rotation"][column % N_DOF]
    )
}

/// Force and moment about the global origin of a generalised force on all slots.
pub(super) fn resultant(x: &[Pose], q: &[f64]) -> Block {
    let mut sum = [0.0; N_DOF];
    for (x, q) in x.iter().zip(q.chunks(N_DOF)) {
        sum[0] += q[0];
        sum[1] += q[1];
        sum[2] += q[2] + x.x * q[1] - x.y * q[0];
    }
    Block::column(sum.to_vec())
}

/// Number of starts tried for one case before its requirements count as never satisfied.
const STARTS: u64 = 20;

/// The constraint of a case, with a start that satisfies its requirements.
pub(super) fn assembled<K: Constraint>(case: &Case) -> Result<(K, Case), Failure> {
    assemble(case, &K::SPEC.common, K::from_arguments)
}

/// The force of a case, with a start that satisfies its requirements.
pub(super) fn assembled_force<F: Force>(case: &Case) -> Result<(F, Case), Failure> {
    assemble(case, &F::SPEC.common, F::from_arguments)
}

fn assemble<K: Definition>(
    case: &Case,
    spec: &Spec,
    from_arguments: impl Fn(&[crate::Argument]) -> Result<K, crate::ArgumentError>,
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
    let mut case = case.clone();
    for attempt in 0..STARTS {
        element.initialise(&case.start);
        // Includes one number beyond the requirements, which must hold too.
        let mut all = 0..=spec.requirements.len();
        if all.all(|k| element.requirement(k, &case.start)) {
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
