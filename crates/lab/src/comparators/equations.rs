//! The differential equation of a reference method for y = [q; v], with accelerations from a
//! [`Solver`] and a treatment of drift.

use std::time::Instant;

use dynamics::PreparedMechanism;
use integrators::{Ode, StepEnd, StepInfo};
use linalg::Matrix;
use model::{Mechanism, Reaction, Scratch, System};

use super::kept_rows::KeptRows;
use super::way::Drift;
use super::{Fault, Saddle, Solver};

/// Largest number of corrections of a projection. A few corrections are sufficient, because
/// Newton's method converges quadratically from the end of a step.
const CORRECTIONS: usize = 10;

/// A correction below this fraction of the size of the mechanism is a rounding error.
const SETTLED: f64 = 1e-13;

/// The equations of motion of a mechanism in one formulation.
pub struct Equations<'a> {
    mechanism: &'a Mechanism,
    s: Scratch,
    solver: Box<dyn Solver + 'a>,
    /// Independent rows of Φq and of C, for projections.
    positions: KeptRows,
    velocities: KeptRows,
    drift: Drift,
    at: Scaled,
    /// Number of evaluated right-hand sides, and of projected states.
    pub(super) evaluations: u64,
    pub(super) projections: u64,
    /// Time after which no more evaluations are performed.
    pub(super) deadline: Option<Instant>,
}

/// The saddle equations of an instant in units of the mechanism: lengths are divided by the size of
/// the mechanism.
struct Scaled {
    /// The unit of each coordinate, and the masses in these units, n_v each.
    units: Vec<f64>,
    mass: Vec<f64>,
    /// All rows of C; the holonomic rows are the rows of Φq.
    c: Matrix,
    /// On entry Q, on return the solution (accelerations or a correction), n_v.
    force: Vec<f64>,
    motion: Vec<f64>,
    /// Multipliers of all rows, followed by their right-hand sides.
    lambda: Vec<f64>,
    gamma: Vec<f64>,
}

impl Scaled {
    /// Solves for accelerations (or a correction) and multipliers.
    fn solve(&mut self, solver: &mut dyn Solver) -> Result<(), Fault> {
        let at = Saddle {
            c: &self.c,
            mass: &self.mass,
            force: &self.force,
            gamma: &self.gamma,
        };
        solver.solve(&at, &mut self.motion, &mut self.lambda)
    }

    /// Iterates over the solution in SI units.
    fn motion(&self) -> impl Iterator<Item = f64> + '_ {
        let of = |(x, unit): (&f64, &f64)| x * unit;
        self.motion.iter().zip(&self.units).map(of)
    }
}

