//! Sensitivity of a reaction component to the data, and the text that describes this sensitivity.

use crate::limits::{BEYOND, FRAGILE, MANY};
use model::words::{estimate, rough};
use model::{ConstraintId, DataUnit, Layout};

/// Change of a reaction component due to a change of one datum.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sensitivity {
    /// Largest change, divided by the value of the component or by the largest applied or inertial
    /// load, whichever is larger. For moments, the load is multiplied by the size of the mechanism.
    pub change: f64,
    /// The datum with the largest effect; `None` if no datum changes the component.
    pub by: Option<Datum>,
}

/// A point, direction or scalar parameter of a joint or drive, and the displacement of this datum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Datum {
    /// The joint or drive.
    pub joint: ConstraintId,
    /// Name of the datum in the joint or drive.
    pub name: &'static str,
    /// Displacement (m or rad).
    pub moved: f64,
    /// Unit of the displacement.
    pub unit: DataUnit,
    /// Whether the datum is a scalar parameter and not a point or a direction.
    pub is_number: bool,
}

impl Sensitivity {
    /// Returns whether the number is sensitive to data (fragile). The number is sensitive if it
    /// changes by more than the limit.
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.change > FRAGILE
    }

    /// Returns the change as printed, to three digits. A first-order estimate has no more accurate
    /// digits.
    #[must_use]
    pub fn stated(&self) -> f64 {
        format!("{:.2e}", self.change)
            .parse()
            .unwrap_or(self.change)
    }

    /// Returns a sentence about the reaction or number with this name. The sentence states that the
    /// number is unique but changes, by how much it changes, and with which datum.
    #[must_use]
    pub fn sentence(&self, reaction: &str, layout: &Layout) -> String {
        match &self.by {
            None => format!("`{reaction}` is unique, and no point of the scene changes it"),
            Some(by) => format!(
                "`{reaction}` is unique but {} if {}",
                change_in_words(self.change, 1),
                by.condition(layout)
            ),
        }
    }
}

impl Datum {
    /// Returns the displacement as a condition of the sentence.
    pub(crate) fn condition(&self, layout: &Layout) -> String {
        let verb = match (self.is_number, self.unit) {
            (true, _) => "changes",
            (false, DataUnit::Length) => "moves",
            (false, DataUnit::Angle) => "turns",
        };
        let moved = match self.unit {
            DataUnit::Length => estimate(self.moved, "m"),
            DataUnit::Angle => estimate(self.moved, "rad"),
        };
        format!("{} {verb} by {moved}", self.subject(layout))
    }

    /// Describes the datum for a sentence. A point is described by its body, and other data are
    /// described by their keys.
    fn subject(&self, layout: &Layout) -> String {
        let group = &layout.groups[self.joint.0];
        match group.slot_of_point(self.name) {
            Some(slot) => match group.bodies.len() {
                1 => format!("the point of `{}`", group.name),
                _ => {
                    let body = ["first", "second", "third", "fourth"][slot.min(3)];
                    format!("the point of `{}` on its {body} body", group.name)
                }
            },
            None => format!("`{}` of `{}`", self.name, group.name),
        }
    }
}

/// States that this number of reactions changes by at most this fraction of their size. The
/// fraction is of first order. Therefore it is given as a number only if it is small.
pub(crate) fn change_in_words(change: f64, reactions: usize) -> String {
    let (verb, up_to, whose) = match reactions {
        1 => ("changes", "", "its"),
        _ => ("change", "up to ", "their"),
    };
    if change < BEYOND {
        return format!("{verb} by {up_to}about {} %", rough(100.0 * change));
    }
    let times = if change < MANY {
        "several times"
    } else {
        "many times"
    };
    format!("would change by {up_to}{times} {whose} size")
}
