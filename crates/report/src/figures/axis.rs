//! Axes with a range, ticks at round values, and labels with the smallest number of digits that
//! distinguishes the labels.

/// An axis with its ticks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) min: f64,
    pub(super) max: f64,
    pub(super) ticks: Vec<Tick>,
    /// A value is its label times 10 to this exponent.
    pub(super) exponent: i32,
}

/// A tick of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: String,
}

/// Larger values cannot be drawn, because the difference of two such values could overflow.
pub(super) const DRAWABLE: f64 = 1e300;

/// Smallest width of a range relative to its values. A narrower range contains only rounding
/// errors.
const RESOLUTION: f64 = 1e-12;

/// Range of values that are written without a power of ten. In this range, labels have at most four
/// digits before the decimal point, or at most one zero directly after the decimal point.
const PLAIN: std::ops::Range<f64> = 1e-2..1e4;

/// Whether a value can be drawn.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() <= DRAWABLE
}

/// Smallest and largest drawable value.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    values
        .into_iter()
        .filter(|v| drawable(*v))
        .fold(None, |range, v| {
            let [min, max] = range.unwrap_or([v, v]);
            Some([min.min(v), max.max(v)])
        })
}

impl Axis {
    /// Creates an axis over exactly this range, with about `count` ticks.
    pub(super) fn over(range: [f64; 2], count: usize) -> Self {
        let [min, max] = widened(range);
        let size = min.abs().max(max.abs());
        let exponent = if PLAIN.contains(&size) {
            0
        } else {
            3 * (size.log10() / 3.0).floor() as i32
        };
        let step = round_step((max - min) / count.max(1) as f64);
        let unit = 10.0_f64.powi(exponent);
        let digits = (-(step / unit).log10() - 1e-9).ceil().clamp(0.0, 15.0) as usize;
        let (first, last) = ((min / step - 1e-9).ceil(), (max / step + 1e-9).floor());
        let ticks = (0..=(last - first).max(0.0) as usize).map(|k| {
            let value = (first + k as f64) * step + 0.0;
            Tick {
                value,
                label: with_minus(&format!("{:.digits$}", value / unit)),
            }
        });
        Self {
            min,
            max,
            ticks: ticks.collect(),
            exponent,
        }
    }

    /// Works like [`Self::over`], but adds a margin on both sides, so that extremes do not touch
    /// the frame.
    pub(super) fn around(range: [f64; 2], count: usize) -> Self {
        let [min, max] = widened(range);
        let margin = 0.06 * (max - min);
        Self::over([min - margin, max + margin], count)
    }

    /// Position of a value: 0 at the start, 1 at the end.
    pub(super) fn position(&self, value: f64) -> f64 {
        (value - self.min) / (self.max - self.min)
    }

    /// The unit, preceded by the power of ten of the labels.
    pub(super) fn unit(&self, unit: &str) -> String {
        if self.exponent == 0 {
            return unit.to_owned();
        }
        let power = power_of_ten(self.exponent);
        if unit.is_empty() || unit == "1" {
            power
        } else {
            format!("{power} {unit}")
        }
    }
}

/// Returns a range of nonzero width. If the given range is a single value, space is added on both
/// sides.
fn widened([min, max]: [f64; 2]) -> [f64; 2] {
    let size = min.abs().max(max.abs());
    if max - min > RESOLUTION * size && max - min >= f64::MIN_POSITIVE {
        return [min, max];
    }
    let middle = 0.5 * (min + max);
    let room = if size < f64::MIN_POSITIVE / RESOLUTION {
        1.0
    } else {
        0.1 * size
    };
    [middle - room, middle + room]
}

/// The smallest value that is at least `at_least` and is 1, 2 or 5 times a power of ten.
pub(super) fn round_step(at_least: f64) -> f64 {
    let power = 10.0_f64.powf(at_least.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|f| f * power >= at_least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

fn with_minus(label: &str) -> String {
    // The label −0.0 is written as 0.0.
    match label.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => label.to_owned(),
    }
}

/// A power of ten as text, such as `10⁻⁶`. The values 1 and 10 have no exponent.
pub(super) fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => {
            let digits = exponent.to_string();
            "10".chars()
                .chain(digits.chars().map(superscript))
                .collect()
        }
    }
}

fn superscript(digit: char) -> char {
    match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        d => d
            .to_digit(10)
            .and_then(|d| char::from_u32('⁰' as u32 + d))
            .unwrap_or(d),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|t| t.label.as_str()).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            labels(&Axis::over([0.0, 10.0], 5)),
            ["0", "2", "4", "6", "8", "10"]
        );
        assert_eq!(labels(&Axis::over([-0.3, 0.25], 4)), ["−0.2", "0.0", "0.2"]);
        assert_eq!(labels(&Axis::over([0.0, 1.0], 4)), ["0.0", "0.5", "1.0"]);
    }

    #[test]
    fn powers_of_ten_go_to_the_unit() {
        let axis = Axis::over([0.0, 2e-5], 4);
        assert_eq!(labels(&axis), ["0", "5", "10", "15", "20"]);
        assert_eq!(axis.unit("N·m"), "10⁻⁶ N·m");
        assert_eq!(Axis::over([0.0, 4e4], 4).unit("N"), "10³ N");
        assert_eq!(Axis::over([0.0, 4e13], 4).unit("1"), "10¹²");
        assert_eq!(Axis::over([0.0, 4.0], 4).unit("N"), "N");
    }

    #[test]
    fn degenerate_ranges_have_room_and_few_ticks() {
        let ranges = [
            [0.0, 0.0],
            [5.0, 5.0],
            [1.0, 1.0 + f64::EPSILON],
            [-DRAWABLE, DRAWABLE],
            [1e-320, 2e-320],
            [1e-290, 3e-290],
            [-1e300, -1e300],
        ];
        for r in ranges {
            let axis = Axis::around(r, 5);
            assert!(
                axis.max > axis.min && (1..12).contains(&axis.ticks.len()),
                "{r:?}: {axis:?}"
            );
            assert!((0.0..=1.0).contains(&axis.position(r[0])), "{r:?}");
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_out_of_range() {
        let values = [f64::NAN, 2.0, f64::INFINITY, -1.0, 1e305];
        assert_eq!(range(values), Some([-1.0, 2.0]));
        assert_eq!(range([f64::NAN]), None);
    }
}
