//! Constraint violations (misfits) of redundant rows. Rows that are redundant only within a stated
//! tolerance may be violated up to a bound. The bound is computed from the tolerance of the data.
//! The violation of such a row is a result of the motion.
//!
//! Let `z` be 1 at a redundant row, and minus the coefficients at the independent rows that imply
//! it. Then the bound is `3·Σ τ_j·|zᵀ·∂Φ/∂d_j|` over all data d_j with their tolerances τ_j. For
//! velocities the bound is `3·Σ τ_j·|zᵀ·∂(C·v)/∂d_j|`. The factor 3 is [`model::SHARED`]. This
//! factor accounts for rows that share a violation, and for the pose, which changes with the data.

use model::words::quantity;
use model::{Bodies, DataBlock, Level, RowLabel, System};

use super::evaluation::Evaluation;
use super::rows::KeptRows;
use crate::error::MotionFault;
use crate::limits::SAME_MISFIT;

/// Largest constraint violation of a redundant row during a motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Misfit {
    /// The row, from 0.
    pub row: usize,
    /// Name of the row.
    pub label: RowLabel,
    /// Unit of the violation: m or rad, and per second for a nonholonomic row.
    pub unit: &'static str,
    /// Largest |Φ| of the row (|C·v − b| of a nonholonomic row), in the unit of the violation.
    pub largest: f64,
    /// Time of the largest violation (s).
    pub time: f64,
    /// Violation that data within their tolerances can cause at this time, in the unit of the row.
    pub bound: f64,
    /// For a row of angles, the violation times the size of the mechanism (m, or m/s).
    pub at_size: Option<f64>,
}

/// Record of the constraint violations of a motion.
#[derive(Clone)]
pub(crate) struct Misfits {
    blocks: Vec<DataBlock>,
    /// Gradient with respect to all data of the constraints.
    gradient: Vec<f64>,
    /// Coefficients of all rows.
    z: Vec<f64>,
    /// The state last checked, and the previous accepted state.
    here: Instant,
    before: Option<Instant>,
    found: Vec<Misfit>,
    /// Poses of the bodies at the start.
    start: Bodies,
}

/// Residuals of the redundant rows at one time.
#[derive(Clone, Default)]
struct Instant {
    t: f64,
    rows: Vec<Residual>,
}

/// The residual of a redundant row.
#[derive(Clone, Copy)]
struct Residual {
    row: usize,
    /// Value of Φ, or of `C·v − b` for a nonholonomic row.
    value: f64,
    /// Rate dΦ/dt; `None` for a nonholonomic row.
    rate: Option<f64>,
    /// Largest residual that the data can cause, if the residual is larger than rounding errors.
    bound: Option<f64>,
}

impl Misfits {
    /// Creates an empty record. `at` must have been evaluated at the start.
    pub(crate) fn new(at: &Evaluation<'_>) -> Self {
        let data = at.mechanism.data();
        Self {
            blocks: data.blocks(&at.s),
            gradient: vec![0.0; data.count()],
            z: vec![0.0; at.mechanism.layout().rows()],
            here: Instant::default(),
            before: None,
            found: Vec::new(),
            start: at.s.bodies.clone(),
        }
    }

