//! The documentation at the start of a module.

use dynamics::code::LEAVE;
use model::{SpaceKind, System};

use super::one_line;
use crate::functions::{Functions, NamedView};
use crate::subject::Subject;

/// Description of the coordinates and velocities in space.
const IN_SPACE: [&str; 3] = [
    "Coordinates of a body: its mass centre, then the quaternion (w, x, y, z) of its principal axes, of any length; velocities: that of the",
    "mass centre along the axes of the ground, then the angular velocity along the principal axes. `dq` is a displacement along velocities: a",
    "translation and a rotation vector.",
];

/// Returns the lines of the documentation of a module.
pub(super) fn of(subject: &Subject<'_>, functions: &Functions) -> Vec<String> {
    let prepared = subject.prepared;
    let layout = prepared.mechanism.layout();
    let numbers = |rows: &[usize]| match rows {
        [] => "none".to_owned(),
        rows => {
            let rows: Vec<String> = rows.iter().map(|i| (i + 1).to_string()).collect();
            rows.join(", ")
        }
    };
    let mut docs = vec![
        format!(
            "The mechanism `{}`: {} coordinates, {} velocities, {} holonomic and {} nonholonomic rows of rank {}.",
            one_line(prepared.mechanism.name()),
            layout.n_q,
            layout.n_v,
            layout.m,
            layout.h,
            prepared.decision.rank
        ),
        format!(
            "Rows (from 1) that are dropped and only monitored: {}; that do not hold the position: {}.",
            numbers(&prepared.decision.dropped),
            numbers(&prepared.position_decision.dropped)
        ),
        match (&functions.view, prepared.mechanism.space()) {
            (NamedView::Frame(body), _) => format!("Solved in the frame of the body `{body}`: it does not matter which way the whole points."),
            (NamedView::Ground, SpaceKind::Space3) => "Solved with angular velocities along principal axes.".to_owned(),
            (NamedView::JointAxes, _) => "Solved with angular velocities along the axes of bodies that carry others.".to_owned(),
            (NamedView::GroundAxes, _) => "Solved with angular velocities along the axes of the ground.".to_owned(),
            (NamedView::Ground, _) => "Solved in the frame of the ground.".to_owned(),
        },
        String::new(),
        "Straight-line code on arrays, without allocation and without imports. SI units, radians; `M·v̇ + Cᵀ·λ = Q`, `C·v̇ = Γ`. Functions that"
            .to_owned(),
        "divide return a health: the smallest divisor relative to its value at the states for which the code was generated, with its sign. Near 0 the"
            .to_owned(),
        "order of elimination is no longer accurate, below 0 a divisor has passed through zero.".to_owned(),
        match functions.unhealthy {
            0 => format!("At all {} states that it was made for the health is above {LEAVE}.", subject.states.len()),
            n => format!(
                "At {n} of the {} states that it was made for the health is below {LEAVE}: the motion comes near a configuration at which a divisor vanishes, and needs other code there.",
                subject.states.len()
            ),
        },
    ];
    if prepared.mechanism.space() == SpaceKind::Space3 {
        docs.extend(IN_SPACE.map(str::to_owned));
    }
    if !subject.inputs.list.is_empty() {
        docs.extend([
            format!(
                "Functions take {} numbers of the scene as `p`, see `PARAMETERS`; these keys of the scene are varied: {}.",
                subject.inputs.list.len(),
                one_line(&subject.inputs.keys.join(", "))
            ),
            "The health belongs to the given values of the inputs: it is the smallest one of the states above, which include motions with other values."
                .to_owned(),
        ]);
    }
    docs.extend(["", "| function | operations |", "| --- | --- |"].map(str::to_owned));
    for f in &functions.list {
        docs.push(format!(
            "| `{}` | {} |",
            f.signature.name,
            f.program.counts()
        ));
    }
    docs
}
