//! Constrained equations of motion with all rows, redundant ones included, by a complete orthogonal decomposition:
//!
//! ```text
//! | M  Cᵀ | | a |   | f |
//! | C  0  | | λ | = | γ |     M = diag(m) ≥ 0 (n), C of rank r (m×n)
//! ```
//!
//! a is unique where M is positive definite on ker C; of all λ the shortest one is taken. Rows that contradict each other (off the
//! constraints they do, by what the state misses) are met in the sense of least squares.
//!
//! The rank is locked: it is decided once, elsewhere, together with the equilibration `C̃ = D_r·C·D_c` (powers of two) in which lengths are
//! measured, and never decided again from an evaluated C, whose "zero" singular values are as large as the state is off the constraints. Only a
//! direction that has all but vanished, at a singular configuration, is left out of that one solve.
//!
//! The algebra, with `C̃ᵀ·P = [Q₁ Q₂]·[R₁ R₂; 0 ≈0]`, `[R₁ R₂] = [T 0]·Z`: Q₂ spans ker C̃, `C̃⁺ = Q₁·[T⁻ᵀ 0]·Z·Pᵀ`, and
//! `(Q₂ᵀ·M̃·Q₂)·w = Q₂ᵀ·(f̃ − M̃·x_p)` for what is free, as in [`KeptRowSaddle`](crate::KeptRowSaddle). Source: G. H. Golub, C. F. Van Loan, Matrix
//! Computations, section 5.4.7.

mod factor;
mod solve;
#[cfg(test)]
mod tests;

use crate::qr::Reflections;
use crate::rank::{ROUNDING, TRUNCATION};
use crate::saddle::{SaddleError, State, check_finite};
use crate::{Matrix, equilibrate};

/// Solver of the saddle equations of n coordinates and m rows of a locked rank; all storage is allocated in [`MinimumNormSaddle::new`].
///
/// ```
/// use linalg::{Matrix, MinimumNormSaddle};
/// // Unit mass on the line x = y, stated twice, pushed along x: a = (½, ½), and each row takes its half.
/// let c = Matrix::from_rows(&[[1.0, -1.0], [1.0, -1.0]]);
/// let mut saddle = MinimumNormSaddle::new(&c, 1)?;
/// saddle.factor(&c, &[1.0, 1.0])?;
/// let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
/// saddle.solve(&[1.0, 0.0], &[0.0, 0.0], &mut a, &mut lambda)?;
/// for x in a.iter().zip(&lambda).flat_map(|(a, l)| [a - 0.5, l - 0.25]) {
///     assert!(x.abs() < 1e-15);
/// }
/// # Ok::<(), linalg::SaddleError>(())
/// ```
#[derive(Debug, Clone)]
pub struct MinimumNormSaddle {
    /// Diagonals of D_r and D_c.
    row_factor: Vec<f64>,
    column_factor: Vec<f64>,
    /// Directions of C̃ shorter than this are left out.
    floor: f64,
    /// Directions of the last factorisation.
    rank: usize,
    /// Row k: column k of `[R₁ R₂]` and, for k < r, of T up to the diagonal; then the tail of the Householder vector. m×n.
    factors: Matrix,
    reflections: Reflections,
    /// Row k: the tail of the vector of the reflection k of Z, in the columns from the rank on. r×m.
    z_tail: Matrix,
    z_tau: Vec<f64>,
    /// Q₂, one basis vector of ker C̃ after the other. At most n×n.
    free: Matrix,
    /// diag(M̃) = D_c·M·D_c.
    mass: Vec<f64>,
    /// L·D·Lᵀ of `Q₂ᵀ·M̃·Q₂`, k×k.
    reduced_mass: Vec<f64>,
    state: State,
    /// Scratch of `solve`: D_c⁻¹·a and forces (n), free motion (n), right-hand side by rows (m).
    x: Vec<f64>,
    g: Vec<f64>,
    w: Vec<f64>,
    u: Vec<f64>,
}

impl MinimumNormSaddle {
    /// Storage for matrices like `reference`, where the rank has been decided: its shape, its equilibration and the length of its shortest
    /// direction are those of all later ones.
    ///
    /// # Errors
    /// - [`SaddleError::TooManyRows`]: a rank that no matrix of this shape has.
    /// - [`SaddleError::NonFinite`]: an entry of C is none.
    /// - [`SaddleError::RankLost`]: C has a smaller rank.
    pub fn new(reference: &Matrix, rank: usize) -> Result<Self, SaddleError> {
        let (m, n) = (reference.nrows(), reference.ncols());
        if rank > m.min(n) {
            return Err(SaddleError::TooManyRows {
                n: m.min(n),
                r: rank,
            });
        }
        let scaling = equilibrate::equilibrate(reference);
        let factor = |e: &i32| equilibrate::scale(1.0, *e);
        let mut saddle = Self {
            row_factor: scaling.rows.iter().map(factor).collect(),
            column_factor: scaling.cols.iter().map(factor).collect(),
            floor: 0.0,
            rank,
            factors: Matrix::zeros(m, n),
            reflections: Reflections::new(m, rank),
            z_tail: Matrix::zeros(rank, m),
            z_tau: vec![0.0; rank],
            free: Matrix::zeros(n, n),
            mass: vec![0.0; n],
            reduced_mass: vec![0.0; n * n],
            state: State::Empty,
            x: vec![0.0; n],
            g: vec![0.0; n],
            w: vec![0.0; n],
            u: vec![0.0; m],
        };
        check_finite("C", reference.as_slice(), 0)?;
        saddle.decompose(reference);
        let (shortest, longest) = (saddle.length(rank), saddle.length(1));
        if rank > 0 && shortest <= ROUNDING * longest {
            return Err(SaddleError::RankLost {
                row: saddle.reflections.permutation[saddle.rank.min(rank - 1)],
                pivot: shortest,
                scale: longest,
            });
        }
        saddle.floor = TRUNCATION * shortest;
        Ok(saddle)
    }

    /// Number of directions of the last factorisation: the locked rank, less at a singular configuration.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Length of the direction k (from 1) of the last factorisation, 0 if there are not as many.
    fn length(&self, k: usize) -> f64 {
        match k.checked_sub(1).filter(|&k| k < self.rank) {
            Some(k) => self.factors[(k, k)].abs(),
            None => 0.0,
        }
    }
}
