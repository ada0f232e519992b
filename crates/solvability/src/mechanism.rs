//! Solvability of a mechanism at one configuration: ranks, and a verdict for every joint, drive,
//! row and direction.

use crate::limits::ROWS_MAX;
use std::ops::Range;

use linalg::Matrix;
use model::reaction::COMPONENTS;
use model::start::scene_size;
use model::{ConstraintId, Known, Mechanism, Scratch, System};
use rank::{KeptRowsError, RankDecision, RankError};

use crate::analysis::Judged;
use crate::certificate::Rows;
use crate::freedoms::WithoutDrives;
use crate::matrices::{Basis, QueryError, Solvability};
use crate::parts::{Extent, PartAnalysis, PartDecision};
use crate::state::StateError;
use crate::verdict::{Judgement, Verdict};
use crate::words;

/// Components of a planar reaction that are forces; the torque follows.
pub(crate) const TRANSLATIONS: usize = 2;

/// Columns of C that a planar body has: two translations and its rotation.
pub(crate) const COLUMNS: usize = 3;

/// The verdict of a joint or drive.
#[derive(Clone, Debug)]
pub struct ReactionVerdict {
    /// Which one.
    pub id: ConstraintId,
    /// Its name.
    pub name: String,
    /// Its scene type.
    pub kind: &'static str,
    /// The wrench: unique iff `B_X = 0`, and no component is free where a row moves no body, as
    /// between two parts of the ground.
    pub wrench: Judgement,
    /// All its multipliers: unique iff `Z_X = 0`.
    pub multipliers: Judgement,
    /// Each of its rows.
    pub rows: Vec<RowVerdict>,
    /// Each component of the reaction that is not identically zero.
    pub components: Vec<ComponentVerdict>,
    /// Those of them that are zero at this configuration under any load, as the force of an edge
    /// along itself: unique, but no finding.
    pub zero_components: Vec<&'static str>,
    /// Basis of the unique directions, in these components.
    pub unique_directions: Vec<Vec<f64>>,
    /// The same without what is zero under any load: perpendicular to the directions along which
    /// there is no reaction here. `None` if their number is undecided; there are no unique
    /// directions then either.
    pub live_directions: Option<Vec<Vec<f64>>>,
    /// The largest part of the reaction that counts as zero within the tolerance of the scene only
    /// for these to be unique; zero where none does.
    pub directions_left_out: f64,
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
    /// The largest coefficient (rows scaled) that counts as zero within the tolerance of the scene
    /// only; zero where none does.
    pub left_out: f64,
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
        source: rank::SparseRankError,
    },
    /// Rows to drop can be chosen in a part of fewer rows only.
    #[error(
        "at t = {time} s: the rows that are dropped cannot be chosen where {rows} rows share cycles; up to {max} rows they can, and elsewhere in \
         this mechanism",
        max = ROWS_MAX
    )]
    Chosen {
        /// When.
        time: f64,
        /// Rows of the part.
        rows: usize,
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
pub(crate) fn uncertainty(mechanism: &Mechanism, s: &Scratch, size: f64) -> Matrix {
    mechanism
        .dimension_scaling(size)
        .apply(&mechanism.uncertainty(s, size, Known::AsStored))
}

/// The velocities that are one without dimensions: 1 m/s for translations, and for rotations what
/// moves a point at the size of the mechanism by about as much, a power of two.
pub(crate) fn velocity_units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let scaling = mechanism.dimension_scaling(size);
    scaling.cols.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Decides the rank of C at the pose of the scratch, where Φ and C have been evaluated at
/// coordinates q.
///
/// # Errors
/// If C is not finite.
pub fn decide(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RankDecision, AnalysisError> {
    let size = scene_size(mechanism, q);
    rank::decide(
        &dimensionless(mechanism, s, size),
        &uncertainty(mechanism, s, size),
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
    rank::decide(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Holonomic rows on which a configuration may be polished.
pub(crate) fn promising_holonomic(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Vec<usize>, AnalysisError> {
    let (phi_q, known) = holonomic(mechanism, s, q);
    rank::promising_rows(&phi_q, &known).map_err(|source| AnalysisError::Rank { time: s.t, source })
}

/// Φq without dimensions, and what its entries are known to.
fn holonomic(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> (Matrix, Matrix) {
    let size = scene_size(mechanism, q);
    let rows: Vec<usize> = (0..mechanism.layout().m).collect();
    let phi_q = dimensionless(mechanism, s, size).select_rows(&rows);
    let known = uncertainty(mechanism, s, size).select_rows(&rows);
    (phi_q, known)
}

/// The same with the dropped rows given (from 0): they must be as many as the redundancy, and the
/// others independent.
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
    let known = uncertainty(mechanism, s, size);
    rank::decide_dropping(&c, &known, dropped)
}

/// Φ and C at a configuration.
pub(crate) fn evaluated(mechanism: &Mechanism, t: f64, q: &[f64]) -> Scratch {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    s
}

/// Verdicts of a mechanism that is one part, at the pose of the scratch, where Φ and C have been
/// evaluated and the rank has been decided.
pub(crate) fn judge(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &Rows,
    decision: RankDecision,
) -> Result<Judged, AnalysisError> {
    let mut found = judge_reactions(mechanism, s, rows, decision, Told::Directions)?;
    if let Some(decision) = found.part.decision.dense() {
        let open = rank::open_rows(decision);
        if !open.is_empty() {
            found.warnings.push(words::open(mechanism, &open));
        }
        let is_known = |rows: &[usize]| !rows.iter().any(|row| open.binary_search(row).is_ok());
        let circuits = rank::short_circuits(decision).into_iter();
        let dependencies = circuits
            .filter(|circuit| is_known(&circuit.rows))
            .map(|circuit| Dependency {
                text: words::describe(mechanism, &circuit),
                left_out: circuit.left_out,
                rows: circuit.rows,
                coefficients: circuit.coefficients,
            });
        found.dependencies = dependencies.collect();
        found.part.nearly_redundant = rows.nearly_redundant(mechanism, s, decision);
    }
    Ok(found)
}

/// What is told of each reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Told {
    /// The verdicts of its wrench, its components and its rows.
    Verdicts,
    /// The directions in which it is unique, too.
    Directions,
}

/// The same without dependencies, also near ones.
pub(crate) fn judge_reactions(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &Rows,
    decision: RankDecision,
    told: Told,
) -> Result<Judged, AnalysisError> {
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
        if let rank::RankStatus::Undecided(doubt) = &decision.status {
            warnings.push(format!("the rank of {what} alone is undecided: {doubt}"));
        }
        Ok::<_, AnalysisError>(decision.rank)
    };
    let rank_holonomic = rank_of("Φq", 0..layout.m)?;
    let rank_nonholonomic = rank_of("Ψ", layout.m..layout.rows())?;
    let without_drives = WithoutDrives::of(layout, rows, &solvability, &mut warnings)?;
    let reactions = mechanism
        .constraint_ids()
        .map(|id| {
            let rows = layout.groups[id.0].rows.clone();
            reaction(mechanism, id, s, solvability.basis(), rows, told)
        })
        .collect::<Result<_, _>>()
        .map_err(|source| AnalysisError::Query { time: t, source })?;
    let decision = solvability.decision().clone();
    if let rank::RankStatus::Undecided(doubt) = &decision.status {
        warnings.push(format!(
            "the rank is undecided, and with it every verdict: {doubt}"
        ));
    }
    Ok(Judged {
        part: PartAnalysis {
            extent: Extent::Whole,
            size: rows.size(),
            rank_holonomic,
            rank_nonholonomic,
            without_drives,
            nearly_redundant: None,
            certificate: decision.evidence.certificate.clone(),
            decision: PartDecision::Dense(Box::new(decision)),
        },
        reactions,
        dependencies: Vec::new(),
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
    told: Told,
) -> Result<ReactionVerdict, QueryError> {
    let group = &mechanism.layout().groups[id.0];
    let components = group.components();
    let full = mechanism.wrench_map(id, s);
    let map = Matrix::from_fn(components.len(), rows.len(), |i, j| {
        full[(components[i], j)]
    });
    let forces = components.iter().filter(|&&c| c < TRANSLATIONS).count();
    let mapped = basis.mapped(&map, rows.clone())?.with_forces(forces);
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
    let unique_directions = match told {
        Told::Verdicts => None,
        Told::Directions => match mapped.unique_directions() {
            Err(QueryError::Rank(_) | QueryError::Directions { .. }) => None,
            known => Some(known?),
        },
    };
    let live_directions = unique_directions
        .as_deref()
        .map(|unique| mapped.live_directions(unique));
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
        unique_directions: unique_directions.unwrap_or_default(),
        directions_left_out: match live_directions {
            Some(_) => mapped.directions_left_out()?,
            None => 0.0,
        },
        live_directions,
    })
}
