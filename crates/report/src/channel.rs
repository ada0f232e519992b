//! Writes curves as short text. Values are rounded to a fraction of the range of the curve. Each
//! value is written as the difference from the previous value.

use serde::Serialize;
use serde::ser::{SerializeSeq, Serializer};

/// Number of levels in the range of a curve; the rounding error is half a level.
pub const LEVELS: f64 = 100_000.0;

/// Number of significant digits of a value that is written without rounding to a level.
const DIGITS: usize = 6;

/// A curve over the frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Channel {
    /// The same value at all frames.
    Constant(FewDigits),
    /// The value at level 0, the height of a level, and the differences between the levels of
    /// consecutive values; `null` is a gap.
    Varying {
        /// The value at level 0.
        o: f64,
        /// Height of a level.
        s: FewDigits,
        /// Differences.
        d: Steps,
    },
}

/// A number with few digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FewDigits(pub f64);

/// Differences between the levels of consecutive values. `None` is a gap.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps(pub Vec<Option<i64>>);

impl Channel {
    /// Creates the curve of these values.
    #[must_use]
    pub fn new(values: impl Iterator<Item = f64> + Clone) -> Self {
        Self::above(0.0, values)
    }

    /// Value of the curve at the first frame.
    pub fn first(&self) -> f64 {
        match self {
            Self::Constant(value) => value.0,
            Self::Varying { o, s, d } => match d.0.first() {
                Some(Some(level)) => o + s.value() * *level as f64,
                _ => f64::NAN,
            },
        }
    }

    /// Creates the curve of these values. Values with an absolute value up to `noise` count as
    /// zero.
    pub fn above(noise: f64, values: impl Iterator<Item = f64> + Clone) -> Self {
        let values = values.map(|x| if x.abs() <= noise { 0.0 } else { x });
        let finite = values.clone().filter(|x| x.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
        let height = (high - low) / LEVELS;
        let has_gaps = values.clone().any(|x| !x.is_finite());
        if low > high {
            return Self::Constant(FewDigits(f64::NAN));
        }
        // A change below the rounding error of the values counts as no change.
        let flat = height <= f64::EPSILON * low.abs().max(high.abs());
        if flat && !has_gaps {
            return Self::Constant(FewDigits(low));
        }
        let height = if flat { 1.0 } else { FewDigits(height).value() };
        let mut last = 0;
        let steps = values.map(|x| {
            x.is_finite().then(|| {
                let level = ((x - low) / height).round() as i64;
                let step = level - last;
                last = level;
                step
            })
        });
        Self::Varying {
            d: Steps(steps.collect()),
            o: low,
            s: FewDigits(height),
        }
    }
}

impl FewDigits {
    /// The number that is written.
    pub fn value(self) -> f64 {
        if self.0.is_finite() && self.0 != 0.0 {
            format!("{:.*e}", DIGITS, self.0).parse().unwrap_or(self.0)
        } else {
            self.0
        }
    }
}

impl Serialize for FewDigits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = self.value();
        // The texts −0 and 3.0 would need more characters than 0 and 3.
        if value == value.trunc() && value.abs() < 1e9 {
            serializer.serialize_i64(value as i64)
        } else {
            serializer.serialize_f64(value)
        }
    }
}

impl Serialize for Steps {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(self.0.len()))?;
        for step in &self.0 {
            list.serialize_element(step)?;
        }
        list.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(channel: &Channel, n: usize) -> Vec<f64> {
        match channel {
            Channel::Constant(x) => vec![x.value(); n],
            Channel::Varying { o, s, d } => {
                let mut level = 0;
                let step = |step: &Option<i64>| {
                    step.map_or(f64::NAN, |step| {
                        level += step;
                        o + s.value() * level as f64
                    })
                };
                d.0.iter().map(step).collect()
            }
        }
    }

    #[test]
    fn a_curve_comes_back_within_half_a_level() {
        let values: Vec<f64> = (0..300)
            .map(|k| 7.0 + 3.0 * (0.1 * f64::from(k)).sin())
            .collect();
        let channel = Channel::new(values.iter().copied());
        for (a, b) in values.iter().zip(decoded(&channel, values.len())) {
            // The error is at most half a level plus the rounding error of the level height, summed
            // over all levels. The level height has six digits.
            assert!((a - b).abs() <= 6.0 * (0.5 / LEVELS + 5e-7), "{a} {b}");
        }
    }

    #[test]
    fn gaps_stay_gaps_and_constants_take_one_number() {
        let values = [1.0, f64::NAN, 3.0];
        let back = decoded(&Channel::new(values.into_iter()), 3);
        assert!(back[1].is_nan() && (back[2] - 3.0).abs() < 1e-5);
        let text = |values: &[f64]| {
            serde_json::to_string(&Channel::new(values.iter().copied())).expect("numbers")
        };
        assert_eq!(text(&[2.5, 2.5]), "2.5");
        assert_eq!(text(&[-0.0, 0.0]), "0");
        assert_eq!(text(&[f64::NAN; 2]), "null");
        assert_eq!(text(&[f64::NAN, 1.0]), r#"{"o":1.0,"s":1,"d":[null,0]}"#);
    }
}
