//! Constrained equations of motion with many independent rows, solved through the Schur complement
//! of the masses:
//!
//! ```text
//! | M  Cᵀ | | a |   | f |        S·λ = C·M⁻¹·f − γ,   a = M⁻¹·(f − Cᵀ·λ)
//! | C  0  | | λ | = | γ |        S = C·M⁻¹·Cᵀ,        M = diag(m) > 0 (n), C of full row rank (r×n), sparse
//! ```
//!
//! S is symmetric and positive definite, so a pivot search is not needed. The order of elimination,
//! and therefore the position of every entry of L, is chosen once from the bodies alone. Each
//! evaluation then performs arithmetic on small dense fronts. The work grows with the square of the
//! width of the graph of bodies. The work grows linearly for chains and ladders, and as n^1.5 for
//! lattices.
//!
//! The method has two disadvantages. S has the square of the condition number of C, and masses must
//! not be zero. Therefore the residuals of the rows are computed for every solution and corrected
//! with the same factors. Rows that are dependent for an instant are skipped. For small systems,
//! zero masses, and masses that differ by many powers of ten, use
//! [`KeptRowSaddle`](crate::KeptRowSaddle).
//!
//! Sources: range space method, M. Benzi, G. H. Golub, J. Liesen, Numerical solution of saddle
//! point problems, Acta Numerica 14 (2005) 1–137, section 5; multifrontal elimination, I. S. Duff,
//! J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM
//! Trans. Math. Softw. 9 (1983) 302–325.

mod added;
mod factor;
mod front;
mod solve;
mod structure;
#[cfg(test)]
mod tests;
mod tiles;

use added::ExtendedSystem;
pub use structure::SchurStructure;
use tiles::{Lane, SIDE, Tile, triangle};

/// Solver of the saddle equations for n coordinates and r independent, sparse constraint rows. All
/// storage is allocated in [`SchurSaddle::new`]. Factorisations and solutions do not allocate
/// memory unless they fail.
///
/// ```
/// use pfaff_linalg::{SchurSaddle, SchurStructure, SparseMatrix};
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
    factors: LdlFactors,
    is_factored: bool,
    assembly: Assembly,
    work: SolutionScratch,
    /// The equations that are solved if the mass matrix has rows.
    extended: Option<Box<ExtendedSystem>>,
}

/// Factors `S = L·D·Lᵀ`, and the data from which they were computed.
#[derive(Clone, Debug)]
struct LdlFactors {
    /// Columns of L of each front, one after the other, with zeros in place of unit diagonals.
    l: Vec<Tile>,
    /// 1/D at each position in the order of elimination; 0 for a skipped row and for padding.
    inverse: Vec<Lane>,
    /// S_kk at each position, and one group for padding.
    diagonal: Vec<Lane>,
    /// Usual independent share of each row, in units of the smallest usual share; 1 if the share is
    /// not known.
    usual: Vec<Lane>,
    /// Reference values for the pivots: the product of `diagonal` and `usual`.
    compared: Vec<Lane>,
    /// Masses m (NaN if the masses are not known) and their inverses, n values each.
    mass: Vec<f64>,
    inverse_mass: Vec<f64>,
    pivot_ratio: f64,
    n_left_out: usize,
}

/// C by elements, and buffers of a factorisation.
#[derive(Clone, Debug)]
struct Assembly {
    /// Values of C, element by element. Places without an entry of C stay zero.
    values: Vec<Lane>,
    /// The front that is being assembled and eliminated.
    front: Vec<Tile>,
    /// Updates that have not yet been added to the parents of their fronts, the last update on top.
    waiting: Vec<Tile>,
}

/// Buffers of a solution.
#[derive(Clone, Debug)]
struct SolutionScratch {
    /// Lists in the order of elimination: a right-hand side and its solution, the sizes of the
    /// terms of each row, and the sizes of all contributions to its multiplier. Each list ends with
    /// a group of four for padding.
    x: Vec<Lane>,
    size: Vec<Lane>,
    added: Vec<Lane>,
    /// Groups of four values of one front or element, and the sizes of these values.
    local: Vec<[Lane; 2]>,
    /// `M⁻¹·f`, and the sizes of the terms of a, n values each.
    free: Vec<f64>,
    terms: Vec<f64>,
}

impl SchurSaddle {
    /// Allocates storage for this structure.
    #[must_use]
    pub fn new(structure: SchurStructure) -> Self {
        let (n, lanes) = (structure.n_coordinates(), structure.rows.lanes);
        let size = &structure.size;
        let zeros = [0.0; SIDE];
        let tile = [zeros; SIDE];
        let mut usual = vec![[1.0; SIDE]; lanes];
        // The rows of the mass matrix are always independent, so their pivots are not compared.
        for &place in &structure.rows.place[structure.rows_of_c..] {
            usual.as_flattened_mut()[place] = 0.0;
        }
        let extended = structure.extended.as_deref();
        Self {
            extended: extended.map(|c| Box::new(ExtendedSystem::new(c.clone()))),
            factors: LdlFactors {
                l: vec![tile; size.tiles],
                inverse: vec![zeros; lanes],
                diagonal: vec![zeros; lanes + 1],
                usual,
                compared: vec![zeros; lanes],
                mass: vec![f64::NAN; n],
                inverse_mass: vec![0.0; n],
                pivot_ratio: f64::INFINITY,
                n_left_out: 0,
            },
            is_factored: false,
            assembly: Assembly {
                values: vec![zeros; structure.elements.n_lanes],
                front: vec![tile; triangle(size.front)],
                waiting: Vec::with_capacity(size.waiting),
            },
            work: SolutionScratch {
                x: vec![zeros; lanes + 1],
                size: vec![zeros; lanes + 1],
                added: vec![zeros; lanes + 1],
                local: vec![[zeros; 2]; size.front],
                free: vec![0.0; n],
                terms: vec![0.0; n],
            },
            structure,
        }
    }

    /// Returns the structure of the matrix and its factors.
    #[must_use]
    pub fn structure(&self) -> &SchurStructure {
        &self.structure
    }

    /// Returns the smallest fraction of a row that is independent of the rows eliminated before it,
    /// in the metric of the inverse masses. The fraction is small near singular configurations, and
    /// infinite without rows.
    #[must_use]
    pub fn pivot_ratio(&self) -> f64 {
        self.factors.pivot_ratio
    }

    /// Returns the number of rows skipped by the last factorisation.
    #[must_use]
    pub fn n_left_out(&self) -> usize {
        self.factors.n_left_out
    }

    /// Returns whether the last factorisation uses row k.
    #[must_use]
    pub fn uses(&self, k: usize) -> bool {
        self.factors.inverse.as_flattened()[self.structure.rows.place[k]] != 0.0
    }
}
