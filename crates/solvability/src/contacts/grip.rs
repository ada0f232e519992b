//! Whether contacts with friction prevent slip, and the least coefficient of friction with which
//! they can.

use model::ConstraintId;

use super::PermittedReactions;
use super::conditions::{Cluster, Polygon};
use super::error::PermittedError;
use crate::limits::{GRIP_ACCURACY, LARGEST_FRICTION};
use crate::polyhedra::polyhedron::{Emptiness, Extremum, Polyhedron};

/// Whether contacts prevent slip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Holds {
    /// No permitted distribution of the loads makes a contact slip.
    Always,
    /// Some distributions of the loads make a contact slip, and others do not.
    Sometimes,
    /// Every distribution of the loads makes a contact slip.
    Never,
    /// The friction is within the accuracy of the polygons that approximate circles.
    Undecided,
}

impl Holds {
    /// Returns the word in documents.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Always => "always",
            Self::Sometimes => "sometimes",
            Self::Never => "never",
            Self::Undecided => "undecided",
        }
    }
}

/// The verdict on contacts with friction that depend on each other.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GripVerdict {
    /// The joints with friction.
    pub joints: Vec<ConstraintId>,
    /// Whether the contacts prevent slip with the stated coefficients of friction. `None` if
    /// one-sided joints cannot all stay closed.
    pub holds: Option<Holds>,
    /// Bounds of the least coefficient of friction with which some distribution of the loads makes
    /// none of these joints slip. The coefficient is equal for all of these joints. `None` if no
    /// coefficient is large enough.
    pub least: Option<[f64; 2]>,
}

impl PermittedReactions<'_, '_> {
    /// Returns the verdicts on contacts with friction.
    ///
    /// # Errors
    /// [`PermittedError::Unclear`]
    pub fn grips(&self) -> Result<Vec<GripVerdict>, PermittedError> {
        let gripping = self.clusters.iter().filter(|c| !c.grips.is_empty());
        gripping.map(Cluster::grip).collect()
    }
}

impl Cluster {
    fn grip(&self) -> Result<GripVerdict, PermittedError> {
        let mut joints: Vec<ConstraintId> = self.grips.iter().map(|g| g.joint).collect();
        joints.dedup();
        let pressed = self.of_presses();
        let (mut holds, mut least) = (None, None);
        if !is_empty(&pressed)? {
            holds = Some(self.holds(&pressed)?);
            least = self.least();
        }
        Ok(GripVerdict {
            joints,
            holds,
            least,
        })
    }

    fn holds(&self, pressed: &Polyhedron) -> Result<Holds, PermittedError> {
        let is_empty_with = |polygon| {
            let (_, halves) = self.half_spaces(|grip| grip.friction, polygon);
            is_empty(&self.permitted_by(&halves))
        };
        if is_empty_with(Polygon::Outer)? {
            return Ok(Holds::Never);
        }
        let mut always = true;
        for grip in &self.grips {
            for half in grip.half_spaces(grip.friction, Polygon::Inner) {
                let range = pressed.range(&half.row, half.value)?;
                let lowest = range.map(|range| range.ends);
                always &=
                    matches!(lowest, Some([Extremum::Finite { value, .. }, _]) if value >= 0.0);
            }
        }
        Ok(match always {
            true => Holds::Always,
            false if is_empty_with(Polygon::Inner)? => Holds::Undecided,
            false => Holds::Sometimes,
        })
    }

    /// Returns two coefficients of friction that are as close as possible. With the first
    /// coefficient (or 0), every distribution of the loads makes a contact slip. With the second
    /// coefficient, some distribution makes no contact slip.
    fn least(&self) -> Option<[f64; 2]> {
        let emptiness = |friction: f64, polygon: Polygon| {
            let (_, halves) = self.half_spaces(|_| friction, polygon);
            self.permitted_by(&halves).emptiness().ok().cloned()
        };
        let slips = |friction: f64| {
            let found = emptiness(friction, Polygon::Outer);
            matches!(found, Some(Emptiness::Empty { .. }))
        };
        let holds = |friction: f64| {
            let found = emptiness(friction, Polygon::Inner);
            matches!(found, Some(Emptiness::Points { .. }))
        };
        let mut enough = 1.0;
        while !holds(enough) {
            enough *= 2.0;
            if enough > LARGEST_FRICTION {
                return None;
            }
        }
        if holds(0.0) {
            return Some([0.0; 2]);
        }
        let highest = bisected([0.0, enough], holds)[1];
        let lowest = bisected([0.0, highest], |friction| !slips(friction))[0];
        Some([lowest, highest])
    }
}

/// Returns the last coefficient without a property and the first coefficient with it. All larger
/// coefficients must also have the property.
fn bisected([mut without, mut with]: [f64; 2], has: impl Fn(f64) -> bool) -> [f64; 2] {
    while with - without > GRIP_ACCURACY * with {
        let middle = f64::midpoint(without, with);
        if has(middle) {
            with = middle;
        } else {
            without = middle;
        }
    }
    [without, with]
}

fn is_empty(of: &Polyhedron) -> Result<bool, PermittedError> {
    Ok(matches!(of.emptiness()?, Emptiness::Empty { .. }))
}
