//! Compares deletions with brute force: every set of rows is tested by ranks of small integer
//! matrices.

use super::*;
use crate::decide;
use crate::dual::subsets;
use linalg::{Matrix, singular_values};

/// Returns the rank of a well-conditioned integer matrix.
fn rank_of(c: &Matrix, rows: &[usize]) -> usize {
    let sigma = singular_values(&c.select_rows(rows));
    sigma.iter().filter(|s| **s > 1e-9).count()
}

fn without(m: usize, set: &[usize]) -> Vec<usize> {
    (0..m).filter(|i| !set.contains(i)).collect()
}

/// Returns small integers. A few rows repeat, vanish, or are sums of other rows.
fn sample(seed: u64) -> Matrix {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = move |below: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) % below
    };
    let (m, n) = (5 + next(5) as usize, 2 + next(4) as usize);
    let mut c = Matrix::zeros(m, n);
    for i in 0..m {
        let kind = if i < 2 { 9 } else { next(5) };
        let pair = [0; 2].map(|_| next(i.max(1) as u64) as usize);
        for k in 0..n {
            c[(i, k)] = match kind {
                0 => 2.0 * c[(pair[0], k)],
                1 => c[(pair[0], k)] - c[(pair[1], k)],
                _ => [0.0, 0.0, 0.0, 1.0, 1.0, -1.0, 2.0, -3.0][next(8) as usize],
            };
        }
    }
    c
}

#[test]
fn all_admissible_sets_are_found_and_counted() {
    let mut largest = 0;
    for seed in 1..=150 {
        let c = sample(seed);
        let (m, decision) = (c.nrows(), decide(&c, crate::Accuracy::Rounding).unwrap());
        let mut expected: Vec<Vec<usize>> = subsets(m, decision.redundancy)
            .filter(|set| rank_of(&c, &without(m, set)) == decision.rank)
            .collect();
        let mut found = deletions(&decision, usize::MAX).unwrap();
        found.sort();
        expected.sort();
        assert_eq!(found, expected, "seed {seed}");
        assert_eq!(
            count_deletions(&decision),
            Ok(expected.len() as u128),
            "seed {seed}"
        );
        largest = largest.max(decision.redundancy);
        assert_eq!(
            deletions(&decision, 2).unwrap().len(),
            expected.len().min(2)
        );
    }
    assert!(largest >= 6);
}

#[test]
fn smallest_sets_that_make_a_multiplier_or_a_group_unique() {
    let mut sizes = [0; 9];
    for seed in 1..=150 {
        let c = sample(seed);
        let (m, decision) = (c.nrows(), decide(&c, crate::Accuracy::Rounding).unwrap());
        let rows: Vec<Vec<usize>> = (0..m).map(|i| vec![i]).collect();
        for group in [vec![0], vec![1, 2]] {
            // The target of a wrench: n combinations, whose coefficients are the columns of C_X.
            let target = Matrix::from_fn(c.ncols(), m, |k, i| {
                if group.contains(&i) { c[(i, k)] } else { 0.0 }
            });
            let found =
                making_unique(&decision, &target, &rows, |_| true, Limits::default()).unwrap();
            assert!(found.complete);
            let expected = by_ranks(&c, decision.rank, &group);
            assert_eq!(found.sets, expected, "seed {seed}, group {group:?}");
            sizes[expected.first().map_or(8, Vec::len)] += 1;
        }
    }
    assert!(sizes[0] > 20 && sizes[1] > 20 && sizes[2] > 5, "{sizes:?}");
}

/// Returns the result according to the definition. After D is deleted, the rank is unchanged, and
/// rank C is the sum of rank C_X and the rank of the other remaining rows.
fn by_ranks(c: &Matrix, rank: usize, group: &[usize]) -> Vec<Vec<usize>> {
    let m = c.nrows();
    let zero = |i: &usize| c.row(*i).iter().all(|x| *x == 0.0);
    for size in 0..=m - rank {
        let found: Vec<Vec<usize>> = subsets(m, size)
            .filter(|set| {
                let left = without(m, set);
                let rest: Vec<usize> = left
                    .iter()
                    .copied()
                    .filter(|i| !group.contains(i))
                    .collect();
                // A row of zeros in the group has no coefficient in the target. Therefore it may be
                // deleted like the rows outside the group.
                set.iter().all(|i| !group.contains(i) || zero(i))
                    && rank_of(c, &left) == rank
                    && rank_of(c, group) + rank_of(c, &rest) == rank
            })
            .collect();
        if !found.is_empty() {
            return found;
        }
    }
    Vec::new()
}

/// Two matrices with many admissible sets. The first has 30 components with two sets each. The
/// second is a uniform matroid, which is counted by contraction.
#[test]
fn large_redundancies_are_counted() {
    let pairs = Matrix::from_fn(60, 30, |i, j| f64::from(u8::from(i / 2 == j)));
    assert_eq!(
        count_deletions(&decide(&pairs, crate::Accuracy::Rounding).unwrap()),
        Ok(1 << 30)
    );
    // Any 4 of 10 generic rows in four columns are independent, so the number is 10 over 6.
    let generic = Matrix::from_fn(10, 4, |i, j| ((i * i + 7 * j * j + i * j) as f64).sin());
    assert_eq!(
        count_deletions(&decide(&generic, crate::Accuracy::Rounding).unwrap()),
        Ok(210)
    );
    let many = Matrix::from_fn(260, 130, |i, j| f64::from(u8::from(i / 2 == j)));
    let error = count_deletions(&decide(&many, crate::Accuracy::Rounding).unwrap()).unwrap_err();
    assert!(matches!(error, DeletionError::TooMany { .. }));
}

#[test]
fn limits_units_and_refusals() {
    // Rows 0, 1 and 2 are equal, and rows 3 and 4 are equal.
    let c = Matrix::from_rows(&[[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]]);
    let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
    let target = Matrix::from_rows(&[[1.0, 0.0, 0.0, 0.0, 0.0]]);
    let ask = |units: &[Vec<usize>], limits: Limits| {
        making_unique(&decision, &target, units, |_| true, limits).unwrap()
    };
    assert_eq!(ask(&[vec![1, 2]], Limits::default()).sets, [[0]]);
    // {1, 3} and {2} are possible at the same time. {0, 1} shares a row with the target, and {3, 4}
    // would change the motion.
    let units = [vec![1, 3], vec![2], vec![0, 1], vec![3, 4]];
    assert_eq!(ask(&units, Limits::default()).sets, [[0, 1]]);
    let none = ask(&units, Limits { sets: 9, trials: 0 });
    assert_eq!((none.sets.len(), none.complete), (0, false));
    let refused = making_unique(&decision, &target, &units, |_| false, Limits::default()).unwrap();
    assert_eq!((refused.sets.len(), refused.complete), (0, true));
    let wrong = making_unique(
        &decision,
        &Matrix::zeros(1, 3),
        &units,
        |_| true,
        Limits::default(),
    );
    assert_eq!(wrong, Err(DeletionError::TargetShape { found: 3, rows: 5 }));
}

#[test]
fn an_unclear_coefficient_has_two_digits() {
    let error = DeletionError::Unclear {
        value: 0.1,
        noise: 2.34e-9,
    };
    let text = error.to_string();
    assert!(text.contains("a coefficient of 0.1, "), "{text}");
    assert!(text.contains("accurate only to 2.3e-9: "), "{text}");
}
