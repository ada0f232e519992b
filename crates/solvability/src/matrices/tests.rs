//! Manually calculated verdicts, exact verdicts that rounding would make undecided, and requests
//! that are errors.

use super::*;
use crate::verdict::Verdict;

/// Rows 0 and 1 fix the left end of a bar (x, y, φ), and rows 2 and 3 the right end at a distance
/// of 2. The last row is `x = y·ε`.
fn bar(epsilon: f64) -> Matrix {
    Matrix::from_rows(&[
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, epsilon, 0.0],
        [0.0, 1.0, 2.0],
    ])
}

/// For every ε, rows 0, 1 and 2 depend on each other: row 2 = row 0 + ε·row 1.
#[test]
fn exact_verdicts_have_no_smallest_number() {
    for epsilon in [1e-6, 1e-12, 1e-18, 1e-100, 1e-300, 5e-324] {
        let s = Solvability::of_exact(&bar(epsilon)).unwrap();
        assert_eq!((s.decision().rank, s.decision().redundancy), (3, 1));
        for (row, verdict) in [
            (0, Verdict::NotUnique),
            (1, Verdict::NotUnique),
            (2, Verdict::NotUnique),
            (3, Verdict::Unique),
        ] {
            assert_eq!(
                s.row(row).unwrap().verdict,
                verdict,
                "ε = {epsilon:e}, row {row}"
            );
        }
        // The forces along x and y: λ₀ + λ₂ and λ₁ + ε·λ₂.
        assert_eq!(
            s.combination(&[1.0, 0.0, 1.0, 0.0]).unwrap().verdict,
            Verdict::Unique
        );
        assert_eq!(
            s.combination(&[0.0, 1.0, epsilon, 0.0]).unwrap().verdict,
            Verdict::Unique
        );
        assert_eq!(
            s.combination(&[0.0, 1.0, 2.0 * epsilon, 0.0])
                .unwrap()
                .verdict,
            Verdict::NotUnique
        );
        assert_eq!(s.group([0, 1, 2]).unwrap().verdict, Verdict::Unique);
        assert_eq!(s.group([1]).unwrap().verdict, Verdict::NotUnique);
        // The direction in the plane of (λ₀, λ₁) along which the component of the self-stress (1,
        // ε) is zero.
        let directions = s.unique_directions(&Matrix::identity(2), [0, 1]).unwrap();
        assert_eq!(directions.len(), 1);
        assert!((directions[0][1] - 1.0).abs() < 1e-6, "{directions:?}");
    }
    let s = Solvability::of_exact(&bar(0.0)).unwrap();
    assert_eq!(s.row(1).unwrap(), Judgement::new(Verdict::Unique, 0.0));
}

/// With rounded entries, ε = 1e-14 cannot be distinguished from zero, and the verdict is undecided.
#[test]
fn rounded_verdicts_are_undecided_near_zero() {
    let verdict = |epsilon: f64| {
        Solvability::of(&bar(epsilon), rank::Accuracy::Rounding)
            .unwrap()
            .row(1)
            .unwrap()
            .verdict
    };
    assert_eq!(verdict(0.0), Verdict::Unique);
    assert_eq!(verdict(1e-18), Verdict::Unique);
    assert!(matches!(verdict(1e-12), Verdict::Undecided { .. }));
    assert_eq!(verdict(1e-8), Verdict::NotUnique);
}

/// A residual of 1e-6 makes coefficients uncertain by 1e-4. With such evidence, no reaction counts
/// as unique.
#[test]
fn poor_evidence_calls_nothing_unique() {
    let s = Solvability::of(&bar(0.0), rank::Accuracy::Absolute(1e-6)).unwrap();
    assert!(s.decision().is_decided());
    assert!(matches!(
        s.row(3).unwrap().verdict,
        Verdict::Undecided { .. }
    ));
    assert_eq!(s.row(0).unwrap().verdict, Verdict::NotUnique);
    let directions = s.unique_directions(&Matrix::identity(1), [3]);
    assert!(
        matches!(directions, Err(QueryError::Directions { .. })),
        "{directions:?}"
    );
}

#[test]
fn groups_overlap_repeat_and_may_be_empty() {
    for s in [
        Solvability::of(&bar(0.0), rank::Accuracy::Rounding).unwrap(),
        Solvability::of_exact(&bar(0.0)).unwrap(),
    ] {
        assert_eq!(s.group([]).unwrap(), Judgement::new(Verdict::Unique, 0.0));
        assert_eq!(s.multipliers([]).unwrap().verdict, Verdict::Unique);
        assert_eq!(s.group([0, 1, 0]).unwrap(), s.group([1, 0]).unwrap());
        assert_eq!(s.group([0, 2]).unwrap().verdict, Verdict::Unique);
        assert_eq!(s.multipliers([0, 2]).unwrap().verdict, Verdict::NotUnique);
        assert_eq!(
            s.unique_directions(&Matrix::zeros(0, 0), []).unwrap(),
            Vec::<Vec<f64>>::new()
        );
    }
}

