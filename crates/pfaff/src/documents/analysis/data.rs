//! Tolerances of the numbers of a scene, and the smallest change of the numbers that leads to
//! another rank.

use model::Tolerance;
use model::words::{estimate, rounded};
use rank::{BEYOND_DOUBT, Certificate, Grounds};
use serde::Serialize;
use solvability::Analysis;

/// Tolerances of the data, and the results that depend on the tolerances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DataDocument {
    /// The tolerance that the scene states for points and lengths (m); `None` if the scene states
    /// no tolerance and only rounding of the data counts.
    pub tolerance: Option<f64>,
    /// The tolerance of directions, angles and ratios (rad), as stated; otherwise `tolerance`
    /// divided by the size of the mechanism, or of the smallest part if there are several parts.
    pub angle_tolerance: Option<f64>,
    /// The smallest tolerance at which a row is redundant (m): if points may be displaced by this
    /// length, the rank is lower at all configurations of the mechanism. `None` if no such
    /// tolerance is close.
    pub lower_rank_from: Option<f64>,
    /// The same tolerance for angles (rad) if the scene states a tolerance for angles only. If
    /// directions may be rotated by this angle, the rank is lower. Then `lower_rank_from` is
    /// `None`.
    pub lower_rank_from_angle: Option<f64>,
    /// The displacement of points that makes the rank lower at this configuration (m; angles are
    /// multiplied by the size of the mechanism). `None` if no such displacement is small.
    pub lower_rank_here: Option<f64>,
    /// Whether the smallest tolerance at which a row is redundant is a small fraction of the size
    /// of a part that still has the higher rank. Then rounding of the data may lock a motion that
    /// the mechanism should have.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub nearly_free: bool,
    /// The smallest such tolerance (m).
    #[serde(skip)]
    free_from: Option<f64>,
    /// Whether rows are redundant only within the stated tolerance.
    #[serde(skip)]
    is_within: bool,
}

/// Data that differ by less than this fraction of the size of a part count as rounded. Data of
/// machines have about four digits, and dimensions of real parts are larger than this fraction.
const ROUNDED: f64 = 1e-3;

impl DataDocument {
    /// Returns a warning about a motion that is locked, possibly only because the data are rounded.
    /// `mobility` is the mobility for the given data. Returns `None` if the motion is free within a
    /// stated tolerance.
    #[must_use]
    pub fn warning(&self, mobility: usize) -> Option<String> {
        let from = self.free_from?;
        let enough = clearly_above(from);
        let known = match self.tolerance {
            None => "as written".to_owned(),
            Some(tolerance) => format!("accurate to {}", estimate(tolerance, "m")),
        };
        Some(format!(
            "mobility {mobility} for data {known}, but {} if lengths are accurate only to {}: one row is then redundant, \
             and the motion that it locks becomes free. If the mechanism must move, write more digits or state \
             `tolerance = {}` (m) in [scene]; `pfaff analyze` names the joints",
            mobility + 1,
            estimate(from, "m"),
            rounded(enough)
        ))
    }

    /// If a motion may be locked only because the data are rounded, returns the tolerance for which
    /// this motion is free. Returns `None` if a tolerance is stated, or if there is no such motion.
    #[must_use]
    pub fn freeing_tolerance(&self) -> Option<Tolerance> {
        let from = self.free_from?;
        let is_stated = self.tolerance.is_some() || self.angle_tolerance.is_some();
        (!is_stated).then(|| Tolerance {
            length: Some(clearly_above(from)),
            angle: None,
        })
    }

    /// Describes the tolerance at which one row becomes redundant, with an option that decides the
    /// rank.
    #[must_use]
    pub fn nearness(&self) -> Option<String> {
        let option = |name: &str, from: f64| {
            if self.is_within {
                String::new()
            } else {
                format!(
                    " (`--{name} {}` decides for it)",
                    rounded(clearly_above(from))
                )
            }
        };
        if let Some(from) = self.lower_rank_from {
            let option = option("tolerance", from);
            return Some(format!(
                "one row is redundant from a tolerance of {} on{option}",
                estimate(from, "m")
            ));
        }
        if let Some(from) = self.lower_rank_from_angle {
            let option = option("angle-tolerance", from);
            return Some(format!(
                "one row is redundant from an angle tolerance of {} on{option}",
                estimate(from, "rad")
            ));
        }
        let here = self.lower_rank_here?;
        Some(format!(
            "this pose is {} from a singular one",
            estimate(here, "m")
        ))
    }

    /// Builds the document of an analysis.
    #[must_use]
    pub fn new(analysis: &Analysis) -> Self {
        let parts = analysis.parts.iter();
        let parts = parts.map(|part| (part.size, part.certificate.as_ref()));
        Self::of(analysis.tolerance, parts)
    }

