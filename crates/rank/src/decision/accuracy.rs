//! The accuracy of the entries of a matrix, and the equilibration that uses it.

use super::outcome::RankError;
use crate::limits::SIGNIFICANT;
use linalg::{Matrix, Scaling, equilibrate};

/// Accuracy of the entries of a matrix.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{Accuracy, decide};
/// // Two rows that differ in the last bit.
/// let c = Matrix::from_rows(&[[1.0, 1.0], [1.0, 1.0 + f64::EPSILON]]);
/// assert_eq!(decide(&c, Accuracy::Rounding)?.rank, 1);
/// assert_eq!(decide(&c, Accuracy::Exact)?.rank, 2);
/// // Two directions that are parallel except for the rounding of their cosine.
/// let c = Matrix::from_rows(&[[6e-17, 1.0], [-1e-17, 1.0]]);
/// assert_eq!(decide(&c, Accuracy::Rounding)?.rank, 2); // small entries are significant
/// assert_eq!(decide(&c, &Matrix::from_rows(&[[2e-16; 2]; 2]))?.rank, 1);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Accuracy<'a> {
    /// The entries are accurate to their last digits. Each entry is as significant as any other,
    /// and computations with the entries have rounding errors.
    Rounding,
    /// The entries are exact rational numbers, and no rounding occurs. The rank is the rank of
    /// [`certify_exact`](crate::certify_exact). If the rank or the rows are given, this variant is
    /// equivalent to [`Accuracy::Rounding`].
    Exact,
    /// An absolute uncertainty that is the same for all entries of the equilibrated matrix.
    Absolute(f64),
    /// An absolute uncertainty for each entry, in the units of the matrix. Entries below their
    /// uncertainty do not affect the scale of a row or column.
    Entries(&'a Matrix),
}

impl<'a> From<&'a Matrix> for Accuracy<'a> {
    fn from(uncertainty: &'a Matrix) -> Self {
        Self::Entries(uncertainty)
    }
}

/// Bounds on the distance between an equilibrated matrix and the intended matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spread {
    /// Largest uncertainty of one entry.
    pub(crate) largest: f64,
    /// Frobenius norm of the uncertainty. No singular value has a larger error.
    pub(crate) norm: f64,
}

impl Accuracy<'_> {
    /// Returns the equilibration of the significant entries of `c`. Entries that are only rounding
    /// are not scaled up to norm one.
    ///
    /// # Errors
    /// Returns an error if the shape of the uncertainty is not the shape of `c`, or if the
    /// uncertainty is negative or not finite.
    pub fn equilibration(self, c: &Matrix) -> Result<Scaling, RankError> {
        let Self::Entries(u) = self else {
            return Ok(equilibrate(c));
        };
        self.check(c)?;
        let mut significant = c.clone();
        let entries = significant.as_mut_slice().iter_mut();
        for (c, u) in entries.zip(u.as_slice()) {
            *c = if c.abs() > SIGNIFICANT * u { *c } else { 0.0 };
        }
        Ok(equilibrate(&significant))
    }

    /// Returns [`Self::equilibration`], and the uncertainty of the equilibrated matrix.
    pub(crate) fn equilibrate(self, c: &Matrix) -> Result<(Scaling, Spread), RankError> {
        let scaling = self.equilibration(c)?;
        let spread = self.equilibrated(c, &scaling)?;
        Ok((scaling, spread))
    }

    /// Returns the uncertainty of `c` in a given equilibration.
    pub(crate) fn equilibrated(self, c: &Matrix, scaling: &Scaling) -> Result<Spread, RankError> {
        let spread = match self {
            Self::Rounding | Self::Exact => Spread {
                largest: 0.0,
                norm: 0.0,
            },
            Self::Absolute(largest) => Spread {
                largest,
                norm: largest * (c.nrows() as f64 * c.ncols() as f64).sqrt(),
            },
            Self::Entries(u) => {
                self.check(c)?;
                let u = scaling.apply(u);
                Spread {
                    largest: u.max_abs(),
                    norm: u.frobenius_norm(),
                }
            }
        };
        if spread.norm.is_finite() && spread.largest >= 0.0 {
            Ok(spread)
        } else {
            Err(RankError::Uncertainty {
                value: spread.largest,
            })
        }
    }

    /// Returns the uncertainty of each entry in an equilibration computed by [`Self::equilibrate`].
    pub(crate) fn of_entries(self, scaling: &Scaling) -> Matrix {
        let all =
            |value: f64| Matrix::from_fn(scaling.rows.len(), scaling.cols.len(), |_, _| value);
        match self {
            Self::Rounding | Self::Exact => all(0.0),
            Self::Absolute(value) => all(value),
            Self::Entries(u) => scaling.apply(u),
        }
    }

    fn check(self, c: &Matrix) -> Result<(), RankError> {
        let Self::Entries(u) = self else {
            return Ok(());
        };
        if (u.nrows(), u.ncols()) != (c.nrows(), c.ncols()) {
            return Err(RankError::UncertaintyShape {
                rows: u.nrows(),
                cols: u.ncols(),
                expected_rows: c.nrows(),
                expected_cols: c.ncols(),
            });
        }
        match u.as_slice().iter().find(|u| !(u.is_finite() && **u >= 0.0)) {
            Some(&value) => Err(RankError::Uncertainty { value }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries that consist of several rounding errors of larger terms are not scaled up to norm
    /// one.
    #[test]
    fn an_entry_near_its_uncertainty_does_not_set_the_scale() {
        let known = Matrix::from_rows(&[[0.0, 0.0], [0.0, 1e-12]]);
        for (entry, is_scaled) in [(0.8e-7, false), (1.2e-7, true)] {
            let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, entry]]);
            let (scaling, _) = Accuracy::Entries(&known).equilibrate(&c).unwrap();
            assert_eq!(scaling.apply(&c)[(1, 1)] >= 0.5, is_scaled, "{entry}");
        }
    }
}
