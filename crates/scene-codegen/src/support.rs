//! Functions that are copied into generated modules, as text and, for tests, as code.

/// Names and texts, in the order in which modules have them.
pub(crate) const SUPPORT: [(&str, &str); 7] = [
    ("cos_sin", include_str!("support/cos_sin.in")),
    ("polynomial", include_str!("support/polynomial.in")),
    ("harmonic", include_str!("support/harmonic.in")),
    ("steps", include_str!("support/steps.in")),
    ("spline", include_str!("support/spline.in")),
    ("lines", include_str!("support/lines.in")),
    ("recip_or_zero", include_str!("support/recip_or_zero.in")),
];

#[cfg(test)]
mod tests {
    include!("support/cos_sin.in");

    #[test]
    fn cosine_and_sine_are_those_of_the_library() {
        let mut x = 1e-9;
        while x < 2e6 {
            for x in [x, -x] {
                let ([cos, sin], (s, c)) = (cos_sin(x), x.sin_cos());
                assert!((cos - c).abs() <= 1.2e-16, "cos {x}: {cos} {c}");
                assert!((sin - s).abs() <= 1.2e-16, "sin {x}: {sin} {s}");
            }
            x *= 1.0003;
        }
        // Near multiples of π/2 small values are accurate relative to their size.
        for k in 1..200_000 {
            let x = f64::from(k) * core::f64::consts::FRAC_PI_2;
            let ([cos, sin], (s, c)) = (cos_sin(x), x.sin_cos());
            assert!(
                (cos - c).abs() <= 1e-15 * c.abs() + 1e-20,
                "cos {x}: {cos} {c}"
            );
            assert!(
                (sin - s).abs() <= 1e-15 * s.abs() + 1e-20,
                "sin {x}: {sin} {s}"
            );
        }
    }

    #[test]
    fn zero_infinity_and_nan() {
        assert_eq!(cos_sin(0.0), [1.0, 0.0]);
        assert!(cos_sin(f64::NAN).iter().all(|x| x.is_nan()));
        assert!(cos_sin(f64::INFINITY).iter().all(|x| x.is_nan()));
    }
}
