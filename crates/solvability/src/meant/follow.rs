//! How positions and velocities follow the data where some rows hold, and what that makes of the
//! way along a walk.
//!
//! Where rows `C_K·x = y` hold, x follows y by `C_K⁺·y`, and a gradient g by x becomes one by y,
//! `λ = C_K⁺ᵀ·g`, and one along the motions that the rows leave, `g − C_Kᵀ·λ`.
//!
//! A pose at the end of a walk follows the data along the whole way: each step goes along a
//! velocity v that the kept rows allow, `C_K·v = 0`, which changes by `δv = −C_K⁺·δ(C_K·v)`, so
//! that `δq⁺ = δq + δv`, with `Φ_K(q⁺) = 0`. Nonholonomic rows lead by velocities alone: of the
//! change that adds up they take nothing back. A gradient by the last pose is carried backwards to
//! the data and to the pose where the walk began.

use crate::limits::FOLLOWED;
use crate::pose::dimensionless;
use linalg::{Matrix, PivotedQr};
use model::{Mechanism, Scratch, System};

/// Rows that hold, independent and scaled.
pub(super) struct Followed {
    /// Of the mechanism, with the factor of each to its scaled form.
    rows: Vec<(usize, f64)>,
    /// Factor of each column to its scaled form.
    columns: Vec<f64>,
    qr: PivotedQr,
}

impl Followed {
    /// These rows of a scaled C.
    pub(super) fn new(scaled: &Matrix, rows: Vec<(usize, f64)>, columns: Vec<f64>) -> Self {
        let qr = PivotedQr::of_rows(scaled.clone());
        Self { rows, columns, qr }
    }

    /// A gradient by coordinates as one by what the rows ask for, a value for each of so many rows
    /// of the mechanism, and one along the motions that they leave (physical units).
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

    /// The velocity nearest to this one that the rows allow.
    fn allowed(&self, v: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = v.iter().zip(&self.columns).map(|(v, f)| v / f).collect();
        self.qr.q_transpose_mul(&mut x);
        x[..self.rows.len()].fill(0.0);
        self.qr.q_mul(&mut x);
        x.iter().zip(&self.columns).map(|(x, f)| x * f).collect()
    }
}

/// One step of a walk that nonholonomic rows lead.
pub(super) struct Step {
    /// Where it began, and its middle.
    first: Scratch,
    middle: Scratch,
    /// Along what (physical units).
    moved: Vec<f64>,
    /// The holonomic kept rows where it began, and all kept rows in the middle.
    positions: Followed,
    velocities: Followed,
}

/// Substeps of a step, one number after the other until they agree.
const SUBSTEPS: [usize; 4] = [2, 4, 6, 8];

/// What a walk is made on.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    pub(super) mechanism: &'a Mechanism,
    /// Kept rows of the mechanism.
    pub(super) kept: &'a [usize],
    /// Velocities that are one without dimensions.
    pub(super) units: &'a [f64],
    /// Size of the mechanism (m).
    pub(super) size: f64,
    pub(super) t: f64,
}

impl Ground<'_> {
    /// C without dimensions at a configuration.
    fn at(&self, q: &[f64]) -> (Scratch, Matrix) {
        let s = crate::pose::evaluated(self.mechanism, self.t, q);
        let c = dimensionless(self.mechanism, &s, self.size);
        (s, c)
    }

    fn followed(&self, c: &Matrix, rows: &[usize]) -> Followed {
        let own = rows.iter().map(|&i| (i, 1.0)).collect();
        Followed::new(&c.select_rows(rows), own, self.units.to_vec())
    }

    /// The kept rows of Φ.
    pub(super) fn holonomic(&self) -> Vec<usize> {
        let m = self.mechanism.layout().m;
        self.kept.iter().copied().filter(|&i| i < m).collect()
    }

    /// Whether velocities alone lead, of positions not implied by them.
    pub(super) fn is_led(&self) -> bool {
        self.kept.iter().any(|&i| i >= self.mechanism.layout().m)
    }

    /// Where velocities that all kept rows allow lead, those nearest to `moved` at each place.
    /// `None` if they change too fast to be followed.
    ///
    /// Source: the modified midpoint rule, extrapolated; E. Hairer, S. P. Nørsett, G. Wanner,
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
        // One row of the scheme of Aitken and Neville, in the square of the substep.
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
    /// A gradient by the pose after the step, along the motions that the rows leave there, becomes
    /// one by the pose before it; what the data make of the step is added to theirs.
    pub(super) fn carry_back(&self, mechanism: &Mechanism, pose: &mut Vec<f64>, data: &mut [f64]) {
        let rows = mechanism.layout().rows();
        let (lambda, _) = self.velocities.split(pose, rows);
        mechanism
            .data()
            .add_power(&self.middle, &lambda, &self.moved, -1.0, data);
        let mut turned = vec![0.0; pose.len()];
        mechanism
            .data()
            .add_power_by_pose(&self.middle, &lambda, &self.moved, &mut turned);
        pose.iter_mut().zip(&turned).for_each(|(p, t)| *p -= t);
        let (lambda, free) = self.positions.split(pose, rows);
        mechanism.data().add_phi(&self.first, &lambda, -1.0, data);
        *pose = free;
    }
}
