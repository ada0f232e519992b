//! Runs scenes up to the last output row, by every method. A scene is a text or a description that
//! was built with the library.

use std::ops::ControlFlow;

use dynamics::{
    FORMULATION, Method, MotionOptions, PreparedMechanism, RowChoice, Summary, prepare, simulate,
};
use model::start::CorrectionLimit;
use model::{BodySpace, Description, Mechanism, MechanismDescription, Registry, StartOptions};
use pfaff::{RunOptions, Study, StudyError};
use solvability::{Analysis, analyse};

use crate::stress::case::{Case, Expected, Outcome};

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

/// Returns the options `base` with every method.
#[must_use]
pub fn combinations(base: &MotionOptions) -> Vec<MotionOptions> {
    let of = |&method: &Method| MotionOptions {
        method,
        ..base.clone()
    };
    let all = Method::ALL.iter().map(of);
    all.filter(|options| options.check().is_ok()).collect()
}

/// Returns, up to a factor, the number of steps that a method needs for a motion over this phase
/// (rad) at a relative tolerance. The local error of a step h is proportional to h to the power of
/// the order plus one. The number of steps is used to bound the sum of the errors of all steps.
#[must_use]
pub fn steps(method: Method, phase: f64, rtol: f64) -> f64 {
    let order = match method {
        Method::Dopri5 | Method::Tsit5 | Method::Radau5 => 5.0,
        _ => 8.0,
    };
    phase.max(1.0) * rtol.powf(-1.0 / (order + 1.0))
}

/// Creates a case that computes a motion with these options.
pub fn moving(
    name: impl Into<String>,
    options: MotionOptions,
    expected: Expected,
    run: impl Fn(&MotionOptions) -> Result<Outcome, Outcome> + Send + Sync + 'static,
) -> Case {
    let method = options.method.name();
    let made = move || run(&options).unwrap_or_else(|refusal| refusal);
    Case::new(name, method, FORMULATION, expected, made)
}

/// Creates a case that examines a question without integration.
pub fn asking(
    name: impl Into<String>,
    question: &str,
    expected: Expected,
    run: impl Fn() -> Result<Outcome, Outcome> + Send + Sync + 'static,
) -> Case {
    let made = move || run().unwrap_or_else(|refusal| refusal);
    Case::new(name, question, "-", expected, made)
}

/// Reads a text and prepares its initial state in the same way as the commands.
///
/// # Errors
/// Returns the error message with all problems.
pub fn study(text: &str) -> Result<Study, Outcome> {
    Study::read("scene", text, &Registry::standard(), &RunOptions::default())
        .map_err(|e| refused(&e))
}

/// Builds a described mechanism.
///
/// # Errors
/// Returns all errors of the description.
pub fn built<S: BodySpace>(description: &MechanismDescription<S>) -> Result<Mechanism, Outcome> {
    Mechanism::build(description).map_err(|errors| {
        let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
        Outcome::refused(texts.join("; "))
    })
}

/// Builds a described mechanism with its initial state, without a scene. The velocity of one body
/// is given, and the velocities of the other bodies follow from the constraints. Depending on the
/// masses, the correction of velocities may also change the given velocity. Therefore cases about
/// initial states use texts.
///
/// # Errors
/// Returns the errors of the description, or the reason why the mechanism cannot move.
pub fn prepared<S: BodySpace>(
    description: &MechanismDescription<S>,
) -> Result<PreparedMechanism, Outcome> {
    let start = StartOptions {
        correction: CorrectionLimit::Any,
        ..StartOptions::default()
    };
    prepare(built(description)?, &start, &RowChoice::Automatic).map_err(Outcome::refused)
}

/// Returns the verdicts on a described mechanism at its described configuration.
///
/// # Errors
/// Returns the errors of the description, or the reason why the mechanism cannot be analysed.
pub fn analysed(description: &Description) -> Result<Analysis, Outcome> {
    let mechanism = built(description)?;
    let (q, _) = mechanism.described_state();
    analyse(&mechanism, 0.0, &q).map_err(Outcome::refused)
}

/// Returns the accelerations at the initial state, computed in the same way as in a run with these
/// options.
///
/// # Errors
/// Returns the reason why there are no accelerations.
pub fn acceleration(
    prepared: &PreparedMechanism,
    options: &MotionOptions,
) -> Result<Vec<f64>, Outcome> {
    let mut found = Vec::new();
    let run = simulate(prepared, options, |sample| {
        found = sample.acceleration()?;
        Ok(ControlFlow::Break(()))
    });
    match run {
        Ok(_) => Ok(found),
        Err(failure) => Err(Outcome::refused(&failure.error)),
    }
}

/// Returns the last output row of a motion, with the statistics of the run.
///
/// # Errors
/// Returns the reason why the run stopped.
pub fn last_row(
    prepared: &PreparedMechanism,
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

/// Creates a case of a moving scene: `error` computes the error of the last row.
pub fn case(
    name: impl Into<String>,
    text: impl Into<String>,
    options: MotionOptions,
    expected: Expected,
    error: impl Fn(&Row, &Summary) -> f64 + Send + Sync + 'static,
) -> Case {
    let text = text.into();
    moving(name, options, expected, move |options| {
        Ok(outcome(&text, options, &error))
    })
}

/// Returns the outcome for a moving scene.
pub fn outcome(
    text: &str,
    options: &MotionOptions,
    error: impl Fn(&Row, &Summary) -> f64,
) -> Outcome {
    match study(text) {
        Ok(study) => outcome_of(&study.prepared, options, error),
        Err(refusal) => refusal,
    }
}

/// Returns the outcome for a prepared mechanism.
pub fn outcome_of(
    prepared: &dynamics::PreparedMechanism,
    options: &MotionOptions,
    error: impl Fn(&Row, &Summary) -> f64,
) -> Outcome {
    match last_row(prepared, options) {
        Err(refusal) => refusal,
        Ok((row, summary)) => {
            let detail = format!("{} steps", summary.steps);
            Outcome::answer(error(&row, &summary), detail)
        }
    }
}

/// Returns the outcome for an error, with the text of all problems.
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

/// Returns the largest value; NaN if a value is NaN.
#[must_use]
pub fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
    errors.into_iter().map(f64::abs).fold(0.0, larger)
}
