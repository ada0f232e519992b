//! Computes a root in a bracket by the method ITP (interpolate, truncate, project). The method
//! needs at most one evaluation more than bisection. The method converges faster than the secant
//! method if the function is smooth.
//!
//! Source: I. F. D. Oliveira, R. H. C. Takahashi, An enhancement of the bisection method average
//! performance preserving minmax optimality, ACM Trans. Math. Softw. 47 (2020) 5, DOI
//! 10.1145/3423597. The constants are κ1 = 0.2/(b − a), κ2 = 2, n0 = 1.

/// One end of a bracket, with its argument and its function value.
pub(crate) type BracketEnd = (f64, f64);

/// Shrinks the bracket from `near` to `far` to a width of at most `width` (> 0). The values at the
/// ends of the bracket must have opposite signs, or the value at `far` must be zero. The function
/// returns the far end of the bracket. The value at this end is zero or has the sign of the
/// original value at `far`.
///
/// # Errors
///
/// Returns the errors of `f`.
pub(crate) fn bracketed_root<E>(
    near: BracketEnd,
    far: BracketEnd,
    width: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let ((mut a, mut f_a), (mut b, mut f_b)) = (near, far);
    let direction = (b - a).signum();
    let length = (b - a).abs();
    let k1 = 0.2 / length;
    // Number of bisections after which the width is reached, plus one permitted extra evaluation.
    let bisections = (length / width).log2().ceil().max(0.0) + 1.0;
    // Largest distance from the middle that satisfies the bound on the number of evaluations.
    let mut reach = 0.5 * width * bisections.exp2();
    while f_b != 0.0 && (b - a).abs() > width {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a).abs());
        let secant = (f_b * a - f_a * b) / (f_b - f_a);
        let towards_middle = (middle - secant).signum();
        let truncation = (k1 * (b - a).powi(2)).max(0.5 * width);
        let truncated = if truncation <= (middle - secant).abs() {
            secant + towards_middle * truncation
        } else {
            middle
        };
        let radius = (reach - half).max(0.0);
        let projected = if (truncated - middle).abs() <= radius {
            truncated
        } else {
            middle - towards_middle * radius
        };
        // The middle is used if the point is outside the bracket because of rounding or because of
        // the overflow of a quotient.
        let is_inside = (projected - a) * direction > 0.0 && (b - projected) * direction > 0.0;
        let x = if is_inside { projected } else { middle };
        if x == a || x == b {
            break;
        }
        let f_x = f(x)?;
        if f_x == 0.0 || (f_x > 0.0) == (f_b > 0.0) {
            (b, f_b) = (x, f_x);
        } else {
            (a, f_a) = (x, f_x);
        }
        reach *= 0.5;
    }
    Ok(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// Root and number of evaluations.
    fn root(a: f64, b: f64, width: f64, f: impl Fn(f64) -> f64) -> (f64, u32) {
        let mut count = 0;
        let counted = |x| {
            count += 1;
            Ok::<_, Infallible>(f(x))
        };
        let Ok(x) = bracketed_root((a, f(a)), (b, f(b)), width, counted);
        (x, count)
    }

    #[test]
    fn roots_are_found_to_the_width_from_both_sides() {
        let width = 4.0 * f64::EPSILON;
        let functions: [(&dyn Fn(f64) -> f64, f64); 5] = [
            (&|x| x * x - 2.0, 2.0_f64.sqrt()),
            (&|x| (x - 1.25).powi(9), 1.25),
            (&|x| x.exp() - 3.0, 3.0_f64.ln()),
            (&|x| if x < 1.3 { -1e300 } else { 1e-300 }, 1.3),
            (&|x| 1e-200 * (x - 1.7), 1.7),
        ];
        for (i, (f, exact)) in functions.into_iter().enumerate() {
            for (a, b) in [(1.0, 2.0), (2.0, 1.0)] {
                let (x, count) = root(a, b, width, f);
                assert!((x - exact).abs() <= 2.0 * width, "{i}: {x:?}");
                assert!(f(x) == 0.0 || (f(x) > 0.0) == (f(b) > 0.0), "{i}: {x:?}");
                // The number is one more than for bisection.
                assert!(count <= 52, "{i}: {count}");
            }
        }
        assert!(root(1.0, 2.0, width, |x| x.exp() - 3.0).1 <= 9);
    }

    #[test]
    fn a_root_at_the_far_end_is_that_end() {
        assert_eq!(root(0.0, 1.0, 1e-15, |x| x - 1.0), (1.0, 0));
    }
}
