//! The tables of a random scene in the plane.

use super::Values;
use super::draft::Draft;
use super::functions::number_or_function;
use super::parts::{active, begin, own_place, place, stiff};

/// Adds the table `[[body]]`.
pub(super) fn body(draft: &mut Draft, values: &mut Values<'_>, k: usize) {
    let name = values.name("b", k);
    draft.line(&format!(
        "[[body]]\nname = {name}\nmass = {}\ninertia = {}",
        values.positive(),
        values.positive()
    ));
    draft.line(&format!("position = {}", values.point()));
    if values.numbers.once_in(3) {
        draft.line(&format!("angle = {}", values.angle()));
    }
    let is_elsewhere = values.numbers.once_in(10);
    if is_elsewhere {
        draft.line(&format!("centre = {}", values.point()));
    }
    let is_moving = values.numbers.once_in(4);
    if is_moving {
        draft.line(&format!("velocity = {}", values.velocity()));
    }
    // If the origin of the frame is not the mass centre, a velocity also needs an angular velocity.
    if values
        .numbers
        .once_in(if is_elsewhere && is_moving { 1 } else { 4 })
    {
        draft.line(&format!("angular_velocity = {}", values.number()));
    }
    draft.bodies.push(name);
}

/// Adds a holonomic joint of two bodies.
pub(super) fn joint(draft: &mut Draft, values: &mut Values<'_>, pair: [String; 2]) {
    let kinds = [
        "revolute",
        "revolute",
        "revolute",
        "revolute",
        "translational",
        "translational",
        "pin-in-slot",
        "fixed",
        "angle",
        "distance",
        "gear",
        "mesh",
        "rack-and-pinion",
        "point-on-line",
    ];
    let kind = kinds[values.numbers.below(kinds.len())];
    begin(draft, values, kind);
    if kind == "point-on-line" {
        draft.line(&format!("body = {}", pair[1]));
        own_place(draft, values);
        draft.line(&format!("line = [{}, {}]", values.point(), values.point()));
        return;
    }
    draft.line(&format!("bodies = [{}, {}]", pair[0], pair[1]));
    match kind {
        "angle" => {}
        "gear" => {
            draft.line(&format!("ratio = {}", values.number()));
            if values.numbers.once_in(3) {
                let carrier = draft.body(values.numbers, 3);
                draft.line(&format!("carrier = {carrier}"));
            }
        }
        "mesh" => {
            draft.line(&format!(
                "at = [{}, {}]\nratio = {}",
                values.point(),
                values.point(),
                values.number()
            ));
            if values.numbers.once_in(2) {
                let angles = ["0.35", "-0.35", "0", "1.5"];
                draft.line(&format!("pressure_angle = {}", values.one(&angles)));
            }
        }
        "distance" => draft.line(&format!("at = [{}, {}]", values.point(), values.point())),
        "rack-and-pinion" => {
            draft.line(&format!(
                "at = {}\naxis = {}\nradius = {}",
                values.point(),
                values.direction(),
                values.number()
            ));
        }
        "translational" | "pin-in-slot" => {
            place(draft, values, &pair);
            draft.line(&format!("axis = {}", values.direction()));
        }
        _ => place(draft, values, &pair),
    }
}

/// Adds a nonholonomic joint.
pub(super) fn nonholonomic(draft: &mut Draft, values: &mut Values<'_>) {
    let kind = values.one(&["knife-edge", "knife-edge", "velocity", "rolling"]);
    let kind = ["knife-edge", "velocity", "rolling"]
        .into_iter()
        .find(|k| *k == kind)
        .unwrap_or("knife-edge");
    begin(draft, values, kind);
    match kind {
        "rolling" => {
            let pair = draft.pair(values.numbers);
            draft.line(&format!("bodies = [{}, {}]", pair[0], pair[1]));
            draft.line(&format!("at = {}", values.point()));
            draft.line(&format!(
                "direction = {}\nradius = {}",
                values.direction(),
                values.number()
            ));
            if values.numbers.once_in(2) {
                let spin = values.one(&["absolute", "relative"]);
                draft.line(&format!("spin = \"{spin}\""));
            }
        }
        _ => {
            let body = draft.body(values.numbers, 100);
            draft.line(&format!("body = {body}"));
            own_place(draft, values);
            let key = if kind == "velocity" {
                "direction"
            } else {
                "normal"
            };
            draft.line(&format!("{key} = {}", values.direction()));
            if kind == "velocity" {
                let rate = number_or_function(values);
                draft.line(&format!("rate = {rate}"));
            }
        }
    }
}

/// Returns a joint coordinate that can be driven. Most joints have no coordinate, and a drive of
/// these joints is rejected.
pub(super) fn measure_of(values: &mut Values<'_>, kind: &str) -> Option<&'static str> {
    match kind {
        "revolute" => Some("angle"),
        "translational" => Some("displacement"),
        "pin-in-slot" => Some(values.one(&["angle", "displacement"])),
        "distance" => Some("length"),
        _ => values.numbers.once_in(20).then_some("angle"),
    }
}

/// Adds the table `[[force]]`.
pub(super) fn force(draft: &mut Draft, values: &mut Values<'_>) {
    let kind = values.one(&[
        "spring-damper",
        "torsion-spring-damper",
        "bushing",
        "point-force",
        "torque",
        "damper",
        "tyre",
    ]);
    let k = draft.text.len();
    let name = values.name("f", k);
    draft.line(&format!("[[force]]\nname = {name}\ntype = \"{kind}\""));
    active(draft, values);
    let pair = [
        draft.body(values.numbers, 3),
        draft.body(values.numbers, 10),
    ];
    if matches!(kind, "point-force" | "torque" | "tyre") {
        draft.line(&format!("body = {}", pair[1]));
    } else {
        draft.line(&format!("bodies = [{}, {}]", pair[0], pair[1]));
    }
    match kind {
        "spring-damper" => {
            draft.line(&format!("at = [{}, {}]", values.point(), values.point()));
            draft.line(&format!(
                "stiffness = {}\ndamping = {}",
                stiff(values),
                stiff(values)
            ));
            if values.numbers.once_in(2) {
                draft.line(&format!("free_length = {}", values.positive()));
            }
        }
        "damper" => draft.line(&format!(
            "at = [{}, {}]\ndamping = {}",
            values.point(),
            values.point(),
            stiff(values)
        )),
        "tyre" => {
            own_place(draft, values);
            draft.line(&format!(
                "normal = {}\nstiffness = {}",
                values.direction(),
                stiff(values)
            ));
            if values.numbers.once_in(3) {
                draft.line(&format!("low_speed = {}", values.positive()));
            }
        }
        "torsion-spring-damper" => {
            draft.line(&format!(
                "stiffness = {}\ndamping = {}",
                stiff(values),
                stiff(values)
            ));
            if values.numbers.once_in(2) {
                draft.line(&format!("free_angle = {}", values.number()));
            }
        }
        "bushing" => {
            draft.line(&format!("at = {}", values.point()));
            let [stiffness, damping] =
                [0, 1].map(|_| [stiff(values), stiff(values), stiff(values)].join(", "));
            draft.line(&format!("stiffness = [{stiffness}]\ndamping = [{damping}]"));
        }
        "point-force" => {
            own_place(draft, values);
            let force = [number_or_function(values), number_or_function(values)].join(", ");
            draft.line(&format!("force = [{force}]"));
            if values.numbers.once_in(3) {
                draft.line(&format!("frame = \"{}\"", values.one(&["body", "global"])));
            }
        }
        _ => draft.line(&format!("torque = {}", number_or_function(values))),
    }
}
