//! The rank of a mechanism with the strongest available evidence: decided in double-double at a
//! configuration polished in double-double, for data that are accurate to the rounding with which a
//! scene stores them.
//!
//! Not for the motion: a run decides in `f64`, because a nearly redundant mechanism cannot be
//! integrated in `f64` anyway.

use crate::error::AnalysisError;
use crate::limits::{ASKED, COEFFICIENT_LARGE, ROWS_MAX, SAFELY, TOLERANCE_ROWS};
use crate::pose::{dimensionless, evaluated, promising_holonomic};
use std::borrow::Cow;

use linalg::{DdMatrix, Matrix};
use model::start::scene_size;
use model::{ConfigurationAccuracy, Mechanism, PolishedConfiguration, Scratch, System};
use rank::{
    Grounds, KeptRowsError, NEARLY_REDUNDANT, NEARLY_SINGULAR, NearlyRedundant, RankDecision,
    RankError, RankReading, WeakestCombination, certify_rank,
};

use crate::numerical_rank::{Nearness, Question, Reading, UncertainMatrix};
use crate::state::check_configuration;

/// C of a mechanism without dimensions, with the accuracy of its entries.
pub(crate) struct UncertainRows<'a> {
    mechanism: &'a Mechanism,
    /// Φ and C evaluated at q.
    scratch: Cow<'a, Scratch>,
    q: Cow<'a, [f64]>,
    size: f64,
    /// Numbers of the analysed rows in the mechanism, ascending.
    places: Vec<usize>,
    uncertain: UncertainMatrix,
    /// C at a configuration polished in double-double. `None` if that does not help: there are too
    /// many rows, or the kept rows are dependent to the last digit of `f64`.
    extended: Option<DdMatrix>,
}

impl<'a> UncertainRows<'a> {
    /// C at the pose of the scratch, in `f64`; q are its coordinates.
    pub(crate) fn in_double(mechanism: &'a Mechanism, s: &'a Scratch, q: &'a [f64]) -> Self {
        Self::at(
            mechanism,
            Cow::Borrowed(s),
            q,
            ConfigurationAccuracy::AsStored,
        )
    }

    /// C without dimensions of a mechanism of this size, and the accuracy of its entries, both
    /// evaluated at the pose of the scratch, whose coordinates are q.
    pub(crate) fn of_matrix(
        mechanism: &'a Mechanism,
        (s, q, size): (&'a Scratch, &'a [f64], f64),
        c: &Matrix,
        uncertainty: &Matrix,
    ) -> Self {
        Self::of_uncertain(
            mechanism,
            (Cow::Borrowed(s), q, size),
            UncertainMatrix::of(mechanism, c.clone(), uncertainty.clone()),
        )
    }

    /// C at the pose of the scratch, in `f64`, for coordinates q that are known like this.
    pub(crate) fn at(
        mechanism: &'a Mechanism,
        scratch: Cow<'a, Scratch>,
        q: &'a [f64],
        known: ConfigurationAccuracy,
    ) -> Self {
        let size = scene_size(mechanism, q);
        let uncertain = UncertainMatrix::new(mechanism, &scratch, size, known);
        Self::of_uncertain(mechanism, (scratch, q, size), uncertain)
    }

    fn of_uncertain(
        mechanism: &'a Mechanism,
        (scratch, q, size): (Cow<'a, Scratch>, &'a [f64], f64),
        uncertain: UncertainMatrix,
    ) -> Self {
        Self {
            uncertain,
            places: (0..mechanism.layout().rows()).collect(),
            mechanism,
            scratch,
            q: Cow::Borrowed(q),
            size,
            extended: None,
        }
    }

    /// C at the configuration q, which satisfies the constraints to `f64`.
    pub(crate) fn new(
        mechanism: &'a Mechanism,
        t: f64,
        q: &'a [f64],
        known: ConfigurationAccuracy,
    ) -> Result<Self, AnalysisError> {
        check_configuration(mechanism, t, q)?;
        let scratch = Cow::Owned(evaluated(mechanism, t, q));
        let mut rows = Self::at(mechanism, scratch, q, known);
        if mechanism.layout().rows() <= ROWS_MAX && rows.uncertain.c.first_non_finite().is_none() {
            let kept = promising_holonomic(mechanism, &rows.scratch, q)?;
            if let Ok(polished) = PolishedConfiguration::at(mechanism, t, q, &kept) {
                let c = polished
                    .c
                    .scaled(&mechanism.layout().dimension_scaling(rows.size));
                rows.extended = Some(rows.uncertain.extended(c));
            }
        }
        Ok(rows)
    }

    /// Size of the mechanism (m).
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// C rounded to `f64`.
    pub(crate) fn matrix(&self) -> Matrix {
        match &self.extended {
            Some(c) => c.hi(),
            None => self.uncertain.c.clone(),
        }
    }

