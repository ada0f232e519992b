//! Independent rows of C and of Φq alone for a simulation, and the consistency of the other rows
//! with the independent rows. At the start, the independent rows are those of the certificate.
//! During the motion, other rows are chosen in `f64` at the same rank.

use std::borrow::Cow;
use std::sync::Arc;

use crate::error::AnalysisError;
use crate::limits::{MOTION_CLEARANCE, ONE_ROUNDING, ROWS_MAX, SPARSE_FROM};
use crate::pose::{
    decide, decide_dropping, decide_holonomic, dimensionless, evaluated, uncertainty,
};
use linalg::{DdMatrix, Matrix};
use model::start::scene_size;
use model::{ConfigurationAccuracy, Layout, Mechanism, Scratch, System};
use rank::{
    Doubt, Evidence, KeptRowsError, NEARLY_REDUNDANT, NEARLY_SINGULAR, NearlyRedundant,
    RankDecision, RankStatus,
};

use crate::certificate::{self, inseparable};
use crate::existence::{Contradiction, Ranks, contradictions};
use crate::parts::{Extent, ListedRows, Partition};
use crate::row_decision::RowDecision;
use crate::sparse::decide_some;
use crate::state::{StateError, check_configuration, check_state};

/// Rows of C, and of Φq alone, decided at one configuration, part by part. The simulation, the
/// verdicts and the texts all use these decisions.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Decision on all rows of C. The decision may be undecided although the rank is certified. The
    /// decision is undecided if the matrix is too close to another rank for a simulation in `f64`.
    pub all: RowDecision,
    /// Decision on the rows of Φq alone.
    pub holonomic: RowDecision,
    pub(crate) parts: Vec<DecidedPart>,
    /// The decisions at the first of several starts ([`Rows::carried`]). `None` at this start.
    first: Option<Arc<Self>>,
    /// Whether the decisions are those of the first start.
    pub(crate) are_carried: bool,
}

/// The decisions of a part.
#[derive(Clone, Debug)]
pub(crate) struct DecidedPart {
    pub(crate) extent: Extent,
    all: RowDecision,
    holonomic: RowDecision,
    /// Certified decisions on all rows and on the holonomic rows. `None` in a part that is decided
    /// with sparse matrices.
    pub(crate) certified: Option<Box<[RankDecision; 2]>>,
    /// C at a configuration refined in double-double. `None` if it was not refined.
    pub(crate) refined: Option<DdMatrix>,
}

impl DecidedPart {
    fn of(part: &Mechanism, t: f64, q: &[f64], extent: Extent) -> Result<Self, AnalysisError> {
        let layout = part.layout();
        if layout.rows() > ROWS_MAX {
            let s = evaluated(part, t, q);
            let all = decide_some(part, &s, q, 0..layout.rows())?;
            let holonomic = match layout.h {
                0 => (&all).into(),
                _ => (&decide_some(part, &s, q, 0..layout.m)?).into(),
            };
            return Ok(Self {
                extent,
                all: (&all).into(),
                holonomic,
                certified: None,
                refined: None,
            });
        }
        let rows = certificate::UncertainRows::new(part, t, q, ConfigurationAccuracy::AsStored)?;
        let all = rows.decide()?;
        let holonomic = match layout.h {
            0 => all.clone(),
            _ => rows.select(&(0..layout.m).collect::<Vec<_>>()).decide()?,
        };
        let certified = Box::new([all, holonomic]);
        let [all, holonomic] = in_double(&certified, part, &evaluated(part, t, q), q);
        Ok(Self {
            extent,
            all: (&all).into(),
            holonomic: (&holonomic).into(),
            certified: Some(certified),
            refined: rows.extended,
        })
    }

    /// Carries the decisions to another configuration, see [`Rows::carried`].
    fn carried(&self, whole: &Mechanism, t: f64, q: &[f64]) -> Option<Self> {
        let certified = self.certified.as_deref()?;
        let (part, q) = (self.extent.mechanism(whole), self.extent.coordinates(q));
        let s = evaluated(&part, t, &q);
        let c = dimensionless(&part, &s, scene_size(&part, &q));
        let [all, holonomic] = in_double(certified, &part, &s, &q);
        let all = clearly_carried(&all, &c)?;
        let holonomic = match part.layout().h {
            0 => all.clone(),
            _ => {
                let first: Vec<usize> = (0..part.layout().m).collect();
                clearly_carried(&holonomic, &c.select_rows(&first))?
            }
        };
        Some(Self {
            extent: self.extent.clone(),
            all: (&all).into(),
            holonomic: (&holonomic).into(),
            certified: Some(Box::new([all, holonomic])),
            refined: None,
        })
    }
}

