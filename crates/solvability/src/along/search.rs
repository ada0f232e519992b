//! Searches in a function of time for a change of sign, for the time at which the function falls
//! below zero, and for a minimum. The function may return an error. The searches find singular
//! instants along a given motion and within a step of a simulation.
//!
//! The crate `integrators` has its own search for events. That crate depends on no other crate, and
//! its search returns the end of the bracket after the event.

use crate::limits::{CORNER_STEPS, EDGE, FALL, NARROWING, RESOLUTION, SEARCH_ITERATIONS};

/// Returns a root of `f` between a and b, where `f(a) > 0 > f(b)`. The method uses secant steps
/// with the Illinois modification, and bisection if these steps gain too little. The search stops
/// if a value is at most `enough`.
///
/// # Errors
/// Returns the errors of `f`.
pub fn root<E>(
    [a, b]: [f64; 2],
    [f_a, f_b]: [f64; 2],
    enough: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let (mut low, mut high) = ((a, f_a), (b, f_b));
    // Values for the secant. The value at an end that does not move is halved.
    let (mut w_low, mut w_high) = (f_a, f_b);
    let mut width = b - a;
    let mut slow = 0;
    let mut was_low = None;
    for _ in 0..SEARCH_ITERATIONS {
        let secant = low.0 + (high.0 - low.0) * w_low / (w_low - w_high);
        let middle = 0.5 * (low.0 + high.0);
        let inside = secant > low.0 && secant < high.0;
        let t = if inside && slow < 3 { secant } else { middle };
        if high.0 - low.0 <= RESOLUTION * low.0.abs().max(high.0.abs()) || t <= low.0 || t >= high.0
        {
            break;
        }
        let value = f(t)?;
        if value.abs() <= enough {
            return Ok(t);
        }
        let is_low = value > 0.0;
        let stays = was_low.replace(is_low) == Some(is_low);
        if is_low {
            (low, w_low) = ((t, value), value);
            w_high *= if stays { 0.5 } else { 1.0 };
        } else {
            (high, w_high) = ((t, value), value);
            w_low *= if stays { 0.5 } else { 1.0 };
        }
        slow = if high.0 - low.0 > 0.5 * width {
            slow + 1
        } else {
            0
        };
        width = high.0 - low.0;
    }
    Ok(if low.1.abs() < high.1.abs() {
        low.0
    } else {
        high.0
    })
}

/// Returns the time between `outside` and `inside`, in either order, at which `f` becomes negative.
/// `f` must be negative at `inside` and not negative at `outside`.
pub(super) fn edge<E>(
    [outside, inside]: [f64; 2],
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let direction = (inside - outside).signum();
    let values = [f(outside)?, f(inside)?];
    if values[0] <= 0.0 {
        return Ok(outside);
    }
    let along = [direction * outside, direction * inside];
    let enough = EDGE * values[0].min(values[1].abs());
    Ok(direction * root(along, values, enough, |x| f(direction * x))?)
}

/// Returns whether a function may reach `limit` near its minimum. The values found around the
/// minimum are between `least` and `largest`.
pub(super) fn may_reach(limit: f64, least: f64, largest: f64) -> bool {
    let lowest = least - FALL * (largest - least);
    // NaN values exclude no limit.
    lowest.is_nan() || lowest <= limit
}

/// Finds the minimum of `f` between a and b and its value, if `f` has only one minimum in this
/// interval. The golden section search finds the corner of an absolute value to rounding. The
/// search stops if the interval is narrower than `enough`. The search returns `None` as soon as the
/// minimum is certainly above `limit`, for example if a function with a jump stays above `limit` on
/// a narrow interval.
///
/// # Errors
/// Returns the errors of `f`.
pub fn minimum<E>(
    [mut a, mut b]: [f64; 2],
    limit: f64,
    enough: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<(f64, f64)>, E> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut f_a, mut f_b) = (f(a)?, f(b)?);
    let mut best = lower(lower((a, f64::INFINITY), (a, f_a)), (b, f_b));
    let (width, above) = (b - a, f_a.max(f_b) - limit);
    let (mut x, mut y) = (b - golden * (b - a), a + golden * (b - a));
    let (mut f_x, mut f_y) = (f(x)?, f(y)?);
    for _ in 0..SEARCH_ITERATIONS {
        best = lower(lower(best, (x, f_x)), (y, f_y));
        let narrow = enough.max(RESOLUTION * a.abs().max(b.abs()));
        if b - a <= narrow || best.1 == 0.0 {
            break;
        }
        let near = FALL * above * ((b - a) / width).powf(NARROWING);
        let stays = best.1 > limit.max(limit + near);
        if stays || !may_reach(limit, best.1, f_a.max(f_b)) {
            return Ok(None);
        }
        if f_x <= f_y {
            (b, f_b, y, f_y) = (y, f_y, x, f_x);
            x = b - golden * (b - a);
            f_x = f(x)?;
        } else {
            (a, f_a, x, f_x) = (x, f_x, y, f_y);
            y = a + golden * (b - a);
            f_y = f(y)?;
        }
    }
    Ok(Some(best))
}

