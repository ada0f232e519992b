//! Computes the distance τ* of the data of a drawing from a lower rank. No change of the data by
//! less than τ* (m) makes a further row redundant, but a larger change may. This module also
//! determines whether a redundancy exists at all configurations of the mechanism or only at the
//! drawn configuration.
//!
//! A lower rank r' means that r' rows K are independent and the other rows D depend on them. With
//! `U = [−C_D·C_K⁺, I]` and the null space V of C_K, `Uᵀ·C·V` must be zero at all configurations of
//! a path that satisfies the independent rows. The same change of the data must make these entries
//! and `Uᵀ·Φ` zero at all configurations of the path. Gradients are finite differences.

use pfaff::linalg::{Matrix, small_svd};
use suite::numbers::Numbers;

use super::doubles::Doubles;
use super::minimax::{Bounds, Equation, least_change};

/// Number of configurations on each side, the distance between two configurations as a fraction of
/// the size, and the number of steps between two configurations.
const POSES: usize = 3;
const REACH: f64 = 0.05;
const STEPS: usize = 20;

/// A path ends if a step needs a correction of more than this fraction of the step, or if the
/// cosine of the change of direction is too small. A path also ends near a singular configuration,
/// at which it could continue on another branch: the smallest singular value of the independent
/// rows is then below this fraction of its initial value.
const CORRECTED: f64 = 0.3;
const TURNED: f64 = 0.9;
const REGULAR: f64 = 0.3;

/// Largest residual at which positions satisfy their constraints, as a fraction of the size.
const MET: f64 = 1e-12;

/// A violation or singular value on a path that is below this fraction of the size counts as a
/// rounding error.
const STAYS: f64 = 1e-8;

/// Step of finite differences (fraction of the size).
const STEP: f64 = 1e-5;

/// Number of left and right directions whose entries must be zero. Fewer equations give a smaller
/// lower bound, which is also valid.
const LEFT: usize = 1;
const RIGHT: usize = 3;

/// Bound of the second derivatives of the entries with respect to data, with lengths in units of
/// the size. The value allows for links as short as a tenth of the size, and for changes of all
/// data.
const CURVED: f64 = 100.0;

/// Number of refinements of the lower bound.
const REFINED: usize = 12;

/// A left direction counts as a combination of holonomic rows only if the weight of its
/// nonholonomic rows is below this value.
const HOLONOMIC: f64 = 1e-6;

/// Number of paths in random directions by which a redundancy is tested.
const WALKS: usize = 3;

impl Doubles {
    /// Returns τ* (m; angles times the size) for a rank one lower than `rank`, for the unchanged
    /// drawing.
    #[must_use]
    pub fn lower_rank_from(&self, rank: usize) -> Bounds {
        let never = Bounds {
            low: f64::INFINITY,
            high: f64::INFINITY,
        };
        let Some(lower) = rank.checked_sub(1) else {
            return never;
        };
        let c = self.c(&self.q, &self.data);
        let kept = independent_rows(&c, lower);
        let first = Candidate::new(&c, &kept);
        let mut equations = self.equations(&self.q, &kept, &first);
        let heading = first.right.first().cloned().unwrap_or_default();
        for q in self.walk(&kept, &heading) {
            let there = Candidate::new(&self.c(&q, &self.data), &kept);
            equations.extend(self.equations(&q, &kept, &there));
        }
        // No upper limit is set, although the first order is not valid for large changes.
        let Bounds { low, high } = least_change(&equations, MET);
        // The bound of the second-order terms is valid for changes up to s. A larger s gives a
        // smaller lower bound for the change, so a lower bound that is at least s is proved.
        let (mut s, mut proved) = (low.min(0.3 * self.size), 0.0_f64);
        for _ in 0..REFINED {
            let bound = least_change(&equations, CURVED * s / self.size).low;
            proved = proved.max(bound.min(s));
            if bound >= s {
                break;
            }
            s = (s * bound).sqrt();
        }
        Bounds { low: proved, high }
    }

    /// Whether the mechanism has this rank at all configurations that the independent rows allow.
    #[must_use]
    pub fn is_permanent(&self, rank: usize, seed: u64) -> bool {
        let c = self.c(&self.q, &self.data);
        let kept = independent_rows(&c, rank);
        let free = Candidate::new(&c, &kept).free;
        if free.is_empty() {
            return true;
        }
        let mut numbers = Numbers::new(seed);
        (0..WALKS).all(|_| {
            let mut heading = vec![0.0; self.q.len()];
            for direction in &free {
                let share = numbers.unit();
                heading
                    .iter_mut()
                    .zip(direction)
                    .for_each(|(h, d)| *h += share * d);
            }
            let poses = self.walk(&kept, &heading);
            !poses.is_empty() && poses.iter().all(|q| self.keeps(q, rank))
        })
    }

