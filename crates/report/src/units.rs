//! Units that a scene chooses, for tables and printed answers.

/// Units of lengths and angles that a scene chooses, with their values in metres and radians.
/// `None` for SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneUnits {
    /// Unit of lengths.
    pub length: Option<(&'static str, f64)>,
    /// Unit of angles.
    pub angle: Option<(&'static str, f64)>,
}

impl SceneUnits {
    /// Returns the unit of the scene that replaces an SI unit, and the value of this unit in the SI
    /// unit.
    ///
    /// ```
    /// let units = pfaff_report::SceneUnits { length: Some(("mm", 1e-3)), angle: None };
    /// assert_eq!(units.unit("m/s²"), Some(("mm/s²".to_owned(), 1e-3)));
    /// assert_eq!(units.unit("rad"), None);
    /// ```
    #[must_use]
    pub fn unit(&self, si: &str) -> Option<(String, f64)> {
        let (base, rest) = si.split_at(si.find('/').unwrap_or(si.len()));
        let (name, value) = match base {
            "m" => self.length?,
            "rad" => self.angle?,
            _ => return None,
        };
        Some((format!("{name}{rest}"), value))
    }
}
