//! A test whether a point is a vertex of a convex hull.

use linalg::{Matrix, PivotedQr};

use crate::limits::{SEPARATED, SEPARATION_STEPS};

/// Returns whether some direction w has a positive product with each of these vectors. The result
/// is also false if the search does not end.
///
/// The method looks for nonnegative weights x with `Σ x·d = 0` and `Σ x = 1` (C. L. Lawson and
/// R. J. Hanson, *Solving Least Squares Problems*, 1974, chapter 23). If no such weights exist,
/// the residual separates the vectors from zero.
pub(super) fn is_separated(vectors: &[Vec<f64>]) -> bool {
    let Some(first) = vectors.first() else {
        return true;
    };
    let n = first.len();
    let column = |j: usize| vectors[j].iter().copied().chain([1.0]);
    let mut used: Vec<usize> = Vec::new();
    let mut weights: Vec<f64> = Vec::new();
    for _ in 0..SEPARATION_STEPS {
        let mut residual = vec![0.0; n + 1];
        residual[n] = 1.0;
        for (&j, &x) in used.iter().zip(&weights) {
            for (r, d) in residual.iter_mut().zip(column(j)) {
                *r -= x * d;
            }
        }
        let size: f64 = residual.iter().map(|r| r * r).sum();
        if size <= SEPARATED {
            return false;
        }
        let gain = |j: usize| -> f64 { column(j).zip(&residual).map(|(d, r)| d * r).sum() };
        let unused = (0..vectors.len()).filter(|j| !used.contains(j));
        let best = unused
            .map(|j| (gain(j), j))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, next)) = best.filter(|(gain, _)| *gain > SEPARATED) else {
            // Every vector d satisfies d·w ≤ −|residual|².
            return true;
        };
        used.push(next);
        weights.push(0.0);
        while !used.is_empty() {
            let matrix = Matrix::from_fn(n + 1, used.len(), |i, k| {
                if i == n { 1.0 } else { vectors[used[k]][i] }
            });
            let qr = PivotedQr::of_columns(&matrix);
            let mut solved = vec![0.0; n + 1];
            solved[n] = 1.0;
            qr.q_transpose_mul(&mut solved);
            solved.truncate(used.len());
            if qr.steps() < used.len() || qr.r_diagonal().any(|r| r.abs() < SEPARATED) {
                // The last vector depends on the other vectors.
                return false;
            }
            qr.solve_r(&mut solved);
            let mut target = vec![0.0; used.len()];
            for (x, &k) in solved.iter().zip(qr.permutation()) {
                target[k] = *x;
            }
            if target.iter().all(|x| *x > 0.0) {
                weights = target;
                break;
            }
            let steps = weights.iter().zip(&target);
            let steps = steps.filter(|(_, t)| **t <= 0.0).map(|(x, t)| x / (x - t));
            let step = steps.fold(1.0, f64::min);
            for (x, t) in weights.iter_mut().zip(&target) {
                *x += step * (t - *x);
            }
            let kept: Vec<usize> = (0..used.len())
                .filter(|&k| weights[k] > SEPARATED)
                .collect();
            used = kept.iter().map(|&k| used[k]).collect();
            weights = kept.iter().map(|&k| weights[k]).collect();
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::is_separated;

    #[test]
    fn vertices_are_separated_and_midpoints_are_not() {
        let from = |m: [f64; 3], others: &[[f64; 3]]| {
            let difference = |o: &[f64; 3]| (0..3).map(|k| m[k] - o[k]).collect();
            is_separated(&others.iter().map(difference).collect::<Vec<Vec<f64>>>())
        };
        let corners = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
        assert!(from(corners[0], &corners[1..]));
        assert!(!from([1.0, 1.0, 0.0], &corners));
        assert!(from([1.0, 1.0, 0.0], &corners[1..]));
        assert!(!from(
            [1.0, 1.0, 1.0],
            &[[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]
        ));
        assert!(from([1.0, 1.0, 1.0], &[]));
    }
}
