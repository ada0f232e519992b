//! A solver of independent rows. There are two kinds: one solves the rows in their null space, and
//! the other solves them through the Schur complement of the masses.
//!
//! The first solver eliminates C itself and solves for the coordinates that the rows of C determine
//! best. The first solver computes the sign of a bordered determinant, supports independent
//! coordinates, and allows zero masses. The work of the first solver grows with the number of free
//! motions times the number of entries. The second solver is for large mechanisms with many free
//! motions, such as chains and trains of vehicles. The second solver also replaces the first solver
//! at instants at which many rows of a large mechanism with few free motions are skipped.

use linalg::{
    AddedMass, GRADED_MASSES, KeptRowSaddle, MassMatrix, Refinement, SaddleError, SchurSaddle,
    SchurStructure, SparseMatrix,
};
use model::{Mechanism, System};

use super::matrix::{KeptMatrix, pattern_of};
use super::units::mass_spread;
use crate::limits::{FREE_DENSE, FREE_MOST, NULL_SPACE_MOST, REFINED_MOST, SCHUR_FROM, VECTORS};

/// Independent rows and their factors.
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
    /// Solver for instants at which many motions are free. `None` for small mechanisms, and if the
    /// Schur complement is not accurate enough.
    many: Option<Box<Many>>,
}

/// The Schur complement that replaces the null space.
#[derive(Clone)]
struct Many {
    saddle: SchurSaddle,
    /// The smallest relative pivot of the Schur complement divided by that of the null space, both
    /// at the reference state. The value is 0 before it has been computed.
    share: f64,
    /// Whether the last factorisation was made by this solver, with this floor and these masses.
    is_used: bool,
    floor: f64,
    mass: Vec<f64>,
    added: AddedMass,
}

/// Returns a value from the null-space solver if this solver made the last factorisation, and
/// otherwise another value from the Schur complement.
macro_rules! either {
    ($factors:expr, $null_space:ident => $a:expr, $schur:ident => $b:expr) => {
        match $factors {
            Factors::NullSpace($null_space) => match $null_space.used() {
                None => $a,
                Some($schur) => $b,
            },
            Factors::Schur($schur) => $b,
        }
    };
}

/// The data of a motion that determine the kind of its solvers.
#[derive(Clone, Copy)]
pub(crate) struct SolverNeeds {
    /// Size of the mechanism (m).
    pub(crate) size: f64,
    /// Number of independent rows of C.
    pub(crate) rows: usize,
    /// Whether the motion uses independent coordinates, which only the null space provides.
    pub(crate) are_coordinates_independent: bool,
}

impl SolverNeeds {
    /// Returns whether the independent rows of C and of Φq of a mechanism are solved through the
    /// Schur complement. There are two cases. In the first case, there are many rows and many free
    /// motions, every coordinate has a mass, and solutions need no refinement because of different
    /// masses. In the second case, rows and free motions are too many for the null space. With
    /// independent coordinates, only the second case requires the Schur complement. If there are
    /// many free motions but no rows, there is no equation to eliminate.
    pub(crate) fn is_schur(self, mechanism: &Mechanism) -> bool {
        let free = mechanism.layout().n_v.saturating_sub(self.rows);
        let most = if self.are_coordinates_independent {
            FREE_DENSE
        } else {
            FREE_MOST
        };
        let has_masses = || mechanism.mass().iter().all(|&m| m > 0.0);
        let is_free = || self.rows == 0 && free > FREE_DENSE && has_masses();
        free > most && (is_free() || self.allows_schur(mechanism))
    }

    /// Returns whether the Schur complement is accurate enough, and whether it justifies its
    /// memory.
    fn allows_schur(self, mechanism: &Mechanism) -> bool {
        let is_graded = || mass_spread(mechanism, self.size) >= GRADED_MASSES;
        self.rows >= SCHUR_FROM
            && mechanism.mass().iter().all(|&m| m > 0.0)
            && (self.rows > REFINED_MOST || !is_graded())
    }

    /// Returns whether the Schur complement is prepared for instants at which many rows are
    /// skipped.
    fn has_many(self, mechanism: &Mechanism) -> bool {
        !self.are_coordinates_independent && self.allows_schur(mechanism)
    }
}

