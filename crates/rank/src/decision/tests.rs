//! Tests with planted ranks, published counterexamples, invariances, and admissible choices of
//! rows. The reference results come from the SVD of nalgebra, and from brute force over all
//! choices.

use nalgebra::DMatrix;
use proptest::prelude::*;

use super::*;
use crate::components;
use crate::limits::{CLEARANCE, COEFFICIENT_BOUND};

/// SplitMix64 (Steele, Lea, Flood 2014), a seeded stream of pseudo-random values.
pub(super) struct Numbers(pub(super) u64);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a value in [−1, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(super) fn matrix(&mut self, m: usize, n: usize) -> Matrix {
        Matrix::from_fn(m, n, |_, _| self.unit())
    }
}

/// Returns a random m×n matrix of rank r. Its rows and columns are scaled over 1e±8.
fn planted(numbers: &mut Numbers, m: usize, n: usize, r: usize) -> Matrix {
    let product = numbers.matrix(m, r).product(&numbers.matrix(r, n));
    let rows: Vec<f64> = (0..m).map(|_| 10f64.powf(8.0 * numbers.unit())).collect();
    let cols: Vec<f64> = (0..n).map(|_| 10f64.powf(8.0 * numbers.unit())).collect();
    Matrix::from_fn(m, n, |i, j| rows[i] * product[(i, j)] * cols[j])
}

/// Returns the matrix of three parallel cranks of length `l`, pitch `l` and angle θ on one coupler.
/// The matrix is a 12×12 matrix. Its rank is 11 unless the linkage is flat.
pub(super) fn parallel_cranks(l: f64, theta: f64) -> Matrix {
    let (s, c) = theta.sin_cos();
    let half = 0.5 * l;
    let mut rows = Matrix::zeros(12, 12);
    for crank in 0..3 {
        let (body, coupler) = (3 * crank, 9);
        for axis in 0..2 {
            let turn = [-half * s, half * c][axis];
            let ground = 4 * crank + axis;
            rows[(ground, body + axis)] = 1.0;
            rows[(ground, body + 2)] = -turn;
            let tip = ground + 2;
            rows[(tip, body + axis)] = 1.0;
            rows[(tip, body + 2)] = turn;
            rows[(tip, coupler + axis)] = -1.0;
            // The coupler lies along x, so only its y rows depend on its rotation.
            rows[(tip, coupler + 2)] = [0.0, -(crank as f64 - 1.0) * l][axis];
        }
    }
    rows
}

fn nalgebra_rank(c: &Matrix, relative: f64) -> usize {
    let sigma = DMatrix::from_row_slice(c.nrows(), c.ncols(), c.as_slice()).singular_values();
    sigma
        .iter()
        .filter(|&&s| s > relative * sigma.max())
        .count()
}

#[test]
fn planted_ranks_are_never_wrong_and_seldom_undecided() {
    // Design target: no wrong result, and fewer than 0.1 % undecided cases.
    const CASES: usize = 3000;
    let mut numbers = Numbers(1);
    let mut undecided = 0;
    for case in 0..CASES {
        let (m, n) = (1 + numbers.below(40), 1 + numbers.below(40));
        let r = numbers.below(m.min(n) + 1);
        let c = planted(&mut numbers, m, n, r);
        let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
        if !decision.is_decided() {
            undecided += 1;
            continue;
        }
        assert_eq!(decision.rank, r, "case {case}: {m}×{n}");
        assert_eq!(decision.kept.len() + decision.dropped.len(), m);
        let t = decision.equilibrated_dependence();
        assert!(
            t.max_abs() <= COEFFICIENT_BOUND,
            "case {case}: {}",
            t.max_abs()
        );
        // C_D = T·C_K, checked on the equilibrated rows.
        let scaled = decision.scaling.apply(&c);
        let kept = scaled.select_rows(&decision.kept);
        let dropped = scaled.select_rows(&decision.dropped);
        approx::assert_abs_diff_eq!(t.product(&kept), dropped, epsilon = 1e-12);
    }
    assert!(undecided * 1000 < CASES, "{undecided} of {CASES} undecided");
}

