//! The reference results are computed in integer arithmetic, in which all results for integers
//! below 2¹⁰⁶ are exact.

use proptest::prelude::*;

use super::*;

/// Integers up to 2⁵³ are exact in `f64`.
const LARGEST: i64 = 1 << 53;

/// Returns the exact integer value of a double-double whose parts are integers.
fn integer(x: Dd) -> i128 {
    assert!(x.hi.fract() == 0.0 && x.lo.fract() == 0.0, "{x:?}");
    x.hi as i128 + x.lo as i128
}

fn dd(x: i128) -> Dd {
    let hi = x as f64;
    Dd::from_sum(hi, (x - hi as i128) as f64)
}

proptest! {
    #[test]
    fn products_of_integers_are_exact(a in -LARGEST..LARGEST, b in -LARGEST..LARGEST) {
        let p = Dd::from(a as f64) * Dd::from(b as f64);
        prop_assert_eq!(integer(p), i128::from(a) * i128::from(b));
    }

    #[test]
    fn sums_of_long_integers_are_exact(a in -(1i128 << 100)..1i128 << 100, b in -(1i128 << 100)..1i128 << 100) {
        prop_assert_eq!(integer(dd(a) + dd(b)), a + b);
        prop_assert_eq!(integer(dd(a) - dd(b)), a - b);
    }

    #[test]
    fn product_of_long_integers(a in 1i128 << 60..1i128 << 62, b in 1i128 << 60..1i128 << 62) {
        let (p, exact) = (dd(a) * dd(b), a * b);
        // Joldes et al. bound algorithm 10 by 5·2⁻¹⁰⁶.
        let error = (integer(p) - exact).unsigned_abs() as f64;
        prop_assert!(error <= 5.0 * 2f64.powi(-106) * exact as f64);
    }

    #[test]
    fn product_with_a_single_number(a in 1i128 << 60..1i128 << 62, b in 1i64 << 40..1i64 << 53) {
        let (p, exact) = (dd(a) * b as f64, a * i128::from(b));
        // Joldes et al. bound algorithm 8 by 3·2⁻¹⁰⁶.
        let error = (integer(p) - exact).unsigned_abs() as f64;
        prop_assert!(error <= 3.0 * 2f64.powi(-106) * exact as f64);
    }

    #[test]
    fn quotients_by_long_division(a in 1i64 << 40..1i64 << 53, b in 1i64 << 20..1i64 << 30) {
        // The expected value is floor(a·2⁶⁰ / b) in integers; the quotient is between 2⁷⁰ and 2⁹³.
        let exact = (i128::from(a) << 60) / i128::from(b);
        let q = Dd::from(a as f64) / Dd::from(b as f64) * Dd::from(2f64.powi(60));
        let off = (q - dd(exact)).to_f64();
        let slack = 16.0 * Dd::EPSILON * exact as f64;
        prop_assert!(off >= -slack && off <= 1.0 + slack, "{}", off);
    }

    #[test]
    fn roots_of_long_squares(a in 1i128 << 40..1i128 << 52) {
        prop_assert_eq!(integer(dd(a * a).sqrt()), a);
    }

    #[test]
    fn error_terms_match_fused_multiply_add(a in -1e100..1e100_f64, b in -1e100..1e100_f64) {
        let (p, e) = two_product(a, b);
        prop_assert_eq!(e, a.mul_add(b, -p));
    }

    #[test]
    fn order_is_that_of_integers(a in -(1i128 << 100)..1i128 << 100, b in -(1i128 << 100)..1i128 << 100) {
        prop_assert_eq!(dd(a).partial_cmp(&dd(b)), a.partial_cmp(&b));
        prop_assert_eq!(integer(dd(a).abs()), a.abs());
    }
}

/// √2 = 1.41421356237309504880168872420969807856967187537694807317668…. The digits are compared by
/// squaring the truncated integer root, so the test does not rely on a constant in this file:
/// 2·10³⁰ lies between the squares of two neighbouring integers.
#[test]
fn root_of_two_to_thirty_digits() {
    let root: i128 = 1_414_213_562_373_095;
    assert!(root * root < 2 * 10i128.pow(30) && (root + 1).pow(2) > 2 * 10i128.pow(30));
    let dd_root = Dd::from(2.0).sqrt();
    assert_eq!(dd_root.hi(), std::f64::consts::SQRT_2);
    // The low word is published, for example, in the table of constants of QD.
    assert!((dd_root.lo() + 9.667_293_313_452_913e-17).abs() < Dd::EPSILON);
    let back = dd_root * dd_root - Dd::from(2.0);
    assert!(back.to_f64().abs() < 8.0 * Dd::EPSILON);
}

/// e = Σ 1/k!, to 31 digits: 2.718281828459045 + 1.445646891729250e-16 (low word of the known
/// expansion 2.71828182845904523536028747135266249775724709369995…).
#[test]
fn series_of_e() {
    let (mut term, mut sum) = (Dd::ONE, Dd::ONE);
    for k in 1..30 {
        term = term / Dd::from(f64::from(k));
        sum += term;
    }
    assert_eq!(sum.hi(), std::f64::consts::E);
    assert!(
        (sum.lo() - 1.445_646_891_729_250_2e-16).abs() < Dd::EPSILON,
        "{:e}",
        sum.lo()
    );
}

#[test]
fn special_values() {
    assert!(Dd::from(-1.0).sqrt().to_f64().is_nan());
    assert_eq!(Dd::ZERO.sqrt(), Dd::ZERO);
    assert_eq!((Dd::ONE / Dd::ZERO).to_f64(), f64::INFINITY);
    assert_eq!(Dd::from(f64::NAN).partial_cmp(&Dd::ONE), None);
}
