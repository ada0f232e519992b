//! Verdicts along a motion: the generic verdict, which holds almost everywhere, and the times at
//! which the verdict differs from it.
//!
//! Rank and verdicts are constant on each component of the configuration set except on a nowhere
//! dense part of it. Between break times, if the functions of time of the drives are analytic, they
//! are therefore constant except at isolated instants, unless the whole stretch of the motion lies
//! in the exceptional part. So a motion has one generic verdict, stretches between break times on
//! which another verdict holds, and passages: single instants with a different verdict.
//!
//! States are moved onto the constraints before anything is decided. An instant between two sample
//! times is found if the smallest singular value decreases towards it at the sample times, or if
//! the kept rows change their orientation.

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

/// Computes the verdicts along a motion of a mechanism. `motion` returns the state at a given time;
/// it is called only for times between the first and the last sample time. It may be a closed form
/// or the dense output of a simulation. Break times of functions of time are sampled as well.
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
/// - [`AlongError::Analysis`], [`AlongError::Undecided`]: the rank cannot be decided.
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
            // The lock is poisoned by a panic in another thread; that panic continues there.
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

/// Like [`along_motion`], for a motion that can return the coordinates and velocities of a single
/// part. For large mechanisms it is called often, each time for a few parts only.
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

/// [`along_motion`] for a mechanism that is a single part; `times` already include the break times.
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

/// Finds only the singular and nearly singular configurations of a motion: part of what
/// [`along_motion`] finds, in a fraction of its time.
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

/// Returns the sample times, the break times between them, and one time within each piece between
/// break times.
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
