//! Constrained equations of motion with independent rows, solved without forming the saddle matrix:
//!
//! ```text
//! | M  Cᵀ | | a |   | f |
//! | C  0  | | λ | = | γ |     M = diag(m) ≥ 0 (n), C of full row rank (r×n)
//! ```
//!
//! M may also have a few rows, `M = diag(m) + Gᵀ·A·G` ([`MassMatrix`]). The reduced mass then
//! contains `(G·N)ᵀ·A·(G·N)`.
//!
//! Sparse LU of the tall Cᵀ gives a null space basis N of C. The pivots are large entries of a row
//! that cause little work for the other rows. The reduced mass `Nᵀ·M·N` (order k = n − r) is
//! factored by Cholesky (as L·D·Lᵀ), and λ is computed with the same LU. M is never inverted, so
//! masses may be zero as long as M is positive definite on ker C. Work and storage grow with the
//! entries of C and of its factors, times k.
//!
//! The solver runs for every evaluation of a right-hand side. The first factorisation plans the
//! order of elimination. After that, `factor` and `solve` do not allocate memory once storage for
//! the entries of the factors exists. The rows must be independent: choose the kept rows with
//! `decide` first (crate `rank`). This module does not decide ranks.
//!
//! Masses that differ by many powers of ten are called graded. For graded masses, the pivot is the
//! entry of the lightest coordinate among the entries that are not much smaller than the largest.
//! Therefore the heavy coordinates are free, `Nᵀ·M·N` contains mainly their masses, and λ is
//! computed from the equations of light bodies, in which no large inertia forces cancel.
//! [`KeptRowSaddle::solve_refined`] removes the remaining rounding.
//!
//! The algebra uses `P·Cᵀ = L·U`, a unit lower trapezoidal `L = [L₁; L₂]`, and y = P·a: `C·a = γ ⇔
//! Lᵀ·y = U⁻ᵀ·γ`, `N = Pᵀ·[−L₁⁻ᵀ·L₂ᵀ; I]`, `(NᵀMN)·z = Nᵀ·(f − M·a_p)`, `L·U·λ = P·(f − M·a)`.
//! Source: null space method, M. Benzi, G. H. Golub, J. Liesen, Numerical solution of saddle point
//! problems, Acta Numerica 14 (2005) 1–137, section 6.

mod bound;
mod error;
mod factor;
mod free;
mod lists;
mod lu;
mod order;
mod orientation;
mod partition;
mod plan;
mod refine;
mod solve;
#[cfg(test)]
mod tests;

use crate::limits::{CANCELLED, GRADED_MASSES, VECTORS};
use crate::{Lu, MassMatrix, SparseMatrix};
use free::FreeMotions;
use lists::Entry;
use lu::TallLu;
use order::Order;

pub use error::SaddleError;
pub use refine::Refinement;

/// Solver of the saddle equations for n coordinates and r independent constraint rows.
///
/// ```
/// use pfaff_linalg::KeptRowSaddle;
/// // Unit mass on the line x = y, pushed along x: a = (½, ½), λ = ½ for the row (1, −1).
/// let c = [1.0, -1.0];
/// let mut saddle = KeptRowSaddle::new(2, 1)?;
/// saddle.factor(|_| &c, &[1.0, 1.0])?;
/// let (mut a, mut lambda) = ([0.0; 2], [0.0; 1]);
/// saddle.solve(&[1.0, 0.0], &[0.0], &mut a, &mut lambda)?;
/// assert_eq!((a, lambda), ([0.5, 0.5], [0.5]));
/// # Ok::<(), pfaff_linalg::SaddleError>(())
/// ```
#[derive(Debug, Clone)]
pub struct KeptRowSaddle {
    lu: TallLu,
    free: FreeMotions,
    /// The spread of the masses if the caller has passed it.
    known_spread: Option<f64>,
    mass_spread: f64,
    is_graded: bool,
    is_factored: bool,
    /// Buffer of `bordered`: Nᵀ·B, k×k, and its factors.
    product: Vec<f64>,
    border: Lu,
    /// Buffer of `solve`: f − M·a, n values.
    g: Vec<f64>,
}

impl KeptRowSaddle {
    /// Allocates storage for n coordinates and r rows.
    ///
    /// # Errors
    /// Returns [`SaddleError::TooManyRows`] if r > n.
    pub fn new(n: usize, r: usize) -> Result<Self, SaddleError> {
        if r > n {
            return Err(SaddleError::TooManyRows { n, r });
        }
        Self::with_columns(n, &vec![Vec::from_iter(0..n); r])
    }

    /// Allocates storage for n coordinates and for rows that have entries only in these columns.
    /// Each column is listed once for a row. The values of a row are listed in the order of its
    /// columns.
    ///
    /// ```
    /// use pfaff_linalg::KeptRowSaddle;
    /// let mut saddle = KeptRowSaddle::with_columns(3, &[vec![0, 1], vec![2]])?;
    /// let rows: [&[f64]; 2] = [&[1.0, -1.0], &[5.0]];
    /// saddle.factor(|k| rows[k], &[1.0; 3])?;
    /// let (mut a, mut lambda) = ([0.0; 3], [0.0; 2]);
    /// saddle.solve(&[1.0, 0.0, 7.0], &[0.0, 10.0], &mut a, &mut lambda)?;
    /// assert_eq!((a, lambda), ([0.5, 0.5, 2.0], [0.5, 1.0]));
    /// # Ok::<(), pfaff_linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`SaddleError::TooManyRows`] if r > n, and [`SaddleError::Column`] for a column that
    /// is not below n.
    pub fn with_columns(n: usize, columns: &[Vec<usize>]) -> Result<Self, SaddleError> {
        let r = columns.len();
        if r > n {
            return Err(SaddleError::TooManyRows { n, r });
        }
        for (row, columns) in columns.iter().enumerate() {
            if let Some(&column) = columns.iter().find(|&&column| column >= n) {
                return Err(SaddleError::Column { row, column, n });
            }
        }
        Ok(Self {
            lu: TallLu::new(n, columns),
            free: FreeMotions::new(n, n - r),
            known_spread: None,
            mass_spread: 1.0,
            is_graded: false,
            is_factored: false,
            product: Vec::with_capacity((n - r).pow(2)),
            border: Lu::new(n - r),
            g: vec![0.0; n],
        })
    }

