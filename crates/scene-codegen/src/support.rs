//! Functions that are copied into generated modules; they are available as text and, in tests, as
//! code.

/// Names and texts of these functions, in the order in which they appear in modules.
pub(crate) const SUPPORT: [(&str, &str); 9] = [
    ("cos_sin", include_str!("support/cos_sin.in")),
    ("rotation", include_str!("support/rotation.in")),
    ("turning", include_str!("support/turning.in")),
    ("polynomial", include_str!("support/polynomial.in")),
    ("harmonic", include_str!("support/harmonic.in")),
    ("steps", include_str!("support/steps.in")),
    ("spline", include_str!("support/spline.in")),
    ("lines", include_str!("support/lines.in")),
    ("recip_or_zero", include_str!("support/recip_or_zero.in")),
];

#[cfg(test)]
mod tests {
    use joints::space3::Pose;

    include!("support/cos_sin.in");
    include!("support/rotation.in");
    include!("support/turning.in");

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
        // Near multiples of π/2, the error of a small value is small relative to the value.
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

    /// The rotation of the quaternion cos ½θ + sin ½θ·n, times any length, compared with Rodrigues'
    /// formula.
    #[test]
    fn rotations_are_those_of_axes_and_angles() {
        for k in 0..1000 {
            let x = |i: usize| (1.3 * (i + 1) as f64 + 2.3 * f64::from(k)).sin();
            let (angle, size) = (4.0 * x(3), 2.0_f64.powf(8.0 * x(4)));
            let length = (x(0) * x(0) + x(1) * x(1) + x(2) * x(2)).sqrt();
            let n = [0, 1, 2].map(|i| x(i) / length);
            let ((half, cos_half), (sin, cos)) = ((0.5 * angle).sin_cos(), angle.sin_cos());
            let e = [cos_half, half * n[0], half * n[1], half * n[2]].map(|e| size * e);
            let found = rotation(e);
            let across = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
            for row in 0..3 {
                for column in 0..3 {
                    let one = if row == column { cos } else { 0.0 };
                    let expected =
                        one + sin * across[row][column] + (1.0 - cos) * n[row] * n[column];
                    let by = (found[3 * row + column] - expected).abs();
                    assert!(by < 1e-15, "{k}: {by:e}");
                    let of_model = Pose::new([0.0; 3], e).rot[row][column];
                    let by = (found[3 * row + column] - of_model).abs();
                    assert!(by < 1e-15, "{k}: {by:e} from the interpreter");
                }
            }
        }
    }

    /// Tests with the angle (0.3 − t)² + 0.2·t, whose derivatives are known exactly.
    #[test]
    fn cosine_and_sine_of_a_function_have_its_derivatives() {
        let angle = |t: f64| (0.3 - t) * (0.3 - t) + 0.2 * t;
        let t = 0.9;
        let found = turning([angle(t), 2.0 * (t - 0.3) + 0.2, 2.0]);
        for (found, f) in found.iter().zip([f64::cos, f64::sin]) {
            let h = 1e-4;
            let at = |steps: f64| f(angle(t + steps * h));
            let rate = (at(1.0) - at(-1.0)) / (2.0 * h);
            let second = (at(1.0) - 2.0 * at(0.0) + at(-1.0)) / (h * h);
            assert!((found[0] - at(0.0)).abs() < 1e-15);
            assert!((found[1] - rate).abs() < 1e-7, "{} {rate}", found[1]);
            assert!((found[2] - second).abs() < 1e-6, "{} {second}", found[2]);
        }
    }

    #[test]
    fn zero_infinity_and_nan() {
        assert_eq!(cos_sin(0.0), [1.0, 0.0]);
        assert!(cos_sin(f64::NAN).iter().all(|x| x.is_nan()));
        assert!(cos_sin(f64::INFINITY).iter().all(|x| x.is_nan()));
    }
}