    /// Returns the size of the entries of some rows in an orthonormal basis of the left null space
    /// of C. Also returns the first-order change of this size if all data change within a tolerance
    /// (m) at constant rank.
    #[must_use]
    pub fn margin(&self, rank: usize, rows: &[usize], tolerance: f64) -> [f64; 2] {
        let holonomic: Vec<usize> = independent_rows(&self.c(&self.q, &self.data), rank);
        let holonomic: Vec<usize> = holonomic
            .into_iter()
            .filter(|&i| i < self.holonomic)
            .collect();
        let answer = pseudo_inverse(&self.c(&self.q, &self.data).select_rows(&holonomic));
        // Rows of the projector on the null space, which do not depend on the basis.
        let projector = |q: &[f64], d: &[f64]| {
            let svd = small_svd(&self.c(q, d));
            let m = self.rows();
            Matrix::from_fn(rows.len(), m, |a, j| {
                let known = (0..rank).map(|k| svd.u[(rows[a], k)] * svd.u[(j, k)]);
                f64::from(u8::from(rows[a] == j)) - known.sum::<f64>()
            })
        };
        let size = projector(&self.q, &self.data).frobenius_norm();
        let mut change = 0.0;
        for block in &self.blocks {
            for k in 0..block.count {
                let h = STEP * self.size;
                let moved = |sign: f64| {
                    let mut d = self.data.clone();
                    d[block.first + k] += sign * h * self.unit(block);
                    let phi = self.phi(&self.q, &d);
                    let here = self.phi(&self.q, &self.data);
                    let missed: Vec<f64> = holonomic.iter().map(|&i| here[i] - phi[i]).collect();
                    let mut q = self.q.clone();
                    self.step(&mut q, &answer.times(&missed));
                    projector(&q, &d)
                };
                let (plus, less) = (moved(1.0), moved(-1.0));
                let apart = plus.as_slice().iter().zip(less.as_slice());
                let apart: f64 = apart.map(|(a, b)| (a - b) * (a - b)).sum();
                change += apart.sqrt() / (2.0 * h) * tolerance;
            }
        }
        [size, change]
    }

    fn keeps(&self, q: &[f64], rank: usize) -> bool {
        let phi = self.phi(q, &self.data);
        let svd = small_svd(&self.c(q, &self.data));
        let next = svd.sigma.get(rank).copied().unwrap_or(0.0);
        phi.iter().all(|x| x.abs() <= STAYS * self.size) && next <= STAYS
    }

