//! The factorisation: select the longest remaining column, reflect, and update the norms.

use super::PivotedQr;
use crate::limits::DOWNDATE_LIMIT;
use crate::{Matrix, kernels};

/// Length of the part of a column that is not yet factored.
#[derive(Debug, Clone, Copy)]
struct Length {
    /// The updated length.
    now: f64,
    /// The length at its last computation from the entries of the column.
    exact: f64,
}

impl Length {
    /// Returns the length of a column with these entries and one further entry of size `beside`.
    fn of(entries: &[f64], beside: f64) -> Self {
        let own = kernels::norm(entries);
        let exact = if beside == 0.0 {
            own
        } else {
            own.hypot(beside)
        };
        Self { now: exact, exact }
    }
}

/// Factors the whole matrix; the rows of `a` are the columns that are pivoted.
pub(super) fn factor(a: Matrix) -> PivotedQr {
    let steps = a.nrows().min(a.ncols());
    factor_leading(a, steps)
}

/// Factors as many columns as there are steps. The other rows then contain Qᵀ times the other
/// columns.
pub(super) fn factor_leading(a: Matrix, steps: usize) -> PivotedQr {
    let n = a.ncols();
    factor_with(a, steps, 0.0, |_, _| n)
}

/// Factors columns with δ·I below them. The storage of each column ends with zeros for these
/// entries. The entry δ of a column is in a separate row, which no other column affects before this
/// column is the pivot. The entry is therefore written only when its column becomes the pivot. The
/// entry is written into the first free row, where the reflections end.
pub(super) fn factor_damped(a: Matrix, damping: f64) -> PivotedQr {
    let (m, n) = (a.nrows(), a.ncols() - a.nrows());
    factor_with(a, m, damping, |k, column| {
        column[n + k] = damping;
        n + k + 1
    })
}

/// Performs the factorisation. When a column becomes the pivot number k, `begin` writes its missing
/// entry and returns the end of the column. Before that, the column has an entry of size `beside`
/// that is not stored in the matrix.
fn factor_with(
    a: Matrix,
    steps: usize,
    beside: f64,
    begin: impl Fn(usize, &mut [f64]) -> usize,
) -> PivotedQr {
    kernels::vectorised(
        #[inline(always)]
        || reflected(a, steps, beside, begin),
    )
}

#[inline(always)]
fn reflected(
    mut a: Matrix,
    steps: usize,
    beside: f64,
    begin: impl Fn(usize, &mut [f64]) -> usize,
) -> PivotedQr {
    let m = a.nrows();
    let (mut tau, mut permutation) = (vec![0.0; steps], Vec::from_iter(0..m));
    let mut lengths: Vec<Length> = (0..m).map(|j| Length::of(a.row(j), beside)).collect();
    for k in 0..steps {
        let pivot = longest(&lengths, k);
        a.swap_rows(k, pivot);
        permutation.swap(k, pivot);
        lengths.swap(k, pivot);

        let end = begin(k, a.row_mut(k));
        tau[k] = reflect(&mut a.row_mut(k)[k..end]);
        for j in k + 1..m {
            let (v, column) = a.two_rows_mut(k, j);
            apply(tau[k], &v[k..end], &mut column[k..end]);
            downdate(&mut lengths[j], &column[k..end], beside);
        }
    }
    PivotedQr {
        factors: a,
        tau,
        permutation,
    }
}

/// Returns the first index from `k` onwards with the largest length. Therefore equal lengths are
/// not reordered.
fn longest(lengths: &[Length], k: usize) -> usize {
    let mut best = k;
    for j in k + 1..lengths.len() {
        if lengths[j].now > lengths[best].now {
            best = j;
        }
    }
    best
}

/// Overwrites `x` by `[β, v_1, v_2, …]` and returns τ, with `H·x = β·e_0`, `H = I − τ·v·vᵀ` and
/// `v_0 = 1`. For a column that is already `[β, 0, …]`, τ = 0 and H = I.
#[inline(always)]
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

/// Computes `y ← (I − τ·v·vᵀ)·y` with `v_0 = 1`. The stored entry 0 of `v` belongs to R.
#[inline(always)]
pub(super) fn apply(tau: f64, v: &[f64], y: &mut [f64]) {
    if tau == 0.0 {
        return;
    }
    let s = -tau * (y[0] + kernels::dot(&v[1..], &y[1..]));
    // Sparse rows are orthogonal to most other rows.
    if s == 0.0 {
        return;
    }
    y[0] += s;
    kernels::axpy(s, &v[1..], &mut y[1..]);
}

/// Computes the length of `column[1..]` from the length of `column[0..]`: `ℓ² ← ℓ² − R_kj²`. The
/// length is recomputed if the difference has lost half of its digits since the last exact value.
fn downdate(length: &mut Length, column: &[f64], beside: f64) {
    if length.now == 0.0 || column[0] == 0.0 {
        return;
    }
    let ratio = column[0].abs() / length.now;
    let left = ((1.0 - ratio) * (1.0 + ratio)).max(0.0);
    let against_exact = left * (length.now / length.exact).powi(2);
    if against_exact <= DOWNDATE_LIMIT {
        *length = Length::of(&column[1..], beside);
    } else {
        length.now *= left.sqrt();
    }
}
