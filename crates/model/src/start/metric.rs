//! Functions for all steps of the computation of an initial state: weights, bounds, and matrices of
//! a few rows.

use linalg::Matrix;

use super::error::StartError;
use crate::mechanism::Mechanism;
use crate::system::{Layout, Scratch, System};

/// Rows that restrict the initial configuration, and the inverse weights of the coordinates.
pub(super) type Restricting<'a> = (&'a [usize], &'a [f64]);

/// Damping of the least-squares step, relative to rows of norm one. The damping is small compared
/// with every significant row and large compared with rounding errors.
pub(super) const DAMPING: f64 = 1e-10;

/// Default limit of corrections of the initial state, as a fraction of the size of the scene, of a
/// radian, or of the largest velocity.
pub(super) const SMALL_CORRECTION: f64 = 1e-3;

/// A row counts as satisfied if its residual is below this multiple of the rounding error of its
/// terms.
pub(super) const ROUNDINGS: f64 = 10.0;

/// Largest number of entries of the matrix for a correction. A matrix with this number of entries
/// takes 1 GB.
const MOST_ENTRIES: usize = 1 << 27;

/// Returns a dense matrix of these rows of C. The function allocates memory.
pub(super) fn dense_rows(
    layout: &Layout,
    s: &Scratch,
    rows: &[usize],
) -> Result<Matrix, StartError> {
    let entries = rows.len().checked_mul(layout.n_v);
    if entries.is_none_or(|entries| entries > MOST_ENTRIES) {
        return Err(StartError::TooLarge {
            rows: rows.len(),
            columns: layout.n_v,
            most: MOST_ENTRIES as f64,
        });
    }
    let mut c = Matrix::zeros(rows.len(), layout.n_v);
    for (k, &i) in rows.iter().enumerate() {
        layout.scatter_row(s, i, c.row_mut(k));
    }
    Ok(c)
}

/// Returns the row with the largest value. NaN counts as the largest value.
pub(super) fn largest(rows: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    rows.fold(
        (0, 0.0),
        |a, b| if b.1 > a.1 || b.1.is_nan() { b } else { a },
    )
}

/// Masses, and inertias divided by the square of the size, are raised to this fraction of the
/// largest value. Lighter bodies have no effect on heavy bodies, but the squares of their weights
/// would overflow.
const LIGHTEST: f64 = 1e-30;

/// Returns the inverse weights of the coordinates in the metric of lengths, in which angles are
/// multiplied by the size.
pub(super) fn lengths(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let turns = |j| mechanism.space().is_rotation(j);
    let weight = |j| if turns(j) { 1.0 / (size * size) } else { 1.0 };
    (0..mechanism.layout().n_v).map(weight).collect()
}

/// Returns the inverse weights of the coordinates in the mass metric. Coordinates without mass or
/// inertia have the weight of the smallest mass or inertia.
pub(super) fn weights(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let turns = |j: usize| mechanism.space().is_rotation(j);
    let unit = |j: usize| if turns(j) { size * size } else { 1.0 };
    let comparable = mechanism
        .mass()
        .iter()
        .enumerate()
        .map(|(k, m)| m / unit(k));
    let heaviest = comparable.filter(|m| m.is_finite()).fold(0.0, f64::max);
    let least = |(k, &m): (usize, &f64)| {
        if m > 0.0 {
            m.max(LIGHTEST * heaviest * unit(k))
        } else {
            m
        }
    };
    let mass: Vec<f64> = mechanism.mass().iter().enumerate().map(least).collect();
    let smallest = |angles: bool| {
        let of_kind = mass.iter().enumerate().filter(|(k, _)| turns(*k) == angles);
        let positive = of_kind.map(|(_, &m)| m).filter(|&m| m > 0.0);
        positive.fold(f64::INFINITY, f64::min)
    };
    let fallback = [smallest(false), smallest(true)].map(|m| if m.is_finite() { m } else { 1.0 });
    let weight = |(k, &m): (usize, &f64)| {
        if m > 0.0 {
            1.0 / m
        } else {
            1.0 / fallback[usize::from(turns(k))]
        }
    };
    mass.iter().enumerate().map(weight).collect()
}
