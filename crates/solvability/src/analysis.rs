//! Ranks and verdicts at one configuration of a mechanism of any size. The results of its parts are
//! combined and numbered as in the whole mechanism.

use crate::error::AnalysisError;
use crate::judged::{Dependency, PartResults, ReactionVerdict};
use crate::limits::ROWS_MAX;
use crate::pose::{decide_dropping, evaluated};
use crate::row_decision::RowDecision;
use std::borrow::Cow;
use std::sync::atomic::{AtomicUsize, Ordering};

use linalg::{Matrix, Scaling};
use model::start::scene_size;
use model::words::in_same_units;
use model::{ConfigurationAccuracy, ConstraintId, Mechanism, System, Tolerance};
use rank::{Evidence, KeptRowsError, NearlyRedundant, RankDecision};
use rayon::prelude::*;

use crate::certificate::UncertainRows;
use crate::large::judge_sparse;
use crate::mechanism::part_verdicts;
use crate::parts::{Extent, ListedRows, PartAnalysis, Partition};
use crate::rows::{decide_rows, rows as rows_of, told_of_whole};
use crate::state::check_configuration;

/// The verdicts at one configuration.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Analysis {
    /// Time of the configuration (s).
    pub time: f64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of velocities n_v.
    pub velocities: usize,
    /// Size of the mechanism (m).
    pub size: f64,
    /// Tolerance of the data for which neither the joint nor the body states a tolerance.
    pub tolerance: Tolerance,
    /// Number of holonomic rows m.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic_rows: usize,
    /// Rank of Φq alone.
    pub rank_holonomic: usize,
    /// Rank of Ψ alone.
    pub rank_nonholonomic: usize,
    /// Rank, redundancy and independent (kept) rows of C.
    pub decision: RowDecision,
    /// Independent rows that are nearly dependent. The rows belong to the part in which the rows
    /// are closest to a dependency.
    pub nearly_redundant: Option<NearlyRedundant>,
    /// Verdicts of joints and drives in the order of their rows.
    pub reactions: Vec<ReactionVerdict>,
    /// Dependencies, ordered by part, short dependencies first. The number of dependencies is the
    /// degree of redundancy, or less if more rows depend on each other than can be analysed
    /// together.
    pub dependencies: Vec<Dependency>,
    /// Further remarks for the user.
    pub warnings: Vec<String>,
    /// Parts that were analysed separately, ordered by their first joints.
    pub parts: Vec<PartAnalysis>,
}

