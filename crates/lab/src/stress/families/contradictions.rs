//! Mechanisms with more drives than degrees of freedom. If the drives are consistent, the mechanism
//! moves. Otherwise no motion exists, and the error message contains the names of both drives.

use dynamics::MotionOptions;
use joints::{Direction, Velocity};
use model::{Body, BodyRef, ContactLimits, Description, Function, Joint};

use crate::mechanisms::cranks::driven_parallelogram;
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{asking, combinations, last_row, moving, prepared, worst};

/// Redundant drives and redundant rows that prescribe velocities.
pub(super) const FAMILY: Family = Family {
    name: "contradictions",
    about: "drives and prescribed velocities that are one too many: the same law, laws that differ at the start by less and less, laws that part later",
    cases,
};

/// The parts of the error message if prescribed velocities become inconsistent during a run.
const PARTED: &[&str] = &["at t = ", "dropped row"];

/// The parts of the error message if the laws of two drives become inconsistent during a run.
const DRIVES_PARTED: &[&str] = &["at t = ", "`one`", "`other`", "contradict each other"];

/// The residual of a redundant row that is allowed in a run, as documented in `dynamics`. It is
/// relative to the largest row, and the size of rows is at most 3 here.
const MONITORED: f64 = 3e-11;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for options in combinations(&MotionOptions::to(0.5)) {
        let right = Expected::answer(
            1e-9,
            "the law itself; driven coordinates are solved to rounding",
        );
        cases.push(moving("the same law on both cranks", options, right, |o| {
            followed([0.0, 1.0, 2.0], o)
        }));
    }
    for (level, order) in [("velocities", 1), ("accelerations", 2)] {
        for k in 0..=15 {
            let size = 10_f64.powi(-k);
            // After 2 s, the positions differ by twice the difference of the initial rates.
            let right = if size >= 1e-9 {
                Expected::refusal(&["`one`", "`other`", "delete or correct one"])
            } else {
                differing(2.0 * size, &["at t = ", "row"])
            };
            let name = format!("{level} differ by {size:.0e}");
            let options = MotionOptions::to(2.0);
            let case = moving(name, options, right, move |o| differ(order, size, o));
            cases.push(case.at("difference (rad/s, rad/s²)", size));
        }
    }
    for options in combinations(&MotionOptions::to(2.0)) {
        for k in [1, 3, 6, 9, 11, 14] {
            let size = 10_f64.powi(-k);
            let right = differing(size, DRIVES_PARTED);
            let name = format!("laws part by {size:.0e} from t = 1 on");
            let case = moving(name, options.clone(), right, move |o| part(size, o));
            cases.push(case);
        }
        let right = Expected::refusal(PARTED);
        cases.push(moving(
            "velocities of a cart part from t = 1 on",
            options,
            right,
            velocities_part,
        ));
    }
    let right = Expected::refusal(&["front", "rear", "m/s"]);
    cases.push(asking(
        "velocities of a cart differ",
        "start",
        right,
        || {
            prepared(&towed([polynomial(&[1.0])?, polynomial(&[1.5])?]))
                .map(|_| Outcome::fact(false, "a start"))
        },
    ));
    cases
}

/// Two laws count as equal if they differ by at most some hundred rounding errors of an angle.
const SAME: f64 = 1e-13;

/// Expects an error if the difference of positions exceeds the accepted value, and a motion if the
/// positions are equal. If the difference is close to the accepted value, both are correct.
fn differing(size: f64, parts: &[&str]) -> Expected {
    let parts = parts.iter().map(|&part| part.to_owned()).collect();
    match size {
        _ if size <= SAME => Expected::answer(1e-9, "the same law to rounding"),
        _ if size > MONITORED => Expected::Refusal { parts },
        _ => Expected::AnswerOrRefusal {
            bound: 1e-9,
            source: "the laws differ by less than what the configuration is known to",
            parts: Vec::new(),
        },
    }
}

fn polynomial(coefficients: &[f64]) -> Result<Function, Outcome> {
    Function::polynomial(coefficients).map_err(Outcome::refused)
}

