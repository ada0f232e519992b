//! Accelerations and multipliers by generated code. The module also checks the reliability of the
//! results.

use super::{Accelerations, State};
use crate::code::SceneCode;
use crate::guards::GUARDED;
use crate::limits::LEAVE;
use model::words::short;

/// Code that was generated for a mechanism, or its evaluator.
pub(crate) struct GeneratedCode<'m>(pub(crate) &'m dyn SceneCode);

/// Reason why a result of generated code is unreliable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Doubt {
    /// A pivot is small, or has changed its sign.
    Health { health: f64 },
    /// A result is NaN or infinite.
    NotFinite,
    /// An independent row is still violated after all corrections.
    OffConstraints { row: usize, by: f64 },
    /// The independent rows do not imply a redundant row.
    DroppedRow { row: usize, by: f64 },
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Health { health } => write!(
                f,
                "its pivots have fallen to {health:.2} of those that it was generated for (limit {LEAVE})"
            ),
            Self::NotFinite => write!(f, "a result of it is not finite"),
            Self::OffConstraints { row, by } => {
                write!(
                    f,
                    "its corrections leave row {} off by {by}",
                    row + 1,
                    by = short(by)
                )
            }
            Self::DroppedRow { row, by } => {
                write!(
                    f,
                    "the dropped row {} misses by {by}",
                    row + 1,
                    by = short(by)
                )
            }
        }
    }
}

impl Doubt {
    /// Checks the health of a result, and checks that its values are finite. NaN counts as
    /// unreliable.
    pub(crate) fn of(health: f64, results: &[f64]) -> Result<(), Self> {
        if !GUARDED {
            return Ok(());
        }
        if health.is_nan() || health < LEAVE {
            return Err(Self::Health { health });
        }
        if results.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(Self::NotFinite)
        }
    }
}

impl Accelerations for GeneratedCode<'_> {
    type Fault = Doubt;

    fn accelerations(&mut self, State { t, q, v }: State<'_>, a: &mut [f64]) -> Result<(), Doubt> {
        Doubt::of(self.0.acceleration(t, q, v, a), a)
    }

    fn multipliers(&mut self, State { t, q, v }: State<'_>, l: &mut [f64]) -> Result<(), Doubt> {
        Doubt::of(self.0.multipliers(t, q, v, l), l)
    }
}
