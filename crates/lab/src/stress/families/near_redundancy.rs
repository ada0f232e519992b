//! Rows that are parallel except for an angle ε, from 1e-2 to 1e-20. The rank is full for the given
//! values, and lower only within the accuracy of the data.

use dynamics::MotionOptions;
use joints::{Direction, KnifeEdge};
use model::{Body, BodyRef, Description, Joint, System};
use rank::Grounds;
use solvability::Analysis;

use crate::mechanisms::cranks::misaligned;
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{analysed, asking, built, last_row, moving, prepared, worst};
use exact::Exact;

/// Nearly parallel knife edges and cranks.
pub(super) const FAMILY: Family = Family {
    name: "near-redundancy",
    about: "edges and cranks that deviate from parallel by ε: of full rank, undecided, or redundant within the accuracy of the data, and reported so; the motion is \
            the same in all three",
    cases,
};

/// Above this ε the rank must be decided in double precision, because singular values down to 1e-7
/// can be distinguished from zero.
const DECIDED: f64 = 1e-6;
/// Some thousand rounding errors of values of size 1. A larger ε must not count as a rounding
/// error.
const ROUNDING: f64 = 1e-12;
/// Data of size 1 are accurate to about 1e-15. Between this constant and the next constant, ε may
/// be an actual angle or zero.
const READ_BOTH_WAYS: f64 = 5e-15;
/// See the constant [`READ_BOTH_WAYS`].
const ROUNDED_AWAY: f64 = 5e-14;
/// Below this ε, reactions are more than a thousand times as large as the loads, and a warning is
/// expected.
const WARNED: f64 = 1e-3;
/// Half the distance of the wheels (m).
const HALF: f64 = 0.5;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for k in 2..=20 {
        let e = 10_f64.powi(-k);
        for (name, describe) in [
            ("cranks", misaligned as fn(f64) -> Description),
            ("edges of one axle", axle),
        ] {
            let case = asking(
                format!("{name}, ε = {e:.0e}"),
                "analyze",
                verdict(e),
                move || said(&describe(e), e),
            );
            cases.push(case);
        }
        {
            let source = "closed form: turns about the contact of the right wheel; a hundred times the tolerance, and the rounding of the start over ε up to 1e-3";
            let bound = (1e-6 + 10.0 * f64::EPSILON / e).min(1e-3);
            // If velocities cannot be determined, the error message must contain the name of the
            // edge. If the edges may be parallel within the accuracy of the data, the message must
            // state this.
            let named = if (READ_BOTH_WAYS..ROUNDED_AWAY).contains(&e) {
                "their rounding"
            } else {
                "`right`"
            };
            let right = if e < DECIDED {
                Expected::AnswerOrRefusal {
                    bound,
                    source,
                    parts: vec![named.into()],
                }
            } else {
                Expected::answer(bound, source)
            };
            let options = MotionOptions::to(0.5);
            let run = move |o: &MotionOptions| about_the_wheel(&axle(e), o);
            let case = moving(
                format!("edges of one axle, ε = {e:.0e}"),
                options,
                right,
                run,
            );
            cases.push(case.at("ε", e));
        }
    }
    cases
}

/// Returns the accepted answers for the rank.
pub(super) fn verdict(e: f64) -> Expected {
    let source = "rank in exact arithmetic; the grounds of a certificate";
    if e < DECIDED {
        Expected::AnswerOrRefusal {
            bound: 0.0,
            source,
            parts: vec!["singular value".into()],
        }
    } else {
        Expected::answer(0.0, source)
    }
}

/// Returns a cart of unit mass and inertia on two knife edges to the left and right of its centre.
/// The right edge is rotated by ε, and the cart rotates about the contact point of the right edge.
fn axle(e: f64) -> Description {
    let edge = |name: &str, y: f64, normal: [f64; 2]| {
        let normal = Direction::new(normal).unwrap_or(Direction::Y);
        Joint::new(
            name,
            &[BodyRef::Body(0)],
            KnifeEdge {
                s: [0.0, y],
                normal,
            },
        )
    };
    Description {
        name: "axle".into(),
        bodies: vec![Body {
            name: "cart".into(),
            mass: 1.0,
            inertia: 1.0,
            velocity: Some([1.0, 0.0]),
            angular_velocity: Some(-1.0 / HALF),
            ..Body::default()
        }],
        joints: vec![
            edge("left", HALF, [0.0, 1.0]),
            edge("right", -HALF, [e, 1.0]),
        ],
        ..Description::default()
    }
}

/// Compares the reported rank with the exact rank of the stored C.
pub(super) fn said(d: &Description, e: f64) -> Result<Outcome, Outcome> {
    let mechanism = built(d)?;
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.c(&mut s);
    let c = mechanism.layout().dense(&s);
    let rows: Vec<&[f64]> = (0..c.nrows()).map(|i| c.row(i)).collect();
    right_of(&analysed(d)?, Exact::of(&rows).rank(), e)
}

fn right_of(a: &Analysis, exact: usize, e: f64) -> Result<Outcome, Outcome> {
    if let rank::RankStatus::Undecided(doubt) = &a.decision.status {
        return Err(Outcome::refused(doubt));
    }
    let rank = a.decision.rank;
    let unique = a
        .reactions
        .iter()
        .filter(|r| r.wrench.verdict.is_unique())
        .count();
    let grounds = a.evidence().certificate.as_ref().map(|c| c.grounds);
    let detail = format!(
        "rank {rank}, exactly {exact}; {unique} of {} reactions unique; {grounds:?}",
        a.reactions.len()
    );
    let warned = a.nearly_redundant.as_ref();
    let detail = format!(
        "{detail}, {:.0e}",
        warned.map_or(f64::NAN, |near| near.sigma)
    );
    // The rank for the given values is correct if a warning states the size of ε. Another rank is
    // correct only if the answer states that the data do not decide it.
    let right = if rank == exact {
        let answer = e >= WARNED || warned.is_some_and(|near| near.sigma <= 2.0 * e);
        answer && unique == a.reactions.len()
    } else {
        let within = e < ROUNDING && grounds == Some(Grounds::WithinData);
        within && rank + 1 == exact && unique == 0
    };
    Ok(Outcome::fact(right, detail))
}

/// Without applied forces, the speed and the centre of rotation are constant.
fn about_the_wheel(d: &Description, options: &MotionOptions) -> Result<Outcome, Outcome> {
    let (row, summary) = last_row(&prepared(d)?, options)?;
    let angle = -row.t / HALF;
    let right = [-HALF * angle.sin(), -HALF + HALF * angle.cos(), angle];
    let error = worst(row.q.iter().zip(right).map(|(a, b)| a - b));
    Ok(Outcome::answer(error, format!("{} steps", summary.steps)))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn no_rank_and_no_motion_is_wrong() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn another_rank_and_another_axle_are_silently_wrong() {
        let a = analysed(&misaligned(1e-3)).expect("finite");
        let found = right_of(&a, 11, 1e-3).expect("decided");
        assert_eq!(judge(&verdict(1e-3), &found), Judgement::SilentlyWrong);
        let mut d = axle(1e-3);
        d.joints.remove(1);
        d.bodies[0].angular_velocity = d.bodies[0].angular_velocity.map(|rate| 1.001 * rate);
        let found = about_the_wheel(&d, &MotionOptions::to(1.0)).expect("it turns");
        assert_eq!(
            judge(&Expected::answer(1e-6, "closed form"), &found),
            Judgement::SilentlyWrong
        );
    }
}
