//! Constrained equations of motion with independent rows, solved without forming the saddle matrix:
//!
//! ```text
//! | M  Cᵀ | | a |   | f |
//! | C  0  | | λ | = | γ |     M = diag(m) ≥ 0 (n), C of full row rank (r×n)
//! ```
//!
//! LU with partial pivoting of the tall Cᵀ gives a null space basis N of C, the reduced mass
//! `Nᵀ·M·N` (order k = n − r) is factored by Cholesky
//! (as L·D·Lᵀ), and λ comes back through the same LU. M is
//! never inverted, so masses may be zero as long as M is positive definite on ker C.
//!
//! This runs for every evaluation of a right-hand side: all storage is allocated in
//! [`KeptRowSaddle::new`], `factor` and `solve` allocate nothing. Not for redundant rows: choose
//! the kept ones with `decide` first (crate `rank`); no rank is decided here.
//!
//! Masses that differ by many powers of ten are graded: then, of the entries that are not much
//! smaller than the largest, the pivot is that of the lightest coordinate. So the heavy coordinates
//! are free, `Nᵀ·M·N` is their masses and little more, and λ comes from the equations of light
//! bodies, where no large inertia cancels. What is left is rounding, which
//! [`KeptRowSaddle::solve_refined`] removes.
//!
//! The algebra, with `P·Cᵀ = L·U`, `L = [L₁; L₂]` unit lower trapezoidal and y = P·a:
//! `C·a = γ ⇔ Lᵀ·y = U⁻ᵀ·γ`, `N = Pᵀ·[−L₁⁻ᵀ·L₂ᵀ; I]`, `(NᵀMN)·z = Nᵀ·(f − M·a_p)`,
//! `L·U·λ = P·(f − M·a)`. Source: null space method, M. Benzi, G. H. Golub, J. Liesen, Numerical
//! solution of saddle point problems, Acta Numerica 14 (2005) 1–137, section 6.

mod factor;
mod fill;
mod free;
mod lu;
mod order;
mod orientation;
mod partition;
mod refine;
mod solve;
#[cfg(test)]
mod tests;

use crate::Lu;
use crate::kernels::all_finite;
use crate::limits::{CANCELLED, GRADED_MASSES};
use free::FreeMotions;
use lu::TallLu;
use order::Order;

pub use refine::Refinement;

/// Solver of the saddle equations of n coordinates and r independent constraint rows.
///
/// ```
/// use linalg::KeptRowSaddle;
/// // Unit mass on the line x = y, pushed along x: a = (½, ½), λ = ½ on the row (1, −1).
/// let c = [1.0, -1.0];
/// let mut saddle = KeptRowSaddle::new(2, 1)?;
/// saddle.factor(|_| &c, &[1.0, 1.0])?;
/// let (mut a, mut lambda) = ([0.0; 2], [0.0; 1]);
/// saddle.solve(&[1.0, 0.0], &[0.0], &mut a, &mut lambda)?;
/// assert_eq!((a, lambda), ([0.5, 0.5], [0.5]));
/// # Ok::<(), linalg::SaddleError>(())
/// ```
#[derive(Debug, Clone)]
pub struct KeptRowSaddle {
    rows: usize,
    /// How a factorisation begins.
    order: Order,
    lu: TallLu,
    free: FreeMotions,
    mass_spread: f64,
    is_graded: bool,
    is_factored: bool,
    /// Scratch of `bordered`: Nᵀ·B, k×k.
    border: Lu,
    /// Scratch of `solve`: P·a and P·(f − M·a), both n.
    y: Vec<f64>,
    g: Vec<f64>,
}