#[test]
fn sizes_1e_minus_8_and_1e_plus_8_in_one_model() {
    let (small, large) = (parallel_cranks(1e-8, 0.7), parallel_cranks(1e8, -0.4));
    let mut c = Matrix::zeros(24, 24);
    for i in 0..12 {
        c.row_mut(i)[..12].copy_from_slice(small.row(i));
        c.row_mut(12 + i)[12..].copy_from_slice(large.row(i));
    }
    let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
    assert_eq!((decision.rank, decision.is_decided()), (22, true));
    assert!(decision.evidence.gap > 1e12, "{:e}", decision.evidence.gap);
    // Without scaling, the textbook tolerance loses rows.
    assert!(nalgebra_rank(&c, 24.0 * f64::EPSILON) < 22);
}

#[test]
fn parallel_cranks_lose_another_rank_when_flat() {
    for (theta, rank) in [(0.7, 11), (-0.3, 11), (0.0, 10)] {
        let decision = decide(&parallel_cranks(1.0, theta), crate::Accuracy::Rounding).unwrap();
        assert_eq!(
            (decision.rank, decision.is_decided()),
            (rank, true),
            "θ = {theta}"
        );
    }
    // For a small angle, σ₁₁ is proportional to the angle. Between the clear cases the rank is
    // undecided, but it is never wrong.
    let near = decide(&parallel_cranks(1.0, 1e-13), crate::Accuracy::Rounding).unwrap();
    assert!(
        matches!(
            near.status,
            RankStatus::Undecided(Doubt::NoClearGap {
                lower: 10,
                upper: 11,
                ..
            })
        ),
        "{:?}",
        near.status
    );
}

#[test]
fn reading_does_not_depend_on_order_or_units() {
    let mut numbers = Numbers(2);
    for _ in 0..100 {
        let (m, n) = (2 + numbers.below(12), 1 + numbers.below(12));
        let r = numbers.below(m.min(n)) + 1;
        // Sparse integer factors give many coloops and several components.
        let mut sparse = |m, n| {
            Matrix::from_fn(m, n, |i, j| {
                let keep = i == j || numbers.below(4) == 0;
                if keep {
                    1.0 + numbers.below(3) as f64
                } else {
                    0.0
                }
            })
        };
        let c = sparse(m, r).product(&sparse(r, n));
        let mut order: Vec<usize> = (0..m).collect();
        for i in (1..m).rev() {
            order.swap(i, numbers.below(i + 1));
        }
        let units: Vec<f64> = (0..m + n)
            .map(|_| 10f64.powf(6.0 * numbers.unit()))
            .collect();
        let other = Matrix::from_fn(m, n, |i, j| c[(order[i], j)] * units[i] * units[m + j]);

        let (a, b) = (
            decide(&c, crate::Accuracy::Rounding).unwrap(),
            decide(&other, crate::Accuracy::Rounding).unwrap(),
        );
        assert!(a.is_decided() && b.is_decided());
        assert_eq!(a.rank, b.rank);
        assert_eq!(a.rank, nalgebra_rank(&c, 1e-10));
        let (a, b) = (components(&a), components(&b));
        let back = |rows: &[usize]| {
            let mut rows: Vec<usize> = rows.iter().map(|&i| order[i]).collect();
            rows.sort_unstable();
            rows
        };
        assert_eq!(a.coloops, back(&b.coloops));
        let mut coupled: Vec<_> = b.coupled.iter().map(|rows| back(rows)).collect();
        coupled.sort_unstable();
        assert_eq!(a.coupled, coupled);
    }
}

/// A row is a coloop iff deleting it lowers the rank.
#[test]
fn coloops_by_deletion() {
    let c = parallel_cranks(1.0, 0.7);
    let found = components(&decide(&c, crate::Accuracy::Rounding).unwrap());
    for i in 0..12 {
        let others: Vec<usize> = (0..12).filter(|&l| l != i).collect();
        let lowers = nalgebra_rank(&c.select_rows(&others), 1e-10) < 11;
        assert_eq!(found.coloops.contains(&i), lowers, "row {i}");
    }
}

