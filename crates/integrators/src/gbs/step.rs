//! One trial: columns until they agree.

use super::Extrapolation;
use super::order::Verdict;
use super::sequence::{COLUMNS, substeps, weights};
use crate::control::{StepControl, weighted_rms};
use crate::drive::evaluate;
use crate::error::Cause;
use crate::method::{Start, Stepper, Trial};
use crate::ode::Ode;
use crate::statistics::Statistics;

impl<O: Ode> Stepper<O> for Extrapolation {
    /// That of the target column.
    fn order(&self) -> i32 {
        2 * self.control.target as i32
    }

    /// Before the first substep of the longest column there may be.
    fn widest_gap(&self) -> f64 {
        0.5 / substeps(self.control.target + 1) as f64
    }

    fn control(&mut self) -> &mut dyn StepControl {
        &mut self.control
    }

    fn trial(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        y1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        if self.control.is_first {
            self.control.aim(start.tolerance.relative());
        }
        let is_fresh = self.control.is_first || trial.t1 == trial.leg.end;
        self.control.begin();
        let evaluations = &mut statistics.evaluations;
        self.column(ode, trial, start.y0, start.f0, 1, evaluations)?;
        for j in 2..=COLUMNS {
            self.column(ode, trial, start.y0, start.f0, j, evaluations)?;
            self.extrapolate(start.y0, j, y1);
            self.error = self.error_of(j, start, y1);
            match self.control.judge(j, trial.h.abs(), self.error, is_fresh) {
                Verdict::NextColumn => {}
                Verdict::Done => break,
            }
        }
        self.note_middle();
        Ok(())
    }

    fn error_norm(
        &mut self,
        _ode: &mut O,
        _trial: &Trial<'_>,
        _start: &Start<'_>,
        _scale: &[f64],
        _statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>> {
        Ok(self.error)
    }

    fn end_derivative(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y1: &[f64],
        f1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        evaluate(
            ode,
            trial.stage_time(1.0),
            y1,
            f1,
            &mut statistics.evaluations,
        )
    }
}

impl Extrapolation {
    /// Column j: `z_1 = h_j·f0`, `z_{m+1} = z_{m−1} + 2·h_j·f(t + m·h_j, y0 + z_m)`, z being the change of the state.
    pub(super) fn column<O: Ode>(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y0: &[f64],
        f0: &[f64],
        j: usize,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        let n = substeps(j);
        let h = trial.h / n as f64;
        let column = &mut self.columns[j - 1];
        let dim = y0.len();
        let (previous, present) = (&mut self.previous, &mut self.present);
        for i in 0..dim {
            (previous[i], present[i]) = (0.0, h * f0[i]);
        }
        for (m, f) in (1..n).zip(&mut column.f) {
            // The change since the start suffers less rounding than the state.
            for i in 0..dim {
                column.to_end[i] = y0[i] + present[i];
            }
            let t = trial.stage_time(m as f64 / n as f64);
            evaluate(ode, t, &column.to_end, f, evaluations)?;
            if 2 * m == n {
                column.to_middle.copy_from_slice(present);
            }
            for i in 0..dim {
                (previous[i], present[i]) = (present[i], previous[i] + 2.0 * h * f[i]);
            }
        }
        column.to_end.copy_from_slice(present);
        Ok(())
    }

    /// Columns 1 to j extrapolated.
    pub(super) fn extrapolate(&self, y0: &[f64], j: usize, y1: &mut [f64]) {
        let w = weights(1, j);
        for i in 0..y1.len() {
            let mut change = 0.0;
            for (w, column) in w[..j].iter().zip(&self.columns) {
                change += w * column.to_end[i];
            }
            y1[i] = y0[i] + change;
        }
    }

    /// Columns 1 to j against columns 2 to j, in the weighted norm.
    fn error_of(&mut self, j: usize, start: &Start<'_>, y1: &[f64]) -> f64 {
        let (all, rest) = (weights(1, j), weights(2, j));
        for i in 0..y1.len() {
            let mut error = 0.0;
            for l in 0..j {
                error += (all[l] - rest[l]) * self.columns[l].to_end[i];
            }
            self.present[i] = error;
        }
        start.tolerance.scale(start.y0, y1, &mut self.scale);
        weighted_rms(&self.present, &self.scale)
    }

    /// Change of the state and f at the middle of the step, from all columns.
    pub(super) fn note_middle(&mut self) {
        let last = self.control.last;
        let w = weights(1, last);
        for i in 0..self.to_middle.len() {
            (self.to_middle[i], self.f_middle[i]) = (0.0, 0.0);
            for (w, column) in w[..last].iter().zip(&self.columns) {
                self.to_middle[i] += w * column.to_middle[i];
                self.f_middle[i] += w * column.f[column.f.len() / 2][i];
            }
        }
    }
}
