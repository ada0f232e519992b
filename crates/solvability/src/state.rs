//! A state that the caller gives: is it one of this mechanism?

use model::{Mechanism, System};

/// Coordinates and velocities at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Coordinates, n_q.
    pub q: Vec<f64>,
    /// Velocities, n_v.
    pub v: Vec<f64>,
}

/// Why a state is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// As many numbers as another mechanism has.
    #[error("at t = {time} s the state has {found} {what}, need {expected}")]
    Length {
        /// When.
        time: f64,
        /// Coordinates or velocities.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A number is NaN or infinite.
    #[error("at t = {time} s number {index} of the {what} is {value}, need finite numbers")]
    NotFinite {
        /// When.
        time: f64,
        /// Coordinates or velocities.
        what: &'static str,
        /// Which one, from 0.
        index: usize,
        /// The number.
        value: f64,
    },
    /// The time is NaN or infinite.
    #[error("the time of a state is {time}, need a finite number")]
    Time {
        /// The time.
        time: f64,
    },
}

/// Checks sizes and numbers of a state.
pub(crate) fn check(
    mechanism: &Mechanism,
    time: f64,
    q: &[f64],
    v: &[f64],
) -> Result<(), StateError> {
    if !time.is_finite() {
        return Err(StateError::Time { time });
    }
    let layout = mechanism.layout();
    for (what, x, expected) in [
        ("coordinates", q, layout.n_q),
        ("velocities", v, layout.n_v),
    ] {
        let found = x.len();
        if found != expected {
            return Err(StateError::Length {
                time,
                what,
                found,
                expected,
            });
        }
        if let Some(index) = x.iter().position(|x| !x.is_finite()) {
            let value = x[index];
            return Err(StateError::NotFinite {
                time,
                what,
                index,
                value,
            });
        }
    }
    Ok(())
}
