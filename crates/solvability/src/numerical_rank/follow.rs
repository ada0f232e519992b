//! Computes how positions and velocities change with the data while some rows stay satisfied. Also
//! computes how these changes accumulate along a continuation path.
//!
//! If the rows `C_K·x = y` stay satisfied, x changes by `C_K⁺·y` with y. A gradient g with respect
//! to x has two parts: `λ = C_K⁺ᵀ·g` with respect to y, and `g − C_Kᵀ·λ` along the motions that the
//! rows leave free.
//!
//! A configuration at the end of a continuation depends on the data along the whole path. Each step
//! follows a velocity v that the kept rows allow, `C_K·v = 0`. This velocity changes by `δv =
//! −C_K⁺·δ(C_K·v)`, so that `δq⁺ = δq + δv`, with `Φ_K(q⁺) = 0`. Nonholonomic rows constrain only
//! velocities. Therefore changes along the path accumulate and are never corrected. A gradient with
//! respect to the last configuration is propagated backwards to the data and to the first
//! configuration.

use crate::limits::FOLLOWED;
use crate::pose::dimensionless;
use linalg::{Matrix, PivotedQr};
use model::{Mechanism, Scratch, System};

/// Scaled independent rows that stay satisfied.
pub(super) struct FollowedRows {
    /// Rows of the mechanism, each with the factor to its scaled form.
    rows: Vec<(usize, f64)>,
    /// Factor of each column to its scaled form.
    columns: Vec<f64>,
    qr: PivotedQr,
}

impl FollowedRows {
    /// Creates the rows from factored rows of a scaled C.
    pub(super) fn new(qr: PivotedQr, rows: Vec<(usize, f64)>, columns: Vec<f64>) -> Self {
        Self { rows, columns, qr }
    }

    /// Splits the derivatives of a function with respect to the coordinates into two parts
    /// (physical units). The first part contains the derivatives with respect to the values of the
    /// rows, one value for each of the `rows` rows of the mechanism. The second part is the
    /// derivative along the motions that the rows leave free.
    pub(super) fn split(&self, gradient: &[f64], rows: usize) -> (Vec<f64>, Vec<f64>) {
        let mut answer: Vec<f64> = gradient
            .iter()
            .zip(&self.columns)
            .map(|(g, f)| g * f)
            .collect();
        self.qr.q_transpose_mul(&mut answer);
        let mut w = answer[..self.rows.len()].to_vec();
        self.qr.solve_r(&mut w);
        let mut lambda = vec![0.0; rows];
        for (w, &k) in w.iter().zip(self.qr.permutation()) {
            let (row, factor) = self.rows[k];
            lambda[row] = w * factor;
        }
        answer[..self.rows.len()].fill(0.0);
        self.qr.q_mul(&mut answer);
        let free = answer
            .iter()
            .zip(&self.columns)
            .map(|(x, f)| x / f)
            .collect();
        (lambda, free)
    }

    /// Returns the smallest velocity by which the unscaled rows change by `y` (physical units).
    pub(super) fn answer(&self, y: &[f64]) -> Vec<f64> {
        let scaled = |&k: &usize| y[k] * self.rows[k].1;
        let mut x: Vec<f64> = self.qr.permutation().iter().map(scaled).collect();
        self.qr.solve_r_transpose(&mut x);
        x.resize(self.columns.len(), 0.0);
        self.qr.q_mul(&mut x);
        x.iter().zip(&self.columns).map(|(x, f)| x * f).collect()
    }

    /// Returns a matrix with the singular values of `C_K⁺·A`. Both factors are scaled.
    pub(super) fn through(&self, a: &Matrix) -> Matrix {
        let mut columns = a.select_rows(self.qr.permutation()).transpose();
        for j in 0..columns.nrows() {
            self.qr.solve_r_transpose(columns.row_mut(j));
        }
        columns
    }

    /// Returns the velocity closest to `v` that the rows allow.
    fn allowed(&self, v: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = v.iter().zip(&self.columns).map(|(v, f)| v / f).collect();
        self.qr.q_transpose_mul(&mut x);
        x[..self.rows.len()].fill(0.0);
        self.qr.q_mul(&mut x);
        x.iter().zip(&self.columns).map(|(x, f)| x * f).collect()
    }
}

/// One step of a continuation on nonholonomic rows.
pub(super) struct Step {
    /// Scratches at the start of the step and in the middle of the step.
    first: Scratch,
    middle: Scratch,
    /// Displacement (physical units).
    moved: Vec<f64>,
    /// The holonomic kept rows at the start of the step, and all kept rows in the middle.
    positions: FollowedRows,
    velocities: FollowedRows,
}

/// Numbers of substeps. The numbers are tried one after the other until two results agree.
const SUBSTEPS: [usize; 4] = [2, 4, 6, 8];

/// The mechanism and the kept rows of a continuation.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    pub(super) mechanism: &'a Mechanism,
    /// Kept rows of the mechanism.
    pub(super) kept: &'a [usize],
    /// Velocities with the dimensionless value 1.
    pub(super) units: &'a [f64],
    /// Size of the mechanism (m).
    pub(super) size: f64,
    pub(super) t: f64,
}

