//! A partition of the coordinates into dependent and free ones that stays the same from
//! factorisation to factorisation. Without it every factorisation chooses its own partition, which
//! is safer and gives the same solutions. With it the free coordinates are coordinates of a
//! manifold, and the rows determine the others.

use super::KeptRowSaddle;
use super::error::{SaddleError, check_finite, check_length};

impl KeptRowSaddle {
    /// From the next factorisation on, solves for these coordinates: one for each row, in any
    /// order. Choose them well, for instance as the first columns of a
    /// [`PivotedQr`](crate::PivotedQr) of the rows; [`KeptRowSaddle::pivot_ratio`] shows when they
    /// are no longer a good choice.
    ///
    /// # Errors
    /// [`SaddleError::Length`], [`SaddleError::Partition`]: the argument does not contain r
    /// different coordinates; nothing is changed.
    pub fn partition(&mut self, dependent: &[usize]) -> Result<(), SaddleError> {
        check_length("dependent", dependent, self.rows)?;
        let mut is_dependent = vec![false; self.lu.n];
        for &coordinate in dependent {
            match is_dependent.get_mut(coordinate) {
                Some(taken @ false) => *taken = true,
                _ => {
                    return Err(SaddleError::Partition {
                        coordinate,
                        n: self.lu.n,
                    });
                }
            }
        }
        let free = (0..self.lu.n).filter(|&i| !is_dependent[i]);
        let order = dependent.iter().copied().chain(free);
        self.order.change(order, self.rows);
        Ok(())
    }

    /// The coordinates for which the last factorisation solved, one for each row in use; with
    /// graded masses the light ones.
    pub fn solved_for(&self) -> &[usize] {
        &self.lu.permutation[..self.lu.r]
    }

    /// From the next factorisation on, uses coordinates in the order of the last one. Each
    /// factorisation still solves for the largest entries, but if these are the same, nothing has
    /// to be exchanged.
    pub fn keep_order(&mut self) {
        let solvable = self.order.solvable;
        let order = self.lu.permutation.iter().copied();
        self.order.change(order, solvable);
    }

    /// From the next factorisation on, each one chooses its own coordinates.
    pub fn forget_partition(&mut self) {
        self.order.change(0..self.lu.n, self.lu.n);
    }

    /// Overwrites the dependent entries of `x` so that `C·x = γ`, and does not change the free
    /// ones. Needs no masses; does not allocate.
    ///
    /// ```
    /// use linalg::KeptRowSaddle;
    /// // The row x + 2·y = 8, solved for y.
    /// let c = [1.0, 2.0];
    /// let mut saddle = KeptRowSaddle::new(2, 1)?;
    /// saddle.partition(&[1])?;
    /// saddle.factor(|_| &c, &[1.0, 1.0])?;
    /// let mut x = [2.0, 0.0];
    /// saddle.complete(&[8.0], &mut x)?;
    /// assert_eq!(x, [2.0, 3.0]);
    /// # Ok::<(), linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// As [`KeptRowSaddle::solve`].
    pub fn complete(&mut self, gamma: &[f64], x: &mut [f64]) -> Result<(), SaddleError> {
        if !self.is_factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("gamma", gamma, self.rows)?;
        check_length("x", x, self.lu.n)?;
        check_finite("gamma", gamma, 0)?;
        check_finite("x", x, 0)?;
        for (y, &coordinate) in self.y.iter_mut().zip(&self.lu.permutation) {
            *y = x[coordinate];
        }
        self.lu.determine(gamma, &mut self.y);
        for (y, &coordinate) in self.y.iter().zip(&self.lu.permutation) {
            x[coordinate] = *y;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [[f64; 4]; 2] = [[1.0, 2.0, -1.0, 0.5], [0.0, 3.0, 1.0, -2.0]];
    const MASS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

    fn factored(dependent: &[usize]) -> KeptRowSaddle {
        let mut saddle = KeptRowSaddle::new(4, 2).unwrap();
        saddle.partition(dependent).unwrap();
        saddle.factor(|k| &ROWS[k], &MASS).unwrap();
        saddle
    }

    #[test]
    fn solutions_do_not_depend_on_the_partition() {
        let (f, gamma) = ([1.0, -2.0, 0.5, 3.0], [0.7, -0.3]);
        let solve = |saddle: &mut KeptRowSaddle| {
            let (mut a, mut lambda) = ([0.0; 4], [0.0; 2]);
            saddle.solve(&f, &gamma, &mut a, &mut lambda).unwrap();
            [a.as_slice(), &lambda].concat()
        };
        let mut free = KeptRowSaddle::new(4, 2).unwrap();
        free.factor(|k| &ROWS[k], &MASS).unwrap();
        let expected = solve(&mut free);
        for dependent in [[0, 1], [3, 1], [2, 3], [0, 2]] {
            let found = solve(&mut factored(&dependent));
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-14, "{dependent:?}: {found:?}");
            }
        }
    }

    #[test]
    fn a_kept_order_is_taken_up_first() {
        let mut saddle = KeptRowSaddle::new(4, 2).unwrap();
        saddle.factor(|k| &ROWS[k], &MASS).unwrap();
        let permutation = saddle.lu.permutation.clone();
        let (ratio, side) = (saddle.pivot_ratio(), saddle.orientation(&[1.0; 8]));
        saddle.keep_order();
        saddle.factor(|k| &ROWS[k], &MASS).unwrap();
        assert_eq!(saddle.lu.permutation, permutation);
        assert_eq!(
            (saddle.pivot_ratio(), saddle.orientation(&[1.0; 8])),
            (ratio, side)
        );
        // Entries that have become the largest are still solved for.
        let turned = [[1.0, 2.0, -1.0, 9.0], [0.0, 3.0, 1.0, -2.0]];
        saddle.factor(|k| &turned[k], &MASS).unwrap();
        assert_eq!(saddle.lu.permutation[0], 3);
    }

    #[test]
    fn free_entries_stay_and_the_rows_hold() {
        let mut saddle = factored(&[3, 0]);
        let mut x = [9.0, 0.25, -0.75, 9.0];
        saddle.complete(&[0.7, -0.3], &mut x).unwrap();
        assert_eq!(x[1..3], [0.25, -0.75]);
        for (row, gamma) in ROWS.iter().zip([0.7, -0.3]) {
            let sum: f64 = row.iter().zip(&x).map(|(c, x)| c * x).sum();
            assert!((sum - gamma).abs() < 1e-15, "{sum}");
        }
    }

    #[test]
    fn a_partition_that_cannot_be_solved_for_is_refused() {
        let mut saddle = KeptRowSaddle::new(4, 2).unwrap();
        let text = |e: SaddleError| e.to_string();
        assert_eq!(
            text(saddle.partition(&[1, 1]).unwrap_err()),
            "coordinate 1 cannot be solved for: need different coordinates below 4"
        );
        assert!(saddle.partition(&[4, 0]).is_err());
        assert!(saddle.partition(&[0]).is_err());
        // The rows are independent, but not in these two columns: they are multiples of each other.
        let rows = [[1.0, 2.0, 0.0], [2.0, 4.0, 1.0]];
        let mut saddle = KeptRowSaddle::new(3, 2).unwrap();
        saddle.partition(&[0, 1]).unwrap();
        let error = saddle.factor(|k| &rows[k], &[1.0; 3]).unwrap_err();
        assert!(matches!(error, SaddleError::RankLost { row: 1, .. }));
        saddle.forget_partition();
        assert_eq!(saddle.factor(|k| &rows[k], &[1.0; 3]), Ok(()));
    }
}
