//! Chooses basis vectors with simple coefficients for a space of velocities. Conditions are imposed
//! one after the other. A condition is used only if a velocity that satisfies it is independent of
//! the velocities already chosen. Other modules decide the rank.

use crate::limits::{NEW_MOTION, SATISFIED};
use linalg::{Matrix, PivotedQr};

/// A linear form of the velocities, as columns and coefficients. The coefficients are at most about
/// 1.
pub(super) type Form = Vec<(usize, f64)>;

/// The velocities that the rows allow, and the velocities that are already chosen.
pub(super) struct Space<'a> {
    /// Orthonormal basis, n × f.
    all: &'a Matrix,
    /// Coefficients of the chosen velocities in this basis, orthonormal.
    chosen: Vec<Vec<f64>>,
}

/// A subspace: orthonormal columns of coefficients, f × k.
pub(super) type Subspace = Matrix;

/// Linear forms that must be zero. Each row contains the f coefficients of one form with respect to
/// a basis of the space.
pub(super) type Condition = Matrix;

impl<'a> Space<'a> {
    /// Returns the space that the orthonormal columns span.
    pub(super) fn new(all: &'a Matrix) -> Self {
        let chosen = Vec::new();
        Self { all, chosen }
    }

    /// Returns the dimension of the space minus the number of chosen velocities.
    pub(super) fn left(&self) -> usize {
        self.all.ncols() - self.chosen.len()
    }

    /// Returns the whole space.
    pub(super) fn whole(&self) -> Subspace {
        Matrix::identity(self.all.ncols())
    }

    /// Marks velocities that the caller reports separately as chosen. Returns `false` and marks no
    /// velocity if one of the velocities is not in the space.
    pub(super) fn take_out(&mut self, velocities: &[Vec<f64>]) -> bool {
        let mut within = Vec::new();
        for v in velocities {
            let coefficients = self.all.transpose_times(v);
            let image = self.all.times(&coefficients);
            let missing = image.iter().zip(v).map(|(a, b)| a - b);
            if norm(missing) > SATISFIED * norm(v.iter().copied()) {
                return false;
            }
            within.push(coefficients);
        }
        for coefficients in within {
            self.choose(coefficients);
        }
        true
    }

    /// Returns the condition on the coefficients that these forms define.
    pub(super) fn condition(&self, forms: &[Form]) -> Condition {
        let mut rows = Matrix::zeros(forms.len(), self.all.ncols());
        for (i, form) in forms.iter().enumerate() {
            let g = rows.row_mut(i);
            for &(j, coefficient) in form {
                for (g, n) in g.iter_mut().zip(self.all.row(j)) {
                    *g += coefficient * n;
                }
            }
        }
        rows
    }

    /// Returns the part of a subspace that satisfies a condition. Returns `None` if this part
    /// contains no new vector.
    pub(super) fn restricted(&self, y: &Subspace, condition: &Condition) -> Option<Subspace> {
        let k = y.ncols();
        let qr = PivotedQr::of_rows(condition.product(y));
        let rank = qr.r_diagonal().filter(|r| r.abs() > SATISFIED).count();
        let mut left = Matrix::zeros(y.nrows(), k - rank);
        let mut row = vec![0.0; k];
        for i in 0..y.nrows() {
            row.copy_from_slice(y.row(i));
            qr.q_transpose_mul(&mut row);
            left.row_mut(i).copy_from_slice(&row[rank..]);
        }
        self.newest(&left).map(|_| left)
    }

    /// Chooses a velocity of a subspace (n numbers). Returns `None` if the subspace contains no new
    /// velocity.
    pub(super) fn take(&mut self, y: &Subspace) -> Option<Vec<f64>> {
        let column = self.newest(y)?;
        let coefficients: Vec<f64> = (0..y.nrows()).map(|i| y[(i, column)]).collect();
        let v = self.all.times(&coefficients);
        self.choose(coefficients);
        Some(v)
    }

    /// Returns the column that differs most from the chosen velocities, if a column is new.
    fn newest(&self, y: &Subspace) -> Option<usize> {
        let mut best = (NEW_MOTION, None);
        for j in 0..y.ncols() {
            let column: Vec<f64> = (0..y.nrows()).map(|i| y[(i, j)]).collect();
            let size = norm(self.remainder(column).into_iter());
            if size > best.0 {
                best = (size, Some(j));
            }
        }
        best.1
    }

    /// Returns the part of these coefficients that is orthogonal to the chosen coefficients.
    fn remainder(&self, mut x: Vec<f64>) -> Vec<f64> {
        for c in &self.chosen {
            let along: f64 = c.iter().zip(&x).map(|(a, b)| a * b).sum();
            x.iter_mut().zip(c).for_each(|(x, c)| *x -= along * c);
        }
        x
    }

    fn choose(&mut self, coefficients: Vec<f64>) {
        // The projection is applied twice, so that the chosen vectors are orthogonal to rounding.
        let rest = self.remainder(self.remainder(coefficients));
        let size = norm(rest.iter().copied());
        if size > 0.0 {
            self.chosen.push(rest.iter().map(|x| x / size).collect());
        }
    }
}

fn norm(x: impl Iterator<Item = f64>) -> f64 {
    x.map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocities (a, b, c) with a = b. The first vector has a = 0 and moves only c. The second
    /// vector has a = b.
    #[test]
    fn conditions_choose_what_is_left() {
        let half = 0.5_f64.sqrt();
        let all = Matrix::from_rows(&[[half, 0.0], [half, 0.0], [0.0, 1.0]]);
        let mut space = Space::new(&all);
        let first = space.condition(&[vec![(0, 1.0)]]);
        let y = space.restricted(&space.whole(), &first).expect("c is left");
        let v = space.take(&y).expect("new");
        assert!(v[0].abs() < 1e-15 && v[1].abs() < 1e-15 && (v[2].abs() - 1.0).abs() < 1e-15);
        assert_eq!(space.left(), 1);
        assert!(space.restricted(&space.whole(), &first).is_none());
        let third = space.condition(&[vec![(2, 1.0)]]);
        let y = space
            .restricted(&space.whole(), &third)
            .expect("a = b is left");
        let v = space.take(&y).expect("new");
        assert!((v[0] - v[1]).abs() < 1e-15 && v[2].abs() < 1e-15, "{v:?}");
        assert_eq!(space.left(), 0);
    }

    #[test]
    fn only_what_lies_in_the_space_is_taken_out() {
        let all = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]);
        let mut space = Space::new(&all);
        assert!(!space.take_out(&[vec![1.0, 0.0, 0.0], vec![0.0, 0.0, 1.0]]));
        assert_eq!(space.left(), 2);
        assert!(space.take_out(&[vec![3.0, 1.0, 0.0]]));
        assert_eq!(space.left(), 1);
    }
}
