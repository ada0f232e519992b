//! Powers of two, which are exact scale factors.

use crate::kernels;

/// Largest power of two whose inverse is also normal.
pub(crate) const STEP: i32 = 1022;

/// Returns `2^e`, where `−STEP ≤ e ≤ STEP`.
#[must_use]
pub fn power(e: i32) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

/// Returns `x·2^e`. The result is exact unless it is outside the range of normal numbers.
#[must_use]
pub fn scale(x: f64, e: i32) -> f64 {
    if (-STEP..=STEP).contains(&e) {
        return x * power(e);
    }
    let mut x = x;
    let mut e = e;
    while e > STEP && x.is_finite() && x != 0.0 {
        x *= power(STEP);
        e -= STEP;
    }
    while e < -STEP && x != 0.0 {
        x *= power(-STEP);
        e += STEP;
    }
    x * power(e.clamp(-STEP, STEP))
}

/// Returns the exponent e with `2^e ≤ |x| < 2^(e+1)`, or `None` for zero and non-finite values.
#[must_use]
pub fn exponent(x: f64) -> Option<i32> {
    const BIAS: i32 = 1023;
    const TO_NORMAL: i32 = 54;
    if x == 0.0 || !x.is_finite() {
        return None;
    }
    let field = |x: f64| ((x.to_bits() >> 52) & 0x7ff) as i32;
    match field(x) {
        0 => Some(field(scale(x, TO_NORMAL)) - BIAS - TO_NORMAL),
        e => Some(e - BIAS),
    }
}

/// Returns the exponent of the power of two that scales the largest entry of `x` into [1, 2), or 0
/// if all entries are zero.
#[must_use]
pub fn unit_exponent(x: &[f64]) -> i32 {
    exponent(kernels::max_abs(x)).map_or(0, |e| -e)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_by_hand() {
        assert_eq!(exponent(1.0), Some(0));
        assert_eq!(exponent(-3.9), Some(1));
        assert_eq!(exponent(f64::MIN_POSITIVE), Some(-1022));
        assert_eq!(exponent(f64::from_bits(1)), Some(-1074));
        assert_eq!(exponent(0.0), None);
        assert_eq!(exponent(f64::NAN), None);
    }

    #[test]
    fn scale_reaches_both_ends() {
        assert_eq!(scale(f64::from_bits(1), 1074), 1.0);
        assert_eq!(scale(1.5, -1022), 1.5 * f64::MIN_POSITIVE);
        assert_eq!(scale(1.0, 5000), f64::INFINITY);
        assert_eq!(scale(0.0, i32::MAX), 0.0);
    }
}
