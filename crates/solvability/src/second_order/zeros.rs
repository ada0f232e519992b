//! Decides whether quadratic forms have a common real zero other than the origin.
//!
//! The first two of the three results are proofs. The proofs apply to every set of forms whose
//! coefficients differ from the given ones by at most a stated error:
//!
//! - [`CommonZero::None`]: a combination of the forms is definite, or boxes cover the sphere. In
//!   each box, some combination of the forms has no zero ([`covering`]).
//! - [`CommonZero::Transversal`]: an interval Newton test finds a zero at which the gradients of
//!   the forms are independent ([`transversal`]).
//! - [`CommonZero::Undecided`]: there is no proof. Examples are double zeros, and a common zero of
//!   as many independent forms as unknowns. Arbitrarily small changes of the coefficients remove
//!   such zeros.
//!
//! Source of the test: R. Krawczyk, Newton-Algorithmen zur Bestimmung von Nullstellen mit
//! Fehlerschranken, Computing 4 (1969) 187–201.

mod covering;
mod independent;
mod transversal;

use linalg::Matrix;

use super::definite::has_definite_combination;
use crate::limits::{COVERED_UNKNOWNS, MARGIN};
use independent::Independent;

/// Whether quadratic forms `aᵀ·M_s·a` have a common zero a ≠ 0.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CommonZero {
    /// The forms have no common zero.
    None,
    /// The forms have a common zero near this unit vector. A zero also exists for slightly
    /// different coefficients.
    Transversal(Vec<f64>),
    /// Neither the existence nor the absence of a common zero is proved within the error of the
    /// coefficients.
    Undecided,
}

/// Decides whether symmetric matrices M_s (d × d, finite) have a common zero a ≠ 0 of `aᵀ·M_s·a`.
/// Each coefficient may be wrong by `error` (absolute; the forms are used as they are). If there
/// are no forms, or if all forms are zero, no zero is transversal, and the result is undecided.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_solvability::{CommonZero, common_zero};
/// let form = |a: f64, b: f64, c: f64| Matrix::from_rows(&[[a, b], [b, c]]);
/// // x² − y² and x·y: no combination is definite, and there is no common zero.
/// let forms = [form(1.0, 0.0, -1.0), form(0.0, 0.5, 0.0)];
/// assert_eq!(common_zero(&forms, 1e-12), CommonZero::None);
/// // x² − y² alone has simple zeros, (x − y)² a double one.
/// assert!(matches!(common_zero(&forms[..1], 1e-12), CommonZero::Transversal(_)));
/// assert_eq!(common_zero(&[form(1.0, -1.0, 1.0)], 1e-12), CommonZero::Undecided);
/// ```
///
/// # Panics
/// Panics if the matrices are not square or have different sizes.
#[must_use]
pub fn common_zero(forms: &[Matrix], error: f64) -> CommonZero {
    let unknowns = forms.first().map_or(0, Matrix::ncols);
    let is_square = |m: &Matrix| m.nrows() == unknowns && m.ncols() == unknowns;
    assert!(forms.iter().all(is_square), "square matrices of one size");
    let independent = Independent::of(forms, unknowns, error);
    if independent.forms.is_empty() {
        return CommonZero::Undecided;
    }
    let doubt = independent.error.iter().sum::<f64>() * unknowns as f64;
    if doubt < MARGIN && has_definite_combination(&independent.forms, unknowns) {
        return CommonZero::None;
    }
    if let Some(zero) = transversal::found(&independent) {
        return CommonZero::Transversal(zero);
    }
    if unknowns <= COVERED_UNKNOWNS && covering::excludes(&independent) {
        return CommonZero::None;
    }
    CommonZero::Undecided
}

/// Returns whether a test proves that the forms have a common zero near a. The gradients of the
/// forms must be independent at this zero.
pub(super) fn is_transversal(forms: &[Matrix], error: f64, a: &[f64]) -> bool {
    transversal::is_proved(&Independent::of(forms, a.len(), error), a)
}

#[cfg(test)]
mod tests;