#[test]
fn admissible_pairs_by_brute_force() {
    let mut numbers = Numbers(3);
    for _ in 0..30 {
        let whole = |numbers: &mut Numbers, m: usize, n: usize| {
            Matrix::from_fn(m, n, |_, _| numbers.below(3) as f64 - 1.0)
        };
        let c = whole(&mut numbers, 6, 4).product(&whole(&mut numbers, 4, 5));
        if nalgebra_rank(&c, 1e-10) != 4 {
            continue;
        }
        for i in 0..6 {
            for j in 0..i {
                let kept: Vec<usize> = (0..6).filter(|&l| l != i && l != j).collect();
                let admissible = nalgebra_rank(&c.select_rows(&kept), 1e-10) == 4;
                match decide_dropping(&c, crate::Accuracy::Rounding, &[i, j]) {
                    Ok(decision) => {
                        assert!(admissible, "{:?}", decision.kept);
                        assert_eq!(decision.kept, kept);
                        assert!(decision.evidence.dependence_residual < 1e-12);
                        assert_eq!(
                            decide_keeping(&c, crate::Accuracy::Rounding, &kept),
                            Ok(decision)
                        );
                    }
                    Err(KeptRowsError::Dependent { .. }) => assert!(!admissible),
                    Err(error) => panic!("{error}"),
                }
            }
        }
    }
}

/// Kahan's matrix. The pivots of pivoted QR do not show how small its smallest singular value is.
pub(super) fn kahan(n: usize, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    Matrix::from_fn(n, n, |i, j| {
        s.powi(i as i32)
            * match i.cmp(&j) {
                std::cmp::Ordering::Equal => 1.0,
                std::cmp::Ordering::Less => -c,
                std::cmp::Ordering::Greater => 0.0,
            }
    })
}

/// Pivoted QR alone would keep the row order of Kahan's matrix and hide the small singular value.
#[test]
fn kahan_is_read_from_singular_values() {
    let kahan = kahan(90, 1.2);
    let decision = decide(&kahan, crate::Accuracy::Rounding).unwrap();
    let scaled = decision.scaling.apply(&kahan);
    let oracle = DMatrix::from_row_slice(90, 90, scaled.as_slice()).singular_values();
    let smallest = singular_values(&scaled)[89];
    // nalgebra is accurate to about eps·σ₁·√n here.
    assert!((smallest - oracle.min()).abs() < 1e-14 * oracle.max());
    assert!(smallest < decision.evidence.tolerance * CLEARANCE);
    assert_ne!(decision.status, RankStatus::Decided);
    assert!(decision.equilibrated_dependence().max_abs() <= COEFFICIENT_BOUND);
}

#[test]
fn nearly_parallel_rows_are_undecided_with_both_readings() {
    let c = Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.0 + 2e-12]]);
    let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
    let RankStatus::Undecided(doubt) = decision.status else {
        panic!("{:?}", decision.status);
    };
    assert!(
        matches!(
            doubt,
            Doubt::NoClearGap {
                lower: 1,
                upper: 2,
                ..
            }
        ),
        "{doubt:?}"
    );
    assert!(doubt.to_string().contains("rank 1 or 2"), "{doubt}");
}

#[test]
fn residual_sets_the_tolerance() {
    let c = Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.0 + 1e-6]]);
    assert_eq!(decide(&c, crate::Accuracy::Rounding).unwrap().rank, 2);
    let off = decide(&c, crate::Accuracy::Absolute(1e-6)).unwrap();
    assert_eq!((off.rank, off.is_decided()), (1, true));
    let lost = decide(&c, crate::Accuracy::Absolute(1.0)).unwrap();
    assert!(matches!(
        lost.status,
        RankStatus::Undecided(Doubt::NotPolished { .. })
    ));
}

/// Noise above a hundredth hides singular values above √eps. Smaller noise hides only rounding
/// errors.
#[test]
fn coarse_data_hide_what_is_no_rounding() {
    for (sigma, tolerance, is_hidden) in [
        (1.8e-8, 0.012, true),
        (1.2e-8, 0.012, false),
        (1.8e-8, 0.008, false),
    ] {
        let status = shown(sigma, tolerance);
        let expected = is_hidden.then_some(Doubt::Hidden { sigma, tolerance });
        assert_eq!(
            status,
            expected.map_or(RankStatus::Decided, RankStatus::Undecided)
        );
    }
}

#[test]
fn empty_and_zero_matrices_have_rank_zero() {
    for (m, n) in [(0, 0), (0, 3), (3, 0), (2, 2)] {
        let decision = decide(&Matrix::zeros(m, n), crate::Accuracy::Rounding).unwrap();
        assert_eq!((decision.rank, decision.redundancy), (0, m));
        assert!(decision.is_decided());
    }
}

