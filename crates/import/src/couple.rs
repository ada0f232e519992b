//! Corrects couplings that are not satisfied at the described pose of the links. The dependent
//! coordinate is changed to the value that the coupling requires.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, Isometry3};

use crate::findings::Findings;
use crate::limits::{ASSEMBLED, ITERATIONS, MOST_COORDINATES, OPEN};
use crate::mechanism::{JointKind, Model, redescribe};
use crate::pose::{JointPlacement, displaced};

/// Value of a polynomial.
fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Coefficients of P(s + x) − P(s) as a polynomial in x.
pub(crate) fn about(coefficients: &[f64], s: f64) -> Vec<f64> {
    let mut shifted = coefficients.to_vec();
    if s != 0.0 {
        let n = shifted.len();
        // Repeated Horner scheme: the Taylor coefficients at s.
        for first in 0..n {
            for k in (first..n.saturating_sub(1)).rev() {
                shifted[k] += s * shifted[k + 1];
            }
        }
    }
    if let Some(constant) = shifted.first_mut() {
        *constant = 0.0;
    }
    shifted
}

/// Extends the given coordinates (joint, coordinate, change relative to the described pose). It
/// adds the coordinates that couplings determine from the given coordinates. A linear coupling is
/// used in both directions.
pub(crate) fn follow(model: &Model, given: &[(usize, usize, f64)]) -> Vec<(usize, usize, f64)> {
    let mut known: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    known.extend(given.iter().map(|&(joint, k, change)| ((joint, k), change)));
    // The number of rounds is at least the number of couplings in a chain, so every chain is
    // complete.
    for _ in 0..=model.couplings.len() {
        let before = known.len();
        for coupling in model.couplings.iter().filter(|coupling| coupling.is_active) {
            let Some(x) = coupling.x else { continue };
            let y = coupling.y;
            let ratio = coupling.coefficients.get(1).copied().unwrap_or(0.0);
            let is_linear = coupling.coefficients.iter().skip(2).all(|c| *c == 0.0);
            match (known.get(&x).copied(), known.get(&y).copied()) {
                (Some(at), None) => {
                    known.insert(y, value(&coupling.coefficients, at));
                }
                (None, Some(at)) if is_linear && ratio != 0.0 => {
                    let first = coupling.coefficients[0];
                    known.insert(x, (at - first) / ratio);
                }
                _ => {}
            }
        }
        if known.len() == before {
            break;
        }
    }
    let all = known.into_iter();
    all.map(|((joint, k), change)| (joint, k, change)).collect()
}

/// Moves the links whose coordinates couplings determine, and converts the polynomials of the
/// couplings to coordinate changes.
///
/// # Errors
/// The name of a coupling that is not satisfied at the position that was found, and the error.
pub(crate) fn settle(model: &mut Model, findings: &mut Findings) -> Result<(), (String, f64)> {
    let mut shifts = chained(model);
    if worst(model, &shifts).is_some() {
        solve(model, &mut shifts);
        if let Some((coupling, error)) = worst(model, &shifts) {
            return Err((model.couplings[coupling].name.clone(), error));
        }
    }
    describe(model, &shifts, findings);
    Ok(())
}

/// Changes of the coordinates if each coupling determines its dependent coordinate from the other.
fn chained(model: &Model) -> Vec<[f64; 2]> {
    let mut shifts = vec![[0.0; 2]; model.joints.len()];
    // The number of rounds is at least the number of couplings in a chain, so every chain is
    // complete.
    for _ in 0..=model.couplings.len() {
        let before = shifts.clone();
        for coupling in model.couplings.iter().filter(|coupling| coupling.is_active) {
            let x = coupling.x.map_or(0.0, |(joint, k)| before[joint][k]);
            let (joint, k) = coupling.y;
            if model.joints[joint].places {
                shifts[joint][k] = value(&coupling.coefficients, x);
            }
        }
        if shifts == before {
            break;
        }
    }
    shifts
}

/// The errors y − P(x) of active couplings, with their indices. Joints that close loops are
/// excluded, because the poses of the links determine their coordinates.
fn errors(model: &Model, shifts: &[[f64; 2]]) -> Vec<(usize, f64)> {
    let at = |(joint, k): (usize, usize)| shifts[joint][k];
    let couplings = model.couplings.iter().enumerate();
    couplings
        .filter(|(_, coupling)| coupling.is_active && model.joints[coupling.y.0].places)
        .map(|(k, of)| (k, at(of.y) - value(&of.coefficients, of.x.map_or(0.0, at))))
        .collect()
}

