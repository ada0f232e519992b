//! The factorisation: choose the longest remaining column, reflect, downdate the norms.

use super::PivotedQr;
use crate::{Matrix, kernels};

/// A downdated norm is recomputed once cancellation has eaten half of its digits (√eps).
const DOWNDATE_LIMIT: f64 = 1.490_116_119_384_765_6e-8;

/// Remaining length of one column.
#[derive(Debug, Clone, Copy)]
struct Length {
    /// Downdated value.
    now: f64,
    /// Value when it was last computed from the entries.
    exact: f64,
}

/// What a factorisation needs beside the matrix itself; made once, used any number of times.
#[derive(Debug, Clone)]
pub(crate) struct Reflections {
    /// Factor of each Householder step.
    pub(crate) tau: Vec<f64>,
    /// Position k of `A·P` is column `permutation[k]` of A.
    pub(crate) permutation: Vec<usize>,
    lengths: Vec<Length>,
}

impl Reflections {
    /// Storage for m columns and at most so many steps.
    pub(crate) fn new(m: usize, steps: usize) -> Self {
        let none = Length {
            now: 0.0,
            exact: 0.0,
        };
        Self {
            tau: vec![0.0; steps],
            permutation: (0..m).collect(),
            lengths: vec![none; m],
        }
    }
}

/// Factors completely; the rows of `a` are the columns that are pivoted.
pub(super) fn factor(mut a: Matrix) -> PivotedQr {
    let mut reflections = Reflections::new(a.nrows(), a.nrows().min(a.ncols()));
    factor_above(f64::NEG_INFINITY, &mut a, &mut reflections);
    let Reflections {
        tau, permutation, ..
    } = reflections;
    PivotedQr {
        factors: a,
        tau,
        permutation,
    }
}

/// Factors in place as far as remaining columns are longer than `floor` and there is room for steps, and returns the number of
/// steps; what remains is left as it is. Allocates nothing.
pub(crate) fn factor_above(floor: f64, a: &mut Matrix, reflections: &mut Reflections) -> usize {
    let m = a.nrows();
    let Reflections {
        tau,
        permutation,
        lengths,
    } = reflections;
    for (j, (place, length)) in permutation.iter_mut().zip(&mut *lengths).enumerate() {
        *place = j;
        let exact = kernels::norm(a.row(j));
        *length = Length { now: exact, exact };
    }
    for k in 0..tau.len() {
        let pivot = longest(lengths, k);
        if lengths[pivot].now <= floor {
            return k;
        }
        a.swap_rows(k, pivot);
        permutation.swap(k, pivot);
        lengths.swap(k, pivot);

        tau[k] = reflect(&mut a.row_mut(k)[k..]);
        for j in k + 1..m {
            let (v, column) = a.two_rows_mut(k, j);
            apply(tau[k], &v[k..], &mut column[k..]);
            downdate(&mut lengths[j], &column[k..]);
        }
    }
    tau.len()
}

/// First index from `k` on with the largest length, so that ties do not reorder.
fn longest(lengths: &[Length], k: usize) -> usize {
    let mut best = k;
    for j in k + 1..lengths.len() {
        if lengths[j].now > lengths[best].now {
            best = j;
        }
    }
    best
}

/// Overwrites `x` by `[β, v_1, v_2, …]` with `H·x = β·e_0`, `H = I − τ·v·vᵀ`, `v_0 = 1`; returns τ.
/// A column that is already `[β, 0, …]` gets τ = 0, that is H = I.
pub(crate) fn reflect(x: &mut [f64]) -> f64 {
    let alpha = x[0];
    if kernels::max_abs(&x[1..]) == 0.0 {
        return 0.0;
    }
    let beta = -kernels::norm(x).copysign(alpha);
    let v_0 = alpha - beta;
    for v in &mut x[1..] {
        *v /= v_0;
    }
    x[0] = beta;
    v_0 / -beta
}

/// `y ← (I − τ·v·vᵀ)·y` with `v_0 = 1` (the stored entry 0 of `v` is R's).
pub(crate) fn apply(tau: f64, v: &[f64], y: &mut [f64]) {
    if tau == 0.0 {
        return;
    }
    let s = -tau * (y[0] + kernels::dot(&v[1..], &y[1..]));
    y[0] += s;
    kernels::axpy(s, &v[1..], &mut y[1..]);
}

/// Length of `column[1..]` from that of `column[0..]`, `ℓ² ← ℓ² − R_kj²`; recomputed when the
/// difference has lost half of its digits since the last exact value.
fn downdate(length: &mut Length, column: &[f64]) {
    if length.now == 0.0 {
        return;
    }
    let ratio = column[0].abs() / length.now;
    let left = ((1.0 - ratio) * (1.0 + ratio)).max(0.0);
    let against_exact = left * (length.now / length.exact).powi(2);
    if against_exact <= DOWNDATE_LIMIT {
        let exact = kernels::norm(&column[1..]);
        *length = Length { now: exact, exact };
    } else {
        length.now *= left.sqrt();
    }
}
