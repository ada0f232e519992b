//! Corrects couplings that are not satisfied at the described pose of the links. The dependent
//! coordinate is changed to the value that the coupling requires.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::findings::Findings;
use crate::mechanism::{JointKind, Model};
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
pub(crate) fn settle(model: &mut Model, findings: &mut Findings) {
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
        .zip(&shifts)
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
    for (joint, shift) in model.joints.iter_mut().zip(&shifts) {
        joint.redescribe(*shift);
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