/// The coupling with the largest error (m or rad), if this error is not a rounding error.
fn worst(model: &Model, shifts: &[[f64; 2]]) -> Option<(usize, f64)> {
    let errors = errors(model, shifts).into_iter();
    let largest = errors.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let scale = shifts
        .iter()
        .flatten()
        .fold(1.0_f64, |most, x| most.max(x.abs()));
    // A comparison with NaN is false, and NaN is an error.
    let is_fine = largest.1.abs() <= ASSEMBLED * scale;
    (!is_fine).then_some(largest)
}

/// Searches for changes that satisfy all couplings, by Newton steps of least length. This is needed
/// if a coordinate depends on several couplings, or if couplings form a cycle.
fn solve(model: &Model, shifts: &mut [[f64; 2]]) {
    let mut unknowns: Vec<(usize, usize)> = { model.couplings.iter() }
        .filter(|coupling| coupling.is_active)
        .flat_map(|coupling| coupling.x.into_iter().chain([coupling.y]))
        .filter(|(joint, _)| model.joints[*joint].places)
        .collect();
    unknowns.sort_unstable();
    unknowns.dedup();
    if unknowns.len() > MOST_COORDINATES || model.couplings.len() > MOST_COORDINATES {
        return;
    }
    for _ in 0..ITERATIONS {
        let errors = errors(model, shifts);
        let rhs = DVector::from_iterator(errors.len(), errors.iter().map(|(_, error)| *error));
        let mut slopes = DMatrix::zeros(errors.len(), unknowns.len());
        for (row, (k, _)) in errors.iter().enumerate() {
            let coupling = &model.couplings[*k];
            if let Ok(column) = unknowns.binary_search(&coupling.y) {
                slopes[(row, column)] += 1.0;
            }
            let Some(x) = coupling.x else { continue };
            if let Ok(column) = unknowns.binary_search(&x) {
                slopes[(row, column)] -= slope(&coupling.coefficients, shifts[x.0][x.1]);
            }
        }
        if slopes.iter().chain(&rhs).any(|x| !x.is_finite()) {
            return;
        }
        let svd = slopes.svd(true, true);
        // Dependent couplings have singular values of rounding errors.
        let floor = OPEN * svd.singular_values.amax();
        let Ok(step) = svd.solve(&rhs, floor) else {
            return;
        };
        for ((joint, k), step) in unknowns.iter().zip(step.iter()) {
            shifts[*joint][*k] -= step;
        }
        if step.amax() <= f64::EPSILON {
            return;
        }
    }
}

/// Slope of a polynomial.
fn slope(coefficients: &[f64], x: f64) -> f64 {
    let horner = |(value, slope): (f64, f64), c: &f64| (value * x + c, slope * x + value);
    coefficients.iter().rev().fold((0.0, 0.0), horner).1
}

/// Moves the links by these changes of the coordinates, and refers the couplings to them.
fn describe(model: &mut Model, shifts: &[[f64; 2]], findings: &mut Findings) {
    for coupling in &mut model.couplings {
        let x = coupling.x.map_or(0.0, |(joint, k)| shifts[joint][k]);
        coupling.coefficients = about(&coupling.coefficients, x);
        // A coupling with a constant polynomial locks its coordinate.
        if coupling.coefficients.iter().all(|c| *c == 0.0) {
            coupling.x = None;
        }
    }
    if shifts.iter().flatten().all(|shift| *shift == 0.0) {
        return;
    }
    let moved: Vec<Isometry3<f64>> = model
        .joints
        .iter()
        .zip(shifts)
        .map(|(joint, shift)| match joint.kind {
            JointKind::Spherical | JointKind::Free | JointKind::Fixed | JointKind::Planar => {
                Isometry3::identity()
            }
            kind => {
                let n = kind.measures().len();
                JointPlacement::of(model, joint).displacement(kind, &shift[..n])
            }
        })
        .collect();
    let links = displaced(model, &moved);
    for (link, g) in model.links.iter_mut().zip(links) {
        link.pose = g * link.pose;
    }
    let mut names = Vec::new();
    for (joint, shift) in model.joints.iter_mut().zip(shifts) {
        redescribe(joint, *shift);
        if shift.iter().any(|x| *x != 0.0) {
            names.push(format!("`{}`", joint.name));
        }
    }
    findings.remarks.push(format!(
        "These joints are described where couplings put them, not at zero: {}.",
        names.join(", ")
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_changes() {
        // (2 + x)³ − 8 = 12·x + 6·x² + x³
        assert_eq!(about(&[5.0, 0.0, 0.0, 1.0], 2.0), [0.0, 12.0, 6.0, 1.0]);
        assert_eq!(value(&[1.0, 2.0, 3.0], 2.0), 17.0);
    }
}