    /// Returns the largest residual of the redundant row i at a level that can result from data
    /// within their tolerances. The rows must be factored.
    pub(crate) fn bound(
        &mut self,
        (at, rows): (&Evaluation<'_>, &mut KeptRows),
        i: usize,
        level: &Level<'_>,
    ) -> Result<f64, MotionFault> {
        rows.dependency(at, i, &mut self.z)?;
        let (data, gradient) = (at.mechanism.data(), &mut self.gradient);
        Ok(data.explained(&at.s, &self.blocks, &self.z, level, gradient))
    }

    /// Starts the record of a state at time t.
    pub(crate) fn look_at(&mut self, t: f64) {
        self.here.t = t;
        self.here.rows.clear();
    }

    /// Records the residual of a redundant row at this state, at the level of velocities or of
    /// positions.
    pub(crate) fn see(
        &mut self,
        is_of_velocities: bool,
        row: usize,
        residual: f64,
        bound: Option<f64>,
        at: &Evaluation<'_>,
    ) {
        let is_holonomic = row < at.mechanism.layout().m;
        let known = self.here.rows.iter_mut().find(|r| r.row == row);
        match (is_of_velocities && is_holonomic, known) {
            (true, Some(known)) => known.rate = Some(residual),
            (true, None) => {}
            (_, Some(known)) => (known.value, known.bound) = (residual, bound),
            (_, None) => self.here.rows.push(Residual {
                row,
                value: residual,
                rate: None,
                bound,
            }),
        }
    }

    /// Accepts the state last checked as a state of the motion. The state is either an output row,
    /// or the end of a step, within which the largest violations may occur.
    pub(crate) fn accept(&mut self, at: &Evaluation<'_>, is_end_of_step: bool) {
        for k in 0..self.here.rows.len() {
            let now = self.here.rows[k];
            let Some(bound) = now.bound else {
                continue;
            };
            self.take(at, now.row, (self.here.t, now.value), bound);
            let before = self.before.as_ref().filter(|_| is_end_of_step);
            let Some(before) = before else { continue };
            let start = before.rows.iter().find(|r| r.row == now.row);
            let rates = start.and_then(|s| Some([s.rate?, now.rate?]));
            if let (Some(start), Some(rates)) = (start, rates) {
                let times = [before.t, self.here.t];
                if let Some(peak) = peak(times, [start.value, now.value], rates) {
                    self.take(at, now.row, peak, bound);
                }
            }
        }
        if is_end_of_step {
            let before = self.before.get_or_insert_default();
            std::mem::swap(before, &mut self.here);
        }
    }

    /// Deletes the last step from the record, because other independent rows are used from now on.
    pub(crate) fn interrupt(&mut self) {
        self.before = None;
    }

    fn take(&mut self, at: &Evaluation<'_>, row: usize, (time, value): (f64, f64), bound: f64) {
        let layout = at.mechanism.layout();
        let k = match self.found.binary_search_by_key(&row, |m| m.row) {
            Ok(k) => k,
            Err(k) => {
                let unit = match (layout.is_angular(row), row < layout.m) {
                    (false, true) => "m",
                    (false, false) => "m/s",
                    (true, true) => "rad",
                    (true, false) => "rad/s",
                };
                let misfit = Misfit {
                    row,
                    label: at.label(row),
                    unit,
                    largest: 0.0,
                    time,
                    bound,
                    at_size: None,
                };
                self.found.insert(k, misfit);
                k
            }
        };
        let misfit = &mut self.found[k];
        // The stored time is the first time of a violation that does not grow further.
        if value.abs() > misfit.largest * (1.0 + SAME_MISFIT) {
            misfit.largest = value.abs();
            (misfit.time, misfit.bound) = (time, bound);
            misfit.at_size = layout.is_angular(row).then(|| value.abs() * at.size);
        }
    }

    /// Returns the constraint violations so far, by row.
    pub(crate) fn found(&self) -> &[Misfit] {
        &self.found
    }

    /// Describes how far the mechanism has moved since its start. The description contains the body
    /// with the largest rotation, or the body with the largest translation relative to the size of
    /// the mechanism.
    pub(crate) fn way(&self, at: &Evaluation<'_>) -> String {
        let bodies = &at.s.bodies;
        let moved = (0..bodies.len()).map(|body| bodies.moved(&self.start, body));
        let far = |[by, turned]: [f64; 2]| (by / at.size).max(turned);
        let farthest = moved
            .enumerate()
            .max_by(|a, b| far(a.1).total_cmp(&far(b.1)));
        let Some((body, [by, turned])) = farthest else {
            return String::from("nothing moved");
        };
        let name = &at.mechanism.bodies()[body].name;
        format!(
            "`{name}` turned by {:.1}° and moved by {by}",
            turned.to_degrees(),
            by = quantity(by, "m")
        )
    }
}

/// Returns the time and the value of the extremum of a cubic between two times, given the values
/// and rates of the cubic at these times. Returns `None` if there is no extremum inside.
fn peak([t0, t1]: [f64; 2], [y0, y1]: [f64; 2], [r0, r1]: [f64; 2]) -> Option<(f64, f64)> {
    let h = t1 - t0;
    let (m0, m1, d) = (r0 * h, r1 * h, y1 - y0);
    // y = y0 + m0·x + b·x² + a·x³, 0 ≤ x ≤ 1
    let (a, b) = (m0 + m1 - 2.0 * d, 3.0 * d - 2.0 * m0 - m1);
    let value = |x: f64| y0 + x * (m0 + x * (b + x * a));
    // The numerically stable form of both roots of 3·a·x² + 2·b·x + m0.
    let discriminant = b * b - 3.0 * a * m0;
    let w = -(b + discriminant.max(0.0).sqrt().copysign(b));
    let roots = [w / (3.0 * a), m0 / w];
    let inside = roots
        .into_iter()
        .filter(|x| discriminant >= 0.0 && *x > 0.0 && *x < 1.0);
    inside
        .map(|x| (t0 + x * h, value(x)))
        .max_by(|p, q| p.1.abs().total_cmp(&q.1.abs()))
}

#[cfg(test)]
mod tests {
    use super::peak;

    /// 5·sin(t) between 1.3 and 1.9 s: the cubic is accurate to h⁴·5/384 = 1.7e-3.
    #[test]
    fn a_peak_within_a_step_is_found() {
        let (y, rate) = (|t: f64| 5.0 * t.sin(), |t: f64| 5.0 * t.cos());
        let (from, to) = (1.3, 1.9);
        let found = peak([from, to], [y(from), y(to)], [rate(from), rate(to)]);
        let (t, value) = found.expect("a maximum between");
        assert!((value - 5.0).abs() < 1.7e-3, "{value}");
        assert!((t - std::f64::consts::FRAC_PI_2).abs() < 1e-2, "{t}");
        assert_eq!(peak([0.0, 1.0], [0.0, 1.0], [1.0, 1.0]), None);
        // The peak of a parabola is exact.
        let (t, value) = peak([0.0, 2.0], [0.0, 0.0], [2.0, -2.0]).expect("a parabola");
        assert!((t - 1.0).abs() < 1e-12 && (value - 1.0).abs() < 1e-12);
    }
}
