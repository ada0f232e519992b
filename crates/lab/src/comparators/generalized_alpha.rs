//! The generalized-α method of order 2, applied to the position constraints (index 3) with
//! independent rows. The parameter ρ∞ determines the damping of high frequencies.
//!
//! ```text
//! q1 = q0 + h·v0 + h²·((½ − β)·a0 + β·a1),   v1 = v0 + h·((1 − γ)·a0 + γ·a1)
//! (1 − α_m)·a1 + α_m·a0 = (1 − α_f)·v'1 + α_f·v'0
//! M·v'1 + Cᵀ·λ1 = Q(t1, q1, v1),   Φ(t1, q1) = 0,   C·v1 = b for rows that are not holonomic
//! ```
//!
//! The vector a is the acceleration at t + (α_m − α_f)·h; if the step size changes, a is converted
//! to the new time. Sources: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371–375, DOI
//! 10.1115/1.2900803; M. Arnold, O. Brüls, Multibody Syst. Dyn. 18 (2007) 185–202, DOI
//! 10.1007/s11044-007-9084-0.

use integrators::Ode;
use linalg::{Lu, Matrix};
use model::{Derivatives, ForceWithoutDerivatives, Mechanism, Scratch, System};

use super::Fault;
use super::equations::Equations;
use super::stepping::{Stepper, Trial};

/// The parameter ρ∞. In one step, an oscillation of infinite frequency is multiplied by this
/// factor.
const RHO: f64 = 0.8;
const ALPHA_M: f64 = (2.0 * RHO - 1.0) / (RHO + 1.0);
const ALPHA_F: f64 = RHO / (RHO + 1.0);
const GAMMA: f64 = 0.5 + ALPHA_F - ALPHA_M;
const BETA: f64 = 0.25 * (GAMMA + 0.5) * (GAMMA + 0.5);
/// The derivative ∂a1/∂v'1.
const SHARE: f64 = (1.0 - ALPHA_F) / (1.0 - ALPHA_M);

/// Local errors of q and v divided by h³·y''', by Taylor expansion with a = v'(t + (α_m − α_f)·h).
const LAG: f64 = ALPHA_F - ALPHA_M;
const OF_POSITION: f64 = BETA - 0.5 * LAG - 1.0 / 6.0;
const OF_VELOCITY: f64 = 1.0 / 12.0 - 0.5 * LAG * LAG;

/// Largest number of Newton iterations of a step.
const ITERATIONS: usize = 10;
/// Largest increment at which Newton's method may stop, relative to the tolerance. The value is
/// small because an error of Φ is multiplied by 1/h² in λ.
const PERMITTED: f64 = 1e-6;
/// Increments below this fraction of the state count as rounding errors.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

/// The state of the method at the end of a step.
#[derive(Clone, Default)]
struct Memory {
    a: Vec<f64>,
    vd: Vec<f64>,
    lambda: Vec<f64>,
}

/// One step of the method, with its memory.
pub(super) struct GeneralizedAlpha<'a> {
    mechanism: &'a Mechanism,
    s: Scratch,
    derivatives: Derivatives,
    /// Independent rows, and the number of holonomic rows among them. The holonomic rows are the
    /// rows of Φq.
    kept: Vec<usize>,
    matrix: Matrix,
    lu: Lu,
    from: Memory,
    to: Memory,
    /// Size of the last accepted step, the time derivative of a over this step, and y' at the start
    /// of this step.
    before: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// Derivative y' at both ends of the last trial.
    f0: Vec<f64>,
    f1: Vec<f64>,
    x: Vec<f64>,
}

impl<'a> GeneralizedAlpha<'a> {
    /// Creates the method; returns an error if a force calls a function without derivatives.
    pub(super) fn new(
        mechanism: &'a Mechanism,
        kept: &[usize],
    ) -> Result<Self, ForceWithoutDerivatives> {
        let (layout, r) = (mechanism.layout(), kept.len());
        let n = layout.n_v + r;
        let memory = Memory {
            a: vec![0.0; layout.n_v],
            vd: vec![0.0; layout.n_v],
            lambda: vec![0.0; r],
        };
        Ok(Self {
            mechanism,
            s: mechanism.scratch(),
            derivatives: Derivatives::of(mechanism)?,
            kept: kept.to_vec(),
            matrix: Matrix::zeros(n, n),
            lu: Lu::new(n),
            from: memory.clone(),
            to: memory,
            before: None,
            f0: vec![0.0; layout.n_q + layout.n_v],
            f1: vec![0.0; layout.n_q + layout.n_v],
            x: vec![0.0; n],
        })
    }

