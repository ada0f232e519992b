//! Checks that an output row is on the path of its step. The error test checks only the ends of a
//! step. Near a singular configuration, dense output or the completion of its independent entries
//! may be on another branch, although it satisfies the constraints.

use model::{Mechanism, System};

use crate::error::MotionFault;
use crate::limits::{PEAK, ROW_DEVIATION, ROW_DEVIATION_AT_REST};

/// An accepted step, with its times and with y0, f0, y1, f1.
#[derive(Default)]
pub(super) struct Span {
    times: [f64; 2],
    ends: [Vec<f64>; 4],
    /// Sizes with which output rows of this step are compared. The sizes are computed at the first
    /// row of the step.
    sizes: Option<StepScales>,
    led: Vec<f64>,
}

/// Sizes of a step.
#[derive(Clone, Copy)]
struct StepScales {
    /// The longest displacement along a column of C, in units of the mechanism.
    way: f64,
    /// Momentum in the mass metric, for the velocities at the ends of the step and for a uniform
    /// motion over the same displacement.
    speed: f64,
    mean: f64,
}

impl Span {
    /// Stores the last accepted step.
    pub(super) fn take(&mut self, times: [f64; 2], ends: [&[f64]; 4]) {
        self.times = times;
        self.sizes = None;
        for (kept, x) in self.ends.iter_mut().zip(ends) {
            kept.clear();
            kept.extend_from_slice(x);
        }
    }

    /// Checks a projected output row y = [q; v; …] at time t. Lengths are divided by `size`.
    ///
    /// # Errors
    /// Returns [`MotionFault::FarRow`] if the row is far from the path of the step.
    pub(super) fn check(
        &mut self,
        mechanism: &Mechanism,
        size: f64,
        t: f64,
        y: &[f64],
    ) -> Result<(), MotionFault> {
        if self.lead(t).is_none() {
            return Ok(());
        }
        let StepScales { way, speed, mean } = match self.sizes {
            Some(sizes) => sizes,
            None => {
                let sizes = self.measure(mechanism, size);
                *self.sizes.insert(sizes)
            }
        };
        let n_q = mechanism.layout().n_q;
        let (q, v) = y.split_at(n_q);
        let (led_q, led_v) = self.led.split_at(n_q);
        let (column, by) = mechanism.largest_difference(q, led_q, size);
        let off = v.iter().zip(led_v).map(|(v, led)| v - led);
        let kink = momentum(mechanism.mass(), off);
        if by <= ROW_DEVIATION * way + ROW_DEVIATION_AT_REST
            && kink <= ROW_DEVIATION * speed + PEAK * mean
        {
            return Ok(());
        }
        let (body, coordinate) = mechanism.coordinate(column);
        Err(MotionFault::FarRow {
            time: t,
            body: body.to_owned(),
            coordinate,
            by,
        })
    }

    fn measure(&mut self, mechanism: &Mechanism, size: f64) -> StepScales {
        let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
        let unit = |j: usize| mechanism.space().unit(j, size);
        let mass = mechanism.mass();
        let [y0, f0, y1, f1] = &self.ends;
        let h = self.times[1] - self.times[0];
        let largest = |a: &[f64], b: &[f64], i: usize| a[i].abs().max(b[i].abs());
        let at_speed = |j: usize| h * largest(y0, y1, n_q + j) / unit(j);
        let (_, apart) = mechanism.largest_difference(&y1[..n_q], &y0[..n_q], size);
        let way = (0..n_v).map(at_speed).fold(apart, f64::max);
        let fastest = |i: usize| largest(y0, y1, i) + h * largest(f0, f1, i);
        StepScales {
            way,
            speed: momentum(mass, (n_q..n_q + n_v).map(fastest)),
            // A drive may be at rest at both ends of a long step.
            mean: momentum(
                mass,
                (0..n_v).map(|j| (way + ROW_DEVIATION_AT_REST) * unit(j) / h),
            ),
        }
    }

    /// Returns the predicted path at a time t between the ends of the step. The path is the cubic
    /// Hermite interpolant of the ends.
    pub(super) fn lead(&mut self, t: f64) -> Option<&[f64]> {
        let [t0, t1] = self.times;
        if !(t0 < t && t < t1) {
            return None;
        }
        let [y0, f0, y1, f1] = &self.ends;
        let (h, x) = (t1 - t0, (t - t0) / (t1 - t0));
        let rest = 1.0 - x;
        let (a, b, c) = (x * x * (3.0 - 2.0 * x), x * rest * rest, -x * x * rest);
        let ends = y0.iter().zip(y1).zip(f0.iter().zip(f1));
        let cubic = ends.map(|((y0, y1), (f0, f1))| y0 + a * (y1 - y0) + h * (b * f0 + c * f1));
        self.led.clear();
        self.led.extend(cubic);
        Some(&self.led)
    }
}

/// Returns the norm of a velocity in the mass metric.
fn momentum(mass: &[f64], v: impl Iterator<Item = f64>) -> f64 {
    mass.iter()
        .zip(v)
        .map(|(m, v)| m * v * v)
        .sum::<f64>()
        .sqrt()
}

#[cfg(test)]
mod tests {
    use model::{Body, Description};

    use super::*;

    /// Returns a free body of one kilogram and one kg·m². Lengths are in metres.
    fn body() -> Mechanism {
        let one = Body {
            name: "one".into(),
            mass: 1.0,
            inertia: 1.0,
            ..Body::default()
        };
        let description = Description {
            bodies: vec![one],
            ..Description::default()
        };
        Mechanism::build(&description).unwrap()
    }

    /// Returns whether an output row at 0.5 s with coordinate x and velocity v along x is accepted.
    /// The step takes 1 s and moves from x = 0 to `way` with the velocity `speed` at both ends.
    fn is_shown([x, v]: [f64; 2], way: f64, speed: f64) -> bool {
        let state = |x: f64, v: f64| [x, 0.0, 0.0, v, 0.0, 0.0];
        let mut span = Span::default();
        let rate = state(speed, 0.0);
        span.take(
            [0.0, 1.0],
            [&state(0.0, speed), &rate, &state(way, speed), &rate],
        );
        span.check(&body(), 1.0, 0.5, &state(x, v)).is_ok()
    }

    /// At the middle of the step, the cubic is at half of the displacement.
    #[test]
    fn rows_lie_where_their_step_leads() {
        // Deviations of less than a quarter of the displacement are accepted.
        assert!(is_shown([0.5 + 0.2, 1.0], 1.0, 1.0));
        assert!(!is_shown([0.5 + 0.3, 1.0], 1.0, 1.0));
        // At rest, deviations of less than a thousandth of the size are accepted.
        assert!(is_shown([0.8e-3, 0.0], 0.0, 0.0));
        assert!(!is_shown([1.5e-3, 0.0], 0.0, 0.0));
    }

    /// A displacement of one metre in a second, uniformly in three coordinates, has the momentum √3
    /// kg·m/s. Three times this momentum is 5.2 kg·m/s.
    #[test]
    fn a_drive_that_rests_at_both_ends_of_a_step_may_be_fast_between() {
        assert!(is_shown([0.5, 5.0], 1.0, 0.0));
        assert!(!is_shown([0.5, 5.5], 1.0, 0.0));
    }
}
