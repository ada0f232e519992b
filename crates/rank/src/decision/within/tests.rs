//! Singular values at doubled precision, and the three zones of the uncertainty.

use super::*;
use crate::decision::tests::{Numbers, parallel_cranks};
use crate::{components, dependencies};
use linalg::Matrix;

/// Relative uncertainty of f64 data.
const DATA: f64 = 2e-16;

fn grounds(decision: &RankDecision) -> Grounds {
    decision.evidence.certificate.as_ref().unwrap().grounds
}

/// Cranks with exact 3–4–5 angles in double-double. The foot of the third crank is displaced by ε
/// across the other feet.
fn cranks(epsilon: f64) -> DdMatrix {
    let mut c = DdMatrix::from(&parallel_cranks(1.0, 0.0));
    let (sin, cos) = (Dd::from(3.0) / Dd::from(5.0), Dd::from(4.0) / Dd::from(5.0));
    let half = Dd::from(0.5);
    for crank in 0..3 {
        for (axis, turn) in [-(half * sin), half * cos].into_iter().enumerate() {
            c[(4 * crank + axis, 3 * crank + 2)] = -turn;
            c[(4 * crank + 2 + axis, 3 * crank + 2)] = turn;
        }
    }
    c[(8, 8)] += Dd::from(epsilon);
    c
}

/// A row whose uncertainty is as large as the row is not redundant, because it contains no
/// information.
#[test]
fn what_the_data_hide_is_undecided() {
    let c = DdMatrix::from(&Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0]]));
    let reading = |known: f64| {
        let uncertainty = Matrix::from_rows(&[[0.0, 0.0], [0.0, known]]);
        certify_within(&c, &uncertainty).unwrap()
    };
    assert_eq!((reading(1e-6).rank, reading(1e-6).is_decided()), (2, true));
    let hidden = reading(3.0);
    assert_eq!(hidden.rank, 0);
    assert!(!hidden.is_decided());
    // Rows that differ by less than the uncertainty of the data are redundant within the data only
    // if the uncertainty is below a hundredth of a row.
    let c = DdMatrix::from(&Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.05]]));
    let decision = certify_within(&c, crate::Accuracy::Absolute(0.01)).unwrap();
    let RankStatus::Undecided(Doubt::Hidden { sigma, tolerance }) = decision.status else {
        panic!("{:?}", decision.status);
    };
    assert!(
        (0.02..0.03).contains(&sigma) && tolerance == 0.1,
        "{sigma} {tolerance}"
    );
    let near = DdMatrix::from(&Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.0005]]));
    assert_eq!(
        grounds(&certify_within(&near, crate::Accuracy::Absolute(1e-3)).unwrap()),
        Grounds::WithinData
    );
    assert!(
        certify_within(&near, crate::Accuracy::Absolute(1e-3))
            .unwrap()
            .is_decided()
    );
}

/// The rank is lower than the rank of the entries, and it is decided from data within their
/// uncertainty. The entries themselves have no rounding errors. In this case, the zeros of the
/// entries prove nothing.
#[test]
fn a_lower_rank_within_the_data_is_not_exact() {
    let rows = Matrix::from_rows(&[[1.0, 0.0]]);
    let (scaling, _) = crate::Accuracy::Rounding.equilibrate(&rows).unwrap();
    let decision = |rank: usize, grounds: Grounds| {
        let reading = RankReading {
            rank,
            status: RankStatus::Decided,
            scaling: scaling.clone(),
            matrix: Spectrum::of(scaling.apply(&rows)),
            noise: 0.0,
            separation: 0.0,
            grounds,
        };
        let c = DdMatrix::from(&rows);
        certify_rank(&c, &Matrix::zeros(1, 2), &reading)
            .unwrap()
            .unwrap()
    };
    assert!(decision(1, Grounds::FullRank).is_exact());
    assert!(!decision(0, Grounds::WithinData).is_exact());
}