    /// Builds the document of parts with their sizes (m), from the smallest change of the data
    /// among all parts.
    fn of<'a>(
        tolerance: Tolerance,
        parts: impl Iterator<Item = (f64, Option<&'a Certificate>)> + Clone,
    ) -> Self {
        let angles = parts
            .clone()
            .filter_map(|(size, _)| tolerance.angle_at(size));
        let known = || parts.clone().filter_map(|(_, certificate)| certificate);
        let by_angles = |(size, certificate): (f64, Option<&Certificate>)| {
            let certificate = certificate.filter(|c| c.lower_rank_by_angles)?;
            Some(certificate.lower_rank_from? / size)
        };
        let by_lengths = known().filter(|c| !c.lower_rank_by_angles);
        let is_within = |c: &Certificate| c.grounds == Grounds::WithinTolerance;
        let free_from = |(size, certificate): (f64, Option<&Certificate>)| {
            let certificate = certificate.filter(|c| !c.lower_rank_by_angles && !is_within(c))?;
            certificate
                .lower_rank_from
                .filter(|from| *from <= ROUNDED * size)
        };
        let free_from = parts.clone().filter_map(free_from).reduce(f64::min);
        Self {
            tolerance: tolerance.length,
            angle_tolerance: angles.reduce(f64::max).or(tolerance.angle),
            lower_rank_from: by_lengths
                .filter_map(|c| c.lower_rank_from)
                .reduce(f64::min),
            lower_rank_from_angle: parts.clone().filter_map(by_angles).reduce(f64::min),
            nearly_free: free_from.is_some(),
            free_from,
            is_within: known().any(is_within),
            lower_rank_here: known().filter_map(|c| c.lower_rank_here).reduce(f64::min),
        }
    }
}

/// Returns a tolerance with two digits. It is clearly above the smallest tolerance at which a row
/// is redundant, because the rank is undecided close to the smallest tolerance.
fn clearly_above(from: f64) -> f64 {
    let enough = BEYOND_DOUBT * from;
    let digit = 10.0_f64.powf(enough.log10().floor() - 1.0);
    ((enough / digit).floor() + 1.0) * digit
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates a certificate that contains only these two lengths.
    fn certificate(from: Option<f64>, here: Option<f64>) -> Certificate {
        Certificate {
            rank_at_least: 1,
            sigma_bound: 1.0,
            sigma_next: 0.0,
            grounds: Grounds::FullRank,
            uncertainty: 0.0,
            spread: 0.0,
            row_noise: Vec::new(),
            lower_rank_by_angles: false,
            row_data: None,
            row_turn: None,
            open_rows: Vec::new(),
            has_tolerance: false,
            nearly_redundant: None,
            lower_rank_here: here,
            lower_rank_from: from,
        }
    }

    #[test]
    fn the_part_that_needs_least_speaks_for_all() {
        let drawing = Tolerance {
            length: Some(1e-4),
            angle: None,
        };
        let near = certificate(Some(5e-5), Some(7e-6));
        let singular = certificate(None, Some(1e-6));
        let parts = [(4.0, Some(&near)), (2.0, Some(&singular)), (1.0, None)];
        let told = DataDocument::of(drawing, parts.into_iter());
        let expected = DataDocument {
            tolerance: Some(1e-4),
            angle_tolerance: Some(1e-4),
            lower_rank_from: Some(5e-5),
            lower_rank_from_angle: None,
            lower_rank_here: Some(1e-6),
            nearly_free: true,
            free_from: Some(5e-5),
            is_within: false,
        };
        assert_eq!(told, expected);
        let said = told.warning(2).expect("near");
        assert!(
            said.starts_with(
                "mobility 2 for data accurate to 0.1 mm, but 3 if lengths are accurate only to 0.05 mm"
            ),
            "{said}"
        );
        assert!(said.contains("`tolerance = 0.00016`"), "{said}");
        // The text does not recommend a tolerance if the row is already redundant within the stated
        // tolerance.
        let freed = Certificate {
            grounds: Grounds::WithinTolerance,
            ..near.clone()
        };
        let told = DataDocument::of(drawing, [(4.0, Some(&freed))].into_iter());
        assert_eq!((told.nearly_free, told.warning(2)), (false, None));
        let said = told.nearness().expect("near");
        assert_eq!(said, "one row is redundant from a tolerance of 0.05 mm on");
        let far = certificate(Some(5e-3), None);
        let told = DataDocument::of(Tolerance::default(), [(4.0, Some(&far))].into_iter());
        assert_eq!((told.nearly_free, told.warning(2)), (false, None));
        let turned = Certificate {
            lower_rank_by_angles: true,
            ..near
        };
        let parts = [(4.0, Some(&turned)), (2.0, Some(&singular))];
        let told = DataDocument::of(drawing, parts.into_iter());
        let told = (told.lower_rank_from, told.lower_rank_from_angle);
        assert_eq!(told, (None, Some(1.25e-5)));
    }

    #[test]
    fn what_nobody_states_is_null() {
        let told = DataDocument::of(Tolerance::default(), [(1.0, None)].into_iter());
        assert_eq!(
            serde_json::to_string(&told).expect("JSON"),
            r#"{"tolerance":null,"angle_tolerance":null,"lower_rank_from":null,"lower_rank_from_angle":null,"lower_rank_here":null}"#
        );
    }
}