    /// Returns configurations on both sides of the initial configuration that satisfy the
    /// independent rows of Φ.
    fn walk(&self, kept: &[usize], heading: &[f64]) -> Vec<Vec<f64>> {
        let mut poses = Vec::new();
        let weakest = |q: &[f64]| {
            let c = self.c(q, &self.data).select_rows(kept);
            small_svd(&c).sigma.last().copied().unwrap_or(1.0)
        };
        let regular = REGULAR * weakest(&self.q);
        for sign in [1.0, -1.0] {
            let mut q = self.q.clone();
            let start = self.c(&q, &self.data).select_rows(kept);
            let heading = project_out(&start, heading);
            let mut heading: Vec<f64> = heading.iter().map(|x| sign * x).collect();
            'side: for _ in 0..POSES {
                for _ in 0..STEPS {
                    let advanced = self.advance(kept, &mut q, &mut heading);
                    if advanced.is_none() || weakest(&q) < regular {
                        break 'side;
                    }
                }
                poses.push(q.clone());
            }
        }
        poses
    }

    /// Performs one step along velocities that the independent rows allow, by the classical
    /// fourth-order method. This order is used because an error of the step in the nonholonomic
    /// rows cannot be corrected afterwards.
    fn advance(&self, kept: &[usize], q: &mut [f64], heading: &mut Vec<f64>) -> Option<()> {
        let allowed = |q: &[f64]| project_out(&self.c(q, &self.data).select_rows(kept), heading);
        let along = allowed(q);
        let largest = along.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        if largest.is_nan() || dot(&along, heading) < TURNED * norm(&along) * norm(heading) {
            return None;
        }
        let stride = REACH / STEPS as f64 * self.size / largest;
        let mut step: Vec<f64> = along.iter().map(|x| stride / 6.0 * x).collect();
        let mut slope = along.clone();
        for (share, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let mut there = q.to_vec();
            let part: Vec<f64> = slope.iter().map(|x| share * stride * x).collect();
            self.step(&mut there, &part);
            slope = allowed(&there);
            let sum = step.iter_mut().zip(&slope);
            sum.for_each(|(s, x)| *s += weight * stride / 6.0 * x);
        }
        self.step(q, &step);
        let holonomic: Vec<usize> = kept
            .iter()
            .copied()
            .filter(|&i| i < self.holonomic)
            .collect();
        for _ in 0..20 {
            let phi = self.phi(q, &self.data);
            let missed: Vec<f64> = holonomic.iter().map(|&i| -phi[i]).collect();
            if missed.iter().all(|x| x.abs() <= MET * self.size) {
                *heading = along;
                return Some(());
            }
            let c = self.c(q, &self.data).select_rows(&holonomic);
            let correction = pseudo_inverse(&c).times(&missed);
            if norm(&correction) > CORRECTED * norm(&step) {
                return None;
            }
            self.step(q, &correction);
        }
        None
    }

    /// Returns the equations for a lower rank at one configuration.
    fn equations(&self, q: &[f64], kept: &[usize], at: &Candidate) -> Vec<Equation> {
        let holonomic: Vec<usize> = kept
            .iter()
            .copied()
            .filter(|&i| i < self.holonomic)
            .collect();
        let answer = pseudo_inverse(&self.c(q, &self.data).select_rows(&holonomic));
        let left = &at.left[..at.left.len().min(LEFT)];
        let right = &at.right[..at.right.len().min(RIGHT)];
        let is_of_positions = |u: &[f64]| {
            let (own, others) = u.split_at(self.holonomic);
            norm(others) <= HOLONOMIC * norm(own)
        };
        let mut equations = Vec::new();
        let empty = vec![[0.0; 2]; self.blocks.len()];
        for (a, u) in left.iter().enumerate() {
            for b in 0..right.len() {
                let target = if a == b { at.sigma[a] } else { 0.0 };
                equations.push(Equation {
                    target: self.size * target,
                    parts: empty.clone(),
                });
            }
            if is_of_positions(u) {
                equations.push(Equation {
                    target: dot(&u[..self.holonomic], &self.phi(q, &self.data)),
                    parts: empty.clone(),
                });
            }
        }
        for (p, block) in self.blocks.iter().enumerate() {
            for k in 0..block.count {
                let h = STEP * self.size;
                let change = h * self.unit(block);
                let moved = |sign: f64| {
                    let mut d = self.data.clone();
                    d[block.first + k] += sign * change;
                    d
                };
                let data = [1.0, -1.0].map(moved);
                let phi = [0, 1].map(|k| self.phi(q, &data[k]));
                let by: Vec<f64> = (0..self.holonomic)
                    .map(|i| (phi[0][i] - phi[1][i]) / (2.0 * h))
                    .collect();
                let missed: Vec<f64> = holonomic.iter().map(|&i| -by[i]).collect();
                let follow = answer.times(&missed);
                let pose = |sign: f64| {
                    let mut q = q.to_vec();
                    let step: Vec<f64> = follow.iter().map(|x| sign * h * x).collect();
                    self.step(&mut q, &step);
                    q
                };
                let poses = [pose(1.0), pose(-1.0)];
                let rates: Vec<Vec<f64>> = right
                    .iter()
                    .map(|v| {
                        let [plus, less] = [0, 1].map(|s| self.power(&poses[s], &data[s], v));
                        let both = plus.iter().zip(&less);
                        both.map(|(p, l)| self.size * (p - l) / (2.0 * h)).collect()
                    })
                    .collect();
                let mut next = equations.iter_mut();
                for u in left {
                    for rate in &rates {
                        if let Some(equation) = next.next() {
                            equation.parts[p][k] = dot(u, rate);
                        }
                    }
                    if is_of_positions(u)
                        && let Some(equation) = next.next()
                    {
                        equation.parts[p][k] = dot(&u[..self.holonomic], &by);
                    }
                }
            }
        }
        equations
    }
}

/// A configuration with the rows that are independent for a lower rank.
struct Candidate {
    /// Combinations of rows: a redundant row minus the combination of independent rows that
    /// approximates it. The combination with the smallest value is last.
    left: Vec<Vec<f64>>,
    /// Motions that the independent rows allow, in the order of the size of `left·C` along them.
    right: Vec<Vec<f64>>,
    /// The product `left·C·right`.
    sigma: Vec<f64>,
    /// All motions that the independent rows allow.
    free: Vec<Vec<f64>>,
}

