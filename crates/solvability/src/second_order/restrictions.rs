//! The conditions of second order that velocities with `C·v = 0` must satisfy if drives are locked.
//!
//! Velocities that no quadratic form contains are unrestricted: they are not excluded at second
//! order. The restricted velocities are orthogonal to the unrestricted velocities. The velocities
//! are split into sets of bodies that joints connect, because self-stresses are split in the same
//! way. Each set is decided separately.

use crate::limits::{FORM_NOISE, OWN_SHARE};
use linalg::{Matrix, PivotedQr, small_svd};
use model::start::scene_size;
use model::{Mechanism, System};

use super::forms::Forms;
use super::undetermined::SecondOrderDoubt;
use super::zeros::{CommonZero, common_zero, is_transversal};
use crate::pose::velocity_units;

/// Second-order result for velocities with `C·v = 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum SecondOrder {
    /// No combination of the velocities satisfies the second-order equations. Therefore no motion
    /// has such a velocity.
    Blocked,
    /// Certain velocities satisfy the equations. Such velocities also exist for slightly different
    /// coefficients.
    Free,
    /// Neither result is proved.
    Undecided,
}

/// Velocities of connected bodies that the second-order equations restrict.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RestrictedVelocities {
    /// The bodies, ascending.
    pub bodies: Vec<usize>,
    /// A basis of the velocities, n_v values each, orthonormal in dimensionless form. The vectors
    /// of the basis are orthogonal to the velocities that no equation contains.
    pub velocities: Vec<Vec<f64>>,
    /// The result at second order.
    pub second_order: SecondOrder,
    /// The equations in coordinates of this basis, and the error of their coefficients.
    pub(crate) forms: Vec<Matrix>,
}

/// The restrictions of second order at one configuration.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Restrictions {
    /// Restricted velocities, set by set.
    pub restricted: Vec<RestrictedVelocities>,
    /// Number of independent velocities that no equation contains.
    pub unrestricted: usize,
    /// Reason why there are no equations, although there may be restrictions.
    pub undetermined: Option<SecondOrderDoubt>,
}

/// Second-order result for an acceleration from rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AccelerationVerdict {
    /// The acceleration satisfies the equations, and such an acceleration also exists for slightly
    /// different coefficients.
    Possible,
    /// The acceleration does not satisfy the equations.
    Excluded,
    /// Neither result is proved.
    Undecided,
}

impl RestrictedVelocities {
    /// Returns the second-order result for an acceleration from rest with these coordinates. The
    /// coordinates must not all be zero.
    pub(crate) fn accelerated(&self, along: &[f64]) -> AccelerationVerdict {
        let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let a: Vec<f64> = along.iter().map(|x| x / length).collect();
        let size: f64 = a.iter().map(|x| x.abs()).sum();
        let value = |m: &Matrix| -> f64 { a.iter().zip(m.times(&a)).map(|(a, m)| a * m).sum() };
        let mut values = self.forms.iter().map(|m| value(m).abs());
        if self.second_order == SecondOrder::Blocked || values.any(|x| x > FORM_NOISE * size * size)
        {
            AccelerationVerdict::Excluded
        } else if is_transversal(&self.forms, FORM_NOISE, &a) {
            AccelerationVerdict::Possible
        } else {
            AccelerationVerdict::Undecided
        }
    }
}

impl Restrictions {
    /// Returns whether every velocity is excluded at second order, or `None` if this is undecided.
    /// Without free velocities, the result is that every velocity is excluded.
    #[must_use]
    pub fn exclude_all(&self) -> Option<bool> {
        let mut decisions = self.restricted.iter().map(|r| r.second_order);
        if self.unrestricted > 0 || self.restricted.is_empty() {
            return match self.undetermined {
                Some(_) => None,
                None => Some(false),
            };
        }
        if decisions.clone().any(|d| d == SecondOrder::Free) {
            return Some(false);
        }
        decisions.all(|d| d == SecondOrder::Blocked).then_some(true)
    }