    /// Allocates storage for the entries of these rows and computes the factors of the rows, see
    /// [`Self::with_columns`] and [`Self::factor`].
    ///
    /// ```
    /// use pfaff_linalg::{KeptRowSaddle, SparseMatrix};
    /// let c = SparseMatrix::from_rows(3, [vec![(0, 1.0), (1, -1.0)], vec![(2, 5.0)]])?;
    /// let mut saddle = KeptRowSaddle::of_rows(&c, &[1.0; 3])?;
    /// let (mut a, mut lambda) = ([0.0; 3], [0.0; 2]);
    /// saddle.solve(&[1.0, 0.0, 7.0], &[0.0, 10.0], &mut a, &mut lambda)?;
    /// assert_eq!((a, lambda), ([0.5, 0.5, 2.0], [0.5, 1.0]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as these two functions.
    pub fn of_rows<'m>(
        c: &SparseMatrix,
        mass: impl Into<MassMatrix<'m>>,
    ) -> Result<Self, SaddleError> {
        let columns: Vec<Vec<usize>> = (0..c.nrows()).map(|k| c.row(k).0.to_vec()).collect();
        let mut saddle = Self::with_columns(c.ncols(), &columns)?;
        saddle.factor(|k| c.row(k).1, mass)?;
        Ok(saddle)
    }

    /// Sets the spread of the masses. The solver then does not use the spread of the given masses,
    /// which depends on units.
    #[must_use]
    pub fn graded_by(self, mass_spread: f64) -> Self {
        Self {
            known_spread: Some(mass_spread),
            ..self
        }
    }

    /// Returns an upper bound of the memory (bytes) of a solver for these rows, for any choice of
    /// pivot coordinates. The values of the rows determine their order.
    #[must_use]
    pub fn bytes(c: &SparseMatrix) -> usize {
        let k = c.ncols().saturating_sub(c.nrows());
        let entries = |k: usize| {
            let (columns, values) = c.row(k);
            let entries = columns.iter().zip(values);
            entries.map(|(&i, &c)| Entry::new(i, c)).collect()
        };
        let order = Order::new(c.ncols(), (0..c.nrows()).map(entries).collect(), None);
        let columns: Vec<&[usize]> = order.rows.iter().map(|&k| c.row(k).0).collect();
        let entries = bound::bound(c.ncols(), &columns).iter().sum::<usize>();
        let numbers = (c.ncols() + 2 * k) * (k + VECTORS);
        entries * (size_of::<f64>() + size_of::<u32>()) + numbers * size_of::<f64>()
    }

    /// Returns the number of coordinates n.
    pub fn n_coordinates(&self) -> usize {
        self.lu.n
    }

    /// Returns the number of constraint rows r.
    pub fn n_rows(&self) -> usize {
        self.lu.n_rows()
    }

    /// Returns the number of rows skipped by the last factorisation, see
    /// [`KeptRowSaddle::factor_above`].
    pub fn n_left_out(&self) -> usize {
        self.lu.n_rows() - self.lu.r
    }

    /// Returns whether the last factorisation uses row `k`.
    pub fn uses(&self, k: usize) -> bool {
        self.lu.uses(k)
    }

    /// Returns whether the masses of the last factorisation are graded, so that light coordinates
    /// become pivots. Masses are graded if [`mass_spread`] is at least [`GRADED_MASSES`], or at
    /// least a thousandth of [`GRADED_MASSES`] if some masses are zero.
    pub fn is_graded(&self) -> bool {
        self.is_graded
    }

    /// Returns whether a plain solution with the last factorisation may have fewer digits than
    /// [`KeptRowSaddle::solve_refined`]. A plain solution may have fewer digits if [`mass_spread`]
    /// is at least [`GRADED_MASSES`], or if less than 1e-3 of a reduced mass remained after
    /// elimination.
    pub fn wants_refinement(&self) -> bool {
        self.mass_spread >= GRADED_MASSES || self.free.mass_ratio < CANCELLED
    }

    /// Returns the smallest share of a row that is independent of the previous rows in the last
    /// factorisation. The share is the largest remaining entry of the row divided by its largest
    /// initial entry. Skipped rows are included, and the result is infinite for r = 0. The share
    /// indicates near-singular configurations. Along a motion the share changes smoothly, except
    /// when the pivot order changes, and approaches zero as the rows become dependent.
    pub fn pivot_ratio(&self) -> f64 {
        self.lu.pivot_ratio
    }
}

/// Returns the largest mass divided by the smallest non-zero mass, or 1 if no mass is positive.
///
/// Moments of inertia are used in kg·m², so lengths far from a metre also increase the spread.
///
/// ```
/// assert_eq!(pfaff_linalg::mass_spread(&[8.0, 0.0, 2.0]), 4.0);
/// ```
pub fn mass_spread(mass: &[f64]) -> f64 {
    let (mut lightest, mut heaviest) = (f64::INFINITY, 0.0);
    for &m in mass {
        lightest = if m > 0.0 && m < lightest { m } else { lightest };
        heaviest = if m > heaviest { m } else { heaviest };
    }
    if heaviest > 0.0 {
        heaviest / lightest
    } else {
        1.0
    }
}
