//! Makes a bidiagonal matrix diagonal by rotations from both sides. Only its singular values are
//! computed.
//!
//! Each step is a step of the implicit QR algorithm for BᵀB; this product is not formed. A rotation
//! of two columns with Wilkinson's shift creates an entry below the diagonal, which further
//! rotations remove. A block with a zero on its diagonal is first divided at this zero.

use crate::limits::QR_STEPS_EACH;

/// Converts the diagonal `d` (n) and the superdiagonal `f` (n − 1) of a matrix with entries near
/// one into singular values, unsorted and with any sign. Returns `false` if the iteration does not
/// converge.
pub(super) fn iterate(d: &mut [f64], f: &mut [f64]) -> bool {
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |a, &b| a.max(b.abs()));
    let zero = f64::EPSILON * largest(d).max(largest(f));
    let stands = |x: f64| x.abs() > zero;
    let mut end = d.len();
    for _ in 0..QR_STEPS_EACH * d.len() {
        // The range begin..end is the last block that is not diagonal yet.
        while end > 1 && !stands(f[end - 2]) {
            end -= 1;
        }
        if end <= 1 {
            return true;
        }
        let mut begin = end - 1;
        while begin > 0 && stands(f[begin - 1]) {
            begin -= 1;
        }
        match (begin..end).find(|&i| !stands(d[i])) {
            Some(i) if i + 1 == end => cut_column(&mut d[begin..end], &mut f[begin..end - 1]),
            Some(i) => cut_row(&mut d[i..end], &mut f[i..end - 1]),
            None => step(&mut d[begin..end], &mut f[begin..end - 1]),
        }
    }
    d.len() <= 1
}

/// Performs one step with a shift.
fn step(d: &mut [f64], f: &mut [f64]) {
    let n = d.len();
    let shift = {
        // The shift is an eigenvalue of the trailing 2×2 block of BᵀB. Of the two eigenvalues, it
        // is the one closer to the last entry of the block.
        let before = if n > 2 { f[n - 3] } else { 0.0 };
        let (a, b, c) = (
            d[n - 2] * d[n - 2] + before * before,
            d[n - 2] * f[n - 2],
            d[n - 1] * d[n - 1] + f[n - 2] * f[n - 2],
        );
        let half = (a - c) / 2.0;
        c - b * b / (half + half.hypot(b).copysign(half))
    };
    let (mut y, mut z) = (d[0] * d[0] - shift, d[0] * f[0]);
    for k in 0..n - 1 {
        // The rotation of columns k, k + 1 removes the entry above the diagonal and creates an
        // entry (k + 1, k).
        let (c, s, r) = rotation(y, z);
        if k > 0 {
            f[k - 1] = r;
        }
        (y, f[k]) = (c * d[k] + s * f[k], c * f[k] - s * d[k]);
        (z, d[k + 1]) = (s * d[k + 1], c * d[k + 1]);
        // The rotation of rows k, k + 1 removes this entry and creates an entry at (k, k + 2).
        let (c, s, r) = rotation(y, z);
        d[k] = r;
        (y, d[k + 1]) = (c * f[k] + s * d[k + 1], c * d[k + 1] - s * f[k]);
        f[k] = y;
        if k + 2 < n {
            (z, f[k + 1]) = (s * f[k + 1], c * f[k + 1]);
        }
    }
}

/// If the first diagonal entry of the block is zero, rotations with the rows below make its row
/// zero.
fn cut_row(d: &mut [f64], f: &mut [f64]) {
    let mut bulge = f[0];
    d[0] = 0.0;
    f[0] = 0.0;
    for k in 1..d.len() {
        let (c, s, r) = rotation(d[k], bulge);
        d[k] = r;
        if k < f.len() {
            (bulge, f[k]) = (-s * f[k], c * f[k]);
        }
    }
}

/// If the last diagonal entry of the block is zero, rotations with the previous columns make its
/// column zero.
fn cut_column(d: &mut [f64], f: &mut [f64]) {
    let n = d.len();
    let mut bulge = f[n - 2];
    d[n - 1] = 0.0;
    f[n - 2] = 0.0;
    for k in (0..n - 1).rev() {
        let (c, s, r) = rotation(d[k], bulge);
        d[k] = r;
        if k > 0 {
            (bulge, f[k - 1]) = (-s * f[k - 1], c * f[k - 1]);
        }
    }
}

/// Returns the cosine c, the sine s and the length r with `[c s; −s c]·[a; b] = [r; 0]`.
fn rotation(a: f64, b: f64) -> (f64, f64, f64) {
    if b == 0.0 {
        return (1.0, 0.0, a);
    }
    // Entries are at most of order one. An entry whose square underflows is negligible relative to
    // the largest.
    let r = (a * a + b * b).sqrt();
    match 1.0 / r {
        // Most of the time of a step is the latency of this quotient, so it is computed once.
        inverse if inverse.is_finite() => (a * inverse, b * inverse, r),
        _ => (1.0, 0.0, 0.0),
    }
}