/// Why the saddle equations have no (unique) solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SaddleError {
    /// More rows than coordinates cannot be independent.
    #[error("{r} independent rows in {n} coordinates are impossible: keep at most {n}")]
    TooManyRows {
        /// Coordinates.
        n: usize,
        /// Rows.
        r: usize,
    },
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, need {expected}")]
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// A column that there is not.
    #[error("row {row} has an entry in column {column}, need columns below {n}")]
    Column {
        /// Number of the row.
        row: usize,
        /// The column.
        column: usize,
        /// Coordinates.
        n: usize,
    },
    /// Coordinates that cannot be solved for.
    #[error("coordinate {coordinate} cannot be solved for: need different coordinates below {n}")]
    Partition {
        /// The coordinate.
        coordinate: usize,
        /// Coordinates.
        n: usize,
    },
    /// A NaN or infinite entry.
    #[error("{argument} contains the value {value} at {index}, need finite numbers")]
    NonFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Entry; for the rows of C the index in row-major order.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A negative mass.
    #[error("mass {index} is {value:.3e}, need a number that is not negative")]
    NegativeMass {
        /// Coordinate.
        index: usize,
        /// Its mass.
        value: f64,
    },
    /// A coordinate without mass, where every one needs some.
    #[error(
        "mass {index} is {value:.3e}: the solver of large mechanisms needs mass and inertia for every coordinate; give it some"
    )]
    ZeroMass {
        /// Coordinate.
        index: usize,
        /// Its mass.
        value: f64,
    },
    /// What only the dense solver can do.
    #[error(
        "{rows} rows are solved sparsely, without independent coordinates: take an explicit method on kept rows, with projection"
    )]
    Large {
        /// Rows.
        rows: usize,
    },
    /// A kept row depends on the rows before it.
    #[error(
        "kept row {row} depends on the rows before it: pivot {pivot:.3e} in a row of size \
         {scale:.3e}; the configuration is singular or the kept rows were chosen elsewhere"
    )]
    RankLost {
        /// Number of the kept row.
        row: usize,
        /// Largest entry left of it.
        pivot: f64,
        /// Largest entry of it before elimination.
        scale: f64,
    },
    /// A motion that the constraints allow moves no mass.
    #[error(
        "the mass is not positive definite on the allowed motions: reduced mass {reduced:.3e} of \
         {size:.3e}; give mass or inertia to what moves along the massless motion {motion:?}"
    )]
    MasslessMotion {
        /// What is left of the reduced mass.
        reduced: f64,
        /// The size that it must be compared with.
        size: f64,
        /// The motion, largest entry 1.
        motion: Vec<f64>,
    },
    /// Refinement does not converge: the equations are singular to working precision.
    #[error(
        "refinement of the solution does not converge: after {rounds} rounds it still changes by the share {change:.3e}; \
         the equations are singular to working precision"
    )]
    Unrefined {
        /// Rounds made.
        rounds: usize,
        /// Largest change of the last one, relative to the size of what changed.
        change: f64,
    },
    /// `solve` without a successful `factor`.
    #[error("nothing is factored: call `factor` and handle its error before `solve`")]
    NotFactored,
}

impl KeptRowSaddle {
    /// Storage for n coordinates and r rows.
    ///
    /// # Errors
    /// [`SaddleError::TooManyRows`] if r > n.
    pub fn new(n: usize, r: usize) -> Result<Self, SaddleError> {
        if r > n {
            return Err(SaddleError::TooManyRows { n, r });
        }
        Self::with_columns(n, &vec![Vec::from_iter(0..n); r])
    }

