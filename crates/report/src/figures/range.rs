//! Range and distribution of a quantity over many samples.

use serde::Serialize;

/// A number over all samples in which it exists.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RangeDocument {
    /// Number of samples.
    pub samples: u64,
    /// Value for the described data; `null` if the number is not unique for these data.
    pub described: Option<f64>,
    /// The least value.
    pub least: f64,
    /// The greatest value.
    pub greatest: f64,
    /// The mean.
    pub mean: f64,
    /// The standard deviation.
    pub deviation: f64,
    /// Percentiles: 5, 50 and 95 % of the samples are below these values.
    pub percentiles: [f64; 3],
    /// Histogram of the values.
    pub histogram: HistogramDocument,
}

/// Numbers of values in intervals of the same width.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HistogramDocument {
    /// Start of the first interval.
    pub from: f64,
    /// End of the last interval.
    pub to: f64,
    /// Number of values in each interval.
    pub counts: Vec<u64>,
    /// Number of values before the first and after the last interval, from few distant samples.
    pub outside: [u64; 2],
}

/// Number of intervals of a histogram.
const INTERVALS: usize = 24;

/// Extension of a histogram on each side, as a multiple of the width of its central range. The
/// central range contains the middle nine tenths of the values. Samples outside of the histogram
/// are counted, but not drawn.
const ROOM: f64 = 1.0;

impl RangeDocument {
    /// Returns the range of these values. `described` is the value for the described data, if there
    /// is such a value. Values that are not finite are omitted. Returns `None` if no value remains.
    ///
    /// ```
    /// use pfaff_report::figures::RangeDocument;
    /// let range = RangeDocument::of([1.0, 2.0, f64::NAN, 6.0], Some(2.5)).unwrap();
    /// assert_eq!((range.samples, range.least, range.greatest, range.mean), (3, 1.0, 6.0, 3.0));
    /// assert!(RangeDocument::of([f64::NAN], None).is_none());
    /// ```
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>, described: Option<f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().filter(|x| x.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (&least, &greatest) = (sorted.first()?, sorted.last()?);
        let n = sorted.len() as f64;
        // The differences from the first value are summed in ascending order. This avoids overflow
        // and large rounding errors.
        let mean = least + sorted.iter().map(|x| (x - least) / n).sum::<f64>();
        let variance = sorted
            .iter()
            .map(|x| (x - mean) * (x - mean) / n)
            .sum::<f64>();
        // Returns the smallest value for which at least this share of the samples is not larger
        // than the value.
        let below = |share: f64| sorted[((share * n).ceil() as usize).clamp(1, sorted.len()) - 1];
        let percentiles = [0.05, 0.5, 0.95].map(below);
        let room = ROOM * (percentiles[2] - percentiles[0]);
        let from = least.max(percentiles[0] - room);
        let to = greatest.min(percentiles[2] + room);
        Some(Self {
            samples: sorted.len() as u64,
            described,
            least,
            greatest,
            mean: mean.clamp(least, greatest),
            deviation: variance.sqrt(),
            percentiles,
            histogram: HistogramDocument::of(&sorted, from, to),
        })
    }

    /// Width of the range.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.greatest - self.least
    }
}

impl HistogramDocument {
    fn of(sorted: &[f64], from: f64, to: f64) -> Self {
        let mut counts = vec![0; INTERVALS];
        let mut outside = [0; 2];
        for &x in sorted {
            let share = (x - from) / (to - from);
            match share {
                _ if x < from => outside[0] += 1,
                _ if x > to => outside[1] += 1,
                // All values are equal.
                _ if share.is_nan() => counts[INTERVALS / 2] += 1,
                _ => counts[((share * INTERVALS as f64) as usize).min(INTERVALS - 1)] += 1,
            }
        }
        Self {
            from,
            to,
            counts,
            outside,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_whole_numbers_are_those_of_the_textbook() {
        let range = RangeDocument::of((1..=100).map(f64::from), None).expect("numbers");
        assert_eq!(
            (range.least, range.greatest, range.width()),
            (1.0, 100.0, 99.0)
        );
        assert!((range.mean - 50.5).abs() < 1e-12);
        // For the integers 1 to n, the variance is (n² − 1)/12.
        assert!((range.deviation - (9999.0_f64 / 12.0).sqrt()).abs() < 1e-12);
        assert_eq!(range.percentiles, [5.0, 50.0, 95.0]);
        assert_eq!(range.histogram.counts.iter().sum::<u64>(), 100);
    }

    #[test]
    fn values_far_outside_are_counted_and_do_not_squeeze_the_others() {
        let mut values = vec![1e9, -1e9];
        values.extend((0..98).map(f64::from));
        let range = RangeDocument::of(values, Some(3.0)).expect("numbers");
        assert_eq!(range.histogram.outside, [1, 1]);
        assert!(range.histogram.to < 300.0, "{range:?}");
        assert_eq!(range.histogram.counts.iter().sum::<u64>(), 98);
    }

    #[test]
    fn equal_values_have_a_range_of_width_zero() {
        let range = RangeDocument::of([2.0; 5], Some(2.0)).expect("numbers");
        assert_eq!(
            (range.width(), range.mean, range.deviation),
            (0.0, 2.0, 0.0)
        );
        assert_eq!(range.histogram.counts.iter().sum::<u64>(), 5);
    }
}
