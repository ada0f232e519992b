//! Parts of a mechanism that are analysed separately.
//!
//! Self-stresses exist only on cycles of the graph of bodies, ground and joints. Every `z` with
//! `Cᵀ·z = 0` is a sum of such vectors on single sets of [`rank::cycles`]. Therefore each set can
//! be analysed as a separate mechanism with its own evidence. The redundancy of the whole mechanism
//! is the sum of the redundancies of the sets, and no verdict depends on another set. The work is
//! linear in the number of sets.
//!
//! Each part has its own size as unit of length. Therefore margins do not depend on the length of
//! the chain to which the part belongs. Other modules analyse the parts.
//!
//! A mechanism with at most `ONE_PART` rows is a single part, even if it has several cycles.

use crate::limits::{FIRST_NAMED, ONE_PART};
use crate::pose::evaluated;
use crate::row_decision::RowDecision;
use std::borrow::Cow;

use model::words::in_same_units;
use model::{BodyRef, Mechanism, Part, Places, Scratch, System};
use rank::{Certificate, Evidence, NearlyRedundant, RankDecision, RankStatus, cycles};
use rayon::prelude::*;

use crate::freedoms::WithoutDrives;
use crate::words;

/// The joints, bodies and rows of a mechanism that belong to a part.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Extent {
    /// The whole mechanism is one part.
    Whole,
    /// The joints, bodies and rows with these indices.
    Places(Places),
}

/// Returns the entries of `x` that have the given indices. If the indices are `None`, returns all
/// entries of `x`.
fn own<'a>(x: &'a [f64], places: Option<&[usize]>) -> Cow<'a, [f64]> {
    match places {
        None => Cow::Borrowed(x),
        Some(places) => places.iter().map(|&j| x[j]).collect(),
    }
}

impl Extent {
    fn places(&self) -> Option<&Places> {
        match self {
            Self::Whole => None,
            Self::Places(places) => Some(places),
        }
    }

