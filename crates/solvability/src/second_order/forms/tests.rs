//! Forms with solutions in closed form. The cases lie on both sides of the limits of the decisions.

use super::*;
use crate::second_order::{branches::others, definite::is_blocked};

/// Returns forms with at most one regular motion `x`, and with new motions.
fn forms(x: usize, matrices: &[Matrix]) -> Forms {
    Forms {
        x,
        basis: vec![Vec::new(); matrices[0].ncols()],
        matrices: matrices.to_vec(),
        driven: false,
    }
}

/// Returns the diagonal matrix of two new motions.
fn diagonal(g: [f64; 2]) -> Matrix {
    Matrix::from_rows(&[[g[0], 0.0], [0.0, g[1]]])
}

/// The equation `g·y² = 0` has only the solution y = 0, unless g is a rounding error.
#[test]
fn a_definite_form_blocks_from_its_margin_on() {
    for (g, expected) in [(0.7e-5, false), (1.4e-5, true)] {
        let form = Matrix::from_rows(&[[0.0, 0.0], [0.0, g]]);
        assert_eq!(is_blocked(&forms(1, &[form])), expected, "{g}");
    }
}

/// The forms are x·y₁ + x·y₂ + y₁² + y₂² and x·y₁ + (1 + 2d)·x·y₂. Their difference does not
/// contain x·y₁. It has singular values of about d that contain the motion. The difference is a
/// proof only if these values are rounding errors.
#[test]
fn a_proof_contains_the_motion_by_rounding_only() {
    for (d, expected) in [(5e-9, true), (5e-8, false)] {
        let form = |second: f64, g: f64| {
            Matrix::from_rows(&[[0.0, 1.0, second], [1.0, g, 0.0], [second, 0.0, g]])
        };
        let pair = [form(1.0, 1.0), form(1.0 + 2.0 * d, 0.0)];
        assert_eq!(is_blocked(&forms(1, &pair)), expected, "{d}");
    }
}

/// The forms are diag(1, −0.99) and diag(−9.7, 10). The sum of 9.8 times the first form and the
/// second form is definite, but only few other combinations are definite.
#[test]
fn narrow_proofs_are_found() {
    let pair = [diagonal([1.0, -0.99]), diagonal([-9.7, 10.0])];
    assert!(is_blocked(&forms(0, &pair)));
    // No combination is definite: y₁ = y₂ solves both equations.
    let pair = [diagonal([1.0, -1.0]), diagonal([-1.0, 1.0])];
    assert!(!is_blocked(&forms(0, &pair)));
}

/// The other branch of `y·(y − s·x) = 0` is y = s·x.
#[test]
fn a_branch_differs_from_the_motion_by_a_thousandth() {
    for (s, expected) in [(0.7e-3, 0), (1.4e-3, 1)] {
        let form = Matrix::from_rows(&[[0.0, -0.5 * s], [-0.5 * s, 1.0]]);
        let found = others(&forms(1, &[form]));
        assert_eq!(found.len(), expected, "{s}: {found:?}");
        if let [a] = &found[..] {
            assert!((a[1] / a[0] - s).abs() < 1e-12, "{a:?}");
        }
    }
}

/// On the parabola `x·y₂ = y₁²`, the cubic (p − 1)·(p − 1 − d)·(p + 1) of p = y₁/x is a quadratic
/// form, in which p·y₂ replaces p³. The cosine of the directions of p = 1 and p = 1 + d is 1 −
/// d²/3.
#[test]
fn branches_nearer_than_a_thousandth_are_one() {
    for (d, expected) in [(1e-3, 2), (3e-3, 3)] {
        // p³ − (1 + d)·p² − p + (1 + d), times p: p²·p² − (1 + d)·p·p² − p² + (1 + d)·p.
        let mut quartic = Matrix::zeros(3, 3);
        quartic[(2, 2)] = 1.0;
        (quartic[(1, 2)], quartic[(2, 1)]) = (-0.5 * (1.0 + d), -0.5 * (1.0 + d));
        quartic[(1, 1)] = -1.0;
        (quartic[(0, 1)], quartic[(1, 0)]) = (0.5 * (1.0 + d), 0.5 * (1.0 + d));
        let parabola = Matrix::from_rows(&[[0.0, 0.0, 0.5], [0.0, -1.0, 0.0], [0.5, 0.0, 0.0]]);
        let found = others(&forms(1, &[parabola, quartic]));
        assert_eq!(found.len(), expected, "{d}: {found:?}");
    }
}

/// A single new motion, y = ±1, satisfies `g·y² = 0` if g is a rounding error.
#[test]
fn a_branch_meets_its_equations_to_rounding() {
    for (g, expected) in [(0.7e-12, 1), (1.4e-12, 0)] {
        let form = Matrix::from_rows(&[[g]]);
        assert_eq!(others(&forms(0, &[form])).len(), expected, "{g}");
    }
}

/// The given motion satisfies its equations to 1e-6 of their coefficients. Coefficients below 1e-10
/// of their terms count as zero.
#[test]
fn forms_are_of_a_motion_and_no_rounding() {
    let normalised = |own: f64, terms: f64| {
        forms(1, &[Matrix::from_rows(&[[own, 0.5], [0.5, 1.0]])]).normalise(terms)
    };
    assert_eq!(normalised(0.7e-6, 1.0), Ok(()));
    assert!(matches!(
        normalised(1.4e-6, 1.0),
        Err(SecondOrderDoubt::Irregular { .. })
    ));
    assert_eq!(normalised(0.0, 0.7e10), Ok(()));
    assert_eq!(normalised(0.0, 1.4e10), Err(SecondOrderDoubt::NoTerms));
}