/// Both cranks rotate by `c[1]·t + c[2]·t²`. The law of one crank has a different constant term
/// `c[0]`.
fn followed(c: [f64; 3], options: &MotionOptions) -> Result<Outcome, Outcome> {
    let law = [polynomial(&c)?, polynomial(&[5.0, c[1], c[2]])?];
    let (row, _) = last_row(&prepared(&driven_parallelogram(law))?, options)?;
    let turned = c[1] * row.t + c[2] * row.t * row.t;
    let rate = c[1] + 2.0 * c[2] * row.t;
    let error = worst([
        row.q[2] - 1.0 - turned,
        row.q[5] - 1.0 - turned,
        row.v[2] - rate,
    ]);
    let whole = row.t == options.t_end;
    Ok(Outcome::answer(
        if whole { error } else { f64::INFINITY },
        format!("reached {} s", row.t),
    ))
}

/// The laws of the drives differ by `size` in the derivative of this order at the initial time.
fn differ(order: usize, size: f64, options: &MotionOptions) -> Result<Outcome, Outcome> {
    let mut other = [0.0, 1.0, 0.0];
    // The second derivative of t² is 2.
    other[order] += if order == 2 { 0.5 * size } else { size };
    let laws = [polynomial(&[0.0, 1.0])?, polynomial(&other)?];
    let (row, _) = last_row(&prepared(&driven_parallelogram(laws))?, options)?;
    let off = worst([row.q[2] - 1.0 - row.t, row.v[2] - 1.0]);
    Ok(Outcome::answer(off, format!("reached {} s", row.t)))
}

/// The laws of the drives and all their derivatives agree up to t = 1 s.
fn part(size: f64, options: &MotionOptions) -> Result<Outcome, Outcome> {
    let late = Function::steps(0.0, &[[1.0, 2.0, size]]).map_err(Outcome::refused)?;
    let found = prepared(&driven_parallelogram([late, polynomial(&[0.0])?]))?;
    let (row, _) = last_row(&found, options)?;
    Ok(Outcome::answer(
        worst([row.q[2] - 1.0, row.q[5] - 1.0]),
        format!("reached {} s", row.t),
    ))
}

/// Returns a cart. Two drives move the front point and the rear point along the cart at these
/// rates.
fn towed([front, rear]: [Function; 2]) -> Description {
    let pull = |name: &str, x: f64, rate: Function| Joint {
        name: name.into(),
        bodies: vec![BodyRef::Body(0)],
        element: Box::new(Velocity {
            s: [x, 0.0],
            direction: Direction::X,
        }),
        functions: vec![rate],
        tolerance: None,
        limits: ContactLimits::default(),
    };
    Description {
        name: "towed cart".into(),
        bodies: vec![Body {
            name: "cart".into(),
            mass: 1.0,
            inertia: 1.0,
            velocity: Some([1.0, 0.0]),
            ..Body::default()
        }],
        joints: vec![pull("front", 1.0, front), pull("rear", -1.0, rear)],
        ..Description::default()
    }
}

fn velocities_part(options: &MotionOptions) -> Result<Outcome, Outcome> {
    let late = Function::steps(1.0, &[[1.0, 1.5, 0.25]]).map_err(Outcome::refused)?;
    let d = towed([polynomial(&[1.0])?, late]);
    let (row, _) = last_row(&prepared(&d)?, options)?;
    Ok(Outcome::fact(
        false,
        format!("reached {} s with v = {}", row.t, row.v[0]),
    ))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;
    use dynamics::Method;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn every_start_is_right() {
        super::super::assert_passes_where(FAMILY, |case| {
            case.method == "start" || case.method == Method::Auto.name()
        });
    }

    /// If the result is compared with the law of another motion, the test detects an error.
    #[test]
    fn another_law_is_silently_wrong() {
        let found = followed([0.0, 1.0, 2.0], &MotionOptions::to(0.5)).expect("it moves");
        assert_eq!(
            judge(&Expected::answer(1e-9, "the law"), &found),
            Judgement::Right
        );
        let late = part(1e-3, &MotionOptions::to(2.0)).unwrap_or_else(|refusal| refusal);
        assert_eq!(
            judge(&Expected::answer(1e-9, "no motion at all"), &late),
            Judgement::Limit
        );
        let same = differ(1, 0.0, &MotionOptions::to(2.0)).expect("the same law");
        assert_eq!(
            judge(&Expected::refusal(&["`one`"]), &same),
            Judgement::SilentlyWrong
        );
    }
}
