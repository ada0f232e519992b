//! The largest values of reactions over a run. Only determined values in the table count. It is not
//! known until the end of the run which values are determined, so a peak is stored for each
//! interval between two boundaries.

use solvability::{Value, VerdictTrack};

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

    /// Adds a boundary. If the boundary is before the last row, the values on both sides are
    /// separated only from the next row onwards.
    pub fn cut(&mut self, t: f64) {
        let place = self.cuts.partition_point(|cut| *cut < t);
        if self.cuts.get(place) != Some(&t) {
            self.cuts.insert(place, t);
            if place < self.passed {
                self.passed += 1;
            }
        }
    }

    /// Adds a row, with a value for each column. NaN does not count as a value.
    pub fn row(&mut self, t: f64, values: impl IntoIterator<Item = f64>) {
        let passed = self.cuts.partition_point(|cut| *cut <= t);
        let begins = passed > self.passed;
        self.passed = self.passed.max(passed);
        for (peaks, value) in self.columns.iter_mut().zip(values) {
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

    /// Returns the peak of each column, or `None` for a column without a determined value. The
    /// verdicts on a column are `None` if the column is determined on the whole run. `extent` is
    /// the time interval of the run (s).
    #[must_use]
    pub fn finish(
        &self,
        verdicts: &[Option<&VerdictTrack>],
        extent: [f64; 2],
    ) -> Vec<Option<Peak>> {
        let of = |(track, peaks): (&Option<&VerdictTrack>, &Vec<[f64; 2]>)| {
            let value = |number: f64, t: f64| {
                track.map_or_else(|| Value::unique(number), |track| track.value(t, number))
            };
            let determined = |&[number, t]: &[f64; 2]| {
                let number = value(number, t).determined();
                Some([number.filter(|number| number.is_finite())?, t])
            };
            // If several values are equal, the first value is returned.
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
                over: track.map_or_else(|| vec![extent], VerdictTrack::determined),
            })
        };
        verdicts.iter().zip(&self.columns).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use solvability::{Verdict, VerdictStretch};

    use super::*;

    /// The largest value may be in an interval in which the value depends on the selected solution
    /// for the multipliers. The peak is the largest value in the determined interval.
    #[test]
    fn a_peak_is_one_of_determined_cells() {
        let mut peaks = PeakRecorder::new(1, &[1.0]);
        for (t, value) in [(0.0, 2.0), (0.5, -5.0), (1.0, 90.0), (2.0, 100.0)] {
            peaks.row(t, [value]);
        }
        let stretch = |from, to, verdict| VerdictStretch { from, to, verdict };
        let track = VerdictTrack::of([
            stretch(0.0, 1.0, Verdict::Unique),
            stretch(1.0, 2.0, Verdict::NotUnique),
        ]);
        let found = peaks.finish(&[Some(&track)], [0.0, 2.0]);
        let peak = Peak {
            value: Value::unique(-5.0),
            time: 0.5,
            over: vec![[0.0, 1.0]],
        };
        assert_eq!(found, [Some(peak)]);
    }

    /// The peak is the first of equal values, and NaN is no value.
    #[test]
    fn a_peak_is_the_first_of_equals() {
        let mut peaks = PeakRecorder::new(1, &[]);
        for (t, value) in [(0.0, f64::NAN), (1.0, 0.0), (2.0, -3.0), (3.0, 3.0)] {
            peaks.row(t, [value]);
        }
        peaks.row(4.0, [f64::NAN]);
        let peak = Peak {
            value: Value::unique(-3.0),
            time: 2.0,
            over: vec![[0.0, 4.0]],
        };
        assert_eq!(peaks.finish(&[None], [0.0, 4.0]), [Some(peak)]);
    }
}
