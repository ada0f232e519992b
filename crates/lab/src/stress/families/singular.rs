//! Configurations at which the rank is lower than at other configurations. The verdicts at this
//! configuration and at other configurations must be correct, and the report must contain both.

use joints::KnifeEdge;
use joints::plane::Direction;
use model::start::{Metric, assemble, nearest_configuration};
use model::{
    Body, BodyRef, ConfigurationAccuracy, Description, Function, Joint, StartOptions, System,
};
use rank::count_deletions;
use solvability::{analyse_known, generic};

use super::near_redundancy;
use crate::mechanisms::cranks::cranks;
use crate::mechanisms::robot::robot;
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{analysed, asking, built, refused, study};

/// Cranks in the singular configuration, knife edges perpendicular to the driven direction, and the
/// robot steered to ±90°.
pub(super) const FAMILY: Family = Family {
    name: "singular",
    about: "flat cranks at the instant and near it, four edges of which two are steered, the robot with its edges at ±90°: ranks and verdicts there and elsewhere",
    cases,
};

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, pivots, usual) in [
        ("two cranks", &[0.0, 1.0][..], 0),
        ("three cranks", &[0.0, 1.0, 1.7], 1),
        ("four cranks", &[0.0, 0.3, 1.0, 1.7], 2),
    ] {
        for theta in [0.0, 0.4, 1.5] {
            let here = usual + usize::from(theta == 0.0);
            let right = Expected::answer(
                0.0,
                "n cranks have n − 2 redundant rows, and one more where they are flat",
            );
            let d = cranks(pivots, 0.5, theta);
            cases.push(asking(
                format!("{name} at {theta} rad"),
                "analyze",
                right,
                move || compared(&d, here, usual),
            ));
        }
    }
    for k in 1..=20 {
        let theta = 10_f64.powi(-k);
        let d = cranks(&[0.0, 1.0], 0.5, theta);
        let right = near_redundancy::verdict(theta);
        let case = asking(
            format!("two cranks {theta:.0e} rad from flat"),
            "analyze",
            right,
            move || near_redundancy::said(&d, theta),
        );
        cases.push(case);
    }
    let right = Expected::AnswerOrRefusal {
        bound: 0.0,
        source: "the flat pose has one redundant row more than the motion to it",
        parts: vec!["singular".into()],
    };
    cases.push(asking(
        "two driven cranks when they pass the flat pose",
        "analyze",
        right,
        passing,
    ));
    for (steering, sizes) in [
        (0.0, [2, 2, 1]),
        (0.3, [3, 1, 0]),
        (std::f64::consts::FRAC_PI_2, [3, 1, 0]),
    ] {
        let right = Expected::answer(
            0.0,
            "by hand: rank, redundancy, freedoms; only the pair that is not steered shares its force when locked",
        );
        cases.push(asking(
            format!("four edges, the front pair at {steering:.2} rad"),
            "analyze",
            right,
            move || edges(steering, sizes),
        ));
    }
    let right = Expected::refusal(&[
        "`vx` of body `cart` is fixed by `keep` at 1",
        "omit `cart.vx` in `keep`",
    ]);
    cases.push(asking(
        "locked edges with a velocity that is held",
        "start",
        right,
        || study(LOCKED).map(|study| Outcome::fact(false, format!("v = {:?}", study.prepared.v))),
    ));
    let right = Expected::answer(
        1e-15,
        "locked: no velocity but zero, and the whole of the described one is answer as corrected",
    );
    cases.push(asking(
        "locked edges with a described velocity",
        "start",
        right,
        stopped,
    ));
    // The values follow from the lengths of the linkage. The pin of the link rotates by 90° about
    // B, and the distance between this pin and the slider is the length of the link.
    for (name, displacement) in [
        ("front edge at +90°", 0.11 - 0.0601_f64.sqrt()),
        ("front edge at −90°", 0.29 - 0.0401_f64.sqrt()),
    ] {
        let right = Expected::answer(
            0.0,
            "worked out by hand for the published structure: rank 20, rows 3, 5, 18–21 not unique, 8 pairs",
        );
        cases.push(asking(
            format!("robot, {name}"),
            "analyze",
            right,
            move || steered(displacement),
        ));
    }
    cases
}

