//! A bound on the number of entries of the factors, for any choice of pivot coordinates.
//!
//! When a row is eliminated, the later rows can receive an entry in every coordinate in which this
//! row can have entries. Source: A. George, E. Ng, Symbolic factorization for sparse Gaussian
//! elimination with partial pivoting, SIAM J. Sci. Stat. Comput. 8 (1987) 877–898.

use std::collections::BTreeSet;

use crate::DisjointSets;

/// Returns the maximum numbers of entries of U and of L below their diagonals, for n coordinates
/// and rows with these columns.
pub(super) fn bound(n: usize, columns: &[&[usize]]) -> [usize; 2] {
    let mut sets = DisjointSets::new(n);
    // For each set, at the index of its representative: the number of coordinates that are not
    // pivots, and the later rows.
    let mut size = vec![1_usize; n];
    let mut rows: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
    for (k, columns) in columns.iter().enumerate() {
        for &column in *columns {
            rows[column].insert(k);
        }
    }
    let [mut upper, mut lower] = [0; 2];
    for (k, columns) in columns.iter().enumerate() {
        let Some((&first, others)) = columns.split_first() else {
            continue;
        };
        for &other in others {
            let [a, b] = [first, other].map(|column| sets.first(column));
            if a != b {
                let [of_a, of_b] = [a, b].map(|set| std::mem::take(&mut rows[set]));
                let (mut all, few) = if of_a.len() < of_b.len() {
                    (of_b, of_a)
                } else {
                    (of_a, of_b)
                };
                all.extend(few);
                let together = size[a] + size[b];
                sets.join(a, b);
                let set = sets.first(a);
                size[set] = together;
                rows[set] = all;
            }
        }
        let set = sets.first(first);
        rows[set].remove(&k);
        size[set] = size[set].saturating_sub(1);
        lower += size[set];
        upper += rows[set].len();
    }
    [upper, lower]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KeptRowSaddle, SparseMatrix};

    #[test]
    fn dense_rows_fill_their_triangles() {
        assert_eq!(bound(5, &[&[0, 1, 2, 3, 4][..]; 3]), [3, 9]);
    }

    #[test]
    fn no_choice_of_coordinates_needs_more() {
        const N: usize = 30;
        for seed in 0..40_usize {
            let row = |k: usize| {
                [
                    k,
                    (7 * k + seed) % N,
                    (5 * k + 3) % N,
                    (11 * k + 2 * seed) % N,
                ]
                .map(|j| (j, (0.3 + (seed + 3 * k + 5 * j) as f64).sin()))
            };
            let c = SparseMatrix::from_rows(N, (0..20).map(row)).unwrap();
            let columns: Vec<Vec<usize>> = (0..20).map(|k| c.row(k).0.to_vec()).collect();
            let mut saddle = KeptRowSaddle::with_columns(N, &columns).unwrap();
            saddle.factor(|k| c.row(k).1, &[1.0; N]).unwrap();
            let found = saddle.lu.n_entries();
            let order = saddle.lu.order().rows.iter().map(|&k| c.row(k).0);
            let most = bound(N, &Vec::from_iter(order));
            assert!(
                found[0] <= most[0] && found[1] <= most[1],
                "{found:?} {most:?}"
            );
        }
    }
}
