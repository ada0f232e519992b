//! Small constrained problems with known solutions, and steps of a size that nobody controls, for the tests of the methods.

use super::{Constrained, Linearisation, Sizes};
use crate::dense_implicit::lu::Lu;
use crate::interval::Interval;
use crate::method::{Method, Start, Stepper, Trial};
use crate::ode::Ode;
use crate::options::Tolerance;
use crate::statistics::Statistics;
use std::convert::Infallible;
use thiserror::Error;

/// A plane system with one constraint G·v = 0; the last component of its state is the work of f.
pub(crate) trait System {
    const SIZES: Sizes;
    fn mass(&self) -> &[f64];
    fn force(&self, q: &[f64]) -> Vec<f64>;
    fn row(&self, q: &[f64]) -> Vec<f64>;
    /// −G'·v.
    fn gamma(&self, q: &[f64], v: &[f64]) -> f64;
    /// Φ, or G·v if there is no Φ.
    fn constraint(&self, q: &[f64], v: &[f64]) -> f64;
    /// ∂(Gᵀ·λ − f)/∂q, entry (i, j).
    fn stiffness(&self, q: &[f64], lambda: f64, i: usize, j: usize) -> f64;
}

/// Point mass on a massless rod of length 1, period 2 for the amplitude π/2: the problem of the SUNDIALS examples. q = (x, y).
pub(crate) struct Pendulum;

/// Gravity, (2·K(1/2))².
pub(crate) const G: f64 = 13.750_371_636_040_746;
/// (x, y, x', y') at t = 1/4 from (1, 0, 0, 0), from elliptic functions (24 digits are known).
pub(crate) const PENDULUM_QUARTER: [f64; 4] = [
    0.910_179_721_124_454_7,
    -0.414_213_562_373_095_1,
    -1.398_004_881_615_590_6,
    -3.071_931_507_962_991_6,
];

impl System for Pendulum {
    const SIZES: Sizes = Sizes {
        positions: 2,
        velocities: 2,
        holonomic: 1,
        nonholonomic: 0,
    };

    fn mass(&self) -> &[f64] {
        &[1.0, 1.0]
    }
    fn force(&self, _q: &[f64]) -> Vec<f64> {
        vec![0.0, -G]
    }
    fn row(&self, q: &[f64]) -> Vec<f64> {
        q.to_vec()
    }
    fn gamma(&self, _q: &[f64], v: &[f64]) -> f64 {
        -(v[0] * v[0] + v[1] * v[1])
    }
    fn constraint(&self, q: &[f64], _v: &[f64]) -> f64 {
        0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)
    }
    fn stiffness(&self, _q: &[f64], lambda: f64, i: usize, j: usize) -> f64 {
        if i == j { lambda } else { 0.0 }
    }
}

/// A skate on a plane of 30° with angular velocity ½ (Neimark, Fufaev; Bloch, ch. 1): q = (x, y, φ), x down the slope,
/// x = k·sin²(t/2), y = k·(t − sin t)/2 with k = 2·g·sin 30°.
pub(crate) struct KnifeEdge;

/// State of the skate at time t, without the work.
pub(crate) fn knife_edge_at(t: f64) -> [f64; 6] {
    let k: f64 = 9.81;
    let (sin, cos) = t.sin_cos();
    [
        k * (0.5 * t).sin().powi(2),
        k * 0.5 * (t - sin),
        0.5 * t,
        0.5 * k * sin,
        0.5 * k * (1.0 - cos),
        0.5,
    ]
}

impl System for KnifeEdge {
    const SIZES: Sizes = Sizes {
        positions: 3,
        velocities: 3,
        holonomic: 0,
        nonholonomic: 1,
    };

    fn mass(&self) -> &[f64] {
        &[2.0, 2.0, 0.3]
    }
    fn force(&self, _q: &[f64]) -> Vec<f64> {
        vec![9.81, 0.0, 0.0]
    }
    fn row(&self, q: &[f64]) -> Vec<f64> {
        vec![q[2].sin(), -q[2].cos(), 0.0]
    }
    fn gamma(&self, q: &[f64], v: &[f64]) -> f64 {
        -(q[2].cos() * v[0] + q[2].sin() * v[1]) * v[2]
    }
    fn constraint(&self, q: &[f64], v: &[f64]) -> f64 {
        q[2].sin() * v[0] - q[2].cos() * v[1]
    }
    fn stiffness(&self, q: &[f64], lambda: f64, i: usize, j: usize) -> f64 {
        match (i, j) {
            (0, 2) => lambda * q[2].cos(),
            (1, 2) => lambda * q[2].sin(),
            _ => 0.0,
        }
    }
}