#[test]
fn questions_that_cannot_be_answered_are_named() {
    let s = Solvability::of(&bar(0.0), rank::Accuracy::Rounding).unwrap();
    assert_eq!(
        s.row(4).unwrap_err().to_string(),
        "row 4 does not exist, rows are 0..4"
    );
    assert!(matches!(
        s.group([0, 9]),
        Err(QueryError::RowOutOfRange { row: 9, rows: 4 })
    ));
    assert_eq!(
        s.combination(&[1.0]).unwrap_err().to_string(),
        "1 coefficients for 4 rows"
    );
    assert!(matches!(
        s.combination(&[1.0, f64::NAN, 0.0, 0.0]),
        Err(QueryError::NonFinite { index: 1, .. })
    ));
    let map = Matrix::identity(2);
    assert!(matches!(
        s.component(&map, 2, [0, 1]),
        Err(QueryError::ComponentOutOfRange {
            component: 2,
            components: 2
        })
    ));
    assert!(matches!(
        s.component(&map, 0, [0]),
        Err(QueryError::Length {
            found: 2,
            expected: 1
        })
    ));
    assert!(s.unique_directions(&map, [0, 1, 2]).is_err());
}

#[test]
fn empty_matrices() {
    for (m, n) in [(0, 0), (0, 3), (3, 0), (2, 2)] {
        let s = Solvability::of_exact(&Matrix::zeros(m, n)).unwrap();
        // For a row of zeros, the multiplier is arbitrary and the reaction is zero.
        for i in 0..m {
            assert_eq!(s.row(i).unwrap().verdict, Verdict::NotUnique);
            assert_eq!(s.group([i]).unwrap().verdict, Verdict::Unique);
        }
    }
}

/// A knife edge in the plane has one multiplier and two components. The force along the edge is
/// always zero. It is not reported as a unique direction.
#[test]
fn directions_without_a_reaction_are_left_out() {
    // Rows 0 and 1 are the same, and row 2 is independent.
    let c = Matrix::from_rows(&[[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    for s in [
        Solvability::of(&c, rank::Accuracy::Rounding),
        Solvability::of_exact(&c),
    ] {
        let s = s.unwrap();
        let live = |map: &Matrix, rows: &[usize]| {
            let mapped = s.basis().mapped(map, rows.iter().copied()).unwrap();
            let unique = mapped.unique_directions().unwrap();
            (unique.len(), mapped.live_directions(&unique))
        };
        for normal in [[0.0, 1.0], [0.6, 0.8]] {
            let map = Matrix::from_rows(&[[normal[0]], [normal[1]]]);
            assert_eq!(live(&map, &[0]), (1, Vec::new()));
            let (number, found) = live(&map, &[2]);
            assert_eq!((number, found.len()), (2, 1));
            assert!(
                (0..2).all(|k| (found[0][k] - normal[k]).abs() < 1e-15),
                "{found:?}"
            );
        }
        // A unique multiplier adds a nonzero direction. The last component is zero and does not add
        // a direction.
        let map = Matrix::from_rows(&[[0.6, 0.0], [0.8, 0.0], [0.0, 1e-6], [0.0, 0.0]]);
        let (number, found) = live(&map, &[0, 2]);
        assert_eq!(number, 3);
        assert_eq!(found, [[0.0, 0.0, 1.0, 0.0]]);
        let mapped = s.basis().mapped(&map, [0, 2]).unwrap();
        let zero = |k: usize| mapped.is_zero(k).unwrap();
        assert_eq!([0, 1, 2, 3].map(zero), [false, false, false, true]);
    }
}

/// Rows 0 and 1 are the same, and a force of row 2 has the direction (1, ε). The accuracy of the
/// data is so low that coefficients of 1e-3 may be rounding errors. The component ε of a direction
/// is not a rounding error.
#[test]
fn a_part_of_a_direction_is_told_however_uncertain_coefficients_are() {
    let c = Matrix::from_rows(&[[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let s = Solvability::of(&c, rank::Accuracy::Absolute(1e-5)).unwrap();
    assert!(s.decision().coefficient_tolerance() > 1e-4);
    for epsilon in [5e-5, -3e-4] {
        let map = Matrix::from_rows(&[[0.0, 1.0], [0.0, epsilon], [1.0, 0.0]]);
        let mapped = s.basis().mapped(&map, [0, 2]).unwrap();
        let found = mapped.live_directions(&[vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0][1] / epsilon - 1.0).abs() < 1e-6, "{found:?}");
    }
}
