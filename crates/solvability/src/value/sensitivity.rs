//! How strongly a number of a reaction depends on the data, and how this is stated.

use crate::limits::{BEYOND, FRAGILE, MANY};
use model::{ConstraintId, DataUnit, Layout};

/// Changes of a number of reactions with one point.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sensitivity {
    /// Largest change, relative to the larger of the number and of the largest applied or inertial
    /// load, which is multiplied by the size for moments.
    pub change: f64,
    /// The datum with the largest effect. `None` if nothing changes the number.
    pub by: Option<Datum>,
}

/// A point, direction or number of a joint or drive, and by how much it is moved.
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
    /// Whether it is a single number, not a point or a direction.
    pub is_number: bool,
}

impl Sensitivity {
    /// Whether the number is fragile: it changes by more than the limit.
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.change > FRAGILE
    }

    /// The change as it is stated, to three digits: an estimate of first order has no more accurate
    /// ones.
    #[must_use]
    pub fn stated(&self) -> f64 {
        format!("{:.2e}", self.change)
            .parse()
            .unwrap_or(self.change)
    }

    /// A sentence about the reaction or number of this name: that it is unique but changes, by how
    /// much, and with which datum.
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
    /// The displacement as a condition of the sentence.
    pub(crate) fn condition(&self, layout: &Layout) -> String {
        let (what, verb) = match (self.is_number, self.unit) {
            (true, _) => ("", "changes"),
            (false, DataUnit::Length) => ("point ", "moves"),
            (false, DataUnit::Angle) => ("direction ", "turns"),
        };
        let moved = match self.unit {
            DataUnit::Length => length(self.moved),
            DataUnit::Angle => format!("{:.1e} rad", self.moved),
        };
        let joint = &layout.groups[self.joint.0].name;
        format!("{what}`{}` of `{joint}` {verb} by {moved}", self.name)
    }
}

/// States that this number of reactions changes by at most this fraction of their size. The
/// fraction is of first order, so it is given as a number only if it is small.
pub(crate) fn change_in_words(change: f64, reactions: usize) -> String {
    let (verb, up_to, whose) = match reactions {
        1 => ("changes", "", "its"),
        _ => ("change", "up to ", "their"),
    };
    if change < BEYOND {
        return format!("{verb} by {up_to}about {:.2} %", Digits(100.0 * change));
    }
    let times = if change < MANY {
        "several times"
    } else {
        "many times"
    };
    format!("would change by {up_to}{times} {whose} size")
}

/// A number with as many significant digits as the precision of the format states.
struct Digits(f64);

impl std::fmt::Display for Digits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(2) as i32;
        let places = match self.0.abs() {
            x if x > 0.0 && x.is_finite() => digits - 1 - x.log10().floor() as i32,
            _ => 0,
        };
        let unit = 10f64.powi(places);
        let rounded = (self.0 * unit).round() / unit;
        write!(f, "{rounded:.*}", places.clamp(0, 12) as usize)
    }
}

/// A small length as text.
#[must_use]
pub fn length(metres: f64) -> String {
    match metres.abs() {
        x if x >= 1.0 => format!("{:.2} m", Digits(metres)),
        x if x >= 1e-5 => format!("{:.2} mm", Digits(1e3 * metres)),
        x if x >= 1e-9 => format!("{:.2} µm", Digits(1e6 * metres)),
        _ => format!("{metres:.1e} m"),
    }
}
