//! One large set of joints on common cycles: its rank, and verdicts from random combinations of its
//! left null space.
//!
//! A joint is read from its own rows of `W = Z·Ω` alone, as it is read from those of Z in a small
//! mechanism, at a cost that does not depend on the degree of redundancy. Dependencies are told
//! where those rows that depend on others fall into small sets of cycles again.

use crate::error::AnalysisError;
use crate::judged::{Dependency, Judged, ReactionVerdict};
use crate::limits::{ROWS_MAX, SPARE_COMBINATIONS};
use crate::pose::evaluated;
use std::ops::Range;

use linalg::{Matrix, SparseMatrix, equilibrate_sparse};
use model::start::scene_size;
use model::{ConstraintId, Known, Mechanism, Scratch, System};
use rank::{Evidence, RankStatus, Sketch, SparseRank, SparseRankError, decide_sparse};

use crate::analysis::analyse;
use crate::freedoms::WithoutDrives;
use crate::matrices::{self, Basis};
use crate::mechanism::{Told, reaction};
use crate::parts::{Extent, PartAnalysis, PartDecision, parts};

/// A sparse decision of rows of C, and these rows.
struct Decided {
    /// The first of them.
    first: usize,
    /// Without dimensions.
    c: SparseMatrix,
    found: SparseRank,
}

/// Rank and kept rows of the rows of C in a range, at the pose of the scratch, where Φ and C have
/// been evaluated at coordinates q.
///
/// # Errors
/// If C is not finite, or too dense for a sparse decision.
pub(crate) fn decide_range(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    rows: Range<usize>,
) -> Result<SparseRank, AnalysisError> {
    Decided::of(mechanism, s, q, rows).map(|decided| decided.found)
}

impl Decided {
    fn of(
        mechanism: &Mechanism,
        s: &Scratch,
        q: &[f64],
        rows: Range<usize>,
    ) -> Result<Self, AnalysisError> {
        let (layout, size) = (mechanism.layout(), scene_size(mechanism, q));
        let dimensions = mechanism.layout().dimension_scaling(size);
        let unit = |j: usize| f64::from(dimensions.cols[j]).exp2();
        let c = rows_of(mechanism, s, rows.clone(), unit);
        let scaling = equilibrate_sparse(&c);
        let known = mechanism
            .scales(s)
            .uncertainty_of_entries(size, Known::AsStored);
        let pattern = &layout.pattern;
        let mut largest = 0.0_f64;
        for i in rows.clone() {
            for k in pattern.start[i]..pattern.start[i + 1] {
                let j = pattern.column[k];
                let exponent = scaling.rows[i - rows.start] + scaling.cols[j];
                largest = largest.max(known[k] * unit(j) * f64::from(exponent).exp2());
            }
        }
        let found = decide_sparse(&c, largest, &blocks(mechanism), sketch_of(mechanism)).map_err(
            |source| match source {
                SparseRankError::Rank(source) => AnalysisError::Rank { time: s.t, source },
                source => AnalysisError::Large {
                    time: s.t,
                    rows: rows.len(),
                    source,
                },
            },
        )?;
        Ok(Self {
            first: rows.start,
            c,
            found,
        })
    }

    /// What verdicts of a group of rows are read from: the rows alone.
    fn basis(&self, rows: Range<usize>) -> Basis {
        let own = rows.start - self.first..rows.end - self.first;
        let e = &self.found.evidence;
        let mut columns: Vec<usize> = own.clone().flat_map(|i| self.c.row(i).0).copied().collect();
        let entries = columns.len();
        columns.sort_unstable();
        columns.dedup();
        let scaling = &self.found.scaling;
        let mut c = Matrix::zeros(own.len(), columns.len());
        for (k, i) in own.clone().enumerate() {
            let (at, values) = self.c.row(i);
            for (j, value) in at.iter().zip(values) {
                if let Ok(l) = columns.binary_search(j) {
                    let factor = f64::from(scaling.rows[i] + scaling.cols[*j]).exp2();
                    c[(k, l)] = value * factor;
                }
            }
        }
        let w = &self.found.sketch;
        let noise = self.found.noise();
        Basis {
            c,
            z: w.select_rows(&own.clone().collect::<Vec<_>>()),
            known: matrices::Known {
                status: self.found.status,
                row_factor: own.clone().map(|i| scaling.row_factor(i)).collect(),
                row_noise: vec![noise; own.len()],
                row_rounding: Vec::new(),
                tolerance: noise,
                spread: e.uncertainty * (entries as f64).sqrt(),
                uncertainty: e.uncertainty,
                row_turn: None,
                readings: self.found.readings(),
            },
            exact: None,
        }
    }
}

/// Rows of C at the pose of the scratch, columns in these units.
pub(crate) fn rows_of(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: impl IntoIterator<Item = usize>,
    unit: impl Fn(usize) -> f64,
) -> SparseMatrix {
    let layout = mechanism.layout();
    let row = |i: usize| layout.row(s, i).map(|(j, c)| (j, c * unit(j)));
    // Columns of a pattern are below n_v.
    SparseMatrix::from_rows(layout.n_v, rows.into_iter().map(row))
        .unwrap_or_else(|e| unreachable!("columns of a pattern: {e}"))
}

/// The columns of each body.
pub(crate) fn blocks(mechanism: &Mechanism) -> Vec<Range<usize>> {
    let bodies = 0..mechanism.bodies().len();
    bodies.map(|b| mechanism.layout().columns(b)).collect()
}

/// Combinations enough for the joint of most rows, and some against chance.
pub(crate) fn sketch_of(mechanism: &Mechanism) -> Sketch {
    let groups = mechanism.layout().groups.iter();
    let most = groups.map(|group| group.rows.len()).max().unwrap_or(0);
    let default = Sketch::default();
    Sketch {
        columns: default.columns.max(most + SPARE_COMBINATIONS),
        ..default
    }
}

