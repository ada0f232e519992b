//! Forms whose common zeros are known in closed form.

use super::*;
use CommonZero::{None, Undecided};

/// Rounding error of coefficients that are exact numbers.
const ERROR: f64 = 1e-15;

/// Returns the form a·x² + 2·b·x·y + c·y².
fn two(a: f64, b: f64, c: f64) -> Matrix {
    Matrix::from_rows(&[[a, b], [b, c]])
}

/// Returns (p·x)·(q·x), the product of two linear forms.
fn product<const N: usize>(p: [f64; N], q: [f64; N]) -> Matrix {
    Matrix::from_fn(N, N, |i, j| 0.5 * (p[i] * q[j] + p[j] * q[i]))
}

fn diagonal<const N: usize>(d: [f64; N]) -> Matrix {
    Matrix::from_fn(N, N, |i, j| if i == j { d[i] } else { 0.0 })
}

/// Checks that a zero of these forms is found to the accuracy of the search.
fn assert_free(forms: &[Matrix]) {
    let CommonZero::Transversal(a) = common_zero(forms, ERROR) else {
        panic!("{forms:?}: {:?}", common_zero(forms, ERROR));
    };
    for form in forms {
        let value = independent::value(form, &a);
        assert!(value.abs() < 1e-12 * form.max_abs(), "{value:e} at {a:?}");
    }
}

#[test]
fn one_unknown() {
    let form = |g: f64| Matrix::from_rows(&[[g]]);
    assert_eq!(common_zero(&[form(1.0)], ERROR), None);
    assert_eq!(common_zero(&[form(0.0)], ERROR), Undecided);
    assert_eq!(common_zero(&[form(1.0), form(0.5)], 1e-4), None);
    assert_eq!(common_zero(&[form(1.0)], 2.0), Undecided);
    assert_eq!(common_zero(&[], ERROR), Undecided);
}

/// With two unknowns, the roots of each form are y/x = tan of two angles.
#[test]
fn two_unknowns() {
    // No combination is definite, and the roots ±1 are neither 0 nor ∞.
    assert_eq!(
        common_zero(&[two(1.0, 0.0, -1.0), two(0.0, 0.5, 0.0)], ERROR),
        None
    );
    assert_free(&[two(1.0, 0.0, -1.0)]);
    assert_free(&[two(0.0, 1.0, 0.0), two(0.0, -3.0, 0.0)]);
    assert_eq!(common_zero(&[two(1.0, -2.0, 4.0)], ERROR), Undecided);
    // The forms are (x − y)·(x + 2y) and (x − y)·(x + 5y). If one root changes slightly, the common
    // root splits.
    let both = [
        product([1.0, -1.0], [1.0, 2.0]),
        product([1.0, -1.0], [1.0, 5.0]),
    ];
    assert_eq!(common_zero(&both, ERROR), Undecided);
    // x² + y² is among the combinations of three independent forms.
    let three = [two(1.0, 0.0, 0.0), two(0.0, 1.0, 0.0), two(1.0, 0.0, 1.0)];
    assert_eq!(common_zero(&three, ERROR), None);
}

/// The roots 1 and 1 + d of two forms are different numbers if d is larger than a few rounding
/// errors.
#[test]
fn nearly_common_zeros_are_told_apart() {
    for (d, expected) in [(1e-10, None), (1e-6, None), (1e-17, Undecided)] {
        let forms = [
            product([1.0, -1.0], [1.0, 2.0]),
            product([1.0 + d, -1.0], [1.0, 5.0]),
        ];
        assert_eq!(common_zero(&forms, ERROR), expected, "{d}");
    }
}

