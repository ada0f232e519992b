//! Constraints in double-double at a configuration that is refined to more digits than `f64` has. A
//! certificate of the rank uses these constraints.
//!
//! At a configuration stored in `f64`, the computed value of an exactly zero singular value is
//! about 1e-16. This value cannot be distinguished from a very small singular value. This module
//! reduces Φ to 1e-32 in the independent rows. The computed value of an exact zero then decreases
//! to about 1e-32, too. A singular value that is due to a misalignment in the data does not change.
//! The method is not suitable for simulations, because it allocates memory and is 100 times slower
//! than the kernels in `f64`.

use linalg::{DampedRows, Dd, DdMatrix, StepError};

use crate::element::{Bodies, ExtendedSlots};
use crate::mechanism::{KernelInput, Mechanism};
use crate::size::scene_size;
use crate::start::within::is_beyond;
use crate::system::System;

/// A configuration that satisfies the independent holonomic rows to double-double, with the
/// residuals of the other rows.
#[derive(Clone, Debug)]
pub struct PolishedConfiguration {
    /// Time (s).
    pub t: f64,
    /// Coordinates, n_q.
    pub q: Vec<Dd>,
    /// Φ, m values. In the independent rows, they are rounding errors. In the other rows, they are
    /// residuals due to the data.
    pub phi: Vec<Dd>,
    /// C, (m+h) × n_v.
    pub c: DdMatrix,
}

/// Largest number of corrections. Each correction adds as many correct digits as a factorisation in
/// `f64` has, or fewer digits near a singular configuration.
const CORRECTIONS: usize = 6;

/// A residual below this multiple of the rounding error of double-double needs no further
/// correction.
const ROUNDINGS: f64 = 16.0;

impl PolishedConfiguration {
    /// Refines the coordinates q, which satisfy Φ = 0 to `f64`; `kept` are the independent rows of
    /// Φ. Each correction has the smallest possible norm. The iteration ends when corrections no
    /// longer decrease, or when the next correction would move a body by more than a stated
    /// tolerance.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `q` | n_q | coordinates that satisfy the constraints to `f64` |
    /// | `kept` | ≤ m | independent holonomic rows (0-based); rows that do not exist are ignored |
    ///
    /// # Errors
    /// Returns an error if the rows `kept` are dependent or an entry is not finite.
    pub fn at(mechanism: &Mechanism, t: f64, q: &[f64], kept: &[usize]) -> Result<Self, StepError> {
        let m = mechanism.layout().m;
        let kept: Vec<usize> = kept.iter().copied().filter(|&i| i < m).collect();
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        let c = mechanism.layout().dense(&s).select_rows(&kept);
        let scale: Vec<f64> = kept
            .iter()
            .map(|&i| mechanism.scales(&s).position(i))
            .collect();
        // The weights make corrections small relative to the size of the mechanism. With the radian
        // as the unit of all rotations, the solver would first rotate large bodies.
        let rotation = scene_size(mechanism, q).powi(-2);
        let weights: Vec<f64> = (0..mechanism.layout().n_v)
            .map(|j| {
                if mechanism.space().is_rotation(j) {
                    rotation
                } else {
                    1.0
                }
            })
            .collect();
        let described = q;
        let mut q: Vec<Dd> = described.iter().map(|&q| Dd::from(q)).collect();
        let residual = |phi: &[Dd]| {
            let miss = |(&row, &scale): (&usize, &f64)| match phi[row].abs().to_f64() {
                0.0 => 0.0,
                phi => phi / scale,
            };
            kept.iter().zip(&scale).map(miss).fold(0.0, f64::max)
        };
        let mut phi = extended_phi(mechanism, t, &q);
        let mut factored = None;
        for _ in 0..CORRECTIONS {
            let least = residual(&phi);
            if least <= ROUNDINGS * Dd::EPSILON {
                break;
            }
            let missing: Vec<f64> = kept.iter().map(|&i| phi[i].to_f64()).collect();
            let rows = match factored.take() {
                Some(rows) => rows,
                None => DampedRows::new(&c, &weights, 0.0)?,
            };
            let step = factored.insert(rows).step(&missing)?;
            let step: Vec<Dd> = step.into_iter().map(Dd::from).collect();
            let mut moved = q.clone();
            mechanism.space().displace(&mut moved, &step);
            let phi_moved = extended_phi(mechanism, t, &moved);
            let there: Vec<f64> = moved.iter().map(|q| q.to_f64()).collect();
            if residual(&phi_moved) >= least || is_beyond(mechanism, &s, described, &there) {
                break;
            }
            (q, phi) = (moved, phi_moved);
        }
        let c = extended_c(mechanism, t, &q);
        Ok(Self { t, q, phi, c })
    }
}

/// Returns Φ in double-double, m values.
fn extended_phi(mechanism: &Mechanism, t: f64, q: &[Dd]) -> Vec<Dd> {
    let mut phi = vec![Dd::ZERO; mechanism.layout().m];
    let at = arguments(mechanism, t, q);
    for c in &mechanism.elements.constraints {
        at.phi(c, &mut phi[c.rows.holonomic.clone()]);
    }
    phi
}

