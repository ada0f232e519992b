//! Sentences about the tolerances of the data and the consequences of these tolerances.

use crate::documents::AnalysisDocument;
use model::words::estimate;

use crate::words::Block;

/// Returns sentences about tolerances. The list is empty if no tolerance is stated and no lower
/// rank is near.
pub(super) fn of(d: &AnalysisDocument) -> Vec<Block> {
    let data = &d.data;
    let sentences = [
        stated(data.tolerance, data.angle_tolerance),
        data.nearness(),
    ];
    let sentences = sentences.into_iter().flatten();
    sentences
        .map(|sentence| Block::after("  ", sentence))
        .collect()
}

/// Describes the tolerances that the scene or the command line states.
fn stated(tolerance: Option<f64>, angle: Option<f64>) -> Option<String> {
    match (tolerance, angle) {
        (Some(tolerance), Some(angle)) => Some(format!(
            "data accurate to {} (angles {angle})",
            estimate(tolerance, "m"),
            angle = estimate(angle, "rad")
        )),
        (Some(tolerance), None) => Some(format!("data accurate to {}", estimate(tolerance, "m"))),
        (None, Some(angle)) => Some(format!(
            "angles accurate to {angle}, lengths to rounding",
            angle = estimate(angle, "rad")
        )),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stated_is_said() {
        let said = stated(Some(1e-4), Some(4.2e-5));
        assert_eq!(
            said.as_deref(),
            Some("data accurate to 0.1 mm (angles 0.042 mrad)")
        );
        let said = stated(None, Some(1e-5));
        assert_eq!(
            said.as_deref(),
            Some("angles accurate to 0.01 mrad, lengths to rounding")
        );
        assert_eq!(stated(None, None), None);
    }
}
