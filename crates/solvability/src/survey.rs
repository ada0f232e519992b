//! Verdicts of large mechanisms, cycle by cycle.
//!
//! Self-stresses live on cycles of the graph of bodies, ground and joints: every `z` with `Cᵀ·z = 0` is a sum of such vectors on single
//! sets of [`linalg::cycles`]. So each set is a small mechanism that can be judged alone, by [`analyse`], with all the evidence that it has; the
//! redundancy of the whole is the sum of theirs, and no verdict depends on any other set. The work is linear in their number.
//!
//! Each part is measured by its own size: margins do not depend on how long the chain is in which it stands. Not here: mechanisms of one
//! large cycle.

use linalg::{RankStatus, cycles};
use model::{BodyRef, ConstraintId, Known, Mechanism, Places, Scratch, System};

use crate::certificate::ROWS_MAX;
use crate::large::{decide_range, full_rank};
use crate::mechanism::{
    Analysis, AnalysisError, Dependency, ReactionVerdict, analyse, analyse_known, evaluated,
    judge_independent,
};
use crate::state::check_configuration;

/// Mechanisms of more rows are better judged by parts: matrices of all rows and columns cost memory with the square of their number, and time with
/// its cube.
pub const LARGE: usize = ROWS_MAX;

/// Redundant sets of more rows are not judged: dense matrices of them take minutes.
const DENSE_MOST: usize = 1500;

/// The verdicts of a mechanism, part by part.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Time of the configuration (s).
    pub time: f64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of velocities n_v.
    pub velocities: usize,
    /// Number of holonomic rows m.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic_rows: usize,
    /// Parts by their first joints. Rows and joints in them are numbered as in the whole.
    pub parts: Vec<SurveyedPart>,
}

/// Joints on common cycles, with their bodies.
#[derive(Clone, Debug)]
pub struct SurveyedPart {
    /// Where it is.
    pub places: Places,
    /// Ranks and verdicts; rows and joints are those of the whole.
    pub analysis: Analysis,
}

impl Survey {
    /// r = rank C
    #[must_use]
    pub fn rank(&self) -> usize {
        self.sum(|a| a.decision.rank)
    }

    /// Rank of Φq alone.
    #[must_use]
    pub fn rank_holonomic(&self) -> usize {
        self.sum(|a| a.rank_holonomic)
    }

    /// Rank of Ψ alone.
    #[must_use]
    pub fn rank_nonholonomic(&self) -> usize {
        self.sum(|a| a.rank_nonholonomic)
    }

    /// p = m + h − r
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.sum(|a| a.decision.redundancy)
    }

    /// Freedoms of motion: n_v − r.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.velocities - self.rank()
    }

    /// r independent rows and the p others, both ascending.
    #[must_use]
    pub fn rows(&self) -> [Vec<usize>; 2] {
        let mut rows = [Vec::new(), Vec::new()];
        for part in &self.parts {
            let decision = &part.analysis.decision;
            for (all, own) in rows.iter_mut().zip([&decision.kept, &decision.dropped]) {
                all.extend(own.iter().map(|&k| part.places.rows[k]));
            }
        }
        rows.iter_mut().for_each(|rows| rows.sort_unstable());
        rows
    }

    /// The part whose rank is least certain: undecided, or else the one with the smallest σ_r. Nothing without joints.
    #[must_use]
    pub fn weakest(&self) -> Option<&SurveyedPart> {
        let strength = |part: &SurveyedPart| match part.analysis.decision.status {
            RankStatus::Decided => part.analysis.decision.evidence.sigma_r,
            _ => -1.0,
        };
        let parts = self.parts.iter();
        parts.min_by(|a, b| strength(a).total_cmp(&strength(b)))
    }

    /// The verdicts of all joints and drives, in the order of their rows.
    #[must_use]
    pub fn reactions(&self) -> Vec<&ReactionVerdict> {
        let of_part = |part: &'_ SurveyedPart| part.analysis.reactions.len();
        let mut all: Vec<&ReactionVerdict> =
            Vec::with_capacity(self.parts.iter().map(of_part).sum());
        all.extend(self.parts.iter().flat_map(|part| &part.analysis.reactions));
        all.sort_unstable_by_key(|r| r.id.0);
        all
    }

    /// What the reader should know of single parts.
    pub fn warnings(&self) -> impl Iterator<Item = &String> {
        self.parts.iter().flat_map(|part| &part.analysis.warnings)
    }

    /// As many minimal dependencies as the degree of redundancy, part by part.
    pub fn dependencies(&self) -> impl Iterator<Item = &Dependency> {
        self.parts
            .iter()
            .flat_map(|part| &part.analysis.dependencies)
    }

    fn sum(&self, of: impl Fn(&Analysis) -> usize) -> usize {
        self.parts.iter().map(|part| of(&part.analysis)).sum()
    }
}