/// Ranks and verdicts of a large mechanism at the pose of the scratch, where Φ and C have been
/// evaluated at coordinates q.
///
/// # Errors
/// If C is not finite, or too dense for a sparse decision.
pub(crate) fn judge_sparse(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Judged, AnalysisError> {
    let layout = mechanism.layout();
    let all = Decided::of(mechanism, s, q, 0..layout.rows())?;
    let mut warnings = Vec::new();
    let mut rank_of = |what: &str, rows: Range<usize>| {
        if rows.is_empty() {
            return Ok(0);
        }
        if rows == (0..layout.rows()) {
            return Ok(all.found.rank);
        }
        let found = decide_range(mechanism, s, q, rows)?;
        if let RankStatus::Undecided(doubt) = found.status {
            warnings.push(format!("the rank of {what} alone is undecided: {doubt}"));
        }
        Ok::<_, AnalysisError>(found.rank)
    };
    let rank_holonomic = rank_of("Φq", 0..layout.m)?;
    let rank_nonholonomic = rank_of("Ψ", layout.m..layout.rows())?;
    let without_drives = without_drives(mechanism, s, q)?;
    let verdict = |id: ConstraintId| {
        let rows = layout.groups[id.0].rows.clone();
        let own = 0..rows.len();
        reaction(mechanism, id, s, &all.basis(rows), own, Told::Directions)
    };
    let reactions: Vec<ReactionVerdict> = mechanism
        .layout()
        .constraint_ids()
        .map(verdict)
        .collect::<Result<_, _>>()
        .map_err(|source| AnalysisError::Query { time: s.t, source })?;
    if let RankStatus::Undecided(doubt) = all.found.status {
        warnings.push(format!(
            "the rank is undecided, and with it every verdict: {doubt}"
        ));
    }
    let dependencies = match all.found.status {
        RankStatus::Decided if all.found.redundancy > 0 => {
            dependencies(mechanism, s, q, &reactions)?
        }
        _ => Vec::new(),
    };
    let told = dependencies.len();
    if told < all.found.redundancy && all.found.is_decided() {
        warnings.push(format!(
            "{told} of {} dependencies are told: {} rows share cycles, and more than {ROWS_MAX} of them depend on each other",
            all.found.redundancy,
            layout.rows()
        ));
    }
    Ok(Judged {
        part: PartAnalysis {
            extent: Extent::Whole,
            size: scene_size(mechanism, q),
            rank_holonomic,
            rank_nonholonomic,
            without_drives,
            decision: PartDecision::Sparse {
                rows: (&all.found).into(),
                evidence: Box::new(evidence(&all.found)),
            },
            certificate: None,
            nearly_redundant: None,
        },
        reactions,
        dependencies,
        warnings,
    })
}

/// Rank and redundancy of the joints alone, decided like all rows. `None` if there are no drives.
fn without_drives(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Option<WithoutDrives>, AnalysisError> {
    let groups = mechanism.layout().groups.iter().enumerate();
    let joints = groups.filter(|(_, group)| !group.is_drive());
    let joints: Vec<usize> = joints.map(|(k, _)| k).collect();
    if joints.len() == mechanism.layout().groups.len() {
        return Ok(None);
    }
    if joints.is_empty() {
        return Ok(Some(WithoutDrives::default()));
    }
    let part = mechanism.part_of_groups(&joints);
    let q: Vec<f64> = part.places.coordinates.iter().map(|&j| q[j]).collect();
    let rows = 0..part.mechanism.layout().rows();
    let s = evaluated(&part.mechanism, s.t, &q);
    let found = decide_range(&part.mechanism, &s, &q, rows)?;
    Ok(Some(WithoutDrives {
        rank: found.rank,
        redundancy: found.redundancy,
    }))
}

/// Minimal dependent sets of rows, where those joints that have dependent rows share small sets of
/// cycles.
fn dependencies(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    reactions: &[ReactionVerdict],
) -> Result<Vec<Dependency>, AnalysisError> {
    let dependent = reactions
        .iter()
        .filter(|r| !r.multipliers.verdict.is_unique());
    let dependent: Vec<usize> = dependent.map(|r| r.id.0).collect();
    let among = mechanism.part_of_groups(&dependent);
    let own = |q: &[f64], places: &[usize]| places.iter().map(|&j| q[j]).collect::<Vec<f64>>();
    let among_q = own(q, &among.places.coordinates);
    let among_s = evaluated(&among.mechanism, s.t, &among_q);
    let mut all = Vec::new();
    for groups in parts(&among.mechanism, &among_s) {
        let part = among.mechanism.part_of_groups(&groups);
        if part.mechanism.layout().rows() > ROWS_MAX {
            continue;
        }
        let part_q = own(&among_q, &part.places.coordinates);
        let analysis = analyse(&part.mechanism, s.t, &part_q)?;
        all.extend(analysis.dependencies.into_iter().map(|mut dependency| {
            for row in &mut dependency.rows {
                *row = among.places.rows[part.places.rows[*row]];
            }
            dependency
        }));
    }
    Ok(all)
}

/// The evidence of a sparse rank in the terms of a dense one.
fn evidence(found: &SparseRank) -> Evidence {
    let e = found.evidence;
    Evidence {
        singular_values: Vec::new(),
        sigma_r: e.sigma_r,
        sigma_next: e.sigma_next,
        gap: e.sigma_r / e.sigma_next,
        tolerance: e.tolerance,
        constraint_residual: e.uncertainty,
        dependence_residual: e.sigma_next,
        certificate: None,
    }
}
