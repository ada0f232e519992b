//! Verdicts along a motion: one that holds almost always, and what is different where.
//!
//! Rank and verdicts are constant on each component of the configuration set except on a nowhere
//! dense part of it. Where the laws of drives are analytic, between break times, they are therefore
//! constant except at isolated instants, or the whole stretch of the motion stays in the special
//! part. So a motion has one generic verdict, stretches between break times where another one
//! holds, and passages: instants with their times.
//!
//! States are brought onto the constraints before anything is decided. An instant that falls
//! between two sample times is seen if the smallest singular value falls towards it at these times,
//! or if the kept rows change their orientation.

mod border;
mod compare;
mod data;
mod instants;
mod parts;
mod passages;
mod path;
pub mod search;
mod stretches;
mod words;

use std::sync::Mutex;

use model::Mechanism;

use crate::parts::{Extent, Partition};
use crate::state::{self, State};
use path::Path;
use stretches::ends_of_pieces;

pub use data::{Along, AlongError, Difference, Part, Passage, PassageKind, Stretch};

/// Verdicts along a motion of a mechanism, which `motion` gives at any time between the first and
/// the last sample time, and only there: a closed form, or the dense output of a simulation. Break
/// times of functions of time are sampled too.
///
/// ```
/// use joints::Revolute;
/// use model::{Body, BodyRef, Description, Joint, Mechanism};
/// use solvability::{State, along_motion};
/// // A pendulum has nothing singular.
/// let pendulum = Description {
///     bodies: vec![Body { name: "bob".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
///     joints: vec![Joint::new(
///         "pivot",
///         &[BodyRef::Ground, BodyRef::Body(0)],
///         Revolute { s_i: [0.0, 0.0], s_j: [0.0, 2.0] },
///     )],
///     ..Description::default()
/// };
/// let mechanism = Mechanism::build(&pendulum).unwrap();
/// let turning = |t: f64| State {
///     q: vec![2.0 * t.sin(), -2.0 * t.cos(), t],
///     v: vec![2.0 * t.cos(), 2.0 * t.sin(), 1.0],
/// };
/// let along = along_motion(&mechanism, turning, &[0.0, 0.5, 1.0])?;
/// assert_eq!(along.generic.decision.rank, 2);
/// assert!(along.stretches.is_empty() && along.passages.is_empty());
/// # Ok::<(), solvability::AlongError>(())
/// ```
///
/// # Errors
/// - [`AlongError::Times`], [`AlongError::State`]: bad input.
/// - [`AlongError::OffConstraints`]: no configuration on the constraints is near a state.
/// - [`AlongError::Analysis`], [`AlongError::Undecided`]: no rank can be read.
/// - [`AlongError::Large`]: too many joints are on common cycles.
pub fn along_motion(
    mechanism: &Mechanism,
    motion: impl FnMut(f64) -> State + Send,
    times: &[f64],
) -> Result<Along, AlongError> {
    let motion = Mutex::new(motion);
    let of_part = |t: f64, extent: &Extent| {
        let whole = match motion.lock() {
            Ok(mut motion) => motion(t),
            // By a panic elsewhere, which goes on there.
            Err(poisoned) => poisoned.into_inner()(t),
        };
        if extent.is_whole() {
            whole
        } else {
            State {
                q: extent.coordinates(&whole.q).into_owned(),
                v: extent.velocities(&whole.v).into_owned(),
            }
        }
    };
    along_motion_of_parts(mechanism, of_part, times)
}

/// The same of a motion that can be asked for the coordinates and velocities of single parts: of
/// large mechanisms it is asked often, and for few of them.
///
/// # Errors
/// As [`along_motion`].
pub fn along_motion_of_parts(
    mechanism: &Mechanism,
    motion: impl Fn(f64, &Extent) -> State + Sync,
    times: &[f64],
) -> Result<Along, AlongError> {
    let times = with_break_times(mechanism, times)?;
    let first = motion(times[0], &Extent::Whole);
    state::check(mechanism, times[0], &first.q, &first.v)?;
    match Partition::of(mechanism, times[0], &first.q) {
        Partition::One => judged_as_one(mechanism, |t| motion(t, &Extent::Whole), &times),
        several => parts::judged_by_parts(mechanism, motion, &times, &several, &first),
    }
}

/// The same of a mechanism that is one part, at these times, break times included.
fn judged_as_one(
    mechanism: &Mechanism,
    motion: impl FnMut(f64) -> State,
    times: &[f64],
) -> Result<Along, AlongError> {
    let mut path = Path::new(mechanism, motion, times)?;
    let (generic, stretches) = stretches::stretches(&path);
    let mut passages = passages::passages(&mut path, &generic, &stretches)?;
    passages.extend(instants::instants(
        &mut path, &generic, &stretches, &passages,
    )?);
    passages.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(Along {
        generic: path.complete(generic.time)?,
        stretches,
        passages,
    })
}

/// The singular and nearly singular configurations of a motion alone: part of what [`along_motion`]
/// finds, in a fraction of its time.
///
/// # Errors
/// As [`along_motion`].
pub fn singular_passages(
    mechanism: &Mechanism,
    motion: impl FnMut(f64) -> State,
    times: &[f64],
) -> Result<Vec<Passage>, AlongError> {
    let times = with_break_times(mechanism, times)?;
    let mut path = Path::new(mechanism, motion, &times)?;
    let (generic, stretches) = stretches::stretches(&path);
    passages::passages(&mut path, &generic, &stretches)
}

/// Sample times, break times between them, and one time within each piece between break times.
fn with_break_times(mechanism: &Mechanism, times: &[f64]) -> Result<Vec<f64>, AlongError> {
    let wrong = |index: usize| {
        let grows = index == 0 || times[index] > times[index - 1];
        !(times[index].is_finite() && grows)
    };
    if let Some(index) = (0..times.len()).find(|&k| wrong(k)) {
        let found = times[index];
        return Err(AlongError::Times { index, found });
    }
    let (Some(&first), Some(&last), true) = (times.first(), times.last(), times.len() > 1) else {
        let (index, found) = (times.len(), f64::NAN);
        return Err(AlongError::Times { index, found });
    };
    let ends = ends_of_pieces(mechanism, first, last);
    let mut all = times.to_vec();
    all.extend_from_slice(&ends);
    for piece in ends.windows(2) {
        let inside = |t: &f64| piece[0] < *t && *t < piece[1];
        if !times.iter().any(inside) {
            all.push(0.5 * (piece[0] + piece[1]));
        }
    }
    all.sort_by(f64::total_cmp);
    all.dedup();
    Ok(all)
}
