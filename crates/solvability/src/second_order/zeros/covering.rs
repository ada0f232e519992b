//! Proves that there is no common zero. Boxes cover the sphere, and in each box some combination of
//! the forms has no zero.
//!
//! Zeros are directions. Therefore the faces `a_i = 1`, `|a_k| ≤ 1` of the cube contain all zeros.
//! In a box with centre c and half width h, a form differs from its value at c by at most
//! `h·Σ|g_k| + h²·Σ|M_kl|`, where g is the gradient of the form at c. Four kinds of combinations
//! are tried: the forms themselves, the steepest combination for the values at c, the part of this
//! combination that is orthogonal to the gradients, and the combinations of Newton's method, whose
//! gradients have one unknown each.

use crate::limits::{BOX_HALVINGS, BOXES};
use linalg::{Matrix, small_svd};

use super::independent::{Independent, value};

/// Part of a face of the cube.
struct Part {
    /// The unknown that is 1.
    face: usize,
    /// All unknowns at the centre of the part.
    centre: Vec<f64>,
    halvings: i32,
}

/// Returns whether boxes without a common zero cover the sphere.
pub(super) fn excludes(forms: &Independent) -> bool {
    let mut open: Vec<Part> = (0..forms.unknowns)
        .map(|face| Part {
            face,
            centre: (0..forms.unknowns).map(|k| f64::from(k == face)).collect(),
            halvings: 0,
        })
        .collect();
    let mut boxes = 0;
    while let Some(part) = open.pop() {
        boxes += 1;
        if boxes > BOXES {
            return false;
        }
        if part.has_no_zero(forms) {
            continue;
        }
        if part.halvings == BOX_HALVINGS || forms.unknowns == 1 {
            return false;
        }
        open.extend(part.halved());
    }
    true
}

impl Part {
    fn half_width(&self) -> f64 {
        (-f64::from(self.halvings)).exp2()
    }

    fn free(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.centre.len()).filter(|k| *k != self.face)
    }

    /// Returns the parts with half the width.
    fn halved(&self) -> impl Iterator<Item = Self> + '_ {
        let step = 0.5 * self.half_width();
        let free: Vec<usize> = self.free().collect();
        (0..1_usize << free.len()).map(move |signs| {
            let mut centre = self.centre.clone();
            for (bit, k) in free.iter().enumerate() {
                centre[*k] += if signs >> bit & 1 == 1 { step } else { -step };
            }
            Self {
                face: self.face,
                centre,
                halvings: self.halvings + 1,
            }
        })
    }

    /// Returns whether some combination of the forms has no zero in this part.
    fn has_no_zero(&self, forms: &Independent) -> bool {
        let singles = forms.forms.iter().zip(&forms.error);
        let mut singles = singles.map(|(m, error)| (m, *error));
        singles.any(|(m, error)| self.is_free_of(m, error))
            || self.weights(forms).iter().any(|w| {
                let (m, error) = forms.combination(w);
                self.is_free_of(&m, error)
            })
    }

    /// Returns whether a form has no zero in this part. `error` contains the errors of the
    /// coefficients of the form.
    fn is_free_of(&self, m: &Matrix, error: f64) -> bool {
        let h = self.half_width();
        let image = m.times(&self.centre);
        let slope: f64 = self.free().map(|k| 2.0 * image[k].abs()).sum();
        let curvature: f64 = self
            .free()
            .flat_map(|k| self.free().map(move |l| (k, l)))
            .map(|(k, l)| m[(k, l)].abs())
            .sum();
        let size =
            self.centre.iter().map(|x| x.abs()).sum::<f64>() + h * (self.centre.len() - 1) as f64;
        value(m, &self.centre).abs() > h * slope + h * h * curvature + error * size * size
    }

    /// Returns combinations of the forms that are large in this part compared with their gradients.
    fn weights(&self, forms: &Independent) -> Vec<Vec<f64>> {
        let values = forms.values(&self.centre);
        let free: Vec<usize> = self.free().collect();
        let gradients = Matrix::from_fn(values.len(), free.len(), |s, k| {
            2.0 * forms.forms[s].times(&self.centre)[free[k]]
        });
        let svd = small_svd(&gradients);
        let mut left = values.clone();
        let mut newton = Matrix::zeros(free.len(), values.len());
        let first = svd.sigma.first().copied().unwrap_or(0.0);
        for (k, sigma) in svd.sigma.iter().enumerate() {
            if *sigma <= f64::EPSILON * first {
                continue;
            }
            let along: f64 = (0..values.len()).map(|s| svd.u[(s, k)] * values[s]).sum();
            for s in 0..values.len() {
                left[s] -= along * svd.u[(s, k)];
                for i in 0..free.len() {
                    newton[(i, s)] += svd.v[(i, k)] * svd.u[(s, k)] / sigma;
                }
            }
        }
        let mut weights = vec![values, left];
        weights.extend((0..free.len()).map(|i| newton.row(i).to_vec()));
        weights
    }
}
