//! Computes the solution that minimises a sum of weighted squares, for minimum norms and elastic
//! supports.

use crate::limits::CHOICE_SOLVES;
use linalg::{Matrix, PivotedQr};

use super::ChoiceError;
use super::multipliers::FreeMultipliers;
use crate::groups::{LinearForm, check, check_finite};
use crate::matrices::Solvability;

/// Returns the λ that minimises `Σ weight·(ℓᵀ·λ)²` over all solutions `λ₀ + Z·y`. Let L contain the
/// rows `√weight·ℓᵀ`. The minimum satisfies `Zᵀ·Lᵀ·L·Z·y = −Zᵀ·Lᵀ·L·λ₀`, which is solved by QR of
/// L·Z. Components of y that do not change any of the numbers ℓᵀ·λ stay zero.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_solvability::{LinearForm, Solvability, minimise};
/// // Three equal springs side by side under a load of 6, then the first one half as stiff.
/// let c = Matrix::from_rows(&[[1.0], [1.0], [1.0]]);
/// let s = Solvability::of(&c, rank::Accuracy::Rounding)?;
/// let of_row = |i| {
///     let mut form = LinearForm::zero(3);
///     form.add(&[(i, 1.0)]).map(|()| form)
/// };
/// let forces = [of_row(0)?, of_row(1)?, of_row(2)?];
/// let equal = forces.clone().map(|f| (f, 1.0));
/// let shares = minimise(&s, &[6.0, 0.0, 0.0], &equal)?;
/// assert!(shares.iter().all(|x| (x - 2.0).abs() < 1e-14));
/// let mut softer = equal;
/// softer[0].1 = 2.0;
/// let shares = minimise(&s, &[6.0, 0.0, 0.0], &softer)?;
/// assert!((shares[0] - 1.2).abs() < 1e-14 && (shares[1] - 2.4).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// - [`ChoiceError::Indeterminate`]: numbers with weight zero are not determined.
/// - [`ChoiceError::Weight`]: a weight is negative or not a number.
/// - [`ChoiceError::Request`]: sizes do not fit.
pub fn minimise(
    solvability: &Solvability,
    lambda_0: &[f64],
    terms: &[(LinearForm, f64)],
) -> Result<Vec<f64>, ChoiceError> {
    let terms = terms.iter().map(|(form, weight)| Term {
        form: form.clone(),
        weight: *weight,
        misfit: 0.0,
    });
    let terms: Vec<Term> = terms.collect();
    minimise_in(&FreeMultipliers::of(solvability), lambda_0, &terms)
}

/// A term `½·weight·(ℓᵀ·λ)² − misfit·ℓᵀ·λ`.
pub(super) struct Term {
    pub(super) form: LinearForm,
    pub(super) weight: f64,
    pub(super) misfit: f64,
}

/// Returns Zᵀ·Σ misfit·ℓ, and the size of the terms of this sum.
pub(super) fn strain(free: &FreeMultipliers<'_>, terms: &[Term]) -> (Vec<f64>, f64) {
    let (mut sum, mut most) = (vec![0.0; free.z.ncols()], 0.0);
    for term in terms.iter().filter(|term| term.misfit != 0.0) {
        let (image, size) = term.form.image(free);
        most += (term.misfit * size).abs();
        for (sum, x) in sum.iter_mut().zip(&image) {
            *sum += term.misfit * size * x;
        }
    }
    (sum, most)
}

/// Works like [`minimise`], for free multipliers and with misfits.
pub(super) fn minimise_in(
    free: &FreeMultipliers<'_>,
    lambda_0: &[f64],
    terms: &[Term],
) -> Result<Vec<f64>, ChoiceError> {
    let z = &free.z;
    check("multipliers", lambda_0, z.nrows())?;
    for Term { form, weight, .. } in terms {
        check("linear form", form.coefficients(), z.nrows())?;
        if !(weight.is_finite() && *weight >= 0.0) {
            return Err(ChoiceError::Weight { value: *weight });
        }
    }
    let images: Vec<(Vec<f64>, f64)> = terms.iter().map(|term| term.form.image(free)).collect();
    let rows: Vec<&[f64]> = images.iter().map(|(image, _)| &image[..]).collect();
    let visible = independent_columns(&rows, z.ncols(), free.tolerance);

    let roots: Vec<f64> = terms.iter().map(|term| term.weight.sqrt()).collect();
    let scales: Vec<f64> = roots.iter().zip(&images).map(|(r, i)| r * i.1).collect();
    let largest = scales.iter().fold(0.0, |a: f64, &b| a.max(b));
    let weighted = Matrix::from_fn(terms.len(), visible.len(), |i, j| {
        scales[i] * rows[i][visible[j]]
    });
    check_finite("weighted forms", weighted.as_slice())?;
    let qr = PivotedQr::of_columns(&weighted);
    let determined = count(&qr, free.tolerance * largest);
    if determined < visible.len() {
        return Err(ChoiceError::Indeterminate {
            free: visible.len() - determined,
        });
    }
    let columns = qr.permutation().iter().map(|&k| visible[k]);
    let columns: Vec<usize> = columns.collect();
    // (Z_Vᵀ·Lᵀ·L·Z_V)·y = Zᵀ·Σ misfit·ℓ for the visible columns V.
    let (all, _) = strain(free, terms);
    let mut strain: Vec<f64> = columns.iter().map(|&k| all[k]).collect();
    qr.solve_r_transpose(&mut strain);
    let mut lambda = lambda_0.to_vec();
    for _ in 0..CHOICE_SOLVES {
        let pairs = terms.iter().zip(&roots);
        let mut y: Vec<f64> = pairs
            .map(|(term, r)| r * term.form.value(&lambda))
            .collect();
        qr.q_transpose_mul(&mut y);
        y.truncate(visible.len());
        y.iter_mut().zip(&strain).for_each(|(y, s)| *y -= s);
        qr.solve_r(&mut y);
        free.leave(&mut lambda, &columns, &y);
    }
    Ok(lambda)
}

/// Selects independent columns of a matrix of images (rows of norm one or less). The remaining
/// columns depend on the selected columns.
pub(super) fn independent_columns(rows: &[&[f64]], columns: usize, tolerance: f64) -> Vec<usize> {
    let matrix = Matrix::from_fn(rows.len(), columns, |i, j| rows[i][j]);
    let qr = PivotedQr::of_columns(&matrix);
    qr.permutation()[..count(&qr, tolerance)].to_vec()
}

/// Returns the number of pivots that are above a tolerance.
fn count(qr: &PivotedQr, tolerance: f64) -> usize {
    qr.r_diagonal().filter(|r| r.abs() > tolerance).count()
}