impl Analysis {
    /// Returns the number of degrees of freedom, n_v − r.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.velocities - self.decision.rank
    }

    /// Returns the part with the least certain rank: an undecided part, or otherwise the part with
    /// the smallest σ_r. Every mechanism has such a part.
    #[must_use]
    pub fn weakest(&self) -> &PartAnalysis {
        let least = |a: &&PartAnalysis, b: &&PartAnalysis| a.strength().total_cmp(&b.strength());
        let weakest = self.parts.iter().min_by(least);
        weakest.unwrap_or_else(|| unreachable!("an analysis has a part"))
    }

    /// Returns the numbers that justify the rank of the weakest part.
    #[must_use]
    pub fn evidence(&self) -> &Evidence {
        self.weakest().decision.evidence()
    }

    /// Returns the index of the part that contains this joint or drive.
    #[must_use]
    pub fn part_of(&self, id: ConstraintId) -> Option<usize> {
        let has = |part: &PartAnalysis| part.extent.own_group(id.0).is_some();
        match self.parts.as_slice() {
            [_] => (id.0 < self.reactions.len()).then_some(0),
            parts => parts.iter().position(has),
        }
    }

    /// Returns the decision on all rows with all dependencies, assembled from the parts. Returns
    /// `None` if there are too many rows. The evidence of the decision is the evidence of the
    /// weakest part.
    #[must_use]
    pub fn whole(&self) -> Option<Cow<'_, RankDecision>> {
        if let [one] = self.parts.as_slice()
            && one.extent.is_whole()
        {
            return one.decision.dense().map(Cow::Borrowed);
        }
        let (rank, redundancy) = (self.decision.rank, self.decision.redundancy);
        if rank + redundancy > ROWS_MAX {
            return None;
        }
        let mut scaling = Scaling::identity(rank + redundancy, self.velocities);
        let mut coefficients = Matrix::zeros(redundancy, rank);
        let place = |rows: &[usize], row: usize| rows.partition_point(|&k| k < row);
        for part in &self.parts {
            let own = part.decision.dense()?;
            for (k, exponent) in own.scaling.rows.iter().enumerate() {
                scaling.rows[part.extent.row(k)] = *exponent;
            }
            for (j, &dropped) in own.dropped.iter().enumerate() {
                let j_all = place(&self.decision.dropped, part.extent.row(dropped));
                for (i, &kept) in own.kept.iter().enumerate() {
                    let i_all = place(&self.decision.kept, part.extent.row(kept));
                    coefficients[(j_all, i_all)] = own.coefficients[(j, i)];
                }
            }
        }
        Some(Cow::Owned(RankDecision {
            rank,
            redundancy,
            kept: self.decision.kept.clone(),
            dropped: self.decision.dropped.clone(),
            coefficients,
            scaling,
            evidence: Evidence {
                certificate: None,
                ..self.evidence().clone()
            },
            status: self.decision.status,
        }))
    }

    /// Combines the results of the parts.
    pub(crate) fn of(mechanism: &Mechanism, t: f64, q: &[f64], judged: Vec<PartResults>) -> Self {
        let layout = mechanism.layout();
        let mut analysis = Self {
            time: t,
            bodies: mechanism.bodies().len(),
            coordinates: layout.n_of_bodies(),
            velocities: layout.n_v,
            size: 0.0,
            tolerance: mechanism.tolerance(),
            holonomic_rows: layout.m,
            nonholonomic_rows: layout.h,
            rank_holonomic: 0,
            rank_nonholonomic: 0,
            decision: RowDecision::empty(),
            nearly_redundant: None,
            reactions: Vec::with_capacity(layout.groups.len()),
            dependencies: Vec::new(),
            warnings: Vec::new(),
            parts: Vec::with_capacity(judged.len()),
        };
        for PartResults {
            part,
            reactions,
            dependencies,
            warnings,
        } in judged
        {
            analysis.rank_holonomic += part.rank_holonomic;
            analysis.rank_nonholonomic += part.rank_nonholonomic;
            let row = |k: usize| part.extent.row(k);
            analysis.decision.add(part.decision.rows(), row);
            if let Some(nearly) = &part.nearly_redundant
                && analysis
                    .nearly_redundant
                    .as_ref()
                    .is_none_or(|other| nearly.sigma < other.sigma)
            {
                analysis.nearly_redundant = Some(NearlyRedundant {
                    sigma: nearly.sigma,
                    direction: part.extent.spread(&nearly.direction, layout.rows()),
                });
            }
            analysis.reactions.extend(reactions);
            analysis.dependencies.extend(dependencies);
            analysis.warnings.extend(warnings);
            analysis.parts.push(part);
        }
        if let [one] = analysis.parts.as_slice()
            && one.extent.is_whole()
        {
            analysis.size = one.size;
            return analysis;
        }
        analysis.size = scene_size(mechanism, q);
        analysis.decision.sort();
        analysis.reactions.sort_unstable_by_key(|r| r.id.0);
        analysis
    }
}

/// Computes the verdicts at time t and coordinates q, which must satisfy the constraints. The
/// function allocates memory.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
/// - [`AnalysisError::Large`]: joints on common cycles are too densely connected for a sparse
///   decision.
pub fn analyse(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<Analysis, AnalysisError> {
    analyse_known(mechanism, t, q, ConfigurationAccuracy::AsStored)
}

/// Works like [`analyse`], for a configuration that is less accurate than its storage format.
/// `known` states the accuracy. Every value that is zero within this accuracy counts as zero.
///
/// # Errors
/// Returns the same errors as [`analyse`].
pub fn analyse_known(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    known: ConfigurationAccuracy,
) -> Result<Analysis, AnalysisError> {
    analyse_with_progress(mechanism, t, q, known, |_| ())
}

/// Works like [`analyse_known`], but calls `progress` after each part with the number of joints
/// analysed so far. Parts run on the `rayon` thread pool of the caller. The result does not depend
/// on the number of threads.
///
/// # Errors
/// Returns the same errors as [`analyse`].
pub fn analyse_with_progress(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    known: ConfigurationAccuracy,
    progress: impl Fn(usize) + Sync,
) -> Result<Analysis, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let partition = Partition::of(mechanism, t, q);
    let judged = AtomicUsize::new(0);
    by_parts(mechanism, t, q, &partition, |part, q, _| {
        let found = judged_alone(part, t, q, known)?;
        let joints = part.layout().groups.len();
        progress(judged.fetch_add(joints, Ordering::Relaxed) + joints);
        Ok(found)
    })
}

/// Works like [`analyse_with_progress`], for ranks that have already been decided. Ranks that were
/// carried from another configuration are decided here.
///
/// # Errors
/// Returns the same errors as [`analyse`].
pub fn analyse_decided(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decided: &crate::rows::Rows,
    progress: impl Fn(usize) + Sync,
) -> Result<Analysis, AnalysisError> {
    if decided.are_carried {
        let known = ConfigurationAccuracy::AsStored;
        return analyse_with_progress(mechanism, t, q, known, progress);
    }
    check_configuration(mechanism, t, q)?;
    let done = AtomicUsize::new(0);
    let of_part = |part: &crate::rows::DecidedPart| {
        let (own, q) = (part.extent.mechanism(mechanism), part.extent.coordinates(q));
        let found = match &part.certified {
            Some(certified) => {
                let s = evaluated(&own, t, &q);
                let mut rows = UncertainRows::in_double(&own, &s, &q);
                rows.extended.clone_from(&part.refined);
                part_verdicts(&own, &s, &rows, rows.with_nearness(certified[0].clone()))?
            }
            None => judge_sparse(&own, &evaluated(&own, t, &q), &q)?,
        };
        let joints = own.layout().groups.len();
        progress(done.fetch_add(joints, Ordering::Relaxed) + joints);
        Ok(found.placed(mechanism, part.extent.clone()))
    };
    let parts = decided.parts.par_iter().map(in_same_units(of_part));
    let parts: Vec<Result<PartResults, AnalysisError>> = parts.collect();
    let judged = parts.into_iter().collect::<Result<_, _>>()?;
    Ok(Analysis::of(mechanism, t, q, judged))
}