/// Works like [`minimum`], for three points with known values, of which the middle one is lowest.
/// The square of `f` must be smooth, as for the absolute value of a smooth function. The minimum of
/// the parabola through the squares then converges within a few evaluations. If it does not, the
/// golden section search continues.
///
/// # Errors
/// Returns the errors of `f`.
pub fn corner<E>(
    [mut low, mut middle, mut high]: [(f64, f64); 3],
    limit: f64,
    enough: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<(f64, f64)>, E> {
    for _ in 0..CORNER_STEPS {
        let narrow = enough.max(RESOLUTION * low.0.abs().max(high.0.abs()));
        if high.0 - low.0 <= 4.0 * narrow || middle.1 == 0.0 {
            return Ok(Some(middle));
        }
        let slope = |(t, x): (f64, f64)| (x * x - middle.1 * middle.1) / (t - middle.0);
        let (before, after) = (slope(low), slope(high));
        let bend = (after - before) / (high.0 - low.0);
        // The derivative of the parabola at the middle point.
        let along = before + bend * (middle.0 - low.0);
        let vertex = middle.0 - 0.5 * along / bend;
        // Points next to the middle point, first on the side of the vertex, enclose the minimum.
        let [is_below, is_above] =
            [middle.0 - low.0, high.0 - middle.0].map(|width| width <= 2.0 * narrow);
        let t = if (vertex - middle.0).abs() >= narrow {
            vertex
        } else if is_below || vertex > middle.0 && !is_above {
            middle.0 + narrow
        } else {
            middle.0 - narrow
        };
        if !(low.0 < t && t < high.0) || t == middle.0 {
            break;
        }
        let found = (t, f(t)?);
        let (inner, outer) = if found.1 < middle.1 {
            (found, middle)
        } else {
            (middle, found)
        };
        if outer.0 < inner.0 {
            low = outer;
        } else {
            high = outer;
        }
        middle = inner;
    }
    minimum([low.0, high.0], limit, enough, f)
}

fn lower(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    if b.1 < a.1 { b } else { a }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    #[test]
    fn roots_to_rounding_also_multiple_ones() {
        let found = |f: &dyn Fn(f64) -> f64| {
            root([0.0, 2.0], [f(0.0), f(2.0)], 0.0, |t| {
                Ok::<_, Infallible>(f(t))
            })
            .unwrap()
        };
        assert!((found(&|t| 2.0 - t * t) - 2f64.sqrt()).abs() < 1e-15);
        assert!((found(&|t| (0.3 - t).powi(3)) - 0.3).abs() < 1e-14);
        assert!((found(&|t| if t < 1.7 { 1e-9 } else { -1.0 }) - 1.7).abs() < 1e-14);
    }

    #[test]
    fn edges_from_both_sides() {
        for (ends, expected) in [([0.0, 2.0], 1.5), ([7.0, 2.0], 2.5)] {
            let mut asked = 0;
            let t = edge(ends, |t| {
                asked += 1;
                Ok::<_, Infallible>((t - 2.0).powi(2) - 0.25)
            });
            assert!(
                (t.unwrap() - expected).abs() < 1e-9 && asked <= 20,
                "{asked}"
            );
        }
        assert_eq!(edge([1.0, 3.0], |t| Ok::<_, Infallible>(1.0 - t)), Ok(1.0));
    }

    #[test]
    fn minima_of_corners_and_parabolas() {
        let found = |limit: f64, f: &dyn Fn(f64) -> f64| {
            let mut asked = 0;
            let found = minimum([-1.0, 2.0], limit, 0.0, |t| {
                asked += 1;
                Ok::<_, Infallible>(f(t))
            });
            (found.unwrap(), asked)
        };
        let at = |f: &dyn Fn(f64) -> f64| found(0.0, f).0.unwrap().0;
        assert!((at(&|t| (t - 0.3).abs()) - 0.3).abs() < 1e-15);
        assert!((at(&|t| (t - 0.3).powi(2)) - 0.3).abs() < 1e-8);
        assert_eq!(at(&|t| t), -1.0);
        // A minimum that is a tenth above the limit takes few evaluations. A minimum that is a
        // tenth below the limit is found.
        let above = |t: f64| 0.1 + (t - 0.3).abs().sqrt();
        assert!(matches!(found(0.0, &|t| 0.1 + (t - 0.3).powi(2)), (None, asked) if asked < 14));
        assert!(matches!(found(0.0, &above), (None, asked) if asked < 24));
        assert!((found(0.11, &above).0.unwrap().0 - 0.3).abs() < 1e-15);
        // A root is as steep as a minimum at zero may be.
        assert!((at(&|t| (t - 0.3).abs().sqrt()) - 0.3).abs() < 1e-15);
        // A jump does not reach zero on any narrow interval.
        let jump = |t: f64| if t < 0.3 { 0.2 } else { 0.1 + 1e-3 * t };
        assert!(matches!(found(0.0, &jump), (None, asked) if asked < 30));
    }

    /// The absolute value of a smooth function, the root of a parabola that stays above zero, and a
    /// square root, whose square has a corner.
    #[test]
    fn corners_take_few_evaluations() {
        let found = |enough: f64, f: &dyn Fn(f64) -> f64| {
            let ends = [-1.0, 0.25, 2.0].map(|t| (t, f(t)));
            let mut asked = 0;
            let found = corner(ends, 0.1, enough, |t| {
                asked += 1;
                Ok::<_, Infallible>(f(t))
            });
            (found.unwrap().expect("a minimum").0, asked)
        };
        let smooth = |t: f64| (t - 0.3 + 0.2 * (t - 0.3).powi(2)).sin().abs();
        for (least, f) in [
            (0.3, &smooth as &dyn Fn(f64) -> f64),
            (0.4, &|t: f64| (0.01 + (t - 0.4).powi(2)).sqrt()),
        ] {
            let (t, asked) = found(1e-7, f);
            assert!(
                (t - least).abs() < 1e-6 && asked <= CORNER_STEPS,
                "{t}: {asked}"
            );
        }
        let (t, asked) = found(1e-7, &|t| (t - 0.3).abs().sqrt());
        assert!(
            (t - 0.3).abs() < 1e-6 && asked > CORNER_STEPS,
            "{t}: {asked}"
        );
    }
}
