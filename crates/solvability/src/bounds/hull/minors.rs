//! The sets of elements that can be zero together, and the solutions in which they are zero.

use linalg::kernels::{dot, norm};
use linalg::{Matrix, PivotedQr};

use super::element::{Element, HullError, Zero};
use super::points::{HullPoint, Sums, monomial};
use crate::limits::{RANDOM_SAMPLES, SAMPLE_WORK, SAMPLED_RATIO};

/// The elements of a block in terms of its basis.
pub(super) struct Minors<'e> {
    pub(super) inside: Vec<&'e Element>,
    pub(super) outside: Vec<&'e Element>,
    /// Rows of the elements outside of the basis, in terms of the basis.
    pub(super) rows: Matrix,
    pub(super) zero: Zero,
}

impl Minors<'_> {
    /// Returns an upper bound of the number of sets of elements that replace each other.
    pub(super) fn count(&self) -> u64 {
        let (n, p) = (self.inside.len() + self.outside.len(), self.inside.len());
        let mut count: u128 = 1;
        for k in 0..p.min(n - p) as u128 {
            count = count.saturating_mul(n as u128 - k) / (k + 1);
        }
        u64::try_from(count).unwrap_or(u64::MAX)
    }

    /// Returns y_m for all monomials, and the number of sets S.
    ///
    /// A set S contains the basis without the elements I, and the elements J outside of the basis.
    /// The determinant of S is the minor of `rows` with the rows J and the columns I.
    pub(super) fn points(&self) -> Result<(Vec<HullPoint>, u64), HullError> {
        let p = self.inside.len();
        // The remaining values of the elements outside of the basis, if all elements of the basis
        // are zero.
        let at_zero: Vec<f64> = self.inside.iter().map(|e| -e.value).collect();
        let left = self.outside.iter().enumerate();
        let left: Vec<f64> = left
            .map(|(i, e)| e.value + dot(self.rows.row(i), &at_zero))
            .collect();
        let mut sums = Sums::default();
        let mut sets = 0;
        for k in 0..=p.min(self.outside.len()) {
            let columns = combinations(p, k);
            for rows in combinations(self.outside.len(), k) {
                for columns in &columns {
                    let minor = Matrix::from_fn(k, k, |i, j| self.rows[(rows[i], columns[j])]);
                    let Some((det, change)) = self.solved(minor, &rows, &left)? else {
                        continue;
                    };
                    sets += 1;
                    let kept = (0..p).filter(|j| !columns.contains(j));
                    let of_basis = kept.map(|j| self.inside[j].group);
                    let of_others = rows.iter().map(|&i| self.outside[i].group);
                    let monomial = monomial(of_basis.chain(of_others));
                    let mut y = at_zero.clone();
                    for (&j, d) in columns.iter().zip(&change) {
                        y[j] += d;
                    }
                    sums.add(monomial, det * det, y);
                }
            }
        }
        Ok((sums.points(), sets))
    }

    /// Returns solutions for some compliances. In some, a single load is soft or stiff, and in
    /// others the compliances are random.
    pub(super) fn samples(&self) -> Result<Vec<HullPoint>, HullError> {
        let p = self.inside.len();
        let elements: Vec<&Element> = self.inside.iter().chain(&self.outside).copied().collect();
        let mut loads: Vec<usize> = elements.iter().map(|e| e.group).collect();
        loads.dedup();
        loads.sort_unstable();
        loads.dedup();
        let count = 2 * loads.len() + RANDOM_SAMPLES;
        let work = (elements.len() * p).saturating_mul(p).saturating_mul(count);
        if work > SAMPLE_WORK {
            return Err(HullError::Many);
        }
        // The coordinates are the changes of the elements of the basis.
        let coefficient = |i: usize, j: usize| match i.checked_sub(p) {
            None => f64::from(u8::from(i == j)),
            Some(i) => self.rows[(i, j)],
        };
        // A fixed sequence between −1 and 1.
        let mut state = 0.5_f64;
        let mut random = || {
            state = (state * 997.0 + 0.381_966).fract();
            2.0 * state - 1.0
        };
        let sample = |k: usize| {
            let root = |place: usize| match k.checked_sub(2 * loads.len()) {
                Some(_) => SAMPLED_RATIO.powf(random()),
                None if k / 2 != place => 1.0,
                None if k.is_multiple_of(2) => SAMPLED_RATIO,
                None => SAMPLED_RATIO.recip(),
            };
            let roots: Vec<f64> = (0..loads.len()).map(root).collect();
            let root = |e: &Element| loads.binary_search(&e.group).map_or(0.0, |k| roots[k]);
            let weighted = Matrix::from_fn(elements.len(), p, |i, j| {
                root(elements[i]) * coefficient(i, j)
            });
            let left = elements.iter().map(|e| -root(e) * e.value).collect();
            HullPoint {
                monomial: loads.iter().map(|load| (*load, 1)).collect(),
                weight: 1.0,
                y: solved(&PivotedQr::of_columns(&weighted), left),
            }
        };
        Ok((0..count).map(sample).collect())
    }

    /// Returns the determinant of a minor, and the change of the coordinates that makes the
    /// elements in its rows zero. Returns `None` if the minor is singular.
    fn solved(
        &self,
        minor: Matrix,
        rows: &[usize],
        left: &[f64],
    ) -> Result<Option<(f64, Vec<f64>)>, HullError> {
        let k = minor.nrows();
        if k == 0 {
            return Ok(Some((1.0, Vec::new())));
        }
        let most: f64 = (0..k).map(|i| norm(minor.row(i))).product();
        if most == 0.0 {
            return Ok(None);
        }
        let qr = PivotedQr::of_columns(&minor);
        let det: f64 = qr.r_diagonal().product();
        if self.zero.holds(det / most, self.outside[rows[0]].group)? {
            return Ok(None);
        }
        let left: Vec<f64> = rows.iter().map(|&i| -left[i]).collect();
        Ok(Some((det, solved(&qr, left))))
    }
}

/// Returns all subsets with k elements of the numbers below n.
fn combinations(n: usize, k: usize) -> Vec<Vec<usize>> {
    let mut out = Vec::new();
    let mut chosen: Vec<usize> = (0..k).collect();
    if k > n {
        return out;
    }
    loop {
        out.push(chosen.clone());
        let Some(i) = (0..k).rev().find(|&i| chosen[i] < n - k + i) else {
            return out;
        };
        chosen[i] += 1;
        for j in i + 1..k {
            chosen[j] = chosen[j - 1] + 1;
        }
    }
}

/// Returns the x that minimises |A·x − b|, from the factors of A with full column rank.
pub(super) fn solved(qr: &PivotedQr, mut b: Vec<f64>) -> Vec<f64> {
    let columns = qr.permutation();
    qr.q_transpose_mul(&mut b);
    b.truncate(columns.len());
    qr.solve_r(&mut b);
    let mut x = vec![0.0; columns.len()];
    for (b, &k) in b.iter().zip(columns) {
        x[k] = *b;
    }
    x
}
