//! Constrained equations of motion with many independent rows, solved through the Schur complement
//! of the masses:
//!
//! ```text
//! | M  Cᵀ | | a |   | f |        S·λ = C·M⁻¹·f − γ,   a = M⁻¹·(f − Cᵀ·λ)
//! | C  0  | | λ | = | γ |        S = C·M⁻¹·Cᵀ,        M = diag(m) > 0 (n), C of full row rank (r×n), sparse
//! ```
//!
//! S is symmetric and positive definite, so no pivot has to be searched for: the order of
//! elimination, and with it the place of every entry of L, is chosen once from the bodies alone.
//! Each evaluation is then arithmetic on small dense fronts. The work grows with the square of the
//! width of the graph of bodies: linearly for chains and ladders, as n^1.5 for lattices.
//!
//! The disadvantages: S has the square of the condition number of C, and masses must not vanish. So
//! every solution is checked with the rows, and residuals are corrected with the same factors; rows
//! that are dependent for an instant are skipped. For small systems, zero masses and masses of many
//! powers of ten use [`KeptRowSaddle`](crate::KeptRowSaddle).
//!
//! Sources: range space method, M. Benzi, G. H. Golub, J. Liesen, Numerical solution of saddle
//! point problems, Acta Numerica 14 (2005) 1–137, section 5; multifrontal elimination, I. S. Duff,
//! J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM
//! Trans. Math. Softw. 9 (1983) 302–325.

mod factor;
mod front;
mod solve;
mod structure;
#[cfg(test)]
mod tests;

pub use structure::SchurStructure;

/// Solver of the saddle equations for n coordinates and r independent, sparse constraint rows. All
/// storage is allocated in [`SchurSaddle::new`]; factorisations and solutions do not allocate
/// unless they fail.
///
/// ```
/// use linalg::{SchurSaddle, SchurStructure, SparseMatrix};
/// // Unit mass on the line x = y, pushed along x: a = (½, ½), λ = ½ for the row (1, −1).
/// let c = SparseMatrix::from_rows(2, [[(0, 1.0), (1, -1.0)]])?;
/// let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &[0..2]));
/// saddle.factor(&c, &[1.0, 1.0])?;
/// let (mut a, mut lambda) = ([0.0; 2], [0.0; 1]);
/// saddle.solve(&c, &[1.0, 0.0], &[0.0], &mut a, &mut lambda)?;
/// assert_eq!((a, lambda), ([0.5, 0.5], [0.5]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SchurSaddle {
    structure: SchurStructure,
    factors: Factors,
    is_factored: bool,
    assembly: Assembly,
    work: Work,
}

/// Factors `S = L·D·Lᵀ`, and the data from which they were computed.
#[derive(Clone, Debug)]
struct Factors {
    /// Columns of L of each front, one after the other, below their unit diagonals.
    l: Vec<f64>,
    /// 1/D of each row in the order of elimination, 0 for a skipped row.
    inverse: Vec<f64>,
    /// S_kk of each row in the order of elimination.
    diagonal: Vec<f64>,
    /// What is left of each row usually, in units of the smallest; 1 if that is not known.
    usual: Vec<f64>,
    /// What the pivots are compared with: diagonal · usual.
    compared: Vec<f64>,
    /// Inverse masses 1/m, n.
    inverse_mass: Vec<f64>,
    pivot_ratio: f64,
    n_left_out: usize,
}

/// Scratch of a factorisation.
#[derive(Clone, Debug)]
struct Assembly {
    /// The present front.
    front: Vec<f64>,
    /// Updates that have not been added to their parents, the last one on top.
    waiting: Vec<f64>,
    /// C of one block, scaled by the square roots of the inverse masses.
    element: Vec<f64>,
}

/// Scratch of a solution.
#[derive(Clone, Debug)]
struct Work {
    /// A right-hand side and its solution in the order of elimination, r.
    x: Vec<f64>,
    /// Entries of one front.
    local: Vec<f64>,
    /// `M⁻¹·f`, the larger of it and a, and the sizes of all terms added to a, n each.
    free: Vec<f64>,
    terms: Vec<f64>,
    all: Vec<f64>,
}

impl SchurSaddle {
    /// Allocates storage for this structure.
    #[must_use]
    pub fn new(structure: SchurStructure) -> Self {
        let (n, r) = (structure.n_coordinates(), structure.n_rows());
        let size = &structure.size;
        Self {
            factors: Factors {
                l: vec![0.0; size.entries],
                inverse: vec![0.0; r],
                diagonal: vec![0.0; r],
                usual: vec![1.0; r],
                compared: vec![0.0; r],
                inverse_mass: vec![0.0; n],
                pivot_ratio: f64::INFINITY,
                n_left_out: 0,
            },
            is_factored: false,
            assembly: Assembly {
                front: vec![0.0; size.front * size.front],
                waiting: Vec::with_capacity(size.waiting),
                element: vec![0.0; size.element],
            },
            work: Work {
                x: vec![0.0; r],
                local: vec![0.0; size.front],
                free: vec![0.0; n],
                terms: vec![0.0; n],
                all: vec![0.0; n],
            },
            structure,
        }
    }

    /// The structure of the matrix and its factors.
    #[must_use]
    pub fn structure(&self) -> &SchurStructure {
        &self.structure
    }

    /// Smallest fraction of a row, in the metric of the inverse masses, that the rows eliminated
    /// before it do not imply: small near singular configurations, infinite without rows.
    #[must_use]
    pub fn pivot_ratio(&self) -> f64 {
        self.factors.pivot_ratio
    }

    /// Number of rows skipped by the last factorisation.
    #[must_use]
    pub fn n_left_out(&self) -> usize {
        self.factors.n_left_out
    }

    /// Whether the last factorisation uses row k.
    #[must_use]
    pub fn uses(&self, k: usize) -> bool {
        self.factors.inverse[self.structure.rows.place[k]] != 0.0
    }
}
