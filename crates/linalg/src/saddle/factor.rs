//! Factorisation: LU of Cᵀ row by row, null space basis, reduced mass.

use super::error::{SaddleError, check_added, check_finite, check_length};
use super::lu::Elimination;
use super::{KeptRowSaddle, mass_spread};
use crate::MassMatrix;
use crate::kernels::{extremes, max_abs};
use crate::limits::{GRADED_BESIDE_MASSLESS, GRADED_MASSES, PIVOT_FLOOR};

impl KeptRowSaddle {
    /// Computes the factors for the independent rows of C and the masses.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `row` | r calls | `row(k)`: values of the k-th row of C in its columns |
    /// | `mass` | n | diagonal of M, entries ≥ 0 |
    ///
    /// For rows without zeros, the function costs about n·r² + k·r²/2 + k²·r/2 multiplications. It
    /// allocates memory in three cases: in the first factorisation, which determines the order of
    /// elimination; if it fails; and if large factors have more entries than before. After an error
    /// the solver has no factorisation.
    ///
    /// # Errors
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad
    ///   input.
    /// - [`SaddleError::RankLost`]: a row depends on the previous rows to working precision.
    /// - [`SaddleError::MasslessMotion`]: M is not positive definite on ker C. The error contains
    ///   the motion.
    pub fn factor<'c, 'm>(
        &mut self,
        row: impl Fn(usize) -> &'c [f64],
        mass: impl Into<MassMatrix<'m>>,
    ) -> Result<(), SaddleError> {
        let mass = mass.into();
        self.prepare(&row, mass)?;
        let graded = self.is_graded.then_some(mass.diagonal());
        for j in 0..self.lu.n_rows() {
            let k = self.lu.order().rows[j];
            let row = (k, row(k));
            if let Elimination::Dependent { pivot, scale } =
                self.lu.eliminate(row, graded, PIVOT_FLOOR)?
            {
                return Err(SaddleError::RankLost {
                    row: k,
                    pivot,
                    scale,
                });
            }
        }
        self.finish(row, mass)
    }

    /// Works like [`KeptRowSaddle::factor`], but skips a row if its pivot is at most `floor` times
    /// its largest entry. If rows are dependent for an instant, the other rows determine the
    /// solution. The multiplier of a skipped row is zero, and its equation is not satisfied.
    ///
    /// ```
    /// use pfaff_linalg::KeptRowSaddle;
    /// let rows = [[1.0, 0.0], [1.0, 1e-9]];
    /// let mut saddle = KeptRowSaddle::new(2, 2)?;
    /// saddle.factor_above(1e-6, |k| &rows[k], &[1.0, 1.0])?;
    /// let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
    /// saddle.solve(&[3.0, 5.0], &[2.0, 7.0], &mut a, &mut lambda)?;
    /// assert_eq!((a, lambda, saddle.n_left_out()), ([2.0, 5.0], [1.0, 0.0], 1));
    /// # Ok::<(), pfaff_linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowSaddle::factor`], without [`SaddleError::RankLost`].
    pub fn factor_above<'c, 'm>(
        &mut self,
        floor: f64,
        row: impl Fn(usize) -> &'c [f64],
        mass: impl Into<MassMatrix<'m>>,
    ) -> Result<(), SaddleError> {
        self.factor_up_to(usize::MAX, floor, row, mass)
    }

    /// Works like [`KeptRowSaddle::factor_above`], but stops before the null space is computed if
    /// the number of free motions exceeds a limit. Above this limit another solver needs less work.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowSaddle::factor_above`], and [`SaddleError::ManyFree`].
    pub fn factor_up_to<'c, 'm>(
        &mut self,
        most_free: usize,
        floor: f64,
        row: impl Fn(usize) -> &'c [f64],
        mass: impl Into<MassMatrix<'m>>,
    ) -> Result<(), SaddleError> {
        let mass = mass.into();
        self.prepare(&row, mass)?;
        let graded = self.is_graded.then_some(mass.diagonal());
        let floor = floor.max(PIVOT_FLOOR);
        for j in 0..self.lu.n_rows() {
            let k = self.lu.order().rows[j];
            self.lu.eliminate((k, row(k)), graded, floor)?;
        }
        let free = self.lu.n - self.lu.r;
        if free > most_free {
            return Err(SaddleError::ManyFree { free });
        }
        self.finish(row, mass)
    }

    fn prepare<'c>(
        &mut self,
        row: impl Fn(usize) -> &'c [f64],
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        self.is_factored = false;
        check_added(mass.added(), self.lu.n)?;
        let mass = mass.diagonal();
        check_length("mass", mass, self.lu.n)?;
        check_finite("mass", mass, 0)?;
        let [lightest, heaviest] = extremes(mass);
        if let (true, Some(index)) = (lightest < 0.0, mass.iter().position(|&m| m < 0.0)) {
            return Err(SaddleError::NegativeMass {
                index,
                value: mass[index],
            });
        }
        let from;
        (self.mass_spread, from) = if lightest > 0.0 {
            (heaviest / lightest, GRADED_MASSES)
        } else {
            (mass_spread(mass), GRADED_BESIDE_MASSLESS)
        };
        self.mass_spread = self.known_spread.unwrap_or(self.mass_spread);
        self.is_graded = self.mass_spread >= from;
        self.lu.begin(row);
        Ok(())
    }

    fn finish<'c>(
        &mut self,
        row: impl Fn(usize) -> &'c [f64],
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        if self.lu.finish() {
            self.free.follow(&mut self.lu);
        }
        let lu = &self.lu;
        let entry = |k: usize, coordinate: usize| {
            let (columns, values) = (lu.columns.of(k), row(k));
            let at = columns.iter().position(|&i| i as usize == coordinate);
            at.map_or(0.0, |at| values[at].abs() / max_abs(values))
        };
        self.free.factor(lu, entry, mass)?;
        self.is_factored = true;
        Ok(())
    }
}
