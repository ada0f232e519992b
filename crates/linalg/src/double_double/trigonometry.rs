//! Sine and cosine in double-double, which are used at configurations for which a rank is
//! certified.
//!
//! The argument is reduced by multiples of π/2 stored with 159 bits and halved three times. The
//! remainder is below 0.1, so its Taylor series converges fast. Doubling the angle uses `1 − cos`,
//! which does not cancel.

use super::Dd;

/// The first 159 bits of π/2, as a sum of three `f64`.
const HALF_PI: [f64; 3] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
];

/// The number of times that the reduced argument is halved.
const HALVINGS: i32 = 3;

/// Number of terms of each series: the next term, 0.1³⁸ / 38!, is far below the rounding of the
/// format.
const TERMS: u32 = 11;

/// Above this argument the multiple of π/2 is not exact in the reduction, and the result has the
/// accuracy of `f64`.
const LARGEST: f64 = 1e15;

impl Dd {
    /// Returns sine and cosine. The absolute error is below 10⁻³¹·(1 + |x|), the rounding error of
    /// the argument. For |x| above 10¹⁵, the error is that of `f64`. The result is NaN if the
    /// argument is not finite.
    ///
    /// ```
    /// use pfaff_linalg::Dd;
    /// // 3-4-5: the angle cannot be represented exactly, but cosine and sine are on the circle to rounding.
    /// let (s, c) = Dd::from(0.6f64.acos()).sin_cos();
    /// assert!((s * s + c * c - Dd::ONE).abs() < Dd::from(1e-31));
    /// assert_eq!(c.to_f64(), 0.6);
    /// ```
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        if self.hi.is_nan() || self.hi.abs() > LARGEST {
            let (s, c) = self.hi.sin_cos();
            return (Self::from(s), Self::from(c));
        }
        let quarters = (self.hi / HALF_PI[0]).round();
        let reduced = HALF_PI
            .iter()
            .fold(self, |x, &part| x - Self::from_product(quarters, part));
        let small = reduced * Self::from(0.5_f64.powi(HALVINGS));
        let (mut s, mut one_minus_c) = series(small);
        for _ in 0..HALVINGS {
            // sin 2x = 2·sin x·cos x and 1 − cos 2x = 2·sin² x
            let c = Self::ONE - one_minus_c;
            one_minus_c = Self::from(2.0) * s * s;
            s = Self::from(2.0) * s * c;
        }
        let c = Self::ONE - one_minus_c;
        match quarters.rem_euclid(4.0) as u8 {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    }
}

/// Returns `sin x` and `1 − cos x` for |x| ≤ 0.1, by Horner's rule.
fn series(x: Dd) -> (Dd, Dd) {
    let square = x * x;
    let (mut sine, mut rest) = (Dd::ONE, Dd::ONE);
    for k in (1..=TERMS).rev() {
        let k = f64::from(k);
        let factor = |product: f64| square / Dd::from(product);
        sine = Dd::ONE - factor(2.0 * k * (2.0 * k + 1.0)) * sine;
        rest = Dd::ONE - factor((2.0 * k + 1.0) * (2.0 * k + 2.0)) * rest;
    }
    (x * sine, square * Dd::from(0.5) * rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dd(hi: f64, lo: f64) -> Dd {
        Dd::from_sum(hi, lo)
    }

    fn close(a: Dd, b: Dd) {
        assert!((a - b).abs() < Dd::from(1e-31), "{a:?} {b:?}");
    }

    /// sin(π/6) = 1/2, cos(π/6) = √3/2, sin(π/4) = cos(π/4) = √½.
    #[test]
    fn angles_of_the_triangle() {
        let pi = dd(HALF_PI[0], HALF_PI[1]) * Dd::from(2.0);
        let (s, c) = (pi / Dd::from(6.0)).sin_cos();
        close(s, Dd::from(0.5));
        close(c, Dd::from(3.0).sqrt() / Dd::from(2.0));
        let (s, c) = (pi / Dd::from(4.0)).sin_cos();
        close(s, Dd::from(0.5).sqrt());
        close(c, Dd::from(0.5).sqrt());
    }

    /// Tests the addition theorem across quadrants, for arguments up to thousands of revolutions.
    #[test]
    fn addition_theorem() {
        for k in -40..40 {
            let a = dd(0.37 * f64::from(k), 1e-18);
            let b = dd(f64::from(k * k) + 0.11, -3e-18);
            let ((sa, ca), (sb, cb)) = (a.sin_cos(), b.sin_cos());
            let (s, c) = (a + b).sin_cos();
            // The sum of the arguments is rounded.
            let tolerance = Dd::from(1e-31 * (2.0 + b.to_f64()));
            assert!((s - (sa * cb + ca * sb)).abs() < tolerance, "sin at {k}");
            assert!((c - (ca * cb - sa * sb)).abs() < tolerance, "cos at {k}");
            assert!((s.to_f64() - (a + b).to_f64().sin()).abs() < 3e-16 * (1.0 + b.to_f64()));
        }
    }

    /// sin 1 and cos 1 to 34 digits (OEIS A049469, A049470).
    #[test]
    fn one_radian() {
        let (s, c) = Dd::ONE.sin_cos();
        // The digits are 0.8414709848078965066525023216302989996 and
        // 0.5403023058681397174009366074429766037.
        let tail = |hi: f64, digits: &str| {
            let scaled: Vec<f64> = digits.bytes().map(|d| f64::from(d - b'0')).collect();
            let value = scaled
                .iter()
                .rev()
                .fold(Dd::ZERO, |sum, &d| (sum + Dd::from(d)) / Dd::from(10.0));
            assert!((value.to_f64() - hi).abs() < 1e-15);
            value
        };
        close(
            s,
            tail(
                0.841_470_984_807_896_5,
                "8414709848078965066525023216302989996",
            ),
        );
        close(
            c,
            tail(
                0.540_302_305_868_139_7,
                "5403023058681397174009366074429766037",
            ),
        );
    }

    #[test]
    fn extremes() {
        let (s, c) = Dd::ZERO.sin_cos();
        assert_eq!((s.to_f64(), c.to_f64()), (0.0, 1.0));
        assert!(Dd::from(f64::NAN).sin_cos().0.to_f64().is_nan());
        assert!(Dd::from(f64::INFINITY).sin_cos().1.to_f64().is_nan());
        assert_eq!(Dd::from(1e300).sin_cos().0.to_f64(), 1e300_f64.sin());
    }
}
