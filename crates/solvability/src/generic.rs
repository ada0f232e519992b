//! Decides whether a redundancy is permanent or present at this configuration only. The rank is
//! constant on each connected component of the configuration set except on a nowhere dense part of
//! the component. Therefore the ranks at a few other points of the same component are sufficient.
//!
//! Other points are reached by steps along the free directions of the constraints. The steps
//! exclude directions that are blocked at second order. In such a direction another branch may be
//! near, and the rank of the other branch does not describe this branch. Drives are omitted,
//! because their prescribed values change with time. If other constraints depend on time, time
//! changes as well.

mod leaving;
mod walker;

use linalg::Matrix;
use model::start::scene_size;
use model::{ConstraintId, Mechanism, System};
use rank::RankDecision;

use crate::certificate::UncertainRows;
use crate::components::{all_components, judge_all};
use crate::limits::{ONE_PART, POINTS, POINTS_APART, WALKS};
use crate::matrices::Solvability;
use crate::pose::{dimensionless, uncertainty, velocity_units};
use crate::stretches::worst;
use crate::verdict::Verdict;
use leaving::Leaving;
use walker::{LastingRows, Walker, has_lasting_function};

/// Redundancy at other configurations of the same component.
#[derive(Clone, Debug, PartialEq)]
pub struct Generic {
    /// The smallest redundancy of the compared configurations. Almost all configurations have this
    /// redundancy.
    pub redundancy: usize,
    /// The configurations that were compared.
    pub points: Vec<OtherConfiguration>,
}

/// Another configuration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OtherConfiguration {
    /// Time (s).
    pub time: f64,
    /// Coordinates, n_q.
    pub q: Vec<f64>,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
}

/// The verdicts on a joint or drive at nearly all configurations.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GenericVerdict {
    /// The joint or drive.
    pub id: ConstraintId,
    /// The verdict on all components together.
    pub whole: Verdict,
    /// The verdicts on the components that are not identically zero, and on the named component of
    /// the definition, with their names.
    pub components: Vec<(&'static str, Verdict)>,
}

impl GenericVerdict {
    /// Returns the verdict on the component with this name, or `None` for a component that is zero
    /// under any load.
    #[must_use]
    pub fn component(&self, name: &str) -> Option<&Verdict> {
        let mut own = self.components.iter();
        own.find(|(known, _)| *known == name).map(|(_, v)| v)
    }
}

