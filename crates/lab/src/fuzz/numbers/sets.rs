//! Computes solutions at one state: one for each admissible set of deleted rows, and one for
//! elastic joints.

use model::{ConstraintId, Mechanism, System};
use nalgebra::{DMatrix, DVector};
use solvability::Compliance;

use super::decomposition::Decomposition;
use super::forms::Form;
use super::oracle::Instant;
use suite::numbers::Numbers;

/// A row may be deleted next if its part in the remaining left null space is at least this fraction
/// of the largest part of any row. The solutions are then at most some hundred times the loads.
const SHARE: f64 = 0.1;

/// A set of rows is not admissible if the smallest singular value of its part in the left null
/// space is below this fraction.
const NEARLY_NOT: f64 = 1e-3;

/// The components do not determine a solution if a change of the multipliers changes the components
/// by less than this fraction of the effect of other changes.
const HIDDEN: f64 = 1e-6;

/// Returns random rows whose deletion does not change the rank. The number of these rows is the
/// degree of redundancy.
#[must_use]
pub fn dropped(instant: &Instant, numbers: &mut Numbers) -> Vec<usize> {
    let mut rest = instant.null.transpose();
    let mut chosen = Vec::new();
    for _ in 0..rest.nrows() {
        let lengths: Vec<f64> = rest.column_iter().map(|c| c.norm()).collect();
        let largest = lengths.iter().copied().fold(0.0, f64::max);
        let rows: Vec<usize> = (0..lengths.len())
            .filter(|&i| lengths[i] >= SHARE * largest)
            .collect();
        let row = rows[numbers.below(rows.len())];
        chosen.push(row);
        let direction = rest.column(row).normalize();
        let shares = direction.transpose() * &rest;
        rest -= direction * shares;
    }
    chosen.sort_unstable();
    chosen
}

/// Returns the scaled multipliers of the solution without these rows. Returns `None` if the set is
/// not admissible at this state. Also returns `None` if the set is nearly inadmissible, because the
/// solution is then large.
#[must_use]
pub fn without(instant: &Instant, from: &DVector<f64>, rows: &[usize]) -> Option<DVector<f64>> {
    let z = &instant.null;
    if rows.len() != z.ncols() {
        return None;
    }
    if rows.is_empty() {
        return Some(from.clone());
    }
    let own = DMatrix::from_fn(rows.len(), rows.len(), |i, j| z[(rows[i], j)]);
    let wanted = DVector::from_fn(rows.len(), |i, _| from[rows[i]]);
    let own = Decomposition::of(&own).above(NEARLY_NOT);
    let is_admissible =
        own.rank() == rows.len() && own.values.last().is_some_and(|x| *x > NEARLY_NOT);
    is_admissible.then(|| from - z * own.solve(&wanted))
}

/// Returns a compliance of each joint and drive, within a factor of four.
#[must_use]
pub fn compliances(mechanism: &Mechanism, size: f64, numbers: &mut Numbers) -> Vec<Compliance> {
    let mut one = |unit: f64| unit * numbers.within(0.5, 2.0);
    let ids = mechanism.layout().constraint_ids();
    ids.map(|reaction| Compliance {
        reaction,
        along: [0; 3].map(|_| one(1e-6)),
        rotation: one(1e-6 / (size * size)),
    })
    .collect()
}

/// Returns the scaled multipliers of the solution for elastic joints, which minimises
/// `½·Σ compliance·component²`. Returns `None` if the components do not determine the multipliers.
#[must_use]
pub fn elastic(
    instant: &Instant,
    from: &DVector<f64>,
    (mechanism, forms): (&Mechanism, &[Form]),
    compliances: &[Compliance],
) -> Option<DVector<f64>> {
    let z = &instant.null;
    if z.ncols() == 0 {
        return Some(from.clone());
    }
    let space = mechanism.layout().space;
    let weight = |form: &Form| {
        let k = form.index?;
        let joint = compliances
            .iter()
            .find(|c| c.reaction == ConstraintId(form.group))?;
        let compliance = if space.forces().contains(&k) {
            joint.along[space.axis_of(k)]
        } else {
            joint.rotation
        };
        // All forms are forces, because torques have been divided by the size.
        Some((compliance / form.unit.powi(2) * 1e6).sqrt())
    };
    let terms: Vec<(DVector<f64>, f64)> = forms
        .iter()
        .filter_map(|form| Some((instant.scaled(form), weight(form)?)))
        .collect();
    let mut a = DMatrix::zeros(terms.len(), z.ncols());
    let mut b = DVector::zeros(terms.len());
    for (k, (w, weight)) in terms.iter().enumerate() {
        a.set_row(k, &((w.transpose() * z) * *weight));
        b[k] = weight * w.dot(from);
    }
    let own = Decomposition::of(&a).above(HIDDEN);
    (own.rank() == z.ncols()).then(|| from - z * own.solve(&b))
}
