//! The second-order equations as quadratic forms `aᵀ·M_s·a = 0`, one for each self-stress.
//!
//! Γ is quadratic in the velocities and in the rate of time, which is 1. With `v = x₀·v_in + N·(x₁,
//! y)`, Γ becomes homogeneous in `a = (x₀, x₁, y)`. Here x₀ is the rate of time (only if there are
//! functions of time), x₁ are the regular motions, and y are the new motions. The regular and the
//! new motions are orthonormal in dimensionless velocities.

use crate::limits::{FORM_ROUNDING, FORMS_MAX, REGULAR};
use crate::pose::{dimensionless, evaluated, velocity_units};
use linalg::{Matrix, PivotedQr};
use model::start::scene_size;
use model::{Mechanism, Scratch, System};
use rank::{RankDecision, RankStatus};

use super::undetermined::SecondOrderDoubt;

/// The quadratic forms, divided by their largest coefficient.
pub(super) struct Forms {
    /// Number of coordinates x of the motion itself.
    x: usize,
    /// Symmetric matrices (x + y) × (x + y), with zeros in the block of x.
    pub(super) matrices: Vec<Matrix>,
    /// The velocity for each coordinate of a, one in each row.
    basis: Vec<Vec<f64>>,
    /// Whether the first coordinate is the rate of time.
    driven: bool,
}

impl Forms {
    /// Creates the forms at a state. The columns of `regular` may be any velocities that span the
    /// regular motions.
    pub(super) fn new(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        v: &[f64],
        decision: &RankDecision,
        regular: &Matrix,
    ) -> Result<Self, SecondOrderDoubt> {
        let driven = mechanism.layout().rheonomic;
        Self::of(mechanism, (t, q, v), decision, regular, driven)
    }

    /// Creates only the forms of the velocities with `C·v = 0`, with locked functions of time.
    pub(super) fn held(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        decision: &RankDecision,
    ) -> Result<Self, SecondOrderDoubt> {
        let n = mechanism.layout().n_v;
        let rest = vec![0.0; n];
        Self::of(
            mechanism,
            (t, q, &rest),
            decision,
            &Matrix::zeros(n, 0),
            false,
        )
    }

    fn of(
        mechanism: &Mechanism,
        (t, q, v): (f64, &[f64], &[f64]),
        decision: &RankDecision,
        regular: &Matrix,
        driven: bool,
    ) -> Result<Self, SecondOrderDoubt> {
        let mut s = evaluated(mechanism, t, q);
        let size = scene_size(mechanism, q);
        let units = velocity_units(mechanism, size);
        let c = dimensionless(mechanism, &s, size);
        let n = c.ncols();
        // Dimensionless velocities that satisfy C·w = 0, one in each row.
        let kept = decision.scaling.apply(&c).select_rows(&decision.kept);
        let mut null = PivotedQr::of_rows(kept).q_columns(decision.rank..n);
        for k in 0..n {
            let factor = 2.0_f64.powi(decision.scaling.cols[k]);
            null.row_mut(k).iter_mut().for_each(|w| *w *= factor);
        }
        let null = PivotedQr::of_columns(&null).q_columns(0..n - decision.rank);
        let speed = norm(v.iter().zip(&units).map(|(v, u)| v / u));
        let speed = if speed > 0.0 { speed } else { 1.0 };
        let own = Matrix::from_fn(n, regular.ncols(), |k, j| {
            regular[(k, j)] / units[k] / speed
        });
        let (coordinates, x_1) = split(&null.transpose().product(&own))?;
        let y = coordinates.ncols() - x_1;
        if y > FORMS_MAX {
            return Err(SecondOrderDoubt::Kernel {
                found: y,
                most: FORMS_MAX,
            });
        }
        let motions = null.product(&coordinates).transpose();
        let velocity = |row: &[f64]| row.iter().zip(&units).map(|(w, u)| w * u * speed).collect();
        let basis: Vec<Vec<f64>> = driven
            .then(|| v.to_vec())
            .into_iter()
            .chain((0..motions.nrows()).map(|i| velocity(motions.row(i))))
            .collect();
        let mut found = Self {
            x: usize::from(driven) + x_1,
            matrices: Vec::new(),
            basis,
            driven,
        };
        let stresses = self_stresses(decision);
        let natural: Vec<f64> = units.iter().map(|u| u * speed).collect();
        let terms = found.evaluate(mechanism, &mut s, &stresses, (size, &natural));
        found.normalise(terms)?;
        Ok(found)
    }

    /// Returns the number of coordinates.
    pub(super) fn len(&self) -> usize {
        self.basis.len()
    }

    /// Returns the number of coordinates x.
    pub(super) fn x(&self) -> usize {
        self.x
    }

    /// Returns the number of coordinates y.
    pub(super) fn y(&self) -> usize {
        self.len() - self.x
    }

    /// Returns whether the first coordinate is the rate of time, which is not zero.
    pub(super) fn is_driven(&self) -> bool {
        self.driven
    }

    /// Returns the velocity of a solution, scaled to the true rate of time, or to the speed of the
    /// motion.
    pub(super) fn velocity(&self, a: &[f64]) -> Vec<f64> {
        let scale = if self.driven { 1.0 / a[0] } else { 1.0 };
        let mut sum = vec![0.0; self.basis[0].len()];
        for (a, row) in a.iter().zip(&self.basis) {
            for (s, w) in sum.iter_mut().zip(row) {
                *s += scale * a * w;
            }
        }
        sum
    }

