//! The tables of a random scene: those of the plane, and what both spaces have.

use super::functions::{function, number_or_function};
use super::{Draft, Space, Values, space};

/// `[scene]`.
pub(super) fn head(draft: &mut Draft, values: &mut Values<'_>) {
    let name = values.name("scene", 0);
    let gravity = match values.numbers.below(4) {
        0 => String::new(),
        1 => format!("gravity = {}", values.velocity()),
        _ => match draft.space {
            Space::Plane => "gravity = [0.0, -9.81]".to_owned(),
            Space::Space => "gravity = [0.0, 0.0, -9.81]".to_owned(),
        },
    };
    let space = match draft.space {
        Space::Plane => "plane",
        Space::Space => "spatial",
    };
    draft.line(&format!(
        "[scene]\nname = {name}\nspace = \"{space}\"\n{gravity}"
    ));
    if values.numbers.once_in(5) {
        // What the data are known to, from rounded to measured by hand.
        let tolerances = ["1e-9", "1e-6", "1e-4", "1e-2"];
        draft.line(&format!("tolerance = {}", values.one(&tolerances)));
    }
    if values.has_expressions() {
        draft.line("format = 2");
        if values.numbers.once_in(3) {
            let units = [
                "length = \"mm\"",
                "angle = \"deg\"",
                "length = \"in\", angle = \"deg\"",
            ];
            draft.line(&format!("units = {{ {} }}", values.one(&units)));
        }
        draft.line(&values.parameters());
    }
}

/// `active`, mostly left out.
pub(super) fn active(draft: &mut Draft, values: &mut Values<'_>) {
    if values.numbers.once_in(25) {
        let is_active = values.one(&["false", "true", "false", "0", "1"]);
        draft.line(&format!("active = {is_active}"));
    }
}

/// `[[marker]]`.
pub(super) fn marker(draft: &mut Draft, values: &mut Values<'_>) {
    let name = values.name("m", draft.markers.len());
    let body = draft.body(values.numbers, 4);
    draft.line(&format!(
        "[[marker]]\nname = {name}\nbody = {body}\npoint = {}",
        values.point()
    ));
    if values.numbers.once_in(2) {
        let turned = match draft.space {
            Space::Plane => format!("angle = {}", values.angle()),
            Space::Space => format!("orientation = {}", space::orientation(values)),
        };
        draft.line(&turned);
    }
    if values.numbers.once_in(8) {
        draft.line("tolerance = 1e-5");
    }
    draft.markers.push(name);
}

/// `[[measure]]` between markers.
pub(super) fn measure(draft: &mut Draft, values: &mut Values<'_>) {
    let kinds = match draft.space {
        Space::Plane => ["distance", "x", "y", "speed", "angle", "angular-velocity"],
        Space::Space => ["distance", "x", "y", "speed", "z", "angular-velocity"],
    };
    let kind = values.one(&kinds);
    let k = draft.text.len();
    let name = values.name("q", k);
    let count = draft.markers.len();
    let of = |values: &mut Values<'_>| {
        if count == 0 || values.numbers.once_in(8) {
            "\"ground\"".to_owned()
        } else {
            draft.markers[values.numbers.below(count)].clone()
        }
    };
    let first = of(values);
    let second = of(values);
    let markers = if values.numbers.once_in(3) || first == second && !values.numbers.once_in(8) {
        first
    } else {
        format!("{first}, {second}")
    };
    draft.line(&format!(
        "[[measure]]\nname = {name}\ntype = \"{kind}\"\nmarkers = [{markers}]"
    ));
}

/// `[[body]]`.
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
    // The velocity of a frame elsewhere needs an angular velocity beside it.
    if values
        .numbers
        .once_in(if is_elsewhere && is_moving { 1 } else { 4 })
    {
        draft.line(&format!("angular_velocity = {}", values.number()));
    }
    draft.bodies.push(name);
}

/// Begins a joint.
pub(super) fn begin(draft: &mut Draft, values: &mut Values<'_>, kind: &'static str) {
    let k = draft.joints.len();
    let name = values.name("j", k);
    draft.line(&format!("[[joint]]\nname = {name}\ntype = \"{kind}\""));
    active(draft, values);
    draft.joints.push((name, kind));
}

/// A place between two bodies: mostly a global point, which is consistent with any start.
pub(super) fn place(draft: &mut Draft, values: &mut Values<'_>, pair: &[String; 2]) {
    let line = if values.numbers.once_in(8) {
        format!(
            "points = {{ {} = {}, {} = {} }}",
            pair[0],
            values.point(),
            pair[1],
            values.point()
        )
    } else if !draft.markers.is_empty() && values.numbers.once_in(6) {
        let marker = values.numbers.below(draft.markers.len());
        format!("at = {}", draft.markers[marker])
    } else {
        format!("at = {}", values.point())
    };
    draft.line(&line);
}