impl Candidate {
    fn new(c: &Matrix, kept: &[usize]) -> Self {
        let (m, n) = (c.nrows(), c.ncols());
        let own = c.select_rows(kept);
        let inverse = pseudo_inverse(&own);
        let free = complement(&own, n - kept.len());
        let mut rows = Vec::new();
        for i in (0..m).filter(|i| !kept.contains(i)) {
            // Row i is the sum of the independent rows with these weights.
            let weights = inverse.transpose_times(c.row(i));
            let mut u = vec![0.0; m];
            u[i] = 1.0;
            for (&k, w) in kept.iter().zip(&weights) {
                u[k] = -w;
            }
            let size = norm(&u);
            u.iter_mut().for_each(|x| *x /= size);
            rows.push(u);
        }
        let forces: Vec<Vec<f64>> = rows.iter().map(|u| c.transpose_times(u)).collect();
        let s = Matrix::from_fn(rows.len(), free.len(), |i, j| dot(&forces[i], &free[j]));
        let svd = small_svd(&s);
        let combine = |of: &[Vec<f64>], with: &Matrix, length: usize| -> Vec<Vec<f64>> {
            (0..svd.sigma.len())
                .map(|k| {
                    let mut sum = vec![0.0; length];
                    for (row, vector) in of.iter().enumerate() {
                        let weight = with[(row, k)];
                        sum.iter_mut()
                            .zip(vector)
                            .for_each(|(s, x)| *s += weight * x);
                    }
                    sum
                })
                .collect()
        };
        Self {
            left: combine(&rows, &svd.u, m),
            right: combine(&free, &svd.v, n),
            sigma: svd.sigma.clone(),
            free,
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Returns the indices of `rank` rows that are as independent as possible.
fn independent_rows(c: &Matrix, rank: usize) -> Vec<usize> {
    let mut rest: Vec<Vec<f64>> = (0..c.nrows()).map(|i| c.row(i).to_vec()).collect();
    let mut kept = Vec::new();
    for _ in 0..rank {
        let left = (0..rest.len()).filter(|i| !kept.contains(i));
        let Some(next) = left.max_by(|&i, &j| norm(&rest[i]).total_cmp(&norm(&rest[j]))) else {
            break;
        };
        kept.push(next);
        let size = norm(&rest[next]);
        let unit: Vec<f64> = rest[next].iter().map(|x| x / size).collect();
        for row in &mut rest {
            let share = dot(row, &unit);
            row.iter_mut().zip(&unit).for_each(|(x, u)| *x -= share * u);
        }
    }
    kept.sort_unstable();
    kept
}

/// Returns orthonormal vectors that are perpendicular to independent rows.
fn complement(rows: &Matrix, count: usize) -> Vec<Vec<f64>> {
    let n = rows.ncols();
    let units: Vec<Vec<f64>> = (0..n)
        .map(|j| {
            let mut unit = vec![0.0; n];
            unit[j] = 1.0;
            project_out(rows, &unit)
        })
        .collect();
    let projected = Matrix::from_fn(n, n, |i, j| units[i][j]);
    let chosen = independent_rows(&projected, count);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for k in chosen {
        let mut v = units[k].clone();
        // Two passes of orthogonalisation are enough.
        for _ in 0..2 {
            for b in &basis {
                let share = dot(&v, b);
                v.iter_mut().zip(b).for_each(|(x, b)| *x -= share * b);
            }
        }
        let size = norm(&v);
        basis.push(v.into_iter().map(|x| x / size).collect());
    }
    basis
}

/// Returns the component of a vector that is perpendicular to the rows.
fn project_out(rows: &Matrix, v: &[f64]) -> Vec<f64> {
    if rows.nrows() == 0 {
        return v.to_vec();
    }
    let svd = small_svd(rows);
    let mut v = v.to_vec();
    for _ in 0..2 {
        for k in (0..svd.sigma.len()).filter(|&k| svd.sigma[k] > 0.0) {
            let share: f64 = (0..v.len()).map(|j| svd.v[(j, k)] * v[j]).sum();
            (0..v.len()).for_each(|j| v[j] -= share * svd.v[(j, k)]);
        }
    }
    v
}

/// Returns C⁺ for independent rows; singular values that are rounding errors are omitted.
fn pseudo_inverse(rows: &Matrix) -> Matrix {
    const ROUNDING: f64 = 1e-13;
    let (m, n) = (rows.nrows(), rows.ncols());
    if m == 0 {
        return Matrix::zeros(n, 0);
    }
    let svd = small_svd(rows);
    let least = ROUNDING * svd.sigma.first().copied().unwrap_or(0.0);
    let mut inverse = Matrix::zeros(n, m);
    for k in (0..svd.sigma.len()).filter(|&k| svd.sigma[k] > least) {
        for i in 0..n {
            for j in 0..m {
                inverse[(i, j)] += svd.v[(i, k)] * svd.u[(j, k)] / svd.sigma[k];
            }
        }
    }
    inverse
}