    /// Computes positions, velocities and a at the end of the step from v' at the end of the step.
    fn move_to_end(&mut self, trial: &Trial<'_>, a0: &[f64], y1: &mut [f64]) {
        let (h, n_q) = (trial.h, self.mechanism.layout().n_q);
        let (q0, v0) = trial.y0.split_at(n_q);
        let (q1, v1) = y1.split_at_mut(n_q);
        let mut d = vec![0.0; v0.len()];
        for i in 0..v0.len() {
            let vd = (1.0 - ALPHA_F) * self.to.vd[i] + ALPHA_F * self.from.vd[i];
            let a1 = (vd - ALPHA_M * a0[i]) / (1.0 - ALPHA_M);
            self.to.a[i] = a1;
            d[i] = h * (v0[i] + h * ((0.5 - BETA) * a0[i] + BETA * a1));
            v1[i] = v0[i] + h * ((1.0 - GAMMA) * a0[i] + GAMMA * a1);
        }
        q1.copy_from_slice(q0);
        self.mechanism.displace(q1, &d);
    }

    /// Factors `[M + c_v·D + c_q·K, C_Kᵀ; C_K, 0]` with `D = −∂Q/∂v`, `K = ∂(Cᵀ·λ − Q)/∂q`.
    fn factor(&mut self, t: f64, y: &[f64], [c_v, c_q]: [f64; 2]) -> Result<(), Fault> {
        let (mechanism, layout) = (self.mechanism, self.mechanism.layout());
        let (n, (q, v)) = (layout.n_v, y.split_at(layout.n_q));
        mechanism.pose(t, q, &mut self.s);
        mechanism.c(&mut self.s);
        mechanism.twist(v, &mut self.s);
        let mut lambda = vec![0.0; layout.rows()];
        for (&i, l) in self.kept.iter().zip(&self.to.lambda) {
            lambda[i] = *l;
        }
        self.derivatives
            .differentiate(mechanism, &self.to.vd, &lambda, &self.s);
        self.matrix.as_mut_slice().fill(0.0);
        for (i, m) in mechanism.mass().iter().enumerate() {
            self.matrix[(i, i)] = *m;
        }
        for (inertia, columns, values) in mechanism.inertia(&self.s).added().rows() {
            for (&i, a) in columns.iter().zip(values) {
                for (&j, b) in columns.iter().zip(values) {
                    self.matrix[(i, j)] += inertia * a * b;
                }
            }
        }
        for (k, &i) in self.kept.iter().enumerate() {
            for (column, c) in layout.row(&self.s, i) {
                self.matrix[(n + k, column)] += c;
                self.matrix[(column, n + k)] += c;
            }
        }
        let d = &self.derivatives;
        let parts = [
            (&d.force_dv, -c_v),
            (&d.force_dq, -c_q),
            (&d.armature_dv, -c_v),
            (&d.armature_dq, -c_q),
            (&d.reaction_dq, c_q),
        ];
        for (part, weight) in parts {
            for (i, j, value) in part.iter() {
                self.matrix[(i, j)] += weight * value;
            }
        }
        let matrix = &self.matrix;
        let factored = self.lu.factor(|i, j| matrix[(i, j)]);
        factored.map_err(|_| Fault::Newton)
    }

    /// Computes the negative residuals. The residual of a constraint row is divided by the factor
    /// by which a change of v'1 changes the row.
    fn residual(&mut self, t: f64, y: &[f64], [c_v, c_q]: [f64; 2]) {
        let (mechanism, layout) = (self.mechanism, self.mechanism.layout());
        let (n, (q, v)) = (layout.n_v, y.split_at(layout.n_q));
        mechanism.pose(t, q, &mut self.s);
        mechanism.phi(&mut self.s);
        mechanism.c(&mut self.s);
        mechanism.b(&mut self.s);
        mechanism.twist(v, &mut self.s);
        mechanism.force(&mut self.s);
        let inertia = mechanism.inertia(&self.s).product(&self.to.vd);
        for (i, inertia) in inertia.into_iter().enumerate() {
            self.x[i] = self.s.force[i] - inertia;
        }
        for (k, (&i, l)) in self.kept.iter().zip(&self.to.lambda).enumerate() {
            for (column, c) in layout.row(&self.s, i) {
                self.x[column] -= c * l;
            }
            self.x[n + k] = match self.s.phi.get(i) {
                Some(phi) => -phi / c_q,
                None => -layout.velocity_residual(&self.s, i, v) / c_v,
            };
        }
    }
}

