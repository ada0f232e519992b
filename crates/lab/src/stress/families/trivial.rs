//! Empty scenes, and scenes for which no decision is necessary.

use dynamics::MotionOptions;

use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{asking, combinations, last_row, moving, refused, study, worst};

/// No body, one body, or no rows.
pub(super) const FAMILY: Family = Family {
    name: "trivial",
    about: "no body, which is refused as a slip of the pen; a free body: no rows, nothing to decide",
    cases,
};

const EMPTY: &str = r#"scene = { name = "empty", space = "plane" }"#;

const THROWN: &str = r#"
scene = { name = "thrown", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "stone", mass = 2.0, inertia = 0.5, velocity = [3.0, 4.0], angular_velocity = -5.0 }]
"#;

fn cases() -> Vec<Case> {
    let empty = Expected::refusal(&["a mechanism needs at least one body"]);
    let free = Expected::answer(0.0, "rank 0 of 0 rows, no verdicts");
    let mut cases = vec![
        asking("empty scene", "analyze", empty, || nothing_found(EMPTY)),
        asking("free body", "analyze", free, || nothing_found(THROWN)),
    ];
    for options in combinations(&MotionOptions::to(2.0)) {
        let right = Expected::answer(
            100.0 * f64::EPSILON,
            "parabola, which every method follows exactly; rounding of a few hundred sums",
        );
        let run = |options: &MotionOptions| parabola(THROWN, options);
        cases.push(moving("free body", options, right, run));
    }
    cases
}

fn nothing_found(text: &str) -> Result<Outcome, Outcome> {
    let study = study(text)?;
    let found = study.analyse(0.0, None);
    let a = found.map_err(|e| refused(&e))?.analysis;
    let sizes = [a.decision.rank, a.decision.redundancy, a.reactions.len()];
    let detail = format!("rank, redundancy, verdicts {sizes:?}");
    let right = sizes == [0, 0, 0] && a.decision.is_decided();
    Ok(Outcome::fact(right, detail))
}

fn parabola(text: &str, options: &MotionOptions) -> Result<Outcome, Outcome> {
    let (row, summary) = last_row(&study(text)?.prepared, options)?;
    let t = options.t_end;
    let q = [3.0 * t, 4.0 * t - 0.5 * 9.81 * t * t, -5.0 * t];
    let v = [3.0, 4.0 - 9.81 * t, -5.0];
    let off =
        |found: &[f64], right: [f64; 3]| worst(found.iter().zip(right).map(|(a, b)| (a - b) / b));
    let error = worst([off(&row.q, q), off(&row.v, v)]);
    Ok(Outcome::answer(error, format!("{} steps", summary.steps)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::judge;

    #[test]
    fn nothing_is_made_of_nothing() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn a_stone_in_another_field_is_silently_wrong() {
        let heavier = THROWN.replace("9.81", "9.8100000001");
        let found = parabola(&heavier, &MotionOptions::to(2.0)).expect("it flies");
        let right = Expected::answer(1e-13, "parabola");
        assert_eq!(
            judge(&right, &found),
            crate::stress::Judgement::SilentlyWrong
        );
    }
}
