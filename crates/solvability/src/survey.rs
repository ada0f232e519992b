//! Verdicts of large mechanisms, cycle by cycle.
//!
//! Self-stresses live on cycles of the graph of bodies, ground and joints: every `z` with `Cᵀ·z = 0` is a sum of such vectors on single
//! sets of [`linalg::cycles`]. So each set is a small mechanism that can be judged alone, by [`analyse`], with all the evidence that it has; the
//! redundancy of the whole is the sum of theirs, and no verdict depends on any other set. The work is linear in their number.
//!
//! Each part is measured by its own size: margins do not depend on how long the chain is in which it stands. One large part, as a lattice, is
//! judged by random combinations of its left null space.

use std::sync::atomic::{AtomicUsize, Ordering};

use linalg::{Evidence, NearlyRedundant, RankStatus, cycles};
use model::{BodyRef, ConstraintId, Mechanism, Places, Scratch, System};
use rayon::prelude::*;

use crate::certificate::ROWS_MAX;
use crate::large::judge_sparse;
use crate::mechanism::{Analysis, AnalysisError, Dependency, ReactionVerdict, analyse, evaluated};
use crate::rows::RowDecision;
use crate::state::check_configuration;

/// Mechanisms of more rows are better judged by parts: matrices of all rows and columns cost memory with the square of their number, and time with
/// its cube.
pub const LARGE: usize = ROWS_MAX;

/// The verdicts of a mechanism, part by part.
#[derive(Clone, Debug)]
#[non_exhaustive]
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
#[non_exhaustive]
pub struct SurveyedPart {
    /// Where it is.
    pub places: Places,
    /// Ranks and verdicts; rows and joints are those of the whole, but those of decision and evidence are its own.
    pub verdicts: PartVerdicts,
}

/// What is known of a part.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PartVerdicts {
    /// Size of the part (m): its lengths are dimensionless by this.
    pub size: f64,
    /// Rank of Φq alone.
    pub rank_holonomic: usize,
    /// Rank of Ψ alone.
    pub rank_nonholonomic: usize,
    /// Rank, redundancy and kept rows of C.
    pub rows: RowDecision,
    /// The numbers behind them.
    pub evidence: Evidence,
    /// Kept rows that are independent, but only just; in large parts nothing is said of them.
    pub nearly_redundant: Option<NearlyRedundant>,
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionVerdict>,
    /// As many as the degree of redundancy, short ones first; fewer where large sets of rows depend on each other.
    pub dependencies: Vec<Dependency>,
    /// What else the reader should know.
    pub warnings: Vec<String>,
}

impl From<Analysis> for PartVerdicts {
    fn from(analysis: Analysis) -> Self {
        Self {
            size: analysis.size,
            rank_holonomic: analysis.rank_holonomic,
            rank_nonholonomic: analysis.rank_nonholonomic,
            rows: (&analysis.decision).into(),
            evidence: analysis.decision.evidence,
            nearly_redundant: analysis.nearly_redundant,
            reactions: analysis.reactions,
            dependencies: analysis.dependencies,
            warnings: analysis.warnings,
        }
    }
}

impl Survey {
    /// r = rank C
    #[must_use]
    pub fn rank(&self) -> usize {
        self.sum(|a| a.rows.rank)
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
        self.sum(|a| a.rows.redundancy)
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
            let decision = &part.verdicts.rows;
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
        let strength = |part: &SurveyedPart| match part.verdicts.rows.status {
            RankStatus::Decided => part.verdicts.evidence.sigma_r,
            _ => -1.0,
        };
        let parts = self.parts.iter();
        parts.min_by(|a, b| strength(a).total_cmp(&strength(b)))
    }

    /// The verdicts of all joints and drives, in the order of their rows.
    #[must_use]
    pub fn reactions(&self) -> Vec<&ReactionVerdict> {
        let of_part = |part: &'_ SurveyedPart| part.verdicts.reactions.len();
        let mut all: Vec<&ReactionVerdict> =
            Vec::with_capacity(self.parts.iter().map(of_part).sum());
        all.extend(self.parts.iter().flat_map(|part| &part.verdicts.reactions));
        all.sort_unstable_by_key(|r| r.id.0);
        all
    }

    /// What the reader should know of single parts.
    pub fn warnings(&self) -> impl Iterator<Item = &String> {
        self.parts.iter().flat_map(|part| &part.verdicts.warnings)
    }

    /// As many minimal dependencies as the degree of redundancy, part by part.
    pub fn dependencies(&self) -> impl Iterator<Item = &Dependency> {
        self.parts
            .iter()
            .flat_map(|part| &part.verdicts.dependencies)
    }

    fn sum(&self, of: impl Fn(&PartVerdicts) -> usize) -> usize {
        self.parts.iter().map(|part| of(&part.verdicts)).sum()
    }
}

/// Verdicts at time t and coordinates q, which must satisfy the constraints; allocates. After each part `progress` is told how many joints are judged.
/// Parts are judged on the threads of the pool of `rayon` from which this is called; the result does not depend on them.
///
/// # Errors
/// As [`analyse`].
pub fn survey(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    progress: impl Fn(usize) + Sync,
) -> Result<Survey, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let s = evaluated(mechanism, t, q);
    let layout = mechanism.layout();
    let judged = AtomicUsize::new(0);
    let parts = parts(mechanism, &s).into_par_iter().map(|groups| {
        let part = mechanism.part_of_groups(&groups);
        let own: Vec<f64> = part.places.coordinates.iter().map(|&j| q[j]).collect();
        let mut verdicts = judged_alone(&part.mechanism, t, &own)?;
        rename(&mut verdicts, &part.places);
        progress(judged.fetch_add(groups.len(), Ordering::Relaxed) + groups.len());
        Ok::<_, AnalysisError>(SurveyedPart {
            places: part.places,
            verdicts,
        })
    });
    // The first error by order of the parts, whoever was quicker.
    let parts: Vec<_> = parts.collect();
    Ok(Survey {
        time: t,
        bodies: mechanism.bodies().len(),
        coordinates: layout.n_q,
        velocities: layout.n_v,
        holonomic_rows: layout.m,
        nonholonomic_rows: layout.h,
        parts: parts.into_iter().collect::<Result<_, _>>()?,
    })
}

/// A part by itself.
fn judged_alone(part: &Mechanism, t: f64, q: &[f64]) -> Result<PartVerdicts, AnalysisError> {
    match part.layout().rows() <= LARGE {
        true => analyse(part, t, q).map(Into::into),
        false => judge_sparse(part, &evaluated(part, t, q), q),
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
fn rename(verdicts: &mut PartVerdicts, places: &Places) {
    for reaction in &mut verdicts.reactions {
        reaction.id = ConstraintId(places.groups[reaction.id.0]);
        for row in &mut reaction.rows {
            row.row = places.rows[row.row];
        }
    }
    for dependency in &mut verdicts.dependencies {
        for row in &mut dependency.rows {
            *row = places.rows[*row];
        }
    }
}
