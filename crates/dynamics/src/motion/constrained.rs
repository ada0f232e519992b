//! The equations of motion with the kept constraints as equations of their own: what generalized-α asks for.
//! Not for methods that see accelerations only.
//!
//! It solves dense systems of n_v + r unknowns, `[A, C_Kᵀ; C_K, 0]`, in which masses may be zero, with the derivatives of the forces. Rows that are dependent for an instant are not left out here: the
//! projection at the end of the step and its monitors see to them.

use linalg::{Lu, Matrix};
use model::{Derivatives, System};

use super::KeptRowMotion;
use crate::counts::{Counted, note};
use crate::error::Trip;

/// Storage for these systems.
pub(crate) struct SaddlePoint {
    derivatives: Derivatives,
    /// The matrix; its last columns hold C_Kᵀ, its last rows C_K.
    matrix: Matrix,
    lu: Lu,
    /// Multipliers of all rows.
    lambda: Vec<f64>,
}

impl SaddlePoint {
    pub(crate) fn new(motion: &KeptRowMotion<'_>) -> Self {
        note(Counted::LinearSystems);
        let layout = motion.mechanism.layout();
        let n = layout.n_v + motion.velocity.kept.len();
        Self {
            derivatives: motion.mechanism.derivatives(),
            matrix: Matrix::zeros(n, n),
            lu: Lu::new(n),
            lambda: vec![0.0; layout.rows()],
        }
    }

    /// Residuals of `M·a + C_Kᵀ·λ_K = Q`, then Φ of the kept holonomic rows, then `C·v = b` of the others.
    pub(crate) fn residual(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        (a, lambda): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let mechanism = motion.mechanism;
        let (layout, n) = (mechanism.layout(), a.len());
        mechanism.pose(t, q, &mut motion.s);
        mechanism.phi(&mut motion.s);
        mechanism.c(&mut motion.s);
        motion.evaluate_b();
        mechanism.twist(v, &mut motion.s);
        mechanism.force(&mut motion.s);
        let (dynamics, rows) = out.split_at_mut(n);
        for (i, &m) in mechanism.mass().iter().enumerate() {
            dynamics[i] = m * a[i] - motion.s.force[i];
        }
        for ((&i, &l), r) in motion.velocity.kept.iter().zip(lambda).zip(rows) {
            for (column, c) in layout.row(&motion.s, i) {
                dynamics[column] += c * l;
            }
            *r = match i < layout.m {
                true => motion.s.phi[i],
                false => layout.velocity_residual(&motion.s, i, v),
            };
        }
    }

    /// Factors `[M + c_v·D + c_q·K, C_Kᵀ; C_K, 0]` with `D = −∂Q/∂v`, `K = ∂(Cᵀ·λ − Q)/∂q`.
    ///
    /// # Errors
    /// [`Trip::IterationMatrix`].
    pub(crate) fn linearise(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        (a, lambda): (&[f64], &[f64]),
        (c_v, c_q): (f64, f64),
    ) -> Result<(), Trip> {
        let (mechanism, n) = (motion.mechanism, a.len());
        mechanism.pose(t, q, &mut motion.s);
        mechanism.c(&mut motion.s);
        mechanism.twist(v, &mut motion.s);
        self.lambda.fill(0.0);
        for (&i, &l) in motion.velocity.kept.iter().zip(lambda) {
            self.lambda[i] = l;
        }
        mechanism.differentiate(a, &self.lambda, &motion.s, &mut self.derivatives);
        self.begin(motion);
        self.add_rows(motion, n);
        self.add_columns(motion, n);
        let d = &self.derivatives;
        let parts = [
            (&d.force_dv, -c_v),
            (&d.force_dq, -c_q),
            (&d.reaction_dq, c_q),
        ];
        for (part, weight) in parts {
            for (i, j, value) in part.iter() {
                self.matrix[(i, j)] += weight * value;
            }
        }
        self.factor(t).map_err(|trip| motion.named(trip))
    }

    /// Solves with the factors of [`SaddlePoint::linearise`].
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        self.lu.solve(x);
    }

    /// M, and nothing else yet.
    fn begin(&mut self, motion: &KeptRowMotion<'_>) {
        for i in 0..self.matrix.nrows() {
            self.matrix.row_mut(i).fill(0.0);
        }
        for (i, &m) in motion.mechanism.mass().iter().enumerate() {
            self.matrix[(i, i)] = m;
        }
    }

    /// C_K of the scratch as last rows.
    fn add_rows(&mut self, motion: &KeptRowMotion<'_>, n: usize) {
        let layout = motion.mechanism.layout();
        for (k, &i) in motion.velocity.kept.iter().enumerate() {
            for (column, c) in layout.row(&motion.s, i) {
                self.matrix[(n + k, column)] += c;
            }
        }
    }

    /// C_Kᵀ of the scratch as last columns.
    fn add_columns(&mut self, motion: &KeptRowMotion<'_>, n: usize) {
        let layout = motion.mechanism.layout();
        for (k, &i) in motion.velocity.kept.iter().enumerate() {
            for (column, c) in layout.row(&motion.s, i) {
                self.matrix[(column, n + k)] += c;
            }
        }
    }

    fn factor(&mut self, t: f64) -> Result<(), Trip> {
        let matrix = &self.matrix;
        let factored = self.lu.factor(|i, j| matrix[(i, j)]);
        factored.map_err(|source| match source.pivot.is_finite() {
            true => Trip::IterationMatrix { time: t, source },
            false => Trip::NotFinite {
                time: t,
                what: "the iteration matrix of the step".into(),
            },
        })
    }
}