/// The values are those of numerics.md, 2.1. If a row is exactly redundant, the values are 8e-18
/// and 4e-34. If the misalignment is 1e-13, the value is the same at every precision. A
/// misalignment of 1e-20 is visible with 32 digits.
#[test]
fn exact_redundancy_falls_with_the_precision_and_misalignment_stays() {
    let decision = certify_within(&cranks(0.0), crate::Accuracy::Absolute(DATA)).unwrap();
    assert_eq!((decision.rank, grounds(&decision)), (11, Grounds::Vanishes));
    assert!(
        decision.evidence.sigma_next < 1e-30,
        "{:e}",
        decision.evidence.sigma_next
    );
    let certificate = decision.evidence.certificate.as_ref().unwrap();
    assert_eq!(certificate.rank_at_least, 11);
    assert!(certificate.sigma_bound > 1e-3 * decision.evidence.sigma_r);

    let reading = |epsilon: f64| {
        let decision = certify_within(&cranks(epsilon), crate::Accuracy::Absolute(DATA)).unwrap();
        decision.evidence.singular_values[11] / epsilon
    };
    let reference = reading(1e-12);
    for k in 3..=20 {
        let epsilon = 10f64.powi(-k);
        let decision = certify_within(&cranks(epsilon), crate::Accuracy::Absolute(DATA)).unwrap();
        // σ₁₂ is proportional to ε for small ε.
        let deviation = reading(epsilon) / reference - 1.0;
        assert!(
            deviation.abs() < 100.0 * epsilon + 1e-6,
            "ε = 1e-{k}: {deviation:e}"
        );
        let sigma = epsilon * reference;
        let tolerance = decision.evidence.tolerance;
        if sigma > 4.01 * tolerance {
            assert!(decision.is_decided() && decision.rank == 12, "ε = 1e-{k}");
            assert_eq!(
                decision.nearly_redundant().is_some(),
                decision.evidence.sigma_r < 1e-3
            );
            let certificate = decision.evidence.certificate.as_ref().unwrap();
            // The bound is smaller than σ by a factor of about ten.
            assert!(certificate.sigma_bound > 0.05 * sigma, "{certificate:?}");
            if sigma > 20.0 * 12.0 * DATA {
                assert_eq!(certificate.rank_at_least, 12, "ε = 1e-{k}");
            }
            assert!(certificate.sigma_bound <= sigma * (1.0 + 100.0 * epsilon));
        } else if sigma < 0.99 * tolerance {
            assert_eq!(
                (decision.rank, grounds(&decision)),
                (11, Grounds::WithinData),
                "ε = 1e-{k}"
            );
            assert!(decision.is_decided());
        } else {
            let RankStatus::Undecided(doubt) = decision.status else {
                panic!("ε = 1e-{k}: {decision:?}");
            };
            assert!(doubt.to_string().contains("rank 11 or 12"), "{doubt}");
        }
    }
}

/// For a misalignment of 1e-20, the coefficients of a circuit are accurate to 1e-10 if the data are
/// accurate enough.
#[test]
fn dependencies_of_a_nearly_redundant_matrix_are_those_of_the_matrix_as_read() {
    for epsilon in [1e-7, 1e-12, 1e-20] {
        let e = Dd::from(epsilon);
        let mut c = DdMatrix::from(&Matrix::from_rows(&[
            [3.0, 0.0, 1.0],
            [3.0, 0.0, 1.0],
            [1.0, 1.0, 7.0],
            [3.0, 0.0, 1.0],
        ]));
        c[(1, 1)] = e;
        c[(3, 1)] = Dd::from(2.0) * e;
        let decision = certify_within(&c, crate::Accuracy::Absolute(1e-24)).unwrap();
        assert_eq!(
            (decision.rank, grounds(&decision)),
            (3, Grounds::FullRank),
            "{epsilon:e}"
        );
        assert_eq!(components(&decision).coupled, [[0, 1, 3]]);
        assert_eq!(components(&decision).coloops, [2]);
        // The dependency is row 0 − 2·row 1 + row 3 = 0.
        let z = dependencies(&decision);
        let z: Vec<f64> = (0..4).map(|i| z[(i, 0)] / z[(0, 0)]).collect();
        for (z, exact) in z.iter().zip([1.0, -2.0, 0.0, 1.0]) {
            assert!((z - exact).abs() < 1e-10, "{epsilon:e}: {z}");
        }
    }
}

