//! One of two solvers of kept rows: in their null space, or through the Schur complement of the
//! masses.
//!
//! The first one eliminates C itself, solves for the coordinates that its rows determine best,
//! computes the sign of a bordered determinant, supports independent coordinates, and allows zero
//! masses. Its work grows with the number of free motions times that of the entries. The second one
//! is for large mechanisms with many free motions: chains, trains of vehicles.

use linalg::{GRADED_MASSES, KeptRowSaddle, Refinement, SaddleError, SchurSaddle, SchurStructure};
use model::{Mechanism, System};

use super::matrix::{KeptMatrix, pattern_of};
use super::units::mass_spread;
use crate::limits::{FREE_MOST, NULL_SPACE_MOST, REFINED_MOST, SCHUR_FROM, VECTORS};

/// Kept rows and their factors.
#[derive(Clone)]
pub(super) struct Solver {
    rows: KeptMatrix,
    factors: Factors,
}

#[derive(Clone)]
enum Factors {
    NullSpace(Box<NullSpace>),
    Schur(Box<SchurSaddle>),
}

/// Factors of the rows, and storage for the refinement of solutions.
#[derive(Clone)]
struct NullSpace {
    saddle: KeptRowSaddle,
    refinement: Refinement,
}

/// Calls the same method of either solver.
macro_rules! each {
    ($factors:expr, $it:ident => $value:expr) => {
        match $factors {
            Factors::NullSpace(null_space) => {
                let $it = &null_space.saddle;
                $value
            }
            Factors::Schur($it) => $value,
        }
    };
}

/// Whether this number of kept rows of C of a mechanism of this size (m) is solved through the
/// Schur complement, and so are its kept rows of Φq: if there are many of them that leave many
/// motions free, every coordinate has a mass, and solutions need no refinement because of different
/// masses; or if there is too much of both for the null space.
pub(crate) fn is_schur(mechanism: &Mechanism, size: f64, rows: usize) -> bool {
    let is_graded = || mass_spread(mechanism, size) >= GRADED_MASSES;
    rows >= SCHUR_FROM
        && mechanism.layout().n_v.saturating_sub(rows) > FREE_MOST
        && mechanism.mass().iter().all(|&m| m > 0.0)
        && (rows > REFINED_MOST || !is_graded())
}

/// Estimated upper bound (bytes) on the memory of a motion: solvers of the kept rows of C and of
/// Φq, stages, and rows of output.
pub(crate) fn memory(mechanism: &Mechanism, size: f64, levels: [&[usize]; 2]) -> usize {
    let layout = mechanism.layout();
    let of_level = |kept: &[usize]| {
        let c = pattern_of(mechanism, kept);
        let factors = if is_schur(mechanism, size, levels[0].len()) {
            structure(mechanism, &c).bytes()
        } else {
            KeptRowSaddle::bytes(&c)
        };
        factors + KeptMatrix::bytes(c.nnz())
    };
    let vectors = VECTORS * size_of::<f64>() * (layout.n_q + layout.n_v + layout.rows());
    levels.into_iter().map(of_level).sum::<usize>() + vectors
}

fn structure(mechanism: &Mechanism, c: &linalg::SparseMatrix) -> SchurStructure {
    let bodies = 0..mechanism.bodies().len();
    let blocks: Vec<_> = bodies.map(|b| mechanism.layout().columns(b)).collect();
    SchurStructure::new(c, &blocks)
}

impl Solver {
    pub(super) fn new(
        mechanism: &Mechanism,
        kept: &[usize],
        (units, size): (&[f64], f64),
        of_c: usize,
    ) -> Result<Self, SaddleError> {
        let rows = KeptMatrix::new(mechanism, kept, units);
        let (n, r) = (rows.c.ncols(), rows.c.nrows());
        if is_schur(mechanism, size, of_c) {
            let saddle = SchurSaddle::new(structure(mechanism, &rows.c));
            let factors = Factors::Schur(Box::new(saddle));
            return Ok(Self { rows, factors });
        }
        let massless = mechanism.mass().iter().position(|&m| m <= 0.0);
        let is_too_much = r > NULL_SPACE_MOST && n - r > FREE_MOST;
        if let Some(index) = massless.filter(|_| is_too_much) {
            let value = mechanism.mass()[index];
            return Err(SaddleError::ZeroMass { index, value });
        }
        let columns: Vec<Vec<usize>> = (0..r).map(|k| rows.c.row(k).0.to_vec()).collect();
        let factors = Factors::NullSpace(Box::new(NullSpace {
            saddle: KeptRowSaddle::with_columns(n, &columns)?
                .graded_by(mass_spread(mechanism, size)),
            refinement: Refinement::new(n, r),
        }));
        Ok(Self { rows, factors })
    }

