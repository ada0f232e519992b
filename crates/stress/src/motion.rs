//! A scene from its text, or from what the library describes, to the last row of its motion, by every method and formulation that go together.

use std::ops::ControlFlow;

use dynamics::{Formulation, Method, MotionOptions, RowChoice, Summary, prepare, simulate};
use model::{Description, Mechanism, Registry, StartOptions};
use pfaff::{Overrides, Study, StudyError};

use crate::case::Outcome;

/// A row of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Time (s).
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
}

/// The options of every method with every formulation that go together, otherwise those of `base`.
#[must_use]
pub fn combinations(base: &MotionOptions) -> Vec<MotionOptions> {
    let all = Method::ALL.iter().flat_map(|&method| {
        Formulation::ALL
            .iter()
            .map(move |&formulation| MotionOptions {
                method,
                formulation,
                ..base.clone()
            })
    });
    all.filter(|options| options.check().is_ok()).collect()
}

/// What the commands make of a text, up to its start.
///
/// # Errors
/// As [`Study::read`].
pub fn study(text: &str) -> Result<Study, StudyError> {
    Study::read("scene", text, &Registry::planar(), &Overrides::default())
}

/// The same for a described mechanism, without a scene.
///
/// # Errors
/// The first fault of the description, or why it cannot move.
pub fn prepared(description: &Description) -> Result<dynamics::Prepared, Outcome> {
    let mechanism = Mechanism::build(description).map_err(|errors| {
        let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
        Outcome::refused(texts.join("; "))
    })?;
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).map_err(Outcome::refused)
}

/// The last row of a motion, with the numbers of the run.
///
/// # Errors
/// Why it stopped.
pub fn last_row(
    prepared: &dynamics::Prepared,
    options: &MotionOptions,
) -> Result<(Row, Summary), Outcome> {
    let mut last = Row::default();
    let summary = simulate(prepared, options, |sample| {
        last = Row {
            t: sample.t,
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
        };
        Ok(ControlFlow::Continue(()))
    });
    match summary {
        Ok(summary) => Ok((last, summary)),
        Err(failure) => Err(Outcome::refused(&failure.error)),
    }
}

/// A refusal with all its problems, not the first alone.
#[must_use]
pub fn refused(error: &StudyError) -> Outcome {
    match error {
        StudyError::Scene(problems) => {
            let texts: Vec<String> = problems.iter().map(ToString::to_string).collect();
            Outcome::refused(texts.join("; "))
        }
        other => Outcome::refused(other),
    }
}

/// The larger one of both, NaN where one is.
#[must_use]
pub fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
    errors.into_iter().map(f64::abs).fold(0.0, larger)
}
