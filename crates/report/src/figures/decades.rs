//! Axes of powers of ten.

use super::axis::{Axis, Tick, power_of_ten, range};

/// Unit of the values of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// Numbers without a unit.
    Number,
    /// Times (s).
    Seconds,
    /// No labels, because the neighbouring axis has the same labels.
    Untold,
}

/// Space beyond the first and the last value, in decades.
const MARGIN: f64 = 0.2;

/// Creates an axis over these logarithms. The axis has at least two and at most `count` + 1 labels
/// at powers of ten.
pub(super) fn decades(logarithms: impl IntoIterator<Item = f64>, unit: Unit, count: i32) -> Axis {
    let [low, high] = range(logarithms).unwrap_or([0.0, 1.0]);
    let (mut low, mut high) = (low - MARGIN, high + MARGIN);
    if high.floor() - low.ceil() < 1.0 {
        low = low.floor();
        high = high.ceil().max(low + 1.0);
    }
    let (first, last) = (low.ceil() as i32, high.floor() as i32);
    let step = (last - first + count - 1).div_euclid(count).max(1);
    let first = first + (-first).rem_euclid(step);
    let ticks = (first..=last).step_by(step as usize).map(|power| Tick {
        value: f64::from(power),
        label: match unit {
            Unit::Number => power_of_ten(power),
            Unit::Seconds => time(power),
            Unit::Untold => String::new(),
        },
    });
    Axis {
        min: low,
        max: high,
        ticks: ticks.collect(),
        exponent: 0,
    }
}

/// Formats 10^power seconds, such as `10 µs`.
fn time(power: i32) -> String {
    let (unit, base) = match power {
        ..=-7 => ("ns", -9),
        -6..=-4 => ("µs", -6),
        -3..=-1 => ("ms", -3),
        0.. => ("s", 0),
    };
    format!("{} {unit}", 10_f64.powi(power - base))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|t| t.label.as_str()).collect()
    }

    #[test]
    fn labels_stand_at_multiples_of_their_step() {
        let axis = decades([-12.4, -0.2], Unit::Number, 6);
        assert_eq!((axis.min, axis.max), (-12.4 - MARGIN, -0.2 + MARGIN));
        assert_eq!(
            labels(&axis),
            ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "1"]
        );
    }

    #[test]
    fn times_have_units() {
        let axis = decades([-6.0, 1.0], Unit::Seconds, 9);
        assert_eq!(
            labels(&axis),
            [
                "1 µs", "10 µs", "100 µs", "1 ms", "10 ms", "100 ms", "1 s", "10 s"
            ]
        );
    }

    #[test]
    fn a_single_value_and_none_have_an_axis() {
        assert_eq!(labels(&decades([2.5], Unit::Number, 4)), ["10²", "10³"]);
        assert_eq!(labels(&decades([], Unit::Number, 4)), ["1", "10"]);
    }
}
