//! The largest values of reactions over a run. Only cells of the table with determined values
//! count. These cells are known only after the run, so a peak is stored for each interval between
//! two boundaries.

use solvability::{Stretches, Value};

use crate::tables::ReactionColumn;

/// The largest value of a column over its determined cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Peak {
    /// The value, with its sign (N, N·m).
    pub value: Value,
    /// The first time at which the value occurs (s).
    pub time: f64,
    /// The intervals on which the value is determined (s).
    pub over: Vec<[f64; 2]>,
}

/// Records the peaks of columns while rows are added.
#[derive(Clone, Debug, Default)]
pub struct PeakRecorder {
    /// Times at which the verdicts may change, ascending.
    cuts: Vec<f64>,
    /// Number of these times that are not after the last row.
    passed: usize,
    /// For each column and each interval between two boundaries, the time and the largest value, in
    /// the order of time.
    columns: Vec<Vec<[f64; 2]>>,
}

impl PeakRecorder {
    /// Creates a recorder for this number of columns, with the boundaries that are known in
    /// advance.
    #[must_use]
    pub fn new(columns: usize, cuts: &[f64]) -> Self {
        Self {
            cuts: cuts.to_vec(),
            passed: 0,
            columns: vec![Vec::new(); columns],
        }
    }

    /// Adds a boundary. If it is before the last row, the values on both sides are separated only
    /// from the next row on.
    pub fn cut(&mut self, t: f64) {
        let place = self.cuts.partition_point(|cut| *cut < t);
        if self.cuts.get(place) != Some(&t) {
            self.cuts.insert(place, t);
            if place < self.passed {
                self.passed += 1;
            }
        }
    }

    /// Adds a row. NaN does not count as a value.
    pub fn row(&mut self, t: f64, values: &[f64]) {
        let passed = self.cuts.partition_point(|cut| *cut <= t);
        let begins = passed > self.passed;
        self.passed = self.passed.max(passed);
        for (peaks, &value) in self.columns.iter_mut().zip(values) {
            match peaks.last_mut() {
                Some(peak) if !begins => {
                    if value.abs() > peak[0].abs() || peak[0].is_nan() {
                        *peak = [value, t];
                    }
                }
                _ => peaks.push([value, t]),
            }
        }
    }

    /// The peak of each column; `None` if no cell is determined.
    #[must_use]
    pub fn finish(&self, columns: &[ReactionColumn], stretches: &Stretches) -> Vec<Option<Peak>> {
        let of = |(column, peaks): (&ReactionColumn, &Vec<[f64; 2]>)| {
            let track = column.quantity.verdicts(stretches);
            let value = |number: f64, t: f64| column.quantity.value(stretches, t, number);
            let determined = |&[number, t]: &[f64; 2]| {
                let number = value(number, t).determined();
                Some([number.filter(|number| number.is_finite())?, t])
            };
            // If several values are equal, the first one is returned.
            let largest = peaks.iter().filter_map(determined).reduce(|best, peak| {
                if peak[0].abs() > best[0].abs() {
                    peak
                } else {
                    best
                }
            });
            largest.map(|[number, time]| Peak {
                value: value(number, time),
                time,
                over: track.map_or_else(|| vec![stretches.extent], |track| track.determined()),
            })
        };
        columns.iter().zip(&self.columns).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use model::ConstraintId;
    use solvability::{Verdict, VerdictTrack};

    use super::*;
    use crate::tables::{Column, Quantity};

    /// The largest value may be in an interval in which the value depends on the selected solution
    /// for the multipliers. The peak is the largest value in the determined interval.
    #[test]
    fn a_peak_is_one_of_determined_cells() {
        let column = ReactionColumn {
            column: Column {
                owner: "hinge".into(),
                kind: "reaction",
                number: "Fx",
                unit: "N",
            },
            quantity: Quantity::Component(ConstraintId(0), "Fx"),
            fragile: false,
        };
        let mut peaks = PeakRecorder::new(1, &[1.0]);
        for (t, value) in [(0.0, 2.0), (0.5, -5.0), (1.0, 90.0), (2.0, 100.0)] {
            peaks.row(t, &[value]);
        }
        let stretch = |from, to, verdict| solvability::VerdictStretch { from, to, verdict };
        let track = VerdictTrack::of([
            stretch(0.0, 1.0, Verdict::Unique),
            stretch(1.0, 2.0, Verdict::NotUnique),
        ]);
        let stretches = Stretches {
            extent: [0.0, 2.0],
            reactions: vec![solvability::ReactionStretches {
                id: ConstraintId(0),
                whole: track.clone(),
                components: vec![("Fx", track)],
            }],
            groups: Vec::new(),
        };
        let found = peaks.finish(&[column], &stretches);
        let peak = Peak {
            value: Value::unique(-5.0),
            time: 0.5,
            over: vec![[0.0, 1.0]],
        };
        assert_eq!(found, [Some(peak)]);
    }
}