    /// Returns whether the part is the whole mechanism.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        *self == Self::Whole
    }

    /// Returns the index in the whole mechanism of the row that has the index `own` in the part.
    #[must_use]
    pub fn row(&self, own: usize) -> usize {
        self.places().map_or(own, |p| p.rows[own])
    }

    /// Returns the index in the part of the row that has the index `row` in the whole mechanism.
    /// Returns `None` if the row belongs to another part.
    #[must_use]
    pub fn own_row(&self, row: usize) -> Option<usize> {
        self.places()
            .map_or(Some(row), |p| p.rows.binary_search(&row).ok())
    }

    /// Returns the listed rows that belong to the part. The list contains indices of rows in the
    /// whole mechanism. The result contains the indices of the same rows in the part, in the order
    /// of the list.
    pub(crate) fn own_rows(&self, listed: &ListedRows<'_>) -> Vec<usize> {
        match self.places() {
            None => listed.rows.to_vec(),
            Some(places) => listed.among(&places.rows),
        }
    }

    /// Returns the index in the whole mechanism of the joint or drive that has the index `own` in
    /// the part.
    #[must_use]
    pub fn group(&self, own: usize) -> usize {
        self.places().map_or(own, |p| p.groups[own])
    }

    /// Returns the index in the part of the joint or drive that has the index `group` in the whole
    /// mechanism. Returns `None` if the joint or drive belongs to another part.
    #[must_use]
    pub fn own_group(&self, group: usize) -> Option<usize> {
        self.places()
            .map_or(Some(group), |p| p.groups.binary_search(&group).ok())
    }

    /// Returns the joints and drives of the part, as indices in the whole mechanism. The list is
    /// empty if the part is the whole mechanism.
    pub(crate) fn groups(&self) -> &[usize] {
        self.places().map_or(&[], |p| &p.groups)
    }

    /// Returns the index in the part of the body that has the index `body` in the whole mechanism.
    /// Returns `None` if no joint of the part acts on the body.
    #[must_use]
    pub fn own_body(&self, body: usize) -> Option<usize> {
        self.places()
            .map_or(Some(body), |p| p.bodies.binary_search(&body).ok())
    }

    /// Returns the index in the whole mechanism of the body that has the index `own` in the part.
    #[must_use]
    pub fn body(&self, own: usize) -> usize {
        self.places().map_or(own, |p| p.bodies[own])
    }

    /// Returns the coordinates of the part.
    #[must_use]
    pub fn coordinates<'a>(&self, q: &'a [f64]) -> Cow<'a, [f64]> {
        own(q, self.places().map(|p| &p.coordinates[..]))
    }

    /// Returns the velocities of the part, or other values of which there is one for each velocity.
    #[must_use]
    pub fn velocities<'a>(&self, v: &'a [f64]) -> Cow<'a, [f64]> {
        own(v, self.places().map(|p| &p.velocities[..]))
    }

    /// Returns the multipliers of the part, or other values of which there is one for each row.
    #[must_use]
    pub fn of_rows<'a>(&self, lambda: &'a [f64]) -> Cow<'a, [f64]> {
        own(lambda, self.places().map(|p| &p.rows[..]))
    }

    /// Returns a vector with one value for each of the `rows` rows of the whole mechanism. `x`
    /// contains the values of the rows of the part. The values of all other rows are zero.
    pub(crate) fn spread(&self, x: &[f64], rows: usize) -> Vec<f64> {
        let mut all = vec![0.0; rows];
        for (k, x) in x.iter().enumerate() {
            all[self.row(k)] = *x;
        }
        all
    }

    /// Returns the velocities of the whole mechanism after the velocities of the part are replaced.
    pub(crate) fn put_velocities(&self, own: &[f64], mut all: Vec<f64>) -> Vec<f64> {
        match self.places() {
            None => own.to_vec(),
            Some(places) => {
                for (&j, v) in places.velocities.iter().zip(own) {
                    all[j] = *v;
                }
                all
            }
        }
    }

    /// Returns the part as a separate mechanism.
    #[must_use]
    pub fn mechanism<'a>(&self, whole: &'a Mechanism) -> Cow<'a, Mechanism> {
        match self {
            Self::Whole => Cow::Borrowed(whole),
            Self::Places(p) => Cow::Owned(whole.part_of_groups(&p.groups).mechanism),
        }
    }

    /// Returns the name of the part, which consists of the names of its first joints and drives.
    pub(crate) fn name(&self, whole: &Mechanism) -> String {
        let groups = &whole.layout().groups;
        let count = self.places().map_or(groups.len(), |p| p.groups.len());
        let ids: Vec<_> = (0..count.min(FIRST_NAMED))
            .map(|k| model::ConstraintId(self.group(k)))
            .collect();
        let names = words::names(whole.layout(), &ids);
        match count.checked_sub(FIRST_NAMED) {
            Some(more @ 1..) => format!("{} and {more} more", names.join(", ")),
            _ => words::list(&names),
        }
    }
}

/// Rows of the whole mechanism, indexed by row number and by their position in the list of the
/// caller. With this index, the rows of each of many parts are found without a search through the
/// whole list.
pub(crate) struct ListedRows<'a> {
    rows: &'a [usize],
    /// Pairs of row and index in the list, ascending.
    by_number: Vec<(usize, usize)>,
}

impl<'a> ListedRows<'a> {
    pub(crate) fn new(rows: &'a [usize]) -> Self {
        let places = rows.iter().enumerate();
        let mut by_number: Vec<_> = places.map(|(place, &row)| (row, place)).collect();
        by_number.sort_unstable();
        Self { rows, by_number }
    }

    /// Returns indices into `own` (ascending) of the listed rows. The indices have the order of the
    /// list and are repeated if the list repeats the rows.
    fn among(&self, own: &[usize]) -> Vec<usize> {
        let mut found: Vec<(usize, usize)> = Vec::new();
        for (k, row) in own.iter().enumerate() {
            let first = self.by_number.partition_point(|(other, _)| other < row);
            let same = self.by_number[first..].iter();
            let same = same.take_while(|(other, _)| other == row);
            found.extend(same.map(|&(_, place)| (place, k)));
        }
        found.sort_unstable();
        found.into_iter().map(|(_, k)| k).collect()
    }
}