impl Stepper for GeneralizedAlpha<'_> {
    fn restart(&mut self) {
        self.before = None;
        self.from.lambda.fill(0.0);
    }

    fn step(
        &mut self,
        ode: &mut Equations<'_>,
        trial: &Trial<'_>,
        y1: &mut [f64],
    ) -> Result<f64, Fault> {
        let (h, n_q, n_v) = (trial.h, self.mechanism.layout().n_q, self.to.vd.len());
        let (c, t1) = ([h * GAMMA * SHARE, h * h * BETA * SHARE], trial.time(1.0));
        let a0 = match &self.before {
            Some((h_before, jerk, _)) => {
                for i in 0..n_v {
                    self.to.vd[i] = self.from.vd[i] + h * jerk[i];
                }
                let moved = self.from.a.iter().zip(jerk);
                moved
                    .map(|(a, jerk)| a - LAG * (h - h_before) * jerk)
                    .collect()
            }
            None => {
                self.from.vd.copy_from_slice(&trial.f0[n_q..]);
                self.to.vd.copy_from_slice(&trial.f0[n_q..]);
                trial.f0[n_q..].to_vec()
            }
        };
        self.to.lambda.copy_from_slice(&self.from.lambda);
        self.f0.copy_from_slice(trial.f0);
        self.move_to_end(trial, &a0, y1);
        self.factor(t1, y1, c)?;
        let (mut iterations, mut before) = (0, f64::INFINITY);
        loop {
            self.residual(t1, y1, c);
            self.lu.solve(&mut self.x);
            for (vd, x) in self.to.vd.iter_mut().zip(&self.x) {
                *vd += x;
            }
            for (l, x) in self.to.lambda.iter_mut().zip(&self.x[n_v..]) {
                *l += x;
            }
            self.move_to_end(trial, &a0, y1);
            // The change by the increment is compared with the tolerance and with the rounding
            // error of the largest coordinate.
            let largest = y1.iter().fold(1.0, |a: f64, y| a.max(y.abs()));
            let of = |c: f64| {
                self.x[..n_v]
                    .iter()
                    .fold(0.0, |a: f64, x| a.max((c * x).abs()))
            };
            let size = of(c[1]).max(of(c[0]) * (c[1] / c[0]).min(1.0)) / largest;
            iterations += 1;
            let is_noise = size >= before && before <= 1e3 * ROUNDING;
            if size <= (PERMITTED * trial.tolerance).max(ROUNDING) || is_noise {
                break;
            }
            if iterations == ITERATIONS || !size.is_finite() {
                return Err(Fault::Newton);
            }
            before = size;
        }
        // The error is C·h³·y'''. It is computed from y' at both ends of the step and at a third
        // time: the start of the previous step, or the midpoint.
        ode.rhs(t1, y1, &mut self.f1)?;
        let mut third = vec![0.0; y1.len()];
        if let Some((h_before, _, f_before)) = &self.before {
            for (i, d) in third.iter_mut().enumerate() {
                let slope = (self.f1[i] - trial.f0[i]) / h;
                let slope_before = (trial.f0[i] - f_before[i]) / h_before;
                *d = 2.0 * (slope - slope_before) / (h + h_before);
            }
        } else {
            let y = trial.y0.iter().zip(trial.f0).zip(&self.f1);
            let middle: Vec<f64> = y
                .map(|((y, f0), f1)| y + h * (0.375 * f0 + 0.125 * f1))
                .collect();
            ode.rhs(trial.time(0.5), &middle, &mut third)?;
            for (i, d) in third.iter_mut().enumerate() {
                *d = 4.0 * (trial.f0[i] - 2.0 * *d + self.f1[i]) / (h * h);
            }
        }
        for (i, d) in third.iter_mut().enumerate() {
            *d *= h * h * h * if i < n_q { OF_POSITION } else { OF_VELOCITY };
        }
        Ok(trial.norm(&third, y1))
    }

    /// This is the step size rule for a method of order 2 with an error estimate of order 2.
    fn next_size(&mut self, h: f64, error: f64, is_accepted: bool) -> f64 {
        if is_accepted {
            let slopes = self.to.vd.iter().zip(&self.from.vd);
            let jerk = slopes.map(|(to, from)| (to - from) / h).collect();
            self.before = Some((h, jerk, self.f0.clone()));
            std::mem::swap(&mut self.from, &mut self.to);
        }
        let factor = 0.9 * error.max(f64::MIN_POSITIVE).powf(-1.0 / 3.0);
        h * factor.clamp(0.2, if is_accepted { 3.0 } else { 0.9 })
    }
}
