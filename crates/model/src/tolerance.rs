//! The stated uncertainty of the values in a scene. If no tolerance is stated, the uncertainty is
//! the rounding error.
//!
//! The crate `solvability` computes the effect of a tolerance on a rank.

use std::fmt;

/// The tolerances of a scene. The tolerances of a scene apply to data for which neither the joint
/// nor the body states a tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tolerance {
    /// Tolerance of points and lengths (m).
    pub length: Option<f64>,
    /// Tolerance of all directions, angles and ratios (rad); see [`Tolerance::angle_at`].
    pub angle: Option<f64>,
}

impl Tolerance {
    /// Returns the tolerance of angles in a mechanism of this size (m). The tolerance of angles is
    /// the stated tolerance of angles, or the length tolerance divided by the size. Returns `None`
    /// if neither tolerance is stated.
    ///
    /// ```
    /// use pfaff_model::Tolerance;
    /// let drawing = Tolerance { length: Some(1e-4), angle: None };
    /// assert_eq!(drawing.angle_at(2.0), Some(5e-5));
    /// assert_eq!(Tolerance { angle: Some(1e-3), ..drawing }.angle_at(2.0), Some(1e-3));
    /// assert_eq!(Tolerance::default().angle_at(2.0), None);
    /// ```
    #[must_use]
    pub fn angle_at(self, size: f64) -> Option<f64> {
        self.angle
            .or_else(|| self.length.map(|length| length / size))
    }

    /// Returns these tolerances. Tolerances that are not stated are taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            length: self.length.or(other.length),
            angle: self.angle.or(other.angle),
        }
    }

    /// Returns whether any tolerance is stated.
    #[must_use]
    pub fn is_stated(self) -> bool {
        self != Self::default()
    }
}

/// The item for which a tolerance is stated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ToleranceScope {
    /// Tolerance for the whole scene.
    Scene,
    /// Tolerance of the points of this body.
    Body(String),
    /// Tolerance of the point of this marker.
    Marker(String),
    /// Tolerance of the data of this joint.
    Joint(String),
    /// Tolerance of the data of this drive.
    Drive(String),
}

impl fmt::Display for ToleranceScope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("the scene"),
            Self::Body(name) => write!(f, "body `{name}`"),
            Self::Marker(name) => write!(f, "marker `{name}`"),
            Self::Joint(name) => write!(f, "joint `{name}`"),
            Self::Drive(name) => write!(f, "drive `{name}`"),
        }
    }
}

#[cfg(test)]
mod tests;
