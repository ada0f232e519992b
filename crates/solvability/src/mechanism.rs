//! Solvability of a mechanism at one configuration: ranks, and a verdict for every joint, drive, row and direction.

use std::ops::Range;

use linalg::{KeptRowsError, Matrix, NearlyRedundant, RankDecision, RankError};
use model::reaction::COMPONENTS;
use model::start::scene_size;
use model::{ConstraintId, Known, Mechanism, Scratch, System};

use crate::certificate::Rows;
use crate::matrices::{Basis, QueryError, Solvability};
use crate::state::{StateError, check_configuration};
use crate::verdict::{Judgement, Verdict};
use crate::words;

/// The verdicts of one configuration.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Time of the configuration (s).
    pub time: f64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of velocities n_v.
    pub velocities: usize,
    /// Size of the mechanism (m): its lengths are dimensionless by this.
    pub size: f64,
    /// Number of holonomic rows m.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic_rows: usize,
    /// Rank of Φq alone.
    pub rank_holonomic: usize,
    /// Rank of Ψ alone.
    pub rank_nonholonomic: usize,
    /// Rank, redundancy, kept rows and evidence of C.
    pub decision: RankDecision,
    /// Kept rows that are independent, but only just.
    pub nearly_redundant: Option<NearlyRedundant>,
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionVerdict>,
    /// As many as the degree of redundancy, short ones first.
    pub dependencies: Vec<Dependency>,
    /// What else the reader should know.
    pub warnings: Vec<String>,
}

impl Analysis {
    /// Freedoms of motion: n_v − r.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.velocities - self.decision.rank
    }
}

/// The verdict of a joint or drive.
#[derive(Clone, Debug)]
pub struct ReactionVerdict {
    /// Which one.
    pub id: ConstraintId,
    /// Its name.
    pub name: String,
    /// Its scene type.
    pub kind: &'static str,
    /// The wrench: unique iff `B_X = 0`, and no component is free where a row moves no body, as between two parts of the ground.
    pub wrench: Judgement,
    /// All its multipliers: unique iff `Z_X = 0`.
    pub multipliers: Judgement,
    /// Each of its rows.
    pub rows: Vec<RowVerdict>,
    /// Each component of the reaction that is not identically zero.
    pub components: Vec<ComponentVerdict>,
    /// Those of them that are zero at this configuration under any load, as the force of an edge along itself: unique, but no finding.
    pub zero_components: Vec<&'static str>,
    /// Basis of the unique directions, in these components.
    pub unique_directions: Vec<Vec<f64>>,
    /// The same without what is zero under any load: perpendicular to the directions along which there is no reaction here.
    pub live_directions: Vec<Vec<f64>>,
}

/// The verdict of one row.
#[derive(Clone, Debug)]
pub struct RowVerdict {
    /// Row of C, from 0.
    pub row: usize,
    /// Its multiplier.
    pub judgement: Judgement,
}

/// The verdict of one component of a reaction.
#[derive(Clone, Debug)]
pub struct ComponentVerdict {
    /// `Fx`, `Fy` or `T`.
    pub name: &'static str,
    /// Its verdict.
    pub judgement: Judgement,
}

/// A minimal set of dependent rows.
#[derive(Clone, Debug)]
pub struct Dependency {
    /// Rows of C, from 0.
    pub rows: Vec<usize>,
    /// `Σ coefficient·row = 0`, the largest coefficient 1.
    pub coefficients: Vec<f64>,
    /// What it means.
    pub text: String,
}

/// Why no analysis can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnalysisError {
    /// Time or coordinates are none of this mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// The constraint matrix cannot be judged.
    #[error("at t = {time} s: {source}")]
    Rank {
        /// When.
        time: f64,
        /// Why.
        source: RankError,
    },
    /// Joints that share cycles are too many for the rank of their rows.
    #[error("at t = {time} s: {rows} rows share cycles: {source}")]
    Large {
        /// When.
        time: f64,
        /// Their rows.
        rows: usize,
        /// Why.
        source: linalg::SparseRankError,
    },
    /// A verdict cannot be asked for.
    #[error("at t = {time} s: {source}")]
    Query {
        /// When.
        time: f64,
        /// Why.
        source: QueryError,
    },
    /// The rows asked to be dropped cannot be.
    #[error("at t = {time} s these rows cannot be dropped: {source}")]
    Rows {
        /// When.
        time: f64,
        /// Why; rows are counted from 0 here.
        source: KeptRowsError,
    },
}

