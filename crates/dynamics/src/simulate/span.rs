//! Is a row of output where the step around it leads? Between the ends of a step nothing is checked by the error test: near a singular
//! configuration dense output, or the completion of its independent entries, may be on another branch, on the constraints all the same.

use model::{Mechanism, System};

use crate::error::Trip;

/// A row may lie so far from the cubic through both ends of its step, as share of the way of the step, and beside.
const LED: f64 = 0.25;
const LED_AT_REST: f64 = 1e-3;

/// Velocities on a way may be so many times those of going it evenly.
const PEAK: f64 = 3.0;

/// An accepted step: times, and y0, f0, y1, f1.
#[derive(Default)]
pub(super) struct Span {
    times: [f64; 2],
    ends: [Vec<f64>; 4],
}

impl Span {
    /// Takes the last accepted step.
    pub(super) fn take(&mut self, times: [f64; 2], ends: [&[f64]; 4]) {
        self.times = times;
        for (kept, x) in self.ends.iter_mut().zip(ends) {
            kept.clear();
            kept.extend_from_slice(x);
        }
    }

    /// Checks a projected row y = [q; v; …] at time t, lengths measured by `size`.
    ///
    /// # Errors
    /// [`Trip::FarRow`]
    pub(super) fn check(
        &self,
        mechanism: &Mechanism,
        size: f64,
        t: f64,
        y: &[f64],
    ) -> Result<(), Trip> {
        let [t0, t1] = self.times;
        if !(t0 < t && t < t1) {
            return Ok(());
        }
        let led = self.cubic(t);
        let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
        let [y0, f0, y1, f1] = &self.ends;
        let h = t1 - t0;
        let change = |i: usize| h * f0[i].abs().max(f1[i].abs());
        let longest = |a: f64, i: usize| {
            let way = change(i).max((y1[i] - y0[i]).abs());
            a.max(way / mechanism.unit(i, size))
        };
        let way = (0..n_q).fold(0.0, longest);
        let (place, by) = mechanism.largest_difference(&y[..n_q], &led[..n_q], size);
        let norm = |x: &dyn Fn(usize) -> f64| -> f64 {
            let terms = (n_q..n_q + n_v).zip(mechanism.mass());
            terms.map(|(i, m)| m * x(i) * x(i)).sum::<f64>().sqrt()
        };
        let kink = norm(&|i| y[i] - led[i]);
        let speed = norm(&|i| y0[i].abs().max(y1[i].abs()) + change(i));
        // A long step of a drive may begin and end at rest.
        let mean = norm(&|i| (way + LED_AT_REST) * mechanism.unit(i - n_q, size) / h);
        if by <= LED * way + LED_AT_REST && kink <= LED * speed + PEAK * mean {
            return Ok(());
        }
        let (body, coordinate) = mechanism.coordinate(place);
        Err(Trip::FarRow {
            time: t,
            body: body.to_owned(),
            coordinate,
            by,
        })
    }

    /// The cubic Hermite interpolant of both ends at t.
    fn cubic(&self, t: f64) -> Vec<f64> {
        let [t0, t1] = self.times;
        let [y0, f0, y1, f1] = &self.ends;
        let (h, x) = (t1 - t0, (t - t0) / (t1 - t0));
        let rest = 1.0 - x;
        let (a, b, c) = (x * x * (3.0 - 2.0 * x), x * rest * rest, -x * x * rest);
        let value = |i: usize| y0[i] + a * (y1[i] - y0[i]) + h * (b * f0[i] + c * f1[i]);
        (0..y0.len()).map(value).collect()
    }
}
