//! Options of the command line that change values of a scene or the accuracy of the data.

use clap::Args;
use pfaff::model::Tolerance;
use pfaff::scene::{Setting, in_si};

/// Other numbers in a scene.
#[derive(Args, Clone, Default)]
pub(crate) struct Settings {
    /// Override a parameter or scene key, e.g. L=0.4, L="400 mm" or body.crank.mass=2; repeatable
    #[arg(long = "set", value_name = "NAME=EXPR")]
    pub(crate) list: Vec<Setting>,
    /// Use the values of a load case ([[case]] of the scene); --set takes precedence
    #[arg(long, value_name = "NAME")]
    pub(crate) case: Option<String>,
}

/// Other numbers in a scene, and other tolerances of its data.
#[derive(Args, Clone, Default)]
pub(crate) struct SceneOptions {
    #[command(flatten)]
    pub(crate) settings: Settings,
    /// Override the tolerance of points and lengths (m, or e.g. 0.1mm)
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = length)]
    pub(crate) tolerance: Option<f64>,
    /// Override the tolerance of directions, angles and ratios (rad, or e.g. 0.01deg) [default:
    /// LENGTH / size of the mechanism]
    #[arg(long, value_name = "RAD", allow_hyphen_values = true, value_parser = angle)]
    pub(crate) angle_tolerance: Option<f64>,
}

impl From<&SceneOptions> for Tolerance {
    fn from(known: &SceneOptions) -> Self {
        Self {
            length: known.tolerance,
            angle: known.angle_tolerance,
        }
    }
}

fn length(text: &str) -> Result<f64, String> {
    positive(
        text,
        "1 m",
        "a length > 0 in m, as 1e-4, or with its unit, as 0.1mm",
    )
}

fn angle(text: &str) -> Result<f64, String> {
    positive(
        text,
        "1 rad",
        "an angle > 0 in rad, as 1e-5, or with its unit, as 0.01deg",
    )
}

fn positive(text: &str, unit: &str, expected: &str) -> Result<f64, String> {
    let positive = in_si(text, unit).filter(|x| *x > 0.0);
    positive.ok_or_else(|| format!("need {expected}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_have_a_name_and_a_value() {
        let set = |text: &str| text.parse().map(|s: Setting| [s.key, s.expression]);
        let pair = |a: &str, b: &str| Ok([a.to_owned(), b.to_owned()]);
        assert_eq!(set("L = 2*25 mm"), pair("L", "2*25 mm"));
        assert_eq!(set("body.a=b.mass=2"), pair("body.a=b.mass", "2"));
        for wrong in ["", "L", "L=", "=2", " = "] {
            assert!(set(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_above_zero_are_tolerances() {
        assert_eq!(length("1e-4"), Ok(1e-4));
        assert_eq!(angle(" 2 "), Ok(2.0));
        assert_eq!(length("0.1mm"), Ok(1e-4));
        assert_eq!(length("0.1 mm"), Ok(1e-4));
        assert_eq!(angle("180deg"), Ok(std::f64::consts::PI));
        for wrong in [
            "0", "-1e-4", "nan", "inf", "1e-400", "0.1deg", "0.1 kg", "-1mm", "",
        ] {
            let refused = length(wrong).expect_err(wrong);
            assert!(refused.starts_with("need a length > 0 in m"), "{refused}");
        }
    }
}
