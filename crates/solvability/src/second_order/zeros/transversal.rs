//! Proves that a common zero with independent gradients exists, by Krawczyk's test on a subspace.
//!
//! At a with `a_i = 1`, let J be the gradients in the other unknowns u and A = J⁺. On the subspace
//! `u = u₀ + A·t` the equations are `G(t) = F(u₀ + A·t) = 0` with `G'(0) = J·A = I`. If `‖G(0)‖ +
//! ‖I − G'‖·ρ ≤ ρ` in the ball of radius ρ, then `t − G(t)` maps the ball into itself and has a
//! fixed point in the ball. All norms are enlarged by the errors of the coefficients.

use crate::limits::TRANSVERSAL_STARTS;
use linalg::{Matrix, small_svd};

use super::super::branches::{solve, starting_point};
use super::independent::Independent;

/// Returns a unit vector near a proved common zero, if a search finds one.
pub(super) fn found(forms: &Independent) -> Option<Vec<f64>> {
    // Transversal zeros exist only if there are fewer forms than unknowns.
    if !forms.spans_all || forms.forms.len() >= forms.unknowns {
        return None;
    }
    (0..TRANSVERSAL_STARTS)
        .filter_map(|start| solve(&forms.forms, starting_point(forms.unknowns, start)))
        .find(|a| is_proved(forms, a))
}

/// Returns whether there is a common zero near a, for all coefficients within their errors.
pub(super) fn is_proved(forms: &Independent, a: &[f64]) -> bool {
    if !forms.spans_all || forms.forms.len() >= forms.unknowns {
        return false;
    }
    let largest = (0..a.len()).fold(0, |k, i| if a[i].abs() > a[k].abs() { i } else { k });
    let a: Vec<f64> = a.iter().map(|x| x / a[largest]).collect();
    let free: Vec<usize> = (0..a.len()).filter(|i| *i != largest).collect();
    let images: Vec<Vec<f64>> = forms.forms.iter().map(|m| m.times(&a)).collect();
    let jacobian = Matrix::from_fn(images.len(), free.len(), |s, k| 2.0 * images[s][free[k]]);
    let svd = small_svd(&jacobian);
    let smallest = svd.sigma.last().copied().unwrap_or(0.0);
    if smallest.is_nan() || smallest == 0.0 {
        return false;
    }
    let steep = smallest.recip();
    let count = forms.forms.len() as f64;
    let size: f64 = a.iter().map(|x| x.abs()).sum();
    let error = norm(forms.error.iter().copied());
    let residual = norm(forms.values(&a)) + error * size * size;
    // ‖J·A − I‖ is bounded by the errors of J and the rounding of A.
    let slope = steep * 2.0 * error * size * (free.len() as f64).sqrt()
        + f64::EPSILON * 16.0 * count * svd.sigma[0] * steep;
    // The forms are orthonormal. Therefore the second derivatives of all forms together are below
    // 2·√e.
    let curvature = 2.0 * count.sqrt() * steep * steep;
    let radius = 2.0 * residual;
    slope + curvature * radius <= 0.5
}

fn norm(x: impl IntoIterator<Item = f64>) -> f64 {
    x.into_iter().map(|x| x * x).sum::<f64>().sqrt()
}