/// The forms are x² + y² − 2·z² and x·y − c·z². With x = r·cos φ, y = r·sin φ, the first form gives
/// r² = 2·z², and the second form gives sin 2φ = c. There are four zeros for |c| < 1, no zeros for
/// |c| > 1, and double zeros at ±1.
#[test]
fn three_unknowns() {
    let circle = diagonal([1.0, 1.0, -2.0]);
    let with = |c: f64| {
        let mut hyperbola = product([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        hyperbola[(2, 2)] = -c;
        [circle.clone(), hyperbola]
    };
    assert_free(&with(0.3));
    assert_free(&with(0.999));
    assert_eq!(common_zero(&with(1.001), ERROR), None);
    assert_eq!(common_zero(&with(-4.0), ERROR), None);
    assert_eq!(common_zero(&with(1.0), ERROR), Undecided);
}

/// The common zeros of the forms x·y, y·z and z·x are the axes. If x² − 2y² + 4z² is added, the
/// forms have no common zero. No combination is definite both in the directions of the three axes
/// and in directions such as (1, 1, 1).
#[test]
fn no_definite_combination_is_needed_in_three_unknowns() {
    let axes = |i: usize, j: usize| {
        Matrix::from_fn(3, 3, |k, l| f64::from((k, l) == (i, j) || (l, k) == (i, j)))
    };
    let pairs = [axes(0, 1), axes(1, 2), axes(2, 0)];
    assert_eq!(common_zero(&pairs, ERROR), Undecided);
    let mut all = pairs.to_vec();
    all.push(diagonal([1.0, -2.0, 4.0]));
    assert!(!has_definite_combination(&all, 3));
    assert_eq!(common_zero(&all, ERROR), None);
}

/// The forms are the real parts and the imaginary parts of (x + i·y)² = x² − y² + 2i·x·y and of
/// (z + i·w)². All forms vanish together only at zero. The motion is blocked. The traces are zero,
/// so no combination is definite.
#[test]
fn four_unknowns_are_covered() {
    let (x, y, z, w) = (0, 1, 2, 3);
    let entry = |terms: &[(usize, usize, f64)]| {
        let mut m = Matrix::zeros(4, 4);
        for &(i, j, value) in terms {
            m[(i, j)] += 0.5 * value;
            m[(j, i)] += 0.5 * value;
        }
        m
    };
    let forms = [
        entry(&[(x, x, 1.0), (y, y, -1.0)]),
        entry(&[(x, y, 2.0)]),
        entry(&[(z, z, 1.0), (w, w, -1.0)]),
        entry(&[(z, w, 2.0)]),
    ];
    assert!(!has_definite_combination(&forms, 4));
    assert_eq!(common_zero(&forms, ERROR), None);
    // The solutions x = ±y and z = ±w intersect; z and w alone are double zeros of the first two
    // forms.
    assert_free(&[forms[0].clone(), forms[2].clone()]);
    assert_eq!(common_zero(&forms[..2], ERROR), Undecided);
}

/// The forms are x·y and x·y + 1e-9·(x² − y²): 1e-9 is small, but far above the error.
#[test]
fn nearly_dependent_forms_are_used() {
    let forms = [two(0.0, 0.5, 0.0), two(1e-9, 0.5, -1e-9)];
    assert_eq!(common_zero(&forms, ERROR), None);
    // With this size, the difference may be an error, and it may therefore be zero.
    assert_free(&[two(0.0, 0.5, 0.0), two(1e-17, 0.5, -1e-17)]);
}

/// The remainder of the second form is above its error, but it is too small to be used. The form
/// x·y alone has zeros, and it is undecided whether these zeros are common.
#[test]
fn a_form_above_its_error_is_no_rounding() {
    let forms = [two(0.0, 0.5, 0.0), two(1e-13, 0.5, -1e-13)];
    assert_eq!(common_zero(&forms, ERROR), Undecided);
}

/// The form x² − s²·y² has the roots ±s. The roots are simple if s² is above the error of the
/// coefficients.
#[test]
fn a_double_zero_is_one_to_the_root_of_the_error() {
    assert_free(&[two(1.0, 0.0, -1e-10)]);
    assert_eq!(common_zero(&[two(1.0, 0.0, -1e-16)], ERROR), Undecided);
}
