//! One of two solvers of kept rows: dense for small mechanisms, sparse for large ones.
//!
//! The dense one eliminates C itself, row by row, with a new choice of coordinates each time: it
//! computes the sign of a bordered determinant, supports independent coordinates, and allows zero
//! masses. The sparse one eliminates the Schur complement of the masses in an order that is chosen
//! once.

use linalg::{GRADED_MASSES, SaddleError};
use model::{Mechanism, System};

use super::dense::Dense;
use super::sparse::{self, Sparse};
use super::units::{mass_in_units, units_of_bodies};
use crate::limits::{DENSE_MATRICES, DENSE_MOST, REFINED_MOST, SPARSE_FROM, VECTORS};

/// Kept rows and their factors.
#[derive(Clone)]
pub(super) enum Solver {
    Dense(Box<Dense>),
    Sparse(Box<Sparse>),
}

/// Calls the same method of either solver.
macro_rules! each {
    ($solver:expr, $it:ident => $value:expr) => {
        match $solver {
            Solver::Dense($it) => $value,
            Solver::Sparse($it) => $value,
        }
    };
}

/// Whether this number of kept rows of C of a mechanism of this size (m) is solved sparsely, and so
/// are its kept rows of Φq: if there are many of them, every coordinate has a mass, and solutions
/// need no refinement because of different masses; or if there are too many rows for a dense
/// solver. The units of columns cancel in the Schur complement, so masses are compared by the
/// lengths of their bodies.
pub(crate) fn is_sparse(mechanism: &Mechanism, size: f64, rows: usize) -> bool {
    let is_graded = || {
        let units = units_of_bodies(mechanism, size);
        linalg::mass_spread(&mass_in_units(mechanism, &units)) >= GRADED_MASSES
    };
    rows >= SPARSE_FROM
        && mechanism.mass().iter().all(|&m| m > 0.0)
        && (rows > REFINED_MOST || !is_graded())
}

/// Estimated upper bound (bytes) on the memory of a motion: solvers of the kept rows of C and of
/// Φq, stages, and rows of output.
pub(crate) fn memory(mechanism: &Mechanism, size: f64, levels: [&[usize]; 2]) -> usize {
    let layout = mechanism.layout();
    let of_level = |kept: &[usize]| {
        if is_sparse(mechanism, size, levels[0].len()) {
            sparse::memory(mechanism, kept)
        } else {
            DENSE_MATRICES * size_of::<f64>() * (layout.n_v + kept.len()).pow(2)
        }
    };
    let vectors = VECTORS * size_of::<f64>() * (layout.n_q + layout.n_v + layout.rows());
    levels.into_iter().map(of_level).sum::<usize>() + vectors
}

impl Solver {
    pub(super) fn new(
        mechanism: &Mechanism,
        kept: &[usize],
        (units, size): (&[f64], f64),
        of_c: usize,
    ) -> Result<Self, SaddleError> {
        if is_sparse(mechanism, size, of_c) {
            return Ok(Self::Sparse(Box::new(Sparse::new(mechanism, kept, units))));
        }
        let massless = mechanism.mass().iter().position(|&m| m <= 0.0);
        if let Some(index) = massless.filter(|_| kept.len() > DENSE_MOST) {
            let value = mechanism.mass()[index];
            return Err(SaddleError::ZeroMass { index, value });
        }
        Ok(Self::Dense(Box::new(Dense::new(mechanism, kept, units)?)))
    }

    pub(super) fn factor_above(
        &mut self,
        floor: f64,
        entries: &[f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        each!(self, it => it.factor_above(floor, entries, mass))
    }

    /// Solves `M·x + Cᵀ·λ = force`, `C·x = rhs` for x.
    pub(super) fn motion(
        &mut self,
        force: &[f64],
        rhs: &[f64],
        x: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        match self {
            Self::Dense(it) => it.saddle.motion(force, rhs, x),
            Self::Sparse(it) => it.saddle.solve(&it.c, force, rhs, x, lambda),
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
        match self {
            Self::Dense(it) => {
                let Dense {
                    c,
                    saddle,
                    refinement,
                    ..
                } = it.as_mut();
                saddle.solve_refined(refinement, |k| c.row(k), force, rhs, x, lambda)
            }
            Self::Sparse(it) => it.saddle.solve(&it.c, force, rhs, x, lambda),
        }
    }

    /// Computes λ of a motion x.
    pub(super) fn multipliers(
        &mut self,
        force: &[f64],
        x: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        match self {
            Self::Dense(it) => it.saddle.multipliers(force, x, lambda),
            Self::Sparse(it) => it.saddle.multipliers(&it.c, force, x, lambda),
        }
    }

    /// Whether solutions include their multipliers.
    pub(super) fn brings_multipliers(&self) -> bool {
        matches!(self, Self::Sparse(_))
    }

    pub(super) fn wants_refinement(&self) -> bool {
        matches!(self, Self::Dense(it) if it.saddle.wants_refinement())
    }

    pub(super) fn pivot_ratio(&self) -> f64 {
        each!(self, it => it.saddle.pivot_ratio())
    }

    pub(super) fn n_left_out(&self) -> usize {
        each!(self, it => it.saddle.n_left_out())
    }

    pub(super) fn uses(&self, k: usize) -> bool {
        each!(self, it => it.saddle.uses(k))
    }

    /// Uses the coordinates of the last factorisation first in the next ones; the sparse order is
    /// always the same.
    pub(super) fn keep_order(&mut self) {
        match self {
            Self::Dense(it) => it.saddle.keep_order(),
            Self::Sparse(it) => it.saddle.keep_shares(),
        }
    }

    /// The dense solver, which alone supports independent coordinates.
    pub(super) fn dense(&mut self) -> Result<&mut Dense, SaddleError> {
        match self {
            Self::Dense(it) => Ok(it),
            Self::Sparse(it) => Err(SaddleError::Large { rows: it.c.nrows() }),
        }
    }

    /// Writes a basis of the motions that the factored rows allow; empty for the sparse solver.
    pub(super) fn null_frame(&self, frame: &mut Vec<f64>) {
        frame.clear();
        if let Self::Dense(it) = self {
            frame.resize(it.n_free() * it.saddle.n_coordinates(), 0.0);
            it.saddle.null_frame(frame);
        }
    }

    /// Sign of the determinant of the factored rows bordered by a basis of motions; 0 for a basis
    /// of another size and for the sparse solver.
    pub(super) fn orientation(&mut self, frame: &[f64]) -> f64 {
        match self {
            Self::Dense(it) if frame.len() == it.n_free() * it.saddle.n_coordinates() => {
                it.saddle.orientation(frame)
            }
            _ => 0.0,
        }
    }
}

impl Dense {
    /// Number of free motions of the last factorisation.
    fn n_free(&self) -> usize {
        self.saddle.n_coordinates() - self.saddle.n_rows() + self.saddle.n_left_out()
    }
}
