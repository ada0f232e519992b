//! Limits of the loads of a contact. A one-sided joint pushes but does not pull. A contact slips if
//! the force along it is too large for the force that presses it.

use crate::words::{quantity, short};

/// The side of a joint with one gap Φ on which its bodies can part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum OpenSide {
    /// The gap can become positive: `Φ ≥ 0`.
    Positive,
    /// The gap can become negative: `Φ ≤ 0`.
    Negative,
}

impl OpenSide {
    /// Returns the sign of the gap if the joint is open.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

/// The condition that a contact does not slip: `|S| ≤ μ·N` for the force S of its nonholonomic
/// rows and the force N that presses it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Grip {
    /// The coefficient of friction μ.
    pub friction: f64,
    /// The force N.
    pub load: GripLoad,
}

/// The force that presses a contact with friction.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum GripLoad {
    /// The force of the one-sided contact itself.
    Own,
    /// A constant force (N).
    Constant(f64),
    /// The force of the one-sided joint with this name.
    Joint(String),
}

/// Limits of the loads of a joint. By default, a joint pushes, pulls, and never slips.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ContactLimits {
    /// The side on which the bodies can part.
    pub open_side: Option<OpenSide>,
    /// The condition that the contact does not slip.
    pub grip: Option<Grip>,
}

impl ContactLimits {
    /// Returns whether the joint can do everything.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// States what the joint cannot do; `None` if it can do everything.
    #[must_use]
    pub fn in_words(&self) -> Option<String> {
        // The sign of the gap depends on the order of points, and says nothing to a reader.
        let side = self.open_side.map(|_| "one-sided".to_owned());
        let grip = self.grip.as_ref().map(|grip| {
            let load = match &grip.load {
                GripLoad::Own => "its own load".to_owned(),
                GripLoad::Constant(load) => quantity(*load, "N"),
                GripLoad::Joint(name) => format!("the load of `{name}`"),
            };
            format!("grips with μ = {} under {load}", short(grip.friction))
        });
        let all: Vec<String> = side.into_iter().chain(grip).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }
}
