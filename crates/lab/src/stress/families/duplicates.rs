//! Mechanisms that contain the same joint twice, and joints that constrain no motion.

use model::BodyRef;

use crate::mechanisms::sketch::{Sketch, Tie};
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{analysed, asking, study};

/// Scenes that contain each kind of joint twice; joints that connect the ground to the ground; keys
/// for which the motion would depend on an arbitrary choice.
pub(super) const FAMILY: Family = Family {
    name: "duplicates",
    about: "each kind of joint twice: its rows are redundant, in pairs; joints that constrain nothing and friction are refused by name",
    cases,
};

/// Each kind of joint with its number of rows. Coordinates of points and directions are not round
/// values.
const TIES: [(&str, usize, Tie); 10] = [
    ("revolute", 2, Tie::Revolute { at: [0.3, 0.7] }),
    (
        "translational",
        2,
        Tie::Translational {
            from: [0.1, 0.2],
            at: [1.3, 0.9],
            axis: [1.2, 0.7],
        },
    ),
    ("fixed", 3, Tie::Fixed { at: [0.3, 0.7] }),
    (
        "pin in slot",
        1,
        Tie::PinInSlot {
            from: [0.1, 0.2],
            at: [1.3, 0.9],
            axis: [1.2, 0.7],
        },
    ),
    (
        "distance",
        1,
        Tie::Distance {
            from: [0.1, 0.2],
            at: [1.3, 0.9],
        },
    ),
    ("angle", 1, Tie::Angle),
    ("gear", 1, Tie::Gear { ratio: -2.3 }),
    (
        "rack and pinion",
        1,
        Tie::RackAndPinion {
            at: [0.3, 0.7],
            axis: [1.2, 0.7],
            radius: 0.21,
        },
    ),
    (
        "knife edge",
        1,
        Tie::KnifeEdge {
            at: [0.3, 0.7],
            normal: [0.4, 1.1],
        },
    ),
    (
        "rolling",
        1,
        Tie::Rolling {
            at: [0.3, 0.7],
            direction: [0.6, 0.8],
            radius: 0.21,
        },
    ),
];

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, rows, tie) in TIES {
        let right = Expected::answer(
            0.0,
            "a row and its copy are a circuit of two, and neither reaction is unique",
        );
        cases.push(asking(
            format!("{name}, twice"),
            "analyze",
            right,
            move || twice(tie, rows, 2),
        ));
    }
    for (name, text, parts) in REFUSED {
        let text = format!("{BODY}{text}");
        let run = move || study(&text).map(|_| Outcome::fact(false, "a mechanism"));
        cases.push(asking(name, "check", Expected::refusal(parts), run));
    }
    cases
}

const BODY: &str = r#"
scene = { name = "nothing", space = "plane" }
body = [{ name = "stone", mass = 1.0, inertia = 1.0 }]
"#;

/// The parts of a scene in addition to the body, and the correct outcome.
const REFUSED: [(&str, &str, &[&str]); 8] = [
    (
        "ground to ground",
        r#"joint = [{ name = "weld", type = "revolute", bodies = ["ground", "ground"], at = [0.0, 0.0] }]"#,
        &["`weld`", "ground"],
    ),
    (
        "body to itself",
        r#"joint = [{ name = "weld", type = "revolute", bodies = ["stone", "stone"], at = [0.0, 0.0] }]"#,
        &["`weld`", "`stone`"],
    ),
    (
        "rod without length",
        r#"joint = [{ name = "rod", type = "distance", bodies = ["ground", "stone"], at = [[1.0, 1.0], [1.0, 1.0]] }]"#,
        &["`rod`", "L > 0"],
    ),
    (
        "edge without normal",
        r#"joint = [{ name = "edge", type = "knife-edge", body = "stone", point = [0.0, 0.0], normal = [0.0, 0.0] }]"#,
        &["`edge`", "`normal`"],
    ),
    (
        "line without direction",
        r#"joint = [{ name = "rail", type = "point-on-line", body = "stone", point = [0.0, 0.0], line = [[1.0, 1.0], [1.0, 1.0]] }]"#,
        &["`rail`", "`line`"],
    ),
    (
        "friction of an edge",
        r#"joint = [{ name = "edge", type = "knife-edge", body = "stone", point = [0.0, 0.0], normal = [0.0, 1.0], friction = 0.3 }]"#,
        &["`edge`", "`friction`"],
    ),
    (
        "friction of a pin",
        r#"joint = [{ name = "pin", type = "revolute", bodies = ["ground", "stone"], at = [0.0, 0.0], friction = 0.3 }]"#,
        &["`pin`", "`friction`"],
    ),
    (
        "contact that can open",
        r#"joint = [{ name = "stop", type = "unilateral", body = "stone", point = [0.0, 0.0] }]"#,
        &["`stop`", "unilateral"],
    ),
];

/// Compares the ranks and verdicts for several copies of a joint between two bodies with theory.
fn twice(tie: Tie, rows: usize, copies: usize) -> Result<Outcome, Outcome> {
    let mut sketch = Sketch::default();
    let (one, other) = (
        sketch.body([0.13, 0.22], 0.37),
        sketch.body([1.41, 1.05], -0.81),
    );
    let bodies: Vec<BodyRef> = match tie {
        Tie::KnifeEdge { .. } => vec![one],
        Tie::Gear { .. } => vec![one, other, BodyRef::Ground],
        _ => vec![one, other],
    };
    for _ in 0..copies {
        sketch.link(&bodies, tie);
    }
    let a = analysed(&sketch.description())?;
    let pairs = a.dependencies.iter().filter(|d| d.rows.len() == 2).count();
    let unique = a
        .reactions
        .iter()
        .filter(|r| r.wrench.verdict.is_unique())
        .count();
    let found = [a.decision.rank, a.decision.redundancy, pairs, unique];
    let detail = format!("rank, redundancy, circuits of two, unique reactions {found:?}");
    Ok(Outcome::fact(
        found == [rows, rows, rows, 0] && a.decision.is_decided(),
        detail,
    ))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn copies_are_redundant_in_pairs() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn three_copies_are_silently_wrong() {
        let found = twice(Tie::Angle, 1, 3).expect("it can be judged");
        assert_eq!(
            judge(&Expected::answer(0.0, "two"), &found),
            Judgement::SilentlyWrong
        );
    }
}