/// Compares the redundancy here and at other configurations.
fn compared(d: &Description, here: usize, usual: usize) -> Result<Outcome, Outcome> {
    let found = analysed(d)?.decision.redundancy;
    let mechanism = built(d)?;
    let (q, _) = mechanism.described_state();
    let elsewhere = generic(&mechanism, 0.0, &q).map(|g| g.redundancy);
    let detail = format!("{found} redundant rows here, {elsewhere:?} elsewhere");
    Ok(Outcome::fact(
        found == here && elsewhere == Some(usual),
        detail,
    ))
}

/// Tests a parallelogram whose first crank is driven from −1 rad through the singular configuration
/// at t = 1 s.
fn passing() -> Result<Outcome, Outcome> {
    let (length, angle) = (0.5, -1.0_f64);
    let [x, y] = [0.5 * length * angle.cos(), 0.5 * length * angle.sin()];
    let text = format!(
        r#"
scene = {{ name = "driven parallelogram", space = "plane" }}
body = [
    {{ name = "one", mass = 1.0, inertia = 0.1, position = [{x:?}, {y:?}], angle = {angle:?} }},
    {{ name = "other", mass = 1.0, inertia = 0.1, position = [{other:?}, {y:?}], angle = {angle:?} }},
    {{ name = "coupler", mass = 1.0, inertia = 0.1, position = [{coupler:?}, {top:?}] }},
]
joint = [
    {{ name = "pivot 1", type = "revolute", bodies = ["ground", "one"], points = {{ ground = [0.0, 0.0], one = [-0.25, 0.0] }} }},
    {{ name = "tip 1", type = "revolute", bodies = ["one", "coupler"], points = {{ one = [0.25, 0.0], coupler = [-0.5, 0.0] }} }},
    {{ name = "pivot 2", type = "revolute", bodies = ["ground", "other"], points = {{ ground = [1.0, 0.0], other = [-0.25, 0.0] }} }},
    {{ name = "tip 2", type = "revolute", bodies = ["other", "coupler"], points = {{ other = [0.25, 0.0], coupler = [0.5, 0.0] }} }},
]
drive = [{{ name = "motor", joint = "pivot 1", type = "angle", motion = {{ type = "constant-rate", rate = 1.0 }} }}]
simulate = {{ t_end = 2.0 }}
"#,
        other = 1.0 + x,
        coupler = 2.0 * x + 0.5,
        top = 2.0 * y,
    );
    let study = study(&text)?;
    let there = study.analyse(1.0, None).map_err(|e| refused(&e))?;
    let decision = &there.analysis.decision;
    if let rank::RankStatus::Undecided(doubt) = &decision.status {
        return Err(Outcome::refused(format!(
            "near a singular configuration: {doubt}"
        )));
    }
    let elsewhere = there.generic().map(|g| g.redundancy);
    let detail = format!(
        "{} redundant rows at the instant, {elsewhere:?} elsewhere",
        decision.redundancy
    );
    Ok(Outcome::fact(
        decision.redundancy == 1 && elsewhere == Some(0),
        detail,
    ))
}

/// Tests one body on four edges, with the front pair steered in parallel.
fn edges(steering: f64, sizes: [usize; 3]) -> Result<Outcome, Outcome> {
    let edge = |name: &str, x: f64, y: f64| {
        let angle = if x > 0.0 { steering } else { 0.0 };
        let normal = Direction::new([-angle.sin(), angle.cos()]).unwrap_or(Direction::Y);
        Joint::new(name, &[BodyRef::Body(0)], KnifeEdge { s: [x, y], normal })
    };
    let d = Description {
        bodies: vec![Body {
            name: "cart".into(),
            mass: 1.0,
            inertia: 1.0,
            ..Body::default()
        }],
        joints: vec![
            edge("front left", 1.0, 0.4),
            edge("front right", 1.0, -0.4),
            edge("rear left", -1.0, 0.4),
            edge("rear right", -1.0, -0.4),
        ],
        ..Description::default()
    };
    let a = analysed(&d)?;
    let found = [a.decision.rank, a.decision.redundancy, a.mobility()];
    let unique: Vec<bool> = a
        .reactions
        .iter()
        .map(|r| r.wrench.verdict.is_unique())
        .collect();
    // If the motion is blocked, the forces of the two steered wheels are determined separately.
    let shared = [steering != 0.0, steering != 0.0, false, false];
    let detail = format!("rank, redundancy, freedoms {found:?}; unique {unique:?}");
    Ok(Outcome::fact(found == sizes && unique == shared, detail))
}

