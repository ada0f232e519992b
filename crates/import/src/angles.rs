//! Finds angles that are probably not in the unit of the file: degrees instead of radians, or
//! radians instead of degrees.

use crate::limits::{COMMON_ANGLE, TURN};

/// Suspicious angles of one kind: a description of the first angle, and the number of angles.
#[derive(Default)]
pub(crate) struct Suspects {
    first: Option<String>,
    count: usize,
}

impl Suspects {
    /// Records a value with a suspicious angle.
    pub(crate) fn see(&mut self, subject: &str, angle: f64, line: usize) {
        self.count += 1;
        self.first
            .get_or_insert_with(|| format!("{subject} in line {line} has {angle}"));
    }

    fn told(&self) -> Option<String> {
        let first = self.first.as_ref()?;
        let more = match self.count {
            1 => String::new(),
            n => format!(" (and {} more)", n - 1),
        };
        Some(format!("{first}{more}"))
    }
}

/// Whether an angle in rad is larger than one revolution, which suggests degrees.
pub(crate) fn is_beyond_a_turn(radians: f64) -> bool {
    radians.abs() > TURN
}

/// Whether an angle in degrees is a common fraction of a revolution in rad, such as 1.5708.
pub(crate) fn is_common_in_radians(degrees: f64) -> bool {
    use std::f64::consts::PI;
    let part = |unit: f64| {
        let times = (degrees / unit).round();
        times != 0.0 && times.abs() <= 12.0 && (degrees - times * unit).abs() <= COMMON_ANGLE
    };
    // An integer counts as degrees even if it is close to such a fraction (22 ≈ 7π).
    degrees.fract() != 0.0 && (part(PI / 4.0) || part(PI / 6.0))
}

/// Remarks on suspected degrees instead of radians, and on suspected radians instead of degrees.
pub(crate) fn remarks(degrees: &Suspects, radians: &Suspects) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(told) = degrees.told() {
        out.push(format!(
            "Does this file use degrees? {told}, which is more than one revolution. Angles are read in rad."
        ));
    }
    if let Some(told) = radians.told() {
        out.push(format!(
            "Does this file use radians? {told}, but angles are read in degrees: <compiler angle=\"radian\"/> \
             says otherwise."
        ));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_another_unit_are_seen() {
        let number = |word: &str| -> f64 { word.parse().expect("a number") };
        for x in ["1.5708", "-1.57", "3.14159", "0.785", "0.5236", "-2.0944"] {
            assert!(is_common_in_radians(number(x)), "{x}");
        }
        for x in [0.0, 90.0, 1.5, 0.7, 30.0, 2.5, 1.0, 45.5] {
            assert!(!is_common_in_radians(x), "{x}");
        }
        assert!(is_beyond_a_turn(-90.0) && !is_beyond_a_turn(number("6.2832")));
    }
}
