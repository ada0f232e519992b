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
mod instants;
mod parts;
mod passages;
mod path;
pub mod search;
mod stretches;
mod words;

use std::sync::Mutex;

use model::{Mechanism, RowLabel, StartError, System};
use rank::Doubt;

use crate::analysis::Analysis;
use crate::mechanism::{AnalysisError, ReactionVerdict};
use crate::parts::{Extent, Partition};
use crate::second_order::Continuation;
use crate::state::{self, State, StateError};
use crate::verdict::{Judgement, Verdict};
use path::Path;

/// Verdicts along a motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Along {
    /// The verdicts that hold almost always, at an instant where they do.
    pub generic: Analysis,
    /// Stretches of time with other verdicts, in the order of time.
    pub stretches: Vec<Stretch>,
    /// Instants where something is different, in the order of time.
    pub passages: Vec<Passage>,
}

/// A stretch of the motion, between break times, on which other verdicts hold than on the rest.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Stretch {
    /// Where it begins (s).
    pub from: f64,
    /// Where it ends (s).
    pub to: f64,
    /// Degree of redundancy on it.
    pub redundancy: usize,
    /// What differs from the generic verdicts.
    pub differences: Vec<Difference>,
    /// All this in words.
    pub text: String,
}

/// An instant where something is different.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Passage {
    /// When (s).
    pub time: f64,
    /// What happens.
    pub kind: PassageKind,
    /// From when to when the smallest non-zero singular value is below 10⁻³, if it is.
    pub nearly_singular: Option<[f64; 2]>,
    /// What differs from the generic verdicts at this instant.
    pub differences: Vec<Difference>,
    /// All this in words.
    pub text: String,
}

/// What happens at an instant.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PassageKind {
    /// The rank drops.
    RankDrops {
        /// Degree of redundancy at the instant.
        redundancy: usize,
        /// How the motion goes on.
        continuation: Continuation,
    },
    /// The configuration is nearly singular; the rank stays.
    NearlySingular {
        /// The smallest non-zero singular value.
        sigma: f64,
    },
    /// The configuration is so nearly singular that it cannot be said whether the rank drops.
    Undecided {
        /// The numbers.
        doubt: Doubt,
    },
    /// Only verdicts change, the rank stays.
    Verdicts,
}

/// One verdict that differs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// Name of the joint or drive.
    pub reaction: String,
    /// Of what the verdict is.
    pub part: Part,
    /// Almost always.
    pub generic: Verdict,
    /// Here.
    pub here: Verdict,
}

/// What a verdict is of.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// The whole reaction.
    Wrench,
    /// One component of it.
    Component(&'static str),
    /// The multiplier of one row.
    Row(RowLabel),
}

/// Why a motion has no verdicts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlongError {
    /// Sample times that are no interval.
    #[error("sample times must be finite and grow, and at least two: {found} at place {index}")]
    Times {
        /// Place of the first wrong one, from 0.
        index: usize,
        /// The time there, NaN if there is none.
        found: f64,
    },
    /// A state of the motion is none.
    #[error(transparent)]
    State(#[from] StateError),
    /// A state of the motion cannot be brought onto the constraints.
    #[error("at t = {time} s the state of the motion is not on the constraints: {source}")]
    OffConstraints {
        /// When.
        time: f64,
        /// Why.
        source: StartError,
    },
    /// The constraint matrix cannot be judged.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// Too many rows are on common cycles.
    #[error(
        "{joints} are on common cycles with {rows} rows in all: a motion is judged by matrices of all of them, which is possible up to {most} rows"
    )]
    Large {
        /// The first joints and drives of the part.
        joints: String,
        /// Its rows.
        rows: usize,
        /// Rows that are possible.
        most: usize,
    },
    /// The rank is decided at no sample time.
    #[error(
        "the rank is decided at none of the sample times; at t = {time} s singular values are {sigma_r:.3e} and then {sigma_next:.3e}, \
         with a tolerance of {tolerance:.3e}"
    )]
    Undecided {
        /// The last time.
        time: f64,
        /// σ_r there, for the reading with the larger gap.
        sigma_r: f64,
        /// σ_{r+1}
        sigma_next: f64,
        /// Below it a singular value counts as zero.
        tolerance: f64,
    },
}

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
        match extent.is_whole() {
            true => whole,
            false => State {
                q: extent.coordinates(&whole.q).into_owned(),
                v: extent.velocities(&whole.v).into_owned(),
            },
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

/// First and last time, and the break times between them.
fn ends_of_pieces(mechanism: &Mechanism, first: f64, last: f64) -> Vec<f64> {
    let breaks = mechanism.layout().break_times.iter().copied();
    let inside = breaks.filter(|t| first < *t && *t < last);
    [first].into_iter().chain(inside).chain([last]).collect()
}

/// A verdict of an analysis.
struct VerdictOf<'a> {
    /// Name of the joint or drive.
    reaction: &'a str,
    place: Place,
    judgement: &'a Judgement,
    /// Whether it is that of a component which is zero under any load.
    is_zero: bool,
}

/// What a verdict is of, as [`Part`], with the number of a row.
#[derive(Clone, Copy)]
enum Place {
    Wrench,
    Component(&'static str),
    Row(usize),
}

/// Every verdict of an analysis; those of one mechanism come in the same order whatever they say.
fn verdicts<'a>(analysis: &'a Analysis) -> impl Iterator<Item = VerdictOf<'a>> {
    let of_reaction = |r: &'a ReactionVerdict| {
        let components = r.components.iter();
        let components = components.map(|c| (Place::Component(c.name), &c.judgement));
        let rows = r.rows.iter();
        let rows = rows.map(|row| (Place::Row(row.row), &row.judgement));
        std::iter::once((Place::Wrench, &r.wrench))
            .chain(components)
            .chain(rows)
            .map(move |(place, judgement)| VerdictOf {
                reaction: &r.name,
                is_zero: matches!(place, Place::Component(c) if r.zero_components.contains(&c)),
                place,
                judgement,
            })
    };
    analysis.reactions.iter().flat_map(of_reaction)
}

/// Verdicts that are not the same in two analyses of one mechanism. That a component is zero says
/// nothing of what is determined.
fn differences(mechanism: &Mechanism, generic: &Analysis, here: &Analysis) -> Vec<Difference> {
    let labels = &mechanism.layout().labels;
    let part = |place: Place| match place {
        Place::Wrench => Part::Wrench,
        Place::Component(name) => Part::Component(name),
        Place::Row(row) => Part::Row(labels[row].clone()),
    };
    let word = |v: &VerdictOf<'_>| v.judgement.verdict.word();
    verdicts(generic)
        .zip(verdicts(here))
        .filter(|(a, b)| word(a) != word(b) && !a.is_zero && !b.is_zero)
        .map(|(generic, here)| Difference {
            reaction: generic.reaction.to_owned(),
            part: part(generic.place),
            generic: generic.judgement.verdict.clone(),
            here: here.judgement.verdict.clone(),
        })
        .collect()
}