/// A place for one body.
pub(super) fn own_place(draft: &mut Draft, values: &mut Values<'_>) {
    let key = values.one(&["at", "point"]);
    draft.line(&format!("{key} = {}", values.point()));
}

/// A holonomic joint of two bodies.
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

/// A nonholonomic joint.
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

/// The measure of a joint that is driven, if it is. Most joints have none; a drive of them is
/// refused.
pub(super) fn measure_of(values: &mut Values<'_>, kind: &str) -> Option<&'static str> {
    match kind {
        "revolute" => Some("angle"),
        "translational" => Some("displacement"),
        "pin-in-slot" => Some(values.one(&["angle", "displacement"])),
        "distance" => Some("length"),
        _ => values.numbers.once_in(20).then_some("angle"),
    }
}

/// `[[drive]]` of a joint.
pub(super) fn drive(
    draft: &mut Draft,
    values: &mut Values<'_>,
    joint: &(String, &'static str),
    measure: &str,
) {
    let name = values.name("d", draft.drives.len());
    draft.line(&format!(
        "[[drive]]\nname = {name}\njoint = {}\ntype = \"{measure}\"",
        joint.0
    ));
    if values.numbers.once_in(4) {
        law(draft, values, measure);
    } else {
        draft.line(&format!("motion = {}", function(values)));
    }
    active(draft, values);
    draft.drives.push(name);
}

/// A torque or a force as a law of the measure, its rate and the time.
pub(super) fn law(draft: &mut Draft, values: &mut Values<'_>, measure: &str) {
    let key = if measure == "angle" {
        "torque"
    } else {
        "force"
    };
    let laws = [
        "2 - 0.5*rate",
        "-3*measure - rate",
        "sin(5*t)",
        "-abs(rate)*rate",
        "1/measure",
        "log(rate)",
        "sqrt(measure)",
        "exp(1e3*t)",
        "1e6*(0.1 - measure)",
        "p0*rate",
    ];
    let law = values.one(&laws);
    draft.line(&format!("{key} = \"{law}\""));
}

/// A stiffness or damping, some of them very large.
pub(super) fn stiff(values: &mut Values<'_>) -> String {
    if values.numbers.once_in(6) {
        format!("1e{}", values.numbers.between(3, 12))
    } else {
        values.positive()
    }
}

/// `[[force]]`.
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

/// The remaining tables: `[start]`, `[[group]]`, `[simulate]`, `[output]`.
pub(super) fn wishes(draft: &mut Draft, values: &mut Values<'_>) {
    if values.numbers.once_in(4) {
        draft.line("[start]\nallow_correction = true");
        let component = match draft.space {
            Space::Plane => values.one(&["x", "y", "angle", "vx", "vy", "omega"]),
            Space::Space => values.one(&["x", "z", "rotation", "vy", "omega", "wx", "wz"]),
        };
        if values.numbers.once_in(2)
            && let Some(body) = draft.bodies.first()
            && !body.contains('\\')
        {
            draft.line(&format!(
                "keep = [\"{}.{component}\"]",
                body.trim_matches('"')
            ));
        }
    }
    if values.numbers.once_in(5) && draft.joints.len() > 1 {
        draft.line(&format!(
            "[[group]]\nname = \"g\"\nmembers = [{}, {}]",
            draft.joints[0].0, draft.joints[1].0
        ));
    }
    if !values.numbers.once_in(8) {
        let end = values.one(&["0.05", "0.1", "0.2", "1.0", "10", "0"]);
        draft.line(&format!("[simulate]\nt_end = {end}"));
        let methods = ["auto", "auto", "dopri5", "dop853", "tsit5", "radau5"];
        let method = values.one(&methods);
        draft.line(&format!("method = \"{method}\""));
        // Radau IIA relies on projection.
        if method != "radau5" && values.numbers.once_in(4) || values.numbers.once_in(40) {
            draft.line(&format!(
                "stabilisation = \"{}\"",
                values.one(&["projection", "none"])
            ));
        }
        if values.numbers.once_in(4) {
            draft.line(&format!(
                "rtol = {}\natol = {}",
                values.one(&["1e-3", "1e-6", "1e-12"]),
                values.one(&["1e-6", "1e-14", "1e-30"])
            ));
        }
        if values.numbers.once_in(4) {
            draft.line(&format!("output_step = {}", values.positive()));
        }
    }
    if values.numbers.once_in(6) {
        draft.line(&format!(
            "[output]\nreactions = {}\ntrajectory = {}",
            values.one(&["true", "false"]),
            values.one(&["true", "false"])
        ));
    }
}