    /// Storage for n coordinates and rows of which each is zero outside its columns: entries there
    /// are not looked at. The same solutions as with [`KeptRowSaddle::new`], bit for bit, for less
    /// work where rows have few entries.
    ///
    /// ```
    /// use linalg::KeptRowSaddle;
    /// let mut saddle = KeptRowSaddle::with_columns(3, &[vec![0, 1], vec![2]])?;
    /// let rows = [[1.0, -1.0, 0.0], [0.0, 0.0, 5.0]];
    /// saddle.factor(|k| &rows[k], &[1.0; 3])?;
    /// let (mut a, mut lambda) = ([0.0; 3], [0.0; 2]);
    /// saddle.solve(&[1.0, 0.0, 7.0], &[0.0, 10.0], &mut a, &mut lambda)?;
    /// assert_eq!((a, lambda), ([0.5, 0.5, 2.0], [0.5, 1.0]));
    /// # Ok::<(), linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// [`SaddleError::TooManyRows`] if r > n, [`SaddleError::Column`] for a column that is not
    /// below n.
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
            rows: r,
            order: Order::new(n, columns),
            lu: TallLu::new(n, r),
            free: FreeMotions::new(n, r),
            mass_spread: 1.0,
            is_graded: false,
            is_factored: false,
            border: Lu::new(n),
            y: vec![0.0; n],
            g: vec![0.0; n],
        })
    }

    /// Number of coordinates n.
    pub fn n_coordinates(&self) -> usize {
        self.lu.n
    }

    /// Number of constraint rows r.
    pub fn n_rows(&self) -> usize {
        self.rows
    }

    /// Number of rows that the last factorisation left out, see [`KeptRowSaddle::factor_above`].
    pub fn n_left_out(&self) -> usize {
        self.rows - self.lu.r
    }

    /// Whether the last factorisation uses row `k`.
    pub fn uses(&self, k: usize) -> bool {
        self.lu.used().binary_search(&k).is_ok()
    }

    /// Whether the masses of the last factorisation are graded, so that light coordinates are
    /// solved for: [`mass_spread`] from [`GRADED_MASSES`] on, and from a thousandth of it on beside
    /// masses that are zero.
    pub fn is_graded(&self) -> bool {
        self.is_graded
    }

    /// Whether a plain solution of the last factorisation may miss digits that
    /// [`KeptRowSaddle::solve_refined`] has: [`mass_spread`] from [`GRADED_MASSES`] on, or
    /// elimination has left less than 1e-3 of a reduced mass.
    pub fn wants_refinement(&self) -> bool {
        self.mass_spread >= GRADED_MASSES || self.free.mass_ratio < CANCELLED
    }

    /// Smallest `|pivot| / largest entry of its row` of the last factorisation, rows left out
    /// included, infinite for r = 0: the monitor for near-singular configurations. It changes
    /// smoothly along a motion except where the pivot order changes, and falls towards zero as the
    /// kept rows become dependent.
    pub fn pivot_ratio(&self) -> f64 {
        self.lu.pivot_ratio
    }
}

/// The heaviest mass divided by the lightest that is not zero; 1 where none is positive.
///
/// Moments of inertia count as they are, in kg·m²: lengths far from a metre show in it as well.
///
/// ```
/// assert_eq!(linalg::mass_spread(&[8.0, 0.0, 2.0]), 4.0);
/// ```
pub fn mass_spread(mass: &[f64]) -> f64 {
    let (mut lightest, mut heaviest) = (f64::INFINITY, 0.0);
    for &m in mass {
        lightest = if m > 0.0 && m < lightest { m } else { lightest };
        heaviest = if m > heaviest { m } else { heaviest };
    }
    match heaviest > 0.0 {
        true => heaviest / lightest,
        false => 1.0,
    }
}

pub(crate) fn check_length<T>(
    argument: &'static str,
    x: &[T],
    expected: usize,
) -> Result<(), SaddleError> {
    if x.len() == expected {
        Ok(())
    } else {
        Err(SaddleError::Length {
            argument,
            found: x.len(),
            expected,
        })
    }
}

/// `first` is the index of `x[0]` in the argument.
pub(crate) fn check_finite(
    argument: &'static str,
    x: &[f64],
    first: usize,
) -> Result<(), SaddleError> {
    if all_finite(x) {
        return Ok(());
    }
    match x.iter().position(|a| !a.is_finite()) {
        Some(i) => Err(SaddleError::NonFinite {
            argument,
            index: first + i,
            value: x[i],
        }),
        None => Ok(()),
    }
}
