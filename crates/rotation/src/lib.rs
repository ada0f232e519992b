#![doc = include_str!("../README.md")]

mod limits;

use limits::{LEAST_COSINE, SERIES_UP_TO};

/// Returns the derivative of this order of `θ/sin θ` with respect to c = cos θ, for 0 ≤ θ ≤ 3. With
/// x = (1 − c)/2, the derivative is `(−½)ⁿ·(n!)²/(3/2)ₙ · ₂F₁(n + 1, n + 1; n + 3/2; x)`. At c = 1,
/// the value (order 0) is 1. The result is NaN beyond θ = 3.
///
/// Source: θ/sin θ = ₂F₁(1, 1; 3/2; sin² ½θ) (NIST DLMF 15.4.13 with 15.8.18), and
/// `(1 − c²)·f⁽ⁿ⁺¹⁾ = (2n + 1)·c·f⁽ⁿ⁾ + n²·f⁽ⁿ⁻¹⁾` from `(1 − c²)·f′ = c·f − 1`.
#[must_use]
pub fn angle_over_sine(c: f64, order: u8) -> f64 {
    let x = 0.5 * (1.0 - c);
    // The comparison is also false for NaN.
    let is_known = c >= LEAST_COSINE;
    if !is_known {
        return f64::NAN;
    }
    if x <= SERIES_UP_TO {
        return series(x, order);
    }
    let square = 4.0 * x * (1.0 - x);
    let sine = square.sqrt();
    let value = sine.atan2(c) / sine;
    let (mut before, mut now) = (value, (c * value - 1.0) / square);
    if order == 0 {
        return value;
    }
    for n in 1..u32::from(order) {
        let n = f64::from(n);
        let next = ((2.0 * n + 1.0) * c * now + n * n * before) / square;
        (before, now) = (now, next);
    }
    now
}

/// Computes the derivative by its series in x = (1 − c)/2.
fn series(x: f64, order: u8) -> f64 {
    let n = f64::from(order);
    let mut term = (0..order).map(f64::from).fold(1.0, |product, k| {
        -0.5 * product * (k + 1.0) * (k + 1.0) / (k + 1.5)
    });
    let mut sum = 0.0;
    let mut k = 0.0;
    loop {
        let next = sum + term;
        // From some k onwards, each term is smaller than the previous term by a factor below 1. The
        // sum ends if a term is zero or negligible.
        if next == sum || !next.is_finite() {
            return next;
        }
        sum = next;
        term *= (n + 1.0 + k) * (n + 1.0 + k) / ((n + 1.5 + k) * (k + 1.0)) * x;
        k += 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Permitted relative error: a few rounding errors, except near half a revolution, where the
    /// sine loses digits by cancellation.
    const ROUNDINGS: f64 = 2e-15;

    #[test]
    fn the_value_is_the_angle_over_its_sine() {
        for k in 1..=300 {
            let theta = 0.01 * f64::from(k) - 1e-12;
            let expected = theta / theta.sin();
            let found = angle_over_sine(theta.cos(), 0);
            // The error is d(θ/sin θ)/dc·δc, where δc is a rounding of the cosine.
            let slope = angle_over_sine(theta.cos(), 1).abs();
            let bound = ROUNDINGS * (expected + slope);
            assert!(
                (found - expected).abs() <= bound,
                "{theta}: {found} {expected}"
            );
        }
        assert_eq!(angle_over_sine(1.0, 0), 1.0);
        // Because of rounding, c is slightly above 1.
        assert!((angle_over_sine(1.0 + 1e-15, 0) - 1.0).abs() < 1e-15);
    }

    /// At c = 1 the values are −1/3, 4/15, −12/35. Each derivative is the slope of the previous
    /// derivative.
    #[test]
    fn derivatives() {
        assert!((angle_over_sine(1.0, 1) + 1.0 / 3.0).abs() < ROUNDINGS);
        assert!((angle_over_sine(1.0, 2) - 4.0 / 15.0).abs() < ROUNDINGS);
        assert!((angle_over_sine(1.0, 3) + 12.0 / 35.0).abs() < ROUNDINGS);
        let h = 1e-5;
        for k in 0..90 {
            let c = 0.99 - 0.021 * f64::from(k);
            for order in 0..3 {
                let [before, after] = [-h, h].map(|h| angle_over_sine(c + h, order));
                let (slope, found) = ((after - before) / (2.0 * h), angle_over_sine(c, order + 1));
                let third = angle_over_sine(c, order + 3).abs();
                let bound = h * h * (1.0 + third) + 1e-10 * (1.0 + after.abs());
                assert!(
                    (slope - found).abs() <= bound,
                    "{c}, {order}: {slope} {found}"
                );
            }
        }
    }

    #[test]
    fn series_and_closed_form_agree() {
        let c = 1.0 - 2.0 * SERIES_UP_TO;
        for order in 0..4 {
            let [below, above] = [c + 1e-15, c - 1e-15].map(|c| angle_over_sine(c, order));
            assert!(
                (below - above).abs() <= 20.0 * ROUNDINGS * above.abs(),
                "{order}"
            );
        }
    }

    #[test]
    fn there_is_none_near_half_a_turn() {
        assert!(angle_over_sine(3.0_f64.cos() + 1e-12, 0).is_finite());
        for c in [3.0_f64.cos() - 1e-12, -1.0, -2.0, f64::NAN] {
            assert!(angle_over_sine(c, 0).is_nan() && angle_over_sine(c, 2).is_nan());
        }
    }
}
