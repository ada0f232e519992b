//! Decides the rank of a mechanism with the strongest available evidence. The decision uses
//! double-double arithmetic at a configuration that is refined in double-double. The decision
//! assumes that the data are accurate to the rounding with which a scene stores them.
//!
//! A simulation does not use this decision. A simulation decides in `f64`, because a nearly
//! redundant mechanism cannot be integrated in `f64` anyway.
//!
//! The decision does not change the start of a simulation. Only rows that are certainly independent
//! are refined, to distinguish numbers that vanish from small numbers.

use crate::error::AnalysisError;
use crate::limits::{ASKED, COEFFICIENT_LARGE, NEAR_TOLD, ROWS_MAX, SAFELY, TOLERANCE_ROWS};
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

/// Dimensionless C of a mechanism, with the accuracy of its entries.
pub(crate) struct UncertainRows<'a> {
    mechanism: &'a Mechanism,
    /// Φ and C evaluated at q.
    scratch: Cow<'a, Scratch>,
    q: Cow<'a, [f64]>,
    size: f64,
    /// Numbers that the analysed rows have in the mechanism, ascending.
    places: Vec<usize>,
    uncertain: UncertainMatrix,
    /// C at a configuration refined in double-double. `None` if the refinement is not possible. The
    /// refinement is not possible if there are too many rows, or if the kept rows are dependent to
    /// the last digit of `f64`.
    pub(crate) extended: Option<DdMatrix>,
}

impl<'a> UncertainRows<'a> {
    /// Returns C in `f64` at the configuration of the scratch, whose coordinates are q.
    pub(crate) fn in_double(mechanism: &'a Mechanism, s: &'a Scratch, q: &'a [f64]) -> Self {
        Self::at(
            mechanism,
            Cow::Borrowed(s),
            q,
            ConfigurationAccuracy::AsStored,
        )
    }

    /// Returns the dimensionless C of a mechanism of this size and the accuracy of the entries of
    /// C. Both are evaluated at the configuration of the scratch, whose coordinates are q.
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

    /// Returns C in `f64` at the configuration of the scratch. The coordinates q have the given
    /// accuracy.
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

    /// Computes C at the configuration q, which satisfies the constraints to `f64`.
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

    /// Returns the size of the mechanism (m).
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Returns C rounded to `f64`.
    pub(crate) fn matrix(&self) -> Matrix {
        match &self.extended {
            Some(c) => c.hi(),
            None => self.uncertain.c.clone(),
        }
    }

    /// Returns rank, independent rows and evidence of all rows.
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
        add_nearness(&mut decision, nearness);
        Ok(decision)
    }

    /// Adds the distance of the data from one rank less to a decision on these rows. With a stated
    /// tolerance, the decision contains this distance already.
    pub(crate) fn with_nearness(&self, mut decision: RankDecision) -> RankDecision {
        let question = self.question();
        let is_certified = decision.evidence.certificate.is_some();
        if is_certified && decision.is_decided() && question.tolerance().is_none() {
            let nearness = question.nearness(decision.rank, NEAR_TOLD * self.size);
            add_nearness(&mut decision, nearness);
        }
        decision
    }

    /// Returns independent rows and evidence for a rank from another source. Returns `None` if the
    /// uncertainty of the data hides this rank. If a tolerance is stated, the rank is decided
    /// again.
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

    /// Returns a decision on these rows with other redundant rows. Rank and evidence do not change.
    pub(crate) fn dropping(
        &self,
        decision: &RankDecision,
        dropped: &[usize],
    ) -> Result<RankDecision, KeptRowsError> {
        rank::with_dropped(decision, &self.matrix(), dropped)
    }

    /// Determines how the accuracy of the data affects the rows of the dependencies. If a tolerance
    /// is stated, all of these rows are examined. Otherwise only rows that the entries of C leave
    /// undecided are examined.
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

    /// Returns the decision for a determined rank, with the evidence from double-double.
    fn certified(&self, reading: &RankReading) -> Result<RankDecision, RankError> {
        if let Some(c) = &self.extended {
            let certified = certify_rank(c, &self.uncertain.uncertainty, reading)?;
            if let Some(mut decision) = certified {
                // A force or lever arm that counts as zero is zero only within the accuracy of the
                // data.
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

    /// Returns whether the kept rows are nearly dependent in the scaling of the bodies (rotations
    /// times the arm of the body), at the configuration of the scratch. Equilibration does not show
    /// a near dependency, because it may scale the only misaligned entry of a column up to norm
    /// one.
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
        // Below the resolution of `f64`, the certificate is more accurate.
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

/// Adds the smallest error of the data that would lower the rank to the certificate.
fn add_nearness(decision: &mut RankDecision, nearness: Option<Nearness>) {
    if let (Some(certificate), Some(near)) = (&mut decision.evidence.certificate, nearness) {
        certificate.lower_rank_here = Some(near.here);
        certificate.lower_rank_by_angles = near.by_angles;
        certificate.lower_rank_from = near.everywhere.is_finite().then_some(near.everywhere);
    }
}

/// Returns the combination of kept rows that is closest to zero at the configuration of the
/// scratch, if the size of the combination is below `limit`. Each row is scaled so that its largest
/// entry is 1. `c` is the dimensionless C of a mechanism of this size.
///
/// The rotations of a body have two natural units: the arm of the body, and the size of the
/// mechanism. With either unit, rows that are not parallel may look parallel. With the size of the
/// mechanism, this applies to rows of a small part of a large mechanism. With the arms, it applies
/// to rows that compare the angles of bodies of different size, because the larger body then has no
/// influence. Therefore a combination counts only if it is found with both units. The weights are
/// computed with the arms.
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

/// Returns the weakest combination of the kept rows of a matrix. Each row is scaled so that its
/// largest entry is 1.
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

/// Returns the combination of kept rows that cannot be distinguished from a dependency in `f64` at
/// the configuration of the scratch. Rotations are measured by the arms of the bodies and by the
/// size of the mechanism. C must have been evaluated at coordinates q. The rank may nevertheless be
/// decided, because equilibration scales up a column whose only entries are the misalignment. The
/// misalignment is part of the data as read. However, velocities along these rows are accurate only
/// to the rounding of the state divided by σ. The function allocates memory.
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

/// Returns the rows that can be satisfied together at configurations other than q, ascending.
/// Without a stated tolerance these are all given rows. Within a tolerance, some rows may be
/// redundant although they contradict each other at other configurations. The residuals of these
/// rows may also contradict each other at q. In this case, the function returns the kept rows.
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

/// Decides the rank of C at time t and coordinates q, which satisfy the constraints. The function
/// uses double-double if possible (up to 600 rows). The evidence then has a certificate. The
/// function allocates memory.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
pub fn certify(mechanism: &Mechanism, t: f64, q: &[f64]) -> Result<RankDecision, AnalysisError> {
    let rows = UncertainRows::new(mechanism, t, q, ConfigurationAccuracy::AsStored)?;
    Ok(rows.with_nearness(rows.decide()?))
}