/// Returns an estimated upper bound (bytes) on the memory of a motion. The memory consists of
/// solvers of the independent rows of C and of Φq, of stages, and of output rows.
pub(crate) fn memory(mechanism: &Mechanism, needs: SolverNeeds, levels: [&[usize]; 2]) -> usize {
    let layout = mechanism.layout();
    let of_level = |kept: &[usize]| {
        let c = pattern_of(mechanism, kept);
        let mut factors = 0;
        let is_schur = needs.is_schur(mechanism);
        if is_schur || needs.has_many(mechanism) {
            factors += structure(mechanism, &c).bytes();
        }
        if !is_schur {
            factors += KeptRowSaddle::bytes(&c);
        }
        factors + KeptMatrix::bytes(c.nnz())
    };
    let vectors = VECTORS * size_of::<f64>() * (layout.n_q + layout.n_v + layout.rows());
    levels.into_iter().map(of_level).sum::<usize>() + vectors
}

fn structure(mechanism: &Mechanism, c: &SparseMatrix) -> SchurStructure {
    let bodies = 0..mechanism.bodies().len();
    let blocks: Vec<_> = bodies.map(|b| mechanism.layout().columns(b)).collect();
    let s = mechanism.scratch();
    SchurStructure::with_added(c, &blocks, mechanism.inertia(&s).added())
}

