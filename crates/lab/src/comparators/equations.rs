//! The differential equation of a comparator: y = [q; v], accelerations from a [`Solver`], and what
//! is done about drift.

use std::time::Instant;

use dynamics::Prepared;
use integrators::{Ode, StepEnd, StepInfo};
use linalg::Matrix;
use model::{Mechanism, Reaction, Scratch, System};

use super::kept_rows::KeptRows;
use super::{Drift, Fault, Saddle, Solver};

/// Corrections of a projection at most: Newton's method converges quadratically from where a step
/// ends.
const CORRECTIONS: usize = 10;

/// A correction below this share of the size of the mechanism is rounding.
const SETTLED: f64 = 1e-13;

/// The equations of motion of a mechanism by one formulation.
pub struct Equations<'a> {
    mechanism: &'a Mechanism,
    s: Scratch,
    solver: Box<dyn Solver + 'a>,
    /// Kept rows of Φq and of C, for projections.
    positions: KeptRows,
    velocities: KeptRows,
    drift: Drift,
    /// What coordinates count in units of the mechanism, and the masses there, n_v each.
    units: Vec<f64>,
    mass: Vec<f64>,
    /// C in those units; its holonomic rows are those of Φq.
    c: Matrix,
    /// Q and a in those units, n_v; λ and right-hand sides of all rows.
    force: Vec<f64>,
    motion: Vec<f64>,
    lambda: Vec<f64>,
    gamma: Vec<f64>,
    /// Right-hand sides evaluated, states projected.
    pub(super) evaluations: u64,
    pub(super) projections: u64,
    /// After it nothing is evaluated any more.
    pub(super) deadline: Option<Instant>,
}

/// C at a configuration in units of the mechanism: lengths in its size.
pub(super) fn in_units(mechanism: &Mechanism, s: &Scratch, units: &[f64], c: &mut Matrix) {
    for i in 0..c.nrows() {
        let row = c.row_mut(i);
        mechanism.layout().scatter_row(s, i, row);
        for (c, unit) in row.iter_mut().zip(units) {
            *c *= unit;
        }
    }
}

impl<'a> Equations<'a> {
    /// `solver` is made from C and M at the start, in units of the mechanism.
    ///
    /// # Errors
    /// What it fails with.
    pub fn new(
        prepared: &'a Prepared,
        drift: Drift,
        solver: impl FnOnce(&Matrix, &[f64]) -> Result<Box<dyn Solver + 'a>, Fault>,
    ) -> Result<Self, Fault> {
        let mechanism = &prepared.mechanism;
        let layout = mechanism.layout();
        let exponents = mechanism
            .layout()
            .dimension_scaling(prepared.assembly.size)
            .cols;
        let units: Vec<f64> = exponents.iter().map(|&e| f64::from(e).exp2()).collect();
        let mass = mechanism.mass().iter().zip(&units);
        let mass: Vec<f64> = mass.map(|(m, unit)| unit * m * unit).collect();
        let (n, m) = (layout.n_v, layout.rows());
        let (mut s, mut c) = (mechanism.scratch(), Matrix::zeros(m, n));
        mechanism.pose(0.0, &prepared.q, &mut s);
        mechanism.c(&mut s);
        in_units(mechanism, &s, &units, &mut c);
        Ok(Self {
            solver: solver(&c, &mass)?,
            positions: KeptRows::new(n, &prepared.position_decision.kept)?,
            velocities: KeptRows::new(n, &prepared.decision.kept)?,
            mechanism,
            s,
            drift,
            units,
            mass,
            c,
            force: vec![0.0; n],
            motion: vec![0.0; n],
            lambda: vec![0.0; m],
            gamma: vec![0.0; m],
            evaluations: 0,
            projections: 0,
            deadline: None,
        })
    }

