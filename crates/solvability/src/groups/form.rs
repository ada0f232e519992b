//! A number that is linear in the multipliers, and the size of the terms in its sum. Such numbers
//! are a component, a sum of components, a moment about a point, or a resultant.

use linalg::Matrix;

use super::error::{RequestError, check_finite};
use crate::choices::FreeMultipliers;
use crate::matrices::Solvability;
use crate::verdict::Judgement;

/// The number `ℓᵀ·λ`, which is a sum of terms over all rows.
///
/// The sizes of the terms determine the rounding. If terms cancel, the remainder is compared with
/// the terms, not with itself. Therefore a total that vanishes identically is unique, even if
/// rounding leaves a remainder.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_solvability::{LinearForm, Solvability, Verdict};
/// // Rows 0 and 1 are the same: only the sum of their multipliers is determined.
/// let c = Matrix::from_rows(&[[0.1, 0.0], [0.1, 0.0], [0.0, 1.0]]);
/// let s = Solvability::of(&c, rank::Accuracy::Rounding)?;
/// let mut sum = LinearForm::zero(3);
/// sum.add(&[(0, 1.0), (1, 1.0)])?;
/// assert_eq!(sum.judge(&s)?.verdict, Verdict::Unique);
/// // λ₁ comes in and goes out again: 0.3 − 0.1 − 0.2 is not zero in floating point, but it is nothing.
/// let mut nothing = LinearForm::zero(3);
/// nothing.add(&[(1, 0.3), (1, -0.1), (1, -0.2)])?;
/// assert!(nothing.coefficients()[1] != 0.0);
/// assert_eq!(nothing.judge(&s)?.verdict, Verdict::Unique);
/// nothing.add(&[(1, 1e-9)])?;
/// assert_eq!(nothing.judge(&s)?.verdict, Verdict::NotUnique);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearForm {
    coefficients: Vec<f64>,
    sizes: Vec<f64>,
}

impl LinearForm {
    /// Returns the form zero for a matrix with this number of rows.
    #[must_use]
    pub fn zero(rows: usize) -> Self {
        Self {
            coefficients: vec![0.0; rows],
            sizes: vec![0.0; rows],
        }
    }

    /// Adds `coefficient·λ_row` for each pair.
    ///
    /// # Errors
    /// [`RequestError::UnknownRow`], [`RequestError::NotFinite`]. If there is an error, the form
    /// does not change.
    pub fn add(&mut self, terms: &[(usize, f64)]) -> Result<(), RequestError> {
        let rows = self.coefficients.len();
        let coefficients: Vec<f64> = terms.iter().map(|(_, c)| *c).collect();
        check_finite("coefficients", &coefficients)?;
        if let Some(&(row, _)) = terms.iter().find(|(row, _)| *row >= rows) {
            return Err(RequestError::UnknownRow { row, rows });
        }
        for &(row, coefficient) in terms {
            self.add_term(row, coefficient, coefficient.abs());
        }
        Ok(())
    }

    /// Adds a multiple of another form.
    pub(super) fn add_scaled(&mut self, other: &Self, factor: f64) {
        for (i, (l, size)) in other.coefficients.iter().zip(&other.sizes).enumerate() {
            self.add_term(i, factor * l, factor.abs() * size);
        }
    }

    /// Returns the part of the form that belongs to these rows.
    pub(super) fn only(&self, rows: &[usize]) -> Self {
        let mut part = Self::zero(self.coefficients.len());
        for &i in rows {
            part.add_term(i, self.coefficients[i], self.sizes[i]);
        }
        part
    }

    /// Adds `coefficient·λ_row`, computed from terms of this size.
    pub(crate) fn add_term(&mut self, row: usize, coefficient: f64, size: f64) {
        self.coefficients[row] += coefficient;
        self.sizes[row] += size;
    }

    /// Returns ℓ, one coefficient for each row.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Returns `ℓᵀ·λ`.
    ///
    /// # Panics
    /// Panics if the number of multipliers differs from the number of rows.
    #[must_use]
    pub fn value(&self, lambda: &[f64]) -> f64 {
        let rows = self.coefficients.len();
        assert!(
            lambda.len() == rows,
            "{} multipliers, {rows} rows",
            lambda.len()
        );
        self.coefficients
            .iter()
            .zip(lambda)
            .map(|(l, x)| l * x)
            .sum()
    }

    /// Returns the values of the form along the columns of a null space.
    pub(crate) fn along_null_space(&self, solvability: &Solvability) -> Vec<f64> {
        solvability.along_null_space(&self.coefficients)
    }

    /// Returns the sum of the sizes of the terms, for multipliers of these sizes.
    pub(crate) fn size(&self, of_row: impl Fn(usize) -> f64) -> f64 {
        let sizes = self.sizes.iter().enumerate();
        sizes.map(|(i, size)| size * of_row(i)).sum()
    }

    /// Returns the verdict on the number. The number is unique iff `ℓᵀ·Z = 0`. The margin is
    /// relative to the size of the terms. Both values are computed for equilibrated rows.
    ///
    /// # Errors
    /// [`RequestError::Length`]: the matrix has another number of rows.
    pub fn judge(&self, solvability: &Solvability) -> Result<Judgement, RequestError> {
        let (found, m) = (self.sizes.len(), solvability.null_space().nrows());
        if found != m {
            return Err(RequestError::Length {
                argument: "linear form",
                found,
                expected: m,
            });
        }
        let all: Vec<usize> = (0..m).collect();
        Ok(solvability.component(&self.map_of(&all), 0, all)?)
    }

    /// Returns the part of the form that belongs to these rows, as the first row of a map. The
    /// second row contains the sizes, because a component is compared with the largest row of its
    /// map.
    pub(crate) fn map_of(&self, rows: &[usize]) -> Matrix {
        let largest = match self.sizes.iter().fold(0.0, |a: f64, &b| a.max(b)) {
            0.0 => 1.0,
            largest => largest,
        };
        let both = [&self.coefficients, &self.sizes];
        Matrix::from_fn(both.len(), rows.len(), |k, i| both[k][rows[i]] / largest)
    }

    /// Returns whether a term belongs to this row.
    pub(crate) fn has_term(&self, row: usize) -> bool {
        self.sizes[row] != 0.0
    }

    /// Returns `ℓᵀ·Ẑ / ‖sizes‖` for an orthonormal basis Ẑ of the left null space of the
    /// equilibrated matrix. The result is the margin as a vector. The second value is the divisor,
    /// which is 1 for a form without terms.
    pub(crate) fn image(&self, free: &FreeMultipliers<'_>) -> (Vec<f64>, f64) {
        let scaled = |x: &[f64]| -> Vec<f64> {
            let pairs = x.iter().zip(free.row_factor.iter());
            pairs.map(|(x, factor)| x * factor).collect()
        };
        let size = match scaled(&self.sizes)
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
        {
            0.0 => 1.0,
            size => size,
        };
        let image = free.z.transpose_times(&scaled(&self.coefficients));
        (image.iter().map(|x| x / size).collect(), size)
    }
}
