//! Finds proved bounds of the smallest change of data that satisfies linear equations. Every set of
//! multipliers gives a lower bound by duality, and every solution gives an upper bound.
//!
//! `min max_P |x_P|` under `target + Σ_P a_P·x_P = 0` has the dual `max targetᵀ·y` under
//! `Σ_P |Aᵀ_P·y| ≤ 1`.

/// Largest number of iterations of reweighted least squares, and relative distance of the bounds at
/// which the iteration stops.
const ITERATIONS: usize = 80;
const CLOSE: f64 = 1.1;

/// Smallest weight, as a fraction of the largest.
const LEAST_WEIGHT: f64 = 1e-8;

/// Equations with dependent left-hand sides contradict each other if their right-hand sides differ
/// by more than this fraction.
const CONTRADICTS: f64 = 1e-6;

/// One linear equation.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The value for the current data, which must become zero.
    pub target: f64,
    /// Coefficients of each point, direction or single value.
    pub parts: Vec<[f64; 2]>,
}

/// Lower and upper bound of the smallest change.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// No smaller change satisfies the equations.
    pub low: f64,
    /// A change of this size satisfies the equations.
    pub high: f64,
}

/// Returns bounds of the smallest possible value of the largest change. In addition to the data,
/// each equation contains a separate unknown change with the coefficient `slack`.
#[must_use]
pub fn least_change(equations: &[Equation], slack: f64) -> Bounds {
    let e = equations.len();
    let blocks = equations.first().map_or(0, |first| first.parts.len());
    let mut weights = vec![1.0; blocks + e];
    let mut bounds = Bounds {
        low: 0.0,
        high: f64::INFINITY,
    };
    for _ in 0..ITERATIONS {
        let mut matrix = vec![vec![0.0; e]; e];
        for (i, left) in equations.iter().enumerate() {
            for (j, right) in equations.iter().enumerate().take(i + 1) {
                let parts = left.parts.iter().zip(&right.parts).zip(&weights);
                let sum: f64 = parts
                    .map(|((a, b), w)| (a[0] * b[0] + a[1] * b[1]) / w)
                    .sum();
                matrix[i][j] = sum;
                matrix[j][i] = sum;
            }
            matrix[i][i] += slack * slack / weights[blocks + i];
        }
        let targets: Vec<f64> = equations.iter().map(|eq| eq.target).collect();
        let largest = targets.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let Some(Solved { y, left }) = solve(matrix, targets) else {
            break;
        };
        if left > CONTRADICTS * largest {
            // No change of data satisfies contradicting equations; they are satisfied only by their
            // slack.
            bounds.low = bounds.low.max(left / (slack * e as f64));
            bounds.high = f64::INFINITY;
            break;
        }
        // Computes Aᵀ·y, block by block.
        let size = |p: usize| match p.checked_sub(blocks) {
            Some(i) => (slack * y[i]).abs(),
            None => {
                let mut sum = [0.0; 2];
                for (equation, y) in equations.iter().zip(&y) {
                    sum[0] += equation.parts[p][0] * y;
                    sum[1] += equation.parts[p][1] * y;
                }
                sum[0].hypot(sum[1])
            }
        };
        let sizes: Vec<f64> = (0..blocks + e).map(size).collect();
        let gained: f64 = equations.iter().zip(&y).map(|(eq, y)| eq.target * y).sum();
        let spent: f64 = sizes.iter().sum();
        let changes: Vec<f64> = sizes.iter().zip(&weights).map(|(a, w)| a / w).collect();
        let largest = changes.iter().copied().fold(0.0, f64::max);
        if !(largest.is_finite() && gained.is_finite()) || spent == 0.0 {
            break;
        }
        bounds.low = bounds.low.max(gained.abs() / spent);
        bounds.high = bounds.high.min(largest);
        if bounds.high <= CLOSE * bounds.low {
            break;
        }
        let total: f64 = changes.iter().zip(&weights).map(|(x, w)| x * w).sum();
        for (w, x) in weights.iter_mut().zip(&changes) {
            *w *= x / total;
        }
        let least = LEAST_WEIGHT * weights.iter().copied().fold(0.0, f64::max);
        weights.iter_mut().for_each(|w| *w = w.max(least));
    }
    bounds
}

/// A solution, and its residual in the largest equation that was omitted.
struct Solved {
    y: Vec<f64>,
    left: f64,
}

/// Performs Gaussian elimination with complete pivoting of a symmetric matrix. Pivots that are
/// rounding errors relative to the first pivot are omitted. Returns `None` if there are no other
/// pivots.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Solved> {
    const ROUNDING: f64 = 1e-13;
    let n = b.len();
    let mut columns: Vec<usize> = (0..n).collect();
    let (mut first, mut rank) = (0.0, 0);
    for k in 0..n {
        let places = (k..n).flat_map(|i| (k..n).map(move |j| (i, j)));
        let largest = |x: &(usize, usize), y: &(usize, usize)| {
            a[x.0][x.1].abs().total_cmp(&a[y.0][y.1].abs())
        };
        let (i, j) = places.max_by(largest)?;
        let pivot = a[i][j].abs();
        first = f64::max(first, pivot);
        if pivot.is_nan() || pivot <= ROUNDING * first {
            break;
        }
        rank = k + 1;
        a.swap(k, i);
        b.swap(k, i);
        for row in &mut a {
            row.swap(k, j);
        }
        columns.swap(k, j);
        let (above, below) = a.split_at_mut(k + 1);
        let pivots = &above[k];
        for (row, r) in below.iter_mut().zip(k + 1..) {
            let factor = row[k] / pivots[k];
            if factor != 0.0 {
                for (x, p) in row[k..].iter_mut().zip(&pivots[k..]) {
                    *x -= factor * p;
                }
                b[r] -= factor * b[k];
            }
        }
    }
    if rank == 0 {
        return None;
    }
    let left = b[rank..].iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let mut x = vec![0.0; n];
    for k in (0..rank).rev() {
        let known: f64 = (k + 1..rank).map(|j| a[k][j] * x[columns[j]]).sum();
        x[columns[k]] = (b[k] - known) / a[k][k];
    }
    Some(Solved { y: x, left })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equation(target: f64, parts: &[[f64; 2]]) -> Equation {
        Equation {
            target,
            parts: parts.to_vec(),
        }
    }

    #[test]
    fn bounds_enclose_what_is_known_by_hand() {
        // The equation is 6 = 1·x + 2·y + |(0, 3)·z|, and all three change by 1.
        let one = [equation(6.0, &[[1.0, 0.0], [2.0, 0.0], [0.0, 3.0]])];
        // If x = 3 and y = 4 belong to one point, the change is 5; if they are two separate values,
        // it is 4.
        let point = [equation(3.0, &[[1.0, 0.0]]), equation(4.0, &[[0.0, 1.0]])];
        let numbers = [
            equation(3.0, &[[1.0, 0.0], [0.0; 2]]),
            equation(4.0, &[[0.0; 2], [1.0, 0.0]]),
        ];
        for (equations, right) in [(&one[..], 1.0), (&point[..], 5.0), (&numbers[..], 4.0)] {
            let Bounds { low, high } = least_change(equations, 1e-9);
            assert!(
                low <= right * 1.001 && high >= right * 0.999,
                "{low} {high}"
            );
            assert!(high < 1.11 * low, "{low} {high}");
        }
        let never = [equation(1.0, &[[1.0, 0.0]]), equation(-1.0, &[[1.0, 0.0]])];
        assert!(least_change(&never, 1e-9).low > 1e6);
    }
}
