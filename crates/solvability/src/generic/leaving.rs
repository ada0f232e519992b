//! Determines how a mechanism without its drives can leave a configuration at second order. The
//! results are the excluded velocities and the tangents of branches. Velocities are dimensionless.

use std::borrow::Cow;

use linalg::{Matrix, PivotedQr};
use model::{Mechanism, Places, System};
use rank::RankDecision;

use crate::pose::{decide, evaluated};
use crate::second_order::{Continuation, blocked_velocities, second_order};

/// The joints of a mechanism that constrain its configuration.
pub(super) struct Leaving<'m> {
    mechanism: Cow<'m, Mechanism>,
    /// Indices of the joints in the mechanism; `None` denotes all joints.
    places: Option<Places>,
    n_v: usize,
    /// Number of velocities that are excluded at second order at the first configuration.
    excluded: usize,
}

impl<'m> Leaving<'m> {
    /// Returns the joints of a mechanism with coordinates q at time t.
    pub(super) fn new(mechanism: &'m Mechanism, t: f64, q: &[f64]) -> Self {
        let layout = mechanism.layout();
        let holds = |k: &usize| {
            let group = &layout.groups[*k];
            !group.is_drive() && !group.rows.holonomic.is_empty()
        };
        let groups: Vec<usize> = (0..layout.groups.len()).filter(holds).collect();
        let (mechanism, places) = if groups.len() == layout.groups.len() {
            (Cow::Borrowed(mechanism), None)
        } else {
            let part = mechanism.part_of_groups(&groups);
            (Cow::Owned(part.mechanism), Some(part.places))
        };
        let mut own = Self {
            mechanism,
            places,
            n_v: layout.n_v,
            excluded: 0,
        };
        own.excluded = own.excluded((t, q)).len();
        own
    }

    /// Returns whether velocities are excluded at second order at the first configuration.
    pub(super) fn excludes(&self) -> bool {
        self.excluded > 0
    }

    /// Returns the free directions at a configuration (orthonormal, in rows) that are not excluded
    /// at second order. Returns `None` if fewer velocities are excluded than at the first
    /// configuration, because another branch may begin at this configuration.
    pub(super) fn possible(
        &self,
        free: Matrix,
        at: (f64, &[f64]),
        units: &[f64],
    ) -> Option<Matrix> {
        // Velocities that are excluded at a point of a branch are excluded along the whole branch.
        if !self.excludes() || free.nrows() == 0 {
            return Some(free);
        }
        let excluded = self.excluded(at);
        if excluded.len() < self.excluded {
            return None;
        }
        let excluded: Vec<Vec<f64>> = self.dimensionless(excluded, units);
        let among = Matrix::from_fn(free.nrows(), excluded.len(), |i, j| {
            let row = free.row(i).iter();
            row.zip(&excluded[j]).map(|(a, b)| a * b).sum()
        });
        let left = excluded.len().min(free.nrows())..free.nrows();
        let rest = PivotedQr::of_columns(&among).q_columns(left);
        Some(rest.transpose().product(&free))
    }

    /// Returns the tangents of the branches that meet at a configuration. The list is empty if the
    /// branches cannot be separated at second order.
    pub(super) fn branches(&self, at: (f64, &[f64]), units: &[f64]) -> Vec<Vec<f64>> {
        let found = self.decided(at).and_then(|(q, decision)| {
            let n = self.mechanism.layout().n_v;
            let (rest, regular) = (vec![0.0; n], Matrix::zeros(n, 0));
            second_order(&self.mechanism, at.0, &q, &rest, &decision, &regular).ok()
        });
        match found {
            Some(Continuation::Bifurcation { branches }) => self.dimensionless(branches, units),
            _ => Vec::new(),
        }
    }

    /// Returns the velocities of the joints that are excluded at second order.
    fn excluded(&self, at: (f64, &[f64])) -> Vec<Vec<f64>> {
        let found = self.decided(at).and_then(|(q, decision)| {
            blocked_velocities(&self.mechanism, at.0, &q, &decision).ok()
        });
        found.unwrap_or_default()
    }

    /// Returns the coordinates of the joints and their rank, or `None` if the second-order analysis
    /// does not apply.
    fn decided(&self, (t, q): (f64, &[f64])) -> Option<(Vec<f64>, RankDecision)> {
        let layout = self.mechanism.layout();
        if layout.h > 0 || layout.rheonomic {
            return None;
        }
        let q: Vec<f64> = match &self.places {
            None => q.to_vec(),
            Some(places) => places.coordinates.iter().map(|&k| q[k]).collect(),
        };
        let s = evaluated(&self.mechanism, t, &q);
        let decision = decide(&self.mechanism, &s, &q).ok()?;
        let has_forms = decision.is_decided() && decision.redundancy > 0;
        (has_forms && decision.rank < layout.n_v).then_some((q, decision))
    }

    /// Returns velocities of the joints as velocities of the mechanism.
    fn dimensionless(&self, velocities: Vec<Vec<f64>>, units: &[f64]) -> Vec<Vec<f64>> {
        let of_all = |own: Vec<f64>| {
            let mut all = match &self.places {
                None => own,
                Some(places) => {
                    let mut all = vec![0.0; self.n_v];
                    for (&k, v) in places.velocities.iter().zip(own) {
                        all[k] = v;
                    }
                    all
                }
            };
            all.iter_mut().zip(units).for_each(|(v, unit)| *v /= unit);
            all
        };
        velocities.into_iter().map(of_all).collect()
    }
}
