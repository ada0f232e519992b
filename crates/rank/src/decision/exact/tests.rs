//! Compares exact decisions with fraction-free elimination of big integers, and with manually
//! solved cases.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

use super::*;
use crate::decision::tests::{Numbers, kahan, parallel_cranks};
use crate::{ExactNullSpace, components};

/// Returns the entries times 2^1074, which are integers.
fn integers(c: &Matrix) -> Vec<Vec<BigInt>> {
    let entry = |x: f64| {
        let bits = x.to_bits();
        let (field, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        let (mantissa, shift) = if field == 0 {
            (fraction, 0)
        } else {
            (fraction | 1 << 52, field - 1)
        };
        let n = BigInt::from(mantissa) << shift;
        if x < 0.0 { -n } else { n }
    };
    (0..c.nrows())
        .map(|i| c.row(i).iter().map(|&x| entry(x)).collect())
        .collect()
}

/// Returns the rank by Bareiss' elimination.
fn oracle_rank(mut a: Vec<Vec<BigInt>>) -> usize {
    let (m, n) = (a.len(), a.first().map_or(0, Vec::len));
    let mut previous = BigInt::from(1);
    let mut rank = 0;
    for j in 0..n {
        let Some(pivot) = (rank..m).find(|&i| !a[i][j].is_zero()) else {
            continue;
        };
        a.swap(rank, pivot);
        for i in rank + 1..m {
            for k in j + 1..n {
                a[i][k] = (&a[i][k] * &a[rank][j] - &a[i][j] * &a[rank][k]) / &previous;
            }
            a[i][j] = BigInt::zero();
        }
        previous = a[rank][j].clone();
        rank += 1;
    }
    rank
}

/// Checks all results of a decision against the oracle: the rank, the kept rows, the zeros of T,
/// and the values of T.
fn check(c: &Matrix) -> RankDecision {
    let decision = certify_exact(c).unwrap();
    let a = integers(c);
    let of = |rows: &[usize]| oracle_rank(rows.iter().map(|&i| a[i].clone()).collect());
    assert_eq!(decision.rank, oracle_rank(a.clone()), "{c:?}");
    assert_eq!(of(&decision.kept), decision.rank, "kept rows of {c:?}");
    assert_eq!(decision.kept.len() + decision.dropped.len(), c.nrows());
    assert!(
        decision.coefficients.max_abs() <= COEFFICIENT_BOUND,
        "{:?}",
        decision.coefficients
    );
    let z = ExactNullSpace::new(c).unwrap();
    for (j, &row) in decision.dropped.iter().enumerate() {
        for (k, &kept) in decision.kept.iter().enumerate() {
            // T_jk ≠ 0 iff row j may replace kept row k.
            let mut exchanged = decision.kept.clone();
            exchanged[k] = row;
            let zero = of(&exchanged) < decision.rank;
            assert_eq!(
                decision.coefficients[(j, k)] == 0.0,
                zero,
                "T[{row}, {kept}] of {c:?}"
            );
        }
    }
    let coloops = components(&decision).coloops;
    for i in 0..c.nrows() {
        let others: Vec<usize> = (0..c.nrows()).filter(|&l| l != i).collect();
        assert_eq!(
            coloops.contains(&i),
            of(&others) < decision.rank,
            "row {i} of {c:?}"
        );
        assert_eq!(z.annihilates([(i, 1.0)]), of(&others) < decision.rank);
        // The wrench of a group is unique iff its rank and the rank of the other rows add up to r.
        let (group, rest): (Vec<usize>, Vec<usize>) =
            (0..c.nrows()).partition(|l| l.abs_diff(i) < 2);
        assert_eq!(
            z.wrench_vanishes(&group),
            of(&group) + of(&rest) == decision.rank
        );
    }
    let bound = decision.evidence.certificate.as_ref().unwrap().sigma_bound;
    assert!(
        bound <= decision.evidence.sigma_r * 1.001,
        "{bound:e} {:e}",
        decision.evidence.sigma_r
    );
    decision
}

/// Returns the determinant of the kept rows with one exchanged row, divided by the determinant of
/// the kept rows, for square kept rows.
fn cramer(c: &Matrix, decision: &RankDecision, j: usize, k: usize) -> f64 {
    fn det(mut a: Vec<Vec<BigInt>>) -> BigInt {
        let n = a.len();
        let mut sign = 1;
        let mut previous = BigInt::from(1);
        for s in 0..n {
            let Some(p) = (s..n).find(|&i| !a[i][s].is_zero()) else {
                return BigInt::zero();
            };
            if p != s {
                a.swap(s, p);
                sign = -sign;
            }
            for i in s + 1..n {
                for l in s + 1..n {
                    a[i][l] = (&a[i][l] * &a[s][s] - &a[i][s] * &a[s][l]) / &previous;
                }
            }
            previous = a[s][s].clone();
        }
        previous * sign
    }
    let a = integers(c);
    let rows = |kept: &[usize]| kept.iter().map(|&i| a[i].clone()).collect::<Vec<_>>();
    let mut exchanged = decision.kept.clone();
    exchanged[k] = decision.dropped[j];
    let (mut numerator, denominator) = (det(rows(&exchanged)), det(rows(&decision.kept)));
    // 400 binary digits after the point are enough for any quotient in the tests.
    numerator <<= 400;
    let quotient = numerator / denominator;
    let bits = quotient.abs().bits();
    let shift = bits.saturating_sub(100);
    (quotient >> shift).to_f64().unwrap() * 2f64.powi(shift as i32 - 400)
}

#[test]
fn planted_integers_sizes_and_near_redundancy_agree_with_big_integers() {
    let mut numbers = Numbers(7);
    for case in 0..300 {
        let (m, n) = (1 + numbers.below(8), 1 + numbers.below(7));
        let r = numbers.below(m.min(n) + 1);
        let mut small = |m, n| Matrix::from_fn(m, n, |_, _| numbers.below(5) as f64 - 2.0);
        let mut c = small(m, r).product(&small(r, n));
        if case % 3 == 1 {
            // The sizes extend over 1e±8. Rows are multiplied by factors that f64 rounds, so
            // rounding may destroy a redundancy.
            for i in 0..m {
                let factor = 10f64.powf(8.0 * numbers.unit());
                c.row_mut(i).iter_mut().for_each(|x| *x *= factor);
            }
        }
        if case % 3 == 2 {
            let epsilon = 10f64.powi(-6 - numbers.below(295) as i32);
            for _ in 0..2 {
                let (i, j) = (numbers.below(m), numbers.below(n));
                if c[(i, j)] == 0.0 {
                    c[(i, j)] = epsilon;
                }
            }
        }
        check(&c);
    }
}

#[test]
fn kahan_has_full_rank_and_a_copy_of_its_last_row_is_seen() {
    let c = kahan(30, 1.2);
    assert_eq!(certify_exact(&c).unwrap().rank, 30);
    let mut rows: Vec<usize> = (0..30).collect();
    rows.push(29);
    let decision = certify_exact(&c.select_rows(&rows)).unwrap();
    assert_eq!((decision.rank, decision.redundancy), (30, 1));
    assert_eq!(components(&decision).coupled, [[29, 30]]);
    let kahan90 = certify_exact(&kahan(90, 1.2)).unwrap();
    assert_eq!(kahan90.rank, 90);
    // Other tests show that the smallest singular value is about 1e-15.
    assert!(kahan90.nearly_redundant().is_some());
    assert!(kahan90.evidence.certificate.unwrap().sigma_bound > 0.0);
}

/// The determinant of [[1, 1], [1, 2⁶¹]] is 2⁶¹ − 1, which is a prime that many programs use.
/// Modulo this prime the determinant is zero.
#[test]
fn powers_of_two_are_no_trap() {
    for c in [
        Matrix::from_rows(&[[1.0, 1.0], [1.0, 2f64.powi(61)]]),
        Matrix::from_rows(&[[1.0, 2f64.powi(-61)], [2f64.powi(-61), 1.0]]),
        Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.0 + f64::EPSILON]]),
    ] {
        assert_eq!(check(&c).rank, 2);
    }
}