/// Computes C at a configuration in units of the mechanism: lengths are divided by the size of the
/// mechanism.
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
    /// Creates the equations; `solver` is constructed from C and M at the initial state, in units
    /// of the mechanism.
    ///
    /// # Errors
    /// Returns the error of the solver.
    pub fn new(
        prepared: &'a PreparedMechanism,
        drift: Drift,
        solver: impl FnOnce(&Matrix, &[f64]) -> Result<Box<dyn Solver + 'a>, Fault>,
    ) -> Result<Self, Fault> {
        let mechanism = &prepared.mechanism;
        if let Some(armature) = mechanism.armatures().next() {
            let joint = armature.joint.to_owned();
            return Err(Fault::Armature { joint });
        }
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
            at: Scaled {
                units,
                mass,
                c,
                force: vec![0.0; n],
                motion: vec![0.0; n],
                lambda: vec![0.0; m],
                gamma: vec![0.0; m],
            },
            evaluations: 0,
            projections: 0,
            deadline: None,
        })
    }

    /// Returns the mechanism.
    pub(super) fn mechanism(&self) -> &'a Mechanism {
        self.mechanism
    }

    /// Returns the numbers n_q of coordinates and n_v of velocities.
    pub(super) fn sizes(&self) -> [usize; 2] {
        [self.mechanism.layout().n_q, self.mechanism.layout().n_v]
    }

    /// Computes the accelerations in `a` and the multipliers of all rows in `self.lambda`.
    ///
    /// # Errors
    /// Returns the errors of the solver, and [`Fault::TooLong`].
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> Result<(), Fault> {
        let (mechanism, s, at) = (self.mechanism, &mut self.s, &mut self.at);
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
        at.gamma.copy_from_slice(&s.gamma);
        if let Drift::Baumgarte { alpha, beta } = self.drift {
            mechanism.b(s);
            mechanism.phi(s);
            for (i, gamma) in at.gamma.iter_mut().enumerate() {
                let rate = mechanism.layout().velocity_residual(s, i, v);
                *gamma -= match s.phi.get(i) {
                    Some(phi) => 2.0 * alpha * rate + beta * beta * phi,
                    None => alpha * rate,
                };
            }
        }
        in_units(mechanism, s, &at.units, &mut at.c);
        for ((scaled, f), unit) in at.force.iter_mut().zip(&s.force).zip(&at.units) {
            *scaled = f * unit;
        }
        at.solve(&mut *self.solver)?;
        for (a, found) in a.iter_mut().zip(at.motion()) {
            *a = found;
        }
        if a.iter().all(|a| a.is_finite()) {
            Ok(())
        } else {
            Err(Fault::NotFinite { time: t })
        }
    }

    /// Returns accelerations, and reactions of all joints and drives, at a state. The method
    /// allocates memory.
    ///
    /// # Errors
    /// Returns the errors of [`Equations::accelerate`].
    pub fn observe(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<(Vec<f64>, Vec<Reaction>), Fault> {
        let mut a = vec![0.0; v.len()];
        self.accelerate(t, q, v, &mut a)?;
        let reactions = self.mechanism.reactions(&self.s);
        let of = |id| reactions.reaction(id, &self.at.lambda);
        let ids = self.mechanism.layout().constraint_ids();
        Ok((a, ids.map(of).collect()))
    }

    /// Corrects q and v so that they satisfy the constraints. No other corrections are smaller in
    /// the mass metric.
    ///
    /// # Errors
    /// [`Fault::Projection`], or an error of the independent rows.
    pub fn project(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<(), Fault> {
        self.projections += 1;
        let (mechanism, mut before) = (self.mechanism, f64::INFINITY);
        for correction in 0.. {
            let s = &mut self.s;
            mechanism.pose(t, q, s);
            mechanism.phi(s);
            mechanism.c(s);
            self.at.gamma.fill(0.0);
            for (gamma, phi) in self.at.gamma.iter_mut().zip(&s.phi) {
                *gamma = -phi;
            }
            let size = self.correct(true)?;
            let d: Vec<f64> = self.at.motion().collect();
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

    /// Projects only the velocities.
    fn project_velocity(&mut self, t: f64, q: &[f64], v: &mut [f64]) -> Result<(), Fault> {
        let (mechanism, s) = (self.mechanism, &mut self.s);
        mechanism.pose(t, q, s);
        mechanism.c(s);
        mechanism.b(s);
        for (i, gamma) in self.at.gamma.iter_mut().enumerate() {
            *gamma = -mechanism.layout().velocity_residual(s, i, v);
        }
        self.correct(false)?;
        for (v, d) in v.iter_mut().zip(self.at.motion()) {
            *v += d;
        }
        Ok(())
    }

    /// Computes the smallest correction that changes the rows by γ; returns its largest component,
    /// in units of the mechanism.
    fn correct(&mut self, of_positions: bool) -> Result<f64, Fault> {
        let at = &mut self.at;
        in_units(self.mechanism, &self.s, &at.units, &mut at.c);
        at.force.fill(0.0);
        at.solve(if of_positions {
            &mut self.positions
        } else {
            &mut self.velocities
        })?;
        Ok(at.motion.iter().fold(0.0, |a: f64, d| a.max(d.abs())))
    }

    /// Ends a step with a projection, if states are projected. Returns whether it projected.
    ///
    /// # Errors
    /// Returns the errors of [`Equations::project`].
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

    /// If the prescribed rates jump, an impulse of the constraints causes a jump of the velocities.
    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), Fault> {
        let (q, v) = y.split_at_mut(self.mechanism.layout().n_q);
        self.project_velocity(t, q, v)
    }
}
