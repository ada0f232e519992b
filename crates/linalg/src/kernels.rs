//! The inner loops of this crate: dot product, `y += s·x` for one or two vectors x, and a norm that
//! neither overflows nor underflows.
//!
//! The functions use only slices and a fixed order of summation, so that the same input gives the
//! same bits on every platform. For the same reason they do not use `mul_add`. Loops over matrices
//! run with the vector instructions of the processor, for which the functions are inlined.

use crate::limits::SQUARE_MIN;

/// Runs a task with the vector instructions of the current processor. The task and its functions
/// must be inlined. The bits of the result do not depend on the processor.
#[inline(always)]
pub(crate) fn vectorised<T>(task: impl FnOnce() -> T) -> T {
    pulp::Arch::new().dispatch(task)
}

/// Returns `xᵀ·y` over the shorter length, summed in four interleaved partial sums.
#[must_use]
#[inline(always)]
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().min(y.len());
    let (x4, x_rest) = x[..n].as_chunks::<4>();
    let (y4, y_rest) = y[..n].as_chunks::<4>();
    let mut s = [0.0_f64; 4];
    for (a, b) in x4.iter().zip(y4) {
        for l in 0..4 {
            s[l] += a[l] * b[l];
        }
    }
    let mut sum = (s[0] + s[2]) + (s[1] + s[3]);
    for (a, b) in x_rest.iter().zip(y_rest) {
        sum += a * b;
    }
    sum
}

/// Computes `y ← y + s·x` over the shorter length.
#[inline(always)]
pub fn axpy(s: f64, x: &[f64], y: &mut [f64]) {
    for (a, b) in x.iter().zip(y) {
        *b += s * a;
    }
}

/// Computes `z ← z + s·x + t·y` over the shortest length.
#[inline(always)]
pub fn axpy_both([s, t]: [f64; 2], [x, y]: [&[f64]; 2], z: &mut [f64]) {
    for ((a, b), c) in x.iter().zip(y).zip(z) {
        *c += s * a + t * b;
    }
}

/// Returns the Euclidean norm, including vectors whose squared entries overflow or underflow.
#[must_use]
#[inline(always)]
pub fn norm(x: &[f64]) -> f64 {
    let sum = dot(x, x);
    if sum > SQUARE_MIN * SQUARE_MIN && sum.is_finite() {
        return sum.sqrt();
    }
    let largest = max_abs(x);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let sum: f64 = x.iter().map(|a| (a / largest) * (a / largest)).sum();
    largest * sum.sqrt()
}

/// Returns the largest absolute entry, or 0 for an empty slice; NaN entries are ignored.
#[must_use]
#[inline(always)]
pub fn max_abs(x: &[f64]) -> f64 {
    let larger = |largest: f64, a: f64| if a.abs() > largest { a.abs() } else { largest };
    let (x4, rest) = x.as_chunks::<4>();
    let mut m = [0.0_f64; 4];
    for a in x4 {
        for l in 0..4 {
            m[l] = larger(m[l], a[l]);
        }
    }
    m.iter()
        .chain(rest)
        .fold(0.0, |largest, &a| larger(largest, a))
}

/// Returns the smallest and the largest entry, without branches. The result is `[∞, −∞]` for an
/// empty slice; NaN entries are ignored.
#[must_use]
pub fn extremes(x: &[f64]) -> [f64; 2] {
    let smaller = |a: f64, b: f64| if b < a { b } else { a };
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let (x4, rest) = x.as_chunks::<4>();
    let (mut least, mut most) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for a in x4 {
        for l in 0..4 {
            least[l] = smaller(least[l], a[l]);
            most[l] = larger(most[l], a[l]);
        }
    }
    [
        least
            .iter()
            .chain(rest)
            .fold(f64::INFINITY, |a, &b| smaller(a, b)),
        most.iter()
            .chain(rest)
            .fold(f64::NEG_INFINITY, |a, &b| larger(a, b)),
    ]
}

/// Returns whether all entries are finite, without branches: x·0 is NaN exactly for NaN and
/// infinities.
#[must_use]
pub fn all_finite(x: &[f64]) -> bool {
    let (x4, rest) = x.as_chunks::<4>();
    let mut s = [0.0_f64; 4];
    for a in x4 {
        for l in 0..4 {
            s[l] += a[l] * 0.0;
        }
    }
    let sum: f64 = s.iter().sum();
    sum + rest.iter().map(|a| a * 0.0).sum::<f64>() == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dot_of_seven_entries_by_hand() {
        let x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        assert_eq!(dot(&x, &x), 140.0);
    }

    #[test]
    fn two_vectors_are_added_at_once() {
        let mut z = [1.0, 2.0, 3.0];
        axpy_both([2.0, -1.0], [&[1.0, 2.0, 3.0], &[0.5, 0.5]], &mut z);
        assert_eq!(z, [2.5, 5.5, 3.0]);
    }

    #[test]
    fn every_place_counts() {
        for n in 0..10 {
            let x: Vec<f64> = (1..=n).map(f64::from).collect();
            assert_eq!(max_abs(&x), f64::from(n));
            if n > 0 {
                assert_eq!(extremes(&x), [1.0, f64::from(n)]);
            }
            assert!(all_finite(&x));
            for i in 0..x.len() {
                let mut x = x.clone();
                x[i] = -100.0;
                assert_eq!(max_abs(&x), 100.0);
                assert_eq!(extremes(&x)[0], -100.0);
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    x[i] = bad;
                    assert!(!all_finite(&x));
                }
                x[i] = f64::NAN;
                assert!(max_abs(&x) <= f64::from(n), "{x:?}");
            }
        }
    }

    #[test]
    fn norm_survives_the_ends_of_the_range() {
        assert_eq!(norm(&[0.0, 0.0]), 0.0);
        // The squares of these sizes underflow, lose digits, are ordinary, are almost too large, or
        // overflow.
        for size in [1e-300, 1e-200, 1e-160, 1.0, 1e153, 1e200, 1e300] {
            let ratio = norm(&[3.0 * size, 4.0 * size]) / (5.0 * size);
            assert!(
                (ratio - 1.0).abs() < 4.0 * f64::EPSILON,
                "{size:e}: {ratio}"
            );
        }
    }
}