impl Solver {
    pub(super) fn new(
        mechanism: &Mechanism,
        kept: &[usize],
        units: &[f64],
        needs: SolverNeeds,
    ) -> Result<Self, SaddleError> {
        let rows = KeptMatrix::new(mechanism, kept, units);
        let (n, r) = (rows.c.ncols(), rows.c.nrows());
        if needs.is_schur(mechanism) {
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
        let many = needs.has_many(mechanism).then(|| {
            Box::new(Many {
                saddle: SchurSaddle::new(structure(mechanism, &rows.c)),
                share: 0.0,
                is_used: false,
                floor: 0.0,
                mass: Vec::new(),
                added: AddedMass::default(),
            })
        });
        let factors = Factors::NullSpace(Box::new(NullSpace {
            saddle: KeptRowSaddle::with_columns(n, &columns)?
                .graded_by(mass_spread(mechanism, needs.size)),
            refinement: Refinement::new(n, r),
            many,
        }));
        Ok(Self { rows, factors })
    }

    /// Factors the rows with these entries of C. Rows whose relative pivots are at most `floor` are
    /// skipped.
    pub(super) fn factor_above(
        &mut self,
        floor: f64,
        entries: &[f64],
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        self.rows.take(entries);
        let c = &self.rows.c;
        match &mut self.factors {
            Factors::NullSpace(it) => it.factor_above(floor, c, mass),
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
        either!(&mut self.factors,
            it => it.saddle.motion(force, rhs, x),
            schur => schur.solve(&self.rows.c, force, rhs, x, lambda))
    }

    /// Works like [`Self::motion`], but also computes λ. The solution is refined in double-double
    /// if possible.
    pub(super) fn refined(
        &mut self,
        force: &[f64],
        rhs: &[f64],
        x: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        let c = &self.rows.c;
        either!(&mut self.factors,
            it => {
                let NullSpace { saddle, refinement, .. } = it.as_mut();
                saddle.solve_refined(refinement, |k| c.row(k).1, force, rhs, x, lambda)
            },
            schur => schur.solve(c, force, rhs, x, lambda))
    }

    /// Computes λ of a motion x.
    pub(super) fn multipliers(
        &mut self,
        force: &[f64],
        x: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        either!(&mut self.factors,
            it => it.saddle.multipliers(force, x, lambda),
            schur => schur.multipliers(&self.rows.c, force, x, lambda))
    }

    /// Returns the Schur complement if it made the last factorisation.
    fn schur(&self) -> Option<&SchurSaddle> {
        match &self.factors {
            Factors::NullSpace(it) => {
                let many = it.many.as_ref().filter(|many| many.is_used);
                many.map(|many| &many.saddle)
            }
            Factors::Schur(it) => Some(it),
        }
    }

    /// Returns the null-space solver if it made the last factorisation.
    fn own(&self) -> Option<&NullSpace> {
        match &self.factors {
            Factors::NullSpace(it) if self.schur().is_none() => Some(it),
            _ => None,
        }
    }

    /// Returns whether solutions include their multipliers.
    pub(super) fn brings_multipliers(&self) -> bool {
        self.schur().is_some()
    }

    pub(super) fn wants_refinement(&self) -> bool {
        self.own().is_some_and(|it| it.saddle.wants_refinement())
    }

    pub(super) fn pivot_ratio(&self) -> f64 {
        match (&self.factors, self.schur()) {
            (Factors::NullSpace(it), Some(schur)) => {
                let share = it.many.as_ref().map_or(1.0, |many| many.share);
                schur.pivot_ratio() / share
            }
            (Factors::NullSpace(it), None) => it.saddle.pivot_ratio(),
            (Factors::Schur(it), _) => it.pivot_ratio(),
        }
    }

    pub(super) fn n_left_out(&self) -> usize {
        match (self.own(), self.schur()) {
            (Some(it), _) => it.saddle.n_left_out(),
            (None, schur) => schur.map_or(0, SchurSaddle::n_left_out),
        }
    }

    pub(super) fn uses(&self, k: usize) -> bool {
        match (self.own(), self.schur()) {
            (Some(it), _) => it.saddle.uses(k),
            (None, schur) => schur.is_some_and(|it| it.uses(k)),
        }
    }

    /// Stores the pivots of this factorisation as the reference for the following factorisations.
    pub(super) fn keep_shares(&mut self, mass: MassMatrix<'_>) {
        match &mut self.factors {
            Factors::Schur(it) => it.keep_shares(),
            Factors::NullSpace(it) => it.keep_shares(&self.rows.c, mass),
        }
    }

    /// Returns the rows and their null-space solver. Only this solver supports independent
    /// coordinates.
    pub(super) fn null_space(
        &mut self,
    ) -> Result<(&SparseMatrix, &mut KeptRowSaddle), SaddleError> {
        let c = &self.rows.c;
        match &mut self.factors {
            Factors::NullSpace(it) => Ok((c, it.factored(c)?)),
            Factors::Schur(_) => Err(SaddleError::Large { rows: c.nrows() }),
        }
    }

    /// Writes a basis of the motions that the factored rows allow. The basis is empty for the Schur
    /// complement. The basis is also empty without rows, because then no rows can become dependent.
    pub(super) fn null_frame(&self, frame: &mut Vec<f64>) {
        frame.clear();
        if let Some(it) = self.own()
            && self.rows.c.nrows() > 0
        {
            frame.resize(it.frame(), 0.0);
            it.saddle.null_frame(frame);
        }
    }

    /// Returns the sign of the determinant of the factored rows bordered by a basis of motions. The
    /// result is 0 for a basis of another size and for the Schur complement.
    pub(super) fn orientation(&mut self, frame: &[f64]) -> f64 {
        let is_own = self.own().is_some_and(|it| frame.len() == it.frame());
        match &mut self.factors {
            Factors::NullSpace(it) if is_own => it.saddle.orientation(frame),
            _ => 0.0,
        }
    }
}

impl NullSpace {
    /// Returns the Schur complement if it made the last factorisation.
    fn used(&mut self) -> Option<&mut SchurSaddle> {
        let many = self.many.as_mut().filter(|many| many.is_used);
        many.map(|many| &mut many.saddle)
    }

    fn factor_above(
        &mut self,
        floor: f64,
        c: &SparseMatrix,
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        let Some(many) = self.many.as_mut().filter(|many| many.share > 0.0) else {
            return self.saddle.factor_above(floor, |k| c.row(k).1, mass);
        };
        many.is_used = false;
        match self
            .saddle
            .factor_up_to(FREE_MOST, floor, |k| c.row(k).1, mass)
        {
            Err(SaddleError::ManyFree { .. }) => {
                (many.is_used, many.floor) = (true, floor);
                many.mass.clear();
                many.mass.extend_from_slice(mass.diagonal());
                many.added.clone_from(mass.added());
                many.saddle.factor_above(floor * many.share, c, mass)
            }
            factored => factored,
        }
    }

    /// Returns the null-space solver with the factors of these rows, even if the Schur complement
    /// is used.
    fn factored(&mut self, c: &SparseMatrix) -> Result<&mut KeptRowSaddle, SaddleError> {
        if let Some(many) = self.many.as_mut().filter(|many| many.is_used) {
            many.is_used = false;
            let (floor, mass) = (many.floor, MassMatrix::new(&many.mass, &many.added));
            self.saddle.factor_above(floor, |k| c.row(k).1, mass)?;
        }
        Ok(&mut self.saddle)
    }

    /// Also factors the rows of the last factorisation by the Schur complement. The pivots of the
    /// Schur complement can then be compared with the pivots of the null-space solver.
    fn keep_shares(&mut self, c: &SparseMatrix, mass: MassMatrix<'_>) {
        let Some(many) = &mut self.many else { return };
        let usual = self.saddle.pivot_ratio();
        let factored = many.saddle.factor_above(0.0, c, mass);
        let share = many.saddle.pivot_ratio() / usual;
        if factored.is_ok() && many.saddle.n_left_out() == 0 && share.is_finite() {
            many.saddle.keep_shares();
            many.share = share;
        }
    }

    /// Returns the number of entries of a basis of the free motions of the last factorisation.
    fn frame(&self) -> usize {
        let n = self.saddle.n_coordinates();
        (n - self.saddle.n_rows() + self.saddle.n_left_out()) * n
    }
}