/// Carries a decision to the dimensionless rows C at another configuration. Returns `None` if the
/// kept rows are nearly redundant there, or could be [`inseparable`].
fn clearly_carried(decision: &RankDecision, c: &Matrix) -> Option<RankDecision> {
    let carried = rank::carried(decision, c)?;
    let scaling = &carried.scaling;
    let largest = |i: usize| c.row(i).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let rows = carried.kept.iter();
    let rows = rows.map(|&i| scaling.row_factor(i) * largest(i));
    let columns = scaling.cols.iter().map(|&e| f64::from(e).exp2());
    // σ of rows with largest entry 1 and unscaled columns is at least σ_r divided by this factor.
    let factor = rows.fold(0.0, f64::max) * columns.fold(0.0, f64::max);
    let required = NEARLY_REDUNDANT.max(NEARLY_SINGULAR * factor);
    (carried.evidence.sigma_r >= required).then_some(carried)
}

/// Returns the certified decisions if they are valid for `f64` numbers at the configuration of the
/// scratch. Velocities and residuals of a motion are accurate to the rounding of its coordinates.
fn in_double(
    certified: &[RankDecision; 2],
    part: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> [RankDecision; 2] {
    let known = uncertainty(part, s, scene_size(part, q));
    certified.each_ref().map(|decision| {
        let rows: Vec<usize> = (0..decision.rank + decision.redundancy).collect();
        let known = ONE_ROUNDING * decision.scaling.apply(&known.select_rows(&rows)).max_abs();
        let entries = (rows.len() * decision.scaling.cols.len()) as f64;
        let tolerance = rank::NOISE_FACTOR * known.max(f64::EPSILON * entries.sqrt());
        // The rank is the rank of the certificate, but `f64` may be too inaccurate for a simulation
        // with this rank.
        let required = (MOTION_CLEARANCE * tolerance).max(NEARLY_SINGULAR);
        let sigma = decision.evidence.sigma_r;
        let status = match decision.status {
            RankStatus::Decided if sigma < required => {
                let values = decision.evidence.singular_values.iter();
                RankStatus::Undecided(Doubt::NoClearGap {
                    lower: values.filter(|sigma| **sigma >= required).count(),
                    upper: decision.rank,
                    sigma,
                    tolerance,
                    required,
                })
            }
            status => status,
        };
        let evidence = Evidence {
            certificate: None,
            tolerance: decision.evidence.tolerance.max(tolerance),
            ..decision.evidence.clone()
        };
        RankDecision {
            evidence,
            status,
            ..decision.clone()
        }
    })
}

/// Decides the rows at time t and coordinates q, which satisfy the constraints.
///
/// # Errors
/// Returns the same errors as [`crate::analyse`].
pub fn rows(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<Rows, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    let parts = Partition::of(mechanism, t, q).map(mechanism, |part, extent| {
        DecidedPart::of(part, t, &extent.coordinates(q), extent)
    })?;
    Ok(Rows::of(parts, false))
}

/// Returns rank and independent rows of C alone, at the configuration of the scratch.
///
/// # Errors
/// Returns an error if C is not finite.
pub fn decide_rows(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RowDecision, AnalysisError> {
    of_small_and_large(mechanism, s, q, decide, Layout::rows)
}

/// Returns rank and independent rows of Φq alone.
///
/// # Errors
/// Returns an error if C is not finite.
pub fn decide_holonomic_rows(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RowDecision, AnalysisError> {
    of_small_and_large(mechanism, s, q, decide_holonomic, |layout| layout.m)
}

/// Decides small parts with `small`, and the first rows of large parts with sparse matrices.
fn of_small_and_large(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    small: fn(&Mechanism, &Scratch, &[f64]) -> Result<RankDecision, AnalysisError>,
    first: fn(&Layout) -> usize,
) -> Result<RowDecision, AnalysisError> {
    of_parts(mechanism, s, q, |part, s, q, _| {
        if part.layout().rows() > SPARSE_FROM {
            Ok((&decide_some(part, s, q, 0..first(part.layout()))?).into())
        } else {
            Ok((&small(part, s, q)?).into())
        }
    })
}

/// Returns rank and independent rows of C with the given redundant rows (`dropped`, from 0).
///
/// # Errors
/// Returns the same errors as [`decide_dropping`].
pub fn decide_rows_dropping(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    dropped: &[usize],
) -> Result<RowDecision, KeptRowsError> {
    let rows = mechanism.layout().rows();
    if let Some(&row) = dropped.iter().find(|&&row| row >= rows) {
        return Err(KeptRowsError::RowOutOfRange { row, rows });
    }
    let listed = ListedRows::new(dropped);
    let found = of_parts(mechanism, s, q, |part, s, q, extent| {
        let found = decide_dropping(part, s, q, &extent.own_rows(&listed));
        found.map(|d| (&d).into()).map_err(|e| match e {
            KeptRowsError::Duplicate { row } => KeptRowsError::Duplicate {
                row: extent.row(row),
            },
            other => other,
        })
    });
    found.map_err(|e| told_of_whole(e, dropped, || decide_rows(mechanism, s, q)))
}

/// Returns independent rows among the first `count` rows, for a rank that was decided at the start.
/// Within a stated tolerance, more rows may be redundant than in the matrix. The caller passes the
/// redundant rows in `dropped`; otherwise the function chooses them. The function does not support
/// sparse matrices.
///
/// # Errors
/// Returns the same errors as [`decide_dropping`].
pub fn rows_of_rank(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    count_and_rank: (usize, usize),
    dropped: Option<&[usize]>,
) -> Result<RowDecision, KeptRowsError> {
    Ok((&decide_of_rank(mechanism, s, q, count_and_rank, dropped)?).into())
}

/// Works like [`rows_of_rank`], and also returns the dependencies of the redundant rows. Each
/// dependency is the nearest combination of independent rows.
///
/// # Errors
/// Returns the same errors as [`decide_dropping`].
pub fn decide_of_rank(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    (count, rank): (usize, usize),
    dropped: Option<&[usize]>,
) -> Result<RankDecision, KeptRowsError> {
    let size = scene_size(mechanism, q);
    let first: Vec<usize> = (0..count).collect();
    let c = dimensionless(mechanism, s, size).select_rows(&first);
    let known = uncertainty(mechanism, s, size).select_rows(&first);
    Ok(match dropped {
        Some(dropped) => rank::dropping_of_rank(&c, &known, dropped, rank)?,
        None => rank::decide_of_rank(&c, &known, rank)?,
    })
}

/// Converts an error with rows of one part to the numbers of the whole mechanism. If the number of
/// dropped rows equals the redundancy of the whole mechanism, but differs from the redundancy of a
/// part, the kept rows are dependent.
pub(crate) fn told_of_whole(
    error: KeptRowsError,
    dropped: &[usize],
    whole: impl FnOnce() -> Result<RowDecision, AnalysisError>,
) -> KeptRowsError {
    let KeptRowsError::WrongCount { .. } = error else {
        return error;
    };
    let Ok(whole) = whole() else {
        return error;
    };
    let rows = whole.kept.len() + whole.dropped.len();
    if dropped.len() == whole.redundancy {
        KeptRowsError::Dependent {
            smallest_singular_value: 0.0,
            required: NEARLY_SINGULAR,
        }
    } else {
        KeptRowsError::WrongCount {
            dropped: dropped.len(),
            kept: rows - dropped.len(),
            rank: whole.rank,
            rows,
        }
    }
}

/// Merges the decisions of all parts. Each part is decided from its mechanism, scratch and
/// coordinates.
fn of_parts<E: Send>(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    decide: impl Fn(&Mechanism, &Scratch, &[f64], &Extent) -> Result<RowDecision, E> + Sync,
) -> Result<RowDecision, E> {
    let partition = Partition::at(mechanism, s);
    let parts = partition.map(mechanism, |part, extent| {
        let decision = if extent.is_whole() {
            decide(part, s, q, &extent)?
        } else {
            let q = extent.coordinates(q);
            decide(part, &evaluated(part, s.t, &q), &q, &extent)?
        };
        Ok::<_, E>((decision, extent))
    })?;
    let mut sum = RowDecision::empty();
    for (decision, extent) in parts {
        sum.add(decision, |k| extent.row(k));
    }
    sum.sort();
    Ok(sum)
}

impl Rows {
    fn of(parts: Vec<DecidedPart>, are_carried: bool) -> Self {
        let sum = |of: fn(&DecidedPart) -> &RowDecision| {
            let mut sum = RowDecision::empty();
            for part in &parts {
                sum.add(of(part).clone(), |k| part.extent.row(k));
            }
            sum.sort();
            sum
        };
        Self {
            all: sum(|part| &part.all),
            holonomic: sum(|part| &part.holonomic),
            parts,
            first: None,
            are_carried,
        }
    }

    /// Carries the decisions of the first start to time t and coordinates q of the same mechanism,
    /// which satisfy the constraints, see [`rank::carried`]. Starts in between have no influence.
    /// An analysis does not use the result and decides again.
    ///
    /// Returns `None` if the rank must be decided at q: if rows are nearly redundant there, if the
    /// rows show another rank or other parts, within stated tolerances, and in a part that is
    /// decided with sparse matrices.
    #[must_use]
    pub fn carried(self: &Arc<Self>, mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<Self> {
        let parts = &self.first().parts;
        let is_same = match Partition::of(mechanism, t, q) {
            Partition::One => parts.iter().all(|part| part.extent.is_whole()),
            Partition::Several(sets) => {
                let own = parts.iter().map(|part| part.extent.groups());
                own.eq(sets.iter().map(Vec::as_slice))
            }
        };
        if !is_same || mechanism.has_tolerances() {
            return None;
        }
        let parts = parts.iter().map(|part| part.carried(mechanism, t, q));
        Some(Self::of(parts.collect::<Option<_>>()?, true).after(Some(self)))
    }

    /// Returns these decisions as those of a start after another start of the same mechanism.
    #[must_use]
    pub fn after(self, other: Option<&Arc<Self>>) -> Self {
        Self {
            first: other.map(|other| Arc::clone(other.first())),
            ..self
        }
    }

    fn first(self: &Arc<Self>) -> &Arc<Self> {
        self.first.as_ref().unwrap_or(self)
    }

    /// Returns the certified decision on all rows with all dependencies. Returns `None` if the rows
    /// were decided in several parts, or with sparse matrices.
    #[must_use]
    pub fn whole(&self) -> Option<&RankDecision> {
        let one = self.parts.first().filter(|one| one.extent.is_whole())?;
        one.certified.as_ref().map(|both| &both[0])
    }

    /// Returns kept rows that cannot be distinguished from dependent rows in `f64`. The direction
    /// covers all rows. See [`inseparable`].
    #[must_use]
    pub fn inseparable(&self, mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<NearlyRedundant> {
        self.parts.iter().find_map(|part| {
            let [decision, _] = part.certified.as_deref()?;
            if !decision.is_decided() {
                return None;
            }
            let own_q = part.extent.coordinates(q);
            let own = part.extent.mechanism(mechanism);
            let mut found = inseparable(&own, &evaluated(&own, t, &own_q), &own_q, decision)?;
            found.direction = part
                .extent
                .spread(&found.direction, mechanism.layout().rows());
            Some(found)
        })
    }

    /// Returns whether the rank of all rows is decided, possibly only by a certificate. The kept
    /// rows are then independent, even if this cannot be shown in `f64`.
    #[must_use]
    pub fn are_certified(&self) -> bool {
        self.parts.iter().all(|part| match &part.certified {
            Some(certified) => certified[0].is_decided(),
            None => part.all.is_decided(),
        })
    }

    /// Returns redundant rows that contradict each other. The largest contradiction of a part comes
    /// first. See [`contradictions`].
    ///
    /// # Errors
    /// Returns the same errors as [`contradictions`].
    pub fn contradictions(
        &self,
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<Vec<Contradiction>, StateError> {
        check_state(mechanism, t, q, v)?;
        let mut all = Vec::new();
        for part in &self.parts {
            // For larger parts, the monitors of the simulation compare the rows.
            let Some(certified) = &part.certified else {
                continue;
            };
            if part.all.redundancy == 0 && part.holonomic.redundancy == 0 {
                continue;
            }
            let own = part.extent.mechanism(mechanism);
            let [q, v] = [part.extent.coordinates(q), part.extent.velocities(v)];
            let in_double = if self.are_carried {
                Cow::Borrowed(&**certified)
            } else {
                Cow::Owned(in_double(certified, &own, &evaluated(&own, t, &q), &q))
            };
            let ranks = Ranks {
                all: &in_double[0],
                holonomic: &in_double[1],
            };
            all.extend(contradictions(&own, t, &q, &v, ranks)?);
        }
        Ok(all)
    }
}