/// C without dimensions, for a mechanism of this size.
pub(crate) fn dimensionless(mechanism: &Mechanism, s: &Scratch, size: f64) -> Matrix {
    mechanism
        .dimension_scaling(size)
        .apply(&mechanism.layout().dense(s))
}

/// What the entries of [`dimensionless`] C are known to in `f64`.
pub(crate) fn uncertainty(mechanism: &Mechanism, s: &Scratch, q: &[f64], size: f64) -> Matrix {
    mechanism
        .dimension_scaling(size)
        .apply(&mechanism.uncertainty(s, q, size, Known::AsStored))
}

/// The velocities that are one without dimensions: 1 m/s for translations, and for rotations what moves a point at the size of the
/// mechanism by about as much, a power of two.
pub(crate) fn velocity_units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let scaling = mechanism.dimension_scaling(size);
    scaling.cols.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Decides the rank of C at the pose of the scratch, where Φ and C have been evaluated at coordinates q.
///
/// # Errors
/// If C is not finite.
pub fn decide(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RankDecision, AnalysisError> {
    let size = scene_size(mechanism, q);
    linalg::decide(
        &dimensionless(mechanism, s, size),
        &uncertainty(mechanism, s, q, size),
    )
    .map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// The same for the holonomic rows alone: which rows of Φ hold the configuration.
///
/// # Errors
/// If C is not finite.
pub fn decide_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RankDecision, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    linalg::decide(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Holonomic rows on which a configuration may be polished.
pub(crate) fn promising_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Vec<usize>, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    linalg::promising_rows(&phi_q, &known)
        .map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Φq without dimensions, and what its entries are known to.
fn holonomic(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> (Matrix, Matrix) {
    let size = scene_size(mechanism, q);
    let rows: Vec<usize> = (0..mechanism.layout().m).collect();
    let phi_q = dimensionless(mechanism, s, size).select_rows(&rows);
    let known = uncertainty(mechanism, s, q, size).select_rows(&rows);
    (phi_q, known)
}

/// The same with the dropped rows given (from 0): they must be as many as the redundancy, and the others independent.
///
/// # Errors
/// If they are not, or C is not finite.
pub fn decide_dropping(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    dropped: &[usize],
) -> Result<RankDecision, KeptRowsError> {
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, s, size);
    let known = uncertainty(mechanism, s, q, size);
    linalg::decide_dropping(&c, &known, dropped)
}

/// Verdicts at time t and coordinates q, which must satisfy the constraints; allocates.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
pub fn analyse(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<Analysis, AnalysisError> {
    analyse_known(mechanism, t, q, Known::AsStored)
}

/// The same at a configuration that is known to less than it is stored with; what is zero to that is zero.
///
/// # Errors
/// As [`analyse`].
pub fn analyse_known(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    known: Known,
) -> Result<Analysis, AnalysisError> {
    let rows = Rows::new(mechanism, t, q, known)?;
    let decision = rows.decide()?;
    judge(mechanism, &evaluated(mechanism, t, q), &rows, decision)
}

/// The same with dependencies told by the dropped rows that the caller chooses (from 0). Verdicts do not depend on them.
///
/// # Errors
/// As [`analyse`], and [`AnalysisError::Rows`]: the rows cannot be dropped without changing the motion.
pub fn analyse_dropping(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    dropped: &[usize],
) -> Result<Analysis, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let s = evaluated(mechanism, t, q);
    let decision = decide_dropping(mechanism, &s, q, dropped)
        .map_err(|source| AnalysisError::Rows { time: t, source })?;
    judge(
        mechanism,
        &s,
        &Rows::new(mechanism, t, q, Known::AsStored)?,
        decision,
    )
}

/// Φ and C at a configuration.
pub(crate) fn evaluated(mechanism: &Mechanism, t: f64, q: &[f64]) -> Scratch {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    s
}

/// Verdicts at the pose of the scratch, where Φ and C have been evaluated and the rank has been decided.
pub(crate) fn judge(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &Rows,
    decision: RankDecision,
) -> Result<Analysis, AnalysisError> {
    let layout = mechanism.layout();
    let t = s.t;
    let solvability = Solvability::from_decision(&rows.matrix(), decision);
    let mut warnings = Vec::new();
    let mut rank_of = |what: &str, part: std::ops::Range<usize>| {
        // What is nothing or everything needs no decision of its own.
        if part.is_empty() {
            return Ok(0);
        }
        if part == (0..layout.rows()) {
            return Ok(solvability.decision().rank);
        }
        if let Some(rank) = solvability.basis().rank_of(part.clone()) {
            return Ok(rank);
        }
        let decision = rows.select(&part.collect::<Vec<_>>()).decide()?;
        if let linalg::RankStatus::Undecided(doubt) = &decision.status {
            warnings.push(format!("the rank of {what} alone is undecided: {doubt}"));
        }
        Ok::<_, AnalysisError>(decision.rank)
    };
    let rank_holonomic = rank_of("Φq", 0..layout.m)?;
    let rank_nonholonomic = rank_of("Ψ", layout.m..layout.rows())?;
    let reactions = mechanism
        .constraint_ids()
        .map(|id| {
            let rows = layout.groups[id.0].rows.clone();
            reaction(mechanism, id, s, solvability.basis(), rows)
        })
        .collect::<Result<_, _>>()
        .map_err(|source| AnalysisError::Query { time: t, source })?;
    let dependencies = linalg::short_circuits(solvability.decision())
        .into_iter()
        .map(|circuit| Dependency {
            text: words::describe(mechanism, &circuit),
            rows: circuit.rows,
            coefficients: circuit.coefficients,
        })
        .collect();
    let decision = solvability.decision().clone();
    if let linalg::RankStatus::Undecided(doubt) = &decision.status {
        warnings.push(format!(
            "the rank is undecided, and with it every verdict: {doubt}"
        ));
    }
    Ok(Analysis {
        time: t,
        bodies: mechanism.bodies().len(),
        coordinates: layout.n_q,
        velocities: layout.n_v,
        size: rows.size(),
        holonomic_rows: layout.m,
        nonholonomic_rows: layout.h,
        rank_holonomic,
        rank_nonholonomic,
        nearly_redundant: rows.nearly_redundant(mechanism, s, &decision),
        decision,
        reactions,
        dependencies,
        warnings,
    })
}

/// The verdict of a joint or drive, whose rows are these of the basis.
pub(crate) fn reaction(
    mechanism: &Mechanism,
    id: ConstraintId,
    s: &Scratch,
    basis: &Basis,
    rows: Range<usize>,
) -> Result<ReactionVerdict, QueryError> {
    let group = &mechanism.layout().groups[id.0];
    let components = group.components();
    let full = mechanism.wrench_map(id, s);
    let map = Matrix::from_fn(components.len(), rows.len(), |i, j| {
        full[(components[i], j)]
    });
    let mapped = basis.mapped(&map, rows.clone())?;
    let mut zero_components = Vec::new();
    for (i, &c) in components.iter().enumerate() {
        if mapped.is_zero(i)? {
            zero_components.push(COMPONENTS[c]);
        }
    }
    let judged = components.iter().enumerate().map(|(i, &c)| {
        Ok(ComponentVerdict {
            name: COMPONENTS[c],
            judgement: mapped.component(i)?,
        })
    });
    let components = judged.collect::<Result<Vec<_>, QueryError>>()?;
    let on_bodies = basis.group(rows.clone())?;
    let free = components
        .iter()
        .find(|c| c.judgement.verdict == Verdict::NotUnique);
    let wrench = match (free, on_bodies.verdict == Verdict::Unique) {
        (Some(free), true) => free.judgement.clone(),
        _ => on_bodies,
    };
    // Where their number is undecided there are none to show; the verdicts above say so.
    let unique_directions = match mapped.unique_directions() {
        Err(QueryError::Rank(_) | QueryError::Directions { .. }) => Vec::new(),
        known => known?,
    };
    let live_directions = mapped.live_directions(&unique_directions);
    let row_verdict = |(row, own)| {
        Ok(RowVerdict {
            row,
            judgement: basis.row(own)?,
        })
    };
    Ok(ReactionVerdict {
        id,
        name: group.name.clone(),
        kind: group.spec.common.scene_type,
        wrench,
        multipliers: basis.multipliers(rows.clone())?,
        rows: (group.rows.clone().zip(rows))
            .map(row_verdict)
            .collect::<Result<_, _>>()?,
        components,
        zero_components,
        unique_directions,
        live_directions,
    })
}
