//! A partition of the coordinates into dependent and free coordinates that does not change between
//! factorisations. Without a fixed partition, every factorisation chooses its own partition, which
//! is safer and gives the same solutions. With a fixed partition, the free coordinates are
//! coordinates of a manifold, and the rows determine the dependent coordinates.

use super::KeptRowSaddle;
use super::error::{SaddleError, check_finite, check_length};

impl KeptRowSaddle {
    /// From the next factorisation onwards, uses these coordinates as pivots: one for each row, in
    /// any order. A good choice is, for example, the first columns of a
    /// [`PivotedQr`](crate::PivotedQr) of the rows. [`KeptRowSaddle::pivot_ratio`] indicates when
    /// these coordinates are no longer a good choice.
    ///
    /// # Errors
    /// [`SaddleError::Length`], [`SaddleError::Partition`]: the argument does not contain r
    /// different coordinates. In this case nothing changes.
    pub fn partition(&mut self, dependent: &[usize]) -> Result<(), SaddleError> {
        check_length("dependent", dependent, self.lu.n_rows())?;
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
        self.lu.solve_for(Some(is_dependent));
        Ok(())
    }

    /// Returns the pivot coordinates of the last factorisation, one for each row in use. With
    /// graded masses, the pivot coordinates are light coordinates.
    pub fn solved_for(&self) -> &[usize] {
        self.lu.pivots()
    }

    /// From the next factorisation onwards, any coordinates with large entries can be pivots.
    pub fn forget_partition(&mut self) {
        self.lu.solve_for(None);
    }

    /// Overwrites the dependent entries of `x` so that `C·x = γ`, and does not change the free
    /// entries. The function needs no masses and does not allocate memory.
    ///
    /// ```
    /// use pfaff_linalg::KeptRowSaddle;
    /// // The row x + 2·y = 8, solved for y.
    /// let c = [1.0, 2.0];
    /// let mut saddle = KeptRowSaddle::new(2, 1)?;
    /// saddle.partition(&[1])?;
    /// saddle.factor(|_| &c, &[1.0, 1.0])?;
    /// let mut x = [2.0, 0.0];
    /// saddle.complete(&[8.0], &mut x)?;
    /// assert_eq!(x, [2.0, 3.0]);
    /// # Ok::<(), pfaff_linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowSaddle::solve`].
    pub fn complete(&mut self, gamma: &[f64], x: &mut [f64]) -> Result<(), SaddleError> {
        if !self.is_factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("gamma", gamma, self.lu.n_rows())?;
        check_length("x", x, self.lu.n)?;
        check_finite("gamma", gamma, 0)?;
        check_finite("x", x, 0)?;
        self.lu.determine(gamma, x);
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
    fn a_row_is_solved_for_the_same_entry_while_that_is_nearly_the_largest() {
        let mut saddle = KeptRowSaddle::new(4, 2).unwrap();
        let mut solved_for = |first: [f64; 4]| {
            let rows = [first, ROWS[1]];
            saddle.factor(|k| &rows[k], &MASS).unwrap();
            let (mut a, mut lambda) = ([0.0; 4], [0.0; 2]);
            saddle
                .solve(&MASS, &[0.7, -0.3], &mut a, &mut lambda)
                .unwrap();
            let mut fresh = KeptRowSaddle::new(4, 2).unwrap();
            fresh.factor(|k| &rows[k], &MASS).unwrap();
            let (mut b, mut mu) = ([0.0; 4], [0.0; 2]);
            fresh.solve(&MASS, &[0.7, -0.3], &mut b, &mut mu).unwrap();
            let found = a.iter().chain(&lambda);
            assert!(
                found
                    .zip(b.iter().chain(&mu))
                    .all(|(a, b)| (a - b).abs() < 1e-14)
            );
            saddle.solved_for()[0]
        };
        assert_eq!(solved_for(ROWS[0]), 1);
        assert_eq!(solved_for([1.0, 2.0, -1.0, 2.4]), 1);
        assert_eq!(solved_for([1.0, 2.0, -1.0, 2.6]), 3);
        assert_eq!(solved_for([1.0, 2.0, -1.0, 1.7]), 3);
        assert_eq!(solved_for(ROWS[0]), 1);
    }

    /// The same test for a pivot that reduces the work for other rows. The other rows also have
    /// entries in coordinate 0.
    #[test]
    fn a_row_is_solved_for_the_same_entry_while_that_is_large() {
        let columns = [vec![0, 1], vec![0, 2], vec![0, 3]];
        let mut saddle = KeptRowSaddle::with_columns(4, &columns).unwrap();
        for (share, solved_for) in [(1.0, 1), (0.051, 1), (0.049, 0), (0.051, 0)] {
            let first = [1.0, share];
            let row = |k: usize| if k == 0 { &first[..] } else { &[1.0, 1.0] };
            saddle.factor(row, &MASS).unwrap();
            assert_eq!(saddle.solved_for()[0], solved_for, "{share}");
        }
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
