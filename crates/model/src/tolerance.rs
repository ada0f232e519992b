//! What the numbers of a scene are known to, where somebody says so. Without that they are known to
//! their rounding.
//!
//! Not here: what a tolerance means for a rank (`solvability`).

use std::fmt;

use joints::spec::DatumShape;

use crate::data::DataUnit;
use crate::description::Description;
use crate::mechanism::{BuildError, Mechanism, PlacedConstraint};

/// What the numbers of a scene are known to, where nothing is said of their joint or body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tolerance {
    /// Of points and lengths (m).
    pub length: Option<f64>,
    /// Of all directions, angles and ratios (rad); see [`Tolerance::angle_at`].
    pub angle: Option<f64>,
}

impl Tolerance {
    /// That of angles in a mechanism of this size (m): the one stated, or the length tolerance
    /// divided by the size. Returns `None` if neither is stated.
    ///
    /// ```
    /// use model::Tolerance;
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

    /// This one, and for what it does not state the other one.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            length: self.length.or(other.length),
            angle: self.angle.or(other.angle),
        }
    }

    /// Whether anything is stated.
    #[must_use]
    pub fn is_stated(self) -> bool {
        self != Self::default()
    }

    /// Checks that what is stated is finite and positive.
    pub(crate) fn check(self) -> Result<(), BuildError> {
        let fields = [("tolerance", self.length), ("angle tolerance", self.angle)];
        let wrong = fields
            .into_iter()
            .find_map(|(field, value)| Some((field, value.filter(is_wrong)?)));
        match wrong {
            Some((field, value)) => Err(BuildError::Tolerance {
                of: Stated::Scene,
                field,
                value,
            }),
            None => Ok(()),
        }
    }
}

/// Where a tolerance is stated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stated {
    /// For the whole scene.
    Scene,
    /// For points of this body.
    Body(String),
    /// For the data of this joint.
    Joint(String),
    /// For the data of this drive.
    Drive(String),
}

impl fmt::Display for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("the scene"),
            Self::Body(name) => write!(f, "body `{name}`"),
            Self::Joint(name) => write!(f, "joint `{name}`"),
            Self::Drive(name) => write!(f, "drive `{name}`"),
        }
    }
}

/// Whether a number is no tolerance.
fn is_wrong(value: &f64) -> bool {
    !(value.is_finite() && *value > 0.0)
}

/// Every tolerance of a description that is no finite number > 0.
pub(crate) fn check(d: &Description, errors: &mut Vec<BuildError>) {
    errors.extend(d.tolerance.check().err());
    let bodies = d.bodies.iter();
    let bodies = bodies.map(|b| (b.tolerance, Stated::Body(b.name.clone())));
    let joints = d.joints.iter();
    let joints = joints.map(|j| (j.tolerance, Stated::Joint(j.name.clone())));
    let drives = d.drives.iter();
    let drives = drives.map(|x| (x.tolerance, Stated::Drive(x.name.clone())));
    for (value, of) in bodies.chain(joints).chain(drives) {
        if let Some(value) = value.filter(is_wrong) {
            let field = "tolerance";
            errors.push(BuildError::Tolerance { of, field, value });
        }
    }
}

impl Mechanism {
    /// What its numbers are known to where nothing is said of their joint or body.
    #[must_use]
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// States what its numbers are known to where nothing is said of their joint or body.
    ///
    /// # Errors
    /// [`BuildError::Tolerance`]: it is no finite number > 0; nothing has changed.
    pub fn set_tolerance(&mut self, tolerance: Tolerance) -> Result<(), BuildError> {
        tolerance.check()?;
        self.tolerance = tolerance;
        Ok(())
    }

    /// Whether anything is stated of any of its numbers.
    pub(crate) fn has_tolerances(&self) -> bool {
        self.tolerance.is_stated()
            || self.bodies().iter().any(|body| body.tolerance.is_some())
            || self.constraints().iter().any(|c| c.tolerance.is_some())
    }

    /// What data of this shape in a constraint are known to, in their unit, in a mechanism of this
    /// size (m). Lengths: as is stated of the constraint, else of the body whose frame they are in,
    /// else of the scene. Angles: as the scene states, else that length divided by the size.
    pub(crate) fn tolerance_of(
        &self,
        c: &PlacedConstraint,
        shape: DatumShape,
        unit: DataUnit,
        size: f64,
    ) -> Option<f64> {
        let slot = match shape {
            DatumShape::Point { slot }
            | DatumShape::Direction { slot }
            | DatumShape::KeptVector { slot } => Some(slot),
            DatumShape::Line | DatumShape::Number(_) | DatumShape::Kept(_) => None,
        };
        let body = slot.and_then(|slot| c.bodies.get(slot)?.moving());
        let nearest = c.tolerance.or_else(|| self.bodies()[body?].tolerance);
        let stated = Tolerance {
            length: nearest.or(self.tolerance.length),
            ..self.tolerance
        };
        match unit {
            DataUnit::Length => stated.length,
            DataUnit::Angle => stated.angle_at(size),
        }
    }
}

#[cfg(test)]
mod tests;
