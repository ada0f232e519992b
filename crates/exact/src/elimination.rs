//! Fraction-free elimination.

use num_bigint::BigInt;
use num_traits::{One, Zero};

/// Transforms the first `columns` columns to echelon form by exchanging rows and adding multiples
/// of rows to other rows. Returns the rank r of these columns, and the transformed rows. The first
/// r rows are the pivot rows. In the other rows, the first `columns` entries are zero.
///
/// Source: E. H. Bareiss, Sylvester's identity and multistep integer-preserving Gaussian
/// elimination, Math. Comp. 22 (1968): all entries remain minors of the matrix,
/// `row ← (d_k·row − b·pivot row)/d_{k−1}`. In this implementation, a row does not change while its
/// b is zero. A row that last changed after ℓ steps has the divisor `d_ℓ`. Before such a row is
/// used as a pivot row, it is converted to the divisor `d_{k−1}`. Sparse matrices stay sparse, and
/// their entries stay small.
pub(super) fn eliminate(mut rows: Vec<Vec<BigInt>>, columns: usize) -> (usize, Vec<Vec<BigInt>>) {
    let mut determinants = vec![BigInt::one()];
    let mut steps = vec![0; rows.len()];
    for k in 0..columns {
        let r = determinants.len() - 1;
        let candidates = (r..rows.len()).filter(|&i| !rows[i][k].is_zero());
        let Some(best) =
            candidates.min_by_key(|&i| rows[i].iter().filter(|x| !x.is_zero()).count())
        else {
            continue;
        };
        rows.swap(r, best);
        steps.swap(r, best);
        if steps[r] != r {
            for x in rows[r].iter_mut().filter(|x| !x.is_zero()) {
                *x = &*x * &determinants[r] / &determinants[steps[r]];
            }
        }
        let (pivots, others) = rows.split_at_mut(r + 1);
        let pivot_row = &pivots[r];
        for (row, done) in others.iter_mut().zip(&mut steps[r + 1..]) {
            if row[k].is_zero() {
                continue;
            }
            let b = row[k].clone();
            for (x, y) in row[k..].iter_mut().zip(&pivot_row[k..]) {
                match (x.is_zero(), y.is_zero()) {
                    (true, true) => continue,
                    (false, true) => *x *= &pivot_row[k],
                    (true, false) => *x = -(&b * y),
                    (false, false) => *x = &*x * &pivot_row[k] - &b * y,
                }
                *x /= &determinants[*done];
            }
            *done = r + 1;
        }
        determinants.push(pivot_row[k].clone());
    }
    (determinants.len() - 1, rows)
}
