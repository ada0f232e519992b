//! The equations of motion solved with all rows of C instead of the kept ones. Accelerations are the same; reactions that are not unique are
//! another choice. Projection, monitors and passages stay with the kept rows.
//!
//! As on kept rows, the solvers see units of the mechanism (see [`super::rows`]) and callers their own.

use linalg::{Matrix, MinimumNormSaddle, PivotedQr, ProximalSaddle, ProximalTuning, SaddleError};
use model::reaction::COMPONENTS;
use model::{Mechanism, Scratch, System};

use super::rows::{mass_in_units, trip, units};
use crate::error::Trip;
use crate::options::Formulation;
use crate::prepare::Prepared;

/// Proximal iterations are tuned again once their last one changes more than so many tolerances, on the constraints.
const UNSETTLED: f64 = 100.0;

/// Accelerations with all rows are those of kept rows, on the constraints, but for this share.
const AGREES: f64 = 1e-9;

/// The first solve for the least reactions leaves its own rounding; the second removes what of it matters.
const LEAST_SOLVES: usize = 2;

/// Entries of all rows at most: half a gigabyte, and minutes for a single solution.
const DENSE_MOST: usize = 1 << 26;

/// All rows with the solver of a formulation.
pub(super) struct AllRows {
    /// Multipliers of the last solve.
    pub(super) lambda: Vec<f64>,
    /// All rows of C in units of the mechanism.
    c: Matrix,
    /// What coordinates count in those units, and the masses there, n_v each.
    units: Vec<f64>,
    mass: Vec<f64>,
    /// Q and accelerations in those units, n_v each.
    force: Vec<f64>,
    motion: Vec<f64>,
    saddle: Saddle,
    rank: usize,
    /// Shares below this one are rounding of the null space.
    tolerance: f64,
}

enum Saddle {
    MinimumNorm(Box<MinimumNormSaddle>),
    Proximal {
        saddle: Box<ProximalSaddle>,
        tolerance: f64,
    },
}

impl AllRows {
    /// The solver of a formulation at the prepared start, where the rank is decided; nothing where that is one of kept rows.
    pub(super) fn new(
        prepared: &Prepared,
        formulation: Formulation,
        rtol: f64,
    ) -> Result<Option<Self>, Trip> {
        if formulation.drops_rows() {
            return Ok(None);
        }
        let mechanism = &prepared.mechanism;
        let mut s = mechanism.scratch();
        mechanism.pose(0.0, &prepared.q, &mut s);
        mechanism.c(&mut s);
        let units = units(mechanism, prepared.assembly.size);
        let mass = mass_in_units(mechanism, &units);
        let (rows, n) = (mechanism.layout().rows(), units.len());
        if rows * n > DENSE_MOST {
            let source = SaddleError::Large { rows };
            return Err(Trip::Saddle { time: 0.0, source });
        }
        let mut c = mechanism.layout().dense(&s);
        scale_columns(&mut c, &units);
        let rank = prepared.decision.rank;
        let saddle = match formulation {
            Formulation::KeptRows | Formulation::NullSpace => return Ok(None),
            Formulation::MinimumNorm => {
                MinimumNormSaddle::new(&c, rank).map(|saddle| Saddle::MinimumNorm(Box::new(saddle)))
            }
            Formulation::Proximal => {
                let saddle = ProximalSaddle::new(&c, &mass, rank, rtol);
                saddle.map(|saddle| Saddle::Proximal {
                    saddle: Box::new(saddle),
                    tolerance: rtol,
                })
            }
        };
        Ok(Some(Self {
            lambda: vec![0.0; c.nrows()],
            saddle: saddle.map_err(|e| trip(mechanism, &s, e, |row| row))?,
            c,
            force: vec![0.0; units.len()],
            motion: vec![0.0; units.len()],
            units,
            mass,
            rank,
            tolerance: prepared.decision.support_tolerance,
        }))
    }

    /// Solves `M·a + Cᵀ·λ = Q`, `C·a = Γ` at the entries, Γ and Q of the scratch.
    pub(super) fn solve(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        a: &mut [f64],
    ) -> Result<(), Trip> {
        for i in 0..self.c.nrows() {
            mechanism.layout().scatter_row(s, i, self.c.row_mut(i));
        }
        scale_columns(&mut self.c, &self.units);
        self.solve_again(mechanism, s, a)
    }

    /// The same at the last C.
    fn solve_again(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        a: &mut [f64],
    ) -> Result<(), Trip> {
        for ((scaled, f), unit) in self.force.iter_mut().zip(&s.force).zip(&self.units) {
            *scaled = f * unit;
        }
        let (mass, motion, lambda) = (&self.mass, &mut self.motion, &mut self.lambda);
        let solved: Result<(), SaddleError> = match &mut self.saddle {
            Saddle::MinimumNorm(saddle) => saddle
                .factor(&self.c, mass)
                .and_then(|()| saddle.solve(&self.force, &s.gamma, motion, lambda)),
            Saddle::Proximal { saddle, .. } => saddle
                .factor(&self.c, mass)
                .and_then(|()| saddle.solve(&self.force, &s.gamma, motion, lambda)),
        };
        solved.map_err(|e| trip(mechanism, s, e, |row| row))?;
        for ((a, scaled), unit) in a.iter_mut().zip(&self.motion).zip(&self.units) {
            *a = scaled * unit;
        }
        Ok(())
    }