/// Analysis of a part.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PartAnalysis {
    /// Joints, bodies and rows of the part.
    pub extent: Extent,
    /// Size of the part (m), the unit of its lengths.
    pub size: f64,
    /// Rank of Φq alone.
    pub rank_holonomic: usize,
    /// Rank of Ψ alone.
    pub rank_nonholonomic: usize,
    /// Rank and redundancy of the rows without drives. `None` if the part has no drives.
    pub without_drives: Option<WithoutDrives>,
    /// Rank and independent (kept) rows of C. The rows are numbered in the part.
    pub decision: PartDecision,
    /// The proof of the rank. The proof is also present if the caller chose the redundant rows.
    pub certificate: Option<Certificate>,
    /// Independent rows that are nearly dependent. `None` for parts that are decided with sparse
    /// matrices.
    pub nearly_redundant: Option<NearlyRedundant>,
}

/// The rank of a part, decided with a dense matrix or with sparse factors.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum PartDecision {
    /// Dense decision, with the dependencies of all rows.
    Dense(Box<RankDecision>),
    /// Sparse decision.
    Sparse {
        /// Rank and independent rows.
        rows: RowDecision,
        /// Evidence for the rank.
        evidence: Box<Evidence>,
    },
}

impl PartDecision {
    /// Returns rank and independent rows.
    #[must_use]
    pub fn rows(&self) -> RowDecision {
        match self {
            Self::Dense(decision) => decision.as_ref().into(),
            Self::Sparse { rows, .. } => rows.clone(),
        }
    }

    /// Returns the rank r.
    #[must_use]
    pub fn rank(&self) -> usize {
        match self {
            Self::Dense(decision) => decision.rank,
            Self::Sparse { rows, .. } => rows.rank,
        }
    }

    /// Returns the degree of redundancy p.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        match self {
            Self::Dense(decision) => decision.redundancy,
            Self::Sparse { rows, .. } => rows.redundancy,
        }
    }

    /// Returns whether the rank is decided, or the reason why it is undecided.
    #[must_use]
    pub fn status(&self) -> RankStatus {
        match self {
            Self::Dense(decision) => decision.status,
            Self::Sparse { rows, .. } => rows.status,
        }
    }

    /// Returns the evidence for the rank.
    #[must_use]
    pub fn evidence(&self) -> &Evidence {
        match self {
            Self::Dense(decision) => &decision.evidence,
            Self::Sparse { evidence, .. } => evidence,
        }
    }

    /// Returns the decision with all dependencies, or `None` if the part was decided with sparse
    /// matrices.
    #[must_use]
    pub fn dense(&self) -> Option<&RankDecision> {
        match self {
            Self::Dense(decision) => Some(decision),
            Self::Sparse { .. } => None,
        }
    }
}

impl PartAnalysis {
    /// Returns the number of rows of the part.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.decision.rank() + self.decision.redundancy()
    }

    /// Returns whether the lower bound of the rank is proved.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        let proved = |c: &Certificate| c.rank_at_least == self.decision.rank();
        self.decision.status() == RankStatus::Decided
            && self.certificate.as_ref().is_some_and(proved)
    }

    /// Returns the certainty of the rank: σ_r, or a negative number if the rank is undecided.
    pub(crate) fn strength(&self) -> f64 {
        match self.decision.status() {
            RankStatus::Decided => self.decision.evidence().sigma_r,
            _ => -1.0,
        }
    }
}

/// Returns sets of joints and drives on common cycles, at the configuration of the scratch. C must
/// have been evaluated in the scratch. Each set can be analysed separately.
#[must_use]
pub fn parts(mechanism: &Mechanism, s: &Scratch) -> Vec<Vec<usize>> {
    let ground = mechanism.bodies().len();
    let layout = mechanism.layout();
    let touched = mechanism.layout().constraint_ids().map(|id| {
        let bodies = layout.groups[id.0].bodies.iter().filter_map(|b| match *b {
            BodyRef::Body(k) => Some(k),
            BodyRef::Ground => None,
        });
        bodies
            .chain(mechanism.reactions(s).acts_on_ground(id).then_some(ground))
            .collect()
    });
    let touched: Vec<Vec<usize>> = touched.collect();
    cycles(ground + 1, &touched)
}

/// Division of a mechanism into parts.
pub(crate) enum Partition {
    /// The mechanism is not divided.
    One,
    /// The mechanism is divided into these sets of joints and drives.
    Several(Vec<Vec<usize>>),
}

impl Partition {
    /// Returns the parts at time t and coordinates q.
    pub(crate) fn of(mechanism: &Mechanism, t: f64, q: &[f64]) -> Self {
        if mechanism.layout().rows() <= ONE_PART {
            Self::One
        } else {
            Self::by_cycles(mechanism, t, q)
        }
    }

