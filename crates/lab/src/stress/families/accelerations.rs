//! Compares accelerations and reactions, for masses and lengths of very different sizes, with the
//! exact solution of the same equations. The exact solution uses the same C, M, Q and Γ as the
//! solver; rounding errors in C, M, Q and Γ are not tested here.

mod scenes;
mod score;

use std::sync::{Arc, OnceLock};

use dynamics::{FORMULATION, KeptRowMotion};
use model::{Description, System};

use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::prepared;
use exact::solve;
use scenes::{Scene, scenes};
use score::Errors;
use solvability::ChosenValues;

/// Masses from 1e-24 to 1e24 and lengths from 1e-12 to 1e12.
pub(super) const FAMILY: Family = Family {
    name: "accelerations",
    about: "masses and lengths far apart, in chains, closed loops and the robot: accelerations and reactions compared with the exact solution of \
            the same equations",
    cases,
};

/// Error bound of accelerations with independent rows. The error is relative to the acceleration
/// component, or to a thousandth of the largest component of the same body and kind if this value
/// is larger.
const ACCELERATION: f64 = 1e-13;

/// Error bound of multipliers of independent rows, relative to the largest multiplier of the same
/// joint.
const REACTION: f64 = 1e-12;

const EXACT: &str = "exact solution of the same equations; bound of the issue";

fn cases() -> Vec<Case> {
    scenes().into_iter().flat_map(of_scene).collect()
}

/// Returns the cases for both questions, which share one solution.
fn of_scene(scene: Scene) -> Vec<Case> {
    let description = Arc::new(scene.description);
    let found = Arc::new(OnceLock::new());
    let of_question = |question: Question| {
        let (found, description) = (Arc::clone(&found), Arc::clone(&description));
        let run = move || match found.get_or_init(|| errors(&description)) {
            Ok(errors) => question.outcome(errors),
            Err(refusal) => refusal.clone(),
        };
        let name = scene.name.clone();
        // A scene with data at the limits of f64 may be rejected.
        let right = match scene.limit {
            Some(words) => Expected::AnswerOrRefusal {
                bound: ACCELERATION,
                source: EXACT,
                parts: vec![words.to_owned()],
            },
            None => question.right(),
        };
        Case::new(name, question.name(), FORMULATION, right, run).at(scene.varied, scene.value)
    };
    [Question::Accelerations, Question::Reactions]
        .map(of_question)
        .into()
}

/// The quantity that is compared.
#[derive(Clone, Copy)]
enum Question {
    Accelerations,
    Reactions,
}

impl Question {
    fn name(self) -> &'static str {
        match self {
            Self::Accelerations => "accelerations",
            Self::Reactions => "reactions",
        }
    }

    fn right(self) -> Expected {
        match self {
            Self::Accelerations => Expected::answer(ACCELERATION, EXACT),
            Self::Reactions => Expected::answer(REACTION, EXACT),
        }
    }

    fn outcome(self, errors: &Errors) -> Outcome {
        let error = match self {
            Self::Accelerations => errors.acceleration,
            Self::Reactions => errors.multipliers,
        };
        Outcome::answer(error, format!("masses differ by {:.0e}", errors.spread))
    }
}

/// Computes the errors of accelerations and reactions at the initial state, relative to the exact
/// values.
fn errors(description: &Description) -> Result<Errors, Outcome> {
    let prepared = prepared(description)?;
    let mut motion = KeptRowMotion::new(&prepared).map_err(Outcome::refused)?;
    let layout = prepared.mechanism.layout();
    let mut a = vec![f64::NAN; layout.n_v];
    let mut lambda = ChosenValues::new(vec![f64::NAN; layout.rows()], Vec::new());
    let (q, v) = (&prepared.q, &prepared.v);
    let solved = motion
        .acceleration(0.0, q, v, &mut a)
        .and_then(|()| motion.multipliers(0.0, q, v, &mut lambda));
    solved.map_err(Outcome::refused)?;

    let s = motion.scratch();
    let c = layout.dense(s);
    let kept = &prepared.decision.kept;
    let rows: Vec<&[f64]> = kept.iter().map(|&i| c.row(i)).collect();
    let gamma: Vec<f64> = kept.iter().map(|&i| s.gamma[i]).collect();
    let exact = solve(prepared.mechanism.mass(), &rows, &s.force, &gamma).map_err(|why| {
        Outcome::fact(false, format!("the exact equations are singular: {why:?}"))
    })?;
    Ok(score::errors(
        &prepared,
        &motion,
        (&a, lambda.as_chosen()),
        &exact,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::judge;

    /// The test runs only the most extreme case of each kind; `lab stress` runs the whole family.
    #[test]
    fn extreme_masses_and_lengths_are_solved_or_refused() {
        let is_outermost = |case: &Case| {
            let power = case.varied.map_or(0.0, |(_, power)| power.abs());
            [0.0, 12.0, 24.0].contains(&power)
        };
        assert!((FAMILY.cases)().iter().any(is_outermost));
        super::super::assert_passes_where(FAMILY, is_outermost);
    }

    #[test]
    fn a_digit_that_is_wrong_is_silently_wrong() {
        let found = Outcome::answer(1.1 * ACCELERATION, "");
        let right = Question::Accelerations.right();
        assert_eq!(
            judge(&right, &found),
            crate::stress::Judgement::SilentlyWrong
        );
        // The mass differs from the reference by ten grams per ton.
        let scene = scenes().remove(0);
        let mut heavier = scene.description.clone();
        heavier.bodies[1].mass *= 1.0 + 1e-11;
        let prepared_right = prepared(&scene.description).unwrap();
        let prepared_wrong = prepared(&heavier).unwrap();
        let acceleration = |p: &dynamics::PreparedMechanism| {
            let mut a = vec![0.0; p.v.len()];
            KeptRowMotion::new(p)
                .unwrap()
                .acceleration(0.0, &p.q, &p.v, &mut a)
                .unwrap();
            a
        };
        let (right, wrong) = (acceleration(&prepared_right), acceleration(&prepared_wrong));
        assert!(score::of_accelerations(&prepared_right, &wrong, &right) > ACCELERATION);
    }
}
