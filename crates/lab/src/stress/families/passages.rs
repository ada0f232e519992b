//! Singular configurations near which a step must end. At these configurations the rank is lower,
//! branches of the motion meet, and accelerations are quotients 0/0.

use dynamics::{Method, MotionOptions};
use joints::RevoluteAngleDrive;
use model::{BodyRef, Description, Drive, Function};

use crate::mechanisms::cranks::cranks;
use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, combinations, moving, outcome_of, prepared, worst};

/// Two and three cranks that are driven through the singular configuration.
pub(super) const FAMILY: Family = Family {
    name: "passages",
    about: "two and three cranks driven through the flat pose, with a break time of the drive near it at which a step has to end",
    cases,
};

/// Initial angle of the first crank, which rotates at 1 rad/s.
const START: f64 = -0.5;
const END: f64 = 0.5;

/// Number of offsets of the break time on each side (s, which equals rad here).
const OFFSETS: u32 = 32;

/// A run may stop at an angle below this value from the singular configuration (rad).
const NEAR: f64 = 1e-2;

/// Tolerance of the runs.
const RTOL: f64 = 1e-9;

fn cases() -> Vec<Case> {
    let beside = (0..OFFSETS).flat_map(|k| {
        let offset = 10.0_f64.powf(-16.0 + 15.0 * f64::from(k) / f64::from(OFFSETS - 1));
        [-offset, offset]
    });
    let offsets: Vec<f64> = beside.chain([0.0]).collect();
    let base = MotionOptions {
        rtol: RTOL,
        atol: RTOL,
        output_step: END - START,
        ..MotionOptions::to(END - START)
    };
    let mut cases = Vec::new();
    for options in combinations(&base) {
        if options.method == Method::Auto {
            continue;
        }
        for pivots in [&[0.0, 1.0][..], &[0.0, 1.0, 1.7]] {
            for &offset in &offsets {
                cases.push(passed(pivots, offset, &options));
            }
        }
    }
    cases
}

fn passed(pivots: &'static [f64], offset: f64, options: &MotionOptions) -> Case {
    let (bound, source) = (
        1e-7,
        "all cranks have the angle of the drive, which is a straight line; a hundred tolerances",
    );
    let is_certain = is_explicit(options.method) && offset.abs() > NEAR;
    let right = if is_certain {
        Expected::answer(bound, source)
    } else {
        Expected::AnswerOrRefusal {
            bound,
            source,
            parts: vec!["do not determine".into()],
        }
    };
    let name = format!("{} cranks, offset {offset:.1e}", pivots.len());
    let case = moving(name, options.clone(), right, move |options| {
        let p = prepared(&driven(pivots, offset))?;
        Ok(outcome_of(&p, options, |row, _| off(row, END)))
    });
    case.at("offset of the break time", offset.abs().max(1e-17))
}

/// Whether the method is explicit. An explicit method has few stages, and none of the stages needs
/// to be at the instant of the singular configuration.
fn is_explicit(method: Method) -> bool {
    matches!(method, Method::Dop853 | Method::Dopri5 | Method::Tsit5)
}

/// Returns cranks with a piecewise linear drive. The drive has two intervals with equal slopes, and
/// the boundary of the intervals is near the singular configuration.
fn driven(pivots: &[f64], offset: f64) -> Description {
    let mut d = cranks(pivots, 0.5, START);
    let times = [0.0, offset - START, END - START];
    let motion = Function::lines(&times, &times);
    d.drives.extend(motion.ok().map(|motion| Drive {
        name: "motor".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
        motion,
        tolerance: None,
    }));
    d
}

/// Returns the deviation from the exact motion: parallel cranks at an angle, which rotate at 1
/// rad/s, and a horizontal coupler.
fn off(row: &Row, angle: f64) -> f64 {
    let last = row.q.len() / 3 - 1;
    let of_crank = |k: usize| [row.q[3 * k + 2] - angle, row.v[3 * k + 2] - 1.0];
    let level = [row.q[3 * last + 2], row.v[3 * last + 2]];
    worst((0..last).flat_map(of_crank).chain(level))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn the_other_branch_is_silently_wrong() {
        let p = prepared(&driven(&[0.0, 1.0], 0.1)).expect("starts");
        let options = MotionOptions::to(END - START);
        let found = outcome_of(&p, &options, |row, _| {
            // On the other branch, the second crank reverses its rotation.
            let mut row = row.clone();
            row.q[5] = -row.q[5];
            off(&row, END)
        });
        let right = Expected::answer(1e-7, "parallel cranks");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }

    #[test]
    fn a_step_may_end_at_any_place_beside_the_flat_pose() {
        let options = MotionOptions {
            rtol: RTOL,
            atol: RTOL,
            ..MotionOptions::to(END - START)
        };
        for offset in [0.0, 1e-16, -1e-12, 1e-8, -1e-4, 1e-2] {
            let case = passed(&[0.0, 1.0, 1.7], offset, &options);
            let found = judge(&case.expected, &(case.run)());
            assert!(found.passes(), "{}: {:?}", case.name, (case.run)());
        }
    }
}
