//! Ranges of numbers over the loads that contacts permit.

use linalg::kernels::dot;
use model::ConstraintId;

use super::conditions::{ContactCondition, LoadNumber};
use super::error::PermittedError;
use super::{PermittedReactions, merged};
use crate::groups::LinearForm;
use crate::polyhedra::polyhedron::Extremum;
use crate::verdict::Verdict;

/// The range of a number over the loads that contacts permit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PermittedRange {
    /// Kind of the range.
    pub kind: RangeKind,
    /// The lowest and the highest end; `None` if no loads are permitted.
    pub ends: Option<[PermittedEnd; 2]>,
}

/// Kinds of ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RangeKind {
    /// One value only. A number that is not unique is then made unique by the signs of the forces.
    Point,
    /// All values between two ends.
    Interval,
    /// All values above or below one end, so a preload is possible.
    HalfLine,
    /// All values, so a preload is possible in both directions.
    Line,
    /// No value, because the contacts cannot all stay closed.
    Empty,
}

impl RangeKind {
    /// Returns the word for the kind in documents.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Interval => "interval",
            Self::HalfLine => "half_line",
            Self::Line => "line",
            Self::Empty => "empty",
        }
    }
}

/// An end of a range.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum PermittedEnd {
    /// The number reaches this value (N, N·m). For every permitted distribution of the loads, the
    /// distance of the number from the end is the sum of the margins of these conditions,
    /// multiplied by their weights ≥ 0.
    Reached {
        /// The value.
        value: f64,
        /// The conditions with their weights.
        weights: Vec<(ContactCondition, f64)>,
        /// The forces (N) with which one-sided joints press in a distribution that reaches the
        /// value.
        pressing: Vec<(ConstraintId, f64)>,
    },
    /// The number has no limit.
    Unlimited {
        /// Changes of components of reactions without an external load (N, N·m) that change the
        /// number by 1. The contacts permit these changes in any multiple.
        preload: Vec<(ConstraintId, &'static str, f64)>,
    },
}

impl PermittedRange {
    /// Returns whether the number has one value in all solutions, for any permitted loads.
    #[must_use]
    pub fn is_unique(&self) -> bool {
        let is_free = |end: &PermittedEnd| matches!(end, PermittedEnd::Reached { weights, .. } if weights.is_empty());
        self.ends
            .as_ref()
            .is_some_and(|ends| ends.iter().all(is_free))
    }
}

impl PermittedEnd {
    /// Returns the value if the number reaches only one value.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Reached { value, .. } => Some(*value),
            Self::Unlimited { .. } => None,
        }
    }

    fn plus(self, other: Self) -> Self {
        match (self, other) {
            (
                Self::Reached {
                    value,
                    mut weights,
                    mut pressing,
                },
                Self::Reached {
                    value: own,
                    weights: own_weights,
                    pressing: own_pressing,
                },
            ) => {
                weights.extend(own_weights);
                pressing.extend(own_pressing);
                Self::Reached {
                    value: value + own,
                    weights,
                    pressing,
                }
            }
            (unlimited @ Self::Unlimited { .. }, _) | (_, unlimited) => unlimited,
        }
    }

    fn exact(value: f64) -> Self {
        Self::Reached {
            value,
            weights: Vec::new(),
            pressing: Vec::new(),
        }
    }
}

impl PermittedReactions<'_, '_> {
    /// Returns the range of a number over the loads that contacts permit. The number is the sum of
    /// linear forms of the multipliers. `forms` contains each linear form with the index of the
    /// part to which the form belongs.
    pub(super) fn range(
        &self,
        forms: &[(usize, &LinearForm)],
    ) -> Result<PermittedRange, PermittedError> {
        let mut ends = [0.0; 2].map(PermittedEnd::exact);
        let mut is_point = true;
        for (c, cluster) in self.clusters.iter().enumerate() {
            let own = forms.iter().filter(|(k, _)| self.cluster_of[*k] == Some(c));
            let own: Vec<_> = own.map(|(k, form)| (*k, *form, 1.0)).collect();
            if own.is_empty() {
                continue;
            }
            let of = (self.questions, self.solution);
            let name = || self.name_of(own[0].0);
            let LoadNumber { row, value } = cluster.number(of, &own, name)?;
            let Some(range) = cluster.permitted.range(&row, value)? else {
                return Ok(PermittedRange {
                    kind: RangeKind::Empty,
                    ends: None,
                });
            };
            is_point &= range.is_point;
            for (end, own) in ends.iter_mut().zip(range.ends) {
                *end = end.clone().plus(match own {
                    Extremum::Finite { value, at, weights } => {
                        let weights = cluster.conditions.iter().copied().zip(weights);
                        let weights = weights.filter(|(_, w)| *w > 0.0).collect();
                        PermittedEnd::Reached {
                            value,
                            weights: merged(weights),
                            pressing: cluster.pressing(&at),
                        }
                    }
                    Extremum::Infinite { ray } => {
                        let change = dot(&row, &ray).abs();
                        let ray: Vec<f64> = ray.iter().map(|x| x / change).collect();
                        let preload = cluster.changes(of, &ray)?;
                        PermittedEnd::Unlimited { preload }
                    }
                });
            }
        }
        for (k, form) in forms.iter().filter(|(k, _)| self.cluster_of[*k].is_none()) {
            let configuration = self.questions.configuration(*k)?;
            let extent = &self.questions.parts()[*k].extent;
            let lambda = extent.of_rows(self.solution.multipliers.as_chosen());
            let value = configuration.value(form, &lambda);
            let own = match configuration.judge(form)?.verdict {
                Verdict::Unique => PermittedEnd::exact(value),
                Verdict::NotUnique => {
                    // The joints of the part are two-sided and share loads in any ratio.
                    let preload = Vec::new();
                    PermittedEnd::Unlimited { preload }
                }
                Verdict::Undecided { .. } => return Err(PermittedError::Verdict(self.name_of(*k))),
            };
            ends = ends.map(|end| end.plus(own.clone()));
        }
        if is_point
            && let [
                PermittedEnd::Reached { value: lowest, .. },
                PermittedEnd::Reached { value: highest, .. },
            ] = &mut ends
        {
            // Both are the one value, to within rounding.
            let value = f64::midpoint(*lowest, *highest);
            (*lowest, *highest) = (value, value);
        }
        let kind = match ends.each_ref().map(PermittedEnd::value) {
            [Some(_), Some(_)] if is_point => RangeKind::Point,
            [Some(_), Some(_)] => RangeKind::Interval,
            [None, None] => RangeKind::Line,
            _ => RangeKind::HalfLine,
        };
        Ok(PermittedRange {
            kind,
            ends: Some(ends),
        })
    }

    /// Returns the names of the first joints of a part.
    fn name_of(&self, k: usize) -> String {
        let mechanism = self.questions.mechanism();
        self.questions.parts()[k].extent.name(mechanism)
    }
}
