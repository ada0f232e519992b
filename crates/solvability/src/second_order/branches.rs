//! Finds other solutions of the quadratic equations by Gauss–Newton iterations on the unit sphere
//! from many starts.

use crate::limits::{BRANCH_ITERATIONS, BRANCH_RESIDUAL, BRANCH_STARTS, OTHER_BRANCH, SAME_BRANCH};
use linalg::{Matrix, least_squares_step};

use super::forms::Forms;

/// Returns the largest number of listed branches. This number is the number of solutions if all
/// solutions are simple.
fn most(forms: &Forms) -> usize {
    (1 << forms.y()) - 1
}

/// Returns unit vectors a that satisfy `aᵀ·M_s·a = 0` for all forms. The vectors differ from the
/// motion itself, up to sign.
pub(super) fn others(forms: &Forms) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    for start in 0..BRANCH_STARTS * most(forms) {
        let Some(a) = solve(&forms.matrices, starting_point(forms.len(), start)) else {
            continue;
        };
        let is_new = |b: &Vec<f64>| {
            let overlap: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            1.0 - overlap.abs() > SAME_BRANCH
        };
        let y = a[forms.x()..].iter().map(|y| y * y).sum::<f64>().sqrt();
        let possible = !forms.is_driven() || a[0].abs() > OTHER_BRANCH;
        if y > OTHER_BRANCH && possible && found.iter().all(is_new) {
            found.push(a);
            if found.len() == most(forms) {
                break;
            }
        }
    }
    found
}

/// Returns a unit vector as starting point. No two starting points are the same.
pub(super) fn starting_point(n: usize, start: usize) -> Vec<f64> {
    // Multiples of square roots of primes are evenly distributed in all directions.
    const PRIMES: [f64; 8] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0];
    let place = (start + 1) as f64;
    unit(
        (0..n)
            .map(|k| {
                let prime = PRIMES[k % PRIMES.len()] + (k / PRIMES.len()) as f64;
                (place * prime.sqrt()).fract() - 0.5
            })
            .collect(),
    )
}

fn unit(mut a: Vec<f64>) -> Vec<f64> {
    let size = a.iter().map(|a| a * a).sum::<f64>().sqrt();
    // The sign is chosen so that the first non-zero entry is positive.
    let sign = a
        .iter()
        .find(|a| a.abs() > OTHER_BRANCH * size)
        .map_or(1.0, |a| a.signum());
    a.iter_mut().for_each(|a| *a *= sign / size);
    a
}

/// Returns the solution to which the iteration converges from a.
pub(super) fn solve(forms: &[Matrix], mut a: Vec<f64>) -> Option<Vec<f64>> {
    let (n, equations) = (a.len(), forms.len() + 1);
    let weights = vec![1.0; n];
    for _ in 0..BRANCH_ITERATIONS {
        let mut jacobian = Matrix::zeros(equations, n);
        let mut residual = vec![0.0; equations];
        for (s, form) in forms.iter().enumerate() {
            let image = form.times(&a);
            residual[s] = a.iter().zip(&image).map(|(a, m)| a * m).sum();
            for (j, m) in jacobian.row_mut(s).iter_mut().zip(&image) {
                *j = 2.0 * m;
            }
        }
        let met = residual.iter().all(|r| r.abs() <= BRANCH_RESIDUAL);
        // The last row keeps the length constant.
        jacobian.row_mut(equations - 1).copy_from_slice(&a);
        let step = least_squares_step(&jacobian, &residual, &weights, f64::EPSILON).ok()?;
        a.iter_mut().zip(&step).for_each(|(a, d)| *a += d);
        a = unit(a);
        // After the residual has reached rounding, one more step follows.
        if met {
            return Some(a);
        }
    }
    None
}