/// If the misalignment decreases from 1e-8 to 1e-300, the kept rows remain independent, and T
/// remains accurate.
#[test]
fn near_redundancy_beside_exact_redundancy() {
    for k in [8, 10, 12, 14, 16, 18, 20, 27, 29, 31, 40, 100, 300] {
        let e = 10f64.powi(-k);
        // Row 1 is row 0 except for ε; row 3 = 2·row 1 − row 0 exactly (ε doubles exactly); row 4
        // is independent.
        let c = Matrix::from_rows(&[
            [3.0, 0.0, 1.0, 0.0],
            [3.0, e, 1.0, 0.0],
            [1.0, 1.0, 7.0, 0.0],
            [3.0, 2.0 * e, 1.0, 0.0],
            [1.0, 0.0, 5.0, 1.0],
        ]);
        let decision = check(&c);
        assert_eq!(decision.rank, 4, "ε = 1e-{k}");
        assert_eq!(components(&decision).coupled, [[0, 1, 3]], "ε = 1e-{k}");
        let t = decision.dependence();
        let exact = cramer(
            &c,
            &decision,
            0,
            decision.kept.iter().position(|&i| i < 2).unwrap(),
        );
        let largest = t.row(0).iter().copied().find(|t| *t != 0.0).unwrap();
        assert!((largest / exact - 1.0).abs() < 1e-14, "{largest} {exact}");
        let near = decision.nearly_redundant().expect("nearly redundant");
        if k < 28 {
            let sigma = near.sigma / e;
            assert!(
                (0.01..100.0).contains(&sigma),
                "ε = 1e-{k}: {:e}",
                near.sigma
            );
            let bound = decision.evidence.certificate.as_ref().unwrap().sigma_bound;
            assert!(bound > 1e-3 * near.sigma, "ε = 1e-{k}: {bound:e}");
        }
        // The direction involves only rows 0, 1 and 3, and is orthogonal to the exact dependency.
        let d = &near.direction;
        assert!(d[2].abs() < 1e-5 && d[4].abs() < 1e-5, "{d:?}");
        let cancelled = decision.scaling.apply(&c).transpose_times(d);
        assert!(
            kernels::norm(&cancelled) < 10.0 * near.sigma.max(1e-16),
            "{cancelled:?}"
        );
    }
}

