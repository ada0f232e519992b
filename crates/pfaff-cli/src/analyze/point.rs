//! Points in the syntax of the command line.

use pfaff::ConfigurationAnalysis;
use pfaff::model::System;

use crate::args::in_si;
use crate::output::Failure;

/// The point of `--about`: coordinates, or the place of a marker.
pub(super) fn point(
    text: &str,
    configuration: &ConfigurationAnalysis<'_>,
) -> Result<[f64; 3], Failure> {
    if let Some(place) = configuration.marker(text) {
        return Ok(place);
    }
    let n = configuration.mechanism.layout().space.n_translations();
    let numbers: Option<Vec<f64>> = text.split(',').map(|x| in_si(x, "1 m")).collect();
    let mut point = [0.0; 3];
    match numbers {
        Some(numbers) if numbers.len() == n => {
            point[..n].copy_from_slice(&numbers);
            Ok(point)
        }
        _ => {
            let form = ["X", "Y", "Z"][..n].join(",");
            Err(Failure::input(format!(
                "--about is `{text}`, need {n} numbers as {form} (m, or with units, as 310mm), or the name of a marker"
            )))
        }
    }
}