/// Determines the rank of C at other configurations of the mechanism. Motions without the drives
/// lead from the configuration (t, q) to the other configurations. Returns the other configurations
/// with their ranks. The configuration (t, q) must satisfy the constraints. Returns `None` if no
/// other configuration with a decided rank was found. For example, a structure that cannot move has
/// only one configuration. Also returns `None` if the mechanism has no rows or more than
/// [`ONE_PART`] rows, or if t and q are not a configuration of the mechanism.
#[must_use]
pub fn generic(mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<Generic> {
    Some(Comparison::of(mechanism, t, q)?.found)
}

/// Works like [`generic`], and also returns the verdicts on all joints and drives. The result
/// contains the worst verdicts at the configurations with the smallest redundancy, or `None` if the
/// verdicts at these configurations are not known.
#[must_use]
pub fn generic_with_verdicts(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
) -> Option<(Generic, Option<Vec<GenericVerdict>>)> {
    let comparison = Comparison::of(mechanism, t, q)?;
    let verdicts = comparison.verdicts(mechanism);
    Some((comparison.found, verdicts))
}

/// Other configurations, with their decisions.
struct Comparison {
    found: Generic,
    /// Decisions on the compared rows, one for each configuration.
    decided: Vec<DecidedRows>,
    /// Rows whose rank is compared, ascending.
    compared: Vec<usize>,
}

/// The decision on rows of C, and the dimensionless C on which it is based.
struct DecidedRows {
    decision: RankDecision,
    c: Matrix,
}

impl Comparison {
    fn of(mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<Self> {
        crate::state::check_configuration(mechanism, t, q).ok()?;
        // Without rows there is no comparison.
        if !(1..=ONE_PART).contains(&mechanism.layout().rows()) {
            return None;
        }
        let compared = compared_rows(mechanism, t, q)?;
        let size = scene_size(mechanism, q);
        let walker = Walker {
            mechanism,
            rows: LastingRows::of(mechanism, t, q),
            units: velocity_units(mechanism, size),
            size,
            leaving: Leaving::new(mechanism, t, q),
            moves_time: has_lasting_function(mechanism),
        };
        let mut points: Vec<OtherConfiguration> = Vec::new();
        let mut decided = Vec::new();
        let mut visited = vec![(t, q.to_vec())];
        for walk in 0..WALKS {
            let from = &visited[visited.len() - 1];
            let Some(there) = walker.walk_from(from, walk) else {
                continue;
            };
            let is_new = |(t, q): &(f64, Vec<f64>)| {
                there.0 != *t || walker.apart(&there.1, q) >= POINTS_APART
            };
            if visited.iter().all(is_new)
                && let Some((point, own)) = walker.elsewhere(&there, &compared)
            {
                points.push(point);
                decided.push(own);
            }
            visited.push(there);
            if points.len() == POINTS {
                break;
            }
        }
        let redundancy = points.iter().map(|p| p.redundancy).min()?;
        Some(Self {
            found: Generic { redundancy, points },
            decided,
            compared,
        })
    }

    /// Returns the worst verdicts at the configurations with the smallest redundancy.
    fn verdicts(&self, mechanism: &Mechanism) -> Option<Vec<GenericVerdict>> {
        let points = self.found.points.iter().zip(&self.decided);
        let typical = points.filter(|(p, _)| p.redundancy == self.found.redundancy);
        let each: Vec<Vec<Verdict>> = typical
            .filter_map(|(point, decided)| self.verdicts_at(mechanism, point, decided))
            .collect();
        if each.is_empty() {
            return None;
        }
        let worst_of = |k: usize| worst(each.iter().map(|verdicts| &verdicts[k])).clone();
        let mut components = all_components(mechanism.layout()).enumerate().peekable();
        let of = |id: ConstraintId| {
            let mut own = Vec::new();
            while let Some((k, (_, name))) = components.next_if(|(_, (other, _))| *other == id) {
                own.push((name, worst_of(k)));
            }
            GenericVerdict {
                id,
                whole: worst(own.iter().map(|(_, v)| v)).clone(),
                components: own,
            }
        };
        Some(mechanism.layout().constraint_ids().map(of).collect())
    }

    /// Returns the verdicts on all components at one of these configurations. At this
    /// configuration, rows that were not compared are redundant within a stated tolerance. If the
    /// decision on all rows does not find these rows redundant, the rank of this decision differs,
    /// and the verdicts are not known.
    fn verdicts_at(
        &self,
        mechanism: &Mechanism,
        point: &OtherConfiguration,
        decided: &DecidedRows,
    ) -> Option<Vec<Verdict>> {
        let s = crate::pose::evaluated(mechanism, point.time, &point.q);
        let solvability = if self.compared.len() == mechanism.layout().rows() {
            Solvability::from_decision(&decided.c, decided.decision.clone())
        } else {
            let rows = UncertainRows::in_double(mechanism, &s, &point.q);
            let all = rows.of_rank(point.rank).ok()??;
            let is_same = all.is_decided() && all.rank == point.rank;
            is_same.then(|| Solvability::from_decision(&rows.matrix(), all))?
        };
        let judged = judge_all(mechanism, &s, solvability.basis()).ok()?;
        Some(judged.into_iter().map(|j| j.verdict).collect())
    }
}

/// Returns whether the degree of redundancy is the same at other configurations. Returns `None` if
/// [`generic`] returns `None`, or if the rank at this configuration is undecided.
#[must_use]
pub fn is_permanent(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Option<bool> {
    let found = generic(mechanism, t, q).filter(|_| decision.is_decided())?;
    Some(found.redundancy == decision.redundancy)
}

/// Returns the rows whose rank is compared. The rows are the independent rows at (t, q), and the
/// redundant rows that are dependent to rounding. The other rows are redundant within a stated
/// tolerance, and this was found at several configurations.
fn compared_rows(mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<Vec<usize>> {
    let all = (0..mechanism.layout().rows()).collect();
    if !mechanism.has_tolerances() {
        return Some(all);
    }
    let s = crate::pose::evaluated(mechanism, t, q);
    let here = UncertainRows::in_double(mechanism, &s, q).decide().ok()?;
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, &s, size);
    let known = uncertainty(mechanism, &s, size);
    let is_dependent = |row: usize| {
        let mut rows = here.kept.clone();
        rows.push(row);
        let found = rank::decide(&c.select_rows(&rows), &known.select_rows(&rows));
        found.is_ok_and(|found| found.is_decided() && found.rank == here.rank)
    };
    let dependent = here
        .dropped
        .iter()
        .copied()
        .filter(|&row| is_dependent(row));
    let mut rows: Vec<usize> = here.kept.iter().copied().chain(dependent).collect();
    rows.sort_unstable();
    Some(rows)
}