/// A mass of 1 on a spring of stiffness k, kept on the x-axis.
pub(crate) struct Oscillator {
    pub(crate) k: f64,
}

impl System for Oscillator {
    const SIZES: Sizes = Pendulum::SIZES;

    fn mass(&self) -> &[f64] {
        &[1.0, 1.0]
    }
    fn force(&self, q: &[f64]) -> Vec<f64> {
        vec![-self.k * q[0], 0.0]
    }
    fn row(&self, _q: &[f64]) -> Vec<f64> {
        vec![0.0, 1.0]
    }
    fn gamma(&self, _q: &[f64], _v: &[f64]) -> f64 {
        0.0
    }
    fn constraint(&self, q: &[f64], _v: &[f64]) -> f64 {
        q[1]
    }
    fn stiffness(&self, _q: &[f64], _lambda: f64, i: usize, j: usize) -> f64 {
        if i == 0 && j == 0 { self.k } else { 0.0 }
    }
}

/// Only a factorisation can fail.
#[derive(Debug, Error)]
#[error("no pivot in column {0}")]
pub(crate) struct Singular(usize);

/// A [`System`] as a problem, with dense matrices.
pub(crate) struct Problem<S> {
    pub(crate) system: S,
    lu: Lu<f64>,
}

impl<S: System> Problem<S> {
    pub(crate) fn new(system: S) -> Self {
        let n = S::SIZES.velocities + 1;
        Self {
            system,
            lu: Lu::new(n),
        }
    }

    /// Solves [M, Gᵀ; G, 0]·x = x.
    fn accelerations(&mut self, row: &[f64], x: &mut [f64]) -> Result<(), Singular> {
        let (n, m) = (S::SIZES.velocities, self.system.mass());
        self.lu
            .factor(|i, j| match (i < n, j < n) {
                (true, true) if i == j => m[i],
                (true, false) => row[i],
                (false, true) => row[j],
                _ => 0.0,
            })
            .map_err(Singular)?;
        self.lu.solve(x);
        Ok(())
    }

