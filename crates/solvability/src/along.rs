//! Verdicts along a motion: the verdicts by time interval, the instants at which the verdicts
//! differ, and the singular configurations.
//!
//! Rank and verdicts are constant on each component of the configuration set except on a nowhere
//! dense part of it. Suppose that the functions of time of the drives are analytic between break
//! times. Rank and verdicts are then constant between break times except at isolated instants,
//! unless a whole interval of the motion lies in the exceptional part. Therefore the result for a
//! motion consists of three parts: verdicts by time interval ([`Stretches`]), special instants with
//! other verdicts, and singular configurations ([`Passage`]), at which the rank drops for an
//! instant.
//!
//! States are moved onto the constraints before any decision. An instant between two sample times
//! is found in two cases. In the first case, the smallest singular value, or the margin of a
//! component, decreases towards the instant at the sample times. In the second case, the
//! determinant of the independent rows changes its sign.

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

use model::{Mechanism, System};

use crate::parts::{Extent, Partition};
use crate::state::{self, State};
use crate::stretches::Stretches;
use path::{Detail, Path};
use stretches::ends_of_pieces;

pub use data::{
    AlongError, Difference, GenericRank, MotionAnalysis, Passage, PassageKind, Stretch,
};

/// Computes the verdicts along a motion of a mechanism. `motion` returns the state at a given time
/// and is called only for times between the first and the last sample time. The motion may be a
/// closed form or the dense output of a simulation. Break times of functions of time are sampled as
/// well.
///
/// ```
/// use joints::Revolute;
/// use model::{Body, BodyRef, Description, Joint, Mechanism};
/// use pfaff_solvability::{State, along_motion};
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
/// assert_eq!(along.generic.rank, 2);
/// assert!(along.verdicts.reactions[0].whole.of_run().is_unique());
/// assert!(along.stretches.is_empty() && along.passages.is_empty());
/// # Ok::<(), pfaff_solvability::AlongError>(())
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
) -> Result<MotionAnalysis, AlongError> {
    let motion = Mutex::new(motion);
    let of_part = |t: f64, extent: &Extent| {
        let whole = match motion.lock() {
            Ok(mut motion) => motion(t),
            // If another thread has panicked while it held the lock, its panic is propagated in
            // that thread.
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
    along_motion_of_parts(mechanism, of_part, times, None)
}

/// Works like [`along_motion`], for a motion that can return the coordinates and velocities of a
/// single part. For large mechanisms, `motion` is called often, each time for a few parts only. If
/// the simulation that computed the motion has verdicts, these verdicts are used, and the search
/// adds its special instants. Otherwise the verdicts at the sample times are used.
///
/// # Errors
/// Returns the same errors as [`along_motion`].
pub fn along_motion_of_parts(
    mechanism: &Mechanism,
    motion: impl Fn(f64, &Extent) -> State + Sync,
    times: &[f64],
    of_run: Option<&Stretches>,
) -> Result<MotionAnalysis, AlongError> {
    let times = with_break_times(mechanism, times, of_run)?;
    let first = motion(times[0], &Extent::Whole);
    state::check_state(mechanism, times[0], &first.q, &first.v)?;
    match Partition::of(mechanism, times[0], &first.q) {
        Partition::One => judged_as_one(
            mechanism,
            |t| motion(t, &Extent::Whole),
            &times,
            of_run.cloned(),
        ),
        several => parts::judged_by_parts(mechanism, motion, &times, &several, of_run),
    }
}

/// Works like [`along_motion`], for a mechanism that is a single part. The list `times` must
/// already include the break times.
fn judged_as_one(
    mechanism: &Mechanism,
    motion: impl FnMut(f64) -> State,
    times: &[f64],
    of_run: Option<Stretches>,
) -> Result<MotionAnalysis, AlongError> {
    let mut path = Path::new(mechanism, motion, times, Detail::Verdicts)?;
    let mut verdicts = of_run.unwrap_or_else(|| stretches::of_samples(&path));
    compare::look_at_samples(&mut verdicts, &path);
    let stretches = stretches::of_other_rank(&path);
    let redundancy = mechanism.layout().rows() - path.rank;
    let mut passages = Vec::new();
    let mut special = Vec::new();
    for found in passages::passages(&mut path, &stretches)? {
        let (mut passage, time) = (found.passage, found.point.t);
        let judged = path.judged(&found.point, found.decision)?;
        passage.differences = compare::differences(mechanism, &verdicts, (time, &judged));
        passage.text = words::passage(&passage, redundancy);
        passages.push(passage);
        special.push((time, judged));
    }
    passages.sort_by(|a, b| a.time.total_cmp(&b.time));
    special.extend(instants::instants(
        &mut path, &verdicts, &stretches, &passages,
    )?);
    for (time, judged) in &special {
        compare::look(&mut verdicts, (*time, judged));
    }
    verdicts.sum_up(&[]);
    Ok(MotionAnalysis {
        verdicts,
        generic: GenericRank {
            time: path.typical,
            rank: path.rank,
            redundancy,
        },
        stretches,
        passages,
    })
}

/// Finds only the singular and nearly singular configurations of a motion, without their verdicts.
/// This search takes a fraction of the time of [`along_motion`].
///
/// # Errors
/// Returns the same errors as [`along_motion`].
pub fn singular_passages(
    mechanism: &Mechanism,
    motion: impl FnMut(f64) -> State,
    times: &[f64],
) -> Result<Vec<Passage>, AlongError> {
    let times = with_break_times(mechanism, times, None)?;
    let mut path = Path::new(mechanism, motion, &times, Detail::Rank)?;
    let stretches = stretches::of_other_rank(&path);
    let found = passages::passages(&mut path, &stretches)?.into_iter();
    let redundancy = mechanism.layout().rows() - path.rank;
    let told = found.map(|found| Passage {
        text: words::passage(&found.passage, redundancy),
        ..found.passage
    });
    Ok(told.collect())
}

/// Returns the sample times and the break times between them. The function adds one time within
/// each interval between break times, and the special instants of the simulation that computed the
/// motion.
fn with_break_times(
    mechanism: &Mechanism,
    times: &[f64],
    of_run: Option<&Stretches>,
) -> Result<Vec<f64>, AlongError> {
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
    let tracks = of_run.into_iter().flat_map(Stretches::components);
    let special = tracks.flat_map(|track| track.special().iter().map(|s| s.time));
    all.extend(special.filter(|t| first <= *t && *t <= last));
    all.sort_by(f64::total_cmp);
    all.dedup();
    Ok(all)
}