proptest! {
    /// For any bit pattern, the function returns a result of the right shape or a named error, and
    /// does not panic.
    #[test]
    fn arbitrary_input_is_survived(
        m in 0..6_usize, n in 0..6_usize, residual in any::<f64>(),
        data in prop::collection::vec(
            prop_oneof![4 => Just(0.0), 8 => any::<f64>(), 1 => Just(f64::NAN)], 36),
    ) {
        let c = Matrix::from_fn(m, n, |i, j| data[6 * i + j]);
        for residual in [0.0, residual] {
            match decide(&c, crate::Accuracy::Absolute(residual)) {
                Ok(decision) => {
                    prop_assert_eq!(decision.rank + decision.redundancy, m);
                    prop_assert_eq!(crate::circuits(&decision).len(), decision.redundancy);
                    let parts = components(&decision);
                    let grouped: usize = parts.coupled.iter().map(Vec::len).sum();
                    prop_assert_eq!(grouped + parts.coloops.len(), m);
                    let z = crate::orthonormal(&decision);
                    prop_assert_eq!((z.nrows(), z.ncols()), (m, decision.redundancy));
                }
                Err(RankError::NonFinite { row, col, .. }) => {
                    prop_assert!(!c[(row, col)].is_finite());
                }
                Err(RankError::Uncertainty { value }) => {
                    // In the other case an entry is so large that the norm of the whole matrix
                    // overflows.
                    prop_assert!(!((36.0 * value).is_finite() && value >= 0.0));
                }
                Err(error) => prop_assert!(false, "{}", error),
            }
        }
    }
}

#[test]
fn bad_input_is_named() {
    let mut c = Matrix::identity(3);
    c[(2, 1)] = f64::NAN;
    assert_eq!(
        decide(&c, crate::Accuracy::Rounding)
            .unwrap_err()
            .to_string(),
        "constraint matrix: entry in row 2, column 1 is NaN, need a finite number"
    );
    assert!(matches!(
        decide(&Matrix::identity(1), crate::Accuracy::Absolute(-1.0)),
        Err(RankError::Uncertainty { value: -1.0 })
    ));
    let c = Matrix::from_rows(&[[1.0], [2.0], [3.0]]);
    let message = |rows: &[usize]| {
        decide_dropping(&c, crate::Accuracy::Rounding, rows)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(&[1]),
        "1 rows dropped and 2 kept, but the rank is 1 of 3 rows: drop exactly 2"
    );
    assert_eq!(message(&[1, 3]), "row 3 does not exist, rows are 0..3");
    assert_eq!(message(&[1, 1]), "row 1 is listed twice");
}

/// Three cranks turn from 0.3 rad to their flat pose, where the rank drops. A carried decision is
/// that of the matrix itself, its dependencies cancel its rows, and its bound is below σ_r. No
/// decision is carried to the flat pose, nor to a matrix of higher rank.
#[test]
fn a_decision_is_carried_up_to_a_singular_pose() {
    let mut last = decide(&parallel_cranks(1.0, 0.3), Accuracy::Rounding).unwrap();
    for step in (0..=300).rev() {
        let c = parallel_cranks(1.0, 1e-3 * f64::from(step));
        let own = decide(&c, Accuracy::Rounding).unwrap();
        let Some(found) = carried(&last, &c) else {
            assert!(
                step == 0 && own.rank == last.rank - 1,
                "{step}: {}",
                own.rank
            );
            continue;
        };
        assert!(step > 0 && own.is_decided() && own.rank == found.rank);
        assert!(found.evidence.sigma_r <= own.evidence.sigma_r * (1.0 + 1e-9));
        assert!(found.coefficients.max_abs() <= COEFFICIENT_BOUND);
        let z = crate::dependencies(&found);
        assert!(c.transpose().product(&z).max_abs() < 1e-12);
        last = found;
    }
    let flat = decide(&parallel_cranks(1.0, 0.0), Accuracy::Rounding).unwrap();
    assert_eq!(carried(&flat, &parallel_cranks(1.0, 0.3)), None);
    assert_eq!(carried(&last, &(parallel_cranks(f64::NAN, 0.3))), None);
}