    fn write(&self, y: &[f64], x: &[f64], dy: &mut [f64]) {
        let n = S::SIZES.velocities;
        let (q, v) = (&y[..n], &y[n..2 * n]);
        dy[..n].copy_from_slice(v);
        dy[n..2 * n].copy_from_slice(&x[..n]);
        dy[2 * n] = dot(&self.system.force(q), v);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<S: System> Ode for Problem<S> {
    type Error = Singular;

    fn dim(&self) -> usize {
        2 * S::SIZES.velocities + 1
    }

    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Singular> {
        let (q, rest) = y.split_at(S::SIZES.positions);
        let v = &rest[..S::SIZES.velocities];
        let mut x = self.system.force(q);
        x.push(self.system.gamma(q, v));
        let row = self.system.row(q);
        self.accelerations(&row, &mut x)?;
        self.write(y, &x, dy);
        Ok(())
    }
}

impl<S: System> Constrained for Problem<S> {
    fn sizes(&self) -> Sizes {
        S::SIZES
    }

    fn displace(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        for (out, (q, d)) in out.iter_mut().zip(q.iter().zip(d)) {
            *out = q + d;
        }
    }

    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        a: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Singular> {
        let n = S::SIZES.velocities;
        let (q, v) = (&y[..n], &y[n..2 * n]);
        let (row, m, f) = (self.system.row(q), self.system.mass(), self.system.force(q));
        for i in 0..n {
            out[i] = m[i] * a[i] + row[i] * lambda[0] - f[i];
        }
        out[n] = self.system.constraint(q, v);
        Ok(())
    }

    fn factor(&mut self, point: &Linearisation<'_>) -> Result<(), Singular> {
        let n = S::SIZES.velocities;
        let (system, q) = (&self.system, &point.y[..n]);
        let (row, m) = (system.row(q), system.mass());
        self.lu
            .factor(|i, j| match (i < n, j < n) {
                (true, true) => {
                    let mass = if i == j { m[i] } else { 0.0 };
                    mass + point.c_q * system.stiffness(q, point.lambda[0], i, j)
                }
                (true, false) => row[i],
                (false, true) => row[j],
                (false, false) => 0.0,
            })
            .map_err(Singular)
    }

    fn solve(&mut self, x: &mut [f64]) {
        self.lu.solve(x);
    }
}

/// Steps of sizes that the caller chooses.
pub(crate) struct FixedSteps<O, S> {
    pub(crate) ode: O,
    pub(crate) stepper: S,
    pub(crate) t: f64,
    pub(crate) y: Vec<f64>,
    f: Vec<f64>,
}

impl<O: Ode, S: Stepper<O>> FixedSteps<O, S> {
    pub(crate) fn new(mut ode: O, mut stepper: S, y: &[f64]) -> Self {
        let mut f = vec![0.0; y.len()];
        ode.rhs(0.0, y, &mut f).expect("regular");
        stepper.restart();
        Self {
            ode,
            stepper,
            t: 0.0,
            y: y.to_vec(),
            f,
        }
    }

    /// One step of size h at full accuracy; returns its estimated error, relative to 1.
    pub(crate) fn step(&mut self, h: f64) -> f64 {
        let t = self.t;
        let legs = Interval::new(t, t + h)
            .legs::<Infallible>()
            .expect("finite");
        let trial = Trial {
            leg: &legs[0],
            t,
            h,
            t1: t + h,
        };
        let tolerance = Tolerance::Uniform {
            rtol: 1e-9,
            atol: 1e-9,
        };
        let start = Start {
            y0: &self.y,
            f0: &self.f,
            tolerance: &tolerance,
        };
        let (mut y1, mut f1, ones) = (self.y.clone(), self.f.clone(), vec![1.0; self.y.len()]);
        let (stepper, ode, statistics) =
            (&mut self.stepper, &mut self.ode, &mut Statistics::default());
        stepper
            .trial(ode, &trial, &start, &mut y1, statistics)
            .expect("smooth");
        let error = stepper
            .error_norm(ode, &trial, &start, &ones, statistics)
            .expect("smooth");
        stepper
            .end_derivative(ode, &trial, &y1, &mut f1, statistics)
            .expect("smooth");
        stepper.after_acceptance(h, 0.5);
        (self.t, self.y, self.f) = (t + h, y1, f1);
        error
    }
}

/// Largest absolute difference of the components that both have.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// Largest values over a run with n steps.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Largest {
    /// Error at the end.
    pub(crate) error: f64,
    /// Estimate of a step.
    pub(crate) estimate: f64,
    /// |G·v|.
    pub(crate) velocity_residual: f64,
    /// |Φ|, or |G·v| if there is no Φ.
    pub(crate) residual: f64,
}

/// n steps of sizes in turn `1 − uneven` and `1 + uneven` times the mean to `t_end`.
pub(crate) fn run<S: System, M: Method<Problem<S>>>(
    method: &M,
    system: S,
    (y0, t_end, end): (&[f64], f64, &[f64]),
    n: u32,
    uneven: f64,
) -> Largest {
    let ode = Problem::new(system);
    let stepper = method.stepper(&ode);
    let mut steps = FixedSteps::new(ode, stepper, y0);
    let mut largest = Largest::default();
    for i in 0..n {
        let factor = if i % 2 == 0 {
            1.0 - uneven
        } else {
            1.0 + uneven
        };
        let estimate = steps.step(factor * t_end / f64::from(n));
        let (q, rest) = steps.y.split_at(S::SIZES.positions);
        let system = &steps.ode.system;
        let gv = dot(&system.row(q), &rest[..S::SIZES.velocities]);
        largest.estimate = largest.estimate.max(estimate);
        largest.velocity_residual = largest.velocity_residual.max(gv.abs());
        largest.residual = largest.residual.max(system.constraint(q, rest).abs());
    }
    largest.error = distance(&steps.y, end);
    largest
}

/// Orders of the error and of the estimate over runs with 20, 40, 80 and 160 steps agree with `claimed` within 0.2.
pub(crate) fn assert_orders(name: &str, claimed: [f64; 2], run: impl Fn(u32) -> Largest) {
    let runs = [20, 40, 80, 160].map(run);
    for pair in runs.windows(2) {
        let orders = [
            (pair[0].error / pair[1].error).log2(),
            (pair[0].estimate / pair[1].estimate).log2(),
        ];
        let agree = orders.iter().zip(claimed).all(|(o, c)| (o - c).abs() < 0.2);
        assert!(agree, "{name}: {orders:?} instead of {claimed:?}, {runs:?}");
    }
}

/// A run over an eighth of the pendulum's period: start, end time, end.
pub(crate) const PENDULUM: (&[f64], f64, &[f64]) =
    (&[1.0, 0.0, 0.0, 0.0, 0.0], 0.25, &PENDULUM_QUARTER);

/// The start of the skate.
pub(crate) const SKATE_START: [f64; 7] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