impl Ground<'_> {
    /// Returns the dimensionless C at a configuration.
    pub(super) fn at(&self, q: &[f64]) -> (Scratch, Matrix) {
        let s = crate::pose::evaluated(self.mechanism, self.t, q);
        let c = dimensionless(self.mechanism, &s, self.size);
        (s, c)
    }

    pub(super) fn followed(&self, c: &Matrix, rows: &[usize]) -> FollowedRows {
        let own = rows.iter().map(|&i| (i, 1.0)).collect();
        let factored = PivotedQr::of_rows(c.select_rows(rows));
        FollowedRows::new(factored, own, self.units.to_vec())
    }

    /// Returns the kept rows of Φ.
    pub(super) fn holonomic(&self) -> Vec<usize> {
        let m = self.mechanism.layout().m;
        self.kept.iter().copied().filter(|&i| i < m).collect()
    }

    /// Returns whether nonholonomic rows are kept. In this case, positions depend on the path.
    pub(super) fn is_led(&self) -> bool {
        self.kept.iter().any(|&i| i >= self.mechanism.layout().m)
    }

    /// Returns the configuration after a motion whose velocities satisfy all kept rows. At each
    /// point of the motion, the velocity is the allowed velocity closest to `moved`. Returns `None`
    /// if the velocities change too fast for the continuation.
    ///
    /// Source: the modified midpoint rule with extrapolation; E. Hairer, S. P. Nørsett, G. Wanner,
    /// Solving Ordinary Differential Equations I, section II.9 (1993).
    pub(super) fn flow(&self, q: &[f64], moved: Vec<f64>) -> Option<(Vec<f64>, Step)> {
        let velocity = |d: &[f64]| {
            let (_, c) = self.at(&self.mechanism.space().displaced(q, 1.0, d));
            self.followed(&c, self.kept).allowed(&moved)
        };
        let advanced = |d: &[f64], h: f64, v: &[f64]| -> Vec<f64> {
            d.iter().zip(v).map(|(d, v)| d + h * v).collect()
        };
        let start = vec![0.0; moved.len()];
        // One row of the Aitken-Neville scheme in the square of the substep.
        let mut row: Vec<Vec<f64>> = Vec::new();
        for (j, n) in SUBSTEPS.into_iter().enumerate() {
            let h = 1.0 / n as f64;
            let (mut last, mut d) = (start.clone(), advanced(&start, h, &velocity(&start)));
            for _ in 1..n {
                let next = advanced(&last, 2.0 * h, &velocity(&d));
                last = std::mem::replace(&mut d, next);
            }
            let mut next = vec![d];
            for (k, coarse) in row.iter().enumerate() {
                let ratio = n as f64 / SUBSTEPS[j - k - 1] as f64;
                let fine = &next[k];
                let gain = 1.0 / (ratio * ratio - 1.0);
                let better = fine.iter().zip(coarse).map(|(f, c)| f + gain * (f - c));
                next.push(better.collect());
            }
            row = next;
            let [.., before, best] = &row[..] else {
                continue;
            };
            let apart = best.iter().zip(before).zip(self.units);
            let apart = apart
                .map(|((a, b), unit)| ((a - b) / unit).abs())
                .fold(0.0, f64::max);
            if apart <= FOLLOWED * self.size {
                let there = self.mechanism.space().displaced(q, 1.0, best);
                return Some((there, self.step(q, moved)));
            }
        }
        None
    }

    fn step(&self, q: &[f64], moved: Vec<f64>) -> Step {
        let (first, c) = self.at(q);
        let positions = self.followed(&c, &self.holonomic());
        let (middle, c) = self.at(&self.mechanism.space().displaced(q, 0.5, &moved));
        let velocities = self.followed(&c, self.kept);
        Step {
            first,
            middle,
            moved,
            positions,
            velocities,
        }
    }
}

impl Step {
    /// Propagates a gradient backwards over the step. The given gradient is with respect to the
    /// configuration after the step, along the free motions at this configuration. The result is
    /// the gradient with respect to the configuration before the step. The effect of the data on
    /// the step is added to `data`.
    pub(super) fn carry_back(&self, mechanism: &Mechanism, pose: &mut Vec<f64>, data: &mut [f64]) {
        let rows = mechanism.layout().rows();
        let (lambda, _) = self.velocities.split(pose, rows);
        mechanism
            .data()
            .slopes(&self.middle)
            .add_power(&lambda, &self.moved, -1.0, data);
        let mut turned = vec![0.0; pose.len()];
        mechanism
            .data()
            .add_power_by_pose(&self.middle, &lambda, &self.moved, &mut turned);
        pose.iter_mut().zip(&turned).for_each(|(p, t)| *p -= t);
        let (lambda, free) = self.positions.split(pose, rows);
        let slopes = mechanism.data().slopes(&self.first);
        slopes.add_phi(&lambda, -1.0, data);
        *pose = free;
    }
}