/// Returns C in double-double.
fn extended_c(mechanism: &Mechanism, t: f64, q: &[Dd]) -> DdMatrix {
    let (layout, elements) = (mechanism.layout(), &mechanism.elements);
    let at = arguments(mechanism, t, q);
    let mut entries: Vec<Dd> = elements.entries.iter().map(|&e| Dd::from(e)).collect();
    for c in elements
        .constraints
        .iter()
        .filter(|c| c.has_varying_entries())
    {
        at.c(c, &mut entries[c.entries.clone()]);
    }
    let mut dense = DdMatrix::zeros(layout.rows(), layout.n_v);
    for i in 0..layout.rows() {
        for k in layout.pattern.row(i) {
            dense[(i, layout.pattern.column[k])] += entries[layout.pattern.entry[k]];
        }
    }
    dense
}

/// Returns the poses of the bodies and the values of the functions of time.
fn arguments(mechanism: &Mechanism, t: f64, q: &[Dd]) -> ExtendedSlots {
    let given = mechanism.elements.given.iter();
    let jet = |given: &KernelInput| given.function().map(|f| f.extended_jet(t));
    let mut jets: Vec<[Dd; 3]> = given.map(|g| jet(g).unwrap_or_default()).collect();
    counted_angles(mechanism, t, q, &mut jets);
    ExtendedSlots {
        bodies: Bodies::at(mechanism.space(), mechanism.of_bodies(q)),
        jets,
    }
}

/// Sets the unwrapped angles of the kernels to the rounded coordinates, whose cosine and sine are
/// accurate to all digits. The kernels add the remaining part of each angle.
fn counted_angles(mechanism: &Mechanism, t: f64, q: &[Dd], jets: &mut [[Dd; 3]]) {
    if mechanism.layout().turns == 0 {
        return;
    }
    let rounded: Vec<f64> = q.iter().map(|q| q.to_f64()).collect();
    let mut s = mechanism.scratch();
    mechanism.pose(t, &rounded, &mut s);
    for angle in &mechanism.elements.counted {
        let theta = Dd::from(s.slots.jets[angle.first][0]);
        let (sin, cos) = theta.sin_cos();
        for (jet, value) in jets[angle.first..].iter_mut().zip([theta, cos, sin]) {
            *jet = [value, Dd::ZERO, Dd::ZERO];
        }
    }
}

#[cfg(test)]
mod tests {
    use joints::Revolute;

    use super::*;
    use crate::{Body, BodyRef, Description, Joint};

    /// Two bars in series with one pivot on the ground, at angles that `f64` cannot represent.
    fn chain() -> Mechanism {
        let bar = |name: &str| Body {
            name: name.into(),
            mass: 1.0,
            inertia: 1.0,
            ..Body::default()
        };
        let pin = |name: &str, bodies: &[BodyRef], s_i, s_j| {
            Joint::new(name, bodies, Revolute { s_i, s_j })
        };
        let description = Description {
            bodies: vec![bar("a"), bar("b")],
            joints: vec![
                pin(
                    "P",
                    &[BodyRef::Ground, BodyRef::Body(0)],
                    [0.1, 0.2],
                    [-0.7, 0.0],
                ),
                pin(
                    "Q",
                    &[BodyRef::Body(0), BodyRef::Body(1)],
                    [0.7, 0.0],
                    [0.0, 0.3],
                ),
            ],
            ..Description::default()
        };
        Mechanism::build(&description).expect("the chain builds")
    }

    #[test]
    fn kept_rows_are_met_to_double_double() {
        let mechanism = chain();
        let (a, b) = (0.7_f64, -1.9_f64);
        let tip = [0.1 + 1.4 * a.cos(), 0.2 + 1.4 * a.sin()];
        let q = [
            0.1 + 0.7 * a.cos(),
            0.2 + 0.7 * a.sin(),
            a,
            tip[0] + 0.3 * b.sin(),
            tip[1] - 0.3 * b.cos(),
            b,
        ];
        let polished = PolishedConfiguration::at(&mechanism, 0.0, &q, &[0, 1, 2, 3, 99])
            .expect("independent rows");
        for phi in &polished.phi {
            assert!(phi.abs() < Dd::from(1e-30), "{phi:?}");
        }
        for (p, q) in polished.q.iter().zip(q) {
            assert!((p.to_f64() - q).abs() < 1e-15);
        }
        // Compares C with the kernels in `f64`. The entry −(R·s)_y = 0.7·sin a of the first row is
        // compared with a value that has more digits than `f64`.
        let mut s = mechanism.scratch();
        mechanism.pose(0.0, &q, &mut s);
        mechanism.c(&mut s);
        let c = mechanism.layout().dense(&s);
        for i in 0..4 {
            for j in 0..6 {
                assert!((polished.c[(i, j)].to_f64() - c[(i, j)]).abs() < 1e-15);
            }
        }
        let (sin, _) = polished.q[2].sin_cos();
        assert!((polished.c[(0, 2)].abs() - Dd::from(0.7) * sin).abs() < Dd::from(1e-31));
    }
}
