//! Tests the exact reference with matrices whose results were derived by hand, and every verdict by
//! two derivations.

use exact::Exact;
use tests::numbers::Numbers;

#[test]
fn by_hand() {
    // Rows 0 to 2 are two forces along x and their sum; rows 3 and 4 are independent of all others;
    // row 5 is empty.
    let exact = Exact::of(&[
        [1.0, 0.0, 0.0],
        [0.25, 0.0, 0.0],
        [1.25, 0.0, 0.0],
        [3.0, 1e-300, 0.0],
        [0.0, 0.0, f64::from_bits(1)],
        [0.0, 0.0, 0.0],
    ]);
    assert_eq!(exact.rank(), 3);
    let unique: Vec<usize> = (0..6).filter(|&i| exact.row_is_unique(i)).collect();
    assert_eq!(unique, [3, 4]);
    assert_eq!(exact.freedom(&[0, 1, 2]), 0);
    assert_eq!(exact.freedom(&[0, 1]), 1);
    assert_eq!(exact.freedom(&[5]), 0, "an empty row carries no force");
    assert!(exact.combination_is_unique(&[4.0, 1.0, 5.0, 7.0, 0.0, 0.0]));
    assert!(!exact.combination_is_unique(&[4.0, 1.0, 5.0, 7.0, 0.0, 1.0]));
}

/// The `f64` nearest to 0.1 and 0.2 do not sum to the one nearest to 0.3; twice the value for 0.1
/// is exactly the value for 0.2.
#[test]
fn data_as_read() {
    let thirds = Exact::of(&[[0.1, 1.0, 0.0], [0.2, 1.0, 1.0], [0.3, 2.0, 1.0]]);
    assert_eq!(thirds.rank(), 3);
    let half = Exact::of(&[[0.1, 1.0, 0.0], [0.1, 1.0, 1.0], [0.2, 2.0, 1.0]]);
    assert_eq!(half.rank(), 2);
}

/// The reaction of X is unique if and only if `rank C = rank C_X + rank C_rest`. A row is unique if
/// and only if the rank decreases without it. The value of `ℓᵀ·λ` is unique if and only if ℓ as an
/// additional column does not change the rank.
#[test]
fn two_derivations_agree() {
    let mut numbers = Numbers::new(7);
    let mut seen = [0; 2];
    for _ in 0..200 {
        let (m, n, r) = (6, 5, 3 + numbers.below(3));
        let mut small = |m: usize, n: usize| -> Vec<Vec<f64>> {
            let mut entry = || f64::from(numbers.between(-1, 1) * numbers.between(0, 1));
            (0..m).map(|_| (0..n).map(|_| entry()).collect()).collect()
        };
        let (a, b) = (small(m, r), small(r, n));
        let entry = |i: usize, k: usize| (0..r).map(|j| a[i][j] * b[j][k]).sum::<f64>();
        let c: Vec<Vec<f64>> = (0..m)
            .map(|i| (0..n).map(|k| entry(i, k)).collect())
            .collect();
        let rank_of = |keep: &dyn Fn(usize) -> bool| {
            let rows: Vec<&Vec<f64>> = (0..m).filter(|&i| keep(i)).map(|i| &c[i]).collect();
            Exact::of(&rows).rank()
        };
        let exact = Exact::of(&c);
        for i in 0..m {
            let falls = rank_of(&|l| l != i) < exact.rank();
            assert_eq!(exact.row_is_unique(i), falls);
            seen[usize::from(falls)] += 1;
        }
        let group = [0, 1, 2];
        let apart = rank_of(&|i| group.contains(&i)) + rank_of(&|i| !group.contains(&i));
        assert_eq!(exact.freedom(&group), apart - exact.rank());
        let l: Vec<f64> = (0..m).map(|_| f64::from(numbers.between(-1, 1))).collect();
        let wider: Vec<Vec<f64>> = (0..m)
            .map(|i| [c[i].as_slice(), &[l[i]]].concat())
            .collect();
        let unique = Exact::of(&wider).rank() == exact.rank();
        assert_eq!(exact.combination_is_unique(&l), unique);
    }
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
}