/// Verdicts at time t and coordinates q, which must satisfy the constraints; allocates. After each part `progress` is told how many joints are judged.
///
/// # Errors
/// As [`analyse`].
pub fn survey(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    mut progress: impl FnMut(usize),
) -> Result<Survey, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let s = evaluated(mechanism, t, q);
    let layout = mechanism.layout();
    let mut judged = 0;
    let parts = parts(mechanism, &s).into_iter().map(|groups| {
        let part = mechanism.part_of_groups(&groups);
        let own: Vec<f64> = part.places.coordinates.iter().map(|&j| q[j]).collect();
        let mut analysis = judged_alone(&part.mechanism, t, &own)?;
        rename(&mut analysis, &part.places);
        judged += groups.len();
        progress(judged);
        Ok::<_, AnalysisError>(SurveyedPart {
            places: part.places,
            analysis,
        })
    });
    Ok(Survey {
        time: t,
        bodies: mechanism.bodies().len(),
        coordinates: layout.n_q,
        velocities: layout.n_v,
        holonomic_rows: layout.m,
        nonholonomic_rows: layout.h,
        parts: parts.collect::<Result<_, _>>()?,
    })
}

/// A part by itself. A large one without redundancy has nothing to judge: all its reactions are unique.
fn judged_alone(part: &Mechanism, t: f64, q: &[f64]) -> Result<Analysis, AnalysisError> {
    let rows = part.layout().rows();
    if rows <= LARGE {
        return analyse_known(part, t, q, Known::AsStored);
    }
    let s = evaluated(part, t, q);
    let found = decide_range(part, &s, q, 0..rows)?;
    let redundancy = found.redundancy;
    match full_rank(found) {
        Some(decision) => Ok(judge_independent(part, &s, q, decision)),
        None if rows <= DENSE_MOST => analyse_known(part, t, q, Known::AsStored),
        None => Err(AnalysisError::LargeVerdicts {
            time: t,
            rows,
            redundancy,
            most: DENSE_MOST,
        }),
    }
}

/// The verdicts of all joints and drives in the order of their rows, of the whole where it is small, by parts where it is large.
///
/// # Errors
/// As [`analyse`].
pub fn verdicts(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
) -> Result<Vec<ReactionVerdict>, AnalysisError> {
    if mechanism.layout().rows() <= LARGE {
        return Ok(analyse(mechanism, t, q)?.reactions);
    }
    let found = survey(mechanism, t, q, |_| ())?;
    Ok(found.reactions().into_iter().cloned().collect())
}

/// Joints and drives that lie on common cycles, at the pose of the scratch, where C has been evaluated: sets that can be judged alone.
#[must_use]
pub fn parts(mechanism: &Mechanism, s: &Scratch) -> Vec<Vec<usize>> {
    let ground = mechanism.bodies().len();
    let layout = mechanism.layout();
    let touched = mechanism.constraint_ids().map(|id| {
        let bodies = layout.groups[id.0].bodies.iter().filter_map(|b| match *b {
            BodyRef::Body(k) => Some(k),
            BodyRef::Ground => None,
        });
        bodies
            .chain(mechanism.acts_on_ground(id, s).then_some(ground))
            .collect()
    });
    let touched: Vec<Vec<usize>> = touched.collect();
    cycles(ground + 1, &touched)
}

/// Numbers of the part become those of the whole. Rows of the decision stay those of its matrix.
fn rename(analysis: &mut Analysis, places: &Places) {
    for reaction in &mut analysis.reactions {
        reaction.id = ConstraintId(places.groups[reaction.id.0]);
        for row in &mut reaction.rows {
            row.row = places.rows[row.row];
        }
    }
    for dependency in &mut analysis.dependencies {
        for row in &mut dependency.rows {
            *row = places.rows[*row];
        }
    }
}