    /// Rank, kept rows and evidence of all rows.
    pub(crate) fn decide(&self) -> Result<RankDecision, AnalysisError> {
        let failed = |source| AnalysisError::Rank {
            time: self.scratch.t,
            source,
        };
        if self.uncertain.c.first_non_finite().is_some() {
            return rank::decide(&self.uncertain.c, rank::Accuracy::Rounding).map_err(failed);
        }
        let question = self.question();
        let Reading {
            rank: reading,
            nearness,
            has_tolerance,
        } = self.uncertain.read(&question);
        let mut decision = self.certified(&reading).map_err(failed)?;
        if self.places.len() <= TOLERANCE_ROWS {
            self.know_rows(&question, &mut decision, has_tolerance);
        }
        Ok(with_nearness(decision, nearness))
    }

    /// Kept rows and evidence for a rank that is known otherwise; `None` if the uncertainty of the
    /// data hides it. Where a tolerance is stated, the rank is decided again.
    pub(crate) fn of_rank(&self, rank: usize) -> Result<Option<RankDecision>, AnalysisError> {
        let is_finite = self.uncertain.c.first_non_finite().is_none();
        if !is_finite || self.question().tolerance().is_some() {
            return self.decide().map(Some);
        }
        let Some(reading) = self.uncertain.of_rank(rank) else {
            return Ok(None);
        };
        let failed = |source| AnalysisError::Rank {
            time: self.scratch.t,
            source,
        };
        let mut decision = self.certified(&reading).map_err(failed)?;
        if self.places.len() <= TOLERANCE_ROWS {
            self.know_rows(&self.question(), &mut decision, false);
        }
        Ok(Some(decision))
    }

    fn question(&self) -> Question<'_> {
        Question {
            mechanism: self.mechanism,
            s: &self.scratch,
            q: &self.q,
            places: &self.places,
            size: self.size,
        }
    }

    /// A decision on these rows with other dropped rows; its rank and evidence stay.
    pub(crate) fn dropping(
        &self,
        decision: &RankDecision,
        dropped: &[usize],
    ) -> Result<RankDecision, KeptRowsError> {
        rank::with_dropped(decision, &self.matrix(), dropped)
    }

    /// Determines how the accuracy of the data affects the rows of the dependencies: all of these
    /// rows if a tolerance is stated, otherwise only rows that the entries of C leave undecided.
    fn know_rows(&self, question: &Question<'_>, decision: &mut RankDecision, has_tolerance: bool) {
        let t = decision.equilibrated_dependence();
        let is_open = |row: usize| -> bool {
            let Ok(k) = decision.kept.binary_search(&row) else {
                return false;
            };
            let noise = decision.row_noise(row);
            let column = (0..t.nrows()).map(|j| t[(j, k)].abs());
            column
                .into_iter()
                .any(|x| (SAFELY * noise..COEFFICIENT_LARGE).contains(&x))
        };
        let rows = 0..decision.rank + decision.redundancy;
        let asked: Vec<usize> = rows.filter(|&i| has_tolerance || is_open(i)).collect();
        if asked.is_empty() || !has_tolerance && asked.len() * decision.redundancy > ASKED {
            return;
        }
        let scaled = decision.scaling.apply(&self.uncertain.c);
        let known = question.rows_within_data(&scaled, decision, &asked);
        let turns = has_tolerance.then(|| question.turns(&scaled, decision));
        if let Some(certificate) = &mut decision.evidence.certificate {
            certificate.row_data = Some(known);
            certificate.row_turn = turns;
            certificate.has_tolerance = has_tolerance;
        }
        if has_tolerance {
            let open = question.open_rows(&scaled, decision);
            if let Some(certificate) = &mut decision.evidence.certificate {
                certificate.open_rows = open;
            }
        }
    }

    /// The decision for a rank that has been read, with the evidence from double-double.
    fn certified(&self, reading: &RankReading) -> Result<RankDecision, RankError> {
        if let Some(c) = &self.extended {
            let certified = certify_rank(c, &self.uncertain.uncertainty, reading)?;
            if let Some(mut decision) = certified {
                // A force or lever arm that counts as zero is zero within the accuracy of the data
                // only.
                if let Some(certificate) = &mut decision.evidence.certificate
                    && certificate.grounds == Grounds::Vanishes
                    && self.uncertain.has_zeros()
                {
                    certificate.grounds = Grounds::WithinData;
                }
                return Ok(decision);
            }
        }
        let c = DdMatrix::from(&self.uncertain.c);
        match certify_rank(&c, &self.uncertain.uncertainty, reading)? {
            Some(decision) => Ok(decision),
            None => rank::decide(&self.uncertain.c, &self.uncertain.uncertainty),
        }
    }

    /// Whether the kept rows nearly depend on each other in the scaling of the bodies (rotations
    /// times the arm of the body), at the pose of the scratch. Equilibration does not show this: it
    /// may scale the only misaligned entry of a column up to size one.
    pub(crate) fn nearly_redundant(
        &self,
        mechanism: &Mechanism,
        s: &Scratch,
        decision: &RankDecision,
    ) -> Option<NearlyRedundant> {
        if !decision.is_decided() {
            return None;
        }
        let of_size = (self.size, &self.matrix());
        let physical = weakest_below(NEARLY_REDUNDANT, mechanism, s, of_size, decision);
        // Below the resolution of `f64` the certificate is more accurate.
        let certified = decision.nearly_redundant().cloned();
        [physical, certified]
            .into_iter()
            .flatten()
            .min_by(|a, b| a.sigma.total_cmp(&b.sigma))
    }

    /// Selects some of the rows, ascending.
    pub(crate) fn select(&self, rows: &[usize]) -> Self {
        Self {
            mechanism: self.mechanism,
            scratch: self.scratch.clone(),
            q: self.q.clone(),
            size: self.size,
            places: rows.iter().map(|&k| self.places[k]).collect(),
            uncertain: self.uncertain.select(rows),
            extended: self.extended.as_ref().map(|c| c.select_rows(rows)),
        }
    }
}