    /// Whether the last solve, at a state on the constraints, reached its tolerance. If not, it is tuned again and `a` solved for again.
    pub(super) fn review(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        a: &mut [f64],
    ) -> Result<(), Trip> {
        let Some(allowed) = self.missed() else {
            return Ok(());
        };
        if let Saddle::Proximal { saddle, tolerance } = &mut self.saddle {
            saddle
                .tune(&self.c, &self.mass, self.rank, *tolerance)
                .map_err(|e| trip(mechanism, s, e, |row| row))?;
        }
        self.solve_again(mechanism, s, a)?;
        match (self.missed(), &self.saddle) {
            (Some(_), Saddle::Proximal { saddle, .. }) => Err(Trip::Unsettled {
                time: s.t,
                share: saddle.unsettled(),
                allowed,
            }),
            _ => Ok(()),
        }
    }

    /// The tuning of proximal iterations.
    pub(super) fn proximal_tuning(&self) -> Option<ProximalTuning> {
        match &self.saddle {
            Saddle::MinimumNorm(_) => None,
            Saddle::Proximal { saddle, .. } => Some(saddle.tuning()),
        }
    }

    /// What is allowed, if iterations ended above it.
    fn missed(&self) -> Option<f64> {
        match &self.saddle {
            Saddle::MinimumNorm(_) => None,
            Saddle::Proximal { saddle, tolerance } => {
                let allowed = UNSETTLED * tolerance.max(f64::EPSILON);
                (saddle.unsettled() > allowed).then_some(allowed)
            }
        }
    }

    /// The share by which accelerations may miss those of kept rows.
    pub(super) fn allowed(&self) -> f64 {
        match &self.saddle {
            Saddle::MinimumNorm(_) => AGREES,
            Saddle::Proximal { tolerance, .. } => AGREES.max(UNSETTLED * tolerance),
        }
    }

    /// Takes other multipliers that solve the same equations, where the formulation chooses among all of them by itself afterwards.
    pub(super) fn start_from(&mut self, kept: &[usize], lambda: &[f64]) {
        if let Saddle::MinimumNorm(_) = self.saddle {
            self.lambda.fill(0.0);
            for (&row, &l) in kept.iter().zip(lambda) {
                self.lambda[row] = l;
            }
        }
    }

    /// Turns the multipliers of the last solve into those that the formulation reports; allocates.
    pub(super) fn choose(&mut self, mechanism: &Mechanism, s: &Scratch) {
        if let Saddle::MinimumNorm(saddle) = &self.saddle {
            let free = saddle.left_null_space();
            self.least_reactions(&free, &wrenches(mechanism, s));
        }
    }

    /// λ + Z·y with the least ‖W·(λ + Z·y)‖, W from multipliers to the wrenches of all joints and drives. Directions that change no wrench
    /// are left alone.
    fn least_reactions(&mut self, free: &Matrix, wrenches: &Matrix) {
        let images = wrenches.product(free);
        let qr = PivotedQr::of_columns(&images);
        let largest = qr.r_diagonal().next().unwrap_or(0.0).abs();
        let visible = qr
            .r_diagonal()
            .filter(|r| r.abs() > self.tolerance * largest);
        let visible = visible.count();
        for _ in 0..LEAST_SOLVES {
            let mut y = wrenches.times(&self.lambda);
            qr.q_transpose_mul(&mut y);
            y.truncate(visible);
            qr.solve_r(&mut y);
            for (i, l) in self.lambda.iter_mut().enumerate() {
                let columns = qr.permutation().iter().map(|&k| free[(i, k)]);
                *l -= columns.zip(&y).map(|(z, y)| z * y).sum::<f64>();
            }
        }
    }
}

fn scale_columns(c: &mut Matrix, units: &[f64]) {
    for i in 0..c.nrows() {
        for (c, unit) in c.row_mut(i).iter_mut().zip(units) {
            *c *= unit;
        }
    }
}

/// W: Fx, Fy (N) and T (N·m) of all joints and drives on their first bodies.
fn wrenches(mechanism: &Mechanism, s: &Scratch) -> Matrix {
    let layout = mechanism.layout();
    let mut all = Matrix::zeros(COMPONENTS.len() * layout.groups.len(), layout.rows());
    for (k, id) in mechanism.constraint_ids().enumerate() {
        let map = mechanism.wrench_map(id, s);
        let first = layout.groups[k].rows.start;
        for c in 0..map.nrows() {
            let row = all.row_mut(COMPONENTS.len() * k + c);
            row[first..first + map.ncols()].copy_from_slice(map.row(c));
        }
    }
    all
}
