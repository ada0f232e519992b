//! The tolerances of the data and their consequences, in sentences.

use pfaff::report::AnalysisDocument;

use crate::output::wrapped;

/// Returns an empty text if no tolerance is stated and no lower rank is near.
pub(super) fn describe(d: &AnalysisDocument) -> String {
    let data = &d.data;
    let near = match (data.lower_rank_from, data.lower_rank_here) {
        (Some(from), _) => Some(format!(
            "one row is redundant from a tolerance of {} on (`--tolerance {from:.1e}`)",
            length(from)
        )),
        _ if data.lower_rank_from_angle.is_some() => data.lower_rank_from_angle.map(|from| {
            format!(
                "one row is redundant from an angle tolerance of {from:.1e} rad on (`--angle-tolerance {from:.1e}`)"
            )
        }),
        (None, Some(here)) => Some(format!("this pose is {here:.1e} m from a singular one")),
        (None, None) => None,
    };
    let sentences = [stated(data.tolerance, data.angle_tolerance), near];
    let told = sentences.into_iter().flatten();
    told.map(|sentence| wrapped("  ", &sentence)).collect()
}

/// The tolerances that the scene or the command line states.
fn stated(tolerance: Option<f64>, angle: Option<f64>) -> Option<String> {
    match (tolerance, angle) {
        (Some(tolerance), Some(angle)) => Some(format!(
            "data known to {} (angles {angle:.1e} rad)",
            length(tolerance)
        )),
        (Some(tolerance), None) => Some(format!("data known to {}", length(tolerance))),
        (None, Some(angle)) => Some(format!(
            "angles known to {angle:.1e} rad, lengths to their rounding"
        )),
        (None, None) => None,
    }
}

/// Units of lengths (m), each with the smallest length that is written in it: hundredths of a
/// millimetre are usual, hundredths of a metre are not. The bounds are a little smaller because of
/// rounding.
const UNITS: [(f64, f64, &str); 4] = [
    (1.0, 0.099, "m"),
    (1e-3, 0.99e-5, "mm"),
    (1e-6, 0.99e-7, "µm"),
    (1e-9, 0.99e-10, "nm"),
];

/// Formats a length (m) with two digits.
fn length(metres: f64) -> String {
    let two_digits = |x: f64| format!("{x:.1e}").parse().unwrap_or(x);
    let metres: f64 = two_digits(metres);
    let said = UNITS.into_iter().find(|(_, from, _)| metres >= *from);
    let (one, _, unit) = said.unwrap_or(UNITS[0]);
    let number: f64 = two_digits(metres / one);
    if (0.01..1e4).contains(&number) {
        format!("{number} {unit}")
    } else {
        format!("{metres:.1e} m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_unit_that_people_say() {
        for (metres, said) in [
            (1e-4, "0.1 mm"),
            (5.04e-5, "0.05 mm"),
            (4.96e-5, "0.05 mm"),
            (4.94e-5, "0.049 mm"),
            (1e-5, "0.01 mm"),
            (9.8e-6, "9.8 µm"),
            (1e-2, "10 mm"),
            (1e-3, "1 mm"),
            (0.15, "0.15 m"),
            (2.0, "2 m"),
            (1.3e-6, "1.3 µm"),
            (4e-10, "0.4 nm"),
            (3e-12, "3.0e-12 m"),
            (1e9, "1.0e9 m"),
        ] {
            assert_eq!(length(metres), said);
        }
    }

    #[test]
    fn what_is_stated_is_said() {
        let said = stated(Some(1e-4), Some(4.2e-5));
        assert_eq!(
            said.as_deref(),
            Some("data known to 0.1 mm (angles 4.2e-5 rad)")
        );
        let said = stated(None, Some(1e-5));
        assert_eq!(
            said.as_deref(),
            Some("angles known to 1.0e-5 rad, lengths to their rounding")
        );
        assert_eq!(stated(None, None), None);
    }
}