/// Adds to the certificate by how much the data would have to be wrong for a lower rank.
fn with_nearness(mut decision: RankDecision, nearness: Option<Nearness>) -> RankDecision {
    if let (Some(certificate), Some(near)) = (&mut decision.evidence.certificate, nearness) {
        certificate.lower_rank_here = Some(near.here);
        certificate.lower_rank_by_angles = near.by_angles;
        certificate.lower_rank_from = near.everywhere.is_finite().then_some(near.everywhere);
    }
    decision
}

/// The combination of kept rows that comes closest to zero at the pose of the scratch, if it does
/// so to less than `limit`, with each row scaled to largest entry 1. `c` is C without dimensions
/// for a mechanism of this size.
///
/// The rotations of a body have two natural units: the arm of the body, and the size of the
/// mechanism. Each makes rows parallel that are not: the size, those of a small part of a large
/// mechanism; the arms, those that compare the angles of bodies of different size, in which the
/// larger body then takes no part. So both have to show the combination. The weights are those by
/// the arms.
fn weakest_below(
    limit: f64,
    mechanism: &Mechanism,
    s: &Scratch,
    (size, c): (f64, &Matrix),
    decision: &RankDecision,
) -> Option<NearlyRedundant> {
    let is_below = |weakest: &WeakestCombination| weakest.sigma < limit;
    let felt = mechanism.scales(s).felt_scaling(size).apply(c);
    let weakest = weakest_kept(&felt, decision).filter(is_below)?;
    weakest_kept(c, decision).filter(is_below)?;
    let mut direction = vec![0.0; decision.rank + decision.redundancy];
    for (&row, weight) in decision.kept.iter().zip(weakest.weights) {
        direction[row] = weight;
    }
    Some(NearlyRedundant {
        sigma: weakest.sigma,
        direction,
    })
}

/// The weakest combination of the kept rows of a matrix, each scaled to largest entry 1.
fn weakest_kept(c: &Matrix, decision: &RankDecision) -> Option<WeakestCombination> {
    let mut kept = c.select_rows(&decision.kept);
    for i in 0..kept.nrows() {
        let largest = kept.row(i).iter().fold(0.0_f64, |a, c| a.max(c.abs()));
        if largest > 0.0 {
            kept.row_mut(i).iter_mut().for_each(|c| *c /= largest);
        }
    }
    rank::weakest_combination(&kept)
}

/// Returns the combination of kept rows that cannot be distinguished from a dependence in `f64` at
/// the pose of the scratch, with rotations measured by the arms of the bodies and by the size of
/// the mechanism; C must have been evaluated at coordinates q. The rank may be decided
/// nevertheless, because equilibration scales up a column whose only entries are the misalignment.
/// The misalignment is part of the data as read, but velocities along these rows are accurate only
/// to the rounding of the state divided by σ. Allocates.
#[must_use]
pub fn inseparable(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    decision: &RankDecision,
) -> Option<NearlyRedundant> {
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, s, size);
    weakest_below(NEARLY_SINGULAR, mechanism, s, (size, &c), decision)
}

/// Those of these rows that can hold together away from q, ascending: all of them, unless a
/// tolerance is stated. Within it some may be redundant although they contradict each other at
/// other configurations, as they do at q by their misfits; then those are returned that are kept.
pub(crate) fn holding_together(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    rows: Vec<usize>,
) -> Vec<usize> {
    if !mechanism.has_tolerances() || mechanism.layout().rows() > ROWS_MAX {
        return rows;
    }
    let s = evaluated(mechanism, t, q);
    match UncertainRows::in_double(mechanism, &s, q)
        .select(&rows)
        .decide()
    {
        Ok(decision) if decision.is_decided() => decision.kept.iter().map(|&k| rows[k]).collect(),
        _ => rows,
    }
}

/// Decides the rank of C at time t and coordinates q, which satisfy the constraints. Uses
/// double-double if possible (up to 600 rows); the evidence then has a certificate. Allocates.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
pub fn certify(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<RankDecision, AnalysisError> {
    UncertainRows::new(mechanism, t, q, ConfigurationAccuracy::AsStored)?.decide()
}