    /// The mechanism.
    pub(super) fn mechanism(&self) -> &'a Mechanism {
        self.mechanism
    }

    /// n_q and n_v.
    pub(super) fn sizes(&self) -> [usize; 2] {
        [self.mechanism.layout().n_q, self.mechanism.layout().n_v]
    }

    /// Accelerations in `a`, multipliers of all rows in `self.lambda`.
    ///
    /// # Errors
    /// Those of the solver; [`Fault::TooLong`].
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> Result<(), Fault> {
        let (mechanism, s) = (self.mechanism, &mut self.s);
        self.evaluations += 1;
        if self
            .deadline
            .is_some_and(|deadline| Instant::now() > deadline)
        {
            return Err(Fault::TooLong { time: t });
        }
        mechanism.pose(t, q, s);
        mechanism.c(s);
        mechanism.twist(v, s);
        mechanism.gamma(s);
        mechanism.force(s);
        self.gamma.copy_from_slice(&s.gamma);
        if let Drift::Baumgarte { alpha, beta } = self.drift {
            mechanism.b(s);
            mechanism.phi(s);
            for (i, gamma) in self.gamma.iter_mut().enumerate() {
                let rate = mechanism.layout().velocity_residual(s, i, v);
                *gamma -= match s.phi.get(i) {
                    Some(phi) => 2.0 * alpha * rate + beta * beta * phi,
                    None => alpha * rate,
                };
            }
        }
        in_units(mechanism, s, &self.units, &mut self.c);
        for ((scaled, f), unit) in self.force.iter_mut().zip(&s.force).zip(&self.units) {
            *scaled = f * unit;
        }
        let at = Saddle {
            c: &self.c,
            mass: &self.mass,
            force: &self.force,
            gamma: &self.gamma,
        };
        self.solver.solve(&at, &mut self.motion, &mut self.lambda)?;
        for ((a, scaled), unit) in a.iter_mut().zip(&self.motion).zip(&self.units) {
            *a = scaled * unit;
        }
        match a.iter().all(|a| a.is_finite()) {
            true => Ok(()),
            false => Err(Fault::NotFinite { time: t }),
        }
    }

    /// Accelerations and reactions of all joints and drives at a state; allocates.
    ///
    /// # Errors
    /// As [`Equations::accelerate`].
    pub fn observe(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<(Vec<f64>, Vec<Reaction>), Fault> {
        let mut a = vec![0.0; v.len()];
        self.accelerate(t, q, v, &mut a)?;
        let of = |id| self.mechanism.reactions(&self.s).reaction(id, &self.lambda);
        Ok((
            a,
            self.mechanism.layout().constraint_ids().map(of).collect(),
        ))
    }

    /// Moves q and v onto the constraints by the smallest corrections in the metric of the masses.
    ///
    /// # Errors
    /// [`Fault::Projection`], or those of the kept rows.
    pub fn project(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<(), Fault> {
        self.projections += 1;
        let (mechanism, mut before) = (self.mechanism, f64::INFINITY);
        for correction in 0.. {
            let s = &mut self.s;
            mechanism.pose(t, q, s);
            mechanism.phi(s);
            mechanism.c(s);
            self.gamma.fill(0.0);
            for (gamma, phi) in self.gamma.iter_mut().zip(&s.phi) {
                *gamma = -phi;
            }
            let size = self.correct(true)?;
            let d: Vec<f64> = self
                .motion
                .iter()
                .zip(&self.units)
                .map(|(d, u)| d * u)
                .collect();
            mechanism.displace(q, &d);
            let is_rounding = size >= before && size < SETTLED.sqrt();
            if size <= SETTLED || is_rounding {
                break;
            }
            if correction == CORRECTIONS || !size.is_finite() {
                return Err(Fault::Projection { time: t });
            }
            before = size;
        }
        self.project_velocity(t, q, v)
    }

    /// The same of velocities alone.
    fn project_velocity(&mut self, t: f64, q: &[f64], v: &mut [f64]) -> Result<(), Fault> {
        let (mechanism, s) = (self.mechanism, &mut self.s);
        mechanism.pose(t, q, s);
        mechanism.c(s);
        mechanism.b(s);
        for (i, gamma) in self.gamma.iter_mut().enumerate() {
            *gamma = -mechanism.layout().velocity_residual(s, i, v);
        }
        self.correct(false)?;
        for ((v, d), unit) in v.iter_mut().zip(&self.motion).zip(&self.units) {
            *v += d * unit;
        }
        Ok(())
    }

    /// The smallest correction that changes rows by γ; returns its largest component, in units of
    /// the mechanism.
    fn correct(&mut self, of_positions: bool) -> Result<f64, Fault> {
        in_units(self.mechanism, &self.s, &self.units, &mut self.c);
        self.force.fill(0.0);
        let at = Saddle {
            c: &self.c,
            mass: &self.mass,
            force: &self.force,
            gamma: &self.gamma,
        };
        let rows = match of_positions {
            true => &mut self.positions,
            false => &mut self.velocities,
        };
        rows.solve(&at, &mut self.motion, &mut self.lambda)?;
        Ok(self.motion.iter().fold(0.0, |a: f64, d| a.max(d.abs())))
    }

    /// Ends a step: projects, where states are projected. Returns whether it did.
    ///
    /// # Errors
    /// As [`Equations::project`].
    pub(super) fn end(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Fault> {
        if self.drift != Drift::Projection {
            return Ok(false);
        }
        let (q, v) = y.split_at_mut(self.mechanism.layout().n_q);
        self.project(t, q, v)?;
        Ok(true)
    }
}

impl Ode for Equations<'_> {
    type Error = Fault;

    fn dim(&self) -> usize {
        self.sizes().iter().sum()
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Fault> {
        let (q, v) = y.split_at(self.mechanism.layout().n_q);
        let (qd, a) = dy.split_at_mut(q.len());
        self.mechanism.rate(q, v, qd);
        self.accelerate(t, q, v, a)
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Fault> {
        let before = y.to_vec();
        if !self.end(step.t_rhs, y)? {
            return Ok(StepEnd::Unchanged);
        }
        self.rhs(step.t_rhs, y, dy)?;
        let moved: Vec<f64> = y.iter().zip(&before).map(|(y, b)| y - b).collect();
        Ok(StepEnd::Projected {
            correction: step.norm(&moved),
            evaluations: 1,
        })
    }

    /// Rates that jump make the velocities jump, by an impulse of the constraints.
    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), Fault> {
        let (q, v) = y.split_at_mut(self.mechanism.layout().n_q);
        self.project_velocity(t, q, v)
    }
}