/// A cart with a forward velocity and front wheels perpendicular to the cart.
const LOCKED: &str = r#"
scene = { name = "locked", space = "plane" }
body = [{ name = "cart", mass = 1.0, inertia = 1.0, velocity = [1.0, 0.0] }]
joint = [
    { name = "front left", type = "knife-edge", body = "cart", point = [1.0, 0.4], normal = [1.0, 0.0] },
    { name = "front right", type = "knife-edge", body = "cart", point = [1.0, -0.4], normal = [1.0, 0.0] },
    { name = "rear left", type = "knife-edge", body = "cart", point = [-1.0, 0.4], normal = [0.0, 1.0] },
    { name = "rear right", type = "knife-edge", body = "cart", point = [-1.0, -0.4], normal = [0.0, 1.0] },
]
start = { keep = ["cart.vx"] }
"#;

fn stopped() -> Result<Outcome, Outcome> {
    let found = study(&LOCKED.replace("keep = [\"cart.vx\"]", "allow_correction = true"))?.prepared;
    let answer = found
        .velocity_correction
        .first()
        .map_or(f64::NAN, |c| c + 1.0);
    let error = crate::stress::motion::worst(found.v.iter().copied().chain([answer]));
    Ok(Outcome::answer(error, format!("v = {:?}", found.v)))
}

/// Returns the robot with a displaced slider, at a configuration that satisfies the constraints.
fn steered(displacement: f64) -> Result<Outcome, Outcome> {
    const STEPS: u32 = 64;
    let ramp = Function::polynomial(&[0.0, displacement]).map_err(Outcome::refused)?;
    let mut mechanism = built(&robot(ramp))?;
    let assembly = assemble(&mut mechanism, &StartOptions::default()).map_err(Outcome::refused)?;
    // Φq of the robot has full rank, so all holonomic rows can be satisfied.
    let rows: Vec<usize> = (0..mechanism.layout().m).collect();
    let mut q = assembly.q;
    for k in 1..=STEPS {
        let t = f64::from(k) / f64::from(STEPS);
        q = nearest_configuration(&mechanism, t, &rows, &q, Metric::Mass)
            .map_err(Outcome::refused)?;
    }
    // The robot has no joint with the ground, so it can be rotated. The platform is rotated to the
    // x-axis, so that the normals of its edges are along the y-axis.
    let (sin, cos) = q[2].sin_cos();
    let heading = q[2];
    for body in q.chunks_mut(3) {
        let [x, y] = [body[0], body[1]];
        (body[0], body[1]) = (cos * x + sin * y, cos * y - sin * x);
        body[2] -= heading;
    }
    // The accuracy allows for some thousand rounding errors in the computation.
    let a = analyse_known(&mechanism, 1.0, &q, ConfigurationAccuracy::To(1e-12))
        .map_err(Outcome::refused)?;
    if let rank::RankStatus::Undecided(doubt) = &a.decision.status {
        return Err(Outcome::refused(doubt));
    }
    let rows = a.reactions.iter().flat_map(|r| &r.rows).enumerate();
    let free: Vec<usize> = rows
        .filter(|(_, row)| !row.judgement.verdict.is_unique())
        .map(|(i, _)| i + 1)
        .collect();
    let whole = a
        .whole()
        .ok_or_else(|| Outcome::refused("judged by parts"))?;
    let pairs = count_deletions(&whole).map_err(Outcome::refused)?;
    let found = [a.decision.rank, a.decision.redundancy];
    let detail = format!("rank, redundancy {found:?}; rows {free:?} not unique; {pairs} pairs");
    let right = found == [20, 2] && free == [3, 5, 18, 19, 20, 21] && pairs == 8;
    Ok(Outcome::fact(right, detail))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn verdicts_at_singular_configurations() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn the_robot_steered_less_is_silently_wrong() {
        let right = Expected::answer(0.0, "at +90°");
        let found = steered(-0.1).expect("it can be judged");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }
}