    /// Extracts the forms from values of Γ and returns the size of the summed terms. The function
    /// also computes the size of the terms for bodies that all move as fast as the motions, and
    /// returns this size if it is larger. Computed velocities of bodies at rest are rounding, and
    /// the forms of these bodies are rounding as well.
    fn evaluate(
        &mut self,
        mechanism: &Mechanism,
        s: &mut Scratch,
        stresses: &[Vec<f64>],
        (size, natural): (f64, &[f64]),
    ) -> f64 {
        // Without a drive and without freedom, no velocity exists.
        let origin = if self.driven {
            self.basis[0].clone()
        } else {
            vec![0.0; mechanism.layout().n_v]
        };
        let first = usize::from(self.driven);
        // The largest sum of the terms of a self-stress at velocities v.
        let size_of = |v: &[f64], s: &Scratch| -> f64 {
            let of_row = |i: usize| mechanism.scales(s).acceleration(i, v, size);
            let rows: Vec<f64> = (0..mechanism.layout().rows()).map(of_row).collect();
            let sum = |z: &Vec<f64>| z.iter().zip(&rows).map(|(z, row)| z.abs() * row).sum();
            stresses.iter().map(sum).fold(0.0, f64::max)
        };
        mechanism.twist(natural, s);
        mechanism.gamma(s);
        let mut terms = size_of(natural, s);
        // The value z·Γ at the velocity zero plus a sum of motions.
        let mut values = |motions: &[(usize, f64)]| -> Vec<f64> {
            let mut v = origin.clone();
            for &(i, sign) in motions {
                for (v, w) in v.iter_mut().zip(&self.basis[first + i]) {
                    *v += sign * w;
                }
            }
            mechanism.twist(&v, s);
            mechanism.gamma(s);
            let sum = |z: &Vec<f64>| z.iter().zip(&s.gamma).map(|(z, g)| z * g).sum();
            terms = terms.max(size_of(&v, s));
            stresses.iter().map(sum).collect()
        };
        let (d, count) = (self.basis.len() - first, self.basis.len());
        let zero = values(&[]);
        let plus: Vec<_> = (0..d).map(|i| values(&[(i, 1.0)])).collect();
        let minus: Vec<_> = (0..d).map(|i| values(&[(i, -1.0)])).collect();
        let mut matrices = vec![Matrix::zeros(count, count); stresses.len()];
        for (m, form) in matrices.iter_mut().enumerate() {
            if self.driven {
                form[(0, 0)] = zero[m];
            }
            for i in 0..d {
                form[(first + i, first + i)] = 0.5 * (plus[i][m] + minus[i][m]) - zero[m];
                if self.driven {
                    let slope = 0.25 * (plus[i][m] - minus[i][m]);
                    (form[(0, 1 + i)], form[(1 + i, 0)]) = (slope, slope);
                }
            }
        }
        for i in 0..d {
            for j in 0..i {
                let both = values(&[(i, 1.0), (j, 1.0)]);
                for (m, form) in matrices.iter_mut().enumerate() {
                    let mixed = 0.5 * (both[m] - plus[i][m] - plus[j][m] + zero[m]);
                    (form[(first + i, first + j)], form[(first + j, first + i)]) = (mixed, mixed);
                }
            }
        }
        self.matrices = matrices;
        terms
    }

    /// Divides the forms by the largest coefficient and checks that the motion itself is a
    /// solution.
    fn normalise(&mut self, terms: f64) -> Result<(), SecondOrderDoubt> {
        let largest = self
            .matrices
            .iter()
            .map(Matrix::max_abs)
            .fold(0.0, f64::max);
        if self.y() > 0 && largest <= FORM_ROUNDING * terms {
            return Err(SecondOrderDoubt::NoTerms);
        }
        let mut residual = 0.0_f64;
        for form in &mut self.matrices {
            for entry in form.as_mut_slice() {
                *entry /= largest;
            }
            for i in 0..self.x {
                for entry in &mut form.row_mut(i)[..self.x] {
                    residual = residual.max(entry.abs());
                    *entry = 0.0;
                }
            }
        }
        if self.y() > 0 && residual > REGULAR {
            Err(SecondOrderDoubt::Irregular {
                residual,
                tolerance: REGULAR,
            })
        } else {
            Ok(())
        }
    }
}

/// Returns orthonormal coordinates and the number of leading coordinates that span the columns.
fn split(columns: &Matrix) -> Result<(Matrix, usize), SecondOrderDoubt> {
    let decision = rank::decide(columns, rank::Accuracy::Absolute(REGULAR))
        .map_err(SecondOrderDoubt::Regular)?;
    match decision.status {
        RankStatus::Undecided(doubt) => Err(SecondOrderDoubt::RegularCount(doubt)),
        _ => {
            let q = PivotedQr::of_columns(columns).q_columns(0..columns.nrows());
            Ok((q, decision.rank))
        }
    }
}

/// Returns a basis of the left null space for the unscaled rows of C. Rows that belong to no
/// dependency are exactly zero. Otherwise the rounding of these rows would define a form that does
/// not exist.
fn self_stresses(decision: &RankDecision) -> Vec<Vec<f64>> {
    let mut z = rank::orthonormal(decision);
    let none = rank::support_tolerance(decision);
    let entries = z.as_mut_slice().iter_mut();
    entries.filter(|z| z.abs() <= none).for_each(|z| *z = 0.0);
    let of = |j: usize| (0..z.nrows()).map(move |i| (i, j));
    (0..z.ncols())
        .map(|j| {
            of(j)
                .map(|(i, j)| z[(i, j)] * decision.scaling.row_factor(i))
                .collect()
        })
        .collect()
}

fn norm(x: impl Iterator<Item = f64>) -> f64 {
    x.map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests;