#[test]
fn planted_ranks_in_double_double() {
    let mut numbers = Numbers(11);
    for case in 0..200 {
        let (m, n) = (1 + numbers.below(14), 1 + numbers.below(14));
        let r = numbers.below(m.min(n) + 1);
        let (a, b) = (numbers.matrix(m, r), numbers.matrix(r, n));
        let scales: Vec<f64> = (0..m).map(|_| 10f64.powf(8.0 * numbers.unit())).collect();
        // Products rounded to double-double, not to f64.
        let c = DdMatrix::from_fn(m, n, |i, j| {
            let mut sum = Dd::ZERO;
            for k in 0..r {
                sum += Dd::from_product(a[(i, k)], b[(k, j)]);
            }
            sum * Dd::from(scales[i])
        });
        let decision = certify_within(&c, crate::Accuracy::Absolute(DATA)).unwrap();
        assert!(decision.is_decided(), "case {case}");
        assert_eq!(decision.rank, r, "case {case}: {m}×{n}");
        let expected = if r == m.min(n) {
            Grounds::FullRank
        } else {
            Grounds::Vanishes
        };
        assert_eq!(
            grounds(&decision),
            expected,
            "case {case}: {:e}",
            decision.evidence.sigma_next
        );
        assert_eq!(
            decision.evidence.certificate.unwrap().rank_at_least,
            r,
            "case {case}"
        );
    }
}

#[test]
fn shapes_and_bad_input() {
    for (m, n) in [(0, 0), (0, 3), (3, 0), (2, 2)] {
        let decision =
            certify_within(&DdMatrix::zeros(m, n), crate::Accuracy::Absolute(DATA)).unwrap();
        assert_eq!(
            (decision.rank, decision.redundancy, decision.is_decided()),
            (0, m, true)
        );
    }
    let nan = DdMatrix::from(&Matrix::from_rows(&[[f64::NAN]]));
    assert!(matches!(
        certify_within(&nan, crate::Accuracy::Absolute(DATA)),
        Err(RankError::NonFinite { .. })
    ));
    let one = DdMatrix::from(&Matrix::identity(1));
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            certify_within(&one, crate::Accuracy::Absolute(bad)),
            Err(RankError::Uncertainty { .. })
        ));
    }
    assert!(matches!(
        certify_within(&one, crate::Accuracy::Absolute(1.0))
            .unwrap()
            .status,
        RankStatus::Undecided(Doubt::NotPolished { .. })
    ));
}

/// The rows (1, 1 − e) and (1 − e, 1). The eigenvalues are 2 − e and e.
fn nearly_parallel(e: f64) -> DdMatrix {
    let mut c = DdMatrix::from(&Matrix::from_rows(&[[1.0; 2]; 2]));
    c[(0, 1)] -= Dd::from(e);
    c[(1, 0)] -= Dd::from(e);
    c
}

#[test]
fn a_thousandth_is_nearly_redundant() {
    for (e, is_near) in [(0.8e-3, true), (1.2e-3, false)] {
        let decision =
            certify_within(&nearly_parallel(e), crate::Accuracy::Absolute(DATA)).unwrap();
        assert_eq!(decision.rank, 2);
        assert_eq!(decision.nearly_redundant().is_some(), is_near, "{e}");
    }
}

/// The levels of σ₂ in the test range up to √2.
#[test]
fn what_vanishes_is_ten_digits_below_rounding() {
    for (e, expected) in [(3e-27, Grounds::Vanishes), (3e-26, Grounds::WithinData)] {
        let decision =
            certify_within(&nearly_parallel(e), crate::Accuracy::Absolute(DATA)).unwrap();
        assert_eq!((decision.rank, grounds(&decision)), (1, expected), "{e}");
    }
}

/// A singular value that exceeds the accuracy of the data by a factor below 4 is undecided.
#[test]
fn a_singular_value_clears_the_data_by_four() {
    for (times, is_decided) in [(2.5, false), (4.5, true)] {
        let decision = certify_within(
            &nearly_parallel(times * 1e-9),
            crate::Accuracy::Absolute(1e-10),
        )
        .unwrap();
        assert_eq!(decision.is_decided(), is_decided, "{times}");
    }
}

/// The rows a, b, a of [`nearly_parallel`], with σ₂ = 2e/√3. If the accuracy of the data is u, the
/// coefficients are undecided within √6·u/σ₂, unless σ₂ is below 1e-6.
#[test]
fn coefficients_of_a_nearly_redundant_matrix_are_as_read() {
    for (e, is_as_read) in [(0.5e-6, true), (2e-6, false)] {
        let two = nearly_parallel(e);
        let c = DdMatrix::from_fn(3, 2, |i, j| two[(i % 2, j)]);
        let decision = certify_within(&c, crate::Accuracy::Absolute(1e-12)).unwrap();
        assert_eq!((decision.rank, decision.redundancy), (2, 1));
        let tolerance = decision.coefficient_tolerance();
        assert_eq!(tolerance < 1e-9, is_as_read, "{e}: {tolerance:e}");
    }
}