    /// Factors the rows with these entries of C; rows whose relative pivots are at most `floor` are
    /// skipped.
    pub(super) fn factor_above(
        &mut self,
        floor: f64,
        entries: &[f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        self.rows.take(entries);
        let c = &self.rows.c;
        match &mut self.factors {
            Factors::NullSpace(it) => it.saddle.factor_above(floor, |k| c.row(k).1, mass),
            Factors::Schur(it) => it.factor_above(floor, c, mass),
        }
    }

    /// Solves `M·x + Cᵀ·λ = force`, `C·x = rhs` for x.
    pub(super) fn motion(
        &mut self,
        force: &[f64],
        rhs: &[f64],
        x: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        match &mut self.factors {
            Factors::NullSpace(it) => it.saddle.motion(force, rhs, x),
            Factors::Schur(it) => it.solve(&self.rows.c, force, rhs, x, lambda),
        }
    }

    /// Like [`Self::motion`], with λ, refined in double-double if possible.
    pub(super) fn refined(
        &mut self,
        force: &[f64],
        rhs: &[f64],
        x: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        let c = &self.rows.c;
        match &mut self.factors {
            Factors::NullSpace(it) => {
                let NullSpace { saddle, refinement } = it.as_mut();
                saddle.solve_refined(refinement, |k| c.row(k).1, force, rhs, x, lambda)
            }
            Factors::Schur(it) => it.solve(c, force, rhs, x, lambda),
        }
    }

    /// Computes λ of a motion x.
    pub(super) fn multipliers(
        &mut self,
        force: &[f64],
        x: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        match &mut self.factors {
            Factors::NullSpace(it) => it.saddle.multipliers(force, x, lambda),
            Factors::Schur(it) => it.multipliers(&self.rows.c, force, x, lambda),
        }
    }

    /// Whether solutions include their multipliers.
    pub(super) fn brings_multipliers(&self) -> bool {
        matches!(self.factors, Factors::Schur(_))
    }

    pub(super) fn wants_refinement(&self) -> bool {
        matches!(&self.factors, Factors::NullSpace(it) if it.saddle.wants_refinement())
    }

    pub(super) fn pivot_ratio(&self) -> f64 {
        each!(&self.factors, it => it.pivot_ratio())
    }

    pub(super) fn n_left_out(&self) -> usize {
        each!(&self.factors, it => it.n_left_out())
    }

    pub(super) fn uses(&self, k: usize) -> bool {
        each!(&self.factors, it => it.uses(k))
    }

    /// Compares the rows of the next factorisations with what this one has left of them.
    pub(super) fn keep_shares(&mut self) {
        if let Factors::Schur(it) = &mut self.factors {
            it.keep_shares();
        }
    }

    /// The rows and the solver in their null space, which alone supports independent coordinates.
    pub(super) fn null_space(
        &mut self,
    ) -> Result<(&linalg::SparseMatrix, &mut KeptRowSaddle), SaddleError> {
        match &mut self.factors {
            Factors::NullSpace(it) => Ok((&self.rows.c, &mut it.saddle)),
            Factors::Schur(_) => Err(SaddleError::Large {
                rows: self.rows.c.nrows(),
            }),
        }
    }

    /// Writes a basis of the motions that the factored rows allow; empty for the Schur complement.
    pub(super) fn null_frame(&self, frame: &mut Vec<f64>) {
        frame.clear();
        if let Factors::NullSpace(it) = &self.factors {
            frame.resize(it.frame(), 0.0);
            it.saddle.null_frame(frame);
        }
    }

    /// Sign of the determinant of the factored rows bordered by a basis of motions; 0 for a basis
    /// of another size and for the Schur complement.
    pub(super) fn orientation(&mut self, frame: &[f64]) -> f64 {
        match &mut self.factors {
            Factors::NullSpace(it) if frame.len() == it.frame() => it.saddle.orientation(frame),
            _ => 0.0,
        }
    }
}

impl NullSpace {
    /// Number of entries of a basis of the free motions of the last factorisation.
    fn frame(&self) -> usize {
        let n = self.saddle.n_coordinates();
        (n - self.saddle.n_rows() + self.saddle.n_left_out()) * n
    }
}