#[test]
fn extreme_entries_and_shapes() {
    let tiny = f64::from_bits(1);
    for c in [
        Matrix::from_rows(&[[1e300, tiny], [1e300, 2.0 * tiny], [0.0, 1e-300]]),
        Matrix::from_rows(&[[1e300, 0.0], [1e-300, 0.0], [tiny, 0.0], [0.0, 0.0]]),
        Matrix::from_rows(&[
            [1e300, 1e-300, 1.0],
            [1e300, 1e-300, 1.0],
            [tiny, tiny, tiny],
        ]),
        Matrix::from_rows(&[[f64::MAX, f64::MIN], [f64::MIN, f64::MAX]]),
        Matrix::from_rows(&[[1e300, 1.0], [1.0, 1e-300], [1e300, 2.0]]),
        Matrix::from_rows(&[[1.0], [2.0], [0.0], [-3.0], [tiny]]),
        Matrix::zeros(0, 3),
        Matrix::zeros(3, 0),
        Matrix::zeros(0, 0),
        Matrix::zeros(2, 2),
    ] {
        check(&c);
    }
    let nan = Matrix::from_rows(&[[1.0, f64::NAN]]);
    assert!(matches!(
        certify_exact(&nan),
        Err(RankError::NonFinite { row: 0, col: 1, .. })
    ));
    assert!(ExactNullSpace::new(&nan).is_err());
}

/// A matrix with many more rows than columns, all in general position. Every T is dense.
#[test]
fn tall_matrices() {
    let mut numbers = Numbers(5);
    let c = Matrix::from_fn(40, 3, |_, _| numbers.below(19) as f64 - 9.0);
    let decision = check(&c);
    let exact = cramer(&c, &decision, 11, 1);
    let t = decision.dependence()[(11, 1)];
    assert!(
        (t - exact).abs() <= 4.0 * f64::EPSILON * exact.abs(),
        "{t} {exact}"
    );
}

/// Cranks at an angle with rounded sine and cosine. The tips of the couplers still agree exactly,
/// so the third crank is redundant to the last bit. With other rounding it would not be redundant.
#[test]
fn cranks_as_they_stand() {
    let c = parallel_cranks(1.0, 0.7);
    let decision = check(&c);
    assert_eq!((decision.rank, decision.redundancy), (11, 1));
    assert!(decision.nearly_redundant().is_none());
}

/// Blocks whose determinants are the first two primes. The blocks are regular, but they are not
/// regular modulo these primes.
#[test]
fn primes_that_divide_a_determinant_are_outvoted() {
    let mut c = Matrix::zeros(4, 4);
    for (k, field) in crate::prime_field::fields().take(2).enumerate() {
        // p = a·2³¹ + b has 62 bits, each part at most 31.
        let (a, b) = (field.p() >> 31, field.p() & ((1 << 31) - 1));
        let (first, second) = (2 * k, 2 * k + 1);
        (c[(first, first)], c[(first, second)]) = (a as f64, -(b as f64));
        (c[(second, first)], c[(second, second)]) = (1.0, 2_f64.powi(31));
    }
    let z = ExactNullSpace::new(&c).unwrap();
    assert!((0..4).all(|row| z.annihilates([(row, 1.0)])));
}