    /// Returns a basis of the velocities with this second-order result, n_v values each.
    #[must_use]
    pub fn velocities(&self, second_order: SecondOrder) -> Vec<Vec<f64>> {
        let sets = self.restricted.iter();
        let sets = sets.filter(|set| set.second_order == second_order);
        sets.flat_map(|set| set.velocities.clone()).collect()
    }

    /// Creates the restrictions from quadratic forms alone, without a given motion.
    pub(super) fn of(forms: &Forms, mechanism: &Mechanism, q: &[f64]) -> Self {
        let basis = restricted(forms);
        let sets = sets(forms, &basis, mechanism, q);
        let decided = |(bodies, own): (Vec<usize>, Matrix)| {
            let across = own.transpose();
            let in_set = |m: &Matrix| own.product(&m.product(&across));
            let in_set: Vec<Matrix> = forms.matrices.iter().map(in_set).collect();
            RestrictedVelocities {
                bodies,
                velocities: (0..own.nrows())
                    .map(|k| forms.velocity(own.row(k)))
                    .collect(),
                second_order: match common_zero(&in_set, FORM_NOISE) {
                    CommonZero::None => SecondOrder::Blocked,
                    CommonZero::Transversal(_) => SecondOrder::Free,
                    CommonZero::Undecided => SecondOrder::Undecided,
                },
                forms: in_set,
            }
        };
        Self {
            unrestricted: forms.len() - basis.nrows(),
            restricted: sets.into_iter().map(decided).collect(),
            undetermined: None,
        }
    }
}

/// Returns orthonormal rows that span the coordinates that the forms contain.
fn restricted(forms: &Forms) -> Matrix {
    let (n, count) = (forms.len(), forms.matrices.len());
    let stacked = Matrix::from_fn(n * count, n, |k, j| forms.matrices[k / n][(k % n, j)]);
    let qr = PivotedQr::of_rows(stacked);
    let rank = qr.r_diagonal().filter(|r| r.abs() > FORM_NOISE).count();
    qr.q_columns(0..rank).transpose()
}

/// Returns these coordinates separately for each set of connected bodies, as orthonormal rows.
fn sets(
    forms: &Forms,
    basis: &Matrix,
    mechanism: &Mechanism,
    q: &[f64],
) -> Vec<(Vec<usize>, Matrix)> {
    let groups: Vec<usize> = (0..mechanism.layout().groups.len()).collect();
    let units = velocity_units(mechanism, scene_size(mechanism, q));
    let unit = |v: Vec<f64>| -> Vec<f64> { v.iter().zip(&units).map(|(v, u)| v / u).collect() };
    let all: Vec<Vec<f64>> = (0..forms.len())
        .map(|k| unit(forms.velocity(&unit_vector(forms.len(), k))))
        .collect();
    let moving: Vec<Vec<f64>> = (0..basis.nrows())
        .map(|k| unit(forms.velocity(basis.row(k))))
        .collect();
    let mut found = Vec::new();
    for bodies in mechanism.joined(&groups) {
        let columns: Vec<usize> = bodies
            .iter()
            .flat_map(|&b| mechanism.space().columns_of(b))
            .collect();
        // The part of each coordinate that moves these bodies, in coordinates of the forms. The sum
        // over the sets is direct. Therefore each singular value is one or zero.
        let own = Matrix::from_fn(moving.len(), all.len(), |k, l| {
            columns.iter().map(|&j| moving[k][j] * all[l][j]).sum()
        });
        let svd = small_svd(&own);
        let rank = svd.sigma.iter().filter(|s| **s > OWN_SHARE).count();
        if rank > 0 {
            let rows = Matrix::from_fn(rank, all.len(), |k, l| svd.v[(l, k)]);
            found.push((bodies, rows));
        }
    }
    found
}

fn unit_vector(n: usize, k: usize) -> Vec<f64> {
    (0..n).map(|i| f64::from(i == k)).collect()
}
