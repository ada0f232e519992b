//! Tolerances of the numbers of a scene that the command line states.

use clap::Args;
use pfaff::model::Tolerance;

#[derive(Args, Clone, Copy, Default)]
pub(crate) struct Known {
    /// Tolerance of points and lengths of the scene (m), in place of its `tolerance`
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = length)]
    pub(crate) tolerance: Option<f64>,
    /// Tolerance of directions, angles and ratios (rad), in place of `angle_tolerance`; if neither
    /// is given: LENGTH divided by the mechanism's size
    #[arg(long, value_name = "RAD", allow_hyphen_values = true, value_parser = angle)]
    pub(crate) angle_tolerance: Option<f64>,
}

impl From<Known> for Tolerance {
    fn from(known: Known) -> Self {
        Self {
            length: known.tolerance,
            angle: known.angle_tolerance,
        }
    }
}

fn length(text: &str) -> Result<f64, String> {
    positive(text, "a length in m > 0, as 1e-4")
}

fn angle(text: &str) -> Result<f64, String> {
    positive(text, "an angle in rad > 0, as 1e-5")
}

fn positive(text: &str, expected: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    let positive = number.filter(|x| x.is_finite() && *x > 0.0);
    positive.ok_or_else(|| format!("need {expected}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_above_zero_are_tolerances() {
        assert_eq!(length("1e-4"), Ok(1e-4));
        assert_eq!(angle(" 2 "), Ok(2.0));
        for wrong in ["0", "-1e-4", "nan", "inf", "1e-400", "0.1mm", ""] {
            let refused = length(wrong);
            assert_eq!(refused, Err("need a length in m > 0, as 1e-4".to_owned()));
        }
    }
}
