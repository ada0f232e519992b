//! A state that the caller passes, and a check that the state fits the mechanism.

use model::codes::Code;
pub use model::start::State;
use model::{Mechanism, System};

/// Reason why a state is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// The number of values differs from the number in the mechanism.
    #[error("at t = {time} s the state has {found} {what}, need {expected}")]
    Length {
        /// Time of the state (s).
        time: f64,
        /// "coordinates" or "velocities".
        what: &'static str,
        /// Number of passed values.
        found: usize,
        /// Number of required values.
        expected: usize,
    },
    /// A number is NaN or infinite.
    #[error("at t = {time} s number {index} of the {what} is {value}, need finite numbers")]
    NotFinite {
        /// Time of the state (s).
        time: f64,
        /// "coordinates" or "velocities".
        what: &'static str,
        /// Index of the value, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// The time is NaN or infinite.
    #[error("the time of a state is {time}, need a finite number")]
    Time {
        /// The time.
        time: f64,
    },
}

impl StateError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Length { .. } | Self::NotFinite { .. } | Self::Time { .. } => {
                const { Code::new(301) }
            }
        }
    }
}

/// Checks the sizes of a state, and checks that its numbers are finite.
///
/// # Errors
/// Returns the first violated condition.
pub fn check_state(
    mechanism: &Mechanism,
    time: f64,
    q: &[f64],
    v: &[f64],
) -> Result<(), StateError> {
    check_configuration(mechanism, time, q)?;
    check_numbers(time, "velocities", v, mechanism.layout().n_v)
}

/// Checks time and coordinates.
pub(crate) fn check_configuration(
    mechanism: &Mechanism,
    time: f64,
    q: &[f64],
) -> Result<(), StateError> {
    if !time.is_finite() {
        return Err(StateError::Time { time });
    }
    check_numbers(time, "coordinates", q, mechanism.layout().n_q)
}

fn check_numbers(
    time: f64,
    what: &'static str,
    x: &[f64],
    expected: usize,
) -> Result<(), StateError> {
    let found = x.len();
    if found != expected {
        return Err(StateError::Length {
            time,
            what,
            found,
            expected,
        });
    }
    match x.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(StateError::NotFinite {
            time,
            what,
            index,
            value: x[index],
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use model::{Body, Description};

    use super::*;
    use crate::{AnalysisError, analyse, analyse_dropping, certify, generic};

    /// A configuration with the wrong number of coordinates is an error, not a panic.
    #[test]
    fn only_a_configuration_is_analysed() {
        let description = Description {
            bodies: vec![Body {
                name: "body".into(),
                mass: 1.0,
                inertia: 1.0,
                ..Body::default()
            }],
            ..Description::default()
        };
        let mechanism = Mechanism::build(&description).expect("a free body builds");
        assert!(analyse(&mechanism, 0.0, &[0.0; 3]).is_ok());
        for (t, q) in [
            (0.0, &[][..]),
            (0.0, &[0.0; 4]),
            (0.0, &[0.0, f64::NAN, 0.0]),
            (f64::INFINITY, &[0.0; 3]),
        ] {
            let refused = |e: AnalysisError| matches!(e, AnalysisError::State(_));
            assert!(analyse(&mechanism, t, q).is_err_and(refused));
            assert!(analyse_dropping(&mechanism, t, q, &[]).is_err_and(refused));
            assert!(certify(&mechanism, t, q).is_err_and(refused));
            assert_eq!(generic(&mechanism, t, q), None);
        }
    }
}