    /// Returns the parts at the configuration of the scratch, in which C must have been evaluated.
    pub(crate) fn at(mechanism: &Mechanism, s: &Scratch) -> Self {
        if mechanism.layout().rows() <= ONE_PART {
            Self::One
        } else {
            Self::of_sets(mechanism, parts(mechanism, s))
        }
    }

    /// Returns the parts at time t and coordinates q, even if the mechanism is small.
    pub(crate) fn by_cycles(mechanism: &Mechanism, t: f64, q: &[f64]) -> Self {
        Self::of_sets(mechanism, parts(mechanism, &evaluated(mechanism, t, q)))
    }

    fn of_sets(mechanism: &Mechanism, sets: Vec<Vec<usize>>) -> Self {
        match sets.as_slice() {
            [] => Self::One,
            [all] if all.len() == mechanism.layout().groups.len() => Self::One,
            _ => Self::Several(sets),
        }
    }

    /// Applies `f` to each part on the `rayon` thread pool of the caller. The parts are ordered by
    /// their first joints. If several parts return errors, the function returns the error of the
    /// first of these parts.
    pub(crate) fn map<T: Send, E: Send>(
        &self,
        mechanism: &Mechanism,
        f: impl Fn(&Mechanism, Extent) -> Result<T, E> + Sync,
    ) -> Result<Vec<T>, E> {
        let sets = match self {
            Self::One => return Ok(vec![f(mechanism, Extent::Whole)?]),
            Self::Several(sets) => sets,
        };
        let of_part = |groups: &Vec<usize>| {
            let Part { mechanism, places } = mechanism.part_of_groups(groups);
            f(&mechanism, Extent::Places(places))
        };
        let each = sets.par_iter().map(in_same_units(of_part));
        let each: Vec<Result<T, E>> = each.collect();
        each.into_iter().collect()
    }
}

/// Returns the parts of a mechanism at time t and coordinates q that contain dropped rows. Each
/// item is a part as a mechanism, and the number of its dropped rows.
pub(crate) fn open_parts<'m>(
    mechanism: &'m Mechanism,
    (t, q): (f64, &[f64]),
    dropped: &[usize],
) -> Vec<(Extent, Cow<'m, Mechanism>, usize)> {
    let all = match Partition::of(mechanism, t, q) {
        Partition::One => vec![(Extent::Whole, Cow::Borrowed(mechanism))],
        Partition::Several(sets) => {
            let part = |groups: Vec<usize>| {
                let part = mechanism.part_of_groups(&groups);
                (Extent::Places(part.places), Cow::Owned(part.mechanism))
            };
            sets.into_iter().map(part).collect()
        }
    };
    let counted = all.into_iter().map(|(extent, own)| {
        let is_own = |row: &&usize| extent.own_row(**row).is_some();
        let redundancy = dropped.iter().filter(is_own).count();
        (extent, own, redundancy)
    });
    counted.filter(|(.., redundancy)| *redundancy > 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sketch::{Kind, door};
    use joints::space3::Pose;

    #[test]
    fn a_part_is_named_by_its_first_three_joints() {
        for (hinges, name) in [
            (2, "`H0` and `H1`"),
            (3, "`H0`, `H1` and `H2`"),
            (4, "`H0`, `H1`, `H2` and 1 more"),
            (9, "`H0`, `H1`, `H2` and 6 more"),
        ] {
            let (mechanism, ..) = door(&vec![Kind::Revolute; hinges], Pose::GROUND).judged();
            assert_eq!(Extent::Whole.name(&mechanism), name);
        }
    }

    /// The result equals that of a search through the whole list. The rows have the order of the
    /// list, and repeated rows are repeated.
    #[test]
    fn listed_rows_of_a_part() {
        let listed = [9, 4, 7, 4, 30, 0];
        let rows = ListedRows::new(&listed);
        for own in [&[4, 7, 8][..], &[0, 1, 2, 9], &[5], &[]] {
            let places = listed.iter().filter_map(|row| own.binary_search(row).ok());
            assert_eq!(rows.among(own), places.collect::<Vec<_>>());
        }
        assert_eq!(Extent::Whole.own_rows(&rows), listed);
    }
}