/// Analyses each set of joints on common cycles separately, even if the mechanism is small enough
/// to be analysed as one. The verdicts do not change.
///
/// # Errors
/// Returns the same errors as [`analyse`].
pub fn analyse_by_cycles(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
) -> Result<Analysis, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let partition = Partition::by_cycles(mechanism, t, q);
    by_parts(mechanism, t, q, &partition, |part, q, _| {
        judged_alone(part, t, q, ConfigurationAccuracy::AsStored)
    })
}

/// Works like [`analyse`], but the caller chooses the redundant rows (`dropped`, from 0). The
/// dependencies express these rows by the other rows. The verdicts do not depend on this choice.
///
/// # Errors
/// Returns the same errors as [`analyse`], and [`AnalysisError::Rows`] if the motion would change
/// without these rows.
pub fn analyse_dropping(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    dropped: &[usize],
) -> Result<Analysis, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let refused = |source| AnalysisError::Rows { time: t, source };
    let rows = mechanism.layout().rows();
    if let Some(&row) = dropped.iter().find(|&&row| row >= rows) {
        return Err(refused(KeptRowsError::RowOutOfRange { row, rows }));
    }
    let partition = Partition::of(mechanism, t, q);
    let listed = ListedRows::new(dropped);
    let found = by_parts(mechanism, t, q, &partition, |part, q, extent| {
        let own = extent.own_rows(&listed);
        if part.layout().rows() > ROWS_MAX {
            let found = judged_alone(part, t, q, ConfigurationAccuracy::AsStored)?;
            // Either the analysis already drops these rows, or there are too many rows for a
            // choice.
            return if found.part.decision.rows().dropped == own {
                Ok(found)
            } else {
                Err(AnalysisError::Chosen {
                    time: t,
                    rows: part.layout().rows(),
                })
            };
        }
        let s = evaluated(part, t, q);
        let rows = UncertainRows::new(part, t, q, ConfigurationAccuracy::AsStored)?;
        let certified = rows.with_nearness(rows.decide()?);
        // Within a stated tolerance, the rank may differ from the rank of the matrix.
        let decision = if part.has_tolerances() {
            rows.dropping(&certified, &own)
        } else {
            decide_dropping(part, &s, q, &own)
        };
        let decision = decision.map_err(|e| {
            refused(match e {
                KeptRowsError::Duplicate { row } => KeptRowsError::Duplicate {
                    row: extent.row(row),
                },
                other => other,
            })
        })?;
        let same = certified.is_decided() && certified.rank == decision.rank;
        let mut found = part_verdicts(part, &s, &rows, decision)?;
        found.part.certificate = certified.evidence.certificate.filter(|_| same);
        Ok(found)
    });
    found.map_err(|e| match e {
        AnalysisError::Rows { time, source } => AnalysisError::Rows {
            time,
            source: told_of_whole(source, dropped, || {
                if mechanism.has_tolerances() {
                    Ok(rows_of(mechanism, t, q)?.all)
                } else {
                    decide_rows(mechanism, &evaluated(mechanism, t, q), q)
                }
            }),
        },
        other => other,
    })
}

fn by_parts(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    partition: &Partition,
    judge: impl Fn(&Mechanism, &[f64], &Extent) -> Result<PartResults, AnalysisError> + Sync,
) -> Result<Analysis, AnalysisError> {
    let judged = partition.map(mechanism, |part, extent| {
        let found = judge(part, &extent.coordinates(q), &extent)?;
        Ok::<_, AnalysisError>(found.placed(mechanism, extent))
    })?;
    Ok(Analysis::of(mechanism, t, q, judged))
}

/// Analyses a part separately.
fn judged_alone(
    part: &Mechanism,
    t: f64,
    q: &[f64],
    known: ConfigurationAccuracy,
) -> Result<PartResults, AnalysisError> {
    if part.layout().rows() <= ROWS_MAX {
        let rows = UncertainRows::new(part, t, q, known)?;
        let decision = rows.with_nearness(rows.decide()?);
        part_verdicts(part, &evaluated(part, t, q), &rows, decision)
    } else {
        judge_sparse(part, &evaluated(part, t, q), q)
    }
}
